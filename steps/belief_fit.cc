#include "steps/belief_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "core/random.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"

namespace slipway::steps {
namespace {

using Ways = std::span<const std::vector<ChainStep>>;

constexpr double kLevelSlipOfPatches = 0.1;  // a soil that slips by more on the level lies in patches
constexpr std::size_t kMostOnUnits = 400, kMostInPatches = 250;  // candidates of each kind
constexpr int kRounds = 60, kRoundsOfProfile = 25;
// Twice the logarithm of a likelihood ratio beyond which a value is outside the 90 % interval [Wilks 1938].
constexpr double kWilks = 2.706;

struct Candidate {
  sim::Soil soil;
  double level_slip = 0.0, slip_at_8_deg = 0.0, sinkage_m = 0.0;
};

double between(double low, double high, double uniform) {
  return low + (high - low) * uniform;
}
double between_log(double low, double high, double uniform) {
  return low * std::pow(high / low, uniform);
}

// Ranges that hold the soils measured on Mars and its simulants but drift (Shen et al. 2024, Tables 1 and 3).
sim::Soil drawn_soil(std::uint64_t key, double gravity_m_s2) {
  sim::Soil soil;
  soil.pressure.n = between(0.7, 1.4, random_uniform(key, 0));
  soil.pressure.k_phi = between_log(6e4, 2e7, random_uniform(key, 1));
  soil.cohesion_pa = between_log(50.0, 6000.0, random_uniform(key, 2));
  soil.friction_angle_rad = rad_from_deg(between(22.0, 42.0, random_uniform(key, 3)));
  soil.shear_modulus_x_m = soil.shear_modulus_y_m = between_log(0.006, 0.06, random_uniform(key, 4));
  soil.c1 = 0.18;
  soil.c2 = 0.32;
  soil.gravity_m_s2 = gravity_m_s2;
  return soil;
}

Candidate candidate(const sim::RoverModel& rover, double gravity_m_s2, const sim::Soil& soil) {
  sim::QuasiStaticSolver solver(rover, gravity_m_s2, sim::Precision::kDraws);
  const sim::DriveCommand command{.speed_m_s = rover.cruise_speed_m_s};
  const auto on = [&](double climb_deg) {
    return solver.solve(sim::stance_on_plane(rover, {.pitch_rad = rad_from_deg(-climb_deg)}), soil, command);
  };
  Candidate out{soil, 1.0, 1.0, 1.0};
  const sim::StationState level = on(0.0), slope = on(8.0);
  if (!level.moving()) return out;
  out.level_slip = sim::measured_slip(level, command);
  out.sinkage_m = 0.0;
  for (const sim::WheelState& wheel : level.wheels) out.sinkage_m = std::max(out.sinkage_m, wheel.sinkage_m);
  if (slope.moving()) out.slip_at_8_deg = sim::measured_slip(slope, command);
  return out;
}

// Candidates that a rover may have met, those on units first.
std::vector<Candidate> candidates(const sim::RoverModel& rover, double gravity_m_s2,
                                  const BeliefFitOptions& options) {
  constexpr double kMostSinkage = 0.25, kLeastLevelSlip = -0.005, kMostLevelSlip = 0.7, kMostOnSlope = 0.3;
  std::vector<Candidate> all(options.candidates);
  parallel_for(all.size(), options.threads, [&](std::size_t i) {
    all[i] = candidate(rover, gravity_m_s2, drawn_soil(random_key(options.seed, i), gravity_m_s2));
  });
  std::vector<Candidate> on_units, in_patches;
  for (const Candidate& each : all) {
    if (each.sinkage_m > kMostSinkage * rover.smallest_wheel_radius_m()) continue;
    if (each.level_slip < kLeastLevelSlip || each.level_slip > kMostLevelSlip) continue;
    if (each.level_slip > kLevelSlipOfPatches) {
      if (in_patches.size() < kMostInPatches) in_patches.push_back(each);
    } else if (each.slip_at_8_deg < kMostOnSlope && on_units.size() < kMostOnUnits) {
      on_units.push_back(each);
    }
  }
  on_units.insert(on_units.end(), in_patches.begin(), in_patches.end());
  return on_units;
}

// Steps with the slips of every soil on them, without the offset of odometry.
struct FitData {
  std::vector<std::vector<ChainStep>> ways;
  std::vector<Eigen::ArrayXXd> slips;  // soil x step
};

FitData data_of(const GroundChain& chain, Ways ways) {
  FitData data{{ways.begin(), ways.end()}, {}};
  for (const std::vector<ChainStep>& way : ways) data.slips.push_back(chain.predicted_slips(way));
  return data;
}

std::vector<Eigen::ArrayXXd> likelihoods_of(const FitData& data, const StepNoise& noise, double offset) {
  std::vector<Eigen::ArrayXXd> out;
  for (std::size_t w = 0; w < data.ways.size(); ++w) {
    Eigen::ArrayXXd& here = out.emplace_back(data.slips[w]);
    for (Eigen::Index t = 0; t < here.cols(); ++t)
      for (Eigen::Index k = 0; k < here.rows(); ++k) {
        const double slip = 1.0 - (1.0 - here(k, t)) * (1.0 - offset);
        here(k, t) = noise.density(data.ways[w][static_cast<std::size_t>(t)].slip - slip, slip);
      }
  }
  return out;
}

// Expectation maximisation of the soils' shares of the steps over the ways of `chosen`; returns the log
// likelihood. The prior counts as steps besides. Steps are counted, not stretches: a way shows parts of its
// first and last stretch alone, so that stretches would count short patches too seldom.
double maximise(const GroundChain& chain, const FitData& data,
                const std::vector<Eigen::ArrayXXd>& likelihoods, std::span<const std::size_t> chosen,
                const Eigen::ArrayXd& prior, int rounds, Eigen::ArrayXd& shares) {
  double log_likelihood = 0.0;
  for (int round = 0; round < rounds; ++round) {
    Eigen::ArrayXd steps = prior;
    log_likelihood = 0.0;
    const std::vector<Eigen::ArrayXd> now{shares};
    for (const std::size_t w : chosen) {
      const ChainPass pass = follow(chain, data.ways[w], likelihoods[w], shares, now);
      steps += pass.smoothed.rowwise().sum();
      log_likelihood += pass.log_likelihood;
    }
    shares = steps / steps.sum();
  }
  return log_likelihood;
}

std::vector<std::size_t> all_of(const FitData& data) {
  std::vector<std::size_t> all(data.ways.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

// The kept soils: those with the largest shares, in steps of which each halves what is too many.
std::vector<std::size_t> kept(const GroundChain& chain, const FitData& data,
                              const std::vector<Eigen::ArrayXXd>& likelihoods,
                              const BeliefFitOptions& options, Eigen::ArrayXd shares) {
  constexpr int kHalvings = 5;
  constexpr double kGone = 1e-7;
  const std::vector<std::size_t> all = all_of(data);
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(shares.size());
  for (int halving = 0; halving < kHalvings; ++halving) {
    std::vector<std::size_t> order(chain.soils.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return shares[static_cast<Eigen::Index>(a)] > shares[static_cast<Eigen::Index>(b)];
    });
    Eigen::ArrayXd remaining = Eigen::ArrayXd::Zero(shares.size());
    for (const bool in_patches : {false, true}) {
      const std::size_t wanted = in_patches ? options.in_patches : options.on_units;
      std::vector<std::size_t> here;
      for (const std::size_t k : order)
        if (chain.soils[k].in_patches == in_patches && shares[static_cast<Eigen::Index>(k)] > kGone)
          here.push_back(k);
      const std::size_t extra = here.size() > wanted ? here.size() - wanted : 0;
      const std::size_t keep = wanted + (halving + 1 < kHalvings ? extra / 2 : 0);
      for (std::size_t i = 0; i < std::min(keep, here.size()); ++i)
        remaining[static_cast<Eigen::Index>(here[i])] = shares[static_cast<Eigen::Index>(here[i])];
    }
    shares = remaining / remaining.sum();
    maximise(chain, data, likelihoods, all, none, kRoundsOfProfile, shares);
  }
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < chain.soils.size(); ++k)
    if (shares[static_cast<Eigen::Index>(k)] > kGone) out.push_back(k);
  return out;
}

Eigen::ArrayXd first_shares(const GroundChain& chain) {
  constexpr double kInPatches = 0.02;
  Eigen::ArrayXd shares(static_cast<Eigen::Index>(chain.soils.size()));
  const auto patches = static_cast<double>(std::count_if(
      chain.soils.begin(), chain.soils.end(), [](const ChainSoil& soil) { return soil.in_patches; }));
  const double units = static_cast<double>(chain.soils.size()) - patches;
  for (std::size_t k = 0; k < chain.soils.size(); ++k)
    shares[static_cast<Eigen::Index>(k)] =
        chain.soils[k].in_patches ? kInPatches / patches : (1.0 - kInPatches) / units;
  return shares;
}

GroundChain chain_of(const sim::RoverModel& rover, double gravity_m_s2, const std::vector<Candidate>& soils,
                     const BeliefFitOptions& options) {
  std::vector<std::optional<PlaneSlips>> tables(soils.size());
  parallel_for(soils.size(), options.threads,
               [&](std::size_t k) { tables[k].emplace(rover, gravity_m_s2, soils[k].soil); });
  std::vector<ChainSoil> of_chain;
  for (std::size_t k = 0; k < soils.size(); ++k)
    of_chain.push_back({fmt::format("soil_{}", k), soils[k].level_slip > kLevelSlipOfPatches, *tables[k]});
  std::vector<ChainGround> grounds{
      {"all", Eigen::ArrayXd::Constant(static_cast<Eigen::Index>(soils.size()), 1.0)}};
  return {std::move(of_chain), std::move(grounds), options.patch_m};
}

// A number with the interval of its profile likelihood over a grid of values.
template <class LogLikelihood>
Estimate profiled(const std::vector<double>& values, const LogLikelihood& log_likelihood) {
  std::vector<double> at;
  for (const double value : values) at.push_back(log_likelihood(value));
  const auto best = std::max_element(at.begin(), at.end());
  Estimate out{values[static_cast<std::size_t>(best - at.begin())], values.back(), values.front()};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (2.0 * (*best - at[i]) > kWilks) continue;
    out.low = std::min(out.low, values[i]);
    out.high = std::max(out.high, values[i]);
  }
  return out;
}

struct FitParts {
  const GroundChain& chain;
  const FitData& data;
  StepNoise noise;
  double offset;
};

// The profiles of offset, noise and patches' length over the kept soils.
void add_profiles(const FitParts& parts, const Eigen::ArrayXd& shares, BeliefFit& fit) {
  const std::vector<std::size_t> all = all_of(parts.data);
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(shares.size());
  const auto at = [&](const GroundChain& chain, const StepNoise& noise, double offset) {
    Eigen::ArrayXd here = shares;
    return maximise(chain, parts.data, likelihoods_of(parts.data, noise, offset), all, none, kRoundsOfProfile,
                    here);
  };
  fit.odometry_offset = profiled({0.0, 0.005, 0.01, 0.015, 0.02, 0.0225, 0.025, 0.0275, 0.03, 0.035, 0.04},
                                 [&](double offset) { return at(parts.chain, parts.noise, offset); });
  fit.noise_least =
      profiled({0.008, 0.01, 0.011, 0.012, 0.013, 0.014, 0.015, 0.016, 0.018, 0.02}, [&](double least) {
        return at(parts.chain, {least, parts.noise.share}, parts.offset);
      });
  fit.noise_share = profiled({0.05, 0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.25, 0.3}, [&](double share) {
    return at(parts.chain, {parts.noise.least, share}, parts.offset);
  });
  fit.patch_m = profiled({3.0, 5.0, 7.0, 10.0, 13.0, 18.0, 25.0, 35.0, 50.0}, [&](double patch_m) {
    GroundChain chain = parts.chain;
    for (std::size_t k = 0; k < chain.soils.size(); ++k)
      if (chain.soils[k].in_patches) chain.chord_m[static_cast<Eigen::Index>(k)] = mean_chord_m(patch_m);
    return at(chain, parts.noise, parts.offset);
  });
}

void add_intervals(const FitParts& parts, const std::vector<Eigen::ArrayXXd>& likelihoods,
                   const Eigen::ArrayXd& shares, const BeliefFitOptions& options, BeliefFit& fit) {
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(shares.size());
  std::vector<Eigen::ArrayXd> resampled(options.resamples);
  parallel_for(options.resamples, options.threads, [&](std::size_t r) {
    std::vector<std::size_t> chosen(parts.data.ways.size());
    for (std::size_t w = 0; w < chosen.size(); ++w)
      chosen[w] = random_bits(random_key(options.seed, 1000000 + r), w) % chosen.size();
    Eigen::ArrayXd here = shares;
    maximise(parts.chain, parts.data, likelihoods, chosen, none, kRoundsOfProfile, here);
    resampled[r] = here;
  });
  for (std::size_t k = 0; k < fit.soils.size(); ++k) {
    std::vector<double> values;
    for (const Eigen::ArrayXd& each : resampled) values.push_back(each[static_cast<Eigen::Index>(k)]);
    const double share = shares[static_cast<Eigen::Index>(k)];
    fit.soils[k].share = values.empty() ? Estimate{share, share, share}
                                        : Estimate{share, quantile(values, 0.05), quantile(values, 0.95)};
  }
}

// Soils on units from the least slip at 8 deg to the most, then those in patches.
std::vector<Candidate> in_order(std::vector<Candidate> soils) {
  std::stable_sort(soils.begin(), soils.end(), [](const Candidate& a, const Candidate& b) {
    const bool a_patch = a.level_slip > kLevelSlipOfPatches, b_patch = b.level_slip > kLevelSlipOfPatches;
    return a_patch != b_patch ? b_patch : a.slip_at_8_deg + a.level_slip < b.slip_at_8_deg + b.level_slip;
  });
  return soils;
}

}  // namespace

Result<BeliefFit> fit_belief(const sim::RoverModel& given, double gravity_m_s2, Ways ways,
                             std::span<const GroundClassSteps> classes, const BeliefFitOptions& options,
                             Progress& progress) {
  BeliefFit fit;
  for (const std::vector<ChainStep>& way : ways) fit.steps += way.size();
  fit.ways = ways.size();
  if (fit.steps == 0) return fail(ErrorCode::kInvalidRequest, "there are no steps to learn from");
  // The offset is fitted: the rover's own is not counted twice.
  sim::RoverModel rover = given;
  for (sim::WheelModel& wheel : rover.wheels) wheel.software_radius_m.reset();

  progress.report("drawing soils", 0.05);
  const std::vector<Candidate> drawn = candidates(rover, gravity_m_s2, options);
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "cancelled");
  const GroundChain wide = chain_of(rover, gravity_m_s2, drawn, options);
  const FitData wide_data = data_of(wide, ways);
  const std::vector<std::size_t> every = all_of(wide_data);
  const Eigen::ArrayXd no_prior = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(drawn.size()));

  // The offset first, with all soils; then the soils that are kept.
  const StepNoise noise;
  double offset = 0.0, best = -1e300;
  for (const double tried : {0.0, 0.01, 0.02, 0.025, 0.03, 0.04}) {
    if (progress.cancelled()) return fail(ErrorCode::kCancelled, "cancelled");
    progress.report("how much odometry counts too much", 0.4);
    Eigen::ArrayXd shares = first_shares(wide);
    const double here = maximise(wide, wide_data, likelihoods_of(wide_data, noise, tried), every, no_prior,
                                 kRoundsOfProfile, shares);
    if (here > best) std::tie(best, offset) = std::pair(here, tried);
  }
  const auto wide_likelihoods = likelihoods_of(wide_data, noise, offset);
  Eigen::ArrayXd wide_shares = first_shares(wide);
  maximise(wide, wide_data, wide_likelihoods, every, no_prior, kRounds, wide_shares);
  std::vector<Candidate> chosen;
  for (const std::size_t k : kept(wide, wide_data, wide_likelihoods, options, wide_shares))
    chosen.push_back(drawn[k]);
  chosen = in_order(std::move(chosen));
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "cancelled");

  progress.report("shares of soils and their intervals", 0.7);
  const GroundChain chain = chain_of(rover, gravity_m_s2, chosen, options);
  const FitData data = data_of(chain, ways);
  const auto likelihoods = likelihoods_of(data, noise, offset);
  Eigen::ArrayXd shares = first_shares(chain);
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(shares.size());
  fit.log_likelihood = maximise(chain, data, likelihoods, every, none, 2 * kRounds, shares);
  std::size_t on_units = 0, in_patches = 0;
  for (const Candidate& each : chosen) {
    const bool patch = each.level_slip > kLevelSlipOfPatches;
    const std::string name =
        patch ? fmt::format("gale_loose_{}", ++in_patches) : fmt::format("gale_firm_{}", ++on_units);
    FittedSoil& soil = fit.soils.emplace_back(
        FittedSoil{name, each.soil, patch, {}, each.level_slip, each.slip_at_8_deg, each.sinkage_m, {}});
    for (std::size_t c = 0; c < kComparedClimbs_deg.size(); ++c)
      soil.slips[c] = chain.soils[fit.soils.size() - 1].slips.at(rad_from_deg(kComparedClimbs_deg[c]), 0.0);
  }
  const FitParts parts{chain, data, noise, offset};
  add_profiles(parts, shares, fit);
  add_intervals(parts, likelihoods, shares, options, fit);

  fit.classes.push_back({"unknown_ground",
                         "Ground of Mars that no map names: firm nearly everywhere, loose in few patches",
                         {shares.begin(), shares.end()},
                         fit.steps});
  for (const GroundClassSteps& each : classes) {
    const FitData of_class = data_of(chain, each.ways);
    Eigen::ArrayXd here = shares;
    maximise(chain, of_class, likelihoods_of(of_class, noise, offset), all_of(of_class),
             options.prior_steps * shares, kRounds, here);
    FittedClass& out =
        fit.classes.emplace_back(FittedClass{each.name, each.summary, {here.begin(), here.end()}, 0});
    for (const std::vector<ChainStep>& way : each.ways) out.steps += way.size();
  }
  return fit;
}

}  // namespace slipway::steps
