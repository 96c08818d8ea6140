#pragma once

#include <string_view>
#include <vector>

#include "api/json/json_value.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"
#include "core/result.h"
#include "sim/rover/rover_model.h"

namespace slipway::api::json {

// Reads a rover's file ("rover/1"): the keys of a drive campaign's rover, and what planning needs beside
// them. All faults together, those of sim::faults_of too.
Result<sim::RoverModel> read_rover_file(std::string_view bytes);

// The same keys, so that what is served can be put into a file again.
void write_rover(Writer& w, const sim::RoverModel& rover);

// A drive campaign's rover, whose faults are the reader's. What planning needs besides is read where it is
// given, and otherwise follows from the wheels; a rocker-bogie's wheels are put into their order.
sim::RoverModel read_campaign_rover(ObjectReader& reader);

// The keys that a drive campaign's rover has, and no others.
void write_campaign_rover(Writer& w, const sim::RoverModel& rover);

}  // namespace slipway::api::json
