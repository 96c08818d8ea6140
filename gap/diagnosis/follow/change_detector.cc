#include "gap/diagnosis/follow/change_detector.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace slipway::gap {
namespace {

double log_of_sum(const std::vector<double>& values) {
  const double most = *std::max_element(values.begin(), values.end());
  if (!std::isfinite(most)) return most;
  double sum = 0.0;
  for (const double v : values) sum += std::exp(v - most);
  return most + std::log(sum);
}

}  // namespace

double start_weight(std::size_t c) {
  // Sum of 1 / (n log^2 n) from n = 2 on.
  constexpr double kSum = 2.109742801;
  const double n = static_cast<double>(c) + 1.0;
  return 1.0 / (kSum * n * std::log(n) * std::log(n));
}

ChangeDetector::ChangeDetector(ChangeOptions options, std::vector<ChangeKind> kinds)
    : options_(std::move(options)),
      kinds_(std::move(kinds)),
      log_alpha_(std::log(options_.alpha)),
      kind_shares_(kinds_.size(), 0.0) {}

double ChangeDetector::log_ratio(const Eigen::MatrixXd& information, const Eigen::VectorXd& score) const {
  std::vector<double> logs;
  for (const double size : options_.sizes) {
    Eigen::MatrixXd inner = size * size * information;
    inner.diagonal().array() += 1.0;
    const Eigen::LLT<Eigen::MatrixXd> llt(inner);
    const double explained = size * size * score.dot(llt.solve(score));
    const double ratio = 0.5 * explained - llt.matrixLLT().diagonal().array().log().sum();
    logs.push_back(options_.share * ratio);
  }
  return log_of_sum(logs) - std::log(static_cast<double>(logs.size()));
}

double ChangeDetector::add(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& known,
                           const Eigen::MatrixXd& changes, bool repeats_last) {
  if (drives_.empty()) {
    known_squares_ = Eigen::MatrixXd::Identity(known.cols(), known.cols());
    known_product_ = Eigen::VectorXd::Zero(known.cols());
  }
  known_squares_.noalias() += known.transpose() * known;
  known_product_.noalias() += known.transpose() * residuals;
  drives_.push_back(
      {known.transpose() * changes, changes.transpose() * changes, changes.transpose() * residuals});
  const Eigen::LLT<Eigen::MatrixXd> llt(known_squares_);
  const Eigen::VectorXd solved = llt.matrixL().solve(known_product_);

  const std::size_t drives = drives_.size();
  start_shares_.assign(drives, 0.0);
  if (kinds_.empty()) return log_evidence_;
  Eigen::MatrixXd crossed = Eigen::MatrixXd::Zero(known.cols(), changes.cols());
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(changes.cols(), changes.cols());
  Eigen::VectorXd product = Eigen::VectorXd::Zero(changes.cols());
  double begun = 0.0;  // of the weights: of starts that lie behind, followed or not
  std::vector<std::pair<std::size_t, double>> of_start;
  std::vector<std::vector<double>> of_kind(kinds_.size());
  for (std::size_t c = drives; c-- > 0;) {
    Drive& drive = drives_[c];
    crossed += drive.crossed;
    squares += drive.squares;
    product += drive.product;
    const double weight = start_weight(c + 1);
    begun += weight;
    if (!drive.followed) continue;
    const Eigen::MatrixXd halfway = llt.matrixL().solve(crossed);
    const Eigen::VectorXd score = product - halfway.transpose() * solved;
    std::vector<double> logs;
    for (std::size_t j = 0; j < kinds_.size(); ++j) {
      const ChangeKind& kind = kinds_[j];
      const Eigen::MatrixXd of_x = halfway.middleCols(kind.first, kind.count);
      Eigen::MatrixXd information = squares.block(kind.first, kind.first, kind.count, kind.count);
      information.noalias() -= of_x.transpose() * of_x;
      logs.push_back(std::log(weight * kind.prior) +
                     log_ratio(information, score.segment(kind.first, kind.count)));
      of_kind[j].push_back(logs.back());
    }
    of_start.emplace_back(c, log_of_sum(logs));
  }

  // What has not begun yet weighs as much as nothing.
  std::vector<double> all{std::log(std::max(std::numeric_limits<double>::min(), 1.0 - begun))};
  for (const auto& [c, log] : of_start) all.push_back(log);
  log_evidence_ = log_of_sum(all);
  if (log_evidence_ < -log_alpha_)
    above_ = 0;
  else if (above_ == 0 || !repeats_last)
    ++above_;
  for (const auto& [c, log] : of_start)
    if (c + options_.kept < drives && log < log_evidence_ + std::log(options_.forgotten))
      drives_[c].followed = false;
  start_ = std::max_element(of_start.begin(), of_start.end(), [](const auto& a, const auto& b) {
             return a.second < b.second;
           })->first;
  const double started = log_of_sum({all.begin() + 1, all.end()});
  for (const auto& [c, log] : of_start) start_shares_[c] = std::exp(log - started);
  std::vector<double> shares;
  for (const std::vector<double>& logs : of_kind) shares.push_back(log_of_sum(logs));
  const double sum = log_of_sum(shares);
  for (std::size_t j = 0; j < shares.size(); ++j) kind_shares_[j] = std::exp(shares[j] - sum);
  return log_evidence_;
}

DriveRange fewest_with(std::span<const double> shares, double part) {
  if (shares.empty()) return {};
  const auto most = static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
  DriveRange best{0, shares.size() - 1, std::accumulate(shares.begin(), shares.end(), 0.0)};
  for (std::size_t first = 0; first <= most; ++first) {
    double sum = std::accumulate(shares.begin() + static_cast<std::ptrdiff_t>(first),
                                 shares.begin() + static_cast<std::ptrdiff_t>(most), 0.0);
    for (std::size_t last = most; last < shares.size(); ++last) {
      sum += shares[last];
      if (sum < part) continue;
      const std::size_t length = last - first, least = best.last - best.first;
      if (length < least || (length == least && sum > best.share)) best = {first, last, sum};
      break;
    }
  }
  return best;
}

}  // namespace slipway::gap
