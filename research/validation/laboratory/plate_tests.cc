#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/chart/chart.h"
#include "gap/estimate/plate_sinkage.h"
#include "research/validation/laboratory/comparisons.h"
#include "research/validation/laboratory/sandbox_plates.h"

namespace slipway::validation {
namespace {

using gap::PlateMeasure;

// Upstream's soil, and a fit of the same tests that was made elsewhere: p = k z^n in kPa and m.
constexpr sim::BekkerModuli kUpstream{0.0, 8e6, 1.46};
constexpr double kEarlierStiffness_kpa = 5.0e3, kEarlierExponent = 1.34;

// The root mean square error of the pressures by these moduli, relative to the test's maximum pressure.
double relative_rms(const gap::PlateRecord& test, const sim::BekkerModuli& moduli) {
  double sum = 0.0;
  for (std::size_t i = 0; i < test.sinkage_m.size(); ++i)
    sum += std::pow(
        moduli.stiffness(test.radius_m) * std::pow(test.sinkage_m[i], moduli.n) - test.pressure_pa[i], 2);
  return std::sqrt(sum / static_cast<double>(test.sinkage_m.size())) /
         *std::max_element(test.pressure_pa.begin(), test.pressure_pa.end());
}

std::vector<std::string> row_of(const std::string& name, std::size_t samples, const std::string& plate,
                                double deepest_m, const gap::ModuliFit& fit) {
  return {name,
          plate,
          fmt::format("{}", samples),
          deepest_m > 0.0 ? fmt::format("{:.1f}", 1e3 * deepest_m) : "-",
          fit.moduli.k_c == 0.0 ? "-"
                                : fmt::format("{:.0f} +- {:.0f}", 1e-3 * fit.moduli.k_c,
                                              1e-3 * std::sqrt(fit.covariance(0, 0))),
          fmt::format("{:.0f} +- {:.0f}", 1e-3 * fit.moduli.k_phi, 1e-3 * std::sqrt(fit.covariance(1, 1))),
          fmt::format("{:.3f} +- {:.3f}", fit.moduli.n, std::sqrt(fit.covariance(2, 2))),
          fmt::format("{:.2f}", 1e-3 * fit.rms_pa),
          fmt::format("{:.4f}", fit.explained_variance)};
}

std::size_t colour_of(const SandboxTest& test) {
  return test.plate.radius_m < 0.035 ? 0 : test.plate.radius_m < 0.045 ? 2 : 1;
}

// A series with every eighth sample of each test, with the smallest plate first.
void add_samples(const std::vector<SandboxTest>& tests, api::Chart& chart) {
  std::vector<SandboxTest> ordered = tests;
  std::stable_sort(ordered.begin(), ordered.end(), [](const SandboxTest& a, const SandboxTest& b) {
    return a.plate.radius_m < b.plate.radius_m;
  });
  for (const SandboxTest& test : ordered) {
    api::ChartSeries series{fmt::format("plate of {:.0f} mm", 2e3 * test.plate.radius_m),
                            api::ChartMark::kDots,
                            {},
                            {},
                            colour_of(test)};
    for (std::size_t i = 0; i < test.plate.sinkage_m.size(); i += 8) {
      series.x.push_back(1e3 * test.plate.sinkage_m[i]);
      series.y.push_back(1e-3 * test.plate.pressure_pa[i]);
    }
    chart.series.push_back(series);
  }
}

api::ChartSeries curve(const char* name, api::ChartMark mark, const sim::BekkerModuli& moduli,
                       double radius_m, std::size_t colour) {
  api::ChartSeries series{name, mark, {}, {}, colour};
  for (int z_mm = 1; z_mm <= 40; ++z_mm) {
    series.x.push_back(z_mm);
    series.y.push_back(1e-3 * moduli.stiffness(radius_m) * std::pow(1e-3 * z_mm, moduli.n));
  }
  return series;
}

std::vector<api::Chart> charts_of(const std::vector<SandboxTest>& tests, const sim::BekkerModuli& pooled,
                                  const sim::BekkerModuli& separate) {
  api::Chart one, two;
  one.title = "one modulus for all plates";
  one.x = {"sinkage, mm", 1.0, 50.0, true, {}};
  one.y = {"pressure, kPa", 0.2, 100.0, true, {}};
  two.title = "k_c and k_phi";
  two.x = {"sinkage, mm", 0.0, 40.0, false, {}};
  two.y = {"pressure, kPa", 0.0, 60.0, false, {}};
  add_samples(tests, one);
  add_samples(tests, two);
  one.series.push_back(curve("one modulus", api::ChartMark::kLine, pooled, 1.0, 6));
  one.series.push_back(curve("upstream's k 8e3, n 1.46", api::ChartMark::kDashedLine, kUpstream, 1.0, 6));
  for (const auto& [radius_m, colour] : {std::pair{0.03, 0}, std::pair{0.04, 2}, std::pair{0.05, 1}})
    two.series.push_back(curve(colour == 0 ? "k_c and k_phi, in the colour of the plate" : "",
                               api::ChartMark::kLine, separate, radius_m, static_cast<std::size_t>(colour)));
  return {one, two};
}

// The report with its title, source and columns, without rows.
Report plate_tests_report() {
  Report report;
  report.title = "Nine plate tests of one sand";
  report.source =
      "Pavlov and Johnson 2022 (robomechanics/3d-terramechanics): plates of 60, 80 and 100 mm diameter "
      "pressed "
      "into a sandbox, three tests each";
  report.peers = "upstream's soil is k 8e3 kPa/m^n, n 1.46; an earlier fit of these tests k 5.0e3, n 1.34";
  report.columns = {"test",       "plate mm",       "samples",
                    "deepest mm", "k_c kN/m^(n+1)", "k or k_phi kN/m^(n+2)",
                    "n",          "rms kPa",        "explained variance"};
  return report;
}

}  // namespace

Result<Report> plate_tests(const std::filesystem::path& data) {
  const auto plates = load_sandbox_plates(data / "validation" / "plate_sinkage_large_sandbox.csv");
  if (!plates) return fail(plates.error());
  const std::vector<SandboxTest>& tests = *plates;
  Report report = plate_tests_report();
  NoProgress progress;
  std::vector<gap::PlateRecord> all;
  double least_explained = 1.0, upstream = 0.0;
  for (const SandboxTest& test : tests) {
    const auto fit = gap::fit_moduli(
        std::span(&test.plate, 1), {.measure = PlateMeasure::kPressure, .cohesive_modulus = false}, progress);
    if (!fit) return fail(fit.error());
    report.rows.push_back(row_of(
        "test " + test.name, test.plate.sinkage_m.size(), fmt::format("{:.0f}", 2e3 * test.plate.radius_m),
        *std::max_element(test.plate.sinkage_m.begin(), test.plate.sinkage_m.end()), *fit));
    least_explained = std::min(least_explained, fit->explained_variance);
    upstream = std::max(upstream, relative_rms(test.plate, kUpstream));
    all.push_back(test.plate);
  }
  std::size_t samples = 0;
  for (const gap::PlateRecord& plate : all) samples += plate.sinkage_m.size();
  const auto pooled =
      gap::fit_moduli(all, {.measure = PlateMeasure::kPressure, .cohesive_modulus = false}, progress);
  const auto separate = gap::fit_moduli(all, {.measure = PlateMeasure::kPressure}, progress);
  const auto logarithms =
      gap::fit_moduli(all, {.measure = PlateMeasure::kLogPressure, .cohesive_modulus = false}, progress);
  for (const auto& fit : {pooled, separate, logarithms})
    if (!fit) return fail(fit.error());
  report.rows.push_back(row_of("all, one modulus", samples, "all", 0.0, *pooled));
  report.rows.push_back(row_of("all, k_c and k_phi", samples, "all", 0.0, *separate));
  report.rows.push_back(row_of("all, plain logarithms", samples, "all", 0.0, *logarithms));
  double worst_pooled = 0.0, worst_separate = 0.0;
  for (const SandboxTest& test : tests) {
    worst_pooled = std::max(worst_pooled, relative_rms(test.plate, pooled->moduli));
    worst_separate = std::max(worst_separate, relative_rms(test.plate, separate->moduli));
  }
  const double k_kpa = 1e-3 * logarithms->moduli.k_phi, n = logarithms->moduli.n;
  report.notes = {
      fmt::format("Within one test the power law explains at least {:.2f} % of the pressure's variance. It "
                  "does not carry over from test to test: with one modulus the worst test is missed by an "
                  "rms of {:.0f} % of its maximum pressure, with k_c and k_phi by {:.0f} %, with "
                  "upstream's values by {:.0f} %.",
                  100.0 * least_explained, 100.0 * worst_pooled, 100.0 * worst_separate, 100.0 * upstream),
      fmt::format("The earlier fit (k 5.0e3, n 1.34) is reproduced by a straight line through the "
                  "logarithms of all samples: k {:.0f}, n {:.3f}. It gives the first millimetres, where "
                  "the plate's seating and the load cell's zero show, the same weight as the rest.",
                  k_kpa, n),
      "k and n compensate each other, so that pressures should be compared, not moduli. The "
      "standard errors treat samples as independent, which those of one test are not; the spread "
      "between the three tests of a plate is the better measure.",
      "Here b is the plate's radius. Larger plates meet more pressure at the same depth, so that "
      "k_c is negative for this sand too."};
  report.bands = {{"minimum explained variance within a test", least_explained, 0.98, 1.0},
                  {"relative difference of k of the plain logarithms to 5.0e3",
                   k_kpa / kEarlierStiffness_kpa - 1.0, -0.02, 0.02},
                  {"n of the plain logarithms", n, kEarlierExponent - 0.005, kEarlierExponent + 0.005}};
  report.cases = {{"all tests, logarithms", "k", "kPa/m^n", kEarlierStiffness_kpa, k_kpa},
                  {"all tests, logarithms", "n", "1", kEarlierExponent, n}};
  report.plot = api::draw_charts(report.title, charts_of(tests, pooled->moduli, separate->moduli));
  return report;
}

}  // namespace slipway::validation
