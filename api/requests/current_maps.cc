#include "api/requests/current_maps.h"

#include <fmt/format.h>

#include <algorithm>

#include "api/json/faults.h"

namespace slipway::api {
namespace {

constexpr std::size_t kSamples = 61;  // of a figure's x axis

std::string soil_name(int simulant, std::string_view state) {
  return fmt::format("jlu_mars_{}_{}", simulant, state);
}

// Makes the rig from rover, soil and options, with the load filled in; reports all faults together.
Result<sim::WheelRig> rig_of(const Catalogue& catalogue, CurrentMapOptions& options,
                             const std::string& soil) {
  std::vector<Fault> faults;
  sim::WheelRig rig;
  const auto rover = catalogue.rovers.find(options.rover);
  if (rover == catalogue.rovers.end()) {
    faults.push_back({"/rover", unknown_rover(catalogue, options.rover)});
  } else {
    rig.rover = *rover->second;
    if (!options.load_n)
      options.load_n =
          rig.rover.mass_kg * options.gravity_m_s2 / static_cast<double>(rig.rover.wheels.size());
    rig.test.load_n = *options.load_n;
    rig.test.speed_m_s = rig.rover.cruise_speed_m_s;
  }
  const auto found = catalogue.soils.find(soil);
  if (found == catalogue.soils.end()) {
    faults.push_back({"/soil", unknown_soil(catalogue, soil)});
  } else {
    rig.soil = found->second.mean;
    rig.soil_format = catalogue.soil_format;
  }
  rig.test.gravity_m_s2 = options.gravity_m_s2;
  rig.test.slip = options.slip;
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return rig;
}

// Numbers beside the axes must be in the same ranges as the axes' values.
std::vector<Fault> faults_of(const CurrentMapOptions& options) {
  std::vector<Fault> faults;
  const auto check = [&](std::string_view name, double value) {
    const Field field = sim::sweep_field(name).value();
    if (value >= field.lowest && value <= field.highest) return;
    faults.push_back({fmt::format("/{}", name), fmt::format("{} = {:g}, must be in [{:g}, {:g}]", name, value,
                                                            field.lowest, field.highest)});
  };
  check("slip", options.slip);
  check("gravity_m_s2", options.gravity_m_s2);
  if (options.load_n) check("load_n", *options.load_n);
  return faults;
}

Result<CurrentPanel> panel_of(const Catalogue& catalogue, CurrentMapOptions& options, const std::string& soil,
                              std::vector<sim::SweepAxis> axes) {
  if (auto faults = faults_of(options); !faults.empty())
    return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  auto rig = rig_of(catalogue, options, soil);
  if (!rig) return fail(rig.error());
  const sim::WheelSweep sweep{std::move(*rig), std::move(axes)};
  std::vector<Fault> faults = sim::faults_of(sweep);
  if (options.model == sim::CurrentModel::kLiteral && sweep.rig.soil.pressure_law.row != nullptr)
    faults.push_back(
        {"/soil", fmt::format("{} has another pressure law than Bekker's, which the paper's equations are of",
                              in_quotes(soil))});
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  CurrentPanel panel;
  panel.soil = soil;
  panel.points = sim::run_current_map(sweep, options.model);
  panel.axes = sweep.axes;
  return panel;
}

struct PanelPlan {
  std::string name, title, soil;
  std::vector<sim::SweepAxis> axes;
};

std::vector<PanelPlan> figure_9() {
  std::vector<PanelPlan> plans;
  for (const char* state : {"loose", "medium", "dense"}) {
    for (int simulant = 1; simulant <= 3; ++simulant)
      plans.push_back({fmt::format("{}_{}", simulant, state),
                       fmt::format("JLU Mars {} {}", simulant, state),
                       soil_name(simulant, state),
                       {*sim::paper_axis("slip", 46)}});
  }
  return plans;
}

// Panels a1, a2 to c1, c2: x over the second parameter, then over slip, for the three loose simulants.
std::vector<PanelPlan> figure_10_or_11(const std::string& x, const sim::SweepAxis& second,
                                       std::string_view kept) {
  const sim::SweepAxis slips{"slip", {0.1, 0.3, 0.5, 0.7, 0.9}};
  std::vector<PanelPlan> plans;
  for (int simulant = 1; simulant <= 3; ++simulant) {
    const char letter = static_cast<char>('a' + simulant - 1);
    const std::string soil = soil_name(simulant, "loose"),
                      title = fmt::format("JLU Mars {} loose {}", simulant, kept);
    const sim::SweepAxis along = *sim::paper_axis(x, kSamples);
    plans.push_back({fmt::format("{}1", letter), title, soil, {along, second}});
    plans.push_back({fmt::format("{}2", letter), title, soil, {along, slips}});
  }
  return plans;
}

}  // namespace

std::string_view describe(sim::CurrentModel model) {
  return model == sim::CurrentModel::kLiteral ? "literal" : "balanced";
}

Result<CurrentMaps> current_map(const Catalogue& catalogue, const CurrentMapOptions& options,
                                const std::string& soil, const std::vector<sim::SweepAxis>& axes) {
  CurrentMaps maps;
  maps.options = options;
  auto panel = panel_of(catalogue, maps.options, soil, axes);
  if (!panel) return fail(panel.error());
  panel->name = "map";
  panel->title = soil;
  maps.title =
      fmt::format("Current of one wheel of {} on {}, {} model", options.rover, soil, describe(options.model));
  maps.panels.push_back(std::move(*panel));
  return maps;
}

Result<CurrentMaps> current_figure(const Catalogue& catalogue, const CurrentMapOptions& options, int figure) {
  std::vector<PanelPlan> plans;
  CurrentMaps maps;
  if (figure == 9) {
    plans = figure_9();
    maps.title = "Zhurong figure 9: current over slip";
  } else if (figure == 10) {
    plans = figure_10_or_11("soil.k_s", {"soil.n", {0.7, 0.9, 1.1, 1.4}}, "shear parameters");
    maps.title = "Zhurong figure 10: current over stiffness";
  } else if (figure == 11) {
    plans = figure_10_or_11("soil.cohesion_pa", {"soil.friction_angle_deg", {16.0, 22.0, 28.0, 34.0, 40.0}},
                            "pressure parameters");
    maps.title = "Zhurong figure 11: current over cohesion";
  } else {
    return fail(ErrorCode::kInvalidRequest, "the figures are 9, 10 and 11",
                {{"/figure", fmt::format("figure = {}, must be 9, 10 or 11", figure)}});
  }
  maps.figure = figure;
  maps.options = options;
  maps.title += fmt::format(", {} model", describe(options.model));
  for (const PanelPlan& plan : plans) {
    auto panel = panel_of(catalogue, maps.options, plan.soil, plan.axes);
    if (!panel) return fail(panel.error());
    panel->name = plan.name;
    panel->title = plan.title;
    maps.panels.push_back(std::move(*panel));
  }
  return maps;
}

}  // namespace slipway::api
