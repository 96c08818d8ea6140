#include "api/report/current_maps_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "api/chart/chart.h"
#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/report/sweep_chart.h"
#include "core/angle.h"
#include "sim/wheel/entry_angle.h"

// CSV and pictures of current maps.
namespace slipway::api {
namespace {

struct InForce {
  std::string_view column;     // in the CSV
  std::string_view parameter;  // of a sweep
  double (*value)(const sim::WheelRigConditions& test);
};

constexpr std::array kInForce{
    InForce{"slip", "slip", [](const sim::WheelRigConditions& t) { return t.slip; }},
    InForce{"load_n", "load_n", [](const sim::WheelRigConditions& t) { return t.load_n; }},
    InForce{"k_s", "soil.k_s",
            [](const sim::WheelRigConditions& t) { return sim::power_stiffness(t.wheel, t.soil); }},
    InForce{"n", "soil.n", [](const sim::WheelRigConditions& t) { return t.soil.pressure.n; }},
    InForce{"cohesion_pa", "soil.cohesion_pa",
            [](const sim::WheelRigConditions& t) { return t.soil.cohesion_pa; }},
    InForce{"friction_angle_deg", "soil.friction_angle_deg",
            [](const sim::WheelRigConditions& t) { return deg_from_rad(t.soil.friction_angle_rad); }},
    InForce{"shear_modulus_x_m", "soil.shear_modulus_x_m",
            [](const sim::WheelRigConditions& t) { return t.soil.shear_modulus_x_m; }},
};

// Axes that are none of the columns above get one of their own.
bool is_in_force(std::string_view parameter) {
  return std::any_of(kInForce.begin(), kInForce.end(),
                     [&](const InForce& c) { return c.parameter == parameter; });
}

std::vector<std::optional<double>> currents_of(const CurrentPanel& panel) {
  std::vector<std::optional<double>> values;
  for (const sim::CurrentPoint& point : panel.points) values.push_back(point.current_a);
  return values;
}

// Figure 9: nine lines in one chart, the state as colour and the simulant as mark, and the sinkage of each.
std::string draw_figure_9(const CurrentMaps& maps) {
  constexpr std::array kMarks{ChartMark::kLine, ChartMark::kDashedLine, ChartMark::kPoints};
  Chart current, sinkage;
  current.x.title = parameter_title("slip");
  current.y = {"motor current, A", 0.0, {}, false, {}};
  sinkage.x.title = "simulant";
  sinkage.y = {"sinkage, mm", 0.0, {}, false, {}};
  for (std::size_t k = 0; k < maps.panels.size(); ++k) {
    const CurrentPanel& panel = maps.panels[k];
    ChartSeries line{panel.title, kMarks[k % 3], {}, {}, k / 3}, depth{"", ChartMark::kPoints, {}, {}, k / 3};
    const bool as_points = line.mark == ChartMark::kPoints;
    for (std::size_t i = 0; i < panel.points.size(); i += as_points ? 3 : 1) {
      if (!panel.points[i].current_a) continue;
      line.x.push_back(panel.points[i].place.at[0]);
      line.y.push_back(*panel.points[i].current_a);
    }
    sinkage.x.categories.push_back(panel.title);
    if (!line.x.empty()) {
      depth.x.push_back(static_cast<double>(k));
      depth.y.push_back(1e3 * panel.points.front().sinkage_m);
    }
    current.series.push_back(std::move(line));
    sinkage.series.push_back(std::move(depth));
  }
  sinkage.title = maps.options.model == sim::CurrentModel::kBalanced ? "at slip 0" : "";
  return draw_charts(maps.title, std::array{current, sinkage});
}

}  // namespace

std::string current_maps_csv(const CurrentMaps& maps) {
  std::vector<std::string> more;
  for (const CurrentPanel& panel : maps.panels) {
    for (const sim::SweepAxis& axis : panel.axes) {
      if (!is_in_force(axis.parameter) && std::find(more.begin(), more.end(), axis.parameter) == more.end())
        more.push_back(axis.parameter);
    }
  }
  std::string csv = "panel,soil,model";
  for (const std::string& name : more) csv += "," + name;
  for (const InForce& column : kInForce) csv += fmt::format(",{}", column.column);
  csv += ",current_a,sinkage_m,torque_nm,reason\n";
  for (const CurrentPanel& panel : maps.panels) {
    for (const sim::CurrentPoint& point : panel.points) {
      csv += fmt::format("{},{},{}", panel.name, panel.soil, describe(maps.options.model));
      for (const std::string& name : more) {
        csv += ",";
        for (std::size_t a = 0; a < panel.axes.size(); ++a)
          if (panel.axes[a].parameter == name) csv += fmt::format("{:.6g}", point.place.at[a]);
      }
      for (const InForce& column : kInForce) csv += fmt::format(",{:.6g}", column.value(point.place.test));
      csv += point.current_a
                 ? fmt::format(",{:.6g},{:.6g},{:.6g},\n", *point.current_a, point.sinkage_m, point.torque_nm)
                 : ",,,," + json::csv_field(point.reason) + "\n";
    }
  }
  return csv;
}

std::string draw_current_maps(const CurrentMaps& maps) {
  if (maps.figure == 9) return draw_figure_9(maps);
  if (maps.panels.size() == 1) {
    const SweptQuantity quantity{"motor current, A", currents_of(maps.panels[0])};
    return draw_sweep(maps.title, maps.panels[0].axes, std::array{quantity});
  }
  // First the panels over the second parameter, in a row, and below them those over slip.
  std::vector<Chart> charts;
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    for (std::size_t k = first; k < maps.panels.size(); k += 2) {
      const CurrentPanel& panel = maps.panels[k];
      Chart chart = sweep_chart(fmt::format("({}) {}", panel.name, panel.title), panel.axes,
                                {"motor current, A", currents_of(panel)});
      // Two legends in one: lines over slip are dashed.
      for (ChartSeries& series : chart.series)
        if (first == 1) series.mark = ChartMark::kDashedLine;
      charts.push_back(std::move(chart));
    }
  }
  return draw_charts(maps.title, charts);
}

}  // namespace slipway::api
