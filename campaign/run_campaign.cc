#include "campaign/run_campaign.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <utility>

#include "core/digest.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "planner/problem/terrain_ground.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::campaign {
namespace {

// Sub-streams of the table's seed.
enum Stream : std::uint64_t { kSoilStream = 1, kSensorStream = 2 };

sim::Soil soil_of(const DriveTable& table, const TableDrive& drive, const std::string& name) {
  const sim::SoilDistribution& belief = table.soils.find(name)->second;
  sim::Soil soil = belief.mean;
  if (table.draw_soils) {
    const std::uint64_t of_drive = random_key(random_key(table.seed, kSoilStream), fnv1a(drive.id));
    const std::uint64_t key = random_key(of_drive, fnv1a(name));
    sim::SoilNormals normals;
    for (int i = 0; i < sim::kSoilDims; ++i) normals[i] = random_normal(key, static_cast<std::uint64_t>(i));
    soil = sim::draw_soil(belief, normals);
  }
  sim::apply_effects(sim::in_force(table.rover->effects, table.effects), soil);
  return soil;
}

sim::DriveSoils soils_of(const DriveTable& table, const TableDrive& drive) {
  sim::DriveSoils soils;
  for (const std::string& name : soils_of(table.terrains[drive.terrain]))
    soils.known.push_back(soil_of(table, drive, name));
  soils.unknown = soils.known.back();
  soils.known.pop_back();
  return soils;
}

// A drive's own steps are no news; that nobody wants the campaign any more is.
class WithinCampaign final : public Progress {
 public:
  WithinCampaign(const Progress& campaign, const std::atomic<bool>& given_up)
      : campaign_(campaign), given_up_(given_up) {}
  void report(std::string_view /*stage*/, double /*fraction*/) override {}
  bool cancelled() const override { return given_up_ || campaign_.cancelled(); }

 private:
  const Progress& campaign_;
  const std::atomic<bool>& given_up_;
};

}  // namespace

MadeDrive make_drive(const DriveTable& table, const TableDrive& drive, Simulator simulator,
                     Progress& progress) {
  const DriveEntry& entry = table.entries[drive.entry];
  const sim::RoverModel rover = driven_rover(table, entry);
  const planner::TerrainGround ground(table.terrains[drive.terrain].ground,
                                      table.terrains[drive.terrain].soil_map);
  MadeDrive made;
  made.soils = soils_of(table, drive);
  sim::DynamicOptions options = table.options;
  options.motor_temp_c = motor_temp_c(table, entry);
  options.keep_ruts = options.keep_ruts || entry.deformed_terrain;
  sim::DriveSensors sensors = table.sensors;
  sensors.seed = random_key(table.seed, kSensorStream);
  const sim::DriveSink keep = [&](const sim::DriveSample& sample) {
    made.readings.push_back(
        sim::read_sensors(sensors, fnv1a(drive.id), made.readings.size(), options.sample_interval_s, sample));
  };
  made.drive = simulator(rover, table.gravity_m_s2, ground, made.soils, drive.start, entry.legs, options,
                         keep, progress);
  return made;
}

Result<void> run_campaign(const DriveTable& table, std::span<const TableDrive> drives,
                          const RunOptions& options, const DriveTaker& taker, Progress& progress) {
  std::atomic<bool> given_up{false};
  std::mutex mutex;
  std::optional<Error> error;
  std::size_t done = 0;
  parallel_for(drives.size(), options.threads, [&](std::size_t i) {
    WithinCampaign within(progress, given_up);
    if (within.cancelled()) return;
    const MadeDrive made = make_drive(table, drives[i], options.simulator, within);
    if (!made.drive && made.drive.error().code == ErrorCode::kCancelled) return;
    const Result<void> taken = taker(drives[i], made);
    const std::lock_guard lock(mutex);
    if (!taken) {
      if (!error) error = taken.error();
      given_up = true;
      return;
    }
    ++done;
    progress.report(fmt::format("{} of {} drives made, last {}", done, drives.size(), drives[i].id),
                    static_cast<double>(done) / static_cast<double>(drives.size()));
  });
  if (error) return fail(std::move(*error));
  if (done < drives.size())
    return fail(ErrorCode::kCancelled,
                fmt::format("given up after {} of {} drives; the same command goes on from there", done,
                            drives.size()));
  return {};
}

}  // namespace slipway::campaign
