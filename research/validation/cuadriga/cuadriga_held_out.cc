#include "research/validation/cuadriga/cuadriga_held_out.h"

#include <Eigen/QR>
#include <cmath>
#include <optional>

#include "core/parallel_for.h"

namespace slipway::validation {
namespace {

std::vector<CuadrigaWindow> outside_fold(const std::vector<CuadrigaWindow>& windows,
                                         const std::vector<int>& fold_of, int fold) {
  std::vector<CuadrigaWindow> others;
  for (std::size_t k = 0; k < windows.size(); ++k)
    if (fold_of[k] != fold) others.push_back(windows[k]);
  return others;
}

Simple simple_at(const Baselines& baselines, const CuadrigaWindow& window) {
  const double gradient = window.path_gradient_rad, turn = std::abs(window.turn_rate_rad_s);
  return {baselines.mean, baselines.line.dot(Eigen::Vector2d(1.0, gradient)),
          baselines.plane.dot(Eigen::Vector3d(1.0, gradient, turn))};
}

}  // namespace

Prediction predict_slip(const CuadrigaFit& fit, const ClimbConditions& conditions) {
  const PredictiveOffsets o = offsets_at(fit.slip, conditions.gradient_rad, fit.slip_std(conditions));
  const double slip = fit.model.slip(conditions);
  return {slip + o.median, slip + o.low_50, slip + o.high_50, slip + o.low_90, slip + o.high_90};
}

Prediction predict_charge(const CuadrigaFit& fit, const ClimbConditions& conditions, double wheel_speed_m_s) {
  const PredictiveOffsets o =
      offsets_at(fit.log_charge, conditions.gradient_rad, fit.log_charge_std(conditions));
  const double charge = fit.model.charge_per_metre_as(conditions, wheel_speed_m_s);
  return {charge * std::exp(o.median), charge * std::exp(o.low_50), charge * std::exp(o.high_50),
          charge * std::exp(o.low_90), charge * std::exp(o.high_90)};
}

Baselines baselines_of(const std::vector<CuadrigaWindow>& windows, double CuadrigaWindow::*quantity) {
  Eigen::MatrixXd known(windows.size(), 3);
  Eigen::VectorXd values(windows.size());
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    known.row(row) << 1.0, windows[k].path_gradient_rad, std::abs(windows[k].turn_rate_rad_s);
    values[row] = windows[k].*quantity;
  }
  return {values.mean(), known.leftCols<2>().colPivHouseholderQr().solve(values),
          known.colPivHouseholderQr().solve(values)};
}

Result<CrossValidation> cross_validate(const sim::RoverModel& rover,
                                       const std::vector<CuadrigaWindow>& windows, int folds) {
  std::vector<std::string> logs;
  for (const CuadrigaWindow& w : windows) logs.push_back(w.log);
  const std::vector<int> fold_of = folds_by_log(logs, folds);
  // The last fit, after those of the folds, leaves nothing out.
  std::vector<std::optional<Result<CuadrigaFit>>> fits(static_cast<std::size_t>(folds) + 1);
  parallel_for(fits.size(), 0, [&](std::size_t fold) {
    fits[fold] = fit_cuadriga(rover, outside_fold(windows, fold_of, static_cast<int>(fold)));
  });
  for (const auto& fit : fits)
    if (!*fit) return fail(fit->error());
  CrossValidation answer{{}, {}, **fits.back()};
  std::vector<Baselines> slips, charges;
  for (int fold = 0; fold < folds; ++fold) {
    answer.fits.push_back(**fits[static_cast<std::size_t>(fold)]);
    std::vector<CuadrigaWindow> others = outside_fold(windows, fold_of, fold);
    std::erase_if(others, [](const CuadrigaWindow& w) { return w.position_jumped(); });
    slips.push_back(baselines_of(others, &CuadrigaWindow::slip_ratio));
    charges.push_back(baselines_of(others, &CuadrigaWindow::charge_per_metre_as));
  }
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const CuadrigaWindow& w = windows[k];
    const auto fold = static_cast<std::size_t>(fold_of[k]);
    const CuadrigaFit& fit = answer.fits[fold];
    answer.windows.push_back({w, fold_of[k], predict_slip(fit, conditions_of(w)),
                              predict_charge(fit, conditions_of(w), w.wheel_speed_m_s),
                              simple_at(slips[fold], w), simple_at(charges[fold], w)});
  }
  return answer;
}

}  // namespace slipway::validation
