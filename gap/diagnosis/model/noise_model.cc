#include "gap/diagnosis/model/noise_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"

namespace slipway::gap {
namespace {

using Scales = std::array<double*, kNoiseScales>;

Scales numbers_of(NoiseScales& s) {
  return {&s.stiffness, &s.friction,  &s.shear_modulus,  &s.within_drives, &s.lean_rad,      &s.load_shift_m,
          &s.slip,      &s.side_slip, &s.yaw_rate_rad_s, &s.attitude_rad,  &s.current_share, &s.sinkage_m};
}

constexpr std::array<std::string_view, kNoiseScales> kScaleNames{"the soil's stiffness",
                                                                 "the soil's friction",
                                                                 "the soil's shear modulus",
                                                                 "the soil within a drive",
                                                                 "the ground's attitude",
                                                                 "the centre of load",
                                                                 "slip",
                                                                 "side slip",
                                                                 "yaw rate",
                                                                 "attitude",
                                                                 "currents",
                                                                 "sinkage"};

}  // namespace

NoiseModel::NoiseModel(const WindowModel& model, Eigen::MatrixXd response, std::vector<double> expected,
                       std::vector<bool> used, const NoiseOptions& options)
    : model_(model),
      response_(std::move(response)),
      expected_(std::move(expected)),
      made_with_to_soil_(response_.leftCols(3)),
      made_with_expected_(expected_),
      used_(std::move(used)),
      options_(options),
      scales_(options.initial) {
  const auto windows = model.windows();
  for (std::size_t w = 0; w < windows.size(); ++w) {
    for (std::size_t i = 0; i < windows[w].observations.size(); ++i) {
      const std::size_t row = model.offset(w) + i;
      if (!used_[row]) continue;
      if (blocks_.empty() || blocks_.back().drive != windows[w].drive)
        blocks_.push_back({windows[w].drive, {}, {}});
      std::vector<WindowRows>& parts = blocks_.back().windows;
      if (parts.empty() || parts.back().window != w) parts.push_back({w, {}});
      parts.back().rows.push_back(static_cast<Eigen::Index>(row));
    }
  }
  set(scales_);
}

std::size_t NoiseModel::used_count() const {
  return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
}

void NoiseModel::respond(const Eigen::MatrixXd& to_soil, std::span<const double> expected) {
  for (Eigen::Index row = 0; row < to_soil.rows(); ++row) {
    const auto i = static_cast<std::size_t>(row);
    const bool answered = !to_soil.row(row).isZero(0.0);
    const Eigen::MatrixXd& from = answered ? to_soil : made_with_to_soil_;
    response_.row(row).head(from.cols()) = from.row(row);
    expected_[i] = answered ? expected[i] : made_with_expected_[i];
  }
}

void NoiseModel::set(const NoiseScales& scales, std::size_t threads) {
  scales_ = scales;
  deviation_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(used_.size()));
  parallel_for(blocks_.size(), threads, [&](std::size_t b) { factor(blocks_[b]); });
  log_determinant_ = 0.0;
  for (const Block& block : blocks_) log_determinant_ += block.factor.log_determinant();
}

void NoiseModel::factor(Block& block) {
  const Eigen::Vector3d deviations(scales_.stiffness, scales_.friction, scales_.shear_modulus);
  const double lean = scales_.lean_rad * scales_.lean_rad;
  const double shift = scales_.load_shift_m * scales_.load_shift_m;
  const Eigen::Vector4d of_the_map(lean, lean, shift, shift);
  const double within = scales_.within_drives * scales_.within_drives;
  block.factor = {};
  for (const WindowRows& part : block.windows) {
    const Eigen::MatrixXd g = response_(part.rows, Eigen::all);
    const Eigen::MatrixXd shared = g.leftCols(3) * deviations.asDiagonal();
    Eigen::MatrixXd own = within * shared * shared.transpose();
    own += g.rightCols(4) * of_the_map.asDiagonal() * g.rightCols(4).transpose();
    own.diagonal() += variances_of(part, scales_);
    for (std::size_t i = 0; i < part.rows.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      deviation_[part.rows[i]] = std::sqrt(own(at, at) + shared.row(at).squaredNorm());
    }
    block.factor.add(std::move(own), shared);
  }
}

std::vector<Eigen::Index> NoiseModel::rows_of(const Block& block) {
  std::vector<Eigen::Index> rows;
  for (const WindowRows& part : block.windows) rows.insert(rows.end(), part.rows.begin(), part.rows.end());
  return rows;
}

Eigen::VectorXd NoiseModel::variances_of(const WindowRows& part, const NoiseScales& scales) const {
  const DriveWindow& window = model_.windows()[part.window];
  Eigen::VectorXd variances(static_cast<Eigen::Index>(part.rows.size()));
  for (std::size_t i = 0; i < part.rows.size(); ++i) {
    const auto row = static_cast<std::size_t>(part.rows[i]);
    const Observation& o = window.observations[row - model_.offset(part.window)];
    const double over = row_of(o.channel).left_over(scales, expected_[row]);
    double& variance = variances[static_cast<Eigen::Index>(i)];
    variance = o.sensor_std * o.sensor_std + over * over;
    if (window.censored && o.channel == Channel::kSlip)
      variance += options_.censored_slip_std * options_.censored_slip_std;
  }
  return variances;
}

std::size_t NoiseModel::factor_bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_) bytes += block.factor.bytes();
  return bytes;
}

Eigen::MatrixXd NoiseModel::whiten(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (const Block& block : blocks_) {
    const std::vector<Eigen::Index> rows = rows_of(block);
    const Eigen::MatrixXd own = columns(rows, Eigen::all);
    if (!own.isZero(0.0)) white(rows, Eigen::all) = block.factor.solve(own);
  }
  return white;
}

double log_marginal(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns) {
  // One half of the symmetric product does.
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  squares.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  return log_marginal(residuals.squaredNorm(), columns.transpose() * residuals, std::move(squares));
}

double log_marginal(double residual_square, const Eigen::VectorXd& products, Eigen::MatrixXd squares) {
  squares.diagonal().array() += 1.0;
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt(squares);
  const double explained = products.dot(llt.solve(products));
  return -0.5 * (residual_square - explained) - llt.matrixLLT().diagonal().array().log().sum();
}

double NoiseModel::log_marginal_of(std::span<const Eigen::MatrixXd> own,
                                   std::vector<Eigen::MatrixXd>& squares, std::size_t threads) const {
  parallel_for(squares.size(), threads, [&](std::size_t part) {
    squares[part].setZero(own.front().cols(), own.front().cols());
    for (std::size_t b = part; b < own.size(); b += squares.size())
      squares[part].selfadjointView<Eigen::Lower>().rankUpdate(blocks_[b].factor.solve(own[b]).transpose());
  });
  for (std::size_t part = 1; part < squares.size(); ++part) squares.front() += squares[part];
  const Eigen::MatrixXd& sum = squares.front();
  const Eigen::Index columns = sum.cols() - 1;
  return log_marginal(sum(0, 0), sum.col(0).tail(columns), sum.bottomRightCorner(columns, columns));
}

double NoiseModel::log_prior() const {
  NoiseScales believed = options_.initial, now = scales_;
  const Scales from = numbers_of(believed), to = numbers_of(now);
  double sum = 0.0;
  for (int k = 0; k < kNoiseScales; ++k) sum += std::pow(std::log(*to[k] / *from[k]) / options_.prior_std, 2);
  return -0.5 * sum;
}

ScaleOffBelief NoiseModel::furthest_above_belief() const {
  NoiseScales believed = options_.initial, now = scales_;
  const Scales from = numbers_of(believed), to = numbers_of(now);
  std::size_t furthest = 0;
  for (std::size_t k = 1; k < from.size(); ++k) {
    if (from[k] == &believed.within_drives) continue;  // of the three before it, no scatter of its own
    if (*to[k] / *from[k] > *to[furthest] / *from[furthest]) furthest = k;
  }
  const double times = *to[furthest] / *from[furthest];
  return {kScaleNames[furthest], times, std::log(times) / options_.prior_std};
}

void NoiseModel::estimate(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& systematic,
                          std::size_t threads) {
  if (blocks_.empty()) return;
  NoiseScales best = scales_;
  std::vector<Eigen::MatrixXd> own;
  for (const Block& block : blocks_) {
    const std::vector<Eigen::Index> rows = rows_of(block);
    own.emplace_back(static_cast<Eigen::Index>(rows.size()), systematic.cols() + 1);
    own.back() << residuals(rows), systematic(rows, Eigen::all);
  }
  // As many sums as this whatever the number of threads, so that there is one order of summing.
  constexpr std::size_t kSums = 8;
  std::vector<Eigen::MatrixXd> squares(std::min(kSums, blocks_.size()));
  const auto score = [&](const NoiseScales& scales) {
    set(scales, threads);
    return log_marginal_of(own, squares, threads) + log_normalisation();
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
  set(best, threads);
}

}  // namespace slipway::gap
