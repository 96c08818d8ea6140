#include "steps/ground_chain.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "sim/prediction/drawn_ground.h"

namespace slipway::steps {
namespace {

constexpr double kDegrees = 4.0;
const double kTScale = std::tgamma(0.5 * (kDegrees + 1.0)) /
                       (std::tgamma(0.5 * kDegrees) * std::sqrt(kDegrees * std::numbers::pi));

Eigen::ArrayXd chords(const std::vector<ChainSoil>& soils, double patch_m) {
  Eigen::ArrayXd chord_m(static_cast<Eigen::Index>(soils.size()));
  for (std::size_t k = 0; k < soils.size(); ++k)
    chord_m[static_cast<Eigen::Index>(k)] = mean_chord_m(soils[k].in_patches ? patch_m : sim::kUnitLength_m);
  return chord_m;
}

}  // namespace

double mean_chord_m(double lattice_m) {
  return 0.25 * std::numbers::pi * lattice_m;
}

double StepNoise::density(double deviation, double slip) const {
  const double scale = least + share * std::abs(slip);
  const double t = deviation / scale;
  return kTScale * std::pow(1.0 + t * t / kDegrees, -0.5 * (kDegrees + 1.0)) / scale;
}

// In closed form for four degrees of freedom.
double StepNoise::below(double deviation, double slip) const {
  const double t = deviation / (least + share * std::abs(slip));
  const double u = t / std::sqrt(t * t + kDegrees);
  return 0.5 + 0.75 * (u - u * u * u / 3.0);
}

GroundChain::GroundChain(std::vector<ChainSoil> chain_soils, std::vector<ChainGround> chain_grounds,
                         double patch_m)
    : soils(std::move(chain_soils)), grounds(std::move(chain_grounds)), chord_m(chords(soils, patch_m)) {}

GroundChain::GroundChain(const sim::RoverModel& rover, double gravity_m_s2,
                         std::span<const sim::SoilDistribution* const> beliefs) {
  std::map<std::string, std::size_t> index;
  std::vector<std::vector<std::pair<std::size_t, double>>> shares;
  std::vector<double> length_m;
  for (const sim::SoilDistribution* belief : beliefs) {
    auto& of_ground = shares.emplace_back();
    const auto add = [&](const sim::SoilDistribution& soil, double share, bool in_patches) {
      const auto [at, is_new] = index.try_emplace(soil.name, soils.size());
      if (is_new) {
        soils.push_back({soil.name, in_patches, PlaneSlips(rover, gravity_m_s2, soil.mean)});
        length_m.push_back(in_patches ? belief->correlation_length_m : sim::kUnitLength_m);
      }
      of_ground.emplace_back(at->second, share);
    };
    if (belief->alternatives.empty()) add(*belief, 1.0, false);
    for (const sim::SoilAlternative& each : belief->alternatives)
      add(*each.soil, each.strength_weight,
          each.in_patches || belief->alternatives_by == sim::AlternativesBy::kPatch);
  }
  const auto count = static_cast<Eigen::Index>(soils.size());
  for (std::size_t g = 0; g < beliefs.size(); ++g) {
    ChainGround ground{beliefs[g]->name, Eigen::ArrayXd::Zero(count)};
    for (const auto& [soil, share] : shares[g]) ground.shares[static_cast<Eigen::Index>(soil)] += share;
    ground.shares /= ground.shares.sum();
    grounds.push_back(std::move(ground));
  }
  chord_m.resize(count);
  for (std::size_t k = 0; k < soils.size(); ++k)
    chord_m[static_cast<Eigen::Index>(k)] = mean_chord_m(length_m[k]);
}

Eigen::ArrayXd GroundChain::entry_weights(const Eigen::ArrayXd& shares) const {
  const Eigen::ArrayXd weights = shares / chord_m;
  return weights / weights.sum();
}

Eigen::ArrayXd GroundChain::shares_of_entries(const Eigen::ArrayXd& weights) const {
  const Eigen::ArrayXd shares = weights * chord_m;
  return shares / shares.sum();
}

Eigen::ArrayXd GroundChain::predicted_slips(const ChainStep& step) const {
  Eigen::ArrayXd slips(chord_m.size());
  for (std::size_t k = 0; k < soils.size(); ++k)
    slips[static_cast<Eigen::Index>(k)] = soils[k].slips.at(step.pitch_rad, step.roll_rad);
  return slips;
}

Eigen::ArrayXXd GroundChain::predicted_slips(std::span<const ChainStep> steps) const {
  Eigen::ArrayXXd slips(chord_m.size(), static_cast<Eigen::Index>(steps.size()));
  for (Eigen::Index t = 0; t < slips.cols(); ++t)
    slips.col(t) = predicted_slips(steps[static_cast<std::size_t>(t)]);
  return slips;
}

Eigen::ArrayXXd GroundChain::likelihoods(std::span<const ChainStep> steps,
                                         const Eigen::ArrayXXd& slips) const {
  Eigen::ArrayXXd out = slips;
  for (Eigen::Index t = 0; t < out.cols(); ++t) {
    const double measured = steps[static_cast<std::size_t>(t)].slip;
    out.col(t) = slips.col(t).unaryExpr([&](double slip) { return noise.density(measured - slip, slip); });
  }
  return out;
}

ChainPass follow(const GroundChain& chain, std::span<const ChainStep> steps,
                 const Eigen::ArrayXXd& likelihoods, const Eigen::ArrayXd& start,
                 const std::vector<Eigen::ArrayXd>& shares) {
  const auto soils = static_cast<Eigen::Index>(chain.soils.size());
  const auto count = static_cast<Eigen::Index>(steps.size());
  ChainPass pass{Eigen::ArrayXXd(soils, count),
                 Eigen::ArrayXXd::Zero(soils, static_cast<Eigen::Index>(chain.grounds.size())),
                 Eigen::ArrayXXd(soils, count), start, 0.0};
  if (count == 0) return pass;
  // Probability that the soil of the last step holds on; nought across a border of grounds.
  const auto stays = [&](Eigen::Index t) -> Eigen::ArrayXd {
    const ChainStep& here = steps[static_cast<std::size_t>(t)];
    if (here.ground != steps[static_cast<std::size_t>(t - 1)].ground) return Eigen::ArrayXd::Zero(soils);
    return (-here.length_m / chain.chord_m).exp();
  };
  const auto entering = [&](Eigen::Index t, const Eigen::ArrayXd& stay) -> Eigen::ArrayXd {
    const Eigen::ArrayXd weights = shares[steps[static_cast<std::size_t>(t)].ground] * (1.0 - stay);
    return weights / weights.sum();
  };
  Eigen::ArrayXXd after(soils, count);
  Eigen::ArrayXd evidence(count);
  for (Eigen::Index t = 0; t < count; ++t) {
    if (t == 0) {
      pass.before.col(t) = start;
    } else {
      const Eigen::ArrayXd stay = stays(t);
      const double leaving = ((1.0 - stay) * after.col(t - 1)).sum();
      pass.before.col(t) = stay * after.col(t - 1) + leaving * entering(t, stay);
    }
    const Eigen::ArrayXd joint = pass.before.col(t) * likelihoods.col(t);
    evidence[t] = joint.sum();
    after.col(t) = joint / evidence[t];
    pass.log_likelihood += std::log(evidence[t]);
  }
  pass.last = after.col(count - 1);
  Eigen::ArrayXd later = Eigen::ArrayXd::Ones(soils);
  for (Eigen::Index t = count - 1; t > 0; --t) {
    const std::size_t ground = steps[static_cast<std::size_t>(t)].ground;
    pass.smoothed.col(t) = after.col(t) * later;
    const Eigen::ArrayXd stay = stays(t);
    const Eigen::ArrayXd weights = entering(t, stay);
    const Eigen::ArrayXd seen = likelihoods.col(t) * later / evidence[t];
    const double leaving = ((1.0 - stay) * after.col(t - 1)).sum();
    pass.entries.col(static_cast<Eigen::Index>(ground)) += leaving * weights * seen;
    later = stay * seen + (1.0 - stay) * (weights * seen).sum();
  }
  pass.smoothed.col(0) = after.col(0) * later;
  // The first stretch of a way began before it: it is one of those met, as the others are.
  pass.entries.col(static_cast<Eigen::Index>(steps[0].ground)) += pass.smoothed.col(0);
  return pass;
}

}  // namespace slipway::steps
