#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "api/json/parse.h"
#include "api/openapi.h"
#include "gap/diagnosis/model/channel.h"
#include "gap/diagnosis/model/noise_model.h"

namespace slipway::api {
namespace {

using gap::Channel;
using json::JsonValue;

TEST(ChannelCatalogue, ItsRowsStandInTheOrderOfTheNamesThatCodeSpeaksOf) {
  EXPECT_EQ(gap::name_of(Channel::kSlip), "slip");
  EXPECT_EQ(gap::name_of(Channel::kSideSlip), "side_slip");
  EXPECT_EQ(gap::name_of(Channel::kYawRate), "yaw_rate");
  EXPECT_EQ(gap::name_of(Channel::kRoll), "roll");
  EXPECT_EQ(gap::name_of(Channel::kPitch), "pitch");
  EXPECT_EQ(gap::name_of(Channel::kCurrent), "current");
  EXPECT_EQ(gap::name_of(Channel::kSinkage), "sinkage");
}

TEST(ChannelCatalogue, EveryRowIsWholeAndTheRoversComeFirst) {
  std::set<std::string_view> names;
  bool wheels = false;
  for (const gap::ChannelRow& row : gap::channel_catalogue()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_FALSE(row.unit.empty()) << row.name;
    EXPECT_FALSE(row.chart_unit.empty()) << row.name;
    EXPECT_GT(row.boundary_unit, 0.0) << row.name;
    EXPECT_GT(row.chart_scale, 0.0) << row.name;
    ASSERT_NE(row.observe, nullptr) << row.name;
    ASSERT_NE(row.predict, nullptr) << row.name;
    EXPECT_GT(row.left_over(gap::NoiseScales{}, 1.0), 0.0) << row.name;
    EXPECT_EQ(row.column.name.empty(), row.column.set == nullptr) << row.name;
    EXPECT_TRUE(row.per_wheel || !wheels) << row.name << " comes behind a wheel's channel";
    wheels = wheels || row.per_wheel;
  }
  EXPECT_EQ(names.size(), gap::channel_count());
}

// Every list of values in a document that has `word` in it.
void find_lists(const JsonValue& value, const std::string& word,
                std::vector<std::vector<std::string>>& lists) {
  if (value.is(JsonValue::Kind::kArray)) {
    std::vector<std::string> texts;
    for (const JsonValue& element : value.elements)
      if (element.is(JsonValue::Kind::kString)) texts.push_back(element.text);
    if (std::find(texts.begin(), texts.end(), word) != texts.end()) lists.push_back(texts);
  }
  for (const JsonValue& element : value.elements) find_lists(element, word, lists);
}

TEST(ChannelCatalogue, TheDescriptionOfTheServiceListsItsChannels) {
  std::vector<std::string> names;
  for (const gap::ChannelRow& row : gap::channel_catalogue()) names.emplace_back(row.name);
  std::vector<std::vector<std::string>> lists;
  find_lists(json::parse(openapi_document()).value(), "side_slip", lists);
  EXPECT_GE(lists.size(), 7U);
  for (const auto& list : lists) EXPECT_EQ(list, names);
}

}  // namespace
}  // namespace slipway::api
