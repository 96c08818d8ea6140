#include "research/benchmark/drive_acquisition.h"

#include <algorithm>
#include <limits>

#include "core/random.h"
#include "research/benchmark/drive_kind.h"

namespace slipway::gap {
namespace {

constexpr std::size_t kManyDrives = 12;

std::vector<DriveKind> kinds_of(const DriveCampaign& campaign) {
  std::vector<DriveKind> kinds;
  for (std::size_t d = 0; d < campaign.drives.size(); ++d) kinds.push_back(kind_of(campaign, d));
  return kinds;
}

std::vector<std::size_t> not_among(std::size_t all, std::span<const std::size_t> made) {
  std::vector<std::size_t> left;
  for (std::size_t d = 0; d < all; ++d)
    if (std::find(made.begin(), made.end(), d) == made.end()) left.push_back(d);
  return left;
}

}  // namespace

std::vector<std::size_t> acquisition_sizes(const AcquisitionOptions& options, std::size_t pool) {
  const std::size_t most = std::min(options.most, pool);
  std::vector<std::size_t> sizes{std::min(options.first, most)};
  while (sizes.back() < most)
    sizes.push_back(std::min(most, sizes.back() + (sizes.back() < kManyDrives ? 2 : 4)));
  return sizes;
}

std::vector<std::size_t> first_drives(const DriveCampaign& campaign, std::size_t count) {
  const std::vector<DriveKind> kinds = kinds_of(campaign);
  const DriveDistance distance(kinds);
  const DriveKind gentle{.speed_m_s = campaign.rover->cruise_speed_m_s, .motor_temp_c = 20.0};
  std::vector<std::size_t> order = not_among(kinds.size(), {});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return distance.between(kinds[a], gentle) < distance.between(kinds[b], gentle);
  });
  order.resize(std::min(count, order.size()));
  return order;
}

std::vector<std::size_t> random_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                       std::size_t count, const AcquisitionOptions& options) {
  std::vector<std::size_t> left = not_among(campaign.drives.size(), made), drawn;
  const std::uint64_t key = random_key(random_key(options.seed, options.repeat), made.size());
  while (drawn.size() < count && !left.empty()) {
    const auto pick =
        static_cast<std::size_t>(random_uniform(key, drawn.size()) * static_cast<double>(left.size()));
    drawn.push_back(left[pick]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(pick));
  }
  return drawn;
}

std::vector<std::size_t> designed_drives(const DriveCampaign& campaign, std::span<const std::size_t> made,
                                         std::span<const NextDrive> proposed, std::size_t count,
                                         const AcquisitionOptions& options) {
  if (proposed.empty()) return random_drives(campaign, made, count, options);
  const std::vector<DriveKind> kinds = kinds_of(campaign);
  const DriveDistance distance(kinds);
  std::vector<std::size_t> left = not_among(kinds.size(), made), chosen;
  std::vector<DriveKind> asked;
  while (chosen.size() < count && !left.empty()) {
    if (asked.empty())
      for (const NextDrive& drive : proposed) asked.push_back(kind_of(drive));
    std::size_t served = 0, by = left.front();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const std::size_t nearest = nearest_drive(distance, kinds, left, asked[i]);
      if (distance.between(kinds[nearest], asked[i]) >= least) continue;
      least = distance.between(kinds[nearest], asked[i]);
      served = i;
      by = nearest;
    }
    chosen.push_back(by);
    std::erase(left, by);
    asked.erase(asked.begin() + static_cast<std::ptrdiff_t>(served));
  }
  return chosen;
}

Result<std::vector<AcquisitionStep>> acquire_drives(const DriveCampaign& campaign, const Diagnosis& first,
                                                    AcquisitionPolicy policy,
                                                    const AcquisitionOptions& options,
                                                    const DrivesDiagnosis& diagnosis,
                                                    const DrivesJudge& judge) {
  std::vector<std::size_t> made = first_drives(campaign, options.first);
  std::vector<AcquisitionStep> steps{{made.size(), judge(first)}};
  std::vector<NextDrive> proposed = first.next_drives;
  const std::vector<std::size_t> sizes = acquisition_sizes(options, campaign.drives.size());
  for (std::size_t i = 1; i < sizes.size(); ++i) {
    const std::size_t count = sizes[i] - made.size();
    const std::vector<std::size_t> added = policy == AcquisitionPolicy::kDesigned
                                               ? designed_drives(campaign, made, proposed, count, options)
                                               : random_drives(campaign, made, count, options);
    made.insert(made.end(), added.begin(), added.end());
    const auto found = diagnosis(subset_of(campaign, made));
    if (!found) return fail(found.error());
    steps.push_back({made.size(), judge(*found)});
    proposed = found->next_drives;
    if (steps[i].right && steps[i - 1].right) break;
  }
  return steps;
}

}  // namespace slipway::gap
