#include "campaign/campaign_files.h"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace slipway::campaign {
namespace {

// Who writes a file: where its name is in the table, and what to call it.
struct Owner {
  std::string pointer;
  std::string words;
};

class Claims {
 public:
  explicit Claims(std::vector<Fault>& faults) : faults_(faults) {}

  void add(const std::string& file, const Owner& owner) {
    const auto [first, is_new] = owners_.emplace(file, owner);
    if (is_new) return;
    faults_.push_back(
        {owner.pointer, fmt::format("{} and {} would both be written to {}: give one another name",
                                    first->second.words, owner.words, file)});
  }

 private:
  std::map<std::string, Owner> owners_;
  std::vector<Fault>& faults_;
};

void claim_files(const DriveTable& table, const TableDrive& drive, Claims& claims) {
  const DriveEntry& entry = table.entries[drive.entry];
  const std::string pointer = fmt::format("/drives/{}/id", drive.entry);
  const int legs = static_cast<int>(entry.legs.size());
  for (int leg = 0; leg < legs; ++leg)
    claims.add(measurement_file(table, drive, leg),
               {pointer, legs > 1 ? fmt::format("leg {} of drive {}", leg + 1, drive.id)
                                  : fmt::format("drive {}", drive.id)});
  if (entry.deformed_terrain)
    claims.add(deformed_terrain_file(drive), {pointer, fmt::format("the ruts of drive {}", drive.id)});
  if (entry.plot)
    claims.add(time_history_file(drive), {pointer, fmt::format("the plot of drive {}", drive.id)});
}

}  // namespace

std::string measurement_file(const DriveTable& table, const TableDrive& drive, int leg) {
  return table.entries[drive.entry].legs.size() > 1 ? fmt::format("{}-leg{}.csv", drive.id, leg + 1)
                                                    : drive.id + ".csv";
}

std::string deformed_terrain_file(const TableDrive& drive) {
  return drive.id + "-deformed.tif";
}

std::string time_history_file(const TableDrive& drive) {
  return "plots/" + drive.id + ".svg";
}

std::string record_file(const TableDrive& drive) {
  return "drives/" + drive.id + ".json";
}

std::string elevation_file(const TableTerrain& terrain) {
  return terrain.name + ".tif";
}

std::string soil_map_file(const TableTerrain& terrain) {
  return terrain.name + "-soil.tif";
}

std::vector<Fault> colliding_files(const DriveTable& table, const std::vector<TableDrive>& drives) {
  std::vector<Fault> faults;
  Claims claims(faults);
  claims.add(kSlipPlotFile, {"", "the plot of slip by terrain"});
  claims.add(kPosesPlotFile, {"", "the plot of final poses"});
  for (std::size_t t = 0; t < table.terrains.size(); ++t) {
    const TableTerrain& terrain = table.terrains[t];
    const std::string pointer = fmt::format("/terrains/{}/name", t);
    claims.add(elevation_file(terrain), {pointer, fmt::format("terrain {}", terrain.name)});
    if (terrain.soil_map)
      claims.add(soil_map_file(terrain), {pointer, fmt::format("the soil map of terrain {}", terrain.name)});
  }
  for (const TableDrive& drive : drives) claim_files(table, drive, claims);
  return faults;
}

}  // namespace slipway::campaign
