#include "sim/prediction/drive_endings.h"

#include <algorithm>
#include <cmath>

#include "core/normal_interval.h"

namespace slipway::sim {

namespace {

// Of a Poisson count so small the mean of which it is the 90th percentile, by Wilson and Hilferty's cube
// root.
double least_mean(double count) {
  constexpr double kReach80 = 1.2815515655446004;
  if (count <= 0.0) return 0.0;
  const double root = 1.0 - 1.0 / (9.0 * count) - kReach80 / (3.0 * std::sqrt(count));
  return root <= 0.0 ? 0.0 : count * root * root * root;
}

}  // namespace

DrawnShare share_of_draws(double share, double n) {
  constexpr double z = kReach90;
  constexpr double kFew = 3.5;
  const double p = std::clamp(share, 0.0, 1.0);
  const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  double low = std::max(0.0, centre - half);
  if (p * n < kFew) low = std::min(low, least_mean(p * n) / n);
  return {p, low, std::min(1.0, centre + half)};
}

Segments::Segments(const std::vector<PreparedStation>& stations, double segment_m)
    : stations_(stations), segment_m_(segment_m), length_m_(stations.back().distance_m) {
  if (segment_m <= 0.0) return;
  count_ = static_cast<std::size_t>(std::max(1.0, std::floor(length_m_ / segment_m + 0.5)));
}

double Segments::to_m(std::size_t segment) const {
  return segment + 1 == count_ ? length_m_ : from_m(segment + 1);
}

std::size_t Segments::segment_of(const OutcomeEvent& event) const {
  if (count_ == 1) return 0;
  return std::min(count_ - 1, static_cast<std::size_t>(stations_[event.station].distance_m / segment_m_));
}

std::vector<DriveEnding> Segments::endings(const DriveOutcome& outcome) const {
  std::vector<DriveEnding> endings;
  std::size_t next = 0;
  for (std::size_t segment = 0; segment < count_; ++segment) {
    const std::size_t first = next;
    while (next < outcome.events.size() && segment_of(outcome.events[next]) == segment) ++next;
    endings.push_back(outcome.ending(first, next));
    // What comes behind an embedding is not driven.
    if (next == outcome.events.size() && outcome.embedded) break;
  }
  return endings;
}

void Segments::for_each_deciding(const DriveOutcome& outcome,
                                 const std::function<void(std::size_t, bool)>& f) const {
  for (const DriveEnding& ending : endings(outcome)) {
    if (!ending.halt) continue;
    f(ending.halt->station, false);
    if (ending.embedded) f(ending.halt->station, true);
  }
}

void EndingSums::add(double weight, const DriveEnding& ending, bool unsolved) {
  weight_ += weight;
  squares_ += weight * weight;
  if (!ending.completed()) stopped_ += weight;
  if (ending.immobilised) immobilised_ += weight;
  if (ending.embedded) embedded_ += weight;
  if (ending.completed() && unsolved) unsolved_ += weight;
}

OutcomeShares EndingSums::shares(double scale) const {
  const auto share = [&](double bad) -> DrawnShare {
    if (weight_ <= 0.0) return {0.0, 0.0, 1.0};
    const double n = scale * weight_ * weight_ / squares_;
    DrawnShare of = share_of_draws(bad / weight_, n);
    if (unsolved_ > 0.0) of.high = share_of_draws((bad + unsolved_) / weight_, n).high;
    return of;
  };
  return {share(stopped_), share(immobilised_), share(embedded_)};
}

std::vector<SegmentRisk> segment_risks(const std::vector<DrawnDrive>& drives, const Segments& segments) {
  std::vector<EndingSums> sums(segments.count());
  double all = 0.0;
  for (const DrawnDrive& drive : drives) {
    all += drive.weight;
    const std::vector<DriveEnding> endings = segments.endings(drive.outcome);
    for (std::size_t k = 0; k < endings.size(); ++k) sums[k].add(drive.weight, endings[k], drive.unsolved);
  }
  std::vector<SegmentRisk> risks;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    SegmentRisk risk;
    static_cast<OutcomeShares&>(risk) = sums[k].shares();
    risk.from_m = segments.from_m(k);
    risk.to_m = segments.to_m(k);
    risk.reached = sums[k].weight() / all;
    risks.push_back(risk);
  }
  return risks;
}

}  // namespace slipway::sim
