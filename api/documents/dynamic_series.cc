#include "api/documents/dynamic_series.h"

#include <array>
#include <string_view>

#include "api/documents/drive_series.h"
#include "core/angle.h"

namespace slipway::api::json {
namespace {

using planner::DynamicVerification;
using planner::LevelDifference;
using sim::DriveSample;
using sim::WheelState;

constexpr double kJoulesPerWattHour = 3600.0;

struct Column {
  std::string_view name;
  double (*value)(const DriveSample& sample);
};

constexpr std::array kPlaceColumns{
    Column{"distance_m", [](const DriveSample& s) { return s.progress_m; }},
    Column{"x_m", [](const DriveSample& s) { return s.p_MB.x(); }},
    Column{"y_m", [](const DriveSample& s) { return s.p_MB.y(); }},
    Column{"height_m", [](const DriveSample& s) { return s.p_MB.z(); }},
};

constexpr std::array kColumns{
    Column{"time_s", [](const DriveSample& s) { return s.time_s; }},
    Column{"yaw_deg", [](const DriveSample& s) { return deg_from_rad(wrapped_rad(s.attitude.yaw_rad)); }},
    Column{"roll_deg", [](const DriveSample& s) { return deg_from_rad(s.attitude.roll_rad); }},
    Column{"pitch_deg", [](const DriveSample& s) { return deg_from_rad(s.attitude.pitch_rad); }},
    Column{"slip", [](const DriveSample& s) { return s.slip_ratio; }},
};

struct WheelColumn {
  std::string_view name;
  double (*value)(const WheelState& wheel);
};

constexpr std::array kWheelColumns{
    WheelColumn{"load_n", [](const WheelState& w) { return w.load_n; }},
    WheelColumn{"slip", [](const WheelState& w) { return w.slip_ratio; }},
    WheelColumn{"sinkage_m", [](const WheelState& w) { return w.sinkage_m; }},
    WheelColumn{"current_a", [](const WheelState& w) { return w.current_a; }},
    WheelColumn{"torque_nm", [](const WheelState& w) { return w.torque_nm; }},
};

void write_difference(Writer& w, std::string_view name, const LevelDifference& difference) {
  w.key(name).begin_object().significant("mean", difference.mean);
  w.significant("mean_abs", difference.mean_abs);
  write_peak(w, "largest", difference.largest);
  w.end_object();
}

void write_figures(Writer& w, const DynamicVerification& d) {
  w.text("fidelity", "dynamic").text("end", planner::end_in_words(d)).text("reason", d.reason);
  w.metres("at_m", d.distance_m).metres("x_m", d.pose.x_m).metres("y_m", d.pose.y_m);
  w.significant("yaw_deg", deg_from_rad(d.pose.yaw_rad)).metres("commanded_m", d.commanded_m);
  const planner::OffRoute& off = d.max_distance_from_route;
  w.key("max_distance_from_route_m").begin_object().metres("value", off.distance_m).metres("at_m", off.at_m);
  w.metres("x_m", off.x_m).metres("y_m", off.y_m).end_object();
  w.significant("duration_s", d.duration_s).key("energy_wh");
  if (d.energy_j) {
    w.significant(*d.energy_j / kJoulesPerWattHour);
  } else {
    w.null();
  }
  write_peak(w, "max_slip", d.extremes.max_slip_ratio);
  write_peak(w, "max_tilt_deg", d.extremes.max_tilt_rad, deg_from_rad(1.0));
  write_peak(w, "max_current_a", d.extremes.max_current_a);
  write_peak(w, "max_sinkage_m", d.extremes.max_sinkage_m);
  write_broken_limits(w, d.broken_limits);
  w.key("less_quasi_static").begin_object().metres("compared_m", d.compared_m);
  write_difference(w, "slip", d.slip_ratio);
  write_difference(w, "sinkage_m", d.sinkage_m);
  write_difference(w, "current_a", d.current_a);
  w.end_object();
  w.key("work").begin_object().whole("steps", d.work.steps).whole("evaluations", d.work.evaluations);
  w.whole("jacobians", d.work.jacobians).whole("restarts", d.work.restarts).end_object();
}

void write_events(Writer& w, const DynamicVerification& dynamic) {
  w.key("events").begin_array();
  for (const sim::DriveEvent& event : dynamic.events) {
    w.begin_object().text("kind", sim::describe(event.kind)).significant("time_s", event.time_s);
    w.whole("leg", event.leg);
    if (event.wheel >= 0) w.text("wheel", dynamic.wheel_names[static_cast<std::size_t>(event.wheel)]);
    w.end_object();
  }
  w.end_array();
}

void write_samples(Writer& w, const DynamicVerification& dynamic) {
  const auto& samples = dynamic.samples;
  w.key("samples").begin_object().whole("count", static_cast<std::int64_t>(samples.size()));
  for (const Column& column : kPlaceColumns) {
    w.key(column.name).begin_array();
    for (const DriveSample& s : samples) w.metres(column.value(s));
    w.end_array();
  }
  for (const Column& column : kColumns) {
    w.key(column.name).begin_array();
    for (const DriveSample& s : samples) w.significant(column.value(s));
    w.end_array();
  }
  w.key("driving").begin_array();
  for (const DriveSample& s : samples) w.boolean(s.driving);
  w.end_array().key("leg").begin_array();
  for (const DriveSample& s : samples) w.whole(s.leg);
  w.end_array().key("wheels").begin_object();
  for (std::size_t k = 0; k < dynamic.wheel_names.size(); ++k) {
    w.key(dynamic.wheel_names[k]).begin_object();
    for (const WheelColumn& column : kWheelColumns) {
      w.key(column.name).begin_array();
      for (const DriveSample& s : samples) w.significant(column.value(s.wheels[k]));
      w.end_array();
    }
    w.end_object();
  }
  w.end_object().end_object();
}

}  // namespace

void write_dynamic_figures(Writer& w, const DynamicVerification& dynamic) {
  w.key("dynamic").begin_object();
  write_figures(w, dynamic);
  w.end_object();
}

void write_dynamic_drive(Writer& w, const DynamicVerification& dynamic) {
  w.key("dynamic").begin_object();
  write_figures(w, dynamic);
  write_events(w, dynamic);
  write_samples(w, dynamic);
  w.end_object();
}

}  // namespace slipway::api::json
