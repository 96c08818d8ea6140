#include "gap/next_drives.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/parallel_for.h"
#include "gap/possible_drives.h"
#include "gap/rival_outcomes.h"
#include "gap/wildcard.h"

namespace slipway::gap {
namespace {

constexpr double kMostSlip = 0.6;  // nobody would drive there
// Of the usual current, on the mean over the wheels: motors that draw less hold the rover back, which
// gearboxes and controllers do in ways of their own.
constexpr double kLeastCurrent = 0.3;

constexpr std::size_t kMostFitted = 6;
constexpr double kWorthAsking = 0.05;  // probability that a rival has at least
constexpr double kLeastBits = 1e-3;
// Beforehand one effect is as much more probable than none, two of which one is known than that one.
constexpr double kOneOverNone = 1.5, kTwoOverOne = 0.67;

// Of the wildcard: what something unknown of that size would do instead is no reason to drive. By what
// proposals have no value of: the day's order, directions on a map that is not theirs.
constexpr double kUnknownSize = kImprecision;
constexpr std::array<std::string_view, 3> kNotOfPlanes{"east", "north", "order"};

// Parameters that rival each other, and which effects they stand for.
struct Rival {
  const Hypothesis* hypothesis;
  std::vector<double> x;
  double weight = 0.0;
  std::vector<std::string> effects;
};

// An effect beside those of a fit, as large as the drives leave it open: each of its fields, with the rest
// re-tuned to it, one deviation from the estimate, on the side where that is.
void add_open(const Hypothesis& hypothesis, const PreparedCampaign& prepared, const FittedExplanation& base,
              double weight, std::vector<Rival>& rivals) {
  std::vector<double> start;
  const Eigen::MatrixXd columns = added_columns(hypothesis, *prepared.model, *prepared.noise, base, start);
  Eigen::MatrixXd all(columns.rows(), base.white_jacobian.cols() + columns.cols());
  all << base.white_jacobian, columns;
  Eigen::MatrixXd hessian = all.transpose() * all;
  hessian.diagonal().array() += 1.0;
  const Eigen::MatrixXd covariance =
      hessian.llt().solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  const Eigen::VectorXd mean = covariance * (all.transpose() * base.white_linear);
  const auto parameters = hypothesis.parameters();
  for (Eigen::Index f = base.white_jacobian.cols(); f < all.cols(); ++f) {
    const Parameter& field = parameters[static_cast<std::size_t>(f)];
    const double sense = field.lowest == field.neutral    ? 1.0
                         : field.highest == field.neutral ? -1.0
                         : mean[f] < 0.0                  ? -1.0
                                                          : 1.0;
    const Eigen::VectorXd u = mean + sense / std::sqrt(covariance(f, f)) * covariance.col(f);
    Rival rival{&hypothesis, {}, weight / static_cast<double>(columns.cols()), {}};
    for (const EffectVariant& effect : hypothesis.effects()) rival.effects.push_back(effect.effect);
    std::sort(rival.effects.begin(), rival.effects.end());
    for (std::size_t p = 0; p < parameters.size(); ++p)
      rival.x.push_back(
          std::clamp(parameters[p].neutral + parameters[p].std * u[static_cast<Eigen::Index>(p)],
                     parameters[p].lowest, parameters[p].highest));
    rivals.push_back(std::move(rival));
  }
}

// The fitted explanations, and beside the most probable of them, the base, every effect as far as the drives
// leave it open. `open` keeps the hypotheses of the latter.
std::vector<Rival> rivals_of(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                             const ExplanationSearch& search, const Candidate& base,
                             std::vector<Hypothesis>& open, std::size_t threads) {
  std::vector<Rival> rivals;
  std::set<std::vector<std::string>> fitted;
  for (const Candidate& c : search.candidates) {
    if (c.with_unknown || (rivals.size() >= kMostFitted && !c.effects.empty())) continue;
    const FittedExplanation& fit = search.fits[c.fit];
    rivals.push_back({&fit.hypothesis, fit.x, std::max(c.probability, kWorthAsking), c.effects});
    std::sort(rivals.back().effects.begin(), rivals.back().effects.end());
    fitted.insert(rivals.back().effects);
  }
  if (base.effects.size() > 1) return rivals;
  const FittedExplanation& beside = search.fits[base.fit];
  std::set<std::string> effects(base.effects.begin(), base.effects.end());
  for (const ScreenedVariant& s : search.screened) {
    if (!effects.insert(s.variant.effect).second) continue;
    std::vector<std::string> names = base.effects;
    names.push_back(s.variant.effect);
    std::sort(names.begin(), names.end());
    if (fitted.contains(names)) continue;
    std::vector<EffectVariant> variants(beside.hypothesis.effects().begin(),
                                        beside.hypothesis.effects().end());
    variants.push_back(s.variant);
    open.emplace_back(campaign, std::move(variants));
  }
  const double more = base.effects.empty() ? kOneOverNone : kTwoOverOne;
  const double each = std::max(kWorthAsking, more * base.probability) / static_cast<double>(effects.size());
  std::vector<std::vector<Rival>> of_open(open.size());
  parallel_for(open.size(), threads,
               [&](std::size_t i) { add_open(open[i], prepared, beside, each, of_open[i]); });
  for (std::vector<Rival>& some : of_open) rivals.insert(rivals.end(), some.begin(), some.end());
  return rivals;
}

// What re-tuned parameters and something unknown do to proposals, whitened, and their covariance after the
// drives that were made.
Eigen::MatrixXd retuned_and_unknown(const PreparedCampaign& prepared, const FittedExplanation& base,
                                    const NoiseModel& noise, const Eigen::MatrixXd& jacobian,
                                    const Wildcard& unmade, Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd made = whitened(base, *prepared.noise, prepared.wildcard);
  const Eigen::Index retuned = base.white_jacobian.cols();
  std::vector<Eigen::Index> kept;
  Eigen::MatrixXd of_made = Eigen::MatrixXd::Zero(made.rows(), unmade.values.cols());
  for (std::size_t c = 0; c < unmade.columns.size(); ++c) {
    const Wildcard::Column& column = unmade.columns[c];
    if (std::find(kNotOfPlanes.begin(), kNotOfPlanes.end(), column.variable) != kNotOfPlanes.end()) continue;
    kept.push_back(static_cast<Eigen::Index>(c));
    for (std::size_t m = 0; m < prepared.wildcard.columns.size(); ++m)
      if (prepared.wildcard.columns[m].entry == column.entry &&
          prepared.wildcard.columns[m].variable == column.variable)
        of_made.col(kept.back()) = made.col(static_cast<Eigen::Index>(m));
  }
  const auto beside = [&](const Eigen::MatrixXd& own, const Eigen::MatrixXd& unknown) {
    Eigen::MatrixXd all(own.rows(), retuned + static_cast<Eigen::Index>(kept.size()));
    all << own, kUnknownSize * unknown(Eigen::all, kept);
    return all;
  };
  const Eigen::MatrixXd known = beside(base.white_jacobian, of_made);
  Eigen::MatrixXd hessian = known.transpose() * known;
  hessian.diagonal().array() += 1.0;
  covariance = hessian.llt().solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  return beside(noise.whiten(jacobian), noise.whiten(unmade.values));
}

// Drives that somebody would make: the rover gets on and its motors pull.
bool is_sensible(const DriveWindow& window, std::span<const double> expected) {
  double current = 0.0, usual = 0.0;
  for (std::size_t i = 0; i < window.observations.size(); ++i) {
    const Observation& o = window.observations[i];
    if (o.channel == Channel::kSlip && !(std::abs(expected[i]) < kMostSlip)) return false;
    if (o.channel != Channel::kCurrent) continue;
    current += std::isfinite(expected[i]) ? expected[i] : 0.0;
    usual += o.value;
  }
  return current >= kLeastCurrent * usual;
}

// What rivals say less what the base is expected to. What one of them has no answer to is no difference, but
// for the slip, which is 1 there.
Eigen::MatrixXd differences(std::span<const Rival> rivals, const WindowModel& model,
                            std::span<const double> expected, std::size_t threads) {
  Eigen::MatrixXd means(static_cast<Eigen::Index>(expected.size()), static_cast<Eigen::Index>(rivals.size()));
  parallel_for(rivals.size(), threads, [&](std::size_t r) {
    const std::vector<double> told = rivals[r].hypothesis->predict(model, rivals[r].x);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double difference = told[i] - expected[i];
      means(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r)) =
          std::isfinite(difference) ? difference : 0.0;
    }
  });
  return means;
}

}  // namespace

std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                                   const ExplanationSearch& search, std::size_t most, std::size_t threads,
                                   const Progress& progress) {
  const auto named = std::find_if(search.candidates.begin(), search.candidates.end(),
                                  [](const Candidate& c) { return !c.with_unknown; });
  if (named == search.candidates.end()) return {};
  const FittedExplanation& base = search.fits[named->fit];
  const PossibleDrives possible = possible_drives(campaign, prepared.windows);
  WindowModel model(possible.campaign, possible.windows);
  model.watch(progress);
  model.start_from(base.hypothesis.state(base.x), threads);
  std::vector<double> expected = base.hypothesis.predict(model, base.x, threads);
  std::vector<Hypothesis> open;
  const std::vector<Rival> rivals = rivals_of(campaign, prepared, search, *named, open, threads);
  const Eigen::MatrixXd means = differences(rivals, model, expected, threads);
  const Eigen::MatrixXd jacobian = base.hypothesis.scaled_jacobian(model, base.x, threads, expected);
  const Eigen::MatrixXd levers = lever_responses(possible.campaign, model, base.x, threads);
  const Wildcard unmade = make_wildcard(possible.campaign, model, base, threads);
  if (progress.cancelled()) return {};

  RivalOutcomes outcomes;
  outcomes.first_row = {0};
  std::vector<NextDrive> drives;
  std::vector<Eigen::Index> rows;
  for (std::size_t w = 0; w < possible.windows.size(); ++w) {
    const DriveWindow& window = possible.windows[w];
    const std::size_t offset = model.offset(w), count = window.observations.size();
    if (!is_sensible(window, std::span(expected).subspan(offset, count))) continue;
    drives.push_back(possible.drives[w]);
    for (std::size_t i = 0; i < count; ++i) rows.push_back(static_cast<Eigen::Index>(offset + i));
    outcomes.first_row.push_back(static_cast<Eigen::Index>(rows.size()));
  }
  for (double& value : expected)
    if (!std::isfinite(value)) value = 0.0;
  NoiseModel noise(model, scatter_response(base.hypothesis, jacobian, levers), expected,
                   std::vector<bool>(expected.size(), true));
  noise.set(prepared.noise->scales());
  outcomes.means = noise.whiten(means)(rows, Eigen::all);
  outcomes.responses =
      retuned_and_unknown(prepared, base, noise, jacobian, unmade, outcomes.covariance)(rows, Eigen::all);
  outcomes.believed = kBelievedShare;
  outcomes.imprecision = kFormImprecision;
  std::map<std::vector<std::string>, std::size_t> families;
  for (const Rival& rival : rivals) {
    outcomes.weights.push_back(rival.weight);
    outcomes.family.push_back(families.try_emplace(rival.effects, families.size()).first->second);
  }
  std::vector<NextDrive> chosen;
  for (const ChosenDrive& c : most_telling_drives(std::move(outcomes), most, kLeastBits)) {
    chosen.push_back(drives[c.drive]);
    chosen.back().information_bits = c.bits;
  }
  return chosen;
}

}  // namespace slipway::gap
