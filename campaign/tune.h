#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "campaign/drive_table.h"
#include "campaign/run_campaign.h"
#include "core/field.h"
#include "core/pose.h"
#include "core/progress.h"
#include "core/result.h"
#include "gap/estimate/drive_tuning.h"

namespace slipway::campaign {

// What can be tuned: the soil's parameters by sim::sweep_parameters' names ("soil.n"), "soil.shear_modulus_m"
// for both ways at once, and "effects.NAME.PARAMETER" of every effect that is not of a place on the map.
std::optional<Field> tuning_field(std::string_view name);
std::vector<std::string> tuning_field_names();

// The table with one number changed in all its soils or its effects, for names that tuning_field knows. An
// effect that is off is switched on.
void set_tuned(std::string_view name, double value, DriveTable& table);

using MeasuredFinals = std::map<std::string, Pose2>;  // by the drive's id; headings need not be wrapped

struct TuneRequest {
  std::vector<gap::TunedParameter> parameters;
  gap::TuningOptions options;
  Simulator simulator = &sim::simulate_drive;
};

struct TableTuning {
  std::vector<gap::MeasuredDrive> drives;  // repeats of one in one
  std::vector<std::string> unmeasured;     // ids of drives that were asked for and have no measured end
  std::string soil;                        // of all drives
  gap::DriveTuning tuning;
};

// Tunes a table's soil and effects to where its drives really ended; soils are not drawn. Drives without a
// measured end are left out. Tilt is that of the ground at the start.
//
// Errors: invalid_request for parameters that can't be tuned or ranges beyond what they may be
// ("/parameters/0 /name"), and for drives on more than one soil; no_data where no drive has a measured end;
// those of gap::tune_drives.
Result<TableTuning> tune(const DriveTable& table, std::span<const TableDrive> drives,
                         const MeasuredFinals& measured, const TuneRequest& request, Progress& progress);

}  // namespace slipway::campaign
