#include "api/steps/step_comparison_document.h"

#include <fmt/format.h>

#include "api/json/writer.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

using json::Writer;

void write(Writer& w, std::string_view key, const steps::Estimate& figure) {
  w.key(key).begin_object().significant("value", figure.value);
  w.significant("low", figure.low).significant("high", figure.high).end_object();
}

void write(Writer& w, std::string_view key, const steps::ProbabilityScore& score) {
  w.key(key).begin_object().whole("cases", static_cast<std::int64_t>(score.cases));
  w.whole("above", static_cast<std::int64_t>(score.above)).significant("expected", score.expected);
  w.significant("log_score", score.log_score).significant("auc", score.auc).key("bins").begin_array();
  for (const auto& bin : score.bins) {
    if (bin.cases == 0) continue;
    w.begin_object().exact("least", bin.least).exact("most", bin.most);
    w.whole("cases", static_cast<std::int64_t>(bin.cases)).significant("expected", bin.expected);
    w.whole("above", static_cast<std::int64_t>(bin.above)).end_object();
  }
  w.end_array().end_object();
}

void write(Writer& w, std::string_view key, const std::vector<steps::BandScore>& bands) {
  w.key(key).begin_array();
  for (const steps::BandScore& band : bands)
    w.begin_object()
        .text("name", band.name)
        .whole("steps", static_cast<std::int64_t>(band.steps))
        .significant("in_band", band.in_band)
        .significant("median_error", band.median_error)
        .end_object();
  w.end_array();
}

void write_step(Writer& w, const steps::SlipStep& step, const StepComparison& comparison,
                const std::optional<StepComparison::Place>& place) {
  w.begin_object().whole("sol", step.sol);
  const auto slope =
      place ? std::optional(comparison.sols[place->sol].steps[place->step].pitch_rad) : step.climb_rad();
  slope ? w.key("path_pitch_deg").angle_deg(*slope) : w.key("path_pitch_deg").null();
  w.exact("slip", step.slip);
  if (!place) {
    for (const char* key : {"slip_p05", "slip_p50", "slip_p95", "p_over_0_2", "p_over_0_4"})
      w.key(key).null();
  } else {
    const steps::StepForecast& f = comparison.sols[place->sol].forecast.steps[place->step];
    w.significant("slip_p05", f.slip_p05)
        .significant("slip_p50", f.slip_p50)
        .significant("slip_p95", f.slip_p95);
    w.significant("p_over_0_2", f.over_0_2).significant("p_over_0_4", f.over_0_4);
  }
  w.end_object();
}

}  // namespace

std::string estimate_words(const steps::Estimate& estimate, double factor, int digits) {
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", factor * estimate.value, digits, factor * estimate.low,
                     digits, factor * estimate.high, digits);
}

std::string_view name_of(steps::StepLearning learning) {
  switch (learning) {
    case steps::StepLearning::kNone:
      return "none";
    case steps::StepLearning::kSols:
      return "sols";
    case steps::StepLearning::kDrive:
      return "drive";
  }
  return "";
}

std::string step_comparison_json(const StepComparisonRequest& request, std::span<const steps::SlipStep> steps,
                                 const StepComparison& comparison) {
  const steps::StepScores& s = comparison.scores;
  Writer w;
  w.begin_object().text("format", "steps-score/1").text("rover", request.rover);
  request.terrain.empty() ? w.key("terrain").null() : w.text("terrain", request.terrain);
  w.text("learn", name_of(request.learning)).key("grounds").begin_array();
  for (const std::string& ground : comparison.grounds) w.text(ground);
  w.end_array().key("summary").begin_object();
  w.whole("steps", static_cast<std::int64_t>(s.steps)).whole("sols", static_cast<std::int64_t>(s.sols));
  w.whole("without_pitch", static_cast<std::int64_t>(comparison.without_pitch));
  w.whole("off_map", static_cast<std::int64_t>(comparison.off_map));
  write(w, "median_error", s.median_error);
  write(w, "rms_error", s.rms_error);
  write(w, "in_90_band", s.in_band);
  w.significant("mean_log_density", s.mean_log_density);
  write(w, "step_over_0_2", s.step_over_0_2);
  write(w, "step_over_0_4", s.step_over_0_4);
  write(w, "sol_over_0_2", s.sol_over_0_2);
  write(w, "sol_over_0_4", s.sol_over_0_4);
  write(w, "by_pitch", s.by_pitch);
  write(w, "by_sol", s.by_sol);
  w.end_object().key("steps").begin_array();
  for (std::size_t i = 0; i < steps.size(); ++i) write_step(w, steps[i], comparison, comparison.places[i]);
  w.end_array().end_object();
  return w.take();
}

std::string step_comparison_text(const StepComparisonRequest& request, const StepComparison& comparison) {
  const steps::StepScores& s = comparison.scores;
  std::string out = fmt::format(
      "{} steps of {} sols, {}{}; learned from: {}\n"
      "slip, median error    {}\n"
      "slip, rms error       {}\n"
      "in the 90 % band, %   {}\n",
      s.steps, s.sols, request.rover, request.terrain.empty() ? "" : " on terrain " + request.terrain,
      request.learning == steps::StepLearning::kNone   ? "nothing"
      : request.learning == steps::StepLearning::kSols ? "the sols before each"
                                                       : "the sols and the steps before each",
      estimate_words(s.median_error, 1.0, 4), estimate_words(s.rms_error, 1.0, 4),
      estimate_words(s.in_band, 100.0, 1));
  const auto add = [&](const char* what, const steps::ProbabilityScore& score) {
    out += fmt::format("{}: {} of {}, {:.1f} expected, AUC {:.2f}\n", what, score.above, score.cases,
                       score.expected, score.auc);
  };
  add("steps above slip 0.2", s.step_over_0_2);
  add("steps above slip 0.4", s.step_over_0_4);
  add("sols with one above 0.2", s.sol_over_0_2);
  add("sols with one above 0.4", s.sol_over_0_4);
  out += "climb            steps  in the band  median error\n";
  for (const steps::BandScore& band : s.by_pitch)
    out += fmt::format("{:<16} {:>5}  {:>9.0f} %  {:>12.4f}\n", band.name, band.steps, 100.0 * band.in_band,
                       band.median_error);
  if (comparison.without_pitch > 0)
    out += fmt::format("{} steps have no slope and are taken as level\n", comparison.without_pitch);
  if (comparison.off_map > 0)
    out += fmt::format("{} steps are not on the terrain and are left out\n", comparison.off_map);
  return out;
}

}  // namespace slipway::api
