#include "research/validation/page.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "research/validation/document.h"

namespace slipway::validation {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Page, WritingReplacesOnlyTheTextBetweenTheMarkers) {
  const auto path = std::filesystem::path(testing::TempDir()) / "page.md";
  std::ofstream(path) << "# Title\n\n" << kPageBegin << "old\n" << kPageEnd << "\nlast words\n";
  EXPECT_FALSE(page_holds(path, "new\n").value());
  ASSERT_TRUE(write_page(path, "new\n"));
  EXPECT_TRUE(page_holds(path, "new\n").value());
  EXPECT_FALSE(page_holds(path, "new").value());
  EXPECT_EQ(content_of(path),
            "# Title\n\n" + std::string(kPageBegin) + "new\n" + std::string(kPageEnd) + "\nlast words\n");
}

TEST(Page, WithoutMarkersNothingIsWritten) {
  const auto path = std::filesystem::path(testing::TempDir()) / "bare.md";
  std::ofstream(path) << "no markers\n" << kPageEnd << kPageBegin;
  const auto written = write_page(path, "new\n");
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kUnreadableData);
  EXPECT_EQ(content_of(path).substr(0, 10), "no markers");
  EXPECT_FALSE(page_holds(path.parent_path() / "absent.md", ""));
}

TEST(Report, HoldsOnlyWhileEveryStatedBandDoes) {
  Report report;
  report.title = "t";
  report.columns = {"a"};
  EXPECT_TRUE(report.holds());
  report.bands.push_back({"rms of slip", 0.01, 0.0, 0.02});
  EXPECT_TRUE(report.holds());
  report.bands.push_back({"rms of current", 0.05, 0.0, 0.04});
  EXPECT_FALSE(report.holds());
  EXPECT_NE(report.markdown().find("rms of current in [0, 0.04]: 0.05, DOES NOT HOLD"), std::string::npos);
  EXPECT_EQ(report.markdown().find("Peers"), std::string::npos);
  report.peers = "30 %";
  EXPECT_NE(report.markdown().find("Peers: 30 %"), std::string::npos);
}

TEST(Report, ABandThatIsNotANumberDoesNotHold) {
  const StatedBand band{"rms", std::numeric_limits<double>::quiet_NaN(), 0.0, 1.0};
  EXPECT_FALSE(band.holds());
}

TEST(Document, HasMeasuredPredictedAndErrorOfEveryCase) {
  const Comparison comparison{"ding_2011", "", "", nullptr};
  Outcome outcome{&comparison, {}};
  outcome.report.cases = {{"smooth", "pull", "N", 10.0, 9.0},
                          {"smooth", "torque", "N m", 0.0, 1.0},
                          {"smooth", "side", "N", 2.0, {}}};
  outcome.report.bands = {{"rms", 3.0, 0.0, 1.0}};
  const std::string json = document_of(std::span(&outcome, 1));
  EXPECT_NE(json.find(R"("format":"research/validation/1","holds":false)"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("measured":10,"predicted":9,"error":-1,"relative_error":-0.1})"), std::string::npos);
  EXPECT_NE(json.find(R"("measured":0,"predicted":1,"error":1})"), std::string::npos);
  EXPECT_NE(json.find(R"("quantity":"side","unit":"N","measured":2})"), std::string::npos);
}

TEST(ComparisonCatalogue, NamesAreUniqueAndEveryRowStatesItsSource) {
  for (const Comparison& comparison : comparison_catalogue()) {
    EXPECT_EQ(find_comparison(comparison.name), &comparison);
    EXPECT_FALSE(comparison.summary.empty());
    EXPECT_FALSE(comparison.source.empty());
  }
  EXPECT_EQ(find_comparison("nothing"), nullptr);
}

// Without their data every comparison is an error with a reason, not a crash.
TEST(ComparisonCatalogue, WithoutDataEveryComparisonIsRefused) {
  for (const Comparison& comparison : comparison_catalogue()) {
    const auto report = comparison.run(std::filesystem::path(testing::TempDir()) / "no-data");
    ASSERT_FALSE(report) << comparison.name;
    EXPECT_EQ(report.error().code, ErrorCode::kUnreadableData) << comparison.name;
  }
}

}  // namespace
}  // namespace slipway::validation
