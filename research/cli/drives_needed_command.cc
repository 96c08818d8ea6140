#include "research/cli/drives_needed_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>
#include <vector>

#include "api/files/campaign/drive_campaign_source.h"
#include "core/parallel_for.h"
#include "gap/diagnosis/diagnosis.h"
#include "research/benchmark/drive_acquisition.h"
#include "server/cli/inquiry/command_parts.h"

namespace slipway::server {
namespace {

using gap::AcquisitionPolicy;
using gap::AcquisitionStep;

std::string words(std::span<const AcquisitionStep> steps) {
  std::vector<std::string> parts;
  for (const AcquisitionStep& step : steps)
    parts.push_back(fmt::format("{}{}", step.drives, step.right ? "+" : "-"));
  return fmt::format("{}", fmt::join(parts, " "));
}

// A campaign with all runs; nothing where it was interrupted.
Result<std::optional<gap::DrivesNeededCase>> needed_of(const GapBenchmarkCommand& options,
                                                       const gap::DriveCampaign& campaign,
                                                       const gap::DiagnosisOptions& how,
                                                       const gap::DrivesJudge& judge) {
  Interruptible patience;
  const auto diagnose = [&](const gap::DriveCampaign& some) { return gap::diagnose(some, how, patience); };
  gap::AcquisitionOptions acquisition;
  acquisition.seed = options.seed;
  const auto first = diagnose(gap::subset_of(campaign, gap::first_drives(campaign, acquisition.first)));
  if (!first && first.error().code == ErrorCode::kCancelled) return std::nullopt;
  if (!first) return fail(first.error());
  gap::DrivesNeededCase found;
  found.limit = gap::acquisition_sizes(acquisition, campaign.drives.size()).back();
  const auto repeats = static_cast<std::size_t>(options.random_repeats);
  std::vector<std::optional<std::size_t>> needed(repeats + 1);
  std::vector<Result<void>> outcome(needed.size());
  std::mutex mutex;
  // Runs beside each other use the processors better than the parts of one diagnosis.
  parallel_for(needed.size(), static_cast<std::size_t>(options.threads), [&](std::size_t run) {
    gap::AcquisitionOptions own = acquisition;
    own.repeat = run;
    const AcquisitionPolicy policy = run == 0 ? AcquisitionPolicy::kDesigned : AcquisitionPolicy::kRandom;
    const auto steps = gap::acquire_drives(campaign, *first, policy, own, diagnose, judge);
    if (!steps) {
      outcome[run] = fail(steps.error());
      return;
    }
    needed[run] = gap::drives_needed(*steps);
    const std::lock_guard lock(mutex);
    std::cerr << fmt::format("{} {}: {}\n", campaign.name,
                             run == 0 ? "designed" : fmt::format("random {}", run), words(*steps));
  });
  for (const Result<void>& o : outcome) {
    if (!o && o.error().code == ErrorCode::kCancelled) return std::nullopt;
    if (!o) return fail(o.error());
  }
  found.designed = needed.front();
  found.random.assign(needed.begin() + 1, needed.end());
  return found;
}

}  // namespace

Result<gap::DrivesNeeded> drives_needed(const GapBenchmarkCommand& options, const api::Catalogue& catalogue,
                                        std::span<const std::string> names,
                                        const std::map<std::string, gap::HiddenAnswer>& answers,
                                        const std::set<std::string>& library) {
  gap::DrivesNeeded all{.seed = options.seed, .first = gap::AcquisitionOptions{}.first, .cases = {}};
  gap::DiagnosisOptions how;
  how.search.threads = 1;
  how.seed = options.seed;
  for (std::size_t i = 0; i < names.size() && !given_up(); ++i) {
    const auto answer = answers.find(names[i]);
    if (answer == answers.end() || answer->second.effects.empty() ||
        !std::includes(library.begin(), library.end(), answer->second.effects.begin(),
                       answer->second.effects.end()))
      continue;
    const auto campaign =
        api::load_drive_campaign(std::filesystem::path(options.folder) / names[i], catalogue);
    if (!campaign) return fail(campaign.error());
    if (campaign->drives.size() <= all.first) continue;
    const gap::DrivesJudge judge = [&](const gap::Diagnosis& d) {
      return gap::score_case(answer->second, d, library, 0.0).exact;
    };
    auto found = needed_of(options, *campaign, how, judge);
    if (!found) return fail(found.error());
    if (!*found) break;
    (*found)->campaign = names[i];
    (*found)->hidden = fmt::format("{}", fmt::join(answer->second.effects, " + "));
    (*found)->kind = answer->second.kind;
    (*found)->fidelity = answer->second.fidelity;
    all.cases.push_back(std::move(**found));
    std::cerr << fmt::format("[{}/{}] {}\n", i + 1, names.size(), names[i]);
  }
  return all;
}

}  // namespace slipway::server
