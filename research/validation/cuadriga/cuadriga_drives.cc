#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "research/validation/cuadriga/comparisons.h"
#include "research/validation/cuadriga/cuadriga_chart.h"
#include "research/validation/cuadriga/cuadriga_held_out.h"
#include "research/validation/cuadriga/cuadriga_shipped.h"

namespace slipway::validation {
namespace {

constexpr int kFolds = 5;
constexpr double kSteep_deg = 8.0;
constexpr double kEdges_deg[] = {-24.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0, 16.0, 26.0};

// The errors of a quantity's predictions over some windows.
struct Score {
  double model = 0.0, mean = 0.0, line = 0.0, plane = 0.0;  // median of absolute errors
  Coverage within_50, within_90;
  double width_90 = 0.0;  // median
};

struct Quantity {
  const char *name, *unit;
  double CuadrigaWindow::*measured;
  Prediction HeldOut::*predicted;
  Simple HeldOut::*simple;
};
constexpr Quantity kSlip{"slip", "1", &CuadrigaWindow::slip_ratio, &HeldOut::slip, &HeldOut::simple_slip};
constexpr Quantity kCharge{"charge_per_metre", "A s/m", &CuadrigaWindow::charge_per_metre_as,
                           &HeldOut::charge_as, &HeldOut::simple_charge_as};

Score score_of(const std::vector<HeldOut>& windows, const Quantity& q) {
  std::vector<std::string> logs;
  std::vector<bool> in_50, in_90;
  std::vector<double> model, mean, line, plane, widths;
  for (const HeldOut& h : windows) {
    const double measured = h.window.*q.measured;
    const Prediction& predicted = h.*q.predicted;
    logs.push_back(h.window.log);
    in_50.push_back(predicted.holds_50(measured));
    in_90.push_back(predicted.holds_90(measured));
    model.push_back(measured - predicted.median);
    mean.push_back(measured - (h.*q.simple).mean);
    line.push_back(measured - (h.*q.simple).line);
    plane.push_back(measured - (h.*q.simple).plane);
    widths.push_back(predicted.high_90 - predicted.low_90);
  }
  return {median_abs(model),        median_abs(mean),         median_abs(line), median_abs(plane),
          coverage_of(logs, in_50), coverage_of(logs, in_90), median(widths)};
}

template <class Keep>
std::vector<HeldOut> those(const std::vector<HeldOut>& windows, const Keep& keep) {
  std::vector<HeldOut> kept;
  for (const HeldOut& h : windows)
    if (keep(h)) kept.push_back(h);
  return kept;
}

double median_of(const std::vector<HeldOut>& windows, const std::function<double(const HeldOut&)>& value) {
  std::vector<double> values;
  for (const HeldOut& h : windows) values.push_back(value(h));
  return median(std::move(values));
}

void add_row(const std::string& name, const std::vector<HeldOut>& windows, Report& report) {
  if (windows.empty()) return;
  std::set<std::string> logs;
  for (const HeldOut& h : windows) logs.insert(h.window.log);
  std::vector<std::string> row{name, fmt::format("{}", windows.size()), fmt::format("{}", logs.size())};
  for (const Quantity* q : {&kSlip, &kCharge}) {
    const double measured = median_of(windows, [&](const HeldOut& h) { return h.window.*q->measured; });
    const double predicted = median_of(windows, [&](const HeldOut& h) { return (h.*q->predicted).median; });
    const int digits = q == &kSlip ? 3 : 1;
    row.push_back(fmt::format("{:.{}f}", measured, digits));
    row.push_back(fmt::format("{:.{}f}", predicted, digits));
    row.push_back(fmt::format("{:+.{}f}", predicted - measured, digits));
    row.push_back(fmt::format("{:.0f} %", 100.0 * score_of(windows, *q).within_90.of_windows));
    report.cases.push_back({"gradient " + name + " deg", q->name, q->unit, measured, predicted});
  }
  report.rows.push_back(row);
}

std::string calibration_words(const char* name, const Score& score, const Score& with_jumps,
                              const char* width) {
  return fmt::format(
      "Calibration of {}: {:.0f} % of the held-out windows are in their 50 % interval and {:.0f} % "
      "in their 90 % interval ({:.0f} % including the windows whose positions jump). With equal "
      "weight for every log these are {:.0f} % and {:.0f} %; in the worst log {:.0f} % are in "
      "their 90 % interval. The median width of the 90 % interval is {}.",
      name, 100.0 * score.within_50.of_windows, 100.0 * score.within_90.of_windows,
      100.0 * with_jumps.within_90.of_windows, 100.0 * score.within_50.mean_over_logs,
      100.0 * score.within_90.mean_over_logs, 100.0 * score.within_90.lowest_of_a_log, width);
}

std::string score_words(const char* name, const char* format, const Score& all, const Score& steep,
                        const Score& with_jumps) {
  const auto number = [&](double value) { return fmt::format(fmt::runtime(format), value); };
  return fmt::format(
      "Median absolute error of {} on held-out windows: {}; a straight line in gradient has {}, a "
      "plane in gradient and turn rate {}, the mean {}. Steeper than {:.0f} deg: {}; {}, {} and "
      "{}. Including the windows whose positions jump: {}; {}, {} and {}.",
      name, number(all.model), number(all.line), number(all.plane), number(all.mean), kSteep_deg,
      number(steep.model), number(steep.line), number(steep.plane), number(steep.mean),
      number(with_jumps.model), number(with_jumps.line), number(with_jumps.plane), number(with_jumps.mean));
}

// A sentence on where the predictions fail, with the log whose charge is least often in its intervals.
std::string miss_words(const std::vector<HeldOut>& windows) {
  std::map<std::string, std::vector<HeldOut>> by_log;
  for (const HeldOut& h : windows) by_log[h.window.log].push_back(h);
  std::string worst;
  double lowest = 2.0;
  for (const auto& [log, its] : by_log) {
    const double share = score_of(its, kCharge).within_90.of_windows;
    if (share >= lowest) continue;
    lowest = share;
    worst = log;
  }
  const std::vector<HeldOut>& its = by_log.at(worst);
  return fmt::format(
      "Misses: the slip of a window of 4 s is mostly noise, and no prediction here is much better "
      "than the mean. Downhill the model slips backwards, and the rover did not. From 4 to 8 deg "
      "the model slips, and the rover did not yet. Above 12 deg charge rises faster than "
      "predicted, and above 16 deg five windows of two logs do not show how. Log {} ({} windows) "
      "drew {:.1f} A s/m where {:.1f} was predicted, and {:.0f} % of its windows are in their 90 % "
      "interval: no other log is like it. The model's form was chosen with these logs in sight: "
      "before it included the turn rate, it predicted charge no better than the straight line.",
      worst, its.size(), median_of(its, [](const HeldOut& h) { return h.window.charge_per_metre_as; }),
      median_of(its, [](const HeldOut& h) { return h.charge_as.median; }), 100.0 * lowest);
}

// A sentence on the correlations of the errors with quantities that the model does not have.
std::string left_over_words(const std::vector<HeldOut>& windows) {
  std::vector<double> slips, charges, turns, rolls;
  for (const HeldOut& h : windows) {
    slips.push_back(h.window.slip_ratio - h.slip.median);
    charges.push_back(std::log(h.window.charge_per_metre_as / h.charge_as.median));
    turns.push_back(std::abs(h.window.turn_rate_rad_s));
    rolls.push_back(std::abs(h.window.dem_roll_rad));
  }
  return fmt::format(
      "Correlations of the residuals: errors of slip and of the logarithm of charge are correlated "
      "(r {:.2f}), because both contain the window's distance; with the turn rate r is {:.2f} and "
      "{:.2f}, with the map's roll {:.2f} and {:.2f}. The roll is not used.",
      agreement(slips, charges).r, agreement(slips, turns).r, agreement(charges, turns).r,
      agreement(slips, rolls).r, agreement(charges, rolls).r);
}

std::string scatter_words(const CuadrigaFit& fit) {
  return fmt::format(
      "Scatter of the training windows (all logs) on level ground: slip {:.3f} between logs and "
      "{:.3f} within a log, logarithm of charge {:.2f} and {:.2f}; with the gradient these grow by "
      "the factors 1 + {:.2f} and 1 + {:.2f} (gradient / 10 deg)^2.",
      fit.slip.between, fit.slip.within, fit.log_charge.between, fit.log_charge.within, fit.slip.growth,
      fit.log_charge.growth);
}

std::vector<StatedBand> bands_of(const Score& slip, const Score& charge, const TableError& table,
                                 double shipped) {
  return {
      {"share of held-out windows in the 90 % interval of slip", slip.within_90.of_windows, 0.80, 0.97},
      {"share of held-out windows in the 90 % interval of charge", charge.within_90.of_windows, 0.80, 0.97},
      {"share of held-out windows in the 50 % interval of slip", slip.within_50.of_windows, 0.40, 0.65},
      {"share of held-out windows in the 50 % interval of charge", charge.within_50.of_windows, 0.40, 0.65},
      {"median error of slip over the straight line's", slip.model / slip.line, 0.0, 1.0},
      {"median error of charge over the straight line's", charge.model / charge.line, 0.0, 1.0},
      {"largest difference of the shipped soil and motors to the fit of all logs, relative", shipped, 0.0,
       0.02},
      {"largest error of the table in slip, straight drives", table.slip_straight, 0.0, 0.003},
      {"largest error of the table in slip, turns", table.slip_turning, 0.0, 0.03}};
}

std::string table_words(const TableError& table) {
  return fmt::format(
      "Slip and torques come from a table. Between its nodes it is off by at most {:.4f} of "
      "slip and {:.2f} A on straight drives up to 20 deg, and by {:.4f} and {:.2f} A in turns "
      "up to {:.0f} deg/s and 12 deg. On steeper ground a turn adds what it adds at 12 deg, "
      "and sharper turns are treated like the sharpest one in the table.",
      table.slip_straight, table.current_straight_a, table.slip_turning, table.current_turning_a,
      table.fastest_turn_deg_s);
}

}  // namespace

Result<Report> cuadriga_drives(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  const sim::RoverModel& rover = *catalogue->rovers.at("cuadriga");
  const auto windows = load_cuadriga_windows(data / "validation" / "cuadriga_windows.csv");
  if (!windows) return fail(windows.error());
  const auto answer = cross_validate(rover, *windows, kFolds);
  if (!answer) return fail(answer.error());
  const std::vector<HeldOut> sound =
      those(answer->windows, [](const HeldOut& h) { return !h.window.position_jumped(); });
  const std::vector<HeldOut> steep = those(sound, [](const HeldOut& h) {
    return std::abs(deg_from_rad(h.window.path_gradient_rad)) > kSteep_deg;
  });
  const Score slip = score_of(sound, kSlip), charge = score_of(sound, kCharge);
  const Score slip_all = score_of(answer->windows, kSlip), charge_all = score_of(answer->windows, kCharge);

  Report report;
  report.title = "Slip and charge per metre of a real rover on logs that were not fitted";
  report.source = fmt::format(
      "University of Malaga (spaceuma/CAMIS_python), the rover Cuadriga in 2018 and 2019: {} "
      "windows of {} logs. Each log is predicted by a fit of the other folds' logs (five folds of "
      "whole logs), at the quasi-static level with gradient and turn rate as logged, at 9.81 m/s2",
      answer->windows.size(), [&] {
        std::set<std::string> logs;
        for (const HeldOut& h : answer->windows) logs.insert(h.window.log);
        return logs.size();
      }());
  report.peers =
      "none known on these windows; the notes compare with a straight line and a mean of the same "
      "logs";
  report.columns = {"gradient deg", "windows", "logs",        "slip, median",
                    "predicted",    "error",   "within 90 %", "charge A s/m, median",
                    "predicted",    "error",   "within 90 %"};
  for (std::size_t k = 0; k + 1 < std::size(kEdges_deg); ++k)
    add_row(fmt::format("{:.0f} to {:.0f}", kEdges_deg[k], kEdges_deg[k + 1]),
            those(sound,
                  [&](const HeldOut& h) {
                    const double g = deg_from_rad(h.window.path_gradient_rad);
                    return g >= kEdges_deg[k] && g < kEdges_deg[k + 1];
                  }),
            report);
  const TableError table = table_error(rover, answer->of_all.model.parameters());
  report.notes = {
      miss_words(sound),
      score_words("slip", "{:.3f}", slip, score_of(steep, kSlip), slip_all),
      score_words("charge per metre", "{:.2f} A s/m", charge, score_of(steep, kCharge), charge_all),
      calibration_words("slip", slip, slip_all, fmt::format("{:.2f}", slip.width_90).c_str()),
      calibration_words("charge", charge, charge_all, fmt::format("{:.0f} A s/m", charge.width_90).c_str()),
      scatter_words(answer->of_all),
      left_over_words(sound)};
  for (std::string& words : fit_words(answer->of_all)) report.notes.push_back(std::move(words));
  report.notes.push_back(table_words(table));
  report.bands =
      bands_of(slip, charge, table, shipped_difference(*catalogue, answer->of_all.model.parameters()));
  report.plot = draw_cuadriga_drives(report.title, *answer);
  return report;
}

}  // namespace slipway::validation
