// Two answers, or two routes of one, side by side.
#include "api/documents/answer_comparison.h"

#include <gtest/gtest.h>

#include "api/documents/check_answer.h"
#include "api/documents/plan_answer.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::at;
using json::JsonValue;
using json::number;
using json::text;

std::string planned(const std::string& members) {
  const Service& service = testing::small_world();
  const auto read = read_plan(
      service,
      R"({"terrain":"yard","rover":"mer-class","start":{"x_m":20,"y_m":30},"goal":{"x_m":30,"y_m":34},"routes":2,"draws":2)" +
          members + "}");
  EXPECT_TRUE(read);
  NoProgress progress;
  const auto plan = run_plan(service, *read, progress);
  EXPECT_TRUE(plan) << plan.error().detail;
  return json::write_plan_answer(*plan);
}

TEST(CompareAnswers, SaysWhatDiffersInTheRequestsAndByHowMuchInTheRoutes) {
  const std::string slow = planned(R"(,"speed_m_s":0.02)"), quick = planned(R"(,"speed_m_s":0.04)");
  const auto comparison = json::compare_answers(slow, quick, std::nullopt);
  ASSERT_TRUE(comparison) << comparison.error().detail;
  const auto document = json::parse(*comparison);
  EXPECT_EQ(text(*document, "format"), "answer-comparison/1");
  const auto& changes = at(*document, "changed_in_request").elements;
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(text(changes[0], "key"), "/speed_m_s");
  EXPECT_EQ(number(changes[0], "a"), 0.02);
  EXPECT_EQ(number(changes[0], "b"), 0.04);
  const JsonValue& first = at(*document, "routes").elements.at(0);
  const double duration_a = number(at(first, "a"), "duration_s"),
               duration_b = number(at(first, "b"), "duration_s");
  EXPECT_GT(duration_a, duration_b);
  bool found = false;
  for (const JsonValue& row : at(first, "differences").elements) {
    if (text(row, "figure") != "duration_s") continue;
    found = true;
    EXPECT_NEAR(number(row, "b_less_a"), duration_b - duration_a, 0.01 * duration_a);
  }
  EXPECT_TRUE(found);
  EXPECT_TRUE(at(at(first, "a"), "expected_stops").is(JsonValue::Kind::kObject)) << "with its interval";
}

TEST(CompareAnswers, AnAnswerAndItselfDifferInNothing) {
  const std::string plan = planned("");
  const auto document = json::parse(*json::compare_answers(plan, plan, std::nullopt));
  EXPECT_TRUE(at(*document, "changed_in_request").elements.empty());
  for (const JsonValue& pair : at(*document, "routes").elements) {
    EXPECT_EQ(number(pair, "apart_m"), 0.0);
    for (const JsonValue& row : at(pair, "differences").elements) {
      EXPECT_EQ(number(row, "b_less_a"), 0.0);
      EXPECT_FALSE(at(row, "intervals_apart").boolean);
    }
  }
}

TEST(CompareAnswers, TwoRoutesOfOnePlanAreChosenByTheirRanks) {
  const std::string plan = planned("");
  const auto document = json::parse(*json::compare_answers(plan, plan, json::ComparedRoutes{2, 1}));
  const auto& pairs = at(*document, "routes").elements;
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(number(at(pairs[0], "a"), "rank"), 2.0);
  EXPECT_EQ(number(at(pairs[0], "b"), "rank"), 1.0);
  EXPECT_GT(number(pairs[0], "apart_m"), 0.0);
  const auto none = json::compare_answers(plan, plan, json::ComparedRoutes{9, 0});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().faults.size(), 2U);
}

TEST(CompareAnswers, RefusesWhatCannotBeCompared) {
  const std::string plan = planned("");
  EXPECT_EQ(json::compare_answers("{", plan, {}).error().faults.at(0).pointer, "/a");
  EXPECT_EQ(json::compare_answers(plan, R"({"format":"diagnosis/1"})", {}).error().faults.at(0).pointer,
            "/b");
  EXPECT_EQ(json::compare_answers(plan, R"({"format":"check/1"})", {}).error().faults.at(0).pointer, "/b");
}

TEST(CompareAnswers, ChecksAreComparedWithTheIntervalsOfTheirStopsAndEmbeddings) {
  const Service& service = testing::small_world();
  const auto checked = [&](const char* more) {
    NoProgress progress;
    const auto read = read_check(
        service,
        std::string(
            R"({"terrain":"yard","rover":"mer-class","path":[{"x_m":20,"y_m":30},{"x_m":24,"y_m":30}],"draws":4)") +
            more + "}");
    EXPECT_TRUE(read);
    return json::write_check_answer(*run_check(service, *read, progress));
  };
  const auto document =
      json::parse(*json::compare_answers(checked(""), checked(R"(,"limits":{"max_slip":0.01})"), {}));
  EXPECT_EQ(text(at(*document, "changed_in_request").elements.at(0), "key"), "/limits/max_slip");
  const JsonValue& pair = at(*document, "routes").elements.at(0);
  EXPECT_FALSE(text(at(pair, "a"), "verdict").empty());
  EXPECT_GE(number(at(at(pair, "b"), "expected_stops"), "value"),
            number(at(at(pair, "a"), "expected_stops"), "value"));
}

}  // namespace
}  // namespace slipway::api
