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

// The pieces of a variable from its sorted readings: its values where there are few, else stretches of
// equally many readings, neighbours sharing the reading between them.
std::vector<Condition> pieces_of(WindowVariable variable, std::span<const double> sorted,
                                 const SliceOptions& options) {
  const std::set<double> values(sorted.begin(), sorted.end());
  std::vector<Condition> pieces;
  if (values.size() < 2) return pieces;
  if (values.size() <= static_cast<std::size_t>(options.max_values)) {
    for (const double value : values) pieces.push_back({variable, value, value});
    return pieces;
  }
  const auto count = static_cast<std::size_t>(options.pieces);
  for (std::size_t k = 0; k < count; ++k) {
    const double from = sorted[k * (sorted.size() - 1) / count];
    const double to = sorted[(k + 1) * (sorted.size() - 1) / count];
    if (pieces.empty() || pieces.back().to < to) pieces.push_back({variable, from, to});
  }
  return pieces;
}

// Slices of one variable: each piece, and the lowest and the highest of them together.
std::vector<Slice> slices_of_one(std::span<const WindowVariables> variables, WindowVariable variable,
                                 const SliceOptions& options) {
  std::vector<double> readings;
  for (const WindowVariables& of : variables) readings.push_back(rounded(variable_of(of, variable)));
  std::vector<double> sorted = readings;
  std::sort(sorted.begin(), sorted.end());
  const std::vector<Condition> pieces = pieces_of(variable, sorted, options);
  std::vector<Slice> slices;
  const auto keep = [&](double from, double to) {
    Slice slice{{{variable, from, to}}, {}};
    for (std::size_t w = 0; w < readings.size(); ++w)
      if (readings[w] >= from && readings[w] <= to) slice.windows.push_back(w);
    if (slice.windows.size() >= least_of_slice(readings.size(), options) &&
        static_cast<double>(slice.windows.size()) <= options.max_share * static_cast<double>(readings.size()))
      slices.push_back(std::move(slice));
  };
  for (const Condition& piece : pieces) keep(piece.from, piece.to);
  for (std::size_t n = 2; n < pieces.size(); ++n) {
    keep(pieces.front().from, pieces[n - 1].to);
    keep(pieces[pieces.size() - n].from, pieces.back().to);
  }
  return slices;
}

Slice both_of(const Slice& one, const Slice& other) {
  Slice both{{one.conditions[0], other.conditions[0]}, {}};
  std::set_intersection(one.windows.begin(), one.windows.end(), other.windows.begin(), other.windows.end(),
                        std::back_inserter(both.windows));
  return both;
}

}  // namespace

std::size_t least_of_slice(std::size_t windows, const SliceOptions& options) {
  const auto one_in = static_cast<std::size_t>(options.min_one_in);
  return std::max<std::size_t>(static_cast<std::size_t>(options.min_windows),
                               (windows + one_in - 1) / one_in);
}

std::vector<Slice> slices_of(std::span<const WindowVariables> variables, const SliceOptions& options) {
  std::vector<std::vector<Slice>> by_variable;
  by_variable.reserve(kWindowVariables);
  const std::size_t least = least_of_slice(variables.size(), options);
  for (int v = 0; v < kWindowVariables; ++v)
    by_variable.push_back(slices_of_one(variables, static_cast<WindowVariable>(v), options));
  std::vector<Slice> all;
  for (std::size_t a = 0; a < by_variable.size(); ++a)
    for (const Slice& one : by_variable[a]) {
      all.push_back(one);
      for (std::size_t b = a + 1; b < by_variable.size(); ++b)
        for (const Slice& other : by_variable[b])
          if (Slice both = both_of(one, other); both.windows.size() >= least) all.push_back(std::move(both));
    }
  return all;
}

}  // namespace slipway::gap
