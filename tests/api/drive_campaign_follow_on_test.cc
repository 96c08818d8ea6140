// Of several faults of a campaign each is reported, and what only follows from one of them is not.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "drive_campaign_folder.h"

namespace slipway::api {
namespace {

using testing::DriveCampaignFolder;
using testing::kDocument;
using testing::kHeader;
using testing::kRows;

class DriveCampaignFaults : public DriveCampaignFolder {};

TEST_F(DriveCampaignFaults, AFaultOfTheRoverDoesNotHideThoseOfTheFiles) {
  // What needs the wheels' names is passed over: the last cell is none of a wheel.
  write("a.csv", "t_s,x_m,y_m,z_m,lf_current_a\n0,1,2,abc,x\n1,1,2\n1,1,2,0,1e9\n");
  const auto begin = kDocument.find("\"rover\": {"), end = kDocument.find("\"soils\"");
  const std::string rover = kDocument.substr(begin, end - begin);
  for (const std::string& other : {std::string("\"rover\": \"nasa\", "), std::string(),
                                   std::string("\"rover\": 3, "), std::string("\"rover\": {}, ")}) {
    edit(rover, other);
    expect_fault("campaign.json#/rover" + std::string(other.find("{}") < other.size() ? "/wheels" : ""), "");
    expect_fault("a.csv#/2/z_m", "\"abc\" is no finite number");
    expect_fault("a.csv#/3/z_m", "the row has 3 cells, must have 5");
    const auto faults = load().error().faults;
    EXPECT_EQ(std::count_if(faults.begin(), faults.end(),
                            [](const Fault& fault) { return fault.pointer.starts_with("a.csv"); }),
              2);
  }
}

TEST_F(DriveCampaignFaults, WhatOnlyFollowsFromAFaultIsNotTold) {
  const auto expect_only = [&](const std::string& pointer, const std::string& words) {
    expect_fault(pointer, words);
    EXPECT_EQ(load().error().faults.size(), 1U) << pointer << "  " << load().error().detail;
  };
  edit("\"name\": \"lf\"", "\"name\": 5");
  expect_only("campaign.json#/rover/wheels/0/name", "name = 5, must be a string");
  edit("\"terrains\": {\"level\": {\"dem\": \"level.tif\", \"soil\": \"sand\"}},", "");
  expect_only("campaign.json#/terrains", "terrains is missing");
  edit("\"terrains\": {\"level\": {\"dem\": \"level.tif\", \"soil\": \"sand\"}},", "\"terrains\": {},");
  expect_only("campaign.json#/terrains", "terrains names no terrain");
  const auto begin = kDocument.find("\"soils\""), end = kDocument.find("\"terrains\"");
  edit(kDocument.substr(begin, end - begin), "");
  expect_only("campaign.json#/soils", "soils is missing");
  edit("\"id\": \"a\", ", "");
  expect_only("campaign.json#/drives/0/id", "id is missing");
  edit("\"speed_m_s\": -0.05, \"curvature_1_m\": 0, \"turn_in_place\": true",
       "\"speed_m_s\": 0, \"curvature_1_m\": 0, \"turn_in_place\": 1");
  expect_only("campaign.json#/drives/1/commanded/turn_in_place", "turn_in_place");
  write("a.csv", "t_s\n0\nx\n1\n");
  edit("\"b.csv\"", "\"a.csv\"");
  expect_fault("campaign.json#/drives/1/file", "is that of /drives/0 as well");
  EXPECT_EQ(load().error().faults.size(), 2U);
  write("campaign.json", kDocument);
  expect_only("a.csv#/3/t_s", "\"x\" is no finite number");
  write("a.csv", "t_s\n0\n58\n1e308\n59\n");
  expect_only("a.csv#/4/t_s", "must be in");
}

TEST_F(DriveCampaignFaults, AWrongNameOfARockerBogiesWheelIsToldOnceAndWhereItIs) {
  const std::string averaging =
      "\"suspension\": {\"type\": \"averaging\", \"rocker_pivot_m\": [0, 0.25, 0.3]}";
  const std::string wheel = R"(, "radius_m": 0.1, "width_m": 0.1, "steerable": true})";
  std::string text = kDocument;
  text.replace(text.find(averaging), averaging.size(),
               R"("suspension": {"type": "rocker_bogie", "rocker_pivot_m": [0.1, 0.25, 0.3],
                   "bogie_pivot_m": [-0.2, 0.25, 0.2], "bogie_wheels": ["m", "r"]})");
  text.replace(text.find("{\"name\": \"lr\""), 0,
               R"({"name": "lf", "position_m": [0, 0.3, 0.1])" + wheel +
                   R"(, {"name": "zz", "position_m": [0, -0.3, 0.1])" + wheel + ", ");
  write("campaign.json", text);
  expect_fault("campaign.json#/rover/wheels/1/name", "name = \"lf\" is another wheel's");
  expect_fault("campaign.json#/rover/wheels/2/name", "name = \"zz\" is no wheel of a rocker_bogie");
  EXPECT_EQ(load().error().faults.size(), 2U);
}

TEST_F(DriveCampaignFaults, CellsOfARowWithTooFewOrTooManyAreReadWhereTheyCanOnlyBeNumbers) {
  write("a.csv", "t_s,x_m,y_m,z_m\n0,1,2,0\n1,abc,2\n2,1,abc,0,3\n3\n");
  expect_fault("a.csv#/3/z_m", "the row has 3 cells, must have 4");
  expect_fault("a.csv#/3/x_m", "a.csv, line 3, column 2 (x_m): \"abc\" is no finite number");
  expect_fault("a.csv#/4", "the row has 5 cells, must have 4");
  expect_fault("a.csv#/4/y_m", "\"abc\" is no finite number");
  EXPECT_EQ(load().error().faults.size(), 5U);
  // "blue" may be the sky's, of which any word is good.
  write("a.csv", kHeader + kRows + "3,abc,1,1,blue\n");
  expect_fault("a.csv#/4/x_m", "\"abc\" is no finite number");
  EXPECT_EQ(load().error().faults.size(), 2U);
}

}  // namespace
}  // namespace slipway::api
