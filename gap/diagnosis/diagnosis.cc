#include "gap/diagnosis/diagnosis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.h"
#include "core/part_of_progress.h"
#include "gap/diagnosis/decide/decision.h"
#include "gap/diagnosis/describe/decision_words.h"
#include "gap/diagnosis/describe/ends_of_ranges.h"
#include "gap/diagnosis/describe/found_causes.h"
#include "gap/diagnosis/describe/localise.h"
#include "gap/diagnosis/describe/look_alikes.h"
#include "gap/diagnosis/describe/measurement_proposals.h"
#include "gap/diagnosis/describe/next_drives.h"
#include "gap/diagnosis/describe/offered_model.h"
#include "gap/diagnosis/describe/reference_summary.h"
#include "gap/diagnosis/describe/unexplained.h"
#include "gap/diagnosis/follow/followed_drives.h"
#include "gap/diagnosis/follow/since_reference.h"
#include "gap/diagnosis/held_out/effect_marginals.h"
#include "gap/diagnosis/held_out/extrapolation.h"
#include "gap/diagnosis/held_out/gap_closure.h"
#include "gap/diagnosis/held_out/ladder_rung.h"
#include "gap/diagnosis/held_out/search_record_of.h"
#include "gap/diagnosis/model/outside_cause.h"
#include "gap/diagnosis/model/reading_plausibility.h"
#include "gap/diagnosis/model/reference_belief.h"
#include "gap/diagnosis/search/effect_trace.h"
#include "gap/diagnosis/search/prepared_campaign.h"
#include "gap/diagnosis/search/selection.h"
#include "gap/diagnosis/search/soft_patch_search.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::gap {
namespace {

DiagnosisOptions with_evidence_share(DiagnosisOptions options, double share) {
  options.evidence.share = share;
  return options;
}

// Fractions of a diagnosis that are done by then.
constexpr double kPrepared = 0.18, kSearched = 0.58, kSearchedAgain = 0.79, kFollowed = 0.82;

class Diagnoser {
 public:
  Diagnoser(const DriveCampaign& campaign, const DiagnosisOptions& options, Progress& progress)
      : campaign_(campaign),
        options_(with_evidence_share(options, evidence_share(options, campaign.reference != nullptr))),
        progress_(progress) {
    d_.options = listed_options(options);
  }

  Result<Diagnosis> run() {
    say_what_was_asked();
    auto prepared = prepare(campaign_, options_, progress_);
    if (!prepared) return fail(prepared.error());
    prepared_ = std::move(*prepared);
    describe_preparation();
    d_.channels = channel_gaps(prepared_, campaign_, prepared_.nominal_residuals, options_);
    if (too_few()) return std::move(d_);
    if (auto searched = search(options_, kPrepared, kSearched); !searched) return fail(searched.error());
    if (auto searched = search_again(); !searched) return fail(searched.error());
    const DriveResampling drives = resample_drives(campaign_, options_.resamples, options_.seed);
    weigh_causes(drives);
    decide_from_search();
    if (auto asked = follow_before_saying_nothing(); !asked) return fail(asked.error());
    compare_look_alikes();
    if (auto closed = close_gap(drives); !closed) return fail(closed.error());
    describe_parameters();
    localise();
    propose_drives();
    if (progress_.cancelled()) return fail(ErrorCode::kCancelled, "the diagnosis was cancelled");
    progress_.report("done", 1.0);
    return std::move(d_);
  }

 private:
  void say_what_was_asked() {
    d_.campaign = campaign_.name;
    d_.campaign_fingerprint = campaign_.fingerprint;
    d_.seed = options_.seed;
    d_.drives = campaign_.drives.size();
    d_.nominal_rover = campaign_.rover;
    d_.nominal_soils = campaign_.soils;
    d_.notes = campaign_.notes;
    for (const sim::Effect& effect : sim::effect_catalogue())
      if (!is_withheld(effect.name)) d_.library.emplace_back(effect.name);
    if (!options_.search.withheld.empty())
      d_.notes.push_back(fmt::format("withheld from the library, as was asked: {}",
                                     fmt::join(options_.search.withheld, ", ")));
  }

  void describe_preparation() {
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
    if (campaign_.reference) d_.reference = reference_summary(prepared_, campaign_);
    if (!campaign_.reference && std::none_of(campaign_.drives.begin(), campaign_.drives.end(),
                                             [](const auto& drive) { return drive.repeat_of.has_value(); }))
      d_.notes.push_back(
          "no drive is said to be a repeat: the drives' own scatter is estimated from drives of different "
          "kinds");
  }

  // Of these drives, and of the reference's.
  std::vector<std::string> implausible_readings() const {
    std::vector<std::string> notes = notes_of_implausible_readings(campaign_);
    if (campaign_.reference) {
      const std::vector<std::string>& before = campaign_.reference->implausible;
      notes.insert(notes.end(), before.begin(), before.end());
    }
    return notes;
  }

  // Whether drives of use are in more than one fold.
  bool can_be_held_out() const {
    const std::vector<std::size_t> groups = repeat_groups(campaign_);
    std::optional<std::size_t> first;
    for (std::size_t w = 0; w < prepared_.windows.size(); ++w) {
      if (!prepared_.model->used(w)) continue;
      const std::size_t fold = groups[prepared_.windows[w].drive] % static_cast<std::size_t>(options_.folds);
      if (fold != first.value_or(fold)) return true;
      first = fold;
    }
    return false;
  }

  // Whether nothing can be said; the verdict says so.
  bool too_few() {
    const bool since = campaign_.reference != nullptr;
    const int min_drives = since ? options_.reference.min_drives : options_.decision.min_drives;
    const int min_windows = since ? options_.reference.min_windows : options_.decision.min_windows;
    const bool enough = d_.drives >= static_cast<std::size_t>(min_drives) &&
                        d_.windows >= static_cast<std::size_t>(min_windows);
    if (enough && can_be_held_out()) return false;
    d_.verdict = Verdict::kInsufficient;
    if (enough) {
      d_.reason =
          "there is one drive of use, or repeats of one: none can be held out of a fit, so that no name can "
          "be checked";
      d_.overturned_by = "another drive, that is no repeat";
      return true;
    }
    d_.reason = fmt::format(
        "{} drives with {} windows of use (positions and attitudes in two rows at least) are too few to "
        "tell causes apart",
        d_.drives, d_.windows);
    d_.overturned_by = fmt::format("{} drives and {} windows at least", min_drives, min_windows);
    return true;
  }

  // From one fraction of the diagnosis to another.
  Result<void> search(const DiagnosisOptions& options, double begun, double ended,
                      std::span<const FittedExplanation> found_before = {}) {
    PartOfProgress progress(progress_, begun, ended);
    const auto look = options_.given ? fit_given_explanation : search_explanations;
    auto found = look(campaign_, *prepared_.model, *prepared_.noise, *prepared_.null, prepared_.discrepancy,
                      options, progress, found_before);
    if (!found) return fail(found.error());
    search_ = std::move(*found);
    best_ = 0;
    return {};
  }

  // With what was found in it, the model takes less of the gap for scatter. What was far behind need not be
  // fitted again.
  Result<void> search_again() {
    if (best().effects.empty()) return {};
    prepared_.noise->set(best().scatter, options_.search.threads);
    prepare_around(prepared_, campaign_, best_fit(), options_);
    d_.noise = prepared_.noise->scales();
    const SecondSearchOptions& second = options_.second_search;
    DiagnosisOptions again = options_;
    again.search.max_refitted = std::min(again.search.max_refitted, second.max_refitted);
    again.search.max_paired = std::min(again.search.max_paired, second.max_paired);
    again.search.max_seconds = std::min(again.search.max_seconds, second.max_seconds);
    return search(again, kSearched, kSearchedAgain,
                  most_probable_fits(search_, static_cast<std::size_t>(second.max_kept)));
  }

  void weigh_causes(const DriveResampling& drives) {
    progress_.report("weighing single effects", kSearchedAgain);
    const LinearHeldOut held_out(prepared_, drives.groups, options_.folds, options_.fit);
    const ClosedShares shares(std::cref(held_out), search_);
    d_.search = record_of(search_, shares, d_.library);
    d_.search.with_reference = campaign_.reference != nullptr;
    d_.search.drives = d_.drives;
    d_.search.windows = d_.windows;
    const Eigen::VectorXd scatter = prepared_.noise->deviations_above_belief();
    d_.search.scatter_deviations.assign(scatter.begin(), scatter.end());
    d_.search.parameters_gain = gain_of_parameters(prepared_, campaign_, options_);
    d_.search.hidden_share = hidden_share(search_.screened, options_.description);
  }

  void decide_from_search() {
    const Decision decision = decide(d_.search, options_.evidence.share, options_.decision);
    best_ = decision.answer;
    beside_ = decision.beside;
    d_.verdict = decision.verdict;
    d_.partial = decision.partial;
    d_.model_adequate = decision.adequate;
    d_.conflict_probability = decision.adequacy.conflict_p;
    d_.held_out_probability = decision.adequacy.held_out_p;
    d_.marginals = effect_marginals(d_.search);
    for (EffectMarginal& m : d_.marginals) m.calibrated = decision.calibrated.at(m.name);
    d_.candidates = compared_sets();
    if (d_.partial || d_.verdict == Verdict::kUnknown)
      d_.outside = outside_finding(search_.fits[beside().fit], campaign_);
    if (d_.outside) {
      d_.outside->probability = decision.marginals.of_cause.at(d_.outside->cause);
      d_.outside->closed_share = d_.search.share_of(d_.outside->cause);
    }
    d_.effects = found_effects(best_fit(), decision.names, d_.marginals);
    d_.least_detectable = finds_nothing_missing(d_.verdict)
                              ? least_detectable_of(search_.screened, options_.description)
                              : std::vector<LeastDetectable>{};
    auto words = words_of(decision, d_.search, d_.marginals, d_.outside);
    d_.reason = std::move(words.reason);
    d_.overturned_by = std::move(words.overturned_by);
  }

  // That nothing is missing is said only where the drives, one after the other, don't say that they changed:
  // of the reference where there is one, else of the first of them.
  Result<void> follow_before_saying_nothing() {
    const bool has_first = campaign_.drives.size() > kDrivesLearntFrom;
    if (!finds_nothing_missing(d_.verdict) || (!campaign_.reference && !has_first)) return {};
    PartOfProgress progress(progress_, kSearchedAgain, kFollowed);
    auto followed = campaign_.reference
                        ? follow_drives(campaign_, {}, options_, progress)
                        : follow_since_first(campaign_, kDrivesLearntFrom, {}, options_, progress);
    if (!followed) return fail(followed.error());
    d_.search.drives_changed = followed->alarm.has_value();
    if (!d_.search.drives_changed) return {};
    decide_from_search();
    d_.reason = changed_words(*followed, campaign_.reference.get());
    return {};
  }

  std::vector<ComparedSet> compared_sets() const {
    std::vector<ComparedSet> sets;
    for (const Candidate& c : search_.candidates) {
      ComparedSet& set = sets.emplace_back();
      set.effects = library_effects_of(c);
      set.with_unknown = c.unknown();
      if (c.outside) set.outside = outside_causes_of(c).front();
      set.probability = c.probability;
      set.log_evidence = evidence_over_nothing(c, search_.candidates);
      set.log_prior = c.log_prior;
      set.complexity = static_cast<int>(search_.fits[c.fit].x.size() - search_.fits[0].x.size());
    }
    return sets;
  }

  bool is_withheld(std::string_view effect) const {
    const auto& withheld = options_.search.withheld;
    return std::find(withheld.begin(), withheld.end(), effect) != withheld.end();
  }

  const Candidate& best() const { return search_.candidates[best_]; }
  const Candidate& beside() const { return search_.candidates[beside_]; }
  const FittedExplanation& best_fit() const { return search_.fits[best().fit]; }
  // What the verdict says: a fit whose effects are all named, or the re-tuned one.
  const FittedExplanation& reported_fit() const { return explains() ? best_fit() : search_.fits[0]; }
  // Beside which something is left: with a cause from outside where one was found.
  const FittedExplanation& fit_beside_rest() const {
    return d_.outside ? search_.fits[beside().fit] : reported_fit();
  }
  bool explains() const { return names_effects(d_.verdict); }

  void describe_parameters() {
    const FittedExplanation& fit = reported_fit();
    for (std::size_t p = 0; p < fit.hypothesis.nuisance_count(); ++p) {
      const Parameter& parameter = fit.hypothesis.parameters()[p];
      const Interval value = parameter_interval(fit, p);
      const auto i = static_cast<Eigen::Index>(p);
      const double error = parameter.std * std::sqrt(fit.covariance(i, i));
      d_.retuned.push_back({parameter.name, value, parameter.std,
                            error < options_.description.determined_share * parameter.std,
                            parameter.neutral});
    }
  }

  void compare_look_alikes() {
    d_.confusable = confusable_pairs(search_, options_.description);
    d_.look_alikes = look_alikes(search_, options_.description);
    if (campaign_.reference) return;  // which told of the parameters already
    d_.measurements = measurement_proposals(
        search_,
        [&](const Eigen::VectorXd& change) -> Eigen::VectorXd {
          return search_.fits[0].row_weights.asDiagonal() * prepared_.noise->whiten(change);
        },
        options_.description);
  }

  void localise() {
    progress_.report("locating the gap", 0.97);
    d_.regimes = regimes_of(prepared_, campaign_, prepared_.nominal_residuals, LookedAt::kGap, options_);
    d_.regimes_retuned =
        regimes_of(prepared_, campaign_, search_.fits[0].residuals, LookedAt::kGap, options_);
    if (d_.verdict == Verdict::kUnknown || d_.partial) {
      d_.residual = describe_unexplained(prepared_, fit_beside_rest(), d_.outside, options_);
      d_.places = gap_places(prepared_, campaign_, search_.fits[0].residuals, options_);
    }
    if (!explains()) return;
    // What the effects do, all else as fitted: only this picture locates the cause.
    const Eigen::VectorXd signature = effect_trace(best_fit(), *prepared_.model, {}, options_.search.threads);
    d_.channels_of_effects = channel_shares(prepared_, signature, options_);
    d_.regimes_of_effect = regimes_of(prepared_, campaign_, signature, LookedAt::kTrace, options_);
    for (std::size_t e = 0; e < best().effects.size(); ++e) {
      const std::optional<sim::Disc> place = place_of(best_fit().hypothesis.effects()[e]);
      if (!place) continue;
      // It lies on the terrain of the windows that meet it.
      std::string terrain = campaign_.terrains.front().name;
      for (const DriveWindow& w : prepared_.windows)
        for (const Pose2& pose : w.stations)
          if (std::hypot(pose.x_m - place->x_m, pose.y_m - place->y_m) < place->radius_m)
            terrain = campaign_.terrains[campaign_.drives[w.drive].terrain].name;
      d_.places.push_back({terrain, place->x_m, place->y_m, place->radius_m, Channel::kSlip, 1.0});
    }
  }

  // What drives held out of the fit are told with the correction and without.
  Result<void> close_gap(const DriveResampling& drives) {
    const std::vector<double> chosen = resample_selection(search_, prepared_, campaign_, options_, drives);
    for (std::size_t c = 0; c < chosen.size(); ++c) d_.candidates[c].chosen_share = chosen[c];
    const Correction correction = explains() ? refitted(prepared_, best_fit(), options_) : uncorrected();
    auto closure = close_gap_on_held_out(prepared_, campaign_, correction, drives, options_, progress_);
    if (!closure) return fail(closure.error());
    d_.gap = closure->channels;
    d_.planners_view = closure->planners_view;
    d_.held_out = closure->points;
    d_.window_gaps = closure->windows;
    d_.candidates[best_].held_out_score = closure->log_density_gain;
    if (explains()) {
      auto extrapolated = extrapolate(prepared_, campaign_, correction, drives, options_, progress_);
      if (!extrapolated) return fail(extrapolated.error());
      d_.extrapolations = std::move(*extrapolated);
      d_.closed_fraction = closure->closed_fraction;
      for (std::string& note : notes_of_ends_of_ranges(reported_fit())) d_.notes.push_back(std::move(note));
    }
    for (ChannelClosure& channel : d_.gap)
      if (!explains()) channel.closed_fraction.reset();
    if (const std::vector<std::string> implausible = implausible_readings(); implausible.empty())
      offer_model(reported_fit(), closure->log_density_gain, options_.held_out, d_);
    else
      doubt_readings(implausible.front());
    add_discrepancy_rung(prepared_, LinearHeldOut(prepared_, drives.groups, options_.folds, options_.fit),
                         fit_beside_rest(), drives, options_.discrepancy, d_.gap);
    return {};
  }

  // That nothing is missing can't be said of implausible readings: currents in mA agree with any model once
  // they are taken to scatter by as much.
  void doubt_readings(const std::string& implausible) {
    if (!finds_nothing_missing(d_.verdict)) return;
    d_.least_detectable.clear();
    d_.verdict = Verdict::kUnknown;
    d_.reason = implausible;
    d_.overturned_by = "readings in the units that the campaign states";
  }

  void propose_drives() {
    std::vector<const FittedExplanation*> fits;
    std::vector<double> probabilities;
    for (const Candidate& c : search_.candidates) {
      if (c.with_unknown || reads_wrongly(c) ||
          fits.size() >= static_cast<std::size_t>(options_.next_drives.max_explanations))
        continue;
      fits.push_back(&search_.fits[c.fit]);
      probabilities.push_back(c.probability);
    }
    d_.next_drives = next_drives(campaign_, prepared_.noise->scales(), fits, probabilities,
                                 options_.next_drives, progress_);
  }

  // Whether a cause from outside is a sensor's: what that does to one drive alone nobody can say.
  static bool reads_wrongly(const Candidate& c) {
    return std::any_of(c.effects.begin(), c.effects.end(), [](const std::string& name) {
      const OutsideCause* const cause = find_outside(name);
      return cause != nullptr && cause->show != nullptr;
    });
  }

  const DriveCampaign& campaign_;
  const DiagnosisOptions options_;
  Progress& progress_;
  PreparedCampaign prepared_;
  ExplanationSearch search_;
  std::size_t best_ = 0;    // of its candidates: what is reported
  std::size_t beside_ = 0;  // the same with something unknown
  Diagnosis d_;
};

}  // namespace

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

Result<Diagnosis> diagnose_since(const DriveCampaign& reference, const DriveCampaign& campaign,
                                 const DiagnosisOptions& options, Progress& progress) {
  const auto since = since_reference(reference, campaign, options, progress);
  if (!since) return fail(since.error());
  return diagnose(*since, options, progress);
}

}  // namespace slipway::gap
