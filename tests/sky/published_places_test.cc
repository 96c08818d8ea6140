#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/angle.h"
#include "core/utc.h"
#include "sky/mars_time.h"
#include "tests/sky/degrees_between.h"

namespace slipway::sky {
namespace {

using Row = std::map<std::string, std::string>;

// The rows of a table below its comments, by the names of its columns.
std::vector<Row> rows_of(const std::string& name) {
  std::ifstream file(std::string(SLIPWAY_SKY_DATA "/") + name);
  std::vector<std::string> columns;
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    Row& row = rows.emplace_back();
    for (std::size_t k = 0; k < cells.size(); ++k) row[columns[k]] = cells[k];
  }
  return rows;
}

double number(const Row& row, const std::string& column) {
  return std::stod(row.at(column));
}

Bearing published(const Row& row, const std::string& what) {
  return {rad_from_deg(number(row, what + "_azimuth_deg")),
          rad_from_deg(number(row, what + "_elevation_deg"))};
}

TEST(MarsSun, StandsWhereJplHasIt) {
  const std::vector<Row> rows = rows_of("horizons_sun.csv");
  ASSERT_EQ(rows.size(), 24U);
  double worst_deg = 0.0;
  for (const Row& row : rows)
    worst_deg =
        std::max(worst_deg, degrees_between(mars_sun(utc_of_text(row.at("utc")).value(),
                                                     rad_from_deg(number(row, "east_lon_deg")),
                                                     rad_from_deg(number(row, "planetocentric_lat_deg"))),
                                            published(row, "sun")));
  std::printf("sun within %.4f deg\n", worst_deg);
  EXPECT_LT(worst_deg, 0.01);
}

TEST(MarsSunAndEarth, StandWhereAnotherTheoryHasThem) {
  const std::vector<Row> rows = rows_of("vsop87_sun_and_earth.csv");
  ASSERT_EQ(rows.size(), 24U);
  double sun_deg = 0.0, earth_deg = 0.0, season_deg = 0.0, clock_h = 0.0;
  for (const Row& row : rows) {
    const std::int64_t at = utc_of_text(row.at("utc")).value();
    const double east = rad_from_deg(number(row, "lon_deg")), latitude = rad_from_deg(number(row, "lat_deg"));
    sun_deg = std::max(sun_deg, degrees_between(mars_sun(at, east, latitude), published(row, "sun")));
    earth_deg = std::max(earth_deg, degrees_between(mars_earth(at, east, latitude), published(row, "earth")));
    const MarsTime time = mars_time(at, east);
    season_deg = std::max(season_deg, std::abs(deg_from_rad(time.season_rad) - number(row, "ls_deg")));
    clock_h = std::max(clock_h, std::abs(time.true_solar_h - number(row, "ltst_h")));
  }
  std::printf("sun within %.4f deg, Earth %.4f deg, Ls %.4f deg, true solar time %.1f s\n", sun_deg,
              earth_deg, season_deg, 3600.0 * clock_h);
  EXPECT_LT(sun_deg, 0.01);
  EXPECT_LT(earth_deg, 0.01);
  EXPECT_LT(season_deg, 0.01);
  EXPECT_LT(3600.0 * clock_h, 3.0);
}

}  // namespace
}  // namespace slipway::sky
