// Drives of a practice campaign as a team would have logged and mapped them, with one thing taken for
// another: each is told, names the key that mends it, and is gone once that is changed.

#include <cmath>

#include "imported_drives.h"

namespace slipway::api::testing {
namespace {

TEST_F(ImportedDrives, AsTheyAreNothingIsTold) {
  expect_none();
}

TEST_F(ImportedDrives, WheelsInAnotherOrder) {
  const std::vector<std::string> order{"lf", "rf", "lm", "rm", "lr", "rr"};
  for (std::size_t k = 0; k < order.size(); ++k) wheels_[kLoggedWheels[k]] = order[k];
  expect_warning({"lr, rf, which can", "lm, rm, which can't steer",
                  "lf = \"lf\", lm = \"lm\", lr = \"lr\", rf = \"rf\"", "change [wheels] of yard.toml"});
}

// What can be told without steering angles: inner wheels turn slower.
TEST_F(ImportedDrives, SidesExchangedWithoutSteeringAngles) {
  columns_.erase("{w}_steer_deg");
  for (std::size_t k = 0; k < 3; ++k) {
    wheels_[kLoggedWheels[k]] = kLoggedWheels[k + 3];
    wheels_[kLoggedWheels[k + 3]] = kLoggedWheels[k];
  }
  expect_warning({"inner wheels turn slower", "lm = \"lm\"", "rm = \"rm\"", "change [wheels]"});
}

// Wheels that can't steer differ by their rates alone.
TEST_F(ImportedDrives, MiddleWheelsExchanged) {
  std::swap(wheels_["lm"], wheels_["rm"]);
  expect_warning({"the rates of lm, rm are not", "lm = \"lm\"", "rm = \"rm\"", "change [wheels]"});
}

TEST_F(ImportedDrives, WheelsInAnotherOrderWithoutATableOfWheels) {
  for (const char* kind : {"_rate_deg_s", "_steer_deg", "_current_a", "_motor_temp_c", "_sinkage_m"}) {
    columns_.erase("{w}" + std::string(kind));
    for (const std::string& wheel : kLoggedWheels) {
      const std::string other = wheel == "lf" ? "lm" : wheel == "lm" ? "lf" : wheel;
      columns_[wheel + kind] = from(other + kind);
    }
  }
  wheels_.clear();
  expect_warning({"lf_... from the columns that lm_... are read from now", "change [columns] of yard.toml"});
}

TEST_F(ImportedDrives, CurrentsOfOneSideInTheOtherSense) {
  log([](LogCells& row) { multiply(row, "_current_a", -1.0, "r"); });
  expect_warning({"currents of rf, rm, rr",
                  "turned = [\"rf\", \"rm\", \"rr\"] of columns.\"{w}_current_a\" of yard.toml"});
  columns_["{w}_current_a"] += ", turned = [\"rf\", \"rm\", \"rr\"]";
  expect_none();
}

TEST_F(ImportedDrives, RatesOfOneSideInTheOtherSense) {
  log([](LogCells& row) { multiply(row, "_rate_deg_s", -1.0, "r"); });
  expect_warning({"wheels rf, rm, rr turned against",
                  "turned = [\"rf\", \"rm\", \"rr\"] of columns.\"{w}_rate_deg_s\""});
  columns_["{w}_rate_deg_s"] += ", turned = [\"rf\", \"rm\", \"rr\"]";
  expect_none();
}

// Negative where a wheel turns backwards.
TEST_F(ImportedDrives, CurrentsSignedByTheRate) {
  log([](LogCells& row) {
    for (const std::string& wheel : kLoggedWheels) {
      std::string& current = row[wheel + "_current_a"];
      if (!current.empty() && cell_number(row[wheel + "_rate_deg_s"]) < 0.0)
        current = cell_text(-cell_number(current));
    }
  });
  expect_warning(
      {"goes with the sense in which the wheel turns", "signed_by = \"rate\" of columns.\"{w}_current_a\""});
  columns_["{w}_current_a"] += ", signed_by = \"rate\"";
  expect_none();
  columns_.erase("{w}_rate_deg_s");
  import();
  EXPECT_NE(told().find("whose sign it could be"), std::string::npos) << told();
}

TEST_F(ImportedDrives, CurrentsOfColumnsForEachWheel) {
  columns_.erase("{w}_current_a");
  for (const std::string& wheel : kLoggedWheels) columns_[wheel + "_current_a"] = from(wheel + "_current_a");
  log([](LogCells& row) { multiply(row, "_current_a", -1.0, "r"); });
  expect_warning(
      {"the key sign of columns.\"rf_current_a\" and columns.\"rm_current_a\" and columns.\"rr_current_a\""});
  for (const char* wheel : {"rf", "rm", "rr"}) columns_[wheel + std::string("_current_a")] += ", sign = -1";
  expect_none();
}

// Where the key is there already the list is what it should be.
TEST_F(ImportedDrives, TurnedWheelsThatShouldNotBe) {
  columns_["{w}_current_a"] += ", turned = [\"lf\", \"rf\"]";
  expect_warning({"currents of lf, rf are", "turned = [] of"});
}

TEST_F(ImportedDrives, AllCurrentsOrSteeringAnglesInTheOtherSense) {
  log([](LogCells& row) { multiply(row, "_current_a", -1.0); });
  expect_warning({"change the key sign of columns.\"{w}_current_a\""});
  columns_["{w}_current_a"] += ", sign = -1";
  expect_none();
  log([](LogCells& row) {
    multiply(row, "_current_a", -1.0);
    multiply(row, "_steer_deg", -1.0);
  });
  expect_warning({"steering angles of lf, lr, rf, rr", "change the key sign of columns.\"{w}_steer_deg\"",
                  "lf = \"lr\""});
  columns_["{w}_steer_deg"] += ", sign = -1";
  expect_none();
}

TEST_F(ImportedDrives, TurnsOfTheOtherSense) {
  turns_ = -1.0;
  expect_warning({"The wheels turned to that side too", "curvature_1_m"});
}

TEST_F(ImportedDrives, YawFromZeroToATurnWithADelay) {
  log([](LogCells& row) {
    row["yaw_deg"] = cell_text(std::fmod(cell_number(row["yaw_deg"]) + 360.0, 360.0));
  });
  columns_["yaw_deg"] += ", delay_s = 0.5";
  expect_none();
  EXPECT_NEAR(first_yaw_deg_, 359.955, 1e-3);
}

TEST_F(ImportedDrives, TimesAsDates) {
  log([](LogCells& row) {
    const int seconds = static_cast<int>(cell_number(row["t_s"]));
    char text[40];
    std::snprintf(text, sizeof text, "2023-09-08T23:59:%02dZ", seconds);
    if (seconds >= 60) std::snprintf(text, sizeof text, "2023-09-09T00:00:%02dZ", seconds - 60);
    row["t_s"] = text;
  });
  expect_none();
  ASSERT_EQ(campaign_.notes.size(), 1U);
  EXPECT_EQ(campaign_.drives[0].duration_s, 60.0);
}

// The remedy that is printed is the one that works.
TEST_F(ImportedDrives, QuaternionsMappedAsAnglesAndAsAnAttitude) {
  log([](LogCells& row) {
    const Attitude attitude{rad_from_deg(cell_number(row["roll_deg"])),
                            rad_from_deg(cell_number(row["pitch_deg"])),
                            rad_from_deg(cell_number(row["yaw_deg"]))};
    const Eigen::Quaterniond q(rotation_MB(attitude));
    row["q.x"] = cell_text(q.x());
    row["q.y"] = cell_text(q.y());
    row["q.z"] = cell_text(q.z());
    row["q.w"] = cell_text(q.w());
  });
  columns_["roll_deg"] = from("q.x", ", unit = \"rad\"");
  columns_["pitch_deg"] = from("q.y", ", unit = \"rad\"");
  columns_["yaw_deg"] = from("q.z", ", unit = \"rad\"");
  import();
  const std::string remedy = "from = [\"q.x\", \"q.y\", \"q.z\", \"q.w\"] and order = \"xyzw\"";
  ASSERT_FALSE(warnings_.empty());
  EXPECT_NE(warnings_[0].find(remedy), std::string::npos) << told();
  for (const char* angle : {"roll_deg", "pitch_deg", "yaw_deg"}) columns_.erase(angle);
  const std::string clock = clock_;
  clock_ = clock + "\n[attitude]\nfrom = [\"q.x\", \"q.y\", \"q.z\", \"q.w\"]\norder = \"xyzw\"";
  expect_none();
  EXPECT_NEAR(first_yaw_deg_, -0.1077523, 1e-5);
  clock_ = clock + "\n[attitude]\nfrom = [\"q.w\", \"q.x\", \"q.y\", \"q.z\"]\norder = \"wxyz\"";
  expect_none();
  clock_ = clock + "\n[attitude]\nfrom = [\"q.x\", \"q.y\", \"q.z\", \"q.w\"]\norder = \"wxyz\"";
  import();
  EXPECT_NE(told().find("[attitude] of yard.toml"), std::string::npos) << told();
}

}  // namespace
}  // namespace slipway::api::testing
