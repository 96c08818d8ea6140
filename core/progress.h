#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace slipway {

// The best route that a search has found so far.
struct RouteSoFar {
  double cost = 0.0;  // by which it is the best: the search's own, or of the simulation once it has a verdict
  double length_m = 0.0;
  std::string verdict;                        // "go", "no_go", "unknown"; empty before it was simulated
  std::vector<std::array<double, 2>> line_m;  // x, y; a few hundred places at the most
};

// Through this a long computation reports its progress and learns that it was cancelled. Implementations must
// be thread-safe, since worker threads call report() and cancelled(). A computation asks cancelled() at least
// every 100 ms.
class Progress {
 public:
  virtual ~Progress() = default;
  // stage is a short phrase ("proposing routes"); fraction is the share of the whole work that is done, in
  // [0, 1].
  virtual void report(std::string_view stage, double fraction) = 0;
  virtual bool cancelled() const = 0;
  // What there would be if the work ended now. It may be called from several threads.
  virtual void found(const RouteSoFar& /*route*/) {}
};

// For callers that need no reports and never cancel.
class NoProgress final : public Progress {
 public:
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return false; }
};

}  // namespace slipway
