#include "api/files/campaign/best_assignment.h"

#include <limits>

namespace slipway::api {
namespace {

// Rows and columns are numbered from 1 here: column 0 stands for the row that is being placed.
class Assignment {
 public:
  explicit Assignment(const std::vector<std::vector<double>>& costs)
      : costs_(costs), n_(costs.size()), of_row_(n_ + 1, 0.0), of_column_(n_ + 1, 0.0), row_at_(n_ + 1, 0U) {}

  std::vector<std::size_t> solve() {
    for (std::size_t row = 1; row <= n_; ++row) place(row);
    std::vector<std::size_t> columns(n_);
    for (std::size_t column = 1; column <= n_; ++column) columns[row_at_[column] - 1] = column - 1;
    return columns;
  }

 private:
  void place(std::size_t row) {
    std::vector<double> least(n_ + 1, std::numeric_limits<double>::infinity());
    std::vector<std::size_t> from(n_ + 1, 0U);
    std::vector<bool> reached(n_ + 1, false);
    row_at_[0] = row;
    std::size_t at = 0;
    while (row_at_[at] != 0) {
      reached[at] = true;
      std::size_t next = 0;
      double step = std::numeric_limits<double>::infinity();
      for (std::size_t column = 1; column <= n_; ++column) {
        if (reached[column]) continue;
        const std::size_t r = row_at_[at];
        const double cost = costs_[r - 1][column - 1] - of_row_[r] - of_column_[column];
        if (cost < least[column]) {
          least[column] = cost;
          from[column] = at;
        }
        if (least[column] < step) {
          step = least[column];
          next = column;
        }
      }
      for (std::size_t column = 0; column <= n_; ++column) {
        if (reached[column]) {
          of_row_[row_at_[column]] += step;
          of_column_[column] -= step;
        } else {
          least[column] -= step;
        }
      }
      at = next;
    }
    for (; at != 0; at = from[at]) row_at_[at] = row_at_[from[at]];
  }

  const std::vector<std::vector<double>>& costs_;
  std::size_t n_;
  std::vector<double> of_row_, of_column_;  // prices, which keep costs less both at 0 or more
  std::vector<std::size_t> row_at_;         // by column; 0 where there is none
};

}  // namespace

std::vector<std::size_t> best_assignment(const std::vector<std::vector<double>>& costs) {
  return Assignment(costs).solve();
}

}  // namespace slipway::api
