// sealed_campaigns OUT [--seed N] [--set blind|full|each|smoke|nothing|other_physics|outside] [--only
// CAUSE[+CAUSE],...] [--alone yes|no]
// [--fidelity L1|L2|L2c|L3] [--size X] [--references yes|no] [--since DRIVE] [--drives N] [--more FILE]
// [--measured soil|soil,closures]
//
// Only: of the set those campaigns with one of these causes, or with all that are joined by +; alone: without
// those that have more than one cause (healthy ones stay).
// Measured: campaign.json says how well soil (and closures) were measured apart from the drives.
// With --drives only so many of a campaign's drives are made, of all kinds; --more adds those of a file,
// whose lines are campaign,tilt_deg,heading_deg,speed_m_s,curvature_1_m,motor_temp_c (of tables alone; the
// heading from straight uphill, positive to the left). The others stay as they are. Since a drive: so many
// drives are healthy before the cause sets in, and their order is drawn. With references OUT/references/NAME
// holds drives of the same rover on the same ground without the cause. Makes campaigns of drives with hidden
// effects in most of them, and writes answers.json and traces.csv (where the effects act) beside them. It
// shares no code with the library that is judged on them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "detectability.h"
#include "effect_traces.h"
#include "hidden_causes.h"
#include "sealed_campaign.h"

namespace {

using namespace slipway::gap_benchmark;

constexpr const char* kUsage =
    "usage: sealed_campaigns OUT [--seed N] [--set blind|full|each|smoke|nothing|other_physics|outside]\n"
    "                        [--only CAUSE[+CAUSE],...] [--alone yes|no]\n"
    "                        [--fidelity L1|L2|L2c|L3] [--size X]\n"
    "                        [--references yes|no] [--since DRIVE] [--drives N] [--more FILE]\n"
    "                        [--measured soil|soil,closures]\n";

constexpr std::uint64_t kReferenceSeed = 0x5eed;  // of a reference, over its campaign's
constexpr std::uint64_t kMoreSeed = 0xadd;        // of drives that are added

struct Wish {
  std::string out, set = "blind";
  std::uint64_t seed = 1;
  std::vector<std::vector<std::string>> only;  // causes that go together
  bool alone = false;
  std::optional<Fidelity> fidelity;
  std::optional<double> size;
  bool references = false, measured_soil = false, measured_closures = false;
  std::size_t since = 0, drives = 0;
  std::map<std::string, std::vector<DriveOrder>> more;  // by campaign
};

// Drives to be added; nothing where the file can't be read or says something else.
std::optional<std::map<std::string, std::vector<DriveOrder>>> more_drives(const std::string& file) {
  std::ifstream in(file);
  std::map<std::string, std::vector<DriveOrder>> more;
  bool good = in.is_open();
  for (std::string line; good && std::getline(in, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    std::string campaign;
    double tilt_deg = 0.0, heading_deg = 0.0;
    DriveOrder order;
    good = static_cast<bool>(fields >> campaign >> tilt_deg >> heading_deg >> order.speed_m_s >>
                             order.curvature_1_m >> order.motor_temp_c);
    char terrain[16];
    std::snprintf(terrain, sizeof terrain, "tilt_%02d", static_cast<int>(std::lround(tilt_deg)));
    order.terrain = terrain;
    order.start_yaw_rad = heading_deg * std::numbers::pi / 180.0;
    more[campaign].push_back(order);
  }
  if (good) return more;
  std::cerr << file << " is no file of drives\n";
  return std::nullopt;
}

std::optional<Fidelity> fidelity_named(const std::string& name) {
  for (const Fidelity fidelity :
       {Fidelity::kSameEquations, Fidelity::kOtherEffects, Fidelity::kOtherClosures, Fidelity::kOtherPhysics})
    if (name_of(fidelity) == name) return fidelity;
  return std::nullopt;
}

std::optional<Wish> wish_of(int count, char** words) {
  Wish wish;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (!word.starts_with("--")) {
      if (!wish.out.empty()) return std::nullopt;
      wish.out = word;
      continue;
    }
    if (++i == count) return std::nullopt;
    const std::string value = words[i];
    if (word == "--seed")
      wish.seed = std::strtoull(value.c_str(), nullptr, 10);
    else if (word == "--set")
      wish.set = value;
    else if (word == "--size")
      wish.size = std::strtod(value.c_str(), nullptr);
    else if (word == "--since")
      wish.since = static_cast<std::size_t>(std::strtoull(value.c_str(), nullptr, 10));
    else if (word == "--drives")
      wish.drives = static_cast<std::size_t>(std::strtoull(value.c_str(), nullptr, 10));
    else if (word == "--more") {
      const auto more = more_drives(value);
      if (!more) return std::nullopt;
      wish.more = *more;
    } else if (word == "--measured") {
      wish.measured_soil = value == "soil" || value == "soil,closures";
      wish.measured_closures = value == "soil,closures";
      if (!wish.measured_soil) return std::nullopt;
    } else if (word == "--references")
      wish.references = value == "yes";
    else if (word == "--fidelity") {
      wish.fidelity = fidelity_named(value);
      if (!wish.fidelity) return std::nullopt;
    } else if (word == "--only") {
      std::istringstream names(value);
      for (std::string together; std::getline(names, together, ',');) {
        std::istringstream causes(together);
        std::vector<std::string>& all = wish.only.emplace_back();
        for (std::string name; std::getline(causes, name, '+');) {
          if (is_known_cause(name)) {
            all.push_back(name);
            continue;
          }
          std::cerr << name << " is no cause; known are";
          for (const std::string_view known : library_effects()) std::cerr << ' ' << known;
          for (const std::string_view known : foreign_causes()) std::cerr << ' ' << known;
          for (const std::string_view known : world_causes()) std::cerr << ' ' << known;
          std::cerr << '\n';
          return std::nullopt;
        }
      }
    } else if (word == "--alone") {
      wish.alone = value == "yes";
    } else {
      return std::nullopt;
    }
  }
  if (wish.out.empty()) return std::nullopt;
  return wish;
}

}  // namespace

int main(int count, char** words) {
  const std::optional<Wish> wish = wish_of(count, words);
  if (!wish) {
    std::cerr << kUsage;
    return 2;
  }
  RandomStream random(wish->seed);
  std::optional<std::vector<CampaignCase>> cases = cases_of(wish->set, wish->fidelity, random);
  if (!cases) {
    std::cerr << kUsage;
    return 2;
  }
  std::erase_if(*cases, [&](const CampaignCase& made_of) {
    const auto has = [&](const std::string& cause) {
      return std::find(made_of.causes.begin(), made_of.causes.end(), cause) != made_of.causes.end();
    };
    const bool wanted =
        wish->only.empty() ||
        std::any_of(wish->only.begin(), wish->only.end(), [&](const std::vector<std::string>& together) {
          return std::all_of(together.begin(), together.end(), has);
        });
    return !wanted || (wish->alone && made_of.causes.size() > 1);
  });
  if (wish->size)
    for (CampaignCase& made_of : *cases) made_of.size = *wish->size;
  for (CampaignCase& made_of : *cases) {
    made_of.since_drive = wish->since;
    if (wish->drives > 0) made_of.max_drives = wish->drives;
    if (!wish->more.empty()) made_of.on_hills = false;
    if (wish->measured_soil) made_of.nominal = NominalSoil::kMeasured;
    made_of.measured_closures = wish->measured_closures;
  }
  for (const CampaignCase& made_of : *cases)
    if (made_of.measured_closures &&
        (made_of.fidelity == Fidelity::kOtherClosures || made_of.fidelity == Fidelity::kOtherPhysics)) {
      std::cerr << "the closures of " << name_of(made_of.fidelity)
                << " are not the nominal ones: none measured them\n";
      return 2;
    }
  for (const CampaignCase& made_of : *cases)
    if (const std::optional<std::string> cause = impossible_cause(made_of)) {
      std::cerr << *cause << " is a term of the wheel law of L1 and L2; " << name_of(made_of.fidelity)
                << " has another law, without it\n";
      return 2;
    }

  std::string answers, traces = traces_header(), limits = detectability_header();
  for (std::size_t i = 0; i < cases->size(); ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "s%02u", static_cast<unsigned>(i + 1));
    if (std::filesystem::exists(std::filesystem::path(wish->out) / name)) {
      std::cerr << wish->out << " holds campaigns already\n";
      return 1;
    }
    RandomStream own((*cases)[i].seed);
    SealedCampaign campaign = make_campaign((*cases)[i], own);
    if (const auto more = wish->more.find(name); more != wish->more.end()) {
      RandomStream later((*cases)[i].seed + kMoreSeed);
      add_drives(campaign, more->second, later);
    }
    const std::string fault = write_campaign(campaign, name, std::filesystem::path(wish->out) / name);
    if (!fault.empty()) {
      std::cerr << fault << '\n';
      return 1;
    }
    if (wish->references) {
      RandomStream before((*cases)[i].seed + kReferenceSeed);
      const std::filesystem::path beside = std::filesystem::path(wish->out) / "references" / name;
      const std::string wrong = write_campaign(healthy_reference(campaign, before), name, beside);
      if (!wrong.empty()) {
        std::cerr << wrong << '\n';
        return 1;
      }
    }
    answers += (answers.empty() ? " \"" : ",\n \"") + std::string(name) + "\": " + answer_of(campaign);
    traces += traces_rows(name, effect_traces(campaign));
    limits += detectability_row(name, detectability(campaign));
    std::cerr << "\rmade " << i + 1 << " of " << cases->size() << std::flush;
  }
  std::cerr << '\n';
  std::ofstream out(std::filesystem::path(wish->out) / "answers.json", std::ios::binary);
  out << "{\n" << answers << "\n}\n";
  std::ofstream beside(std::filesystem::path(wish->out) / "traces.csv", std::ios::binary);
  beside << traces;
  std::ofstream limit(std::filesystem::path(wish->out) / "detectability.csv", std::ios::binary);
  limit << limits;
  return out.good() && beside.good() && limit.good() ? 0 : 1;
}
