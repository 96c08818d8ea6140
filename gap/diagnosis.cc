#include "gap/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "core/angle.h"
#include "gap/effect_trace.h"
#include "gap/localise.h"
#include "gap/next_drives.h"
#include "gap/prepared_campaign.h"
#include "gap/shrink.h"
#include "gap/unexplained.h"
#include "sim/effect_catalogue.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kLeastDrives = 3, kLeastWindows = 6;
constexpr int kMostRefittedAgain = 6, kMostPairedAgain = 2, kMostSecondsAgain = 2;
constexpr std::size_t kMostKept = 6;      // sets of effects that are fitted again
constexpr double kMuchLess = 0.5;         // of a probability
constexpr double kCertain = 0.5;          // of a set's probability: below it the answer is a set of sets
constexpr double kWorthNaming = 0.05;     // of an effect's probability
constexpr double kParametersGain = 20.0;  // of the logarithm of the evidence, for calling parameters mis-set
constexpr double kSurelySeen = 6.0;  // standard errors: what the tempered evidence asks for over its prior
constexpr double kSmall = 0.5;       // of an effect's usual size
constexpr double kAlike_deg = 30.0;
constexpr int kRounds = 2;  // searches: the second under the scatter around what the first found
constexpr double kNinety = 1.6448536269514722;
constexpr std::size_t kMostRegimes = 5, kMostNext = 3;

constexpr std::array<std::string_view, 7> kVerdicts{"no_gap",     "not_detected", "parameters",  "effects",
                                                    "effect_set", "unknown",      "insufficient"};

Interval estimate(double value, double error) {
  return {value, value - kNinety * error, value + kNinety * error};
}

double standard_error(const FittedExplanation& fit, std::size_t p) {
  const auto i = static_cast<Eigen::Index>(p);
  return fit.hypothesis.parameters()[p].std * std::sqrt(fit.covariance(i, i));
}

// How much more probable the drives are when soils and motors may differ from the nominal ones, closures
// being free in either case.
double gain_of_parameters(const PreparedCampaign& prepared, const DriveCampaign& campaign,
                          std::size_t threads) {
  const FittedExplanation& null = *prepared.null;
  const Hypothesis pinned(campaign, {}, FreeNuisances::kClosures);
  std::vector<double> start;
  for (const Parameter& closure : pinned.parameters())
    for (std::size_t p = 0; p < null.x.size(); ++p)
      if (null.hypothesis.parameters()[p].name == closure.name) start.push_back(null.x[p]);
  ExplanationOptions options;
  options.threads = threads;
  const FittedExplanation nominal = fit_explanation(pinned, *prepared.model, *prepared.noise, start, options);
  const auto evidence = [&](const FittedExplanation& fit) {
    return fit.log_evidence + wildcard_gain(fit, *prepared.noise, prepared.wildcard,
                                            Eigen::MatrixXd(fit.white_jacobian.rows(), 0))
                                  .imprecision;
  };
  return evidence(null) - evidence(nominal);
}

// The most probable candidate, or, where none is certain, one with fewer effects of the same that is not much
// less probable: what adds little is not worth a name.
std::size_t simplest_of_the_best(const std::vector<Candidate>& candidates) {
  std::size_t best = 0;
  if (candidates.front().probability >= kCertain) return best;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const Candidate &held = candidates[best], &other = candidates[i];
    const auto in_held = [&](const std::string& effect) {
      return std::find(held.effects.begin(), held.effects.end(), effect) != held.effects.end();
    };
    if (!other.effects.empty() && other.effects.size() < held.effects.size() &&
        other.with_unknown == held.with_unknown &&
        std::all_of(other.effects.begin(), other.effects.end(), in_held) &&
        other.probability > kMuchLess * candidates.front().probability)
      best = i;
  }
  return best;
}

std::vector<std::string> names_in(const Candidate& c) {
  std::vector<std::string> names = c.effects;
  if (c.with_unknown) names.emplace_back("unknown");
  return names;
}

class Diagnoser {
 public:
  Diagnoser(const DriveCampaign& campaign, const DiagnosisOptions& options, Progress& progress)
      : campaign_(campaign), options_(options), progress_(progress) {}

  Result<Diagnosis> run() {
    d_.campaign = campaign_.name;
    d_.campaign_fingerprint = campaign_.fingerprint;
    d_.seed = options_.seed;
    d_.drives = campaign_.drives.size();
    d_.notes = campaign_.notes;
    for (const sim::Effect& effect : sim::effect_catalogue())
      if (!is_withheld(effect.name)) d_.library.emplace_back(effect.name);
    auto prepared = prepare(campaign_, options_.windows, options_.search.threads, progress_);
    if (!prepared) return fail(prepared.error());
    prepared_ = std::move(*prepared);
    d_.windows = prepared_.used_windows();
    d_.observations = prepared_.noise->used_count();
    d_.noise = prepared_.noise->scales();
    if (d_.windows < prepared_.windows.size())
      d_.notes.push_back(fmt::format("{} of {} windows lie where the terrain has no ground and are left out",
                                     prepared_.windows.size() - d_.windows, prepared_.windows.size()));
    if (prepared_.model->footing() == Footing::kPlane && std::isnan(prepared_.model->attitude_misfit_rad()))
      d_.notes.emplace_back(
          "no attitude was recorded: the rover, whose frame is rigid, is predicted on the plane under its "
          "wheels");
    else if (prepared_.model->footing() == Footing::kPlane)
      d_.notes.push_back(fmt::format(
          "the attitudes recorded are those of the plane under the wheels (within {:.2f} deg), not of the "
          "suspension on the map: the rover is predicted on that plane",
          deg_from_rad(prepared_.model->attitude_misfit_rad())));
    if (std::none_of(campaign_.drives.begin(), campaign_.drives.end(),
                     [](const auto& drive) { return drive.repeat_of.has_value(); }))
      d_.notes.push_back(
          "no drive is said to be a repeat: the drives' own scatter is estimated from drives of different "
          "kinds");
    d_.channels = channel_gaps(prepared_, campaign_, prepared_.nominal_residuals, options_);
    if (d_.drives < kLeastDrives || d_.windows < kLeastWindows) {
      d_.verdict = Verdict::kInsufficient;
      d_.reason = fmt::format("{} drives with {} windows of use are too few to tell causes apart", d_.drives,
                              d_.windows);
      d_.overturned_by = fmt::format("{} drives and {} windows at least", kLeastDrives, kLeastWindows);
      return std::move(d_);
    }
    if (auto searched = search(options_.search); !searched) return fail(searched.error());
    if (!best().effects.empty()) {
      // With what was found in it, the model takes less of the gap for scatter. What was far behind need not
      // be fitted again.
      prepare_around(prepared_, campaign_, best_fit(), options_.search.threads);
      d_.noise = prepared_.noise->scales();
      SearchOptions again = options_.search;
      again.most_refitted = std::min(again.most_refitted, kMostRefittedAgain);
      again.most_paired = std::min(again.most_paired, kMostPairedAgain);
      again.most_seconds = std::min(again.most_seconds, kMostSecondsAgain);
      const std::vector<FittedExplanation> kept = most_probable_fits(search_, kMostKept);
      if (auto searched = search(again, kept); !searched) return fail(searched.error());
    }
    judge();
    describe_parameters();
    compare_look_alikes();
    localise();
    auto shrunk = shrink();
    if (!shrunk) return fail(shrunk.error());
    propose_drives();
    if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress_.report("done", 1.0);
    return std::move(d_);
  }

 private:
  Result<void> search(const SearchOptions& options, std::span<const FittedExplanation> found_before = {}) {
    auto found = search_explanations(campaign_, *prepared_.model, *prepared_.noise, *prepared_.null,
                                     prepared_.wildcard, options, progress_, found_before);
    if (!found) return fail(found.error());
    search_ = std::move(*found);
    best_ = simplest_of_the_best(search_.candidates);
    return {};
  }

  bool is_withheld(std::string_view effect) const {
    const auto& withheld = options_.search.withheld;
    return std::find(withheld.begin(), withheld.end(), effect) != withheld.end();
  }

  const Candidate& best() const { return search_.candidates[best_]; }
  const FittedExplanation& best_fit() const { return search_.fits[best().fit]; }
  // What the verdict says: a fit whose effects are all named, or the re-tuned one.
  const FittedExplanation& told_fit() const {
    return d_.effects.size() == best().effects.size() ? best_fit() : search_.fits[0];
  }
  bool explains() const { return d_.verdict == Verdict::kEffects || d_.verdict == Verdict::kEffectSet; }

  void judge() {
    std::map<std::set<std::string>, double> sets;
    std::map<std::string, double> single;
    double unknown = 0.0;
    for (const Candidate& c : search_.candidates) {
      const std::vector<std::string> names = names_in(c);
      sets[{names.begin(), names.end()}] += c.probability;
      for (const std::string& name : c.effects) single[name] += c.probability;
      if (c.with_unknown) unknown += c.probability;
      d_.candidates.push_back({names, c.probability, std::nullopt,
                               static_cast<int>(search_.fits[c.fit].x.size() - search_.fits[0].x.size())});
    }
    const std::vector<std::string> named = names_in(best());
    const double probability = sets[{named.begin(), named.end()}];
    if (unknown > 0.5 || best().with_unknown) {
      d_.verdict = Verdict::kUnknown;
      d_.reason =
          fmt::format("a gap remains that no effect of the library explains (probability {:.2f})", unknown);
      d_.overturned_by =
          "an effect of the library with another equation than the library's would look the same";
    } else if (best().effects.empty()) {
      judge_without_effects(probability);
    } else {
      d_.verdict = probability >= kCertain ? Verdict::kEffects : Verdict::kEffectSet;
      d_.reason =
          fmt::format("{} explain{} what re-tuned parameters leave over (probability {:.2f})",
                      fmt::join(best().effects, " and "), best().effects.size() == 1 ? "s" : "", probability);
      const auto rival = std::find_if(search_.candidates.begin(), search_.candidates.end(),
                                      [&](const Candidate& c) { return names_in(c) != named; });
      if (rival != search_.candidates.end()) {
        const std::vector<std::string> rivals = names_in(*rival);
        d_.overturned_by =
            fmt::format("next best: {} (probability {:.2g})",
                        rivals.empty() ? "nothing missing" : fmt::format("{}", fmt::join(rivals, " and ")),
                        rival->probability);
      }
    }
    if (d_.verdict == Verdict::kUnknown && !best().effects.empty())
      d_.notes.push_back(
          fmt::format("{} would fit beside what is unexplained, and may be its shadow: nothing is named",
                      fmt::join(best().effects, " and ")));
    if (!explains()) return;
    for (std::size_t e = 0; e < best().effects.size(); ++e) {
      FoundEffect found{
          best().effects[e], best_fit().hypothesis.effects()[e].label, single[best().effects[e]], {}};
      const auto parameters = best_fit().hypothesis.parameters();
      for (std::size_t p = best_fit().hypothesis.nuisance_count(); p < parameters.size(); ++p)
        if (parameters[p].effect == found.name)
          found.parameters.push_back({parameters[p].name.substr(found.name.size() + 1),
                                      estimate(best_fit().x[p], standard_error(best_fit(), p))});
      for (const auto& [field, value] : best_fit().hypothesis.effects()[e].fixed)
        found.parameters.push_back({field, {value, value, value}});
      d_.effects.push_back(std::move(found));
    }
  }

  void judge_without_effects(double probability) {
    for (const ScreenedVariant& s : search_.screened) {
      if (s.visibility <= 0.0) continue;
      if (std::any_of(d_.least_detectable.begin(), d_.least_detectable.end(),
                      [&](const LeastDetectable& l) { return l.effect == s.variant.effect; }))
        continue;
      const EffectVariant::Free& free = s.variant.free.front();
      d_.least_detectable.push_back({s.variant.effect, free.field, kSurelySeen * free.std / s.visibility});
    }
    const double gain = gain_of_parameters(prepared_, campaign_, options_.search.threads);
    if (gain > kParametersGain) {
      d_.verdict = Verdict::kParameters;
      d_.reason = fmt::format(
          "re-tuned soil and motor parameters explain the drives (log evidence +{:.0f}); no effect is "
          "missing (probability {:.2f})",
          gain, probability);
      d_.overturned_by = "an effect that acts like these parameters in every drive that was made";
      return;
    }
    // Of effects at their usual size, how many could have hidden?
    int hidden = 0, all = 0;
    for (const ScreenedVariant& s : search_.screened) {
      ++all;
      if (s.visibility * kSmall < kSurelySeen) ++hidden;
    }
    const bool seen = 2 * hidden < all;
    d_.verdict = seen ? Verdict::kNoGap : Verdict::kNotDetected;
    d_.reason =
        seen ? fmt::format("prediction and drives agree within the drives' own scatter (probability {:.2f})",
                           probability)
             : "no gap was found, but these drives could not have shown effects of half their usual size";
    d_.overturned_by = "drives that show an effect below the least size that these could have shown";
  }

  void describe_parameters() {
    const FittedExplanation& fit = explains() ? best_fit() : search_.fits[0];
    for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p) {
      const Parameter& parameter = fit.hypothesis.parameters()[p];
      const double error = standard_error(fit, p);
      d_.retuned.push_back(
          {parameter.name, estimate(fit.x[p], error), parameter.std, error < 0.7 * parameter.std});
    }
  }

  void compare_look_alikes() {
    std::vector<const ScreenedVariant*> first;
    for (const ScreenedVariant& s : search_.screened)
      if (s.signature.size() > 0 && s.signature.norm() > 1.0 &&
          std::none_of(first.begin(), first.end(),
                       [&](const auto* f) { return f->variant.effect == s.variant.effect; }))
        first.push_back(&s);
    for (std::size_t a = 0; a < first.size(); ++a)
      for (std::size_t b = a + 1; b < first.size(); ++b) {
        const double cosine = std::abs(first[a]->signature.dot(first[b]->signature)) /
                              (first[a]->signature.norm() * first[b]->signature.norm());
        const double angle = std::acos(std::min(1.0, cosine)) * 180.0 / std::numbers::pi;
        if (angle < kAlike_deg)
          d_.confusable.push_back({first[a]->variant.effect, first[b]->variant.effect, angle});
      }
    std::stable_sort(
        d_.confusable.begin(), d_.confusable.end(),
        [](const ConfusablePair& a, const ConfusablePair& b) { return a.angle_deg < b.angle_deg; });
  }

  void localise() {
    progress_.report("locating the gap", 0.75);
    d_.regimes = regimes_of(prepared_, campaign_, prepared_.nominal_residuals, options_, kMostRegimes);
    d_.regimes_retuned = regimes_of(prepared_, campaign_, search_.fits[0].residuals, options_, kMostRegimes);
    if (d_.verdict == Verdict::kUnknown) {
      d_.residual = describe_unexplained(prepared_, told_fit());
      d_.places = gap_places(prepared_, campaign_, search_.fits[0].residuals, options_);
    }
    if (!explains()) return;
    // What the effects do, all else as fitted: only this picture locates the cause.
    const Eigen::VectorXd signature = effect_trace(best_fit(), *prepared_.model, {}, options_.search.threads);
    d_.regimes_of_effect = regimes_of(prepared_, campaign_, signature, options_, kMostRegimes);
    for (std::size_t e = 0; e < best().effects.size(); ++e) {
      if (best().effects[e] != "soft_patch") continue;
      const EffectVariant& patch = best_fit().hypothesis.effects()[e];
      // It lies on the terrain of the windows that meet it.
      std::string terrain = campaign_.terrains.front().name;
      for (const DriveWindow& w : prepared_.windows)
        for (const Pose2& pose : w.stations)
          if (std::hypot(pose.x_m - patch.fixed[0].second, pose.y_m - patch.fixed[1].second) <
              patch.fixed[2].second)
            terrain = campaign_.terrains[campaign_.drives[w.drive].terrain].name;
      d_.places.push_back({terrain, patch.fixed[0].second, patch.fixed[1].second, patch.fixed[2].second,
                           Channel::kSlip, 1.0});
    }
  }

  Result<void> shrink() {
    auto shrunk = shrink_on_held_out(
        prepared_, campaign_, refitted(prepared_, told_fit(), options_.search.threads), options_, progress_);
    if (!shrunk) return fail(shrunk.error());
    d_.gap = std::move(shrunk->channels);
    d_.held_out = std::move(shrunk->points);
    d_.window_gaps = std::move(shrunk->windows);
    if (explains()) d_.closed_fraction = shrunk->closed_fraction;
    for (ChannelShrink& channel : d_.gap)
      if (!explains()) channel.closed_fraction.reset();
    d_.candidates[best_].held_out_score = shrunk->log_density_gain;
    const bool offered = explains() ? shrunk->log_density_gain > 0.0
                                    : d_.verdict == Verdict::kParameters || unknown_but_nearer();
    if (offered) {
      const FittedExplanation& told = explains() ? best_fit() : search_.fits[0];
      d_.model = told.hypothesis.state(told.x);
      d_.model_effects = told.hypothesis.settings(told.x);
    } else if (explains()) {
      d_.notes.push_back(
          "the correction did not improve drives held out of the fit: no corrected model is offered");
    }
    return {};
  }

  // A model beside which something unknown is at work is still the better one to plan with, where no channel
  // of drives held out is told worse by it than by the nominal one and one is told much better.
  bool unknown_but_nearer() {
    constexpr double kNoWorse = 1.02, kMuchBetter = 0.8;
    if (d_.verdict != Verdict::kUnknown) return false;
    bool better = false;
    for (const ChannelShrink& c : d_.gap) {
      if (c.retuned.value > kNoWorse * c.nominal.value) return false;
      better = better || c.retuned.value < kMuchBetter * c.nominal.value;
    }
    if (better)
      d_.notes.emplace_back(
          "the corrected model is the re-tuned one, without the effects named, and leaves something "
          "unexplained; it is offered because it told drives held out of the fit better than the nominal "
          "one");
    return better;
  }

  void propose_drives() {
    std::vector<const FittedExplanation*> fits;
    std::vector<double> probabilities;
    for (const Candidate& c : search_.candidates) {
      if (c.with_unknown || fits.size() >= 4) continue;
      fits.push_back(&search_.fits[c.fit]);
      probabilities.push_back(std::max(c.probability, kWorthNaming));
    }
    d_.next_drives =
        next_drives(campaign_, prepared_.noise->scales(), fits, probabilities, kMostNext, progress_);
  }

  const DriveCampaign& campaign_;
  const DiagnosisOptions& options_;
  Progress& progress_;
  PreparedCampaign prepared_;
  ExplanationSearch search_;
  std::size_t best_ = 0;  // of its candidates
  Diagnosis d_;
};

}  // namespace

std::string_view name_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

Result<Diagnosis> diagnose(const DriveCampaign& campaign, const DiagnosisOptions& options,
                           Progress& progress) {
  std::vector<Fault> faults;
  for (const std::string& name : options.search.withheld)
    if (sim::find_effect(name) == nullptr) {
      std::vector<std::string_view> known;
      for (const sim::Effect& effect : sim::effect_catalogue()) known.push_back(effect.name);
      faults.push_back(
          {"/without", fmt::format("unknown effect \"{}\", known are: {}", name, fmt::join(known, ", "))});
    }
  if (!faults.empty())
    return fail(ErrorCode::kInvalidRequest, "an effect to withhold is not in the catalogue", faults);
  return Diagnoser(campaign, options, progress).run();
}

}  // namespace slipway::gap
