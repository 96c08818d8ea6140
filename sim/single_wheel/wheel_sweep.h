#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/result.h"
#include "sim/single_wheel/sweep_parameter.h"

namespace slipway::sim {

// One parameter and the values it takes, in the unit of the boundary (degrees).
struct SweepAxis {
  std::string parameter;
  std::vector<double> values;
};

// To twelve digits: 0.1 + 2 * 0.1 is 0.3 again.
double rounded_to_twelve(double value);

// lowest, lowest + step, ... up to highest, which is met where the step meets it; each to twelve digits. step
// > 0.
std::vector<double> stepped(double lowest, double highest, double step);

constexpr std::size_t kMaxSweepAxes = 2;
constexpr std::size_t kMaxPairedAxes = 12;
constexpr std::size_t kMaxSweepRows = 5000;

// One parameter that stands at another value throughout.
struct SweepSetting {
  std::string parameter;
  double value = 0.0;  // in the unit of the boundary
};

// What a single-wheel rig would report over one or two parameters: every combination, the first axis slowest.
struct WheelSweep {
  WheelRig rig;
  std::vector<SweepAxis> axes = {};
  // The axes have one value for each row, all as many: row i stands at every axis' value i.
  bool paired = false;
  std::vector<SweepSetting> set = {};  // on the rig before it is swept; a soil that no file has, say
};

// One place of a sweep, and the test that is made there.
struct SweepPoint {
  std::vector<double> at;  // the value of each axis
  WheelRigConditions test;
};

struct SweepRow {
  SweepPoint point;
  WheelRigResult result;
};

// Axes that can't be swept, values out of range, too many rows, tests that no rig can make (a slip angle of
// 90 deg with slip by the forward speed, a depth beyond the axle). Pointers: "/sweep/0/parameter",
// "/sweep/1/values/3", "/set/soil.n", "/sinkage_m".
std::vector<Fault> faults_of(const WheelSweep& sweep);
// Of these, the names and values of what is set and swept, which can be asked of any rig.
std::vector<Fault> parameter_faults(const WheelSweep& sweep);

// How many rows a sweep has, and the rig of one of them with the value of each axis there.
std::size_t rows_of(const WheelSweep& sweep);
WheelRig rig_of(const WheelSweep& sweep, std::size_t row, std::vector<double>& at);

// The places of a sweep, and the rows of one without faults.
std::vector<SweepPoint> points_of(const WheelSweep& sweep);
std::vector<SweepRow> run_wheel_sweep(const WheelSweep& sweep);

}  // namespace slipway::sim
