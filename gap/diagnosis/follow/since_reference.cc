#include "gap/diagnosis/follow/since_reference.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/soil/soil_field.h"

namespace slipway::gap {
namespace {

// Why the drives are not those of one rover on one body, or not others than the reference's.
std::vector<Fault> mismatches(const DriveCampaign& reference, const DriveCampaign& campaign) {
  constexpr double kSameGravity = 1e-6;
  std::vector<Fault> faults;
  if (reference.rover->name != campaign.rover->name ||
      reference.rover->wheels.size() != campaign.rover->wheels.size())
    faults.push_back(
        {"/reference", fmt::format("the reference is of rover \"{}\" with {} wheels, the campaign "
                                   "of \"{}\" with {}: must be the same",
                                   reference.rover->name, reference.rover->wheels.size(),
                                   campaign.rover->name, campaign.rover->wheels.size())});
  if (std::abs(reference.gravity_m_s2 - campaign.gravity_m_s2) > kSameGravity * campaign.gravity_m_s2)
    faults.push_back(
        {"/reference", fmt::format("the reference's gravity is {} m/s2, the campaign's {}: must be the same",
                                   reference.gravity_m_s2, campaign.gravity_m_s2)});
  const auto twin = std::find_if(campaign.drives.begin(), campaign.drives.end(), [&](const auto& drive) {
    return std::any_of(reference.drives.begin(), reference.drives.end(),
                       [&](const auto& healthy) { return healthy.id == drive.id; });
  });
  const bool same_files = !campaign.fingerprint.empty() && campaign.fingerprint == reference.fingerprint;
  if (same_files && twin != campaign.drives.end())
    faults.push_back({"/reference", fmt::format("drive {} is among the reference's drives too: must be other "
                                                "drives than those that are diagnosed",
                                                twin->id)});
  return faults;
}

// Drives of a simulator without noise may have the same rows and be others, so that nothing is refused.
void note_same_rows(const DriveCampaign& reference, DriveCampaign& campaign) {
  std::vector<std::string> same;
  for (const MeasuredDriveSeries& drive : campaign.drives)
    if (std::any_of(reference.drives.begin(), reference.drives.end(),
                    [&](const MeasuredDriveSeries& healthy) { return same_rows(drive, healthy); }))
      same.push_back(drive.id);
  if (same.empty()) return;
  constexpr std::size_t kNamed = 3;
  const std::size_t named = std::min(kNamed, same.size());
  campaign.notes.push_back(fmt::format(
      "{} of {} drives have the very rows of a drive of the reference (the first: {}): where they are the "
      "same recordings they were taken as healthy, and can't show a change",
      same.size(), campaign.drives.size(),
      fmt::join(same.begin(), same.begin() + static_cast<std::ptrdiff_t>(named), ", ")));
}

// By copies, since rows of the catalogue give members to write to.
bool same_numbers(sim::Soil a, sim::Soil b) {
  const auto fields = sim::soil_fields();
  return std::all_of(fields.begin(), fields.end(),
                     [&](const sim::SoilField& row) { return row.number(a) == row.number(b); });
}

// But for words about it, and the rate that its campaigns have asked of it.
bool same_numbers(sim::RoverModel rover, const sim::RoverModel& known) {
  rover.summary = known.summary;
  rover.sources = known.sources;
  rover.assumed = known.assumed;
  rover.drive.max_wheel_rate_rad_s = known.drive.max_wheel_rate_rad_s;
  return rover == known;
}

// As the reference has rover and soils, which what was learnt is relative to.
void adopt_nominal(const DriveCampaign& reference, DriveCampaign& campaign) {
  auto rover = std::make_shared<sim::RoverModel>(*reference.rover);
  if (!same_numbers(*campaign.rover, *rover) || campaign.parameter_std != reference.parameter_std)
    campaign.notes.push_back(fmt::format(
        "rover {} has other numbers in the reference, or how well they were measured differs; those of the "
        "reference are taken, since what was learnt is relative to them",
        rover->name));
  rover->drive.max_wheel_rate_rad_s =
      std::max(rover->drive.max_wheel_rate_rad_s, campaign.rover->drive.max_wheel_rate_rad_s);
  campaign.rover = std::move(rover);
  campaign.parameter_std = reference.parameter_std;
  for (NominalSoil& soil : campaign.soils)
    for (const NominalSoil& known : reference.soils)
      if (known.name == soil.name) {
        if (!same_numbers(known.soil, soil.soil))
          campaign.notes.push_back(fmt::format(
              "soil {} has other numbers in the reference; those of the reference are taken, since "
              "what was learnt is relative to them",
              soil.name));
        soil.soil = known.soil;
      }
}

}  // namespace

Result<void> check_reference(const DriveCampaign& reference, const DriveCampaign& campaign) {
  auto faults = mismatches(reference, campaign);
  if (faults.empty()) return {};
  const std::string message = faults.front().message;
  return fail(ErrorCode::kInvalidRequest, message, std::move(faults));
}

Result<DriveCampaign> since_reference(const LearntReference& learnt, const DriveCampaign& campaign,
                                      const DiagnosisOptions& options) {
  const DriveCampaign& reference = learnt.prepared.model->campaign();
  if (const auto checked = check_reference(reference, campaign); !checked) return fail(checked.error());
  DriveCampaign since = campaign;
  adopt_nominal(reference, since);
  note_same_rows(reference, since);
  since.reference = belief_for(learnt, since, options.reference);
  for (const std::string& note : since.reference->implausible) since.notes.push_back(note);
  return since;
}

Result<DriveCampaign> since_reference(const DriveCampaign& reference, const DriveCampaign& campaign,
                                      const DiagnosisOptions& options, Progress& progress) {
  // Before the work of learning.
  if (const auto checked = check_reference(reference, campaign); !checked) return fail(checked.error());
  const auto learnt = learn_reference(reference, options, progress);
  if (!learnt) return fail(learnt.error());
  return since_reference(*learnt, campaign, options);
}

}  // namespace slipway::gap
