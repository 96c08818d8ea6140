#include "sim/prediction/drawn_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/normal_interval.h"

namespace slipway::sim {
namespace {

// Type 7 of Hyndman and Fan where all weigh the same. There must be a value.
double quantile_of_sorted(const std::vector<std::pair<double, double>>& values, double share) {
  double sum = 0.0;
  for (const auto& [value, weight] : values) sum += weight;
  const double span = sum - values.back().second;
  if (span <= 0.0) return values.back().first;
  double before = 0.0;
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    const double here = before / span, next = (before + values[k].second) / span;
    if (share <= next) {
      const double part = next > here ? (share - here) / (next - here) : 0.0;
      return values[k].first + part * (values[k + 1].first - values[k].first);
    }
    before += values[k].second;
  }
  return values.back().first;
}

double weighted_quantile(std::vector<std::pair<double, double>> values, double share) {
  std::sort(values.begin(), values.end());
  return quantile_of_sorted(values, share);
}

// Sums over weighted draws.
class Weighted {
 public:
  explicit Weighted(const std::vector<DrawnDrive>& drives) : drives_(drives) {
    double squares = 0.0;
    for (const DrawnDrive& drive : drives) {
      sum_ += drive.weight;
      squares += drive.weight * drive.weight;
    }
    effective_ = sum_ * sum_ / squares;
  }

  double effective() const { return effective_; }

  template <class Of>
  double mean(Of of) const {
    double total = 0.0;
    for (const DrawnDrive& drive : drives_) total += drive.weight * static_cast<double>(of(drive));
    return total / sum_;
  }

  template <class Of>
  DrawnShare share(Of of) const {
    return share_of_draws(mean(of), effective_);
  }

  template <class Of>
  double quantile(Of of, double at) const {
    std::vector<std::pair<double, double>> values;
    for (const DrawnDrive& drive : drives_) values.emplace_back(of(drive), drive.weight);
    return weighted_quantile(std::move(values), at);
  }

 private:
  const std::vector<DrawnDrive>& drives_;
  double sum_ = 0.0, effective_ = 0.0;
};

double limit_of(Rule rule, const DriveLimits& limits) {
  switch (rule) {
    case Rule::kSlipCheck:
      return limits.max_slip_ratio;
    case Rule::kTilt:
      return limits.max_tilt_rad;
    case Rule::kCurrent:
      return limits.max_current_a;
    case Rule::kSinkage:
      return limits.max_sinkage_m;
    case Rule::kClearance:
      return limits.min_clearance_m;
    case Rule::kEmbedding:
      break;
  }
  return 1.0;
}

RuleRisk rule_risk(Rule rule, const std::vector<DrawnDrive>& drives, const Weighted& weighted,
                   const DriveLimits& limits) {
  const auto value = [&](const DrawnDrive& d) { return d.outcome.of(rule).value; };
  RuleRisk risk{.rule = rule,
                .limit = limit_of(rule, limits),
                .value_p05 = weighted.quantile(value, 0.05),
                .value_p50 = weighted.quantile(value, 0.50),
                .value_p95 = weighted.quantile(value, 0.95),
                .trips = weighted.share([&](const DrawnDrive& d) { return d.outcome.of(rule).tripped; })};
  std::map<std::pair<std::size_t, int>, double> places;
  bool first = true;
  for (const DrawnDrive& drive : drives) {
    const RuleTrace& trace = drive.outcome.of(rule);
    if (drive.weight <= 0.0) continue;
    places[{trace.station, trace.wheel}] += drive.weight;
    if (!trace.tripped) continue;
    risk.from_m = first ? trace.first_m : std::min(risk.from_m, trace.first_m);
    risk.to_m = first ? trace.last_m : std::max(risk.to_m, trace.last_m);
    first = false;
  }
  double most = 0.0;
  for (const auto& [place, weight] : places) {
    if (weight <= most) continue;
    most = weight;
    risk.station = place.first;
    risk.wheel = place.second;
  }
  return risk;
}

// Stops and embeddings by ground and by stretch.
void locate(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
            DriveOutcomes& out) {
  if (stations.empty()) return;
  const double length = stations.back().distance_m;
  double from_m = 0.0;
  for (const double to_m : stretch_ends_m(stations)) {
    out.stretches.push_back({from_m, to_m, 0.0, 0.0});
    from_m = to_m;
  }
  const auto pieces = static_cast<double>(out.stretches.size());
  std::map<std::optional<std::size_t>, GroundRisk> grounds;
  for (const PreparedStation& station : stations) {
    GroundRisk& ground = grounds[ground_of(station)];
    ground.soil = ground_of(station);
    ground.length_m += station.drive_m;
  }
  double sum = 0.0;
  for (const DrawnDrive& drive : drives) sum += drive.weight;
  for (const DrawnDrive& drive : drives) {
    for (const OutcomeEvent& event : drive.outcome.events) {
      const PreparedStation& station = stations[event.station];
      const auto piece = static_cast<std::size_t>(
          length > 0.0 ? std::min(pieces - 1.0, std::floor(station.distance_m / length * pieces)) : 0.0);
      GroundRisk& ground = grounds[ground_of(station)];
      const bool embeds = event.rule == Rule::kEmbedding;
      (embeds ? ground.embedding : ground.expected_stops) += drive.weight / sum;
      (embeds ? out.stretches[piece].embedding : out.stretches[piece].expected_stops) += drive.weight / sum;
    }
  }
  for (const auto& [soil, ground] : grounds) out.grounds.push_back(ground);
}

// The same by segments. What comes behind an embedding is not driven.
std::vector<SegmentRisk> segments_of(const std::vector<DrawnDrive>& drives,
                                     const std::vector<PreparedStation>& stations, double segment_m) {
  const double length = stations.back().distance_m;
  const auto count = static_cast<std::size_t>(std::max(1.0, std::floor(length / segment_m + 0.5)));
  const auto segment_at = [&](double at_m) {
    return std::min(count - 1, static_cast<std::size_t>(at_m / segment_m));
  };
  struct Sums {
    double weight = 0.0, squares = 0.0, stops = 0.0, stops_squared = 0.0, stopped = 0.0, embedded = 0.0;
  };
  std::vector<Sums> sums(count);
  double all = 0.0;
  for (const DrawnDrive& drive : drives) {
    all += drive.weight;
    std::vector<int> stops(count, 0);
    std::size_t last = count;
    for (const OutcomeEvent& event : drive.outcome.events) {
      const std::size_t segment = segment_at(stations[event.station].distance_m);
      if (event.rule == Rule::kEmbedding)
        last = segment;
      else
        ++stops[segment];
    }
    for (std::size_t k = 0; k < std::min(count, last + 1); ++k) {
      Sums& sum = sums[k];
      sum.weight += drive.weight;
      sum.squares += drive.weight * drive.weight;
      sum.stops += drive.weight * stops[k];
      sum.stops_squared += drive.weight * stops[k] * stops[k];
      sum.stopped += stops[k] > 0 ? drive.weight : 0.0;
      sum.embedded += k == last ? drive.weight : 0.0;
    }
  }
  std::vector<SegmentRisk> segments;
  for (std::size_t k = 0; k < count; ++k) {
    const Sums& sum = sums[k];
    SegmentRisk segment;
    segment.from_m = segment_m * static_cast<double>(k);
    segment.to_m = k + 1 == count ? length : segment_m * static_cast<double>(k + 1);
    segment.reached = sum.weight / all;
    if (sum.weight > 0.0) {
      const double n = sum.weight * sum.weight / sum.squares;
      DriveOutcomes figures;
      figures.stop = share_of_draws(sum.stopped / sum.weight, n);
      fill_expected_stops(sum.stops / sum.weight, sum.stops_squared / sum.weight, n, figures);
      segment.stop = figures.stop;
      segment.embedding = share_of_draws(sum.embedded / sum.weight, n);
      segment.expected_stops = figures.expected_stops;
      segment.expected_stops_low = figures.expected_stops_low;
      segment.expected_stops_high = figures.expected_stops_high;
    } else {
      segment.stop.high = segment.embedding.high = 1.0;  // nobody knows
      segment.expected_stops_high = std::numeric_limits<double>::infinity();
    }
    segments.push_back(segment);
  }
  return segments;
}

DriveOutcomes outcomes_of(const std::vector<DrawnDrive>& drives, const Weighted& weighted,
                          const std::vector<PreparedStation>& stations, const DriveLimits& limits) {
  DriveOutcomes out;
  out.effective_draws = weighted.effective();
  out.stop = weighted.share([](const DrawnDrive& d) { return d.outcome.stops > 0; });
  out.embedding = weighted.share([](const DrawnDrive& d) { return d.outcome.embedded; });
  out.completed =
      weighted.share([](const DrawnDrive& d) { return d.outcome.stops == 0 && !d.outcome.embedded; });
  const double mean = weighted.mean([](const DrawnDrive& d) { return d.outcome.stops; });
  const double square = weighted.mean([](const DrawnDrive& d) { return d.outcome.stops * d.outcome.stops; });
  fill_expected_stops(mean, square, weighted.effective(), out);
  const auto on_known = [&](const DrawnDrive& d, bool embeddings) {
    return static_cast<double>(
        std::count_if(d.outcome.events.begin(), d.outcome.events.end(), [&](const OutcomeEvent& event) {
          return (event.rule == Rule::kEmbedding) == embeddings && ground_of(stations[event.station]);
        }));
  };
  out.embedding_on_known = weighted.share([&](const DrawnDrive& d) { return on_known(d, true); });
  out.expected_stops_on_known = weighted.mean([&](const DrawnDrive& d) { return on_known(d, false); });
  locate(drives, stations, out);
  for (std::size_t k = 0; k < out.stretches.size(); ++k) {
    const auto behind_m = [k](const DrawnDrive& d) { return static_cast<double>(d.shortfall_m[k]); };
    out.stretches[k].shortfall_m = {weighted.quantile(behind_m, 0.05), weighted.quantile(behind_m, 0.50),
                                    weighted.quantile(behind_m, 0.95)};
  }
  for (std::size_t rule = 0; rule < kRules; ++rule)
    out.rules.push_back(rule_risk(static_cast<Rule>(rule), drives, weighted, limits));
  return out;
}

}  // namespace

DrawnShare share_of_draws(double share, double n) {
  constexpr double z = kReach90;
  const double p = std::clamp(share, 0.0, 1.0);
  const double centre = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  return {p, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

void fill_expected_stops(double mean, double square, double n, DriveOutcomes& out) {
  const double error = std::sqrt(std::max(0.0, square - mean * mean) / n);
  // Where hardly any draw stops, their scatter says little: the share of draws with a stop bounds the mean.
  out.expected_stops = mean;
  out.expected_stops_low = std::max({0.0, mean - kReach90 * error, std::min(mean, out.stop.low)});
  out.expected_stops_high = std::max(mean + kReach90 * error, mean > 0.0 ? mean : out.stop.high);
}

DrawnSpread spread_of(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  return {quantile_of_sorted(values, 0.05), quantile_of_sorted(values, 0.50),
          quantile_of_sorted(values, 0.95)};
}

std::optional<std::size_t> ground_of(const PreparedStation& station) {
  std::optional<std::size_t> soil = station.soil[0];
  for (std::size_t k = 0; k < station.soil.size(); ++k)
    if (!station.soil[k]) soil.reset();
  return soil;
}

std::vector<double> stretch_ends_m(const std::vector<PreparedStation>& stations) {
  constexpr double kMinStretch_m = 10.0;
  constexpr double kMaxStretches = 100.0;
  const double length = stations.back().distance_m;
  const double pieces = std::clamp(std::ceil(length / kMinStretch_m - 1e-9), 1.0, kMaxStretches);
  std::vector<double> ends;
  for (int k = 0; k < static_cast<int>(pieces); ++k) ends.push_back(length * (k + 1) / pieces);
  return ends;
}

void fill_events(const std::vector<DrawnDrive>& drives, std::vector<StationPrediction>& stations) {
  double sum = 0.0;
  for (const DrawnDrive& drive : drives) sum += drive.weight;
  for (const DrawnDrive& drive : drives) {
    for (const OutcomeEvent& event : drive.outcome.events) {
      if (event.station >= stations.size()) continue;  // beyond the prediction on the mean soils
      StationPrediction& at = stations[event.station];
      (event.rule == Rule::kEmbedding ? at.embedding : at.stops) += drive.weight / sum;
    }
  }
}

void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station) {
  std::vector<std::pair<double, double>> slip, current, sinkage, tilt, clearance;
  double bad = 0.0, all = 0.0;
  for (const DrawnDrive& drive : drives) {
    all += drive.weight;
    if (s < drive.bad.size() && drive.bad[s]) bad += drive.weight;
    if (s >= drive.slip.size()) continue;
    slip.emplace_back(drive.slip[s], drive.weight);
    current.emplace_back(drive.current_a[s], drive.weight);
    sinkage.emplace_back(drive.sinkage_m[s], drive.weight);
    tilt.emplace_back(drive.tilt_rad[s], drive.weight);
    clearance.emplace_back(drive.clearance_m[s], drive.weight);
  }
  station.risk = bad / all;
  if (slip.empty()) return;  // no draw came this far, so that the values on the mean soils remain
  std::sort(slip.begin(), slip.end());
  station.slip_ratio_p05 = quantile_of_sorted(slip, 0.05);
  station.slip_ratio_p50 = quantile_of_sorted(slip, 0.50);
  station.slip_ratio_p95 = quantile_of_sorted(slip, 0.95);
  station.current_a_p95 = weighted_quantile(current, 0.95);
  station.sinkage_m_p95 = weighted_quantile(sinkage, 0.95);
  std::sort(tilt.begin(), tilt.end());
  station.tilt_rad_p05 = quantile_of_sorted(tilt, 0.05);
  station.tilt_rad_p95 = quantile_of_sorted(tilt, 0.95);
  std::sort(clearance.begin(), clearance.end());
  station.clearance_m_p05 = quantile_of_sorted(clearance, 0.05);
  station.clearance_m_p95 = quantile_of_sorted(clearance, 0.95);
}

void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, double segment_m, DrivePrediction& prediction) {
  const Weighted weighted(drives);
  const DrawnShare risk = weighted.share([](const DrawnDrive& d) { return d.breaks_a_limit; });
  prediction.draws = static_cast<int>(drives.size());
  prediction.drawn.clear();
  for (const DrawnDrive& drive : drives) prediction.drawn.push_back(drive);
  prediction.risk = risk.share;
  prediction.risk_low = risk.low;
  prediction.risk_high = risk.high;
  prediction.risk_immobilised = weighted.mean([](const DrawnDrive& d) { return d.immobilised; });
  prediction.outcomes = outcomes_of(drives, weighted, stations, limits);
  if (segment_m > 0.0 && !stations.empty())
    prediction.outcomes.segments = segments_of(drives, stations, segment_m);
  std::vector<std::pair<double, double>> duration, energy;
  for (const DrawnDrive& drive : drives) {
    if (drive.immobilised || drive.weight <= 0.0) continue;
    duration.emplace_back(drive.duration_s, drive.weight);
    energy.emplace_back(drive.energy_j, drive.weight);
  }
  prediction.duration_s_p95 = duration.empty() ? prediction.duration_s : weighted_quantile(duration, 0.95);
  prediction.energy_j_p95 = energy.empty() ? prediction.energy_j : weighted_quantile(energy, 0.95);
  std::vector<std::pair<double, double>> slip;
  for (const DrawnDrive& drive : drives)
    if (drive.driven_m > 0.0 && drive.weight > 0.0) slip.emplace_back(drive.mean_slip_ratio(), drive.weight);
  if (slip.empty()) return;
  prediction.mean_slip_ratio_p05 = weighted_quantile(slip, 0.05);
  prediction.mean_slip_ratio_p50 = weighted_quantile(slip, 0.50);
  prediction.mean_slip_ratio_p95 = weighted_quantile(slip, 0.95);
}

}  // namespace slipway::sim
