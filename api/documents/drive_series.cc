#include "api/documents/drive_series.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "api/files/relief_values.h"
#include "core/angle.h"
#include "core/version.h"
#include "planner/judge/verdict_words.h"

namespace slipway::api::json {
namespace {

using sim::StationPrediction;
using sim::WheelState;

constexpr double kJoulesPerWattHour = 3600.0;

struct Column {
  std::string_view name;
  double (*value)(const StationPrediction& station);
  bool of_wheels = false;  // comes from the wheels' forces: not known on ground that has a slip curve alone
};

constexpr std::array kPlaceColumns{
    Column{"distance_m", [](const StationPrediction& s) { return s.station.distance_m; }},
    Column{"x_m", [](const StationPrediction& s) { return s.station.pose.x_m; }},
    Column{"y_m", [](const StationPrediction& s) { return s.station.pose.y_m; }},
    Column{"height_m", [](const StationPrediction& s) { return s.height_m; }},
};

constexpr std::array kColumns{
    Column{"yaw_deg", [](const StationPrediction& s) { return deg_from_rad(s.attitude.yaw_rad); }},
    Column{"roll_deg", [](const StationPrediction& s) { return deg_from_rad(s.attitude.roll_rad); }},
    Column{"pitch_deg", [](const StationPrediction& s) { return deg_from_rad(s.attitude.pitch_rad); }},
    Column{"tilt_deg", [](const StationPrediction& s) { return deg_from_rad(s.attitude.tilt_rad()); }},
    Column{"tilt_deg_p05", [](const StationPrediction& s) { return deg_from_rad(s.tilt_rad_p05); }},
    Column{"tilt_deg_p95", [](const StationPrediction& s) { return deg_from_rad(s.tilt_rad_p95); }},
    Column{"clearance_m", [](const StationPrediction& s) { return s.clearance_m; }},
    Column{"clearance_m_p05", [](const StationPrediction& s) { return s.clearance_m_p05; }},
    Column{"clearance_m_p95", [](const StationPrediction& s) { return s.clearance_m_p95; }},
    Column{"turned_deg", [](const StationPrediction& s) { return deg_from_rad(s.station.turned_rad); }},
    Column{"slip", [](const StationPrediction& s) { return s.state.slip_ratio; }},
    Column{"slip_p05", [](const StationPrediction& s) { return s.slip_ratio_p05; }},
    Column{"slip_p50", [](const StationPrediction& s) { return s.slip_ratio_p50; }},
    Column{"slip_p95", [](const StationPrediction& s) { return s.slip_ratio_p95; }},
    Column{"aside_m", [](const StationPrediction& s) { return s.aside_m; }},
    Column{"aside_m_p05", [](const StationPrediction& s) { return s.aside_m_p05; }},
    Column{"aside_m_p95", [](const StationPrediction& s) { return s.aside_m_p95; }},
    Column{"side_slip_deg", [](const StationPrediction& s) { return deg_from_rad(s.state.side_slip_rad); }},
    Column{"yaw_rate_deg_s", [](const StationPrediction& s) { return deg_from_rad(s.state.yaw_rate_rad_s); }},
    Column{"left_rut_depth_m", [](const StationPrediction& s) { return s.state.left_rut_depth_m; }, true},
    Column{"right_rut_depth_m", [](const StationPrediction& s) { return s.state.right_rut_depth_m; }, true},
    Column{"current_a_p95", [](const StationPrediction& s) { return s.current_a_p95; }, true},
    Column{"sinkage_m_p95", [](const StationPrediction& s) { return s.sinkage_m_p95; }, true},
    Column{"power_w", [](const StationPrediction& s) { return s.state.electric_power_w; }, true},
    Column{"risk", [](const StationPrediction& s) { return s.risk; }},
    Column{"expected_stops", [](const StationPrediction& s) { return s.stops; }},
    Column{"embedding", [](const StationPrediction& s) { return s.embedding; }},
    Column{"elapsed_s", [](const StationPrediction& s) { return s.elapsed_s; }},
};

struct WheelColumn {
  std::string_view name;
  double (*value)(const WheelState& wheel);
};

constexpr std::array kWheelColumns{
    WheelColumn{"load_n", [](const WheelState& w) { return w.load_n; }},
    WheelColumn{"slip", [](const WheelState& w) { return w.slip_ratio; }},
    WheelColumn{"slip_angle_deg", [](const WheelState& w) { return deg_from_rad(w.slip_angle_rad); }},
    WheelColumn{"sinkage_m", [](const WheelState& w) { return w.sinkage_m; }},
    WheelColumn{"torque_nm", [](const WheelState& w) { return w.torque_nm; }},
    WheelColumn{"current_a", [](const WheelState& w) { return w.current_a; }},
};

void write_figure(Writer& w, double value, bool known) {
  if (known)
    w.significant(value);
  else
    w.null();
}

// An array under this key, with what `element(station)` writes of each station shown.
template <class Element>
void write_column(Writer& w, std::string_view key, const sim::DrivePrediction& prediction,
                  const std::vector<std::size_t>& shown, const Element& element) {
  w.key(key).begin_array();
  for (const std::size_t k : shown) element(prediction.stations[k]);
  w.end_array();
}

void write_words(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                 const std::vector<std::size_t>& shown) {
  const auto column = [&](std::string_view key, const auto& element) {
    write_column(w, key, prediction, shown, element);
  };
  column("outcome", [&](const StationPrediction& s) { w.text(sim::describe(s.state.outcome)); });
  column("turning_in_place", [&](const StationPrediction& s) { w.boolean(s.station.turning_in_place); });
  column("soil", [&](const StationPrediction& s) {
    if (s.soil)
      w.text(provenance.soils.at(*s.soil));
    else
      w.null();
  });
  column("on_unknown_ground", [&](const StationPrediction& s) { w.boolean(s.on_unknown_ground); });
}

}  // namespace

void write_peak(Writer& w, std::string_view name, const sim::Peak& peak, double scale) {
  w.key(name)
      .begin_object()
      .significant("value", peak.value * scale)
      .metres("at_m", peak.distance_m)
      .end_object();
}

void write_drive_figures(Writer& w, const sim::DrivePrediction& p) {
  w.text("fidelity", "quasi_static");
  w.metres("length_m", p.length_m).significant("turned_deg", deg_from_rad(p.turned_rad));
  w.significant("duration_s", p.duration_s).significant("duration_p95_s", p.duration_s_p95);
  // What comes from the wheels' forces is null where part of the way is known by a slip curve alone.
  const bool known = !p.by_slip_curve;
  write_figure(w.key("energy_wh"), p.energy_j / kJoulesPerWattHour, known);
  write_figure(w.key("energy_p95_wh"), p.energy_j_p95 / kJoulesPerWattHour, known);
  w.significant("mean_slip", p.mean_slip_ratio).significant("mean_slip_p05", p.mean_slip_ratio_p05);
  w.significant("mean_slip_p50", p.mean_slip_ratio_p50).significant("mean_slip_p95", p.mean_slip_ratio_p95);
  write_peak(w, "max_slip", p.max_slip_ratio);
  write_peak(w, "max_tilt_deg", p.max_tilt_rad, deg_from_rad(1.0));
  for (const auto& [name, peak] :
       {std::pair{"max_current_a", &p.max_current_a}, {"max_sinkage_m", &p.max_sinkage_m}}) {
    if (known)
      write_peak(w, name, *peak);
    else
      w.key(name).null();
  }
  w.metres("unknown_length_m", p.unknown_length_m);
  if (p.by_slip_curve) w.metres("slip_curve_length_m", p.slip_curve_length_m);
  w.key("immobilised");
  if (p.immobilised) {
    w.begin_object().metres("at_m", p.immobilised->distance_m).metres("x_m", p.immobilised->pose.x_m);
    w.metres("y_m", p.immobilised->pose.y_m).text("reason", p.immobilised->reason).end_object();
  } else {
    w.null();
  }
  write_broken_limits(w, p.broken_limits);
  w.key("risk").begin_object().significant("value", p.risk).significant("low", p.risk_low);
  w.significant("high", p.risk_high).significant("immobilised", p.risk_immobilised).whole("draws", p.draws);
  w.key("worst_place").begin_object().significant("value", p.worst_place.value);
  w.metres("at_m", p.worst_place.distance_m).end_object().end_object();
  write_share(w, "stop", p.outcomes.stop);
  w.key("worst_halt");
  const sim::RuleRisk* const rule = planner::main_halt(p);
  const StationPrediction* const at = planner::worst_station(p);
  if (rule != nullptr && at != nullptr)
    w.begin_object()
        .text("rule", sim::describe(rule->rule))
        .metres("at_m", at->station.distance_m)
        .end_object();
  else
    w.null();
  write_share(w, "embedding", p.outcomes.embedding);
  w.significant("expected_stops", p.outcomes.expected_stops);
}

void write_broken_limits(Writer& w, const std::vector<sim::BrokenLimit>& broken) {
  std::vector<std::string> words;
  for (const sim::BrokenLimit& each : broken) words.push_back(sim::describe(each));
  w.texts("broken_limits", words);
}

void write_share(Writer& w, std::string_view name, const sim::DrawnShare& share) {
  w.key(name).begin_object().significant("value", share.share).significant("low", share.low);
  w.significant("high", share.high).end_object();
}

void write_spread(Writer& w, std::string_view name, const sim::DrawnSpread& spread) {
  w.key(name).begin_object().significant("p05", spread.p05).significant("p50", spread.p50);
  w.significant("p95", spread.p95).end_object();
}

std::size_t max_stations_shown(std::size_t drives) {
  constexpr std::size_t kOfAll = 6000, kOfEach = 500;
  return std::max(kOfEach, kOfAll / std::max<std::size_t>(drives, 1));
}

std::vector<std::size_t> shown_stations(const sim::DrivePrediction& prediction, std::size_t most) {
  const std::vector<StationPrediction>& stations = prediction.stations;
  std::vector<std::size_t> shown;
  if (stations.size() <= most) {
    shown.resize(stations.size());
    std::iota(shown.begin(), shown.end(), std::size_t{0});
    return shown;
  }
  using Quantity = double (*)(const StationPrediction&);
  constexpr std::array<Quantity, 3> kPeaks{[](const StationPrediction& s) { return s.slip_ratio_p95; },
                                           [](const StationPrediction& s) { return s.attitude.tilt_rad(); },
                                           [](const StationPrediction& s) { return s.current_a_p95; }};
  const std::size_t parts = std::max<std::size_t>(1, (most - 1) / (1 + kPeaks.size()));
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * stations.size() / parts, end = (part + 1) * stations.size() / parts;
    shown.push_back(begin);
    for (const Quantity quantity : kPeaks) {
      std::size_t peak = begin;
      for (std::size_t k = begin; k < end; ++k)
        if (quantity(stations[k]) > quantity(stations[peak])) peak = k;
      shown.push_back(peak);
    }
  }
  shown.push_back(stations.size() - 1);
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return shown;
}

void write_stations(Writer& w, const sim::DrivePrediction& prediction, const Provenance& provenance,
                    const std::vector<std::size_t>& shown) {
  w.key("stations").begin_object().whole("count", static_cast<std::int64_t>(shown.size()));
  if (shown.size() < prediction.stations.size())
    w.whole("thinned_from", static_cast<std::int64_t>(prediction.stations.size()));
  for (const Column& column : kPlaceColumns)
    write_column(w, column.name, prediction, shown,
                 [&](const StationPrediction& s) { w.metres(column.value(s)); });
  for (const Column& column : kColumns)
    write_column(w, column.name, prediction, shown, [&](const StationPrediction& s) {
      write_figure(w, column.value(s), !(column.of_wheels && s.state.by_slip_curve));
    });
  write_words(w, prediction, provenance, shown);
  w.key("wheels").begin_object();
  for (std::size_t wheel = 0; wheel < prediction.wheel_names.size(); ++wheel) {
    w.key(prediction.wheel_names[wheel]).begin_object();
    for (const WheelColumn& column : kWheelColumns)
      write_column(w, column.name, prediction, shown, [&](const StationPrediction& s) {
        write_figure(w, column.value(s.state.wheels[wheel]), !s.state.by_slip_curve);
      });
    w.end_object();
  }
  w.end_object().end_object();
}

void write_line(Writer& w, const sim::DrivePrediction& prediction, const std::vector<std::size_t>& shown) {
  w.key("geometry");
  // A LineString has two positions at least (RFC 7946): a rover that is stuck where it stands has none.
  if (prediction.stations.size() < 2) {
    w.null();
    return;
  }
  w.begin_object().text("type", "LineString").key("coordinates").begin_array();
  for (const std::size_t k : shown) {
    const StationPrediction& s = prediction.stations[k];
    w.begin_array().metres(s.station.pose.x_m).metres(s.station.pose.y_m).metres(s.height_m).end_array();
  }
  w.end_array().end_object();
}

void write_provenance(Writer& w, const Provenance& p) {
  w.key("provenance").begin_object().text("slipway", version()).text("fidelity", "quasi_static");
  w.text("terrain_title", p.terrain_title).text("terrain_version", p.terrain_version);
  w.text("terrain_fingerprint", p.terrain_fingerprint);
  w.text("crs_name", p.crs_name).text("body", p.body).exact("gravity_m_s2", p.gravity_m_s2);
  w.texts("soils", p.soils).text("unknown_soil", p.unknown_soil).text("legend", p.legend);
  w.text("soil_assumption", p.soil_assumption);
  if (!p.unseen_relief.empty()) w.text("unseen_relief", p.unseen_relief);
  if (p.past_drives) w.whole("past_drives", *p.past_drives).significant("measured_m", p.measured_m);
  if (p.measured_near)
    w.key("measured_near")
        .begin_object()
        .exact("within_m", StepsNear::kWithin_m)
        .whole("steps", static_cast<std::int64_t>(p.measured_near->steps))
        .significant("way_m", p.measured_near->way_m)
        .significant("median_slip", p.measured_near->median_slip)
        .significant("largest_slip", p.measured_near->largest_slip)
        .end_object();
  if (p.relief) write_relief(w, *p.relief);
  w.whole("seed", static_cast<std::int64_t>(p.seed)).end_object();
}

}  // namespace slipway::api::json
