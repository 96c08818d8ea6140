#include "gap/diagnosis/search/linear_gain.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

namespace slipway::gap {
namespace {

bool is_one_sided(const Parameter& p) {
  return p.lowest == p.neutral || p.highest == p.neutral;
}

bool on_its_side(const Parameter& p, double value) {
  return !((p.lowest == p.neutral && value < p.neutral) || (p.highest == p.neutral && value > p.neutral));
}

// The equations of some of the columns alone.
KnownColumns::Equations of_columns(const KnownColumns::Equations& all,
                                   const std::vector<Eigen::Index>& columns) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  KnownColumns::Equations some{Eigen::MatrixXd(count, count), Eigen::VectorXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index from = columns[static_cast<std::size_t>(i)];
    some.products[i] = all.products[from];
    for (Eigen::Index j = 0; j < count; ++j)
      some.squares(i, j) = all.squares(from, columns[static_cast<std::size_t>(j)]);
  }
  return some;
}

}  // namespace

KnownColumns::KnownColumns(const Eigen::VectorXd& residuals, const Eigen::MatrixXd& columns)
    : columns_(columns), left_(residuals) {
  if (columns.cols() == 0) return;
  Eigen::MatrixXd squares = Eigen::MatrixXd::Identity(columns.cols(), columns.cols());
  squares.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  factor_.compute(squares);
  left_ -= columns * factor_.solve(columns.transpose() * residuals);
}

KnownColumns::Equations KnownColumns::beside(const Eigen::MatrixXd& more) const {
  // What a few drives met is 0 in all other rows.
  Eigen::Index first = 0, end = more.rows();
  while (first < end && more.row(first).isZero(0.0)) ++first;
  while (end > first && more.row(end - 1).isZero(0.0)) --end;
  const auto own = more.middleRows(first, end - first);
  Equations equations{own.transpose() * own, own.transpose() * left_.segment(first, own.rows())};
  equations.squares.diagonal().array() += 1.0;
  if (columns_.cols() == 0) return equations;
  const Eigen::MatrixXd crossed = columns_.middleRows(first, own.rows()).transpose() * own;
  equations.squares -= crossed.transpose() * factor_.solve(crossed);
  return equations;
}

Eigen::MatrixXd spanned_by(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return columns;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

double gain_of(const KnownColumns::Equations& equations) {
  const Eigen::LLT<Eigen::MatrixXd> factor(equations.squares);
  return 0.5 * equations.products.dot(factor.solve(equations.products)) -
         factor.matrixLLT().diagonal().array().log().sum();
}

LinearGain linear_gain(const KnownColumns& known, const Eigen::MatrixXd& columns,
                       std::span<const Parameter> parameters) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) kept.push_back(c);
  LinearGain found{0.0, Eigen::VectorXd::Zero(columns.cols())};
  const KnownColumns::Equations all = known.beside(columns);
  while (!kept.empty()) {
    const KnownColumns::Equations of_kept = of_columns(all, kept);
    const Eigen::VectorXd solved = of_kept.squares.llt().solve(of_kept.products);
    std::vector<Eigen::Index> allowed;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
      if (on_its_side(p, p.neutral + p.std * solved[static_cast<Eigen::Index>(i)]))
        allowed.push_back(kept[i]);
    }
    if (allowed.size() < kept.size()) {
      kept = std::move(allowed);
      continue;
    }
    found.gain = gain_of(of_kept);
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const Parameter& p = parameters[static_cast<std::size_t>(kept[i])];
      found.estimate[kept[i]] = std::clamp(solved[static_cast<Eigen::Index>(i)],
                                           (p.lowest - p.neutral) / p.std, (p.highest - p.neutral) / p.std);
      if (is_one_sided(p)) found.gain += std::log(2.0);
    }
    break;
  }
  return found;
}

}  // namespace slipway::gap
