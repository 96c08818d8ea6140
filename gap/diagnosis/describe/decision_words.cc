#include "gap/diagnosis/describe/decision_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace slipway::gap {
namespace {

constexpr std::string_view kSameLook =
    "an effect of the library with another equation than the library's would look the same";

// "dragging_wheel (probability 0.999) closes 93 % of the gap", of each effect.
std::string closing_words(std::span<const EffectMarginal> marginals, std::span<const std::string> effects) {
  std::vector<std::string> each;
  for (const std::string& effect : effects) {
    const EffectMarginal m = marginal_of(marginals, effect);
    each.push_back(fmt::format("{} (probability {:.3f}) closes {:.0f} % of the gap", effect, m.probability,
                               100.0 * m.closed_share));
  }
  return fmt::format("{}", fmt::join(each, ", "));
}

std::string conflict_words(const Adequacy& adequacy) {
  if (adequacy.held_out_p < adequacy.conflict_p)
    return fmt::format(
        "the model is not adequate: drives held out of the best explanation are told {:.2f} times worse than "
        "their noise (probability {:.1g} by chance)",
        adequacy.held_out_rms, adequacy.held_out_p);
  return fmt::format(
      "the wheel model is not adequate: {} would lie {:.1f} deviations from what was believed (a conflict of "
      "probability {:.1g})",
      adequacy.furthest.empty() ? "the drives' scatter" : adequacy.furthest, adequacy.deviations,
      adequacy.conflict_p);
}

std::string outside_words(const OutsideFinding& outside) {
  return fmt::format("{} (probability {:.2f})", outside.words, outside.probability);
}

// The most probable explanation with other effects, or with something unknown in another way.
std::string next_best(const SearchRecord& record, const SearchRecord::Explanation& answer) {
  for (const SearchRecord::Explanation& e : record.explanations) {
    if (e.effects == answer.effects && e.unknown() == answer.unknown()) continue;
    std::vector<std::string> names = e.effects;
    if (e.unknown()) names.emplace_back("unknown");
    return fmt::format("next best: {} (probability {:.2g})",
                       names.empty() ? "nothing missing" : fmt::format("{}", fmt::join(names, " and ")),
                       e.probability);
  }
  return {};
}

std::string unknown_words(const Decision& decision, std::span<const EffectMarginal> marginals,
                          const std::optional<OutsideFinding>& outside) {
  if (!decision.adequate) return conflict_words(decision.adequacy);
  if (outside && decision.marginals.unknown > 0.5)
    return fmt::format("no effect of the library: {}; something unknown {:.2f}", outside_words(*outside),
                       decision.marginals.unknown);
  std::vector<std::string> likely;
  for (const EffectMarginal& m : marginals)
    if (m.probability >= 0.1) likely.push_back(fmt::format("{} ({:.2f})", m.name, m.probability));
  return fmt::format(
      "something is missing (probability {:.2f}) that no effect of the library explains surely: "
      "something unknown has {:.2f}{}{}",
      decision.missing_probability, decision.marginals.unknown, likely.empty() ? "" : ", ",
      fmt::join(likely, ", "));
}

}  // namespace

DecisionWords words_of(const Decision& decision, const SearchRecord& record,
                       std::span<const EffectMarginal> marginals,
                       const std::optional<OutsideFinding>& outside) {
  const std::string rival = next_best(record, record.explanations[decision.answer]);
  const auto or_rival = [&](std::string_view words) {
    return rival.empty() ? std::string(words) : fmt::format("{}; {}", words, rival);
  };
  const double nothing = 1.0 - decision.missing_probability;
  switch (decision.verdict) {
    case Verdict::kEffects:
    case Verdict::kEffectSet: {
      const std::string named = closing_words(marginals, decision.names);
      if (decision.verdict == Verdict::kEffectSet)
        return {
            fmt::format("{}; whether other effects of the library are at work beside is open on these drives",
                        named),
            rival};
      if (!decision.partial)
        return {fmt::format("{}; that these explain what re-tuned parameters leave over has a probability of "
                            "{:.2f}",
                            named, decision.set_probability),
                rival};
      const std::string beside = !decision.adequate ? conflict_words(decision.adequacy)
                                 : outside          ? outside_words(*outside)
                                                    : "something of no known form";
      return {fmt::format("{}, and beside it remains unexplained: {}", named, beside),
              std::string(kSameLook)};
    }
    case Verdict::kUnknown:
      return {unknown_words(decision, marginals, outside), std::string(kSameLook)};
    case Verdict::kParameters:
      return {fmt::format("re-tuned soil and motor parameters explain the drives (log evidence +{:.0f}); no "
                          "effect is missing (probability {:.2f})",
                          record.parameters_gain, nothing),
              or_rival("an effect that acts like these parameters in every drive that was made")};
    case Verdict::kNoGap:
      return {fmt::format("with parameters re-tuned within what was believed of them, prediction and drives "
                          "agree within the drives' own scatter (probability {:.2f})",
                          nothing),
              or_rival("drives that show an effect below the least size that these could have shown")};
    case Verdict::kNotDetected:
    case Verdict::kInsufficient:
      break;
  }
  return {"no gap was found, but these drives could not have shown effects of half their usual size",
          or_rival("drives that show an effect below the least size that these could have shown")};
}

std::string changed_words(const FollowedDrives& followed, const ReferenceBelief* reference) {
  const WatchedDrive& at = followed.drives[*followed.alarm];
  std::string words = fmt::format(
      "something has changed: from drive {} on the drives are no longer what {} taught (evidence 10^{:.1f} "
      "to "
      "1 at drive {}), though no explanation of all of them together is more probable than none",
      followed.drives[followed.since].id,
      reference != nullptr ? fmt::format("the healthy drives of {}", reference->campaign)
                           : "the drives before them",
      at.log10_evidence, at.id);
  if (!followed.causes.empty())
    words += fmt::format("; a first pointer is {} ({:.2f} of the evidence)", followed.causes.front().name,
                         followed.causes.front().share);
  return words;
}

}  // namespace slipway::gap
