#include "gap/diagnosis/describe/slices.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace slipway::gap {
namespace {

// Two readings that differ by less are the same value.
double rounded(double value) {
  return std::round(1e4 * value) / 1e4;
}

}  // namespace

std::size_t least_of_slice(std::size_t windows) {
  return std::max<std::size_t>(3, (windows + 19) / 20);
}

std::vector<Slice> slices_of(std::span<const WindowVariables> variables) {
  std::vector<std::vector<Slice>> by_variable;
  const std::size_t least = least_of_slice(variables.size());
  for (int v = 0; v < kWindowVariables; ++v) {
    std::vector<double> sorted;
    for (const WindowVariables& of : variables) sorted.push_back(rounded(variable_of(of, v)));
    std::sort(sorted.begin(), sorted.end());
    const std::set<double> values(sorted.begin(), sorted.end());
    if (values.size() < 2) continue;
    std::vector<Condition> pieces;
    if (values.size() <= 6) {
      for (const double value : values) pieces.push_back({variable_name(v), value, value});
    } else {
      constexpr int kPieces = 5;
      for (int k = 0; k < kPieces; ++k) {
        const double from = sorted[k * (sorted.size() - 1) / kPieces];
        const double to = sorted[(k + 1) * (sorted.size() - 1) / kPieces];
        if (pieces.empty() || pieces.back().to < to) pieces.push_back({variable_name(v), from, to});
      }
    }
    by_variable.emplace_back();
    const auto keep = [&](double from, double to) {
      Slice slice{{{variable_name(v), from, to}}, {}};
      for (std::size_t w = 0; w < variables.size(); ++w) {
        const double value = rounded(variable_of(variables[w], v));
        if (value >= from && value <= to) slice.windows.push_back(w);
      }
      if (slice.windows.size() >= least && 4 * slice.windows.size() <= 3 * variables.size())
        by_variable.back().push_back(std::move(slice));
    };
    for (const Condition& piece : pieces) keep(piece.from, piece.to);
    for (std::size_t n = 2; n < pieces.size(); ++n) {
      keep(pieces.front().from, pieces[n - 1].to);
      keep(pieces[pieces.size() - n].from, pieces.back().to);
    }
  }
  std::vector<Slice> all;
  for (std::size_t a = 0; a < by_variable.size(); ++a) {
    for (const Slice& one : by_variable[a]) {
      all.push_back(one);
      for (std::size_t b = a + 1; b < by_variable.size(); ++b)
        for (const Slice& other : by_variable[b]) {
          Slice both{{one.conditions[0], other.conditions[0]}, {}};
          std::set_intersection(one.windows.begin(), one.windows.end(), other.windows.begin(),
                                other.windows.end(), std::back_inserter(both.windows));
          if (both.windows.size() >= least) all.push_back(std::move(both));
        }
    }
  }
  return all;
}

}  // namespace slipway::gap
