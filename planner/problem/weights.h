#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "planner/problem/cost_catalogue.h"

namespace slipway::planner {

// One weight for each row of a cost catalogue, and with them what a drive costs. The rows must outlive it, as
// those of a catalogue do.
class Weights {
 public:
  // Each row's weight at its initial value.
  Weights() : Weights(cost_catalogue()) {}
  explicit Weights(std::span<const CostTerm> terms);

  std::span<const CostTerm> terms() const { return terms_; }
  double operator[](std::size_t row) const { return values_[row]; }
  double& operator[](std::size_t row) { return values_[row]; }
  // By the term's name; 0 of a term that the catalogue doesn't have.
  double of(std::string_view term) const;
  // Leaves everything as it is where the catalogue doesn't have the term.
  void set(std::string_view term, double weight);

  // The sum over rows of weight times value.
  double cost(const DriveFigures& figures) const;

 private:
  std::span<const CostTerm> terms_;
  std::vector<double> values_;
};

}  // namespace slipway::planner
