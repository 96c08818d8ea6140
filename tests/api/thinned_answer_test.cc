// Long drives: their documents show so many stations that what is drawn of them looks the same, and the whole
// table is kept in pages.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "api/documents/drive_series.h"
#include "api/documents/prediction_answer.h"
#include "api/export/station_csv.h"
#include "api/job_kinds.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/service_drives.h"
#include "small_world.h"

namespace slipway::api {
namespace {

using json::JsonValue;

sim::DrivePrediction drive_of(std::size_t stations) {
  sim::DrivePrediction drive;
  drive.stations.resize(stations);
  for (std::size_t k = 0; k < stations; ++k) drive.stations[k].slip_ratio_p95 = 0.1;
  return drive;
}

TEST(ShownStations, AreAllWhereThereAreFew) {
  const auto shown = json::shown_stations(drive_of(7), 7);
  ASSERT_EQ(shown.size(), 7u);
  for (std::size_t k = 0; k < shown.size(); ++k) EXPECT_EQ(shown[k], k);
  EXPECT_TRUE(json::shown_stations(drive_of(0), 7).empty());
}

TEST(ShownStations, KeepBothEndsAndEveryPeak) {
  sim::DrivePrediction drive = drive_of(10'001);
  drive.stations[1234].slip_ratio_p95 = 0.5;
  drive.stations[5678].current_a_p95 = 2.0;
  drive.stations[9000].attitude.roll_rad = 0.3;
  for (const std::size_t most : {1u, 2u, 6u, 500u, 10'000u}) {
    const auto shown = json::shown_stations(drive, most);
    EXPECT_LE(shown.size(), std::max<std::size_t>(most, 5)) << most;
    EXPECT_TRUE(std::is_sorted(shown.begin(), shown.end()));
    EXPECT_EQ(shown.front(), 0u);
    EXPECT_EQ(shown.back(), 10'000u);
    for (const std::size_t peak : {1234u, 5678u, 9000u})
      EXPECT_TRUE(std::binary_search(shown.begin(), shown.end(), peak)) << most << ", station " << peak;
  }
}

// To and fro over the yard, some kilometres.
std::string long_request(int ways) {
  std::string path;
  for (int k = 0; k < ways; ++k)
    path +=
        fmt::format(R"({}{{"x_m":{},"y_m":{}}})", k == 0 ? "" : ",", k % 2 == 0 ? 20 : 40, 20.0 + 0.1 * k);
  return R"({"terrain":"yard","rover":"mer-class","draws":2,"path":[)" + path + "]}";
}

TEST(ThinnedAnswer, IsSmallAndItsTableIsWhole) {
  const Service& service = testing::small_world();
  const std::string request = long_request(160);
  NoProgress progress;
  const auto kept = service_work(service)(std::string(kPredictionKind), request, progress);
  ASSERT_TRUE(kept) << kept.error().detail;
  const auto prediction = run_prediction(service, read_prediction(service, request).value(), progress);
  ASSERT_TRUE(prediction);
  const std::size_t all = prediction->prediction.stations.size(), most = json::max_stations_shown(1);
  ASSERT_GT(all, most) << "the drive is not long enough for this test";
  const auto document = json::parse(kept->bytes, {.bytes = kept->bytes.size(), .values = kept->bytes.size()});
  ASSERT_TRUE(document);
  const JsonValue& feature = json::at(json::at(*document, "routes"), "features").elements.front();
  const JsonValue& stations = json::at(json::at(feature, "properties"), "stations");
  const auto shown = static_cast<std::size_t>(json::number(stations, "count"));
  EXPECT_LE(shown, most);
  EXPECT_EQ(json::number(stations, "thinned_from"), static_cast<double>(all));
  EXPECT_EQ(json::at(stations, "slip").elements.size(), shown);
  EXPECT_EQ(json::at(json::at(feature, "geometry"), "coordinates").elements.size(), shown);
  std::string table;
  for (const std::string& page : kept->series) {
    EXPECT_LT(page.size(), 1'100'000u);
    EXPECT_EQ(page.back(), '\n');
    table += page;
  }
  EXPECT_EQ(table,
            *json::station_csv(json::write_prediction_answer(*prediction, json::StationDetail::kWhole)));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), static_cast<std::ptrdiff_t>(all + 1));
}

TEST(ThinnedAnswer, AShortDriveIsKeptWholeWithoutATable) {
  NoProgress progress;
  const auto kept =
      service_work(testing::small_world())(std::string(kPredictionKind), long_request(3), progress);
  ASSERT_TRUE(kept) << kept.error().detail;
  EXPECT_TRUE(kept->series.empty());
  EXPECT_EQ(kept->bytes.find("thinned_from"), std::string::npos);
}

}  // namespace
}  // namespace slipway::api
