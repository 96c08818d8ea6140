#include <fmt/format.h>

#include <array>

#include "api/files/catalogue.h"
#include "api/files/slip_steps_file.h"
#include "api/steps/step_chart.h"
#include "api/steps/step_comparison.h"
#include "api/steps/step_comparison_document.h"
#include "research/validation/mars/comparisons.h"

namespace slipway::validation {
namespace {

struct Table {
  const char* what;
  const char* file;  // in the data folder
  api::StepComparisonRequest request;
  steps::StepLearning most;  // up to which learning is compared
};

void add_row(const Table& table, const api::StepComparison& comparison, Report& report) {
  const steps::StepScores& s = comparison.scores;
  const std::string learnt(api::name_of(table.request.learning));
  report.rows.push_back({table.what, learnt, fmt::format("{}", s.steps), fmt::format("{}", s.sols),
                         api::estimate_words(s.median_error, 1.0, 4),
                         api::estimate_words(s.in_band, 100.0, 1),
                         fmt::format("{:.1f} / {}", s.step_over_0_2.expected, s.step_over_0_2.above),
                         fmt::format("{:.1f} / {}", s.step_over_0_4.expected, s.step_over_0_4.above),
                         s.step_over_0_4.above > 0 ? fmt::format("{:.2f}", s.step_over_0_4.auc) : "-"});
}

}  // namespace

Result<Report> curiosity_steps(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  constexpr const char* kMariasPass = "terrains/gale/curiosity_steps_0960_1000.csv";
  const std::array tables{
      Table{"sols 45 to 582", "steps/curiosity_0045_0582.csv", {}, steps::StepLearning::kDrive},
      Table{"Marias Pass, sols 960 to 997", kMariasPass, {}, steps::StepLearning::kDrive},
      Table{"Marias Pass, slope and soil from the map",
            kMariasPass,
            {.terrain = "gale", .legend = {}},
            steps::StepLearning::kNone},
      Table{"Perseverance, sols 15 to 700",
            "steps/perseverance_0014_0700.csv",
            {.rover = "m2020-class", .terrain = {}, .legend = {}},
            steps::StepLearning::kNone}};
  Report report;
  report.title = "Slip of single metres on Mars";
  report.source =
      "NASA/JPL: SPICE kernels of PDS data set MSL-M-SPICE-6-V1.0 (Semenov and Acton 2013); PDS Mars 2020 "
      "PLACES";
  report.columns = {"steps",
                    "learned from",
                    "number",
                    "sols",
                    "median error",
                    "in the 90 % band, %",
                    "above 0.2, expected / measured",
                    "above 0.4, expected / measured",
                    "AUC of 0.4"};
  for (const Table& table : tables) {
    const auto steps = api::read_slip_steps_file(data / table.file, table.file);
    if (!steps) return fail(steps.error());
    for (const auto learning :
         {steps::StepLearning::kNone, steps::StepLearning::kSols, steps::StepLearning::kDrive}) {
      if (learning > table.most) break;
      Table asked = table;
      asked.request.learning = learning;
      const auto comparison = api::compare_steps(*catalogue, asked.request, *steps);
      if (!comparison) return fail(comparison.error());
      add_row(asked, *comparison, report);
      if (learning != steps::StepLearning::kNone || &table != &tables.front()) continue;
      report.bands.push_back({"median error of slip, sols 45 to 582, learned from nothing",
                              comparison->scores.median_error.value, 0.0, 0.020});
      report.bands.push_back(
          {"share in the 90 % band, the same", comparison->scores.in_band.value, 0.84, 0.97});
      report.plot = api::step_chart(*comparison);
    }
  }
  report.notes = {
      "The belief (soils gale_firm_*, gale_loose_*, unknown_ground) is fitted to both tables of Curiosity, "
      "so "
      "that its rows with \"none\" are no blind forecast. Fitted to sols 45 to 449 alone it had on sols 450 "
      "to "
      "582 a median error of 0.0174, 94 % in the band and 0.1 expected steps above 0.4 where there was 1; at "
      "Marias Pass 0.0210, 85 % and 1.0 where there were 11: what rarely happens can't be learned where it "
      "did "
      "not happen.",
      "Downhill of -6 deg the band holds 85 % of the steps, above 3 deg of climb 97 %: the scatter is fitted "
      "as "
      "one number for all slopes.",
      "Perseverance's rover file is made of published figures, its belief is Curiosity's: nothing is fitted. "
      "Its steps have the mean slope of their sol, and single rows above 0.4 may be steps that were cut "
      "short."};
  return report;
}

}  // namespace slipway::validation
