#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "dem/elevation_source.h"
#include "planner/problem/terrain_ground.h"
#include "sim/rover/stance.h"
#include "validation/mars/comparisons.h"
#include "validation/report/csv_table.h"
#include "validation/report/scatter_chart.h"
#include "validation/report/statistics.h"

namespace slipway::validation {
namespace {

// The tilt of the least-squares plane through the cells within 1.5 m.
double plane_tilt_rad(const dem::Terrain& terrain, double x_m, double y_m) {
  std::vector<Eigen::Vector3d> points;
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      if (std::hypot(i, j) <= 1.5)
        if (const auto z = terrain.height_m(x_m + i, y_m + j)) points.emplace_back(i, j, *z);
  Eigen::MatrixXd a(points.size(), 3);
  Eigen::VectorXd b(points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    a.row(k) << points[k].x(), points[k].y(), 1.0;
    b[k] = points[k].z();
  }
  const Eigen::Vector3d plane = a.colPivHouseholderQr().solve(b);
  return std::atan(plane.head<2>().norm());
}

std::string words(const char* what, const Agreement& a) {
  return fmt::format("{}: r {:.2f}, rms {:.1f} deg, bias {:+.1f} deg.", what, a.r, a.rms, a.bias);
}

// The report with its title, source and columns, without rows.
Report curiosity_attitude_report() {
  Report report;
  report.title = "Attitude at Curiosity's real stops";
  report.source =
      "32 stops of Curiosity on the Marias Pass DEM: attitude measured by the rover against a "
      "Curiosity-class rover set down on the DEM at the same place and heading";
  report.columns = {"sol",
                    "x m",
                    "y m",
                    "tilt measured deg",
                    "rover set down",
                    "plane fit 3 m",
                    "pitch measured",
                    "predicted",
                    "roll measured",
                    "predicted"};
  return report;
}

}  // namespace

Result<Report> curiosity_attitude(const std::filesystem::path& data) {
  Report report = curiosity_attitude_report();
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("msl-class");
  const std::filesystem::path gale = data / "terrains" / "gale";
  const auto stops =
      CsvTable::read(gale / "curiosity_stops.csv",
                     {.numbers = {"sol", "x_m", "y_m", "yaw_deg", "tilt_deg", "pitch_deg", "roll_deg"},
                      .numbers_or_empty = {},
                      .texts = {}});
  if (!stops) return fail(stops.error());
  const auto source = dem::open_elevation((gale / "elevation.tif").string());
  if (!source) return fail(source.error());
  const auto terrain = (*source)->read((*source)->info().geometry.extent());
  if (!terrain) return fail(terrain.error());
  const planner::TerrainGround ground(*terrain, nullptr);

  std::vector<double> tilt_measured, settled, plane, pitch_measured, pitch, roll_measured, roll;
  for (std::size_t k = 0; k < stops->rows(); ++k) {
    // The rover reports yaw clockwise from north, pitch positive nose up and roll positive left side up.
    const Pose2 pose{stops->number(k, "x_m"), stops->number(k, "y_m"),
                     rad_from_deg(90.0 - stops->number(k, "yaw_deg"))};
    const auto stance = sim::settle(rover, ground, pose);
    if (!stance) return fail(ErrorCode::kNoData, fmt::format("no ground under the rover at stop {}", k + 1));
    tilt_measured.push_back(stops->number(k, "tilt_deg"));
    settled.push_back(deg_from_rad(stance->attitude.tilt_rad()));
    plane.push_back(deg_from_rad(plane_tilt_rad(**terrain, pose.x_m, pose.y_m)));
    pitch_measured.push_back(stops->number(k, "pitch_deg"));
    pitch.push_back(-deg_from_rad(stance->attitude.pitch_rad));
    roll_measured.push_back(stops->number(k, "roll_deg"));
    roll.push_back(deg_from_rad(stance->attitude.roll_rad));
    const std::string sol = fmt::format("{:.0f}", stops->number(k, "sol"));
    report.rows.push_back({sol, fmt::format("{:.0f}", pose.x_m), fmt::format("{:.0f}", pose.y_m),
                           fmt::format("{:.1f}", tilt_measured.back()), fmt::format("{:.1f}", settled.back()),
                           fmt::format("{:.1f}", plane.back()), fmt::format("{:.1f}", pitch_measured.back()),
                           fmt::format("{:.1f}", pitch.back()), fmt::format("{:.1f}", roll_measured.back()),
                           fmt::format("{:.1f}", roll.back())});
    report.cases.push_back({"sol " + sol, "tilt", "deg", tilt_measured.back(), settled.back()});
    report.cases.push_back({"sol " + sol, "pitch", "deg", pitch_measured.back(), pitch.back()});
    report.cases.push_back({"sol " + sol, "roll", "deg", roll_measured.back(), roll.back()});
  }
  const Agreement tilt = agreement(settled, tilt_measured);
  report.notes.push_back(words("Tilt of the rover set down", tilt));
  report.notes.push_back(words("Tilt of a 3 m plane fit", agreement(plane, tilt_measured)));
  report.notes.push_back(words("Pitch of the rover set down", agreement(pitch, pitch_measured)));
  report.notes.push_back(words("Roll of the rover set down", agreement(roll, roll_measured)));
  report.notes.push_back(
      "The DEM's cells are 1 m wide and its heights are smoother than the ground under a wheel. "
      "The residual is due to what the map does not show, and a plan's tilt is uncertain by as "
      "much.");
  report.bands = {{"stops", static_cast<double>(stops->rows()), 32, 32},
                  {"rms of tilt, deg", tilt.rms, 0.0, 4.5}};
  const api::Chart panels[] = {scatter_chart("tilt, deg", tilt_measured, settled),
                               scatter_chart("pitch, deg", pitch_measured, pitch),
                               scatter_chart("roll, deg", roll_measured, roll)};
  report.plot = api::draw_charts(report.title, panels);
  return report;
}

}  // namespace slipway::validation
