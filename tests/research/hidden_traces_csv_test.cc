#include "research/sealed_set/hidden_traces_csv.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slipway::api {
namespace {

const std::string kTracesHeader =
    "campaign,drive,slope_deg,cross_slope_deg,slip,speed_m_s,curvature_1_m,temperature_c,turning,time_s,"
    "slip_mean_square,side_slip_mean_square,yaw_rate_mean_square,roll_mean_square,pitch_mean_square,"
    "current_mean_square,sinkage_mean_square\n";

std::vector<Fault> faults_of(const std::string& text) {
  const auto traces = read_hidden_traces_csv("traces.csv", text);
  return traces ? std::vector<Fault>{} : traces.error().faults;
}

bool has(const std::vector<Fault>& faults, const std::string& place, const std::string& words) {
  return std::any_of(faults.begin(), faults.end(), [&](const Fault& fault) {
    return fault.pointer == place && fault.message.find(words) != std::string::npos;
  });
}

TEST(HiddenTracesCsv, AreByCampaignWithWhatIsNotObservedLeftOut) {
  const auto traces = read_hidden_traces_csv(
      "traces.csv", kTracesHeader + "s01,D001,-5,1,0.1,-0.04,0.4,20,0,15,1.5,2,3,0,0,4,\n" +
                        "s03,D002,0,0,0.1,0,0,-40,1,10,1,,,0,0,0,0\n" +
                        "s01,D002,0,0,0,0.05,0,0,0,5,,,,,,,\n");
  ASSERT_TRUE(traces);
  ASSERT_EQ(traces->size(), 2u);
  ASSERT_EQ(traces->at("s01").size(), 2u);
  const gap::HiddenTrace& first = traces->at("s01").front();
  EXPECT_EQ(first.drive, "D001");
  EXPECT_EQ(first.at.slope_deg, -5.0);
  EXPECT_EQ(first.at.curvature_1_m, 0.4);
  EXPECT_EQ(first.at.time_s, 15.0);
  EXPECT_EQ(first.mean_square[static_cast<std::size_t>(gap::Channel::kCurrent)], 4.0);
  EXPECT_FALSE(first.mean_square[static_cast<std::size_t>(gap::Channel::kSinkage)]);
  EXPECT_EQ(traces->at("s03").front().at.turning, 1.0);
}

// Not a million faults, each with the name that was probably meant.
TEST(HiddenTracesCsv, AMillionColumnsAreRefusedAtOnce) {
  std::string header = "campaign";
  for (int c = 0; c < 1'000'000; ++c) header += "," + std::to_string(c);
  EXPECT_EQ(faults_of(header + "\n").size(), 1U + 17U) << "too many, and so none of those that must be there";
}

TEST(HiddenTracesCsv, WithoutRowsNothingIsHidden) {
  const auto traces = read_hidden_traces_csv("traces.csv", kTracesHeader);
  ASSERT_TRUE(traces);
  EXPECT_TRUE(traces->empty());
  EXPECT_TRUE(has(faults_of(""), "traces.csv", "empty"));
}

TEST(HiddenTracesCsv, NamesEveryFaultWithItsLineAndColumn) {
  const auto faults = faults_of(kTracesHeader + "s01,,x,1,0.1,0.04,0,20,0,15,-1,2,3,0,0,4,0\n" +
                                "s01,D001,0,,0.1,0.04,0,20,0,15,1,2,3,0,0,nan,0\n" + "s01,D001,0\n");
  EXPECT_TRUE(has(faults, "traces.csv, line 2, column 2 (drive)", "missing"));
  EXPECT_TRUE(has(faults, "traces.csv, line 2, column 3 (slope_deg)", "is no number"));
  EXPECT_TRUE(has(faults, "traces.csv, line 2, column 11 (slip_mean_square)", "must be 0 or more"));
  EXPECT_TRUE(has(faults, "traces.csv, line 3, column 4 (cross_slope_deg)", "missing"));
  EXPECT_TRUE(has(faults, "traces.csv, line 3, column 16 (current_mean_square)", "is no number"));
  EXPECT_TRUE(has(faults, "traces.csv, line 4", "3 cells, must be 17"));
  EXPECT_EQ(faults.size(), 6u);
}

TEST(HiddenTracesCsv, NamesEveryFaultOfTheHeader) {
  std::string header = kTracesHeader;
  header.replace(header.find("slope_deg"), 9, "slop_deg");
  header.replace(header.find("pitch_mean_square"), 17, "roll_mean_square");
  const auto faults = faults_of(header);
  EXPECT_TRUE(has(faults, "traces.csv, line 1, column 3", "slop_deg"));
  EXPECT_TRUE(has(faults, "traces.csv, line 1, column 15", "there twice"));
  EXPECT_TRUE(has(faults, "traces.csv, line 1", "no column slope_deg"));
  EXPECT_TRUE(has(faults, "traces.csv, line 1", "no column pitch_mean_square"));
  EXPECT_EQ(faults.size(), 4u);
}

}  // namespace
}  // namespace slipway::api
