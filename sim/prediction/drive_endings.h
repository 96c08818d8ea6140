#pragma once

#include <functional>
#include <vector>

#include "sim/prediction/drawn_drive.h"

namespace slipway::sim {

// Wilson's interval for a share of n draws, at 90 % [Wilson 1927]; of three cases or fewer its lower end is
// Poisson's, since Wilson's is too high there [Brown, Cai & DasGupta 2001, section 4.1.1].
DrawnShare share_of_draws(double share, double n);

// The segments of a drive: one, the whole way, where segment_m is 0. The last may be half as long again as
// the others. There must be a station; the stations must outlive it.
class Segments {
 public:
  Segments(const std::vector<PreparedStation>& stations, double segment_m);

  std::size_t count() const { return count_; }
  double from_m(std::size_t segment) const { return segment_m_ * static_cast<double>(segment); }
  double to_m(std::size_t segment) const;
  // How a drive ends on each segment; as many as it comes to.
  std::vector<DriveEnding> endings(const DriveOutcome& outcome) const;
  // Calls f(station, embeds) for the first halt on each segment and for the embedding that follows there.
  void for_each_deciding(const DriveOutcome& outcome, const std::function<void(std::size_t, bool)>& f) const;

 private:
  std::size_t segment_of(const OutcomeEvent& event) const;

  const std::vector<PreparedStation>& stations_;
  double segment_m_, length_m_;
  std::size_t count_ = 1;
};

// Sums of how weighted draws end.
class EndingSums {
 public:
  void add(double weight, const DriveEnding& ending, bool unsolved);
  double weight() const { return weight_; }
  double stopped() const { return stopped_; }
  double embedded() const { return embedded_; }
  // As of `scale` times as many draws. Nothing is known without a draw: 0, between 0 and 1.
  OutcomeShares shares(double scale = 1.0) const;

 private:
  double weight_ = 0.0, squares_ = 0.0;
  double stopped_ = 0.0, immobilised_ = 0.0, embedded_ = 0.0;
  double unsolved_ = 0.0;  // of those that come to their end
};

// The shares of each segment, of the draws that come to it.
std::vector<SegmentRisk> segment_risks(const std::vector<DrawnDrive>& drives, const Segments& segments);

}  // namespace slipway::sim
