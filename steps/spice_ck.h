#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "steps/spice_daf.h"

// Attitudes, by NAIF's "CK Required Reading": types 1 (at instants), 2 (turning at a constant rate within
// intervals) and 3 (interpolated within intervals).
namespace slipway::steps {

struct CkRecord {
  double tick = 0.0;     // encoded spacecraft clock
  Eigen::Quaterniond q;  // unit; its matrix turns a vector of the reference frame into the instrument's
};

struct CkSegment {
  std::string name;
  int instrument = 0, reference = 0, type = 0;
  double start_tick = 0.0, end_tick = 0.0;
  std::vector<CkRecord> records;               // by rising ticks
  std::vector<double> interval_starts;         // type 3: ticks of records, rising
  std::vector<double> interval_ends;           // type 2: one for each record
  std::vector<Eigen::Vector3d> turn_per_tick;  // type 2: rotation vector in the reference frame, rad
};

// The types of segment that read_ck_segment() knows.
bool is_readable_ck(const DafArray& array);

// Errors: unreadable_data with the byte of a wrong count, of a number that is not finite, of a quaternion
// that is none, or of ticks that do not rise.
Result<CkSegment> read_ck_segment(const DafFile& daf, const DafArray& array);

// The attitude at a time of the clock. A record within `tolerance` ticks stands for that time: clocks of
// kernels agree to milliseconds only. Nothing where the segment does not say.
std::optional<Eigen::Quaterniond> attitude_at(const CkSegment& segment, double tick, double tolerance);

}  // namespace slipway::steps
