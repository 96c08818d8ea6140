#pragma once

#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/drive_command.h"
#include "sim/rover/rover_model.h"
#include "sim/rover/stance.h"

namespace slipway::gap {

// What the model predicts at one station of a window: what channels are predicted from.
struct StationPrediction {
  const sim::StationState* state = nullptr;  // null: the rover does not move on
  const sim::Stance& stance;
  const sim::DriveCommand& command;
  const sim::RoverModel& rover;
  double track_left_out = 0.0;  // see kTrackLeftOut
  bool leans = true;            // see Footing

  // That the rover's attitude sensor would show.
  const Attitude& attitude() const { return leans && state != nullptr ? state->attitude : stance.attitude; }
};

}  // namespace slipway::gap
