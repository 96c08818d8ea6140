#include "api/documents/diagnosis/diagnosis_where.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <span>
#include <string_view>
#include <utility>

#include "api/documents/interval_keys.h"

namespace slipway::api::json {
namespace {

using gap::Diagnosis;

constexpr int kDiscCorners = 32;

void write_channels(Writer& w, const Diagnosis& d) {
  w.key("channels").begin_array();
  for (const gap::ChannelGap& channel : d.channels) {
    const double unit = gap::boundary_unit(channel.channel);
    w.begin_object().text("channel", gap::name_of(channel.channel));
    if (channel.wheel) w.text("wheel", *channel.wheel);
    w.text("unit", gap::unit_of(channel.channel));
    write_finite(w, "gap", unit * channel.gap);
    write_finite(w, "noise", unit * channel.noise);
    write_finite(w, "bias", unit * channel.bias);
    write_finite(w, "significance", channel.significance);
    w.end_object();
  }
  w.end_array();
}

void write_regimes(Writer& w, std::string_view key, std::span<const gap::Regime> regimes) {
  w.key(key).begin_array();
  for (const gap::Regime& regime : regimes) {
    w.begin_object().key("condition").begin_array();
    for (const gap::Condition& condition : regime.conditions) {
      w.begin_object().text("variable", gap::name_of(condition.variable));
      // An open end is not there.
      write_finite(w, "from", condition.from);
      write_finite(w, "to", condition.to);
      w.end_object();
    }
    w.end_array().text("channel", gap::name_of(regime.channel));
    w.significant("share_of_gap", regime.share_of_gap).significant("share_of_data", regime.share_of_data);
    w.significant("significance", regime.significance).end_object();
  }
  w.end_array();
}

void write_channels_of_effects(Writer& w, const Diagnosis& d) {
  w.key("channels_of_effects").begin_array();
  for (const gap::ChannelShare& share : d.channels_of_effects) {
    w.begin_object().text("channel", gap::name_of(share.channel));
    w.significant("share", share.share).end_object();
  }
  w.end_array();
}

void write_places(Writer& w, const Diagnosis& d) {
  w.key("places").begin_object().text("type", "FeatureCollection").key("features").begin_array();
  for (const gap::GapPlace& place : d.places) {
    w.begin_object().text("type", "Feature").key("geometry").begin_object().text("type", "Polygon");
    w.key("coordinates").begin_array().begin_array();
    for (int k = 0; k <= kDiscCorners; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k % kDiscCorners) / kDiscCorners;
      w.begin_array().metres(place.x_m + place.radius_m * std::cos(angle));
      w.metres(place.y_m + place.radius_m * std::sin(angle)).end_array();
    }
    w.end_array().end_array().end_object();
    w.key("properties").begin_object().text("terrain", place.terrain);
    w.text("channel", gap::name_of(place.channel)).metres("x_m", place.x_m).metres("y_m", place.y_m);
    w.metres("radius_m", place.radius_m).significant("share_of_gap", place.share_of_gap);
    w.end_object().end_object();
  }
  w.end_array().end_object();
}

// What was measured in a window and predicted of it; of a wheel's channel the mean over wheels.
struct WindowValues {
  double count = 0.0, measured = 0.0, nominal = 0.0, retuned = 0.0, with_effects = 0.0;

  void add(const gap::HeldOutPoint& point) {
    count += 1.0;
    measured += point.measured;
    nominal += point.nominal;
    retuned += point.retuned;
    with_effects += point.with_effects;
  }
};
using ValuesOfWindows = std::map<std::pair<std::size_t, double>, std::map<gap::Channel, WindowValues>>;

ValuesOfWindows values_of_windows(const Diagnosis& d) {
  ValuesOfWindows values;
  for (const gap::HeldOutPoint& point : d.held_out)
    values[{point.drive, point.start_s}][point.channel].add(point);
  return values;
}

void write_window_values(Writer& w, const std::map<gap::Channel, WindowValues>& values) {
  w.key("values").begin_array();
  for (const auto& [channel, sums] : values) {
    const double unit = gap::boundary_unit(channel) / sums.count;
    w.begin_object().text("channel", gap::name_of(channel)).text("unit", gap::unit_of(channel));
    write_finite(w, "measured", unit * sums.measured);
    write_finite(w, "nominal", unit * sums.nominal);
    write_finite(w, "retuned", unit * sums.retuned);
    write_finite(w, "with_effects", unit * sums.with_effects);
    w.end_object();
  }
  w.end_array();
}

void write_windows(Writer& w, const gap::DriveCampaign& campaign, const Diagnosis& d) {
  const ValuesOfWindows values = values_of_windows(d);
  w.key("windows").begin_array();
  for (const gap::WindowGap& window : d.window_gaps) {
    if (window.stations.empty()) continue;
    const Pose2& middle = window.stations[window.stations.size() / 2];
    w.begin_object().text("terrain", campaign.terrains[window.terrain].name);
    w.text("drive", campaign.drives[window.drive].id).significant("start_s", window.start_s);
    w.metres("x_m", middle.x_m).metres("y_m", middle.y_m);
    write_finite(w, "nominal", window.nominal);
    write_finite(w, "retuned", window.retuned);
    write_finite(w, "with_effects", window.with_effects);
    if (const auto of_window = values.find({window.drive, window.start_s}); of_window != values.end())
      write_window_values(w, of_window->second);
    w.end_object();
  }
  w.end_array();
}

}  // namespace

void write_where(Writer& w, const gap::DriveCampaign& campaign, const Diagnosis& d) {
  w.key("where").begin_object();
  write_channels(w, d);
  write_regimes(w, "regimes", d.regimes);
  write_regimes(w, "regimes_retuned", d.regimes_retuned);
  write_regimes(w, "regimes_of_effect", d.regimes_of_effect);
  write_channels_of_effects(w, d);
  write_places(w, d);
  write_windows(w, campaign, d);
  w.end_object();
}

}  // namespace slipway::api::json
