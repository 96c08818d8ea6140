#include "api/report/diagnosis_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "api/documents/diagnosis/diagnosis_document.h"
#include "api/files/corrected_model.h"
#include "api/report/diagnosis_sections.h"
#include "api/report/gap_report.h"
#include "api/report/report_words.h"
#include "core/angle.h"
#include "core/version.h"

namespace slipway::api {
namespace {

using gap::Diagnosis;
using gap::Verdict;
using Spans = std::vector<ReportText::Span>;
using Style = ReportText::Style;

constexpr std::size_t kMaxCandidates = 10;
constexpr double kMinMarginal = 0.01;  // of effects with a row of their own

// What the verdict means, for someone who has not read the manual.
std::string_view meaning(Verdict verdict, bool since_reference) {
  switch (verdict) {
    case Verdict::kNoGap:
      return "With parameters re-tuned within what was believed of them, prediction and drives agree as "
             "closely as sensors and the drives' own scatter allow. Nothing is missing.";
    case Verdict::kNotDetected:
      return "No gap was found, but these drives could not have shown a small one.";
    case Verdict::kParameters:
      return "No effect is missing. Known parameters were off, and re-tuning them explains the drives.";
    case Verdict::kEffects:
      return since_reference ? "The effects below have set in since the reference; with them the drives are "
                               "explained."
                             : "The simulator lacked the effects below; with them it explains the drives.";
    case Verdict::kEffectSet:
      return "Something is missing, and several explanations look alike on these drives. The best is below.";
    case Verdict::kUnknown:
      return "Something is missing that no effect of the library explains. What is known of it is below.";
    case Verdict::kInsufficient:
      return "There are too few drives or channels to say anything.";
  }
  return "";
}

constexpr std::string_view kPartial =
    "The effects below are at work. They explain a part: something unexplained remains beside them, "
    "and what is known of it is below too.";

std::string_view why_no_model(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNoGap:
    case Verdict::kNotDetected:
      return "None is offered: what was given predicts these drives as well as they can be, once its "
             "parameters are re-tuned within what was believed of them.";
    case Verdict::kInsufficient:
      return "None is offered: there are too few drives.";
    default:
      return "None is offered: it would be no better one to plan with than the nominal one. The notes say "
             "why.";
  }
}

std::string set_words(const std::vector<std::string>& names) {
  return names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " + "));
}

class Report {
 public:
  Report(const gap::DriveCampaign& campaign, const Diagnosis& d, const std::vector<NamedChart>& charts,
         ReportPage& page)
      : campaign_(campaign), d_(d), charts_(charts), page_(page) {}

  // For an engineer who was not in the room: what was found and how sure, where, how far the gap shrinks,
  // what to change, which drive next. What that rests on follows.
  void write() {
    write_verdict();
    write_where(page_, d_, charts_);
    write_unknown(page_, d_);
    write_ladder(page_, d_, charts_);
    write_model();
    write_next_drives(page_, d_);
    write_how_to_read();
    write_explanations();
    write_retuned(page_, d_);
    add_picture(page_, charts_, "parameters", "Re-tuned parameters in deviations of their priors");
    write_reference(page_, d_);
    write_what_was_driven(page_, campaign_);
    write_notes();
    write_options(page_, d_);
  }

 private:
  void write_verdict() {
    page_.paragraph(
        Spans{{std::string(gap::name_of(d_.verdict)), Style::kStrong},
              {fmt::format(": {}", d_.partial ? kPartial : meaning(d_.verdict, d_.reference.has_value()))}});
    page_.paragraph(fmt::format("{}.", d_.reason));
    if (!d_.overturned_by.empty())
      page_.paragraph(fmt::format("What would overturn it: {}.", d_.overturned_by));
    write_found_effects(page_, d_);
    page_.paragraph(fmt::format("{} drives, {} windows, {} observations, {} effects in the library.",
                                d_.drives, d_.windows, d_.observations, d_.library.size()));
  }

  // The words that the sections below use.
  void write_how_to_read() {
    if (d_.verdict == Verdict::kInsufficient) return;
    page_.section("How to read this page");
    page_.item(
        "Drives are cut into windows of about a metre and a half. In each the simulator predicts, from the "
        "commands and the ground alone, what was measured: the channels (slip, motor currents, sinkage, "
        "...). "
        "The gap is what it is off by beyond what sensors and the drives' own scatter explain.");
    page_.item(
        "An explanation is a set of effects that the simulator lacks, or that nothing is missing, or "
        "something unknown. All of them may re-tune soils and motors, and compete. Probabilities add up to 1 "
        "over the explanations.");
    page_.item(
        "Figures of how well a model predicts are of drives held out: those from which it had not learnt.");
  }

  void write_explanations() {
    if (d_.candidates.empty()) return;
    page_.section("Explanations compared");
    page_.table(
        {"explanation", "probability", "estimated parameters", "held-out score", "chosen by resamples"});
    std::size_t shown = 0;
    for (const gap::ComparedSet& set : json::compared_sets(d_)) {
      const bool ends = set.effects.empty();  // nothing missing, or something unknown alone
      if (++shown > kMaxCandidates && !ends) continue;
      page_.row({set_words(gap::names_of(set)), probability_words(set.probability),
                 fmt::format("{}", set.complexity),
                 set.held_out_score ? number_words("{:+.2f}", *set.held_out_score) : "",
                 fmt::format("{:.0f} %", 100.0 * set.chosen_share)});
    }
    page_.paragraph(
        "The score is the gain of log density a drive over re-tuned parameters alone, on drives that the fit "
        "had not seen. Last column: how often its evidence would have chosen the set, drives with their "
        "repeats drawn with replacement. It is not the probability: it says how much the choice depends on "
        "which drives were made. The probability is of all the drives, and uses only a part of their "
        "evidence, since no simulator is exact.");
    add_picture(page_, charts_, "explanations", "Probability of each explanation");
    write_marginals();
    if (!d_.confusable.empty()) {
      page_.paragraph("Pairs that these drives hardly tell apart:");
      page_.table({"one", "other", "angle between their signatures, deg"});
      for (const gap::ConfusablePair& pair : d_.confusable)
        page_.row({pair.a, pair.b, fmt::format("{:.0f}", pair.angle_deg)});
    }
    write_measurements();
  }

  void write_measurements() {
    if (d_.measurements.empty()) return;
    page_.paragraph(
        "Effects that these drives would hide behind re-tuned parameters, at their usual size, and what "
        "would "
        "uncover them: those parameters measured apart from drives (parameter_std of the campaign says so). "
        "Deviations are those by which the effect shows.");
    page_.table({"effect", "shows now by", "would show by", "once known from", "what it is"});
    for (const gap::MeasurementProposal& proposal : d_.measurements) {
      std::vector<std::string_view> ways;
      for (const gap::NuisanceKind kind : proposal.kinds) ways.push_back(gap::measurement_of(kind));
      page_.row({proposal.effect, fmt::format("{:.1f}", proposal.deviations_now),
                 fmt::format("{:.1f}", proposal.deviations_then), fmt::format("{}", fmt::join(ways, "; ")),
                 effect_summary(proposal.effect)});
    }
  }

  void write_marginals() {
    const auto shown = [](const gap::EffectMarginal& m) { return m.probability >= kMinMarginal; };
    if (std::none_of(d_.marginals.begin(), d_.marginals.end(), shown)) return;
    page_.paragraph(
        "Each effect of the library over all explanations, with and without something unknown beside it, and "
        "what goes with it of the gap that re-tuning leaves on drives held out of the fit. Effects are named "
        "by the last figure: how often effects with such a probability and such a share were at work in "
        "campaigns whose causes were known.");
    page_.table({"effect", "probability", "closes", "at work", "what it is"});
    for (const gap::EffectMarginal& m : d_.marginals)
      if (shown(m))
        page_.row({m.name, probability_words(m.probability), fmt::format("{:.0f} %", 100.0 * m.closed_share),
                   probability_words(m.calibrated), effect_summary(m.name)});
  }

  void write_model() {
    page_.section("The corrected model");
    const auto model = corrected_model(campaign_, d_);
    if (!model) return page_.paragraph(std::string(why_no_model(d_.verdict)));
    page_.paragraph(Spans{{"Rover "},
                          {model->rover.name, Style::kCode},
                          {model->rover.effects.empty() ? "; " : " with the effects above at work; "},
                          {"slipway diagnose --model", Style::kCode},
                          {" writes its files."}});
    page_.table({"soil", "k_c", "k_phi", "n", "cohesion, Pa", "friction angle, deg", "shear modulus, m"});
    const auto describe = [&](const ReportText& name, const sim::Soil& s) {
      page_.row({name, fmt::format("{:.4g}", s.pressure.k_c), fmt::format("{:.4g}", s.pressure.k_phi),
                 fmt::format("{:.3f}", s.pressure.n), fmt::format("{:.4g}", s.cohesion_pa),
                 fmt::format("{:.2f}", deg_from_rad(s.friction_angle_rad)),
                 fmt::format("{:.4f}", s.shear_modulus_x_m)});
    };
    for (std::size_t k = 0; k < model->soils.size(); ++k) {
      describe(d_.nominal_soils[k].name, d_.nominal_soils[k].soil);
      describe(Spans{{model->soils[k].name, Style::kCode}}, model->soils[k].mean);
    }
  }

  void write_notes() {
    page_.section("Notes");
    for (const std::string& note : d_.notes) page_.item(note);
    const gap::NoiseScales& n = d_.noise;
    page_.item(
        fmt::format("scatter from drive to drive, of logarithms: stiffness {:.2g}, friction {:.2g}, shear "
                    "modulus {:.2g}; {:.2g} of it again from window to window",
                    n.stiffness, n.friction, n.shear_modulus, n.within_drives));
    page_.item(fmt::format("Slipway {}, seed {}, campaign fingerprint {}", version(), d_.seed,
                           d_.campaign_fingerprint));
  }

  const gap::DriveCampaign& campaign_;
  const Diagnosis& d_;
  const std::vector<NamedChart>& charts_;
  ReportPage& page_;
};

}  // namespace

ReportPage diagnosis_report(const gap::DriveCampaign& campaign, const Diagnosis& diagnosis,
                            const std::vector<NamedChart>& charts) {
  ReportPage page(fmt::format("Diagnosis of {}", diagnosis.campaign));
  write_diagnosis(page, campaign, diagnosis, charts);
  return page;
}

void write_diagnosis(ReportPage& page, const gap::DriveCampaign& campaign, const Diagnosis& diagnosis,
                     const std::vector<NamedChart>& charts) {
  Report(campaign, diagnosis, charts, page).write();
}

}  // namespace slipway::api
