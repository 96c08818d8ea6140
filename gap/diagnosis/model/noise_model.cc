#include "gap/diagnosis/model/noise_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace slipway::gap {
namespace {

using Scales = std::array<double*, kNoiseScales>;

Scales numbers_of(NoiseScales& s) {
  return {&s.stiffness, &s.friction,  &s.shear_modulus,  &s.within_drives, &s.lean_rad,      &s.load_shift_m,
          &s.slip,      &s.side_slip, &s.yaw_rate_rad_s, &s.attitude_rad,  &s.current_share, &s.sinkage_m};
}

}  // namespace

NoiseModel::NoiseModel(const WindowModel& model, Eigen::MatrixXd response, std::vector<double> expected,
                       std::vector<bool> used, const NoiseOptions& options)
    : model_(model),
      response_(std::move(response)),
      expected_(std::move(expected)),
      used_(std::move(used)),
      options_(options),
      scales_(options.initial) {
  const auto windows = model.windows();
  for (std::size_t w = 0; w < windows.size(); ++w) {
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i) {
      const std::size_t row = model.offset(w) + i;
      if (!used_[row]) continue;
      if (blocks_.empty() || blocks_.back().drive != windows[w].drive)
        blocks_.push_back({windows[w].drive, {}, {}, {}});
      blocks_.back().rows.push_back(static_cast<Eigen::Index>(row));
      blocks_.back().window.push_back(w);
    }
  }
  set(scales_);
}

std::size_t NoiseModel::used_count() const {
  return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
}

void NoiseModel::set(const NoiseScales& scales) {
  scales_ = scales;
  const Eigen::Vector3d variances(scales.stiffness * scales.stiffness, scales.friction * scales.friction,
                                  scales.shear_modulus * scales.shear_modulus);
  const double lean = scales.lean_rad * scales.lean_rad, shift = scales.load_shift_m * scales.load_shift_m;
  const Eigen::Vector4d of_the_map(lean, lean, shift, shift);
  const double within = scales.within_drives * scales.within_drives;
  log_determinant_ = 0.0;
  deviation_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(used_.size()));
  const auto windows = model_.windows();
  for (Block& block : blocks_) {
    const auto n = static_cast<Eigen::Index>(block.rows.size());
    const Eigen::MatrixXd g = response_(block.rows, Eigen::all);
    const Eigen::MatrixXd soil = g.leftCols(3) * variances.asDiagonal() * g.leftCols(3).transpose();
    const Eigen::MatrixXd map = g.rightCols(4) * of_the_map.asDiagonal() * g.rightCols(4).transpose();
    Eigen::MatrixXd v = soil;
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < n; ++b)
        if (block.window[static_cast<std::size_t>(a)] == block.window[static_cast<std::size_t>(b)])
          v(a, b) += within * soil(a, b) + map(a, b);
    for (Eigen::Index a = 0; a < n; ++a) {
      const auto row = static_cast<std::size_t>(block.rows[static_cast<std::size_t>(a)]);
      const std::size_t w = block.window[static_cast<std::size_t>(a)];
      const Observation& o = windows[w].observations[row - model_.offset(w)];
      const double over = row_of(o.channel).left_over(scales, expected_[row]);
      v(a, a) += o.sensor_std * o.sensor_std + over * over;
      if (windows[w].censored && o.channel == Channel::kSlip)
        v(a, a) += options_.censored_slip_std * options_.censored_slip_std;
      deviation_[static_cast<Eigen::Index>(row)] = std::sqrt(v(a, a));
    }
    block.factor = v.llt().matrixL();
    log_determinant_ += 2.0 * block.factor.diagonal().array().log().sum();
  }
}

Eigen::MatrixXd NoiseModel::whiten(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (const Block& block : blocks_) {
    const Eigen::MatrixXd part = columns(block.rows, Eigen::all);
    const Eigen::MatrixXd solved = block.factor.triangularView<Eigen::Lower>().solve(part);
    for (std::size_t i = 0; i < block.rows.size(); ++i)
      white.row(block.rows[i]) = solved.row(static_cast<Eigen::Index>(i));
  }
  return white;
}

double log_marginal(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd inner = columns.transpose() * columns;
  inner.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd> llt(inner);
  const Eigen::VectorXd projected = columns.transpose() * residuals;
  const double explained = projected.dot(llt.solve(projected));
  const double log_det = 2.0 * llt.matrixLLT().diagonal().array().log().sum();
  return -0.5 * (residuals.squaredNorm() - explained) - 0.5 * log_det;
}

void NoiseModel::estimate(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& systematic) {
  NoiseScales initial = options_.initial;
  const Scales believed = numbers_of(initial);
  NoiseScales best = scales_;
  Eigen::MatrixXd both(residuals.size(), systematic.cols() + 1);
  both << residuals, systematic;
  const auto score = [&](const NoiseScales& scales) {
    set(scales);
    const Eigen::MatrixXd white = whiten(both);
    NoiseScales copy = scales;
    const Scales numbers = numbers_of(copy);
    double prior = 0.0;
    for (int k = 0; k < kNoiseScales; ++k)
      prior += std::pow(std::log(*numbers[k] / *believed[k]) / options_.prior_std, 2);
    return log_marginal(white.col(0), white.rightCols(systematic.cols())) - 0.5 * log_determinant_ -
           0.5 * prior;
  };
  double value = score(best);
  for (const double step : {1.0, 0.5, 0.25}) {
    for (int sweep = 0; sweep < 3; ++sweep) {
      bool better = false;
      for (int k = 0; k < kNoiseScales; ++k) {
        if (model_.cancelled()) return;
        for (const double sign : {1.0, -1.0}) {
          NoiseScales trial = best;
          *numbers_of(trial)[k] *= std::exp(sign * step);
          const double v = score(trial);
          if (v <= value) continue;
          value = v;
          best = trial;
          better = true;
          break;
        }
      }
      if (!better) break;
    }
  }
  set(best);
}

}  // namespace slipway::gap
