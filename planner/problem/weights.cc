#include "planner/problem/weights.h"

namespace slipway::planner {

Weights::Weights(std::span<const CostTerm> terms) : terms_(terms) {
  for (const CostTerm& term : terms_) values_.push_back(term.weight.initial);
}

double Weights::of(std::string_view term) const {
  for (std::size_t row = 0; row < terms_.size(); ++row)
    if (terms_[row].name == term) return values_[row];
  return 0.0;
}

void Weights::set(std::string_view term, double weight) {
  for (std::size_t row = 0; row < terms_.size(); ++row)
    if (terms_[row].name == term) values_[row] = weight;
}

double Weights::cost(const DriveFigures& figures) const {
  double sum = 0.0;
  for (std::size_t row = 0; row < terms_.size(); ++row) sum += values_[row] * terms_[row].value(figures);
  return sum;
}

}  // namespace slipway::planner
