#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "research/validation/report/csv_table.h"
#include "research/validation/simulators/comparisons.h"
#include "research/validation/simulators/sealed_scores.h"

namespace slipway::validation {
namespace {

using gap::CaseScore;
using gap::Rate;
using gap::TruthKind;

const std::string kAsIs = "as-is";

void count(Rate& rate, bool hit) {
  ++rate.of;
  rate.hits += hit ? 1 : 0;
}

// Exactly what is hidden, or a partial answer with exactly its names.
bool is_right(const CaseScore& c) {
  return c.exact || (c.partial && c.names_right);
}

struct LevelRates {
  Rate right, wrong, with_cause, healthy_unnamed, outside_unnamed, alarms;

  void add(const CaseScore& c) {
    const bool healthy = c.truth_kind == TruthKind::kNothing || c.truth_kind == TruthKind::kParameters;
    count(right, is_right(c));
    count(wrong, c.wrong_name);
    if (!healthy) count(with_cause, is_right(c));
    if (healthy) count(healthy_unnamed, !c.wrong_name);
    if (healthy) count(alarms, c.false_alarm);
    if (c.truth_kind == TruthKind::kOutsideLibrary) count(outside_unnamed, !c.wrong_name);
  }
  std::vector<std::string> cells() const {
    return {rate_words(right),           rate_words(with_cause),      rate_words(wrong),
            rate_words(healthy_unnamed), rate_words(outside_unnamed), rate_words(alarms)};
  }
};

// "blind-1 s02 (hardpan as unknown)"
std::string miss_words(const SealedScore& s) {
  const CaseScore& c = s.score;
  return fmt::format("{} {} ({}{} as {}{})", s.set, c.campaign, c.truth,
                     c.size == 1.0 ? "" : fmt::format(", size {:g}", c.size), c.verdict,
                     c.found == "nothing" || c.found == c.verdict ? "" : " " + c.found);
}

std::string joined(const std::vector<std::string>& parts) {
  std::string all;
  for (const std::string& part : parts) all += (all.empty() ? "" : ", ") + part;
  return all.empty() ? "none" : all;
}

}  // namespace

Result<Report> sealed_levels(const std::filesystem::path& data) {
  const auto scores = read_sealed_scores(data / "validation" / "sealed_levels_scores.csv");
  if (!scores) return fail(scores.error());
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> order;  // variant, set, by level
  std::map<std::tuple<std::string, std::string, std::string>, LevelRates> rates;
  std::map<std::string, std::vector<std::string>> misses;
  for (const SealedScore& s : *scores) {
    const std::tuple key{s.score.fidelity, s.variant, s.set};
    if (!rates.contains(key)) order[s.score.fidelity].emplace_back(s.variant, s.set);
    rates[key].add(s.score);
    if ((s.variant == kAsIs || s.variant == kAsIs + "+reference") && !is_right(s.score))
      misses[fmt::format("{}, {}", s.score.fidelity, s.variant)].push_back(miss_words(s));
  }
  Report report;
  report.title = "The diagnosis on sealed campaigns, by level of fidelity, as it is and with parts taken out";
  report.source = "tests/gap_benchmark; shares with 90 % intervals [Clopper & Pearson 1934]";
  report.columns = {"level",
                    "variant",
                    "set",
                    "right, all",
                    "with a cause",
                    "a wrong name",
                    "healthy, unnamed",
                    "outside, unnamed",
                    "false alarms"};
  for (const auto& [level, rows] : order)
    for (const auto& [variant, set] : rows) {
      std::vector<std::string> row{level, variant, set};
      for (std::string& cell : rates[{level, variant, set}].cells()) row.push_back(std::move(cell));
      report.rows.push_back(std::move(row));
    }
  for (const auto& [of, those] : misses)
    report.notes.push_back(fmt::format("Misses at {}: {}.", of, joined(those)));
  report.notes.emplace_back(
      "\"Right\": exactly what is hidden, or a partial answer with exactly its names (target 24 of 26, at L3 "
      "with a "
      "reference 5 of 7 with a cause); a wrong name: at most 1 of 26; causes from outside without a library "
      "effect's "
      "name: 0.8; false alarms: effects or \"unknown\" where nothing is hidden. Variants: as-is; +reference: "
      "healthy "
      "drives of the same rover given; no-wrench: no causes from outside; old-naming: something unknown "
      "hides all "
      "names; no-wrench-old-naming: both, which is the diagnosis as it was before. Written by slipway "
      "gap-benchmark --csv "
      "(docs/results/gap_benchmark.md says with which sets).");
  return report;
}

Result<Report> sealed_marginals(const std::filesystem::path& data) {
  const auto table = CsvTable::read(data / "validation" / "sealed_levels_marginals.csv",
                                    {.numbers = {"probability", "closed_share", "hidden"},
                                     .numbers_or_empty = {},
                                     .texts = {"set", "variant", "campaign", "fidelity", "effect"}});
  if (!table) return fail(table.error());
  std::map<std::string, std::vector<gap::Statement>> statements;  // by level
  for (std::size_t row = 0; row < table->rows(); ++row)
    statements[fmt::format("{}, {}", table->text(row, "fidelity"), table->text(row, "variant"))].push_back(
        {table->number(row, "probability"), table->number(row, "hidden") != 0.0});
  Report report;
  report.title = "Whether marginal probabilities of single effects hold on sealed campaigns";
  report.source = "tests/gap_benchmark; of every effect of the library in every campaign; 90 % intervals";
  report.columns = {"level", "stated", "mean", "hidden"};
  for (const auto& [level, of] : statements) {
    for (const gap::ReliabilityBin& bin : gap::reliability_of(of))
      if (bin.right.of > 0)
        report.rows.push_back({level, fmt::format("{:.1f} to {:.1f}", bin.from, bin.to),
                               fmt::format("{:.3f}", bin.mean_probability), rate_words(bin.right)});
    report.notes.push_back(fmt::format("{}: calibration error {:.3f}, Brier score {:.3f} over {} statements.",
                                       level, gap::calibration_error(of).value_or(0.0),
                                       gap::brier_score(of).value_or(0.0), of.size()));
  }
  report.notes.emplace_back("Written by slipway gap-benchmark --marginals-csv.");
  return report;
}

Result<Report> sealed_detectability(const std::filesystem::path& data) {
  constexpr std::array kBounds{0.0, 50.0, 100.0, 300.0, 1000.0, 1e300};
  const std::filesystem::path folder = data / "validation";
  const auto scores = read_sealed_scores(folder / "sealed_levels_scores.csv");
  if (!scores) return fail(scores.error());
  const auto table =
      CsvTable::read(folder / "sealed_detectability.csv",
                     {.numbers = {"parameters_known", "retuned_as_drawn", "retuned_as_believed"},
                      .numbers_or_empty = {},
                      .texts = {"set", "campaign"}});
  if (!table) return fail(table.error());
  struct Bin {
    Rate one, several;
    std::vector<std::string> misses;
  };
  std::array<Bin, kBounds.size() - 1> bins;
  for (std::size_t row = 0; row < table->rows(); ++row)
    for (const SealedScore& s : *scores) {
      if (s.variant != kAsIs || s.set != table->text(row, "set") ||
          s.score.campaign != table->text(row, "campaign"))
        continue;
      if (s.score.truth_kind == TruthKind::kNothing || s.score.truth_kind == TruthKind::kParameters) continue;
      const double left = table->number(row, "retuned_as_believed");
      const auto above = std::upper_bound(kBounds.begin() + 1, kBounds.end() - 1, left);
      Bin& bin = bins[static_cast<std::size_t>(above - kBounds.begin()) - 1];
      const bool several = s.score.truth.find(" + ") != std::string::npos;
      count(several ? bin.several : bin.one, is_right(s.score));
      if (!is_right(s.score))
        bin.misses.push_back(fmt::format("{}: {:.3g} left of {:.3g}", miss_words(s), left,
                                         table->number(row, "parameters_known")));
    }
  Report report;
  report.title = "What of a hidden cause is left to see beside re-tuned parameters, and how often it is told";
  report.source = "tests/gap_benchmark; squared deviations of all readings; 90 % intervals";
  report.columns = {"squared deviations left", "one cause, right", "two causes, right"};
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const std::string range = b + 1 == bins.size() ? fmt::format("over {:g}", kBounds[b])
                                                   : fmt::format("{:g} to {:g}", kBounds[b], kBounds[b + 1]);
    report.rows.push_back({range, rate_words(bins[b].one), rate_words(bins[b].several)});
    if (!bins[b].misses.empty())
      report.notes.push_back(fmt::format("Misses with {} left: {}.", range, joined(bins[b].misses)));
  }
  report.notes.emplace_back(
      "A diagnosis that knew laws, sizes and places of the causes could expect a log evidence of half of "
      "what is left, and believes a third of it. Of two causes what is left is that of both: the weaker one "
      "can "
      "be invisible. Written by sealed_campaigns (detectability.csv), of sets that were blind when they were "
      "diagnosed.");
  return report;
}

}  // namespace slipway::validation
