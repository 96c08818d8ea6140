#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "api/catalogue.h"
#include "core/angle.h"
#include "dem/elevation_source.h"
#include "planner/terrain_ground.h"
#include "sim/stance.h"
#include "tests/validation/report.h"

namespace slipway::validation {
namespace {

using Row = std::map<std::string, double>;

std::vector<Row> read_stops(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot open " + path);
  std::string line, cell;
  std::getline(file, line);
  std::vector<std::string> header;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) header.push_back(cell);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    Row row;
    std::istringstream cells(line);
    for (const std::string& name : header)
      if (std::getline(cells, cell, ',') && !cell.empty()) row[name] = std::stod(cell);
    rows.push_back(row);
  }
  return rows;
}

// Tilt of the least-squares plane through the cells within 1.5 m.
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

struct Agreement {
  double r = 0.0, rms = 0.0, bias = 0.0;
};

Agreement agreement(const std::vector<double>& predicted, const std::vector<double>& measured) {
  const double n = static_cast<double>(predicted.size());
  double mp = 0, mm = 0, pp = 0, mmm = 0, pm = 0, d2 = 0;
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    mp += predicted[k] / n;
    mm += measured[k] / n;
    d2 += std::pow(predicted[k] - measured[k], 2) / n;
  }
  for (std::size_t k = 0; k < predicted.size(); ++k) {
    pp += std::pow(predicted[k] - mp, 2);
    mmm += std::pow(measured[k] - mm, 2);
    pm += (predicted[k] - mp) * (measured[k] - mm);
  }
  return {pm / std::sqrt(pp * mmm), std::sqrt(d2), mp - mm};
}

std::string words(const char* what, const Agreement& a) {
  return fmt::format("{}: r {:.2f}, rms {:.1f} deg, bias {:+.1f} deg.", what, a.r, a.rms, a.bias);
}

}  // namespace

Report curiosity_attitude(const std::string& data_folder) {
  Report report;
  report.title = "Attitude at Curiosity's real stops";
  report.source =
      "32 stops of Curiosity on the Marias Pass DEM: attitude measured by the rover against a "
      "Curiosity-class "
      "rover set down on the DEM at the same place and heading";
  report.columns = {"sol",
                    "x m",
                    "y m",
                    "tilt measured deg",
                    "rover set down",
                    "plane fit 3 m",
                    "pitch measured",
                    "ours",
                    "roll measured",
                    "ours"};
  const auto catalogue = api::load_catalogue(data_folder);
  if (!catalogue) throw std::runtime_error(catalogue.error().detail);
  const sim::RoverModel& rover = *catalogue->rovers.at("msl-class");
  const auto source = dem::open_elevation(data_folder + "/terrains/gale/elevation.tif");
  if (!source) throw std::runtime_error(source.error().detail);
  const auto terrain = (*source)->read((*source)->info().geometry.extent());
  if (!terrain) throw std::runtime_error(terrain.error().detail);
  const planner::TerrainGround ground(*terrain, nullptr);

  std::vector<double> measured, settled, plane, pitch_measured, pitch, roll_measured, roll;
  for (const Row& stop : read_stops(data_folder + "/terrains/gale/curiosity_stops.csv")) {
    // The rover reports yaw clockwise from north, pitch positive nose up and roll positive left side up.
    const Pose2 pose{stop.at("x_m"), stop.at("y_m"), rad_from_deg(90.0 - stop.at("yaw_deg"))};
    const auto stance = sim::settle(rover, ground, pose);
    if (!stance) throw std::runtime_error("no stance at a stop");
    measured.push_back(stop.at("tilt_deg"));
    settled.push_back(deg_from_rad(stance->attitude.tilt_rad()));
    plane.push_back(deg_from_rad(plane_tilt_rad(**terrain, pose.x_m, pose.y_m)));
    pitch_measured.push_back(stop.at("pitch_deg"));
    pitch.push_back(-deg_from_rad(stance->attitude.pitch_rad));
    roll_measured.push_back(stop.at("roll_deg"));
    roll.push_back(deg_from_rad(stance->attitude.roll_rad));
    report.rows.push_back({fmt::format("{:.0f}", stop.at("sol")), fmt::format("{:.0f}", pose.x_m),
                           fmt::format("{:.0f}", pose.y_m), fmt::format("{:.1f}", measured.back()),
                           fmt::format("{:.1f}", settled.back()), fmt::format("{:.1f}", plane.back()),
                           fmt::format("{:.1f}", pitch_measured.back()), fmt::format("{:.1f}", pitch.back()),
                           fmt::format("{:.1f}", roll_measured.back()), fmt::format("{:.1f}", roll.back())});
  }
  const Agreement tilt = agreement(settled, measured);
  report.notes.push_back(words("Tilt of the rover set down", tilt));
  report.notes.push_back(words("Tilt of a 3 m plane fit", agreement(plane, measured)));
  report.notes.push_back(words("Pitch of the rover set down", agreement(pitch, pitch_measured)));
  report.notes.push_back(words("Roll of the rover set down", agreement(roll, roll_measured)));
  report.notes.push_back(
      "The DEM's cells are 1 m and its heights smooth away what a wheel stands on; the residual is what the "
      "map does "
      "not know, and a plan's tilt is uncertain by as much.");
  report.holds = measured.size() == 32 && tilt.rms < 4.5;
  return report;
}

}  // namespace slipway::validation
