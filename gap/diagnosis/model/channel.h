#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "gap/diagnosis/model/sample_column.h"

namespace slipway::gap {

class WindowReadings;
struct StationPrediction;
struct NoiseScales;

// What is compared between prediction and drive: the number of a row of channel_catalogue(). The names here
// are those that code speaks of; a row behind them needs none.
enum class Channel : int {
  kSlip,      // 1 - speed along the commanded direction / commanded; turning in place: of the yaw rate
  kSideSlip,  // speed to the left over the commanded speed; not of turns in place
  kYawRate,   // minus the commanded one, rad/s; not of turns in place
  kRoll,      // measured minus that of the rover set down on the map, rad
  kPitch,
  kCurrent,  // of a wheel's motor, A, positive in the sense of its rate
  kSinkage,  // of a wheel, m
};

struct Observation {
  Channel channel = Channel::kSlip;
  int wheel = -1;  // of a wheel's channel; -1 there: the mean of all wheels
  double value = 0.0;
  double sensor_std = 0.0;  // by the campaign's measurement_std and the number of readings
};

// What a window's readings say of a channel.
struct Measured {
  double value = 0.0, sensor_std = 0.0;
  bool mean_of_wheels = false;  // of a wheel's channel that was recorded for all wheels together
};

// A channel of recorded drives: all that readers, windows, model, noise, documents and charts need to know.
struct ChannelRow {
  std::string_view name;             // "slip", "side_slip", ...: in requests and answers
  std::string_view unit;             // at the boundary: "1", "deg/s", "deg", "A", "m"
  double boundary_unit = 1.0;        // what one internal unit is there: 57.3 of an angle
  std::string_view chart_unit = {};  // and in charts, where ticks are to stay short
  double chart_scale = 1.0;          // what one internal unit is there
  bool per_wheel = false;            // one value a wheel; else one of the rover
  // The column of a drive's file that holds it alone, of a wheel's channel without the wheel's name; without
  // a name: it is derived from columns that every file has.
  SampleColumn column = {};

  // The value of a window, nothing where it was not measured. `wheel` is 0 for the rover's channels.
  std::optional<Measured> (*observe)(const WindowReadings& readings, std::size_t wheel) = nullptr;
  // What the model predicts at a station; a window's prediction is the mean of its stations.
  double (*predict)(const StationPrediction& at, std::size_t wheel) = nullptr;
  bool predicted_when_stuck = false;  // whether `predict` has a value where the rover does not move on
  // Standard deviation of what the model leaves over in every window, besides the sensors' noise. `expected`
  // is the model's own value.
  double (*left_over)(const NoiseScales& scales, double expected) = nullptr;

  // Whether gaps in it are looked for in places of the map.
  bool located = false;
  // How the rover leans as its wheels sink is in no model here: what is left of a gap in the stance does not
  // speak against an explanation.
  bool of_the_stance = false;
};

// The explicit list of channels, see channel_catalogue.cc; its order is that of Channel, the rover's channels
// before the wheels'. A new one is a row in channel_rows.cc and an entry there.
std::span<const ChannelRow> channel_catalogue();
std::size_t channel_count();

const ChannelRow& row_of(Channel channel);
std::string_view name_of(Channel channel);
std::string_view unit_of(Channel channel);
double boundary_unit(Channel channel);

}  // namespace slipway::gap
