#include "api/files/campaign/drive_campaign_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"
#include "core/angle.h"
#include "gap/diagnosis/model/nuisance_catalogue.h"

namespace slipway::api::json {
namespace {

constexpr ParseLimits kLimits{.bytes = std::size_t{16} << 20U, .values = 500'000, .depth = 64, .keys = 2000};
constexpr std::size_t kMaxDrives = 10'000;

std::vector<std::string> names_in(const std::vector<gap::NominalSoil>& soils) {
  std::vector<std::string> names;
  names.reserve(soils.size());
  for (const gap::NominalSoil& soil : soils) names.push_back(soil.name);
  return names;
}

void keep_rover(sim::RoverModel rover, DriveCampaignFile& file) {
  rover.drive.currents_by_format = true;
  file.rover = std::make_shared<const sim::RoverModel>(std::move(rover));
}

void read_rover(ObjectReader& reader, const Catalogue& catalogue, DriveCampaignFile& file) {
  const JsonValue* const value = reader.member("rover", kRequired);
  if (value == nullptr) return;
  if (value->is(JsonValue::Kind::kString)) {
    const auto shipped = catalogue.rovers.find(value->text);
    if (shipped == catalogue.rovers.end())
      reader.fault("rover", unknown_rover(catalogue, value->text));
    else
      keep_rover(*shipped->second, file);
    return;
  }
  if (!value->is(JsonValue::Kind::kObject)) {
    reader.fault("rover",
                 fmt::format("rover = {}, must be an object, or the name of a rover that is shipped: {}",
                             describe(*value), fmt::join(names_of(catalogue.rovers), ", ")));
    return;
  }
  const std::size_t before = file.faults.size();
  ObjectReader object = *reader.object("rover", kRequired);
  sim::RoverModel rover = read_campaign_rover(object);
  // Its wheels' names are enough to read the drives' files by, so that their faults are reported as well.
  const bool nameable = !rover.wheels.empty() && rover.wheels.size() <= sim::kMaxWheels;
  if (file.faults.size() == before || nameable) keep_rover(std::move(rover), file);
}

// What must hold between the numbers of a soil, under the wheels that will roll on it.
void check_soil(ObjectReader& reader, const sim::Soil& soil, const sim::RoverModel* rover) {
  if (rover == nullptr) return;
  for (const sim::WheelModel& wheel : rover->wheels) {
    if (!(wheel.width_m > 0.0) || soil.pressure.stiffness(wheel.width_m) > 0.0) continue;
    reader.fault(
        "k_phi",
        fmt::format("k_c / b + k_phi = {:.6g} N/m^(n+2) under wheels of width b = {} m, must be above 0",
                    soil.pressure.stiffness(wheel.width_m), wheel.width_m));
    return;
  }
}

void note_defaults(const JsonValue& value, const gap::NominalSoil& soil, std::vector<std::string>& notes) {
  std::vector<std::string> taken;
  if (value.find("density_kg_m3") == nullptr)
    taken.push_back(fmt::format("density_kg_m3 = {}", soil.soil.density_kg_m3));
  if (value.find("c1") == nullptr) taken.push_back(fmt::format("c1 = {}", soil.soil.c1));
  if (value.find("c2") == nullptr) taken.push_back(fmt::format("c2 = {}", soil.soil.c2));
  if (!taken.empty())
    notes.push_back(
        fmt::format("soil {} does not say all: taken as {}", in_quotes(soil.name), fmt::join(taken, ", ")));
}

void read_soils(ObjectReader& reader, DriveCampaignFile& file) {
  auto object = reader.object("soils", kRequired);
  if (!object) return;
  const JsonValue& values = *reader.member("soils", kRequired);
  if (values.keys.empty()) reader.fault("soils", "soils names no soil, must name one at least");
  for (const std::string& name : values.keys) {
    const std::size_t before = file.faults.size();
    gap::NominalSoil& soil = file.soils.emplace_back();  // also where faulty, so that its name is known
    soil.name = name;
    soil.soil.gravity_m_s2 = file.gravity_m_s2;
    auto parameters = object->object(name, kRequired);
    if (!parameters) continue;
    read_campaign_soil(*parameters, kOptional, soil.soil);
    parameters->refuse_unknown();
    if (file.faults.size() > before) continue;
    check_soil(*parameters, soil.soil, file.rover.get());
    note_defaults(*object->member(name, kRequired), soil, file.notes);
  }
}

void check_soil_name(ObjectReader& reader, std::string_view key, const std::string& name,
                     const DriveCampaignFile& file) {
  const std::vector<std::string> known = names_in(file.soils);
  if (known.empty()) return;  // which was reported
  if (std::find(known.begin(), known.end(), name) == known.end())
    reader.fault(key, unknown_name("soil", name, known));
}

void read_classes(ObjectReader& soil, CampaignTerrainEntry& terrain, const DriveCampaignFile& file) {
  auto classes = soil.object("classes", kRequired);
  if (!classes) return;
  for (const std::string& key : soil.member("classes", kRequired)->keys) {
    dem::SoilClass& row = terrain.classes.emplace_back();
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), row.value);
    if (error != std::errc() || end != key.data() + key.size() || row.value < -32768 || row.value > 32767)
      classes->fault(key, in_quotes(key) + " is no class, must be a whole number in [-32768, 32767]");
    std::string name;
    if (!classes->text(key, kRequired, {}, name)) continue;
    check_soil_name(*classes, key, name, file);
    row.label = key;
    row.soil = std::move(name);
  }
}

void read_terrain_soil(ObjectReader& reader, CampaignTerrainEntry& terrain, const DriveCampaignFile& file) {
  const JsonValue* const soil = reader.member("soil", kRequired);
  if (soil == nullptr) return;
  if (soil->is(JsonValue::Kind::kString)) {
    terrain.soil = soil->text;
    check_soil_name(reader, "soil", terrain.soil, file);
    return;
  }
  if (!soil->is(JsonValue::Kind::kObject)) {
    reader.fault("soil", fmt::format("soil = {}, must be a soil's name, or an object of raster and classes",
                                     describe(*soil)));
    return;
  }
  ObjectReader object = *reader.object("soil", kRequired);
  object.text("raster", kRequired, {.most = 300}, terrain.soil_raster);
  read_classes(object, terrain, file);
  object.refuse_unknown();
}

void read_terrains(ObjectReader& reader, DriveCampaignFile& file) {
  auto object = reader.object("terrains", kRequired);
  if (!object) return;
  const JsonValue& values = *reader.member("terrains", kRequired);
  if (values.keys.empty()) reader.fault("terrains", "terrains names no terrain, must name one at least");
  for (const std::string& name : values.keys) {
    CampaignTerrainEntry& terrain = file.terrains.emplace_back();
    terrain.name = name;
    terrain.pointer = child_pointer(object->pointer(), name);
    auto entry = object->object(name, kRequired);
    if (!entry) continue;
    entry->text("dem", kRequired, {.most = 300}, terrain.dem);
    read_terrain_soil(*entry, terrain, file);
    entry->refuse_unknown();
  }
}

void read_measurement_std(ObjectReader& reader, gap::MeasurementStd& std) {
  auto object = reader.object("measurement_std", kRequired);
  if (!object) return;
  object->number("position_m", kRequired, {"m", 0.0, 1000.0, true}, std.position_m);
  object->angle_deg("attitude_deg", kRequired, {"deg", 0.0, 180.0, true}, std.attitude_rad);
  // Of what no drive has, see missing_noise() of drive_campaign_source.cc.
  object->number("current_rel", kOptional, {"1", 0.0, 10.0}, std.current_relative);
  object->number("current_a", kOptional, {"A", 0.0, 1000.0}, std.current_a);
  object->number("sinkage_m", kOptional, {"m", 0.0, 10.0, true}, std.sinkage_m);
  object->refuse_unknown();
}

// A key that campaigns made here have besides those of the format.
void read_parameter_std(ObjectReader& reader, DriveCampaignFile& file) {
  const JsonValue* const value = reader.member("parameter_std", kOptional);
  if (value == nullptr) return;
  // A name that is misspelt is refused: its parameter would stay as unknown as before.
  ObjectReader object(*value, child_pointer(reader.pointer(), "parameter_std"), reader.faults());
  constexpr double kLeast = 1e-3;  // of the usual deviation: derivatives are taken by shares of it
  for (const gap::Nuisance& row : gap::nuisance_catalogue()) {
    std::optional<double> std;
    object.number(row.name, kOptional, {"1", kLeast * row.std, row.highest}, std);
    if (std) file.parameter_std.emplace(row.name, *std);
  }
  object.refuse_unknown();
}

// Of a turn in place: the fastest wheels' rims have the commanded speed.
double turn_rate_of(const sim::RoverModel* rover, double speed_m_s) {
  double farthest_m = 0.0;
  if (rover != nullptr)
    for (const sim::WheelModel& wheel : rover->wheels)
      farthest_m = std::max(farthest_m, wheel.position_m.head<2>().norm());
  return farthest_m > 0.0 ? speed_m_s / farthest_m : 0.0;
}

void read_command(ObjectReader& drive, const sim::RoverModel* rover, gap::MeasuredDriveSeries& out) {
  auto object = drive.object("commanded", kRequired);
  if (!object) return;
  sim::DriveCommand& command = out.command;
  double speed_m_s = 0.0;
  std::optional<double> turn_rate_rad_s;
  const bool has_speed = object->number("speed_m_s", kRequired, {"m/s", -5.0, 5.0}, speed_m_s);
  object->number("curvature_1_m", kRequired, {"1/m", -100.0, 100.0}, command.curvature_1_m);
  const bool has_turning = object->boolean("turn_in_place", kRequired, command.turn_in_place);
  object->number("duration_s", kRequired, {"s", 0.0, 1e7, true}, out.duration_s);
  // Keys that campaigns made here have besides those of the format.
  object->angle_deg("turn_rate_deg_s", kOptional, {"deg/s", -360.0, 360.0}, turn_rate_rad_s);
  object->angle_deg("crab_deg", kOptional, {"deg", -90.0, 90.0}, command.crab_rad);
  object->refuse_unknown();
  if (!has_turning) return;
  if (!command.turn_in_place) {
    if (has_speed && speed_m_s == 0.0)
      object->fault("speed_m_s", "speed_m_s = 0 m/s, must be another where the rover does not turn in place");
    if (turn_rate_rad_s)
      object->fault("turn_rate_deg_s",
                    "turn_rate_deg_s is of a rover that turns in place, and this one does not");
    command.speed_m_s = speed_m_s;
    return;
  }
  command.curvature_1_m = 0.0;
  command.turn_rate_rad_s = turn_rate_rad_s.value_or(turn_rate_of(rover, speed_m_s));
  if (turn_rate_rad_s ? *turn_rate_rad_s == 0.0 : has_speed && speed_m_s == 0.0)
    object->fault(
        turn_rate_rad_s ? "turn_rate_deg_s" : "speed_m_s",
        "turns in place at no rate: speed_m_s (of the fastest wheels' rims) or turn_rate_deg_s must "
        "not be 0");
}

// Index into the terrains; 0 with a fault where there is none of the name.
std::size_t terrain_index(ObjectReader& drive, const std::vector<std::string>& terrains) {
  std::string name;
  if (!drive.text("terrain", kRequired, {}, name) || terrains.empty()) return 0;  // which was reported
  const auto at = std::find(terrains.begin(), terrains.end(), name);
  if (at != terrains.end()) return static_cast<std::size_t>(at - terrains.begin());
  drive.fault("terrain", unknown_name("terrain", name, terrains));
  return 0;
}

// A repeat may stand before what it repeats. ids: of all drives; where one could not be read, it may be the
// one that is repeated.
void check_repeats(const std::map<std::string, std::size_t>& ids, bool all_read, DriveCampaignFile& file) {
  for (const CampaignDriveEntry& entry : file.drives) {
    if (!entry.drive.repeat_of) continue;
    const std::string& other = *entry.drive.repeat_of;
    const std::string at = child_pointer(entry.pointer, "repeat_of");
    if (other == entry.drive.id)
      file.faults.push_back({at, fmt::format("repeat_of = {} is the drive itself", in_quotes(other))});
    else if (all_read && !ids.contains(other))
      file.faults.push_back(
          {at, fmt::format("repeat_of = {}, there is no drive of this id", in_quotes(other))});
  }
}

void read_drives(ObjectReader& reader, DriveCampaignFile& file) {
  std::map<std::string, std::size_t> first_with, first_of_file;
  std::vector<std::string> terrains;
  for (const CampaignTerrainEntry& terrain : file.terrains) terrains.push_back(terrain.name);
  bool all_ids = true;
  for (const Element& element : reader.list("drives", kRequired, {1, kMaxDrives})) {
    ObjectReader object = reader.object(element);
    all_ids = all_ids && object.is_object();
    if (!object.is_object()) continue;
    CampaignDriveEntry& entry = file.drives.emplace_back();
    entry.pointer = element.pointer;
    const std::size_t index = file.drives.size() - 1;
    gap::MeasuredDriveSeries& drive = entry.drive;
    if (!object.text("id", kRequired, {}, drive.id))
      all_ids = false;
    else if (const auto [first, is_new] = first_with.emplace(drive.id, index); !is_new)
      object.fault("id", fmt::format("id = {} is that of {} as well", in_quotes(drive.id),
                                     file.drives[first->second].pointer));
    if (object.text("file", kRequired, {.most = 300}, entry.file))
      if (const auto [first, is_new] = first_of_file.emplace(entry.file, index); !is_new) {
        object.fault("file", fmt::format("file = {} is that of {} as well", in_quotes(entry.file),
                                         file.drives[first->second].pointer));
        entry.file.clear();  // its faults are reported once
      }
    read_drive_facts(object, file.rover.get(), terrains, drive);
    object.refuse_unknown();
  }
  check_repeats(first_with, all_ids, file);
}

// "/drives/17/weather" -> "/drives/*/weather": once for all elements of a list.
std::string without_indices(const std::string& pointer) {
  std::string text;
  for (std::size_t begin = 1; begin <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', begin), pointer.size());
    const std::string step = pointer.substr(begin, end - begin);
    const bool is_index = !step.empty() && step.find_first_not_of("0123456789") == std::string::npos;
    text += "/" + (is_index ? "*" : step);
    begin = end + 1;
  }
  return text;
}

void note_passed_over(const std::vector<std::string>& passed_over, std::vector<std::string>& notes) {
  std::set<std::string> keys;
  for (const std::string& pointer : passed_over) keys.insert(without_indices(pointer));
  if (keys.empty()) return;
  constexpr std::size_t kMostNamed = 30;
  std::vector<std::string> named(keys.begin(), keys.end());
  const std::size_t more = named.size() > kMostNamed ? named.size() - kMostNamed : 0;
  named.resize(named.size() - more);
  notes.push_back(fmt::format("campaign.json: keys that the format does not have were passed over: {}{}",
                              fmt::join(named, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
}

}  // namespace

void read_drive_facts(ObjectReader& object, const sim::RoverModel* rover,
                      const std::vector<std::string>& terrains, gap::MeasuredDriveSeries& drive) {
  drive.terrain = terrain_index(object, terrains);
  read_command(object, rover, drive);
  if (std::string other; object.text("repeat_of", kOptional, {}, other)) drive.repeat_of = other;
  object.boolean("final_only", kOptional, drive.final_only);
}

Result<DriveCampaignFile> read_drive_campaign_file(std::string_view bytes, const Catalogue& catalogue) {
  const auto document = parse_file(bytes, kCampaignDocument, kLimits);
  if (!document) return fail(document.error());
  DriveCampaignFile file;
  std::vector<std::string> passed_over;
  ObjectReader reader(*document, "", file.faults, &passed_over);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"drive-campaign/1"}, format);
  reader.text("name", kRequired, {.most = 500, .may_be_empty = true}, file.name);
  reader.number("gravity_m_s2", kRequired, {"m/s^2", 0.0, 30.0, true}, file.gravity_m_s2);
  read_rover(reader, catalogue, file);
  read_soils(reader, file);
  read_terrains(reader, file);
  read_measurement_std(reader, file.measurement_std);
  read_parameter_std(reader, file);
  read_drives(reader, file);
  reader.refuse_unknown();
  note_passed_over(passed_over, file.notes);
  return file;
}

}  // namespace slipway::api::json
