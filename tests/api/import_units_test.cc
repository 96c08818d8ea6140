// Units of a team's logs that are taken for others are told by the sizes of what is read.

#include <cmath>

#include "imported_drives.h"

namespace slipway::api::testing {
namespace {

// Units that are taken for others: by size, and the unit that would be right is named where it can be.
TEST_F(ImportedDrives, UnitsTakenForOthers) {
  struct Taken {
    std::string ending;
    double by;
    std::string key, remedy, unit;
  };
  for (const Taken& taken :
       {Taken{"_steer_deg", M_PI / 180.0, "{w}_steer_deg",
              "the key unit of columns.\"{w}_steer_deg\" of yard.toml to \"rad\"", "rad"},
        Taken{"_rate_deg_s", 1.0 / 6.0, "{w}_rate_deg_s",
              "the key unit of columns.\"{w}_rate_deg_s\" of yard.toml to \"rpm\"", "rpm"},
        Taken{"_rate_deg_s", M_PI / 180.0, "{w}_rate_deg_s", "of yard.toml to \"rad/s\"", "rad/s"}}) {
    log([&](LogCells& row) { multiply(row, taken.ending, taken.by); });
    columns_[taken.key] = from(taken.key);
    expect_warning({taken.remedy});
    columns_[taken.key] += ", unit = \"" + taken.unit + "\"";
    expect_none();
    columns_[taken.key] = from(taken.key);
  }
}

TEST_F(ImportedDrives, CurrentsInAmperesTakenForMilliamperes) {
  columns_["{w}_current_a"] += ", unit = \"mA\"";
  expect_warning({"smaller than", "the key unit of columns.\"{w}_current_a\""});
}

TEST_F(ImportedDrives, TemperaturesInFahrenheit) {
  log([](LogCells& row) {
    for (auto& [name, cell] : row)
      if (name.ends_with("_motor_temp_c") && !cell.empty())
        cell = cell_text((cell_number(cell) + 45.0) * 1.8 + 32.0);
  });
  expect_warning({"warmer than", "\"F\" are degrees Fahrenheit", "columns.\"{w}_motor_temp_c\""});
  columns_["{w}_motor_temp_c"] += ", unit = \"F\"";
  expect_none();
}

TEST_F(ImportedDrives, TemperaturesInKelvinAreOneFault) {
  log([](LogCells& row) {
    for (auto& [name, cell] : row)
      if (name.ends_with("_motor_temp_c") && !cell.empty()) cell = cell_text(cell_number(cell) + 273.15);
  });
  expect_fault({"lf_motor_temp_c", "Change the key unit of columns.\"{w}_motor_temp_c\""});
}

// What the format has no room for is one fault of a column, with its key.
TEST_F(ImportedDrives, SteeringAnglesInDegreesTakenForRadians) {
  columns_["{w}_steer_deg"] += ", unit = \"rad\"";
  import();
  ASSERT_FALSE(faults_.empty());
  EXPECT_LE(faults_.size(), 8U) << told();  // two drives that turn, four wheels that steer
  EXPECT_NE(faults_[0].message.find("change the key unit of columns.\"{w}_steer_deg\""), std::string::npos)
      << told();
}

// Sixty seconds in microseconds would be two years.
TEST_F(ImportedDrives, MicrosecondsTakenForSeconds) {
  log([](LogCells& row) { multiply(row, "t_s", 1e6); });
  expect_fault({"lasts 6e+07 s", "change the key clock.unit (it is \"s\")"});
  clock_ += "\nunit = \"us\"";
  expect_none();
}

TEST_F(ImportedDrives, ClockAndPositionsInOtherUnits) {
  clock_ = "from = \"t_s\"\nunit = \"ms\"";
  import();
  EXPECT_NE(told().find("the key clock.unit of yard.toml to \"s\""), std::string::npos) << told();
  clock_ = "from = \"t_s\"";
  columns_["x_m"] += ", unit = \"mm\"";
  columns_["y_m"] += ", unit = \"mm\"";
  import();
  EXPECT_NE(told().find("columns.x_m and columns.y_m to \"m\""), std::string::npos) << told();
}

}  // namespace
}  // namespace slipway::api::testing
