// The parts of an import of drive logs: times as they are written, tables with their faults, angles between
// rows, quaternions, and the order that agrees best.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "api/files/campaign/best_assignment.h"
#include "api/files/campaign/import_attitude.h"
#include "api/files/campaign/import_clock.h"
#include "api/files/campaign/recorded_table.h"
#include "api/files/campaign/written_time.h"

namespace slipway::api {
namespace {

double written_seconds(const std::string& text) {
  const auto time = written_time(text, false);
  return time ? time->seconds : std::nan("");
}

TEST(ImportTimes, DatesOfEveryNotationAreTheSameSecond) {
  constexpr double kTenOClock_s = 1694167200.0;  // date -u -d 2023-09-08T10:00:00Z +%s
  for (const char* text : {"2023-09-08T10:00:00Z", "2023-09-08T10:00:00", "2023-09-08 10:00:00 UTC",
                           "2023/09/08 10:00:00.000", "2023-251T10:00:00", "2023-251T10:00:00.000Z",
                           "2023-09-08T12:00:00+02:00", "2023-09-08T05:30:00-0430", "2023-09-08T10:00Z"})
    EXPECT_EQ(written_seconds(text), kTenOClock_s) << text;
  EXPECT_DOUBLE_EQ(written_seconds("2023-09-08T10:00:00,25Z"), kTenOClock_s + 0.25);
  for (const char* text : {"2023-13-08T10:00:00Z", "2023-02-30T10:00:00Z", "08/09/2023 10:00:00", "yesterday",
                           "2023-09-08T10:61:00Z", "2023-09-08T10:00:00 PST", ""})
    EXPECT_FALSE(written_time(text, false)) << text;
}

TEST(ImportTimes, SolsAndSpacecraftClocks) {
  for (const char* text : {"Sol 12 10:00:01.5", "SOL-00012M10:00:01.5", "Sol-12 10:00:01.5 LMST"}) {
    const auto time = written_time(text, false);
    ASSERT_TRUE(time) << text;
    EXPECT_EQ(time->notation, TimeNotation::kDayClock);
    EXPECT_TRUE(time->of_a_sol);
    EXPECT_EQ(time->day, 12.0);
    EXPECT_EQ(time->seconds, 36001.5);
  }
  EXPECT_FALSE(written_time("10:00:00", false)->has_day);
  const auto clock = written_time("1/0397446444:12345", false);
  ASSERT_TRUE(clock);
  EXPECT_EQ(clock->notation, TimeNotation::kSpacecraft);
  EXPECT_EQ(clock->partition, 1);
  EXPECT_EQ(clock->seconds, 397446444.0);
  EXPECT_EQ(clock->ticks, 12345.0);
  // A point separates a second's ticks only where the mapping says that there are ticks.
  EXPECT_EQ(written_time("397446444.128", false)->notation, TimeNotation::kNumber);
  EXPECT_EQ(written_time("397446444.128", true)->ticks, 128.0);
}

// The times of a column "t", and what was found to be wrong with them.
struct LogTimes {
  std::vector<double> times_s;
  std::vector<std::string> notes;
  std::vector<Fault> faults;
};

LogTimes log_times(ImportClock clock, const std::string& header, const std::vector<std::string>& rows) {
  std::string text = header + "\n";
  for (const std::string& row : rows) text += row + "\n";
  LogTimes read;
  clock.column = "t";
  TableQuestion question{.separator = std::nullopt, .asked = {}, .texts = {"t"}};
  if (!clock.plus_column.empty()) question.texts.insert(clock.plus_column);
  const RecordedTable table = read_recorded_table(text, "log.csv", question, read.faults);
  if (!read.faults.empty()) return read;
  bool as_text = false;
  if (auto times_s = read_times(clock, "log.csv", table, read.notes, as_text, read.faults))
    read.times_s = *times_s;
  if (const auto warning = ticks_as_decimals(clock, table)) read.notes.push_back(*warning);
  return read;
}

TEST(ImportTimes, AreSecondsSinceTheFirstRow) {
  const std::vector<double> expected{0.0, 2.0};
  EXPECT_EQ(log_times({}, "t,x", {"1448560415.0,1", "1448560417.0,2"}).times_s, expected);
  EXPECT_EQ(log_times({.unit = "ns"}, "t,x", {"1448560415000000000,1", "1448560417000000000,2"}).times_s,
            expected);
  EXPECT_EQ(log_times({}, "t,x", {"2023-09-08T23:59:59Z,1", "2023-09-09T00:00:01Z,2"}).times_s, expected);
  EXPECT_EQ(log_times({}, "t,x", {"23:59:59,1", "00:00:01,2"}).times_s, expected);
  EXPECT_EQ(log_times({}, "t;x", {"0,5;1", "2,5;2"}).times_s, expected);
  EXPECT_EQ(log_times({.plus_column = "n"}, "t,n", {"5,999000000", "7,999000000"}).times_s, expected);
  EXPECT_EQ(log_times({.ticks_per_s = 256.0}, "t,x", {"1/100:128,1", "1/102:128,2"}).times_s, expected);
  EXPECT_EQ(log_times({.day_s = 2.0 * 86400.0}, "t,x", {"10:00:00,1", "10:00:01,2"}).times_s, expected);
  EXPECT_EQ(log_times({.plus_column = "u"}, "t,u", {"2023-09-08,23:59:59", "2023-09-09,00:00:01"}).times_s,
            expected);
  EXPECT_EQ(log_times({.unit = "min"}, "t,x", {"10,1", "10.5,2"}).times_s, (std::vector<double>{0.0, 30.0}));
  const std::vector<double> sol = log_times({}, "t,x", {"Sol 5 10:00:00,1", "Sol 6 10:00:00,2"}).times_s;
  ASSERT_EQ(sol.size(), 2U);
  EXPECT_EQ(sol[1], 88775.244);
}

TEST(ImportTimes, SayHowTextIsRead) {
  const LogTimes read = log_times({}, "t,x", {"2023-09-08T10:00:00Z,1", "2023-09-08T10:00:02Z,2"});
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_NE(read.notes[0].find("UTC"), std::string::npos);
}

// Decimals that never reach 256 are ticks; those that do are decimals.
TEST(ImportTimes, TicksThatAreReadAsDecimalsAreTold) {
  std::vector<std::string> ticks, decimals;
  for (int i = 0; i < 20; ++i) {
    ticks.push_back("39744" + std::to_string(1000 + i) + "." + std::to_string(100 + 150 * i % 156) + ",1");
    decimals.push_back("39744" + std::to_string(1000 + i) + "." + std::to_string(100 + 45 * i) + ",1");
  }
  const LogTimes read = log_times({}, "t,x", ticks);
  ASSERT_EQ(read.notes.size(), 1U);
  EXPECT_NE(read.notes[0].find("add the key ticks_per_s = 256 to [clock]"), std::string::npos);
  EXPECT_TRUE(log_times({.ticks_per_s = 256.0}, "t,x", ticks).faults.empty());
  EXPECT_TRUE(log_times({}, "t,x", decimals).notes.empty());
}

void expect_one_fault(const LogTimes& read, const std::string& words) {
  ASSERT_EQ(read.faults.size(), 1U) << words;
  EXPECT_NE(read.faults[0].message.find(words), std::string::npos) << read.faults[0].message;
}

// One fault for each kind, which says how many there are and what mends it.
TEST(ImportTimes, FaultsAreOneForEachKind) {
  expect_one_fault(log_times({}, "t,x", {"1/100:12,1", "1/101:12,2", "1/102:12,3"}), "clock.ticks_per_s");
  expect_one_fault(log_times({}, "t,x", {"soon,1", "later,2", "never,3"}), "\"soon\" is no time");
  expect_one_fault(log_times({}, "t,x", {"soon,1", "later,2", "never,3"}), "so it is in lines 3, 4");
  expect_one_fault(log_times({}, "t,x", {"0,1", ",2", "2,3"}), "line 3 (t): the time is missing");
  expect_one_fault(log_times({.unit = "ns"}, "t,stamp.secs", {"148999929,1", "148999929,2"}),
                   "from = \"stamp.secs\"");
  expect_one_fault(log_times({}, "t,x", {"5,1", "5,2", "6,3"}), "plus = {from = ");
  expect_one_fault(log_times({.unit = "ns"}, "t,x", {"148999929,1", "148999929,2", "148999929,3"}),
                   "plus = {from = \"t\", unit = \"ns\"}");
  expect_one_fault(log_times({.ticks_per_s = 256.0}, "t,x", {"1/100:255,1", "2/0:0,2"}),
                   "partition is 2 after 1");
}

TEST(ImportTables, FaultsOfAColumnAreOneForEachKind) {
  std::vector<Fault> faults;
  const TableQuestion question{.separator = std::nullopt, .asked = {"x"}, .texts = {"t"}};
  read_recorded_table("t,x\n0,1\n1,?\n2,?\n3,?\n", "log.csv", question, faults);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].pointer, "log.csv#/3/x");
  EXPECT_NE(faults[0].message.find("lines 4, 5"), std::string::npos) << faults[0].message;
  // Units below the header.
  faults.clear();
  const RecordedTable table =
      read_recorded_table("t,x,y\ns,m,m\n0,1,2\n1,2,3\n", "log.csv",
                          {.separator = std::nullopt, .asked = {"x", "y"}, .texts = {"t"}}, faults);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.notes.size(), 1U);
}

// Angles between rows lie on the short way between them, and are written as the rows' own.
TEST(ImportDelays, AnglesGoTheShortWayRound) {
  const std::vector<double> time_s{0.0, 2.0};
  const auto half_a_second_later = [&](double before, double after, double turn) {
    return delayed(time_s, {before, after}, 0, 0.5, turn);
  };
  EXPECT_NEAR(half_a_second_later(359.8, 0.2, 360.0), 359.9, 1e-9);
  EXPECT_NEAR(half_a_second_later(359.9, 0.7, 360.0), 0.1, 1e-9);
  EXPECT_NEAR(half_a_second_later(0.2, 359.8, 360.0), 0.1, 1e-9);
  EXPECT_NEAR(half_a_second_later(179.8, -179.8, 360.0), 179.9, 1e-9);
  EXPECT_NEAR(half_a_second_later(-179.9, 179.3, 360.0), 179.9, 1e-9);
  EXPECT_NEAR(half_a_second_later(6.2, 0.1, 2.0 * M_PI), 6.2 + 0.25 * (0.1 + 2.0 * M_PI - 6.2), 1e-9);
  EXPECT_NEAR(half_a_second_later(350.0, 10.0, 0.0), 265.0, 1e-9);  // no angle
  EXPECT_NEAR(half_a_second_later(10.0, 50.0, 360.0), 20.0, 1e-9);
}

TEST(ImportAttitudes, QuaternionsBecomeRollPitchAndYaw) {
  std::vector<Fault> faults;
  // Yaw by 90 deg, then nose down by 30 deg.
  const double c = std::cos(M_PI / 4.0), s = std::sin(M_PI / 4.0), d = std::cos(M_PI / 12.0),
               n = std::sin(M_PI / 12.0);
  const std::string text = "t,x,y,z,w\n0,0,0,0,1\n1," + std::to_string(-s * n) + "," + std::to_string(c * n) +
                           "," + std::to_string(s * d) + "," + std::to_string(c * d) + "\n2,,,,\n";
  const TableQuestion question{.separator = std::nullopt, .asked = {"x", "y", "z", "w"}, .texts = {"t"}};
  const RecordedTable table = read_recorded_table(text, "log.csv", question, faults);
  const auto angles = angles_of_quaternions({.from = {"x", "y", "z", "w"}}, "log.csv", table, faults);
  ASSERT_TRUE(faults.empty());
  EXPECT_NEAR(angles[0][1], 0.0, 1e-3);
  EXPECT_NEAR(angles[1][1], 30.0, 1e-3);
  EXPECT_NEAR(angles[2][1], 90.0, 1e-3);
  EXPECT_TRUE(std::isnan(angles[0][2]) && std::isnan(angles[1][2]) && std::isnan(angles[2][2]));
  angles_of_quaternions({.from = {"t", "y", "z", "w"}}, "log.csv", table, faults);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_NE(faults[0].message.find("must have 1"), std::string::npos);
}

TEST(BestAssignment, CostsLeast) {
  EXPECT_EQ(best_assignment({{1, 2, 3}, {2, 4, 6}, {3, 6, 9}}), (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_EQ(best_assignment({{5, 0, 9}, {9, 5, 0}, {0, 9, 5}}), (std::vector<std::size_t>{1, 2, 0}));
}

}  // namespace
}  // namespace slipway::api
