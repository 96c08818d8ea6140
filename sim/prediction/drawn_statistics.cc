#include "sim/prediction/drawn_statistics.h"

#include <algorithm>
#include <cmath>
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

RuleRisk rule_risk(Rule rule, const std::vector<DrawnDrive>& drives, const Weighted& weighted, double limit) {
  RuleRisk risk;
  risk.rule = rule;
  risk.limit = limit;
  risk.trips = weighted.share([&](const DrawnDrive& d) { return d.outcome.of(rule).tripped; });
  const bool any = risk.trips.share > 0.0;
  std::vector<std::pair<double, double>> values, tripping;
  std::map<std::pair<std::size_t, int>, double> places;
  bool first = true;
  for (const DrawnDrive& drive : drives) {
    const RuleTrace& trace = drive.outcome.of(rule);
    values.emplace_back(trace.value, drive.weight);
    if (drive.weight <= 0.0) continue;
    if (trace.tripped || !any) places[{trace.station, trace.wheel}] += drive.weight;
    if (!trace.tripped) continue;
    tripping.emplace_back(trace.value, drive.weight);
    risk.from_m = first ? trace.first_m : std::min(risk.from_m, trace.first_m);
    risk.to_m = first ? trace.last_m : std::max(risk.to_m, trace.last_m);
    first = false;
  }
  risk.value = spread_of(std::move(values));
  if (!tripping.empty()) risk.tripping = spread_of(std::move(tripping));
  double most = 0.0;
  for (const auto& [place, weight] : places) {
    if (weight <= most) continue;
    most = weight;
    risk.station = place.first;
    risk.wheel = place.second;
  }
  return risk;
}

// The share of the draws that each rule halts first, on the first segment.
void fill_halts(const std::vector<DrawnDrive>& drives, const Segments& segments, DriveOutcomes& out) {
  double sum = 0.0;
  for (const DrawnDrive& drive : drives) {
    sum += drive.weight;
    if (const DriveEnding ending = segments.endings(drive.outcome).front(); ending.halt)
      out.rules[static_cast<std::size_t>(ending.halt->rule)].halts += drive.weight;
  }
  for (RuleRisk& rule : out.rules) rule.halts /= sum;
}

// First halts and embeddings by ground and by stretch.
void locate(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
            const Segments& segments, DriveOutcomes& out) {
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
    segments.for_each_deciding(drive.outcome, [&](std::size_t at, bool embeds) {
      const PreparedStation& station = stations[at];
      const auto piece = static_cast<std::size_t>(
          length > 0.0 ? std::min(pieces - 1.0, std::floor(station.distance_m / length * pieces)) : 0.0);
      GroundRisk& ground = grounds[ground_of(station)];
      (embeds ? ground.embedding : ground.expected_stops) += drive.weight / sum;
      (embeds ? out.stretches[piece].embedding : out.stretches[piece].expected_stops) += drive.weight / sum;
    });
  }
  for (const auto& [soil, ground] : grounds) out.grounds.push_back(ground);
}

// The way behind, beside and off the heading at the end of each stretch.
void fill_position(const Weighted& weighted, DriveOutcomes& out) {
  for (std::size_t k = 0; k < out.stretches.size(); ++k) {
    const auto spread = [&](std::vector<float> DrawnDrive::*member) -> DrawnSpread {
      const auto at = [&](const DrawnDrive& d) { return static_cast<double>((d.*member)[k]); };
      return {weighted.quantile(at, 0.05), weighted.quantile(at, 0.50), weighted.quantile(at, 0.95)};
    };
    out.stretches[k].shortfall_m = spread(&DrawnDrive::shortfall_m);
    out.stretches[k].drift_m = spread(&DrawnDrive::drift_m);
    out.stretches[k].turned_rad = spread(&DrawnDrive::turned_rad);
  }
}

// With 90 % interval. Where hardly any draw halts, their scatter says little: the share of draws with a halt
// bounds the mean.
void fill_expected_stops(const Weighted& weighted, DriveOutcomes& out) {
  const auto stops = [](const DrawnDrive& d) { return static_cast<double>(d.outcome.stops); };
  const double mean = weighted.mean(stops);
  const double square = weighted.mean([&](const DrawnDrive& d) { return stops(d) * stops(d); });
  const double error = std::sqrt(std::max(0.0, square - mean * mean) / weighted.effective());
  out.expected_stops = mean;
  out.expected_stops_low = std::max({0.0, mean - kReach90 * error, std::min(mean, out.stop.low)});
  out.expected_stops_high = std::max(mean + kReach90 * error, mean > 0.0 ? mean : out.stop.high);
}

DriveOutcomes outcomes_of(const std::vector<DrawnDrive>& drives, const Weighted& weighted,
                          const std::vector<PreparedStation>& stations, const DriveLimits& limits,
                          const RiskOptions& options) {
  DriveOutcomes out;
  out.effective_draws = weighted.effective();
  EndingSums sums, on_known;
  for (const DrawnDrive& drive : drives) {
    const DriveEnding ending = drive.outcome.ending();
    sums.add(drive.weight, ending, drive.unsolved);
    const bool known = !ending.halt || ground_of(stations[ending.halt->station]);
    on_known.add(drive.weight, known ? ending : DriveEnding{}, drive.unsolved);
  }
  static_cast<OutcomeShares&>(out) = sums.shares();
  out.on_known = on_known.shares();
  out.completed = weighted.share([](const DrawnDrive& d) { return d.outcome.ending().completed(); });
  out.unsolved = weighted.mean([](const DrawnDrive& d) { return d.unsolved; });
  fill_expected_stops(weighted, out);
  for (const RuleRow& row : rule_catalogue())
    out.rules.push_back(rule_risk(row.rule, drives, weighted, limit_of(row.rule, limits, options.checks)));
  if (stations.empty()) return out;
  const Segments segments(stations, options.segment_m);
  fill_halts(drives, segments, out);
  locate(drives, stations, segments, out);
  fill_position(weighted, out);
  if (options.segment_m > 0.0) out.segments = segment_risks(drives, segments);
  return out;
}

}  // namespace

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

void fill_events(const std::vector<DrawnDrive>& drives, const Segments& segments,
                 std::vector<StationPrediction>& stations) {
  double sum = 0.0;
  for (const DrawnDrive& drive : drives) sum += drive.weight;
  for (const DrawnDrive& drive : drives) {
    segments.for_each_deciding(drive.outcome, [&](std::size_t at, bool embeds) {
      if (at >= stations.size()) return;  // beyond the prediction on the mean soils
      (embeds ? stations[at].embedding : stations[at].stops) += drive.weight / sum;
    });
  }
}

void fill_station(const std::vector<DrawnDrive>& drives, std::size_t s, StationPrediction& station) {
  std::vector<std::pair<double, double>> slip, current, sinkage, tilt, clearance, aside;
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
    aside.emplace_back(drive.aside_m[s], drive.weight);
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
  std::sort(aside.begin(), aside.end());
  station.aside_m_p05 = quantile_of_sorted(aside, 0.05);
  station.aside_m_p95 = quantile_of_sorted(aside, 0.95);
}

void summarise(const std::vector<DrawnDrive>& drives, const std::vector<PreparedStation>& stations,
               const DriveLimits& limits, const RiskOptions& options, DrivePrediction& prediction) {
  const Weighted weighted(drives);
  const DrawnShare risk = weighted.share([](const DrawnDrive& d) { return d.breaks_a_limit; });
  prediction.draws = static_cast<int>(drives.size());
  prediction.drawn.clear();
  for (const DrawnDrive& drive : drives) prediction.drawn.push_back(drive);
  prediction.risk = risk.share;
  prediction.risk_low = risk.low;
  prediction.risk_high = risk.high;
  prediction.risk_immobilised = weighted.mean([](const DrawnDrive& d) { return d.immobilised; });
  prediction.outcomes = outcomes_of(drives, weighted, stations, limits, options);
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
