#include "campaign/drive_record.h"

#include <cmath>
#include <utility>

#include "core/angle.h"
#include "core/error_code.h"

namespace slipway::campaign {

DriveRecord record_of(const DriveTable& table, const TableDrive& drive, const MadeDrive& made,
                      const std::string& digest, std::vector<std::string> files) {
  DriveRecord record;
  record.id = drive.id;
  record.digest = digest;
  record.files = std::move(files);
  const std::vector<std::string> names = soils_of(table.terrains[drive.terrain]);
  for (std::size_t i = 0; i < names.size(); ++i)
    record.soils.emplace_back(names[i],
                              i < made.soils.known.size() ? made.soils.known[i] : made.soils.unknown);
  if (!made.drive) {
    record.end = error_row(made.drive.error().code).name;
    record.reason = made.drive.error().detail;
    return record;
  }
  const sim::DynamicDrive& d = *made.drive;
  record.answered = true;
  record.end = sim::describe(d.end);
  record.reason = d.reason;
  record.duration_s = d.duration_s;
  record.progress_m = d.progress_m;
  record.commanded_m = d.commanded_m;
  record.energy_j = d.energy_j;
  record.final_slip_ratio = d.commanded_m > 0.0 ? sim::final_slip_ratio(d) : 0.0;
  record.start = d.start;
  record.final = d.final;
  record.commanded = d.commanded;
  record.max_slip_ratio = d.max_slip_ratio;
  record.max_tilt_rad = d.max_tilt_rad;
  record.max_current_a = d.max_current_a;
  record.max_sinkage_m = d.max_sinkage_m;
  record.events = d.events;
  record.work = d.work;
  return record;
}

double position_error_m(const DriveRecord& record) {
  return std::hypot(record.final.x_m - record.commanded.x_m, record.final.y_m - record.commanded.y_m);
}

double heading_error_rad(const DriveRecord& record) {
  return wrapped_rad(record.final.yaw_rad - record.commanded.yaw_rad);
}

}  // namespace slipway::campaign
