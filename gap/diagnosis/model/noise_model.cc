#include "gap/diagnosis/model/noise_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/parallel_for.h"
#include "gap/diagnosis/model/scatter_likelihood.h"

namespace slipway::gap {
namespace {

// How far the logarithms of scales lie from what is believed of them, in the order of NoiseScales.
Eigen::VectorXd from_belief(NoiseScales scales, NoiseScales believed) {
  const auto to = numbers_of(scales), from = numbers_of(believed);
  Eigen::VectorXd off(kNoiseScales);
  for (int k = 0; k < kNoiseScales; ++k) off[k] = std::log(*to[k] / *from[k]);
  return off;
}

NoiseScales moved(NoiseScales scales, const Eigen::VectorXd& step) {
  const auto numbers = numbers_of(scales);
  for (int k = 0; k < kNoiseScales; ++k) *numbers[k] *= std::exp(step[k]);
  return scales;
}

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
  parallel_for(blocks_.size(), threads, [&](std::size_t b) { make_whitening(blocks_[b]); });
  log_determinant_ = 0.0;
  for (const Block& block : blocks_) log_determinant_ += block.whitening.log_determinant();
}

void NoiseModel::make_whitening(Block& block) {
  const Eigen::Vector3d deviations(scales_.stiffness, scales_.friction, scales_.shear_modulus);
  const double lean = scales_.lean_rad * scales_.lean_rad;
  const double shift = scales_.load_shift_m * scales_.load_shift_m;
  const Eigen::Vector4d of_the_map(lean, lean, shift, shift);
  const double within = scales_.within_drives * scales_.within_drives;
  block.whitening = {};
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
    block.whitening.add(std::move(own), shared);
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

std::size_t NoiseModel::whitening_bytes() const {
  std::size_t bytes = 0;
  for (const Block& block : blocks_) bytes += block.whitening.bytes();
  return bytes;
}

Eigen::MatrixXd NoiseModel::whiten(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  for (const Block& block : blocks_) {
    const std::vector<Eigen::Index> rows = rows_of(block);
    const Eigen::MatrixXd own = columns(rows, Eigen::all);
    if (!own.isZero(0.0)) white(rows, Eigen::all) = block.whitening.whiten(own);
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

double NoiseModel::log_prior(const NoiseScales& scales) const {
  return -0.5 * from_belief(scales, options_.initial).squaredNorm() /
         (options_.prior_std * options_.prior_std);
}

Eigen::VectorXd NoiseModel::deviations_above_belief() const {
  Eigen::VectorXd off = from_belief(scales_, options_.initial) / options_.prior_std;
  off[kWithinScale] = std::min(0.0, off.minCoeff());
  return off;
}

ScatterLikelihood NoiseModel::likelihood_of(const Eigen::VectorXd& residuals,
                                            const Eigen::MatrixXd& systematic, std::size_t threads) const {
  std::vector<ScatterLikelihood::Drive> drives;
  for (const Block& block : blocks_) {
    ScatterLikelihood::Drive& drive = drives.emplace_back();
    for (const WindowRows& part : block.windows) {
      Eigen::MatrixXd columns(static_cast<Eigen::Index>(part.rows.size()), systematic.cols() + 1);
      columns << residuals(part.rows), systematic(part.rows, Eigen::all);
      drive.windows.push_back({response_(part.rows, Eigen::all), std::move(columns),
                               [this, &part](const NoiseScales& s) { return variances_of(part, s); }});
    }
  }
  return ScatterLikelihood(std::move(drives), threads);
}

void NoiseModel::estimate(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& systematic,
                          std::size_t threads) {
  if (blocks_.empty()) return;
  ScatterLikelihood likelihood = likelihood_of(residuals, systematic, threads);
  const auto probability = [&](const NoiseScales& scales) {
    return likelihood.at(scales) + log_prior(scales);
  };
  const double prior_precision = 1.0 / (options_.prior_std * options_.prior_std);
  NoiseScales best = scales_;
  double value = probability(best);
  constexpr int kMaxSteps = 30, kMaxHalvings = 6;
  constexpr double kNoGain = 1e-3;   // of the logarithm of the probability
  constexpr double kFarthest = 1.0;  // of a scale's logarithm in one step
  for (int i = 0; i < kMaxSteps; ++i) {
    const ScatterLikelihood::Slope slope = likelihood.slope();
    const Eigen::VectorXd gradient = slope.by_scale - prior_precision * from_belief(best, options_.initial);
    Eigen::MatrixXd information = slope.information;
    information.diagonal().array() += prior_precision;
    Eigen::VectorXd step = information.ldlt().solve(gradient);
    if (0.5 * gradient.dot(step) < kNoGain) break;
    step *= std::min(1.0, kFarthest / step.cwiseAbs().maxCoeff());
    bool better = false;
    for (int halving = 0; halving < kMaxHalvings && !better; ++halving, step *= 0.5) {
      if (model_.cancelled()) return;
      const NoiseScales trial = moved(best, step);
      const double v = probability(trial);
      if (v <= value) continue;
      value = v;
      best = trial;
      better = true;
    }
    if (!better) break;
  }
  set(best, threads);
}

}  // namespace slipway::gap
