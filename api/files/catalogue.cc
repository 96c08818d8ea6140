#include "api/files/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <system_error>
#include <utility>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/files/whole_file.h"
#include "api/json/faults.h"

namespace slipway::api {
namespace {

namespace fs = std::filesystem;

// Beliefs about unmapped ground of other bodies than Mars.
struct UnmappedGround {
  std::string_view belief;
  double least_gravity_m_s2, most_gravity_m_s2;
};
constexpr std::array kUnmappedElsewhere{UnmappedGround{"unknown_ground_moon", 1.5, 1.75},
                                        UnmappedGround{"unknown_ground_earth", 9.7, 9.9}};

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

// The faults of one file, which is left out where it has any.
class FileFaults {
 public:
  FileFaults(std::string kind, std::string name, std::string file, Catalogue& catalogue)
      : left_out_{std::move(kind), std::move(name), {}}, file_(std::move(file)), catalogue_(catalogue) {}
  ~FileFaults() {
    if (any()) catalogue_.left_out.push_back(std::move(left_out_));
  }
  FileFaults(const FileFaults&) = delete;
  FileFaults& operator=(const FileFaults&) = delete;

  bool any() const { return !left_out_.faults.empty(); }
  void add(const std::string& pointer, std::string message) {
    left_out_.faults.push_back({file_ + "#" + pointer, std::move(message)});
  }
  void add(const Error& error) {
    if (error.faults.empty()) add("", error.detail);
    for (const Fault& fault : error.faults) add(fault.pointer, fault.message);
  }

 private:
  LeftOutFile left_out_;
  std::string file_;
  Catalogue& catalogue_;
};

void load_rovers(const fs::path& data, Catalogue& catalogue) {
  for (const fs::path& path : entries_of(data / "rovers")) {
    if (path.extension() != ".json") continue;
    FileFaults faults("rover", path.stem().string(), "rovers/" + path.filename().string(), catalogue);
    const auto bytes = read_data_file(path);
    auto rover = bytes ? json::read_rover_file(*bytes) : Result<sim::RoverModel>(fail(bytes.error()));
    if (!rover) {
      faults.add(rover.error());
    } else if (rover->name != path.stem().string()) {
      faults.add("/name", fmt::format("name = {}, must be the file's name", in_quotes(rover->name)));
    } else {
      const std::string name =
          rover->name;  // of its own: the rover is moved from before the key is looked up
      catalogue.rovers[name] = std::make_shared<const sim::RoverModel>(std::move(*rover));
    }
  }
}

// Joins the names of alternatives with the soils that they name. The faults by soil; their pointers begin
// with
// "/alternatives".
std::map<std::string, std::vector<Fault>> join_alternatives(Catalogue& catalogue) {
  std::map<std::string, std::vector<Fault>> faults;
  for (auto& [name, soil] : catalogue.soils) {
    for (std::size_t i = 0; i < soil.alternatives.size(); ++i) {
      sim::SoilAlternative& alternative = soil.alternatives[i];
      const std::string pointer = fmt::format("/alternatives/{}/soil", i);
      const auto found = catalogue.soils.find(alternative.name);
      if (found == catalogue.soils.end()) {
        faults[name].push_back({pointer, unknown_soil(catalogue, alternative.name)});
      } else if (!found->second.alternatives.empty()) {
        faults[name].push_back(
            {pointer, fmt::format("soil {} can't be an alternative: it has alternatives of its own",
                                  alternative.name)});
      } else {
        alternative.soil = std::make_shared<const sim::SoilDistribution>(found->second);
      }
    }
  }
  return faults;
}

void load_soils(const fs::path& data, Catalogue& catalogue) {
  for (const fs::path& path : entries_of(data / "soils")) {
    if (path.extension() != ".json") continue;
    FileFaults faults("soil", path.stem().string(), "soils/" + path.filename().string(), catalogue);
    const auto bytes = read_data_file(path);
    auto soils = bytes ? json::read_soil_file(*bytes, *catalogue.soil_format)
                       : Result<std::vector<sim::SoilDistribution>>(fail(bytes.error()));
    if (!soils) {
      faults.add(soils.error());
      continue;
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < soils->size(); ++i)
      if (const std::string& name = (*soils)[i].name;
          catalogue.soils.contains(name) || !names.insert(name).second)
        faults.add(fmt::format("/soils/{}/name", i), fmt::format("soil {} is given twice", name));
    if (faults.any()) continue;
    for (sim::SoilDistribution& soil : *soils) {
      const std::string name = soil.name;
      catalogue.soils.emplace(name, std::move(soil));
    }
  }
  for (const auto& [name, unjoined] : join_alternatives(catalogue)) {
    FileFaults faults("soil", name, "soils", catalogue);
    for (const Fault& fault : unjoined) faults.add(name + fault.pointer, fault.message);
    catalogue.soils.erase(name);
  }
}

void load_rules(const fs::path& data, Catalogue& catalogue) {
  std::error_code error;
  if (!fs::exists(data / "rules", error)) return;
  for (const fs::path& path : entries_of(data / "rules")) {
    if (path.extension() != ".json") continue;
    FileFaults faults("rules", path.stem().string(), "rules/" + path.filename().string(), catalogue);
    const auto bytes = read_data_file(path);
    auto rules = bytes ? json::read_rules_file(*bytes) : Result<RuleSet>(fail(bytes.error()));
    if (!rules) {
      faults.add(rules.error());
    } else if (rules->name != path.stem().string()) {
      faults.add("/name", fmt::format("name = {}, must be the name of its file", rules->name));
    } else {
      catalogue.rules[rules->name] = std::move(*rules);
    }
  }
}

void check_legends(const TerrainDescription& terrain, const Catalogue& catalogue, FileFaults& faults) {
  for (std::size_t l = 0; l < terrain.legends.size(); ++l) {
    const std::vector<dem::SoilClass>& classes = terrain.legends[l].classes;
    const std::string place = l == 0 ? "/soil" : fmt::format("/soil/other_legends/{}", l - 1);
    for (std::size_t i = 0; i < classes.size(); ++i)
      if (const auto& soil = classes[i].soil; soil && !catalogue.soils.contains(*soil))
        faults.add(fmt::format("{}/legend/{}/soil", place, i), unknown_soil(catalogue, *soil));
  }
}

void load_terrains(const fs::path& data, Catalogue& catalogue) {
  for (const fs::path& folder : entries_of(data / "terrains")) {
    std::error_code error;
    if (is_unfinished(folder)) continue;  // an import under way, or killed
    if (!fs::exists(folder / "terrain.json", error)) continue;
    const std::string name = folder.filename().string();
    FileFaults faults("terrain", name, fmt::format("terrains/{}/terrain.json", name), catalogue);
    const auto site = TerrainSite::open(folder);
    if (!site) {
      faults.add(site.error());
      continue;
    }
    check_legends((*site)->description(), catalogue, faults);
    if (!faults.any()) catalogue.terrains.emplace((*site)->description().name, *site);
  }
}

std::string unknown_in(const Catalogue& catalogue, std::string_view kind, std::string_view name,
                       const std::vector<std::string>& known) {
  std::string words = unknown_name(kind, name, known);
  for (const LeftOutFile& file : catalogue.left_out)
    if (file.kind == kind && (file.name == name || kind == "soil"))
      words += fmt::format("; {} is left out, since it has faults",
                           file.faults.front().pointer.substr(0, file.faults.front().pointer.find('#')));
  return words;
}

}  // namespace

Catalogue with_terrains(Catalogue catalogue, const fs::path& folder) {
  load_terrains(folder, catalogue);
  return catalogue;
}

std::string_view unknown_ground_at(double gravity_m_s2) {
  for (const UnmappedGround& body : kUnmappedElsewhere)
    if (gravity_m_s2 >= body.least_gravity_m_s2 && gravity_m_s2 <= body.most_gravity_m_s2) return body.belief;
  return kUnknownGround;
}

Result<Catalogue> load_catalogue(const fs::path& data, const sim::SoilFormat& format) {
  Catalogue catalogue;
  catalogue.soil_format = &format;
  load_rovers(data, catalogue);
  load_soils(data, catalogue);
  load_rules(data, catalogue);
  load_terrains(data, catalogue);
  std::vector<Fault> missing;
  if (catalogue.rovers.empty()) missing.push_back({"rovers#", "there is no rover"});
  if (!catalogue.soils.contains(kUnknownGround))
    missing.push_back({"soils#", fmt::format("there is no soil {}", kUnknownGround)});
  if (missing.empty()) {
    for (const UnmappedGround& body : kUnmappedElsewhere) {
      if (catalogue.soils.contains(body.belief)) continue;
      sim::SoilDistribution belief = catalogue.soils.find(kUnknownGround)->second;
      belief.name = body.belief;
      catalogue.soils.emplace(body.belief, std::move(belief));
    }
    return catalogue;
  }
  for (const LeftOutFile& file : catalogue.left_out)
    missing.insert(missing.end(), file.faults.begin(), file.faults.end());
  return fail(ErrorCode::kUnreadableData,
              fmt::format("the data folder {}: {}", data.string(), summary_of(missing)), missing);
}

std::string unknown_rover(const Catalogue& catalogue, std::string_view name) {
  return unknown_in(catalogue, "rover", name, names_of(catalogue.rovers));
}

std::string unknown_soil(const Catalogue& catalogue, std::string_view name) {
  return unknown_in(catalogue, "soil", name, names_of(catalogue.soils));
}

std::string unknown_terrain(const Catalogue& catalogue, std::string_view name) {
  return unknown_in(catalogue, "terrain", name, names_of(catalogue.terrains));
}

Result<std::shared_ptr<const TerrainSite>> terrain_at(const Catalogue& catalogue, std::string_view name,
                                                      const std::string& version) {
  const auto found = catalogue.terrains.find(name);
  if (found == catalogue.terrains.end())
    return fail(ErrorCode::kNotFound,
                fmt::format("the terrain {} was removed after this was asked for: ask about another one",
                            in_quotes(name)));
  const std::string& now = found->second->version();
  if (version.empty() || version == now) return found->second;
  return fail(ErrorCode::kConflict,
              fmt::format("the terrain {} was replaced after this was asked for, version "
                          "{} by {}: ask again for an answer on what is there now",
                          in_quotes(name), version, now));
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
  for (const auto& [name, unjoined] : join_alternatives(catalogue)) {
    const auto own = given.find(name);
    // Beliefs about other bodies that the request does not give keep the soils that ship.
    const bool is_elsewhere = std::any_of(kUnmappedElsewhere.begin(), kUnmappedElsewhere.end(),
                                          [&](const UnmappedGround& body) { return body.belief == name; });
    if (own == given.end() && is_elsewhere) continue;
    for (const Fault& fault : unjoined)
      faults.push_back({own != given.end() ? fmt::format("/beliefs/{}{}", own->second, fault.pointer)
                                           : std::string("/beliefs"),
                        fault.message});
  }
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return catalogue;
}

}  // namespace slipway::api
