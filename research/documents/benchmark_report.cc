#include "research/documents/benchmark_report.h"

#include <fmt/format.h>

#include <set>

#include "research/benchmark/benchmark_figures.h"

namespace slipway::api {
namespace {

using gap::BenchmarkFigures;
using gap::CaseScore;
using gap::Rate;

std::string rate_words(const Rate& rate) {
  if (rate.of == 0) return "-";
  const gap::RateInterval interval = gap::binomial_interval(rate);
  return fmt::format("{:.2f} ({:.2f} to {:.2f}), {} of {}", rate.value(), interval.low, interval.high,
                     rate.hits, rate.of);
}

std::string score_or_dash(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

void row(std::string& out, std::string_view figure, std::string_view target, const std::string& value) {
  out += fmt::format("| {} | {} | {} |\n", figure, value, target);
}

void write_figures(std::string& out, const std::string& title, std::span<const CaseScore> cases) {
  const BenchmarkFigures f = gap::figures_of(cases);
  out += fmt::format("\n### {}: {} campaigns\n\n", title, f.cases);
  out += "| figure | value (90 % interval) | target |\n| --- | --- | --- |\n";
  row(out, "right effects, exactly", "", rate_words(f.exact));
  row(out, "right effects, up to look-alikes", "", rate_words(f.alike));
  row(out, "right effects, exactly, size 1 and above", "0.85", rate_words(f.exact_sized));
  row(out, "right effects, up to look-alikes, size 1 and above", "0.93", rate_words(f.alike_sized));
  row(out, "at most three sets hold the truth", "0.95", rate_words(f.held));
  row(out, "verdict of the right class", "", rate_words(f.verdict_right));
  row(out, "false alarm where nothing is missing", "0.03", rate_words(f.alarm_nothing));
  row(out, "false alarm where only parameters are off", "0.05", rate_words(f.alarm_parameters));
  row(out, "unknown causes reported as unknown", "", rate_words(f.unknown_reported));
  row(out, "unknown distinguished from known (area under ROC)", "0.85", score_or_dash(f.unknown_auroc));
  row(out, "exactly the right names, alone or beside something unexplained", "0.92",
      rate_words(f.names_right));
  row(out, "a name that is not hidden", "0.04", rate_words(f.wrong_name));
  row(out, "a cause outside the library without the name of an effect", "0.80",
      rate_words(f.outside_unnamed));
  row(out, "a wrong name with more than 0.9", "0.05", rate_words(f.confident_wrong));
  row(out, "calibration error", "0.05", score_or_dash(f.calibration));
  row(out, "Brier score", "0.15", score_or_dash(f.brier));
  row(out, "median share of the gap closed", "0.90", score_or_dash(f.closed_fraction));
  row(out, "median share of what an oracle closes", "0.90", score_or_dash(f.closed_of_oracle));
  row(out, "the wheel of a found effect", "0.95", rate_words(f.wheel_right));
  row(out, "the channel in which the found effects act most", "0.95", rate_words(f.channel_right));
  row(out, "median overlap of the first slice", "0.6", score_or_dash(f.slice_overlap));
  row(out, "the same, of what the best slice has", "", score_or_dash(f.slice_of_attainable));
  row(out, "first slices that overlap by half or more", "", rate_words(f.slice_half));
  row(out, "median overlap of the soft patch's disc", "0.5", score_or_dash(f.place_overlap));
  row(out, "median seconds a campaign", "", f.seconds ? fmt::format("{:.1f}", *f.seconds) : "-");
}

void write_reliability(std::string& out, std::span<const CaseScore> cases) {
  out +=
      "\n### Marginal probabilities of single effects\n\n| stated | mean | hidden (90 % interval) |\n| --- | "
      "--- | "
      "--- |\n";
  for (const gap::ReliabilityBin& bin : gap::figures_of(cases).reliability)
    if (bin.right.of > 0)
      out += fmt::format("| {:.1f} to {:.1f} | {:.3f} | {} |\n", bin.from, bin.to, bin.mean_probability,
                         rate_words(bin.right));
}

const char* mark(bool yes) {
  return yes ? "yes" : "";
}

void write_cases(std::string& out, std::span<const CaseScore> cases) {
  out +=
      "\n### Campaigns\n\n| campaign | hidden | size | kind | fidelity | verdict | found | exact | names | "
      "alike | "
      "stated | "
      "P(unknown) | s |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const CaseScore& c : cases)
    out += fmt::format("| {} | {} | {:g} | {} | {} | {} | {} | {} | {} | {} | {:.2f} | {:.2f} | {:.1f} |\n",
                       c.campaign, c.truth, c.size, c.kind, c.fidelity, c.verdict, c.found, mark(c.exact),
                       mark(c.names_right), mark(c.alike), c.stated, c.unknown_probability, c.seconds);
}

void write_confusion(std::string& out, std::span<const CaseScore> cases) {
  out += "\n### Hidden against found\n\n| hidden | found (how often) |\n| --- | --- |\n";
  for (const auto& [truth, found] : gap::confusion_of(cases)) {
    std::string words;
    for (const auto& [name, count] : found)
      words += fmt::format("{}{}{}", words.empty() ? "" : ", ", name,
                           count > 1 ? fmt::format(" ({})", count) : "");
    out += fmt::format("| {} | {} |\n", truth, words);
  }
}

void write_withheld(std::string& out, std::span<const gap::WithheldScore> withheld) {
  Rate right, unknown, alike, declared, absorbed;
  for (const gap::WithheldScore& w : withheld) {
    for (const auto& [rate, hit] : {std::pair{&right, w.right()},
                                    {&unknown, w.unknown},
                                    {&alike, w.look_alike},
                                    {&declared, w.declared},
                                    {&absorbed, w.absorbed}}) {
      ++rate->of;
      rate->hits += hit ? 1 : 0;
    }
  }
  out +=
      "\n### With the hidden effect withheld from the library\n\n| figure | value (90 % interval) |\n| --- | "
      "--- |\n";
  out += fmt::format(
      "| unknown or a look-alike | {} |\n| unknown | {} |\n| another effect that looks alike | {} |\n| "
      "parameters "
      "that are declared to look alike | {} |\n",
      rate_words(right), rate_words(unknown), rate_words(alike), rate_words(declared));
  out += fmt::format("| no effect, or parameters alone | {} |\n", rate_words(absorbed));
  out += "\n| campaign | withheld | verdict | found | right |\n| --- | --- | --- | --- | --- |\n";
  for (const gap::WithheldScore& w : withheld)
    out += fmt::format("| {} | {} | {} | {} | {} |\n", w.campaign, w.withheld, w.verdict, w.found,
                       mark(w.right()));
}

}  // namespace

std::string benchmark_report(const gap::Benchmark& benchmark) {
  std::string out = fmt::format("## Diagnosis, variant {}\n", benchmark.variant);
  for (const auto& [name, cases] : benchmark_groups(benchmark)) write_figures(out, name, cases);
  write_reliability(out, benchmark.cases);
  write_cases(out, benchmark.cases);
  write_confusion(out, benchmark.cases);
  if (!benchmark.withheld.empty()) write_withheld(out, benchmark.withheld);
  return out;
}

std::string benchmark_csv(const gap::Benchmark& benchmark, const std::string& set) {
  std::string out =
      "set,variant,campaign,hidden,hidden_kind,size,kind,fidelity,verdict,found,exact,alike,verdict_right,"
      "held,"
      "false_alarm,confident_wrong,unknown_probability,stated,wheel_right,closed_fraction,"
      "oracle_closed_fraction,place_overlap,"
      "seconds,channel_right,slice_overlap,slice_attainable,partial,names_right,wrong_name\n";
  const auto yes = [](const std::optional<bool>& value) { return value ? (*value ? "1" : "0") : ""; };
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.4g}", *value) : std::string();
  };
  for (const CaseScore& c : benchmark.cases)
    out += fmt::format(
        "{},{},{},{},{},{:g},{},{},{},{},{:d},{:d},{:d},{:d},{:d},{:d},{:.4g},{:.4g},{},{},{},{},{:.1f},{},{}"
        ",{},{:d},{:d},{:d}"
        "\n",
        set, benchmark.variant, c.campaign, c.truth, static_cast<int>(c.truth_kind), c.size, c.kind,
        c.fidelity, c.verdict, c.found, c.exact, c.alike, c.verdict_right, c.held, c.false_alarm,
        c.confident_wrong, c.unknown_probability, c.stated, yes(c.wheel_right), number(c.closed_fraction),
        number(c.oracle_closed_fraction), number(c.place_overlap), c.seconds, yes(c.channel_right),
        number(c.slice_overlap), number(c.slice_attainable), c.partial, c.names_right, c.wrong_name);
  return out;
}

std::string marginals_csv(const gap::Benchmark& benchmark, const std::string& set) {
  std::string out = "set,variant,campaign,fidelity,effect,probability,closed_share,hidden\n";
  for (const CaseScore& c : benchmark.cases)
    for (const gap::MarginalStatement& m : c.marginals)
      out += fmt::format("{},{},{},{},{},{:.4g},{:.4g},{:d}\n", set, benchmark.variant, c.campaign,
                         c.fidelity, m.effect, m.probability, m.closed_share, m.right);
  return out;
}

std::string withheld_csv(const gap::Benchmark& benchmark, const std::string& set) {
  std::string out =
      "set,variant,campaign,withheld,fidelity,verdict,found,unknown,look_alike,absorbed,declared\n";
  for (const gap::WithheldScore& w : benchmark.withheld)
    out += fmt::format("{},{},{},{},{},{},{},{:d},{:d},{:d},{:d}\n", set, benchmark.variant, w.campaign,
                       w.withheld, w.fidelity, w.verdict, w.found, w.unknown, w.look_alike, w.absorbed,
                       w.declared);
  return out;
}

}  // namespace slipway::api
