#include "api/files/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

// Sorted, so that faults come in the same order everywhere.
std::vector<fs::path> entries_of(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    entries.push_back(it->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

void add_faults(const std::string& file, const Error& error, std::vector<Fault>& faults) {
  if (error.faults.empty()) faults.push_back({file + "#", error.detail});
  const auto moved = moved_under(file + "#", error.faults);
  faults.insert(faults.end(), moved.begin(), moved.end());
}

void load_rovers(const fs::path& data, Catalogue& catalogue, std::vector<Fault>& faults) {
  for (const fs::path& path : entries_of(data / "rovers")) {
    if (path.extension() != ".json") continue;
    const std::string file = "rovers/" + path.filename().string();
    const auto bytes = read_data_file(path);
    auto rover = bytes ? json::read_rover_file(*bytes) : Result<sim::RoverModel>(fail(bytes.error()));
    if (!rover) {
      add_faults(file, rover.error(), faults);
    } else if (rover->name != path.stem().string()) {
      faults.push_back(
          {file + "#/name", fmt::format("name = {}, must be the file's name", in_quotes(rover->name))});
    } else {
      const std::string name =
          rover->name;  // of its own: the rover is moved from before the key is looked up
      catalogue.rovers[name] = std::make_shared<const sim::RoverModel>(std::move(*rover));
    }
  }
  if (catalogue.rovers.empty() && faults.empty()) faults.push_back({"rovers#", "there is no rover"});
}

// Joins the names of alternatives with the soils that they name.
void join_alternatives(Catalogue& catalogue, std::vector<Fault>& faults) {
  for (auto& [name, soil] : catalogue.soils) {
    for (std::size_t i = 0; i < soil.alternatives.size(); ++i) {
      sim::SoilAlternative& alternative = soil.alternatives[i];
      const std::string pointer = fmt::format("soils#{}/alternatives/{}/soil", name, i);
      const auto found = catalogue.soils.find(alternative.name);
      if (found == catalogue.soils.end()) {
        faults.push_back({pointer, unknown_name("soil", alternative.name, names_of(catalogue.soils))});
      } else if (!found->second.alternatives.empty()) {
        faults.push_back(
            {pointer, fmt::format("soil {} can't be an alternative: it has alternatives of its own",
                                  alternative.name)});
      } else {
        alternative.soil = std::make_shared<const sim::SoilDistribution>(found->second);
      }
    }
  }
}

void load_soils(const fs::path& data, Catalogue& catalogue, std::vector<Fault>& faults) {
  for (const fs::path& path : entries_of(data / "soils")) {
    if (path.extension() != ".json") continue;
    const std::string file = "soils/" + path.filename().string();
    const auto bytes = read_data_file(path);
    auto soils = bytes ? json::read_soil_file(*bytes, *catalogue.soil_format)
                       : Result<std::vector<sim::SoilDistribution>>(fail(bytes.error()));
    if (!soils) {
      add_faults(file, soils.error(), faults);
      continue;
    }
    for (std::size_t i = 0; i < soils->size(); ++i) {
      const std::string name = (*soils)[i].name;
      if (!catalogue.soils.emplace(name, std::move((*soils)[i])).second) {
        faults.push_back(
            {fmt::format("{}#/soils/{}/name", file, i), fmt::format("soil {} is given twice", name)});
      }
    }
  }
  if (faults.empty()) join_alternatives(catalogue, faults);
  if (faults.empty() && !catalogue.soils.contains(kUnknownGround)) {
    faults.push_back({"soils#", fmt::format("there is no soil {}", kUnknownGround)});
  }
}

void load_rules(const fs::path& data, Catalogue& catalogue, std::vector<Fault>& faults) {
  std::error_code error;
  if (!fs::exists(data / "rules", error)) return;
  for (const fs::path& path : entries_of(data / "rules")) {
    const auto bytes = read_data_file(path);
    const std::string file = "rules/" + path.filename().string();
    auto rules = bytes ? json::read_rules_file(*bytes) : Result<RuleSet>(fail(bytes.error()));
    if (!rules) {
      add_faults(file, rules.error(), faults);
    } else if (rules->name != path.stem().string()) {
      faults.push_back(
          {file + "#/name", fmt::format("name = {}, must be the name of its file", rules->name)});
    } else {
      catalogue.rules[rules->name] = std::move(*rules);
    }
  }
}

void check_legend(const std::string& file, const TerrainDescription& terrain, const Catalogue& catalogue,
                  std::vector<Fault>& faults) {
  for (std::size_t l = 0; l < terrain.legends.size(); ++l) {
    const std::vector<dem::SoilClass>& classes = terrain.legends[l].classes;
    const std::string place = l == 0 ? "/soil" : fmt::format("/soil/other_legends/{}", l - 1);
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const auto& soil = classes[i].soil;
      if (!soil || catalogue.soils.contains(*soil)) continue;
      faults.push_back({fmt::format("{}#{}/legend/{}/soil", file, place, i),
                        unknown_name("soil", *soil, names_of(catalogue.soils))});
    }
  }
}

void load_terrains(const fs::path& data, Catalogue& catalogue, std::vector<Fault>& faults) {
  const bool soils_are_good = faults.empty();
  for (const fs::path& folder : entries_of(data / "terrains")) {
    std::error_code error;
    if (!fs::exists(folder / "terrain.json", error)) continue;
    const std::string file = fmt::format("terrains/{}/terrain.json", folder.filename().string());
    const auto site = TerrainSite::open(folder);
    if (!site) {
      add_faults(file, site.error(), faults);
      continue;
    }
    if (soils_are_good) check_legend(file, (*site)->description(), catalogue, faults);
    catalogue.terrains[(*site)->description().name] = *site;
  }
}

}  // namespace

Result<Catalogue> load_catalogue(const fs::path& data, const sim::SoilFormat& format) {
  Catalogue catalogue;
  catalogue.soil_format = &format;
  std::vector<Fault> faults;
  load_rovers(data, catalogue, faults);
  load_soils(data, catalogue, faults);
  load_rules(data, catalogue, faults);
  load_terrains(data, catalogue, faults);
  if (!faults.empty()) {
    return fail(ErrorCode::kUnreadableData,
                fmt::format("the data folder {}: {}", data.string(), summary_of(faults)), faults);
  }
  return catalogue;
}

Result<Catalogue> with_soils(Catalogue catalogue, const std::vector<sim::SoilDistribution>& soils) {
  std::vector<Fault> faults;
  std::map<std::string, std::size_t> given;
  for (std::size_t k = 0; k < soils.size(); ++k) {
    if (!given.emplace(soils[k].name, k).second)
      faults.push_back(
          {fmt::format("/beliefs/{}/name", k), fmt::format("soil {} is given twice", soils[k].name)});
    catalogue.soils[soils[k].name] = soils[k];
  }
  std::vector<Fault> unjoined;
  join_alternatives(catalogue, unjoined);
  for (Fault& fault : unjoined) {
    // "soils#NAME/alternatives/..."
    const std::size_t begin = fault.pointer.find('#') + 1, end = fault.pointer.find('/');
    const auto own = given.find(fault.pointer.substr(begin, end - begin));
    faults.push_back({own != given.end()
                          ? fmt::format("/beliefs/{}{}", own->second, fault.pointer.substr(end))
                          : std::string("/beliefs"),
                      std::move(fault.message)});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return catalogue;
}

}  // namespace slipway::api
