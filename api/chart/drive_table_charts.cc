#include "api/chart/drive_table_charts.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "api/chart/chart.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

using campaign::Band;
using campaign::DriveRecord;
using campaign::TableDrive;

constexpr double kHalfBar = 0.3;  // of the width between two terrains

const DriveRecord* answered(const std::map<std::string, DriveRecord>& records, const TableDrive& drive) {
  const auto record = records.find(drive.id);
  return record != records.end() && record->second.answered ? &record->second : nullptr;
}

// Draws a bar for each terrain, and its drives' values as dots beside each other in the table's order.
Chart by_terrain(std::span<const campaign::TerrainSummary> summaries, std::string title,
                 const std::function<std::vector<double>(const std::string&)>& values_of,
                 std::optional<Band> campaign::TerrainSummary::*band, double unit) {
  Chart chart;
  chart.x.title = "terrain";
  chart.y.title = std::move(title);
  ChartSeries dots{.name = "drives", .mark = ChartMark::kDots, .x = {}, .y = {}, .colour = 0};
  ChartSeries medians{.name = "median", .mark = ChartMark::kLine, .x = {}, .y = {}, .colour = 1};
  for (std::size_t t = 0; t < summaries.size(); ++t) {
    const auto at = static_cast<double>(t);
    chart.x.categories.push_back(summaries[t].terrain);
    const std::vector<double> values = values_of(summaries[t].terrain);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(values.size());
      dots.x.push_back(at + kHalfBar * (2.0 * share - 1.0));
      dots.y.push_back(unit * values[i]);
    }
    const std::optional<Band>& b = summaries[t].*band;
    if (!b) continue;
    chart.bands.push_back({.name = chart.bands.empty() ? "5 to 95 %" : "",
                           .x = {at - kHalfBar, at + kHalfBar},
                           .lower = {unit * b->p05, unit * b->p05},
                           .upper = {unit * b->p95, unit * b->p95},
                           .colour = 1});
    for (const double x : {at - kHalfBar, at + kHalfBar, std::numeric_limits<double>::quiet_NaN()}) {
      medians.x.push_back(x);
      medians.y.push_back(unit * b->p50);
    }
  }
  chart.series = {std::move(dots), std::move(medians)};
  return chart;
}

Chart poses_of(const std::string& terrain) {
  Chart chart;
  chart.title = terrain;
  chart.x.title = "east, m";
  chart.y.title = "north, m";
  chart.series = {{.name = "commanded", .mark = ChartMark::kPoints, .x = {}, .y = {}, .colour = 0},
                  {.name = "reached", .mark = ChartMark::kPoints, .x = {}, .y = {}, .colour = 1},
                  {.name = "", .mark = ChartMark::kDashedLine, .x = {}, .y = {}, .colour = 6}};
  return chart;
}

void add_pose(Chart& chart, const DriveRecord& record) {
  chart.series[0].x.push_back(record.commanded.x_m);
  chart.series[0].y.push_back(record.commanded.y_m);
  chart.series[1].x.push_back(record.final.x_m);
  chart.series[1].y.push_back(record.final.y_m);
  for (const Pose2& pose : {record.commanded, record.final}) {
    chart.series[2].x.push_back(pose.x_m);
    chart.series[2].y.push_back(pose.y_m);
  }
  // Breaks the line between two drives.
  chart.series[2].x.push_back(std::numeric_limits<double>::quiet_NaN());
  chart.series[2].y.push_back(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

std::string draw_slip_by_terrain(const campaign::DriveTable& table, std::span<const TableDrive> drives,
                                 const std::map<std::string, DriveRecord>& records,
                                 std::span<const campaign::TerrainSummary> summaries) {
  const auto values = [&](bool going, double (*value)(const DriveRecord&)) {
    return [&, going, value](const std::string& terrain) {
      std::vector<double> out;
      for (const TableDrive& drive : drives) {
        const DriveRecord* const record = answered(records, drive);
        if (record != nullptr && table.terrains[drive.terrain].name == terrain &&
            (record->commanded_m > 0.0) == going)
          out.push_back(value(*record));
      }
      return out;
    };
  };
  const auto slip = [](const DriveRecord& record) { return record.final_slip_ratio; };
  const auto heading_rad = [](const DriveRecord& record) {
    return std::abs(campaign::heading_error_rad(record));
  };
  std::vector<Chart> charts{by_terrain(summaries, "slip of the drive", values(true, slip),
                                       &campaign::TerrainSummary::slip_ratio, 1.0),
                            by_terrain(summaries, "heading error of drives, deg", values(true, heading_rad),
                                       &campaign::TerrainSummary::heading_error_rad, deg_from_rad(1.0))};
  bool any_turn = false;
  for (const campaign::TerrainSummary& summary : summaries) any_turn = any_turn || summary.turn_error_rad;
  if (any_turn)
    charts.push_back(by_terrain(summaries, "heading error of turns in place, deg", values(false, heading_rad),
                                &campaign::TerrainSummary::turn_error_rad, deg_from_rad(1.0)));
  return draw_charts(fmt::format("Slip and heading errors of {}", table.name), charts);
}

std::string draw_final_poses(const campaign::DriveTable& table, std::span<const TableDrive> drives,
                             const std::map<std::string, DriveRecord>& records) {
  std::vector<Chart> charts;
  for (std::size_t t = 0; t < table.terrains.size() && charts.size() < kMaxPosePanels; ++t) {
    Chart chart = poses_of(table.terrains[t].name);
    for (const TableDrive& drive : drives) {
      const DriveRecord* const record = drive.terrain == t ? answered(records, drive) : nullptr;
      if (record != nullptr) add_pose(chart, *record);
    }
    if (!chart.series[0].x.empty()) charts.push_back(std::move(chart));
  }
  if (charts.empty()) return {};
  return draw_charts(fmt::format("Commanded and reached places of {}", table.name), charts);
}

std::string draw_time_history(const std::string& title, const sim::RoverModel& rover,
                              std::span<const sim::SensorReading> readings) {
  using Value = std::function<double(const sim::SensorReading&)>;
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  const auto series = [&](std::string name, ChartMark mark, std::size_t colour, const Value& value) {
    ChartSeries s{.name = std::move(name), .mark = mark, .x = {}, .y = {}, .colour = colour};
    for (const sim::SensorReading& reading : readings) {
      const double y = value(reading);
      // A missing reading does not break the line.
      if (std::isnan(y)) continue;
      s.x.push_back(reading.sample.time_s);
      s.y.push_back(y);
    }
    return s;
  };
  const auto chart = [](const char* y_title) {
    Chart c;
    c.x.title = "time, s";
    c.y.title = y_title;
    return c;
  };
  std::vector<Chart> charts{chart("slip"),        chart("attitude, deg"),
                            chart("sinkage, mm"), chart("motor current, A"),
                            chart("torque, N m"), chart("load, N")};
  charts[0].series.push_back(
      series("rover", ChartMark::kLine, 6, [](const auto& r) { return r.sample.slip_ratio; }));
  const auto add_angle = [&](const std::string& name, ChartMark mark, const auto& angle_rad) {
    charts[1].series.push_back(series(name, mark, 6, [&](const auto& r) {
      return r.has_attitude ? deg_from_rad(angle_rad(r.sample.attitude)) : kNothing;
    }));
  };
  add_angle("pitch", ChartMark::kLine, [](const Attitude& a) { return a.pitch_rad; });
  add_angle("roll", ChartMark::kDashedLine, [](const Attitude& a) { return a.roll_rad; });
  double before_rad = kNothing;
  for (const sim::SensorReading& reading : readings)
    if (reading.has_attitude && std::isnan(before_rad)) before_rad = reading.sample.attitude.yaw_rad;
  add_angle("yaw since the start", ChartMark::kDots,
            [=](const Attitude& a) { return a.yaw_rad - before_rad; });
  for (std::size_t k = 0; k < rover.wheels.size(); ++k) {
    // The curves of an axle's two wheels often coincide; dashes leave the lower one visible.
    const bool right = rover.wheels[k].position_m.y() < 0.0;
    const auto add = [&](std::size_t panel, const Value& value) {
      charts[panel].series.push_back(
          series(rover.wheels[k].name, right ? ChartMark::kDashedLine : ChartMark::kLine, k, value));
    };
    add(0, [=](const auto& r) { return r.sample.wheels[k].slip_ratio; });
    add(2, [=](const auto& r) { return r.has_sinkage ? 1e3 * r.sample.wheels[k].sinkage_m : kNothing; });
    add(3, [=](const auto& r) { return r.has_current ? r.sample.wheels[k].current_a : kNothing; });
    add(4, [=](const auto& r) { return r.sample.wheels[k].torque_nm; });
    add(5, [=](const auto& r) { return r.sample.wheels[k].load_n; });
  }
  return draw_charts(title, charts);
}

}  // namespace slipway::api
