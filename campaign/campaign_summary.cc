#include "campaign/campaign_summary.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"

namespace slipway::campaign {
namespace {

double quantile_of_sorted(const std::vector<double>& values, double share) {
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - std::floor(at)) * (values[above] - values[below]);
}

struct Spread {
  double place_m = 0.0, heading_rad = 0.0;
};

Spread spread_of(const std::vector<const DriveRecord*>& repeats) {
  const auto count = static_cast<double>(repeats.size());
  const double first_rad = repeats.front()->final.yaw_rad;
  Pose2 mean;
  for (const DriveRecord* record : repeats) {
    mean.x_m += record->final.x_m / count;
    mean.y_m += record->final.y_m / count;
    mean.yaw_rad += wrapped_rad(record->final.yaw_rad - first_rad) / count;
  }
  Spread spread;
  for (const DriveRecord* record : repeats) {
    const double along_m = std::hypot(record->final.x_m - mean.x_m, record->final.y_m - mean.y_m);
    const double turned_rad = wrapped_rad(record->final.yaw_rad - first_rad) - mean.yaw_rad;
    spread.place_m += along_m * along_m / count;
    spread.heading_rad += turned_rad * turned_rad / count;
  }
  return {std::sqrt(spread.place_m), std::sqrt(spread.heading_rad)};
}

// Everything of one terrain, value by value.
struct Gathered {
  TerrainSummary summary;
  std::vector<double> slip, heading_rad, position_m, turn_rad;
  std::map<std::string, std::vector<const DriveRecord*>> repeats;  // by the first one's id
};

void gather(const TableDrive& drive, const DriveRecord& record, Gathered& into) {
  ++into.summary.drives;
  ++into.summary.ends[record.end];
  if (!record.answered) return;
  if (record.commanded_m > 0.0) {
    into.slip.push_back(record.final_slip_ratio);
    into.heading_rad.push_back(std::abs(heading_error_rad(record)));
    into.position_m.push_back(position_error_m(record));
  } else {
    into.turn_rad.push_back(std::abs(heading_error_rad(record)));
  }
  into.repeats[drive.repeat_of.empty() ? drive.id : drive.repeat_of].push_back(&record);
}

TerrainSummary summary_of(Gathered& gathered) {
  TerrainSummary& summary = gathered.summary;
  summary.slip_ratio = band_of(std::move(gathered.slip));
  summary.heading_error_rad = band_of(std::move(gathered.heading_rad));
  summary.position_error_m = band_of(std::move(gathered.position_m));
  summary.turn_error_rad = band_of(std::move(gathered.turn_rad));
  std::vector<double> places_m, headings_rad;
  for (const auto& [id, repeats] : gathered.repeats) {
    if (repeats.size() < 2) continue;
    const Spread spread = spread_of(repeats);
    places_m.push_back(spread.place_m);
    headings_rad.push_back(spread.heading_rad);
  }
  summary.repeat_spread_m = band_of(std::move(places_m));
  summary.repeat_spread_rad = band_of(std::move(headings_rad));
  return summary;
}

}  // namespace

std::optional<Band> band_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return Band{.count = static_cast<int>(values.size()),
              .lowest = values.front(),
              .p05 = quantile_of_sorted(values, 0.05),
              .p50 = quantile_of_sorted(values, 0.5),
              .p95 = quantile_of_sorted(values, 0.95),
              .highest = values.back()};
}

std::vector<TerrainSummary> summarise(const DriveTable& table, std::span<const TableDrive> drives,
                                      const std::map<std::string, DriveRecord>& records) {
  std::vector<Gathered> by_terrain(table.terrains.size());
  for (const TableDrive& drive : drives) {
    const auto record = records.find(drive.id);
    if (record != records.end()) gather(drive, record->second, by_terrain[drive.terrain]);
  }
  std::vector<TerrainSummary> summaries;
  for (std::size_t t = 0; t < by_terrain.size(); ++t) {
    if (by_terrain[t].summary.drives == 0) continue;
    by_terrain[t].summary.terrain = table.terrains[t].name;
    summaries.push_back(summary_of(by_terrain[t]));
  }
  return summaries;
}

}  // namespace slipway::campaign
