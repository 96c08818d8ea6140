#include "gap/next_drives.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"
#include "core/parallel_for.h"
#include "gap/rival_outcomes.h"
#include "gap/wildcard.h"

namespace slipway::gap {
namespace {

constexpr std::array kTilts_deg{0.0, 5.0, 10.0, 15.0};
constexpr std::array kHeadings_deg{0.0, 90.0, 180.0, -90.0};  // from straight uphill, to the left
constexpr std::array kSpeedShares{1.0, 0.5, -1.0, -0.5};      // of cruise speed
constexpr std::array kArcs_1_m{0.3, -0.3};
constexpr double kMostTiltOfArcs_deg = 10.0;
constexpr std::array kTemperatures_c{20.0, -40.0};
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

// Uphill is along x; one soil.
class Plane final : public sim::Ground {
 public:
  explicit Plane(double tilt_rad)
      : rise_(std::tan(tilt_rad)), normal_(-std::sin(tilt_rad), 0.0, std::cos(tilt_rad)) {}
  std::optional<sim::GroundPoint> at(double x_m, double /*y_m*/) const override {
    return sim::GroundPoint{rise_ * x_m, normal_};
  }
  std::optional<std::size_t> soil_at(double /*x_m*/, double /*y_m*/) const override { return 0; }

 private:
  double rise_;
  Eigen::Vector3d normal_;
};

// No model tells drives that nobody has made nearer than this, whatever those that were made scatter by: of
// currents a share of what is usual, since downhill there is hardly any.
constexpr double kCurrentShare = 0.05;
double least_error(Channel channel, double usual) {
  switch (channel) {
    case Channel::kSlip:
    case Channel::kSideSlip:
      return 0.01;
    case Channel::kYawRate:
      return 3e-4;
    case Channel::kCurrent:
      return kCurrentShare * usual;
    case Channel::kSinkage:
      return 0.001;
    default:
      return 0.0;
  }
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// What windows of the campaign measure, each channel of each wheel once, with its usual size and sensor
// error.
std::vector<Observation> measured_channels(std::span<const DriveWindow> windows) {
  struct Told {
    std::vector<double> errors, sizes;
  };
  std::map<std::pair<Channel, int>, Told> told;
  for (const DriveWindow& window : windows)
    for (const Observation& o : window.observations) {
      if (o.channel == Channel::kRoll || o.channel == Channel::kPitch) continue;
      told[{o.channel, o.wheel}].errors.push_back(o.sensor_std);
      told[{o.channel, o.wheel}].sizes.push_back(std::abs(o.value));
    }
  std::vector<Observation> channels;
  for (auto& [key, of_windows] : told) {
    const double usual = median_of(of_windows.sizes);
    channels.push_back({key.first, key.second, usual,
                        std::hypot(median_of(of_windows.errors), least_error(key.first, usual))});
  }
  return channels;
}

// A campaign of drives that could be made, a window each.
struct Proposals {
  std::vector<NextDrive> drives;
  DriveCampaign campaign;
  std::vector<DriveWindow> windows;
};

std::vector<NextDrive> possible_drives(const DriveCampaign& campaign, bool temperatures) {
  std::vector<NextDrive> drives;
  for (const double tilt : kTilts_deg)
    for (const double heading : kHeadings_deg)
      for (const double share : kSpeedShares)
        for (const double temperature : kTemperatures_c) {
          if (tilt == 0.0 && heading != 0.0) continue;
          if (!temperatures && temperature != kTemperatures_c[0]) continue;
          NextDrive drive{.tilt_deg = tilt,
                          .heading_deg = heading,
                          .speed_m_s = share * campaign.rover->cruise_speed_m_s,
                          .motor_temp_c = temperature};
          drives.push_back(drive);
          if (tilt > kMostTiltOfArcs_deg || share < 0.0 || temperature != kTemperatures_c[0]) continue;
          for (const double curvature : kArcs_1_m) {
            drive.curvature_1_m = curvature;
            drives.push_back(drive);
          }
        }
  return drives;
}

Proposals make_proposals(const DriveCampaign& campaign, std::span<const DriveWindow> made) {
  Proposals proposals;
  const bool temperatures = std::any_of(
      made.begin(), made.end(), [](const DriveWindow& w) { return w.command.motor_temp_c.has_value(); });
  proposals.drives = possible_drives(campaign, temperatures);
  DriveCampaign& c = proposals.campaign;
  c.gravity_m_s2 = campaign.gravity_m_s2;
  c.rover = campaign.rover;
  c.soils = campaign.soils;
  c.measurement_std = campaign.measurement_std;
  c.retuning = campaign.retuning;
  for (const double tilt : kTilts_deg)
    c.terrains.push_back({"", std::make_shared<Plane>(rad_from_deg(tilt)), ""});
  const std::vector<Observation> channels = measured_channels(made);
  for (const NextDrive& asked : proposals.drives) {
    MeasuredDriveSeries drive;
    drive.terrain = static_cast<std::size_t>(std::find(kTilts_deg.begin(), kTilts_deg.end(), asked.tilt_deg) -
                                             kTilts_deg.begin());
    drive.command.speed_m_s = asked.speed_m_s;
    drive.command.curvature_1_m = asked.curvature_1_m;
    if (temperatures) drive.command.motor_temp_c = asked.motor_temp_c;
    DriveWindow window;
    window.drive = c.drives.size();
    window.command = drive.command;
    window.stations = {{0.0, 0.0, rad_from_deg(asked.heading_deg)}};
    window.observations = channels;
    c.drives.push_back(std::move(drive));
    proposals.windows.push_back(std::move(window));
  }
  return proposals;
}

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

}  // namespace

std::vector<NextDrive> next_drives(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                                   const ExplanationSearch& search, std::size_t most, std::size_t threads,
                                   const Progress& progress) {
  const auto named = std::find_if(search.candidates.begin(), search.candidates.end(),
                                  [](const Candidate& c) { return !c.with_unknown; });
  if (named == search.candidates.end()) return {};
  const FittedExplanation& base = search.fits[named->fit];
  Proposals proposals = make_proposals(campaign, prepared.windows);
  WindowModel model(proposals.campaign, proposals.windows);
  model.watch(progress);
  model.start_from(base.hypothesis.state(base.x), threads);
  std::vector<double> expected = base.hypothesis.predict(model, base.x, threads);
  std::vector<Hypothesis> open;
  const std::vector<Rival> rivals = rivals_of(campaign, prepared, search, *named, open, threads);
  std::vector<std::vector<double>> told(rivals.size());
  parallel_for(rivals.size(), threads,
               [&](std::size_t r) { told[r] = rivals[r].hypothesis->predict(model, rivals[r].x); });
  if (progress.cancelled()) return {};

  const Eigen::MatrixXd jacobian = base.hypothesis.scaled_jacobian(model, base.x, threads, expected);
  const Eigen::MatrixXd levers = lever_responses(proposals.campaign, model, base.x, threads);
  std::vector<double> known = expected;
  for (double& value : known)
    if (!std::isfinite(value)) value = 0.0;
  NoiseModel noise(model, scatter_response(base.hypothesis, jacobian, levers), known,
                   std::vector<bool>(known.size(), true));
  noise.set(prepared.noise->scales());
  if (progress.cancelled()) return {};

  // What a rival has no answer to is no difference, but for the slip, which is 1 there.
  Eigen::MatrixXd means(static_cast<Eigen::Index>(expected.size()), static_cast<Eigen::Index>(rivals.size()));
  for (std::size_t r = 0; r < rivals.size(); ++r)
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double difference = told[r][i] - expected[i];
      means(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(r)) =
          std::isfinite(difference) ? difference : 0.0;
    }
  means = noise.whiten(means);

  RivalOutcomes outcomes;
  const Wildcard unmade = make_wildcard(proposals.campaign, model, base, threads);
  const Eigen::MatrixXd responses =
      retuned_and_unknown(prepared, base, noise, jacobian, unmade, outcomes.covariance);
  outcomes.believed = kBelievedShare;
  outcomes.imprecision = kFormImprecision;
  std::map<std::vector<std::string>, std::size_t> families;
  for (const Rival& rival : rivals) {
    outcomes.weights.push_back(rival.weight);
    outcomes.family.push_back(families.try_emplace(rival.effects, families.size()).first->second);
  }
  // Drives that somebody would make.
  std::vector<NextDrive> drives;
  std::vector<Eigen::Index> rows;
  outcomes.first_row = {0};
  for (std::size_t w = 0; w < proposals.windows.size(); ++w) {
    const auto& observations = proposals.windows[w].observations;
    bool stuck = false;
    double current = 0.0, usual = 0.0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      const std::size_t row = model.offset(w) + i;
      if (observations[i].channel == Channel::kSlip)
        stuck = stuck || !(std::abs(expected[row]) < kMostSlip) || !(std::abs(told[0][row]) < kMostSlip);
      if (observations[i].channel != Channel::kCurrent) continue;
      current += known[row];
      usual += observations[i].value;
    }
    stuck = stuck || current < kLeastCurrent * usual;
    if (stuck) continue;
    drives.push_back(proposals.drives[w]);
    for (std::size_t i = 0; i < observations.size(); ++i)
      rows.push_back(static_cast<Eigen::Index>(model.offset(w) + i));
    outcomes.first_row.push_back(static_cast<Eigen::Index>(rows.size()));
  }
  outcomes.means = means(rows, Eigen::all);
  outcomes.responses = responses(rows, Eigen::all);
  std::vector<NextDrive> chosen;
  for (const ChosenDrive& c : most_telling_drives(std::move(outcomes), most, kLeastBits)) {
    chosen.push_back(drives[c.drive]);
    chosen.back().information_bits = c.bits;
  }
  return chosen;
}

}  // namespace slipway::gap
