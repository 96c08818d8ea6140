#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "api/files/catalogue.h"
#include "api/files/relief_values.h"
#include "core/angle.h"
#include "core/random.h"
#include "dem/elevation_source.h"
#include "planner/problem/terrain_ground.h"
#include "research/validation/mars/comparisons.h"
#include "research/validation/report/csv_table.h"
#include "research/validation/report/scatter_chart.h"
#include "research/validation/report/statistics.h"
#include "sim/prediction/drawn_relief.h"
#include "sim/rover/stance.h"

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

struct NamedSpread {
  const char* name;
  sim::ReliefSpread spread;
};

// What the terrain says that its map may not show, each part alone and all together.
std::array<NamedSpread, 4> parts_of(const sim::ReliefSpread& all) {
  sim::ReliefSpread error = all, roughness = all, rocks = all;
  error.roughness_m = error.rock_share = 0.0;
  roughness.elevation_error_m = roughness.rock_share = 0.0;
  rocks.elevation_error_m = rocks.roughness_m = 0.0;
  return {{{"the map's error", error}, {"roughness", roughness}, {"rocks", rocks}, {"all three", all}}};
}

// How often the 90 % interval over draws of the relief holds what the rover measured.
class Coverage {
 public:
  // Angles in degrees: of the draws, and measured.
  void add(std::vector<double> drawn, double measured) {
    std::sort(drawn.begin(), drawn.end());
    const auto at = [&](double share) {
      return drawn[static_cast<std::size_t>(share * static_cast<double>(drawn.size() - 1))];
    };
    const double low = at(0.05), high = at(0.95);
    held_ += low <= measured && measured <= high ? 1 : 0;
    width_ += high - low;
    ++count_;
  }
  std::string words() const { return fmt::format("{} ({:.1f} deg wide)", held_, width_ / count_); }
  double share() const { return static_cast<double>(held_) / count_; }

 private:
  int held_ = 0, count_ = 0;
  double width_ = 0.0;
};

struct MeasuredStop {
  Pose2 pose;
  double tilt_deg = 0.0, pitch_deg = 0.0, roll_deg = 0.0;
};

// A note for each spread; returns the share of pitches and rolls that the last one holds.
double add_coverage(const sim::RoverModel& rover, const sim::Ground& ground, const sim::ReliefSpread& relief,
                    const std::vector<MeasuredStop>& stops, Report& report) {
  constexpr std::uint64_t kReliefDraws = 400;
  double share = 0.0;
  for (const NamedSpread& each : parts_of(relief)) {
    Coverage tilt, pitch, roll;
    for (const MeasuredStop& stop : stops) {
      std::vector<double> tilts, pitches, rolls;
      for (std::uint64_t draw = 0; draw < kReliefDraws; ++draw) {
        const sim::DrawnRelief drawn(ground, each.spread, random_key(1, draw));
        const auto stance = sim::settle(rover, drawn, stop.pose);
        if (!stance) continue;
        tilts.push_back(deg_from_rad(stance->attitude.tilt_rad()));
        pitches.push_back(-deg_from_rad(stance->attitude.pitch_rad));
        rolls.push_back(deg_from_rad(stance->attitude.roll_rad));
      }
      if (tilts.empty()) continue;
      tilt.add(std::move(tilts), stop.tilt_deg);
      pitch.add(std::move(pitches), stop.pitch_deg);
      roll.add(std::move(rolls), stop.roll_deg);
    }
    report.notes.push_back(fmt::format(
        "Drawn with {} (blind): 90 % intervals hold, of {} stops, the tilt of {}, the pitch of {}, "
        "the roll of {}.",
        each.name, stops.size(), tilt.words(), pitch.words(), roll.words()));
    share = 0.5 * (pitch.share() + roll.share());
  }
  report.notes.push_back(
      "A miss: the tilt of too few stops is inside. A map whose errors are drawn on top of those that it has "
      "is steeper than the ground, so that its tilts are too large.");
  return share;
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

  std::vector<MeasuredStop> measured;
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
    measured.push_back({pose, tilt_measured.back(), pitch_measured.back(), roll_measured.back()});
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
  const auto relief =
      api::relief_spread(catalogue->terrains.at("gale")->description().relief, {}, {}, nullptr);
  if (!relief) return fail(ErrorCode::kUnreadableData, "the terrain gale states no relief");
  const double held = add_coverage(rover, ground, *relief, measured, report);
  report.bands = {{"stops", static_cast<double>(stops->rows()), 32, 32},
                  {"rms of tilt, deg", tilt.rms, 0.0, 4.5},
                  {"share of pitches and rolls in their 90 % intervals, all three drawn", held, 0.8, 0.97}};
  const api::Chart panels[] = {scatter_chart("tilt, deg", tilt_measured, settled),
                               scatter_chart("pitch, deg", pitch_measured, pitch),
                               scatter_chart("roll, deg", roll_measured, roll)};
  report.plot = api::draw_charts(report.title, panels);
  return report;
}

}  // namespace slipway::validation
