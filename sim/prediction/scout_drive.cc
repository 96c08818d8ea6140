#include "sim/prediction/scout_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/prediction/drawn_statistics.h"
#include "sim/prediction/telemetry.h"

namespace slipway::sim {
namespace {

// The first and last slip that has a bin of its own between the open ones at the ends.
constexpr double kLowestSlip = -0.3, kHighestSlip = 1.1;
// As many as a check takes at most.
constexpr double kDrawsAfterwards = 1000.0;
// Of the ground that decides: as many sections are looked at.
constexpr std::size_t kMaxSections = 4;

double normal_share_below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// Stations from `first` to before `end`.
struct Section {
  std::size_t first = 0, end = 0;
  double wrong = 0.0;
};

const GroundRisk* deciding_ground(const DriveOutcomes& outcomes) {
  const auto wrong = [](const GroundRisk& ground) { return ground.expected_stops + ground.embedding; };
  const auto worst =
      std::max_element(outcomes.grounds.begin(), outcomes.grounds.end(),
                       [&](const GroundRisk& a, const GroundRisk& b) { return wrong(a) < wrong(b); });
  return worst == outcomes.grounds.end() || wrong(*worst) <= 0.0 ? nullptr : &*worst;
}

class ScoutSearch {
 public:
  ScoutSearch(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
              const SoilBeliefs& beliefs, const OutcomeBars& bars, std::optional<std::size_t> soil)
      : drives_(drives), stations_(stations), bars_(bars), soil_(soil), wrong_(stations.size(), 0.0) {
    slip_error_ = unresolved_slip_error(beliefs.of(soil));
    for (const DrawnDrive& drive : drives)
      if (const DriveEnding ending = drive.outcome.ending(); ending.halt)
        wrong_[ending.halt->station] += drive.weight;
  }

  std::optional<ScoutDrive> best() const {
    std::optional<ScoutDrive> best;
    for (const Section& section : sections()) {
      std::vector<std::size_t> firsts{section.first};
      const std::size_t worst = worst_place(section);
      if (worst != section.first) firsts.push_back(worst);
      for (const std::size_t first : firsts) {
        const std::size_t end = end_of_scout(first, section.end);
        if (stations_[end - 1].distance_m <= stations_[first].distance_m) continue;
        const ScoutDrive scout = judge(first, end);
        if (!best || scout.worth_sols > best->worth_sols) best = scout;
      }
    }
    return best;
  }

 private:
  // Those on which most goes wrong, in the order of the way.
  std::vector<Section> sections() const {
    std::vector<Section> all;
    for (std::size_t s = 0; s < stations_.size(); ++s) {
      if (ground_of(stations_[s]) != soil_) continue;
      if (all.empty() || all.back().end != s) all.push_back({s, s, 0.0});
      all.back().end = s + 1;
      all.back().wrong += wrong_[s];
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Section& a, const Section& b) { return a.wrong > b.wrong; });
    if (all.size() > kMaxSections) all.resize(kMaxSections);
    std::stable_sort(all.begin(), all.end(),
                     [](const Section& a, const Section& b) { return a.first < b.first; });
    return all;
  }

  std::size_t end_of_scout(std::size_t first, std::size_t end) const {
    std::size_t last = first;
    while (last + 1 < end && stations_[last].distance_m - stations_[first].distance_m < kScoutLength_m)
      ++last;
    return last + 1;
  }

  // The beginning of the scout drive that meets most of what goes wrong.
  std::size_t worst_place(const Section& section) const {
    std::size_t best = section.first;
    double most = -1.0;
    for (std::size_t first = section.first; first < section.end; ++first) {
      double sum = 0.0;
      const std::size_t end = end_of_scout(first, section.end);
      for (std::size_t s = first; s < end; ++s) sum += wrong_[s];
      if (sum <= most) continue;
      most = sum;
      best = first;
    }
    return best;
  }

  // The slip of a draw between two stations; 1 beyond where the ground holds the rover.
  double slip_of(const DrawnDrive& drive, std::size_t first, std::size_t end) const {
    double come_m = 0.0, rolled_m = 0.0;
    for (std::size_t s = first + 1; s < end; ++s) {
      const double slip = s < drive.slip.size() ? static_cast<double>(drive.slip[s]) : 1.0;
      come_m += stations_[s].drive_m;
      rolled_m += stations_[s].drive_m / (1.0 - std::min(slip, 0.999));
    }
    return 1.0 - come_m / rolled_m;
  }

  ScoutDrive judge(std::size_t first, std::size_t end) const {
    ScoutDrive scout;
    scout.soil = soil_;
    scout.from_m = stations_[first].distance_m;
    scout.to_m = stations_[end - 1].distance_m;
    scout.from = stations_[first].pose;
    scout.slip_error = slip_error_;
    std::vector<std::pair<double, double>> slips;
    double all = 0.0;
    for (const DrawnDrive& drive : drives_) {
      // Along long ways the states of the first draws alone are kept.
      if (drive.slip.empty()) break;
      scout.drawn_slip.push_back(static_cast<float>(slip_of(drive, first, end)));
      slips.emplace_back(scout.drawn_slip.back(), drive.weight);
      all += drive.weight;
      const DriveEnding ending = drive.outcome.ending();
      if (!ending.halt || ending.halt->station < first || ending.halt->station >= end) continue;
      scout.expected_stops += drive.weight;
      if (ending.embedded) scout.embedding += drive.weight;
    }
    if (all <= 0.0) return scout;
    scout.embedding /= all;
    scout.expected_stops /= all;
    scout.slip_ratio = spread_of(slips);
    weigh(all, scout);
    return scout;
  }

  void weigh(double all, ScoutDrive& scout) const {
    EndingSums before;
    std::array<EndingSums, kSlipBins> after;
    for (std::size_t d = 0; d < scout.drawn_slip.size(); ++d) {
      const double weight = drives_[d].weight / all;
      const DriveEnding ending = drives_[d].outcome.ending();
      before.add(weight, ending, drives_[d].unsolved);
      const auto shares = measured_shares(scout.drawn_slip[d], scout.slip_error, scout.to_m - scout.from_m);
      for (std::size_t bin = 0; bin < kSlipBins; ++bin)
        after[bin].add(weight * shares[bin], ending, drives_[d].unsolved);
    }
    const double scale = kDrawsAfterwards / static_cast<double>(scout.drawn_slip.size());
    scout.worth_sols = cost(before);
    for (const EndingSums& sums : after) {
      if (sums.weight() <= 0.0) continue;
      scout.worth_sols -= cost(sums);
      const OutcomeShares then = sums.shares(scale);
      if (bars_.are_kept(then))
        scout.go += sums.weight();
      else if (bars_.are_passed(then))
        scout.no_go += sums.weight();
    }
    scout.worth_sols = std::max(0.0, scout.worth_sols);  // rounding
  }

  // Of the better of driving and not driving, times the weight of the sums. To turn back costs as much as a
  // drive that is as likely to halt as not.
  double cost(const EndingSums& sums) const {
    const double of_embedding = bars_.no_go_stop / bars_.max_embedding;
    return std::min(sums.stopped() + of_embedding * sums.embedded(), bars_.no_go_stop * sums.weight());
  }

  const std::vector<DrawnDrive>& drives_;
  const std::vector<PreparedStation>& stations_;
  const OutcomeBars& bars_;
  std::optional<std::size_t> soil_;
  double slip_error_ = 0.0;
  std::vector<double> wrong_;  // by station
};

}  // namespace

std::optional<ScoutDrive> scout_drive(const std::vector<DrawnDrive>& drives,
                                      const std::vector<PreparedStation>& stations,
                                      const SoilBeliefs& beliefs, const DriveOutcomes& outcomes,
                                      const OutcomeBars& bars) {
  const GroundRisk* const ground = deciding_ground(outcomes);
  if (ground == nullptr) return std::nullopt;
  return ScoutSearch(drives, stations, beliefs, bars, ground->soil).best();
}

std::array<double, kSlipBins> measured_shares(double drawn_slip, double slip_error, double length_m) {
  const TelemetryErrors errors;
  const double sd = slip_deviation(drawn_slip, slip_error, length_m, errors.position_m);
  std::array<double, kSlipBins> shares{};
  double below = 0.0;
  for (std::size_t bin = 0; bin < kSlipBins; ++bin) {
    const double top = kLowestSlip + (kHighestSlip - kLowestSlip) * static_cast<double>(bin + 1) / kSlipBins;
    const double next = bin + 1 == kSlipBins ? 1.0 : normal_share_below((top - drawn_slip) / sd);
    shares[bin] = (1.0 - errors.model_error) * (next - below) + errors.model_error / kSlipBins;
    below = next;
  }
  return shares;
}

}  // namespace slipway::sim
