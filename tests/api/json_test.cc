#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "api/files/parameter_posterior.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "api/json/problem_document.h"
#include "api/json/strict_reader.h"
#include "api/json/writer.h"

namespace slipway::api::json {
namespace {

TEST(Parse, SyntaxErrorNamesLineAndColumn) {
  const auto document = parse("{\"a\": 1,\n \"b\" 2}");
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().code, ErrorCode::kMalformedJson);
  EXPECT_TRUE(document.error().detail.starts_with("line 2, column 6: ")) << document.error().detail;
  EXPECT_EQ(document.error().detail.find("json.exception"), std::string::npos);
}

TEST(Parse, RefusesWhatIsNotJson) {
  for (const char* text : {"", " ", "{", "[1,]", "{\"a\":NaN}", "[Infinity]", "[-Infinity]", "[1e999]",
                           "[01]", "nul", "{} {}", "[\"\xff\"]", "{'a':1}", "[1] // no", "\"\\ud800\""}) {
    const auto document = parse(text);
    ASSERT_FALSE(document) << text;
    EXPECT_EQ(document.error().code, ErrorCode::kMalformedJson) << text;
    EXPECT_FALSE(document.error().faults.empty()) << text;
  }
}

TEST(Parse, MessagesHoldNoBytesThatAreNotText) {
  const auto document = parse("[\"\xff\xfe");
  ASSERT_FALSE(document);
  for (const char c : document.error().detail) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << document.error().detail;
}

TEST(Parse, RefusesAKeyGivenTwiceAtItsPlace) {
  const auto document = parse(R"({"limits": {"max_slip": 0.4, "max_slip": 0.9}})");
  ASSERT_FALSE(document);
  EXPECT_EQ(document.error().faults.front(), (Fault{"/limits/max_slip", "key \"max_slip\" is given twice"}));
}

TEST(Parse, RefusesDepthAbove64AndReadsDepth64) {
  const auto nested = [](int depth) { return std::string(depth, '[') + std::string(depth, ']'); };
  EXPECT_TRUE(parse(nested(64)));
  const auto refused = parse(nested(65));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().detail, "nested deeper than 64 levels");
  EXPECT_FALSE(parse(std::string(1'000'000, '[')));
}

TEST(Parse, RefusesTooManyBytesAndTooManyValues) {
  EXPECT_EQ(parse("[1, 2, 3]", {.bytes = 8}).error().code, ErrorCode::kPayloadTooLarge);
  EXPECT_FALSE(parse("[1, 2, 3]", {.values = 3}));
  EXPECT_TRUE(parse("[1, 2, 3]", {.values = 4}));
}

TEST(Writer, WhatIsNoUtf8BecomesTheReplacementCharacter) {
  const std::string replaced = "\xEF\xBF\xBD";
  const auto written = [](std::string_view text) { return Writer().text(text).take(); };
  EXPECT_EQ(written("a\xffz"), "\"a" + replaced + "z\"");
  EXPECT_EQ(written("\xc3\x28"), "\"" + replaced + "(\"") << "half a character";
  EXPECT_EQ(written("\xed\xa0\x80"), "\"" + replaced + replaced + replaced + "\"") << "half a UTF-16 pair";
  EXPECT_EQ(written("\xc0\xaf"), "\"" + replaced + replaced + "\"") << "longer than needed";
  EXPECT_EQ(written("m\xc3\xa4rz \xf0\x9f\x9a\x80"), "\"m\xc3\xa4rz \xf0\x9f\x9a\x80\"");
  EXPECT_TRUE(parse(Writer().begin_object().text("a\xff", "\xfe").end_object().take()));
}

TEST(Problem, HoldsNoMoreOfWhatWasSentThanAnAnswerMay) {
  const std::string megabyte(1'000'000, 'a');
  Error error{ErrorCode::kInvalidRequest, megabyte, {}};
  for (int k = 0; k < 5000; ++k)
    error.faults.push_back({"/" + megabyte.substr(0, 2000), megabyte.substr(0, 5000)});
  const std::string written = write_problem(error);
  EXPECT_LT(written.size(), 200'000U);
  const Error read = read_problem(written);
  ASSERT_EQ(read.faults.size(), 100U);
  EXPECT_EQ(read.faults.back().message, "and 4901 faults more");
  EXPECT_TRUE(read.faults.front().message.ends_with("aaa..."));
  EXPECT_EQ(write_problem(read), written) << "what is stored is told as it was";
}

TEST(StrictReader, NamesEveryFaultAtOnce) {
  const auto document =
      parse(R"({"max_slope_deg": 212, "routes": 2.5, "name": 7, "list": [1, "x", 5], "surprise": 1,
                                  "max_tilt": 3, "flag": 0, "inner": []})");
  ASSERT_TRUE(document);
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  double slope = 1.5;
  double tilt = 0.25;
  int routes = 3;
  std::string name = "unchanged";
  bool flag = true;
  std::vector<double> list;
  EXPECT_FALSE(reader.number("max_slope_deg", kOptional, {"deg", 0.0, 60.0}, slope));
  reader.whole("routes", kOptional, 1, 8, routes);
  reader.text("name", kRequired, {}, name);
  reader.numbers("list", kRequired, {1, 3}, {"m", 0.0, 4.0}, list);
  reader.angle_deg("max_tilt_deg", kOptional, {"deg", 0.0, 60.0}, tilt);
  reader.boolean("flag", kOptional, flag);
  EXPECT_FALSE(reader.object("inner", kOptional));
  reader.number("goal", kRequired, {}, slope);
  reader.refuse_unknown();
  const std::vector<Fault> expected{
      {"/max_slope_deg", "max_slope_deg = 212 deg, must be in [0, 60]"},
      {"/routes", "routes = 2.5, must be a whole number in [1, 8]"},
      {"/name", "name = 7, must be a string"},
      {"/list/1", "list[1] = \"x\", must be a number in m"},
      {"/list/2", "list[2] = 5 m, must be in [0, 4]"},
      {"/flag", "flag = 0, must be true or false"},
      {"/inner", "inner = a list of 0, must be an object"},
      {"/goal", "goal is missing"},
      {"/surprise",
       "unknown key \"surprise\"; known: max_slope_deg, routes, name, list, max_tilt_deg, flag, inner, goal"},
      {"/max_tilt",
       "unknown key \"max_tilt\"; did you mean \"max_tilt_deg\"? known: max_slope_deg, routes, name, list, "
       "max_tilt_deg, flag, inner, goal"}};
  EXPECT_EQ(faults, expected);
  EXPECT_EQ(slope, 1.5) << "nothing is clamped, converted or half read";
  EXPECT_EQ(tilt, 0.25);
  EXPECT_EQ(routes, 3);
  EXPECT_EQ(name, "unchanged");
  EXPECT_TRUE(list.empty());
}

TEST(StrictReader, EscapesPointers) {
  EXPECT_EQ(child_pointer("/a", "x/y~z"), "/a/x~1y~0z");
}

TEST(StrictReader, NamesAreNamesOnly) {
  for (const char* bad : {"../etc", "Gale", "a b", "gale/x", "/vsicurl/http", "caf\xc3\xa9", ""}) {
    JsonValue value;
    value.kind = JsonValue::Kind::kString;
    value.text = bad;
    std::vector<Fault> faults;
    std::string out;
    EXPECT_FALSE(read_text(value, "", "name", {.is_name = true}, out, faults)) << bad;
    EXPECT_EQ(faults.size(), 1U);
  }
}

TEST(Faults, NearestForgivesASlipAndNotMore) {
  const std::vector<std::string> known{"mer-class", "fido-class", "zhurong-class"};
  EXPECT_EQ(nearest("mer_class", known), "mer-class");
  EXPECT_EQ(nearest("mer", known), "mer-class");
  EXPECT_EQ(nearest("spirit", known), std::nullopt);
}

TEST(Writer, WritesTheSameNumberInTheFewestDigits) {
  Writer w;
  w.begin_array()
      .exact(0.1)
      .exact(-0.0)
      .exact(1e300)
      .significant(1.0 / 3.0)
      .metres(1234567.0004)
      .metres(-0.0001);
  w.angle_deg(0.4363323129985824).text("a\"\\\n\x01").end_array();
  EXPECT_EQ(w.take(), "[0.1,0,1e+300,0.333333,1234567,0,25,\"a\\\"\\\\\\n\\u0001\"]");
}

TEST(Writer, RefusesNumbersThatAreNotFinite) {
  Writer w;
  w.begin_object();
  try {
    w.exact("mean_slip", std::numeric_limits<double>::quiet_NaN());
    FAIL();
  } catch (const std::domain_error& broken) {
    EXPECT_STREQ(broken.what(), "mean_slip is not finite in an answer");
  }
}

TEST(Writer, ADocumentReadsBackAsItself) {
  const std::string bytes = R"({"a":[1,2.5,{"b":null}],"c":true,"d":"x","e":{},"f":[]})";
  const auto document = parse(bytes);
  ASSERT_TRUE(document);
  Writer w;
  write_value(w, *document);
  EXPECT_EQ(w.take(), bytes);
}

TEST(ParameterPosterior, OfCorrelationsThatContradictOrAreMissingIsRefusedAtItsPlace) {
  const auto faults_of = [](const char* text) {
    std::vector<Fault> faults;
    const auto document = parse(text);
    ObjectReader reader(*document, "", faults);
    read_parameter_posterior(reader);
    return faults;
  };
  EXPECT_TRUE(faults_of("{}").empty());
  const auto missing = faults_of(R"({"left_open": [{"name": "n", "deviation": -1, "correlation": []},
                                                   {"name": "c1", "deviation": 0.1, "correlation": []}]})");
  ASSERT_EQ(missing.size(), 2U);
  EXPECT_EQ(missing[0].pointer, "/left_open/0/deviation");
  EXPECT_EQ(missing[1].pointer, "/left_open/1/correlation");
  const auto contradicting = faults_of(
      R"({"left_open": [{"name": "n", "deviation": 1, "correlation": []},
                        {"name": "c1", "deviation": 1, "correlation": [0.9]},
                        {"name": "c2", "deviation": 1, "correlation": [0.9, -0.9]}]})");
  ASSERT_EQ(contradicting.size(), 1U);
  EXPECT_EQ(contradicting[0].pointer, "/left_open");
}

TEST(Problem, ReadsBackAsTheErrorThatItWas) {
  const Error error{ErrorCode::kNoData, "no ground", {{"/path/3", "no elevation \"there\""}, {"", "x"}}};
  const Error read = read_problem(write_problem(error));
  EXPECT_EQ(read.code, error.code);
  EXPECT_EQ(read.detail, error.detail);
  EXPECT_EQ(read.faults, error.faults);
  EXPECT_EQ(read_problem("nonsense").code, ErrorCode::kInternal);
}

}  // namespace
}  // namespace slipway::api::json
