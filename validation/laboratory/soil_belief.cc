#include "api/requests/soil_belief.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "api/documents/soil_belief_document.h"
#include "api/files/catalogue.h"
#include "core/progress.h"
#include "validation/laboratory/comparisons.h"

namespace slipway::validation {
namespace {

// A file of data/beliefs, and how its law is called in the table.
struct Law {
  const char* file;
  const char* name;
};
constexpr std::array kLaws{Law{"wheel_tests_plain", "plain"}, Law{"wheel_tests_closures", "with effects"}};

std::string with_std(const gap::NumbersOfSoil& of, std::size_t number) {
  const auto k = static_cast<Eigen::Index>(number);
  return fmt::format("{:.2f} +- {:.2f}", of.mean[k], of.std[k]);
}

void add_rows(const Law& law, const gap::SoilBelief& belief, Report& report) {
  for (const gap::TestedSoilBelief& soil : belief.soils) {
    const gap::SoilLeftOut& left = soil.left_out;
    std::vector<std::string> row{law.name, soil.name, fmt::format("{}", soil.readings),
                                 fmt::format("{:.1f}", soil.residual_variance)};
    for (std::size_t k = 0; k < belief.between.size(); ++k) {
      row.push_back(with_std(soil.alone, k));
      row.push_back(fmt::format("{}, own at {:.0f} %{}", with_std(left.predicted, k), 100.0 * left.rank[k],
                                left.held(k) ? "" : ": missed"));
    }
    row.push_back(fmt::format("{} / {}", left.readings.by_belief, left.readings.by_file));
    report.rows.push_back(std::move(row));
  }
}

std::string words_of(const gap::SpreadInterval& of) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f} at 90 %)", of.median, of.low, of.high);
}

void add_notes(const Law& law, const gap::SoilBelief& belief, Report& report) {
  const gap::BetweenSoils& all = belief.all;
  report.notes.push_back(
      fmt::format("Law {}: between soils c1 {:.2f} +- {:.2f} with a spread of {}, c2 {:.2f} +- {:.2f} with "
                  "{}, correlation "
                  "{}. A soil that was not tested: c1 {}, c2 {}, correlation {:+.2f}.",
                  law.name, all.mean[0], all.mean_std[0], words_of(all.spread[0]), all.mean[1],
                  all.mean_std[1], words_of(all.spread[1]), words_of(all.correlation), with_std(all.next, 0),
                  with_std(all.next, 1), all.next.correlation(1, 0)));
}

}  // namespace

Result<Report> soil_belief(const std::filesystem::path& data) {
  const auto catalogue = api::load_catalogue(data);
  if (!catalogue) return fail(catalogue.error());
  Report report;
  report.title = "What c1 and c2 differ by between soils, each soil predicted by the others";
  report.source =
      "all wheel tests that ship: Ding et al. 2011 (one sand, two wheels), Pavlov and Johnson 2022 (one "
      "sand, "
      "two wheels), the ends of Zhurong's measured pulls (two simulants); within each soil fitted, between "
      "soils leave-one-soil-out";
  report.columns = {"law",           "soil",         "readings",
                    "variance left", "c1 alone",     "c1 by others",
                    "c2 alone",      "c2 by others", "readings held, by the others' c1 and c2 / the file's"};
  std::size_t missed = 0, held = 0, readings = 0;
  for (const Law& law : kLaws) {
    const auto request =
        api::json::load_soil_belief_request(data / "beliefs" / fmt::format("{}.json", law.file), data);
    if (!request) return fail(request.error());
    NoProgress progress;
    const auto belief = api::believe_soils(*catalogue, *request, progress);
    if (!belief) return fail(belief.error());
    add_rows(law, *belief, report);
    add_notes(law, *belief, report);
    for (const gap::TestedSoilBelief& soil : belief->soils) {
      for (std::size_t k = 0; k < belief->between.size(); ++k) missed += soil.left_out.held(k) ? 0 : 1;
      held += soil.left_out.readings.by_belief;
      readings += soil.left_out.readings.all;
    }
  }
  report.bands = {{"numbers of a soil that lie outside the others' 90 % interval, of 16",
                   static_cast<double>(missed), 0.0, 4.0}};
  return report;
}

}  // namespace slipway::validation
