#include "gap/diagnosis/search/diagnosis_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

namespace slipway::gap {
namespace {

std::vector<double> value_of(const std::vector<ListedOption>& options, std::string_view step,
                             std::string_view name) {
  for (const ListedOption& option : options)
    if (option.step == step && option.name == name) return option.values;
  return {};
}

TEST(DiagnosisOptions, AreListedOnceEachWithTheStepsTogether) {
  const std::vector<ListedOption> options = listed_options({});
  std::set<std::pair<std::string_view, std::string_view>> names;
  std::set<std::string_view> steps;
  std::string_view last;
  for (const ListedOption& option : options) {
    EXPECT_TRUE(names.emplace(option.step, option.name).second) << option.step << "." << option.name;
    if (option.step != last) {
      EXPECT_TRUE(steps.insert(option.step).second) << option.step << " is torn apart";
    }
    last = option.step;
    ASSERT_FALSE(option.values.empty());
    EXPECT_TRUE(option.list || option.values.size() == 1);
  }
  EXPECT_GT(options.size(), 120U);
}

TEST(DiagnosisOptions, AreListedWithTheirOwnValues) {
  DiagnosisOptions changed;
  changed.fit.huber = 3.25;
  changed.search.something_else = false;
  changed.evidence.share = 0.125;
  changed.location.place_radii_m = {7.0, 9.0};
  changed.resamples = 17;
  changed.noise.initial.friction = 0.5;
  const std::vector<ListedOption> options = listed_options(changed);
  EXPECT_EQ(value_of(options, "fit", "huber"), std::vector{3.25});
  EXPECT_EQ(value_of(options, "search", "something_else"), std::vector{0.0});
  EXPECT_EQ(value_of(options, "evidence", "share"), (std::vector{0.125}));
  EXPECT_EQ(value_of(options, "location", "place_radii_m"), (std::vector{7.0, 9.0}));
  EXPECT_EQ(value_of(options, "run", "resamples"), std::vector{17.0});
  EXPECT_EQ(value_of(options, "noise", "friction"), std::vector{0.5});
}

// The method's page has a row for each, with the value that it has unless somebody asks otherwise.
TEST(DiagnosisOptions, AreAllOnTheMethodsPage) {
  std::ifstream file(std::string(SLIPWAY_DOCS_FOLDER) + "/method/estimator.md");
  std::stringstream page;
  page << file.rdbuf();
  ASSERT_FALSE(page.str().empty());
  std::size_t rows = 0;
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| `") && line.find(".", 3) < line.find("`", 3) && line.find("` | ") != line.npos)
      ++rows;
  EXPECT_EQ(rows, listed_options({}).size()) << "an option that is no more, or one that is there twice";
  for (const ListedOption& option : listed_options({})) {
    std::vector<std::string> values;
    for (const double value : option.values) values.push_back(fmt::format("{:.6g}", value));
    const std::string row =
        fmt::format("| `{}.{}` | {} |", option.step, option.name, fmt::join(values, ", "));
    EXPECT_NE(page.str().find(row), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace slipway::gap
