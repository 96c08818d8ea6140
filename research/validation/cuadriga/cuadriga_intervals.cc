#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "api/files/catalogue.h"
#include "core/angle.h"
#include "core/parallel_for.h"
#include "research/validation/cuadriga/comparisons.h"
#include "research/validation/cuadriga/cuadriga_held_out.h"
#include "research/validation/report/conformal.h"

namespace slipway::validation {
namespace {

constexpr double kLevel = 0.9;
constexpr double kAimLow = 86.0, kAimHigh = 96.0;  // percent
constexpr double kEdges_deg[] = {-24.0, -8.0, -4.0, 0.0, 4.0, 8.0, 26.0};
constexpr std::size_t kBins = std::size(kEdges_deg) - 1;
// A bin with fewer windows to learn from takes the stretch of all bins.
constexpr std::size_t kMinWindows = 20;

enum Quantity : std::size_t { kSlip, kCharge, kQuantities };

// The outing that a window is of: its log's name begins with it.
std::string day_of(const CuadrigaWindow& window) {
  return window.log.substr(0, window.log.find("__"));
}

std::size_t bin_of(const CuadrigaWindow& window) {
  const double gradient = deg_from_rad(window.path_gradient_rad);
  std::size_t bin = 0;
  while (bin + 1 < kBins && gradient >= kEdges_deg[bin + 1]) ++bin;
  return bin;
}

// A 90 % interval and what was measured; of charge their logarithms, as its scatter is in ratios.
struct Judged {
  std::size_t bin = 0;
  std::string day;
  double low = 0.0, high = 0.0, measured = 0.0;

  double stretch() const { return stretch_to_hold(low, high, measured); }
};

Judged judged(const CuadrigaFit& fit, const CuadrigaWindow& window, std::size_t quantity) {
  const ClimbConditions conditions = conditions_of(window);
  if (quantity == kSlip) {
    const Prediction p = predict_slip(fit, conditions);
    return {bin_of(window), day_of(window), p.low_90, p.high_90, window.slip_ratio};
  }
  const Prediction p = predict_charge(fit, conditions, window.wheel_speed_m_s);
  return {bin_of(window), day_of(window), std::log(p.low_90), std::log(p.high_90),
          std::log(window.charge_per_metre_as)};
}

using Days = std::set<std::string>;

// Fits of all windows but those of the days left out, by these days: one day, and each pair.
Result<std::map<Days, CuadrigaFit>> fits_without(const sim::RoverModel& rover,
                                                 const std::vector<CuadrigaWindow>& windows,
                                                 const Days& days) {
  std::vector<Days> left_out;
  for (auto a = days.begin(); a != days.end(); ++a)
    for (auto b = a; b != days.end(); ++b) left_out.push_back({*a, *b});
  std::vector<std::optional<Result<CuadrigaFit>>> made(left_out.size());
  parallel_for(made.size(), 0, [&](std::size_t k) {
    std::vector<CuadrigaWindow> others = windows;
    std::erase_if(others, [&](const CuadrigaWindow& w) { return left_out[k].contains(day_of(w)); });
    made[k] = fit_cuadriga(rover, others);
  });
  std::map<Days, CuadrigaFit> fits;
  for (std::size_t k = 0; k < made.size(); ++k) {
    if (!*made[k]) return fail(made[k]->error());
    fits.emplace(left_out[k], **made[k]);
  }
  return fits;
}

// The stretch for each bin, learnt on the days other than `day`: each of them is predicted by the fit that
// has neither it nor `day`.
std::vector<double> learnt_stretches(const std::map<Days, CuadrigaFit>& fits,
                                     const std::vector<CuadrigaWindow>& windows, const std::string& day,
                                     std::size_t quantity) {
  std::vector<std::vector<double>> by_bin(kBins);
  std::vector<double> all;
  for (const CuadrigaWindow& window : windows) {
    if (day_of(window) == day) continue;
    const Judged other = judged(fits.at({day, day_of(window)}), window, quantity);
    by_bin[other.bin].push_back(other.stretch());
    all.push_back(other.stretch());
  }
  const double of_all = conformal_stretch(all, kLevel).value_or(1.0);
  std::vector<double> stretches;
  for (const std::vector<double>& values : by_bin)
    stretches.push_back(values.size() < kMinWindows ? of_all
                                                    : conformal_stretch(values, kLevel).value_or(of_all));
  return stretches;
}

// Windows of one bin or day, in their intervals before and after.
struct Tally {
  double windows = 0.0, before = 0.0, after = 0.0;
  double width_ratio = 0.0;  // summed over the windows
  Days days;

  void add(const Judged& window, double stretch) {
    const double needed = window.stretch();
    windows += 1.0;
    before += needed <= 1.0 ? 1.0 : 0.0;
    after += needed <= stretch ? 1.0 : 0.0;
    width_ratio += stretch;
    days.insert(window.day);
  }
  double percent_before() const { return 100.0 * before / windows; }
  double percent_after() const { return 100.0 * after / windows; }
};

struct Coverages {
  std::map<std::size_t, Tally> bins[kQuantities];
  std::map<std::string, Tally> days[kQuantities];
  Tally all[kQuantities];
};

Coverages coverages_of(const std::map<Days, CuadrigaFit>& fits, const std::vector<CuadrigaWindow>& windows,
                       const Days& days) {
  Coverages coverages;
  for (const std::string& day : days) {
    for (const std::size_t quantity : {kSlip, kCharge}) {
      const std::vector<double> stretches = learnt_stretches(fits, windows, day, quantity);
      for (const CuadrigaWindow& window : windows) {
        if (day_of(window) != day) continue;
        const Judged held = judged(fits.at({day}), window, quantity);
        const double stretch = stretches[held.bin];
        coverages.bins[quantity][held.bin].add(held, stretch);
        coverages.days[quantity][day].add(held, stretch);
        coverages.all[quantity].add(held, stretch);
      }
    }
  }
  return coverages;
}

void add_row(const std::string& name, const Tally& slip, const Tally& charge, Report& report) {
  std::vector<std::string> row{name, fmt::format("{:.0f}", slip.windows),
                               fmt::format("{}", slip.days.size())};
  for (const Tally* tally : {&slip, &charge}) {
    row.push_back(fmt::format("{:.0f}", tally->percent_before()));
    row.push_back(fmt::format("{:.0f}", tally->percent_after()));
    row.push_back(fmt::format("{:.2f}", tally->width_ratio / tally->windows));
  }
  report.rows.push_back(std::move(row));
}

// Which bins are outside the aim after the correction.
std::string miss_words(const char* name, const std::map<std::size_t, Tally>& bins) {
  std::string misses;
  std::size_t before = 0, after = 0;
  const auto aimed = [](double percent) { return percent >= kAimLow && percent <= kAimHigh; };
  for (const auto& [bin, tally] : bins) {
    before += aimed(tally.percent_before()) ? 1 : 0;
    after += aimed(tally.percent_after()) ? 1 : 0;
    if (aimed(tally.percent_after())) continue;
    misses += fmt::format("{}{:.0f} to {:.0f} deg ({:.0f} %)", misses.empty() ? "" : ", ", kEdges_deg[bin],
                          kEdges_deg[bin + 1], tally.percent_after());
  }
  return fmt::format(
      "{}: {} of {} bins of gradient are within the aim of {:.0f} to {:.0f} % before the correction, {} "
      "after "
      "it; missed: {}.",
      name, before, bins.size(), kAimLow, kAimHigh, after, misses.empty() ? "none" : misses);
}

Report report_on(const Coverages& coverages, std::size_t windows, std::size_t days) {
  Report report;
  report.title = "90 % intervals of a real rover's slip and charge on days that were not fitted";
  report.source = fmt::format(
      "University of Malaga (spaceuma/CAMIS_python), the rover Cuadriga: {} windows of 4 s on {} outings. "
      "Each "
      "outing is predicted by a fit of the others (before), and its intervals are then stretched by bin of "
      "gradient by split conformal prediction learnt on the others (after). Cross-validated: whole outings "
      "held "
      "out, of the fit and of the correction",
      windows, days);
  report.columns = {"gradient deg", "windows",         "outings",        "slip before %", "slip after %",
                    "slip width x", "charge before %", "charge after %", "charge width x"};
  for (const auto& [bin, slip] : coverages.bins[kSlip])
    add_row(fmt::format("{:.0f} to {:.0f}", kEdges_deg[bin], kEdges_deg[bin + 1]), slip,
            coverages.bins[kCharge].at(bin), report);
  for (const auto& [day, slip] : coverages.days[kSlip])
    add_row("outing " + day, slip, coverages.days[kCharge].at(day), report);
  add_row("all", coverages.all[kSlip], coverages.all[kCharge], report);
  report.notes = {
      miss_words("Slip", coverages.bins[kSlip]), miss_words("Charge per metre", coverages.bins[kCharge]),
      "Charge per metre is the current of all motors integrated over the window, over its way; its intervals "
      "are stretched in the logarithm. The stretch is what nine in ten windows of the other outings needed, "
      "each "
      "predicted without its own outing; a bin with fewer than 20 such windows takes that of all bins. Below "
      "1 "
      "it makes intervals narrower.",
      "What the method promises holds where windows are exchangeable. Here they are not: three outings teach "
      "and a fourth is judged, outings differ in place and soil, and windows overlap by half. Windows whose "
      "positions jump are left out."};
  report.bands = {{"windows in the 90 % interval of slip after the correction, %",
                   coverages.all[kSlip].percent_after(), 75.0, 100.0},
                  {"windows in the 90 % interval of charge after the correction, %",
                   coverages.all[kCharge].percent_after(), 75.0, 100.0}};
  return report;
}

}  // namespace

Result<Report> cuadriga_intervals(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  auto windows = load_cuadriga_windows(data / "validation" / "cuadriga_windows.csv");
  if (!windows) return fail(windows.error());
  std::erase_if(*windows, [](const CuadrigaWindow& w) { return w.position_jumped(); });
  Days days;
  for (const CuadrigaWindow& window : *windows) days.insert(day_of(window));
  const auto fits = fits_without(*catalogue->rovers.at("cuadriga"), *windows, days);
  if (!fits) return fail(fits.error());
  return report_on(coverages_of(*fits, *windows, days), windows->size(), days.size());
}

}  // namespace slipway::validation
