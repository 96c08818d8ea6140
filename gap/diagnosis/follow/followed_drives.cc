#include "gap/diagnosis/follow/followed_drives.h"

#include <map>
#include <numbers>
#include <span>

#include "core/parallel_for.h"
#include "gap/diagnosis/follow/since_reference.h"
#include "gap/diagnosis/model/drive_resampling.h"
#include "gap/diagnosis/search/explanation_search.h"

namespace slipway::gap {
namespace {

constexpr std::string_view kUnknown = "unknown";
// Of the prior of a change: that it is one which the library has no name for.
constexpr double kUnknownPrior = 0.5;

// Columns of every kind of change, whitened, with the kinds' names.
struct Changes {
  Eigen::MatrixXd columns;
  std::vector<ChangeKind> kinds;
  std::vector<std::string> names;

  void add(const std::string& name, double prior, const Eigen::MatrixXd& of_kind) {
    if (of_kind.cols() == 0 || of_kind.squaredNorm() == 0.0) return;
    kinds.push_back({columns.cols(), of_kind.cols(), prior});
    names.push_back(name);
    columns.conservativeResize(of_kind.rows(), columns.cols() + of_kind.cols());
    columns.rightCols(of_kind.cols()) = of_kind;
  }
  void normalise() {
    double sum = 0.0;
    for (const ChangeKind& kind : kinds) sum += kind.prior;
    for (ChangeKind& kind : kinds) kind.prior /= sum;
  }
};

// Of the effects that the library has, and of each entry point by itself: constant or growing with the slope.
Changes changes_of(const DriveCampaign& campaign, const PreparedCampaign& prepared,
                   const FittedExplanation& fit, const DiagnosisOptions& options) {
  const std::vector<EffectVariant> variants = effect_variants(*campaign.rover, options.search.withheld);
  std::map<std::string, double> variants_of;
  for (const EffectVariant& v : variants) variants_of[v.effect] += 1.0;
  std::vector<Eigen::MatrixXd> columns(variants.size());
  parallel_for(variants.size(), options.search.threads, [&](std::size_t v) {
    if (prepared.model->cancelled()) return;
    std::vector<double> start;
    columns[v] =
        added_columns(Hypothesis(campaign, {variants[v]}), *prepared.model, *prepared.noise, fit, start);
  });
  Changes changes;
  changes.columns.resize(fit.white_linear.size(), 0);
  for (std::size_t v = 0; v < variants.size(); ++v)
    changes.add(
        variants[v].effect,
        (1.0 - kUnknownPrior) / (static_cast<double>(variants_of.size()) * variants_of[variants[v].effect]),
        columns[v]);
  const DiscrepancyTerm term =
      make_discrepancy_term(campaign, *prepared.model, fit, options.discrepancy, options.search.threads);
  const Eigen::MatrixXd white = whitened(fit, *prepared.noise, term).columns;
  std::map<std::pair<Entry, int>, std::vector<Eigen::Index>> entries;
  for (std::size_t c = 0; c < term.columns.size(); ++c) {
    const DiscrepancyTerm::Column& column = term.columns[c];
    if (column.circumstance == Circumstance::kConstant || column.circumstance == Circumstance::kPitch)
      entries[{column.entry, column.wheel}].push_back(static_cast<Eigen::Index>(c));
  }
  for (const auto& [entry, of] : entries)
    changes.add(std::string(kUnknown), kUnknownPrior / static_cast<double>(entries.size()),
                white(Eigen::all, of));
  changes.normalise();
  return changes;
}

// What each drive has of all rows: windows follow each other in the drives' order.
struct DriveRows {
  Eigen::Index first = 0, count = 0;
  std::size_t windows = 0;  // of use
};
std::vector<DriveRows> rows_of_drives(const PreparedCampaign& prepared, std::size_t drives) {
  std::vector<DriveRows> rows(drives);
  for (std::size_t w = 0; w < prepared.windows.size(); ++w) {
    DriveRows& of = rows[prepared.windows[w].drive];
    if (of.count == 0) of.first = static_cast<Eigen::Index>(prepared.model->offset(w));
    of.count += static_cast<Eigen::Index>(prepared.windows[w].observations.size());
    of.windows += prepared.model->used(w) ? 1 : 0;
  }
  return rows;
}

std::vector<ChangeShare> causes_of(const Changes& changes, const std::vector<double>& shares) {
  std::map<std::string, double> by_name;
  for (std::size_t k = 0; k < shares.size(); ++k) by_name[changes.names[k]] += shares[k];
  std::vector<ChangeShare> causes;
  for (const auto& [name, share] : by_name) causes.push_back({name, share});
  std::stable_sort(causes.begin(), causes.end(),
                   [](const ChangeShare& a, const ChangeShare& b) { return a.share > b.share; });
  return causes;
}

// A third of the evidence is no reason to prefer the one to the other.
std::size_t last_about_as_probable(const std::vector<double>& shares) {
  constexpr double kAboutAsProbable = 1.0 / 3.0;
  const double most = *std::max_element(shares.begin(), shares.end());
  std::size_t last = shares.size() - 1;
  while (shares[last] < kAboutAsProbable * most) --last;
  return last;
}

}  // namespace

Result<FollowedDrives> follow_drives(const DriveCampaign& campaign, const ChangeOptions& change,
                                     const DiagnosisOptions& options, Progress& progress) {
  const auto believed = prepare_as_believed(campaign, options, progress);
  if (!believed) return fail(believed.error());
  const PreparedCampaign& prepared = *believed;
  const Hypothesis hypothesis(campaign, {});
  FitOptions untouched = options.fit;
  untouched.max_iterations = 0;
  const FittedExplanation fit = fit_explanation(hypothesis, *prepared.model, *prepared.noise,
                                                hypothesis.neutral(), untouched, options.search.threads);
  progress.report("what a change would show", 0.5);
  const Changes changes = changes_of(campaign, prepared, fit, options);
  ChangeDetector detector(change, changes.kinds);
  FollowedDrives followed;
  followed.alpha = change.alpha;
  const auto rows = rows_of_drives(prepared, campaign.drives.size());
  const std::vector<std::size_t> groups = repeat_groups(campaign);
  for (std::size_t d = 0; d < campaign.drives.size() && !progress.cancelled(); ++d) {
    const auto [first, count, windows] = rows[d];
    const double log_evidence =
        detector.add(fit.white_linear.segment(first, count), fit.white_jacobian.middleRows(first, count),
                     changes.columns.middleRows(first, count), d > 0 && groups[d] == groups[d - 1]);
    if (!followed.alarm && detector.alarmed()) {
      followed.alarm = d;
      followed.since = detector.most_probable_start();
      followed.onset_shares = detector.start_shares();
      followed.onset = fewest_with(followed.onset_shares, kOnsetPart);
      followed.diagnosed_since = last_about_as_probable(followed.onset_shares);
      followed.causes = causes_of(changes, detector.kind_shares());
    }
    followed.drives.push_back(
        {campaign.drives[d].id, windows, log_evidence / std::numbers::ln10, followed.alarm.has_value()});
  }
  if (!followed.alarm) followed.causes = causes_of(changes, detector.kind_shares());
  if (progress.cancelled()) return fail(ErrorCode::kCancelled, "the watch was cancelled");
  return followed;
}

Result<FollowedDrives> follow_since_first(const DriveCampaign& campaign, std::size_t first,
                                          const ChangeOptions& change, const DiagnosisOptions& options,
                                          Progress& progress) {
  const DriveCampaign healthy = drives_between(campaign, 0, first);
  const auto since =
      since_reference(healthy, drives_between(campaign, first, campaign.drives.size()), options, progress);
  if (!since) return fail(since.error());
  return follow_drives(*since, change, options, progress);
}

}  // namespace slipway::gap
