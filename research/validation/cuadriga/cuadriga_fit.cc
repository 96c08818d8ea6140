#include "research/validation/cuadriga/cuadriga_fit.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "core/angle.h"

namespace slipway::validation {
namespace {

constexpr int kStarts = 2;
// Rolling resistance on level ground over the weight, times the cube root of k_phi; it is 0.21 at 1e6 N/m^3.
constexpr double kResistance = 21.0;

// First guesses of the scatter of slip, and of current in A.
LogScatter guessed(double within) {
  LogScatter scatter;
  scatter.within = within;
  scatter.between = 0.6 * within;
  return scatter;
}

// The residual whose half square is s^2 (sqrt(1 + z^2 / s^2) - 1), which is z^2 / 2 near 0 and grows like |z|
// far out, without a kink [Charbonnier et al. 1997]. The loss is applied before the weights, so that it
// limits windows of long and short logs alike.
double softened(double z) {
  constexpr double kFrom = 1.5;
  const double cost = kFrom * kFrom * (std::sqrt(1.0 + z * z / (kFrom * kFrom)) - 1.0);
  return std::copysign(std::sqrt(2.0 * cost), z);
}

// Solves the table again only for a soil that is not among the last eight, since half of the unknowns are the
// motors'.
class ModelSource {
 public:
  explicit ModelSource(const sim::RoverModel& rover) : rover_(rover) {}

  std::optional<CuadrigaModel> model(std::span<const double> x) {
    const std::vector<double> soil(x.begin(), x.begin() + 3);
    auto known = std::find_if(tables_.begin(), tables_.end(), [&](const auto& t) { return t.first == soil; });
    if (known == tables_.end()) {
      if (tables_.size() == 8) tables_.pop_front();
      tables_.emplace_back(soil, ClimbTable::tabulate(rover_, ground_of(parameters_of(x))));
      known = std::prev(tables_.end());
    }
    if (!known->second) return std::nullopt;
    return CuadrigaModel(parameters_of(x), *known->second);
  }

 private:
  const sim::RoverModel& rover_;
  std::deque<std::pair<std::vector<double>, std::optional<ClimbTable>>> tables_;
};

struct Leftovers {
  std::vector<LogResidual> slip, current, log_charge;
};

Leftovers leftovers_of(const CuadrigaModel& model, const std::vector<CuadrigaWindow>& windows) {
  Leftovers left;
  for (const CuadrigaWindow& w : windows) {
    const double g = w.path_gradient_rad;
    const ClimbConditions at = conditions_of(w);
    left.slip.push_back({w.log, g, w.slip_ratio - model.slip(at)});
    left.current.push_back({w.log, g, w.total_current_a - model.current_a(at)});
    left.log_charge.push_back(
        {w.log, g, std::log(w.charge_per_metre_as / model.charge_per_metre_as(at, w.wheel_speed_m_s))});
  }
  return left;
}

Result<gap::LeastSquaresFit> search(ModelSource& source, const std::vector<CuadrigaWindow>& windows,
                                    const LogScatter& slip, const LogScatter& current,
                                    const std::vector<double>& start, int starts) {
  std::vector<gap::Unknown> unknowns = cuadriga_unknowns();
  for (std::size_t k = 0; k < start.size(); ++k) unknowns[k].start = start[k];
  std::vector<std::string> logs;
  for (const CuadrigaWindow& w : windows) logs.push_back(w.log);
  const std::vector<double> slip_weights = weights_by_log(logs, slip.share_between());
  const std::vector<double> current_weights = weights_by_log(logs, current.share_between());
  const auto residuals = [&](std::span<const double> x, std::span<double> r) {
    const auto model = source.model(x);
    if (!model) return false;
    for (std::size_t k = 0; k < windows.size(); ++k) {
      const double g = windows[k].path_gradient_rad;
      const ClimbConditions at = conditions_of(windows[k]);
      const double of_slip = (windows[k].slip_ratio - model->slip(at)) / slip.std_at(g);
      const double of_current = (windows[k].total_current_a - model->current_a(at)) / current.std_at(g);
      r[2 * k] = std::sqrt(slip_weights[k]) * softened(of_slip);
      r[2 * k + 1] = std::sqrt(current_weights[k]) * softened(of_current);
    }
    return true;
  };
  NoProgress progress;
  return gap::fit_least_squares(
      unknowns, 2 * windows.size(), residuals,
      {.starts = starts, .max_iterations = 40, .tolerance = 1e-7, .relative_step = 1e-3}, progress);
}

double std_of(const CuadrigaFit& fit, const std::function<double(const CuadrigaModel&)>& prediction) {
  Eigen::VectorXd slope(static_cast<Eigen::Index>(fit.steps.size()));
  for (std::size_t k = 0; k < fit.steps.size(); ++k)
    slope[static_cast<Eigen::Index>(k)] =
        (prediction(fit.neighbours[k].second) - prediction(fit.neighbours[k].first)) / (2.0 * fit.steps[k]);
  return std::sqrt(std::max(0.0, slope.dot(fit.search.covariance * slope)));
}

}  // namespace

std::vector<gap::Unknown> cuadriga_unknowns() {
  // Wide priors for firm ground; torque per ampere and idle current have none.
  return {
      {"ln k_phi", std::log(3e6), std::log(1e6), std::log(1e8), 0.3, gap::Prior{std::log(3e6), 1.5}},
      {"net traction", 0.7, 0.65, 0.95, 0.05, gap::Prior{0.65, 0.15}},
      {"ln K", std::log(0.003), std::log(3e-4), std::log(0.01), 0.3, gap::Prior{std::log(0.01), 1.0}},
      {"torque per ampere", 10.0, 3.0, 30.0, 0.5, {}},
      {"idle current", 9.0, 0.0, 14.0, 0.5, {}},
      {"returned share", 0.0, -1.0, 1.0, 0.1, gap::Prior{0.0, 1.0}},
  };
}

CuadrigaParameters parameters_of(std::span<const double> x) {
  const double resistance = kResistance * std::exp(-x[0] / 3.0);
  return {std::exp(x[0]), std::atan(x[1] + resistance), std::exp(x[2]), x[3], x[4], x[5]};
}

Eigen::Matrix3d soil_covariance(const CuadrigaFit& fit) {
  const double resistance = kResistance * std::exp(-fit.search.estimate[0] / 3.0);
  Eigen::Matrix3d change = Eigen::Matrix3d::Identity();
  change(1, 0) = -resistance / 3.0;
  return change * fit.search.covariance.topLeftCorner<3, 3>() * change.transpose();
}

ClimbConditions conditions_of(const CuadrigaWindow& window) {
  return {window.path_gradient_rad, window.turn_rate_rad_s};
}

double CuadrigaFit::slip_std(const ClimbConditions& conditions) const {
  return std_of(*this, [&](const CuadrigaModel& m) { return m.slip(conditions); });
}

double CuadrigaFit::log_charge_std(const ClimbConditions& conditions) const {
  return std_of(*this, [&](const CuadrigaModel& m) {
    return std::log(std::max(1e-6, m.charge_per_metre_as(conditions, 1.0)));
  });
}

Result<CuadrigaFit> fit_cuadriga(const sim::RoverModel& rover, const std::vector<CuadrigaWindow>& windows) {
  std::vector<CuadrigaWindow> sound;
  for (const CuadrigaWindow& w : windows)
    if (!w.position_jumped()) sound.push_back(w);
  ModelSource source(rover);
  LogScatter slip = guessed(0.05), current = guessed(2.0);
  Result<gap::LeastSquaresFit> found = search(source, sound, slip, current, {}, kStarts);
  if (found) {
    const Leftovers left = leftovers_of(*source.model(found->estimate), sound);
    slip = measure_scatter(left.slip);
    current = measure_scatter(left.current);
    found = search(source, sound, slip, current, found->estimate, 1);
  }
  if (!found) return fail(found.error());
  const CuadrigaModel model = *source.model(found->estimate);
  const Leftovers left = leftovers_of(model, sound);
  CuadrigaFit fit{*found, model, measure_scatter(left.slip), measure_scatter(left.log_charge), {}, {}};
  const std::vector<gap::Unknown> unknowns = cuadriga_unknowns();
  for (std::size_t k = 0; k < unknowns.size(); ++k) {
    std::vector<double> below = found->estimate, above = found->estimate;
    const double step = 1e-2 * unknowns[k].step_scale;
    below[k] -= step;
    above[k] += step;
    const auto low = source.model(below), high = source.model(above);
    // The difference is one-sided where the rover does not climb on the other side of the fit.
    fit.neighbours.emplace_back(low.value_or(model), high.value_or(model));
    fit.steps.push_back(low && high ? step : 0.5 * step);
  }
  return fit;
}

}  // namespace slipway::validation
