#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "api/files/catalogue.h"
#include "api/files/drive_table/campaign_source.h"
#include "core/angle.h"
#include "research/validation/mars/comparisons.h"
#include "sim/effects/effect_catalogue.h"
#include "sim/quasi_static/quasi_static.h"
#include "sim/rover/stance.h"

namespace slipway::validation {
namespace {

constexpr std::size_t kTilts = 4, kSteepest = 3;
constexpr double kStuck = 100.0;  // slip in percent of a rover that makes no headway
constexpr double kShown = 0.1;    // percentage points; a smaller change is not shown
constexpr std::size_t kMaxCandidates = 4;

// ROAMS paper, Table 1. Percent of slip.
struct Published {
  double tilt_deg, least, most, roams_least, roams_most;
};
constexpr std::array<Published, kTilts> kPublished{
    {{0.085, 2, 5, 2, 4}, {5.743, 2, 8, 1, 6}, {10.758, 2, 20, 2, 10}, {20.764, 10, 60, 5, 20}}};

// The rover on the sand, with effects.
struct Model {
  sim::RoverModel rover;
  sim::Soil soil;
};

Model with_effects(const campaign::DriveTable& table, sim::Soil soil,
                   const std::vector<sim::EffectSetting>& more) {
  std::vector<sim::EffectSetting> settings = sim::in_force(table.rover->effects, table.effects);
  settings.insert(settings.end(), more.begin(), more.end());
  Model model{*table.rover, std::move(soil)};
  sim::apply_effects(settings, model.rover);
  sim::apply_effects(settings, model.soil);
  // An effect of a patch acts on the whole ground.
  for (std::size_t r = 0; r < sim::effect_regions(settings).size(); ++r)
    sim::apply_in_region(settings, r, model.soil);
  return model;
}

struct Drive {
  const char* name;
  double tilt_deg, heading_deg;  // 0 up, 90 across, 180 down
  double speed_share;            // of the cruise speed; negative is backwards, but still up the slope
};

struct Outcome {
  double slip_percent = kStuck;
  double side_slip_percent = 0.0;
};

Outcome drive_of(const Model& model, double gravity_m_s2, const Drive& drive) {
  const double tilt = rad_from_deg(drive.tilt_deg), heading = rad_from_deg(drive.heading_deg);
  const double sense = drive.speed_share < 0.0 ? -1.0 : 1.0;
  const Attitude attitude{.roll_rad = std::asin(-std::sin(tilt) * std::sin(heading)),
                          .pitch_rad = std::asin(-sense * std::sin(tilt) * std::cos(heading)),
                          .yaw_rad = 0.0};
  sim::QuasiStaticSolver solver(model.rover, gravity_m_s2);
  sim::DriveCommand command;
  command.speed_m_s = drive.speed_share * model.rover.cruise_speed_m_s;
  const sim::StationState state =
      solver.solve(sim::stance_on_plane(model.rover, attitude), model.soil, command);
  if (!state.moving()) return {};
  return {100.0 * state.slip_ratio, 100.0 * state.leftward_m_s / std::abs(command.speed_m_s)};
}

using Slips = std::array<double, kTilts>;

Slips up_slope(const Model& model, double gravity_m_s2) {
  Slips slips{};
  for (std::size_t t = 0; t < kTilts; ++t)
    slips[t] = drive_of(model, gravity_m_s2, {"", kPublished[t].tilt_deg, 0.0, 1.0}).slip_percent;
  return slips;
}

// The sand of the shipped table with a higher friction angle, so that the rover slips up the steepest tilt as
// ROAMS's did.
sim::Soil as_roams(const campaign::DriveTable& table) {
  sim::Soil soil = table.soils.begin()->second.mean;
  double low = rad_from_deg(36.0), high = rad_from_deg(55.0);
  for (int k = 0; k < 20; ++k) {
    soil.friction_angle_rad = 0.5 * (low + high);
    const Model model = with_effects(table, soil, {});
    const double slip =
        drive_of(model, table.gravity_m_s2, {"", kPublished[kSteepest].tilt_deg, 0.0, 1.0}).slip_percent;
    (slip > kPublished[kSteepest].roams_most ? low : high) = soil.friction_angle_rad;
  }
  return soil;
}

struct Signature {
  std::string effect, size;
  Slips rise{};  // increase of the slip up the slope, in percentage points
  Model model;
  // The rise on the steepest tilt less the part of the rise on the lower tilts that exceeds the difference
  // between FIDO and ROAMS.
  double score() const {
    double too_much = 0.0;
    for (std::size_t t = 0; t < kSteepest; ++t)
      too_much += std::max(0.0, std::abs(rise[t]) - (kPublished[t].most - kPublished[t].roams_most));
    return std::min(rise[kSteepest], kPublished[kSteepest].most - kPublished[kSteepest].roams_most) -
           too_much;
  }
};

std::vector<Signature> signatures_of(const campaign::DriveTable& table, const sim::Soil& soil,
                                     const Slips& base) {
  std::vector<Signature> all;
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    const auto at_work = [&](const sim::EffectSetting& s) { return s.name == effect.name; };
    if (std::any_of(table.effects.begin(), table.effects.end(), at_work)) continue;
    std::vector<std::string> words;
    for (const Field& field : effect.fields)
      words.push_back(fmt::format("{} {:g}", field.name, field.initial));
    Signature s{std::string(effect.name),
                fmt::format("{}", fmt::join(words, ", ")),
                {},
                with_effects(table, soil, {{.name = std::string(effect.name), .parameters = {}}})};
    const Slips slips = up_slope(s.model, table.gravity_m_s2);
    for (std::size_t t = 0; t < kTilts; ++t) s.rise[t] = slips[t] - base[t];
    all.push_back(std::move(s));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Signature& a, const Signature& b) { return a.score() > b.score(); });
  return all;
}

constexpr std::array kDrives{Drive{"20.764 deg up", 20.764, 0.0, 1.0},
                             Drive{"20.764 deg up, backwards", 20.764, 0.0, -1.0},
                             Drive{"20.764 deg up, half the speed", 20.764, 0.0, 0.5},
                             Drive{"20.764 deg, at 45 deg to the slope", 20.764, 45.0, 1.0},
                             Drive{"20.764 deg across", 20.764, 90.0, 1.0},
                             Drive{"20.764 deg down", 20.764, 180.0, 1.0},
                             Drive{"15 deg up", 15.0, 0.0, 1.0},
                             Drive{"15 deg up, backwards", 15.0, 0.0, -1.0}};

// Adds the predictions of each candidate for a drive, and the difference of the two nearest in percentage
// points of slip and side slip.
void add_drives(const std::vector<Signature>& candidates, double gravity_m_s2, Report& report) {
  double widest = -1.0;
  std::string settled;
  for (const Drive& drive : kDrives) {
    std::vector<Outcome> outcomes;
    std::vector<std::string> words;
    for (const Signature& c : candidates) {
      outcomes.push_back(drive_of(c.model, gravity_m_s2, drive));
      words.push_back(
          fmt::format("{} {:.0f} %{}", c.effect, outcomes.back().slip_percent,
                      std::abs(outcomes.back().side_slip_percent) > 1.0
                          ? fmt::format(" ({:+.0f} % sideways)", outcomes.back().side_slip_percent)
                          : ""));
    }
    double nearest = 1e9;
    for (std::size_t a = 0; a < outcomes.size(); ++a)
      for (std::size_t b = a + 1; b < outcomes.size(); ++b)
        nearest =
            std::min(nearest, std::hypot(outcomes[a].slip_percent - outcomes[b].slip_percent,
                                         outcomes[a].side_slip_percent - outcomes[b].side_slip_percent));
    report.notes.push_back(fmt::format("Drive {}: {}; the two most similar differ by {:.1f} points.",
                                       drive.name, fmt::join(words, ", "), nearest));
    if (nearest <= widest) continue;
    widest = nearest;
    settled = drive.name;
  }
  report.notes.push_back(fmt::format(
      "The drive that would decide: {}, on which any two of these {} candidates differ by at least "
      "{:.1f} points. FIDO's surveys before and after would have to be read to 0.1 points for it.",
      settled, candidates.size(), widest));
}

// The report with its title, source and columns, without rows.
Report roams_table_1_report() {
  Report report;
  report.title =
      "ROAMS's Table 1 as a case: where the gap is, which effect is like it, and which drive would "
      "decide";
  report.source =
      "ROAMS paper (Huntsberger et al.), Table 1: minimum and maximum slip of FIDO and of ROAMS on "
      "four tilts";
  report.columns = {"points of slip", "0.085 deg", "5.743 deg", "10.758 deg", "20.764 deg"};
  return report;
}

// FIDO less ROAMS on a tilt, in percentage points of slip: at the lower and at the upper end.
double lower_gap(std::size_t t) {
  return kPublished[t].least - kPublished[t].roams_least;
}

double upper_gap(std::size_t t) {
  return kPublished[t].most - kPublished[t].roams_most;
}

double whole_gap() {
  double gap = 0.0;
  for (const Published& p : kPublished)
    gap += std::abs(p.least - p.roams_least) + std::abs(p.most - p.roams_most);
  return gap;
}

// Adds the rows of the gap and of the effects' signatures. Returns the effects that change nothing.
std::vector<std::string> add_rows(const std::vector<Signature>& all, const Slips& base, double gap,
                                  Report& report) {
  const auto row = [&](const std::string& name, const auto& value, const char* form) {
    std::vector<std::string> cells{name};
    for (std::size_t t = 0; t < kTilts; ++t) cells.push_back(fmt::format(fmt::runtime(form), value(t)));
    report.rows.push_back(std::move(cells));
  };
  const auto share_of = [&](double part) { return 100.0 * std::abs(part) / gap; };
  row("FIDO less ROAMS, minimum slip", lower_gap, "{:+.0f}");
  row(
      "its share of the gap", [&](std::size_t t) { return share_of(lower_gap(t)); }, "{:.0f} %");
  row("FIDO less ROAMS, maximum slip", upper_gap, "{:+.0f}");
  row(
      "its share of the gap", [&](std::size_t t) { return share_of(upper_gap(t)); }, "{:.0f} %");
  row(
      "predicted slip up the slope, sand as ROAMS's, %", [&](std::size_t t) { return base[t]; }, "{:.1f}");
  std::vector<std::string> nothing;
  for (const Signature& s : all) {
    if (std::all_of(s.rise.begin(), s.rise.end(), [](double r) { return std::abs(r) < kShown; })) {
      nothing.push_back(s.effect);
      continue;
    }
    row(
        "with " + s.effect + " (" + s.size + ")", [&](std::size_t t) { return s.rise[t]; }, "{:+.1f}");
  }
  return nothing;
}

}  // namespace

// Compares the gap between ROAMS and FIDO with the signatures of the catalogue's effects.
Result<Report> roams_table_1(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const auto loaded = api::load_campaign_table("fido_table_1", data, *catalogue);
  if (!loaded) return fail(loaded.error());
  const campaign::DriveTable& table = loaded->table;
  const sim::Soil soil = as_roams(table);
  const Slips base = up_slope(with_effects(table, soil, {}), table.gravity_m_s2);
  const std::vector<Signature> all = signatures_of(table, soil, base);

  const double gap = whole_gap();
  Report report = roams_table_1_report();
  const std::vector<std::string> nothing = add_rows(all, base, gap, report);
  const double share = 100.0 * upper_gap(kSteepest) / gap;
  report.notes.push_back(
      fmt::format("Where the gap is: the upper tail on 20.764 deg alone holds {:.0f} % of all {:.0f} points, "
                  "and the maximum slip occurs up the slope. On 0 to 6 deg there is almost no gap.",
                  share, gap));
  report.notes.push_back(fmt::format(
      "Which effect is like it: every effect of the catalogue that does not act already is added "
      "alone at its initial size to the FIDO-class rover up the slope, on the table's sand with a "
      "friction angle of {:.1f} deg, with which the rover slips by {:.0f} % there as ROAMS did. "
      "Effects are ordered by the rise on 20.764 deg (at most {:.0f} points) less their excess "
      "over the gap on the lower tilts. 100 % is a rover that makes no headway.",
      deg_from_rad(soil.friction_angle_rad), base[kSteepest], upper_gap(kSteepest)));
  if (!nothing.empty())
    report.notes.push_back(
        fmt::format("These effects do not change the slip up the slope: {}.", fmt::join(nothing, ", ")));
  const std::vector<Signature> candidates(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(kMaxCandidates, all.size())));
  report.notes.push_back(fmt::format(
      "The first is {} ({:+.1f} points on 20.764 deg, {:+.1f} on 10.758, {:+.1f} on 5.743, {:+.1f} "
      "on 0.085).",
      candidates[0].effect, candidates[0].rise[3], candidates[0].rise[2], candidates[0].rise[1],
      candidates[0].rise[0]));
  add_drives(candidates, table.gravity_m_s2, report);
  report.notes.push_back(
      "This is not a diagnosis of FIDO's drives. They are not published one by one, the shipped "
      "rover is only of FIDO's class, the effects' sizes are the catalogue's own, and softer sand "
      "alone would raise the same tail (the comparison fido_table_1 fits all eight numbers with no "
      "other effect than grousers).");
  report.bands = {
      {"share of the gap in the upper tail on 20.764 deg, %", share, 60.0, 75.0},
      {"predicted slip up 20.764 deg on sand as ROAMS's, %", base[kSteepest], 19.0, 21.0},
      {"rise of the first candidate on 20.764 deg, points", candidates[0].rise[kSteepest], 5.0, 80.0}};
  return report;
}

}  // namespace slipway::validation
