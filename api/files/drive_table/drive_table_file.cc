#include "api/files/drive_table/drive_table_file.h"

#include <cstdint>
#include <utility>

#include "api/files/effect_settings.h"
#include "api/files/soil_file.h"
#include "api/json/faults.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

// In the order of sim::Feedback.
const std::vector<std::string_view> kFeedbacks{"none", "heading", "pose"};

void read_rover_name(ObjectReader& reader, const Catalogue& catalogue, campaign::DriveTable& table) {
  std::string name;
  if (!reader.text("rover", kRequired, {.most = 64}, name)) return;
  const auto found = catalogue.rovers.find(name);
  if (found == catalogue.rovers.end()) {
    reader.fault("rover", unknown_rover(catalogue, name));
  } else {
    table.rover = found->second;
  }
}

// The table's own soils stand before the catalogue's of the same name.
void read_table_soils(ObjectReader& reader, const Catalogue& catalogue, campaign::DriveTable& table) {
  std::vector<sim::SoilDistribution> own = read_soils(reader, "soils", kOptional);
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i].name.empty()) continue;
    std::string name = own[i].name;  // of its own: the soil is moved from before the key is looked up
    if (!table.soils.emplace(name, std::move(own[i])).second)
      reader.faults().push_back({child_pointer(child_pointer(child_pointer("", "soils"), i), "name"),
                                 "soil " + name + " is given twice"});
  }
  for (const auto& [name, soil] : catalogue.soils) table.soils.emplace(name, soil);
}

void read_simulation(ObjectReader& reader, sim::DynamicOptions& options) {
  auto object = reader.object("simulation", kOptional);
  if (!object) return;
  object->number("sample_interval_s", kOptional, {"s", 0.001, 3600.0}, options.sample_interval_s);
  std::size_t feedback = 0;
  if (object->choice("feedback", kOptional, kFeedbacks, feedback))
    options.feedback = static_cast<sim::Feedback>(feedback);
  object->number("relative_tolerance", kOptional, {"1", 1e-10, 1e-2}, options.relative_tolerance);
  object->whole("contact_points", kOptional, 1, 15, options.contact_points);
  object->number("give_up_s", kOptional, {"s", 1.0, 1e5}, options.give_up_s);
  object->number("motor_temp_c", kOptional, {"degC", -150.0, 150.0}, options.motor_temp_c);
  object->refuse_unknown();
}

}  // namespace

Result<campaign::DriveTable> read_campaign_table(std::string_view bytes, const std::filesystem::path& folder,
                                                 const Catalogue& catalogue) {
  const auto document = parse(bytes, {.bytes = 16U << 20U, .values = 1'000'000});
  if (!document) return fail(document.error());
  campaign::DriveTable table;
  std::vector<Fault> faults;
  ObjectReader reader(*document, "", faults);
  std::size_t format = 0;
  reader.choice("format", kRequired, {"campaign-table/1"}, format);
  reader.text("name", kRequired, {.most = 64, .is_name = true}, table.name);
  reader.text("summary", kRequired, {.most = 500}, table.summary);
  reader.texts("sources", kRequired, {0, 50}, {.most = 500}, table.sources);
  reader.texts("assumed", kOptional, {0, 50}, {.most = 500}, table.assumed);
  read_rover_name(reader, catalogue, table);
  read_effects(reader, table.effects);
  reader.number("gravity_m_s2", kRequired, {"m/s^2", 0.0, 30.0, true}, table.gravity_m_s2);
  reader.whole("seed", kOptional, std::uint64_t{0}, std::uint64_t{1} << 53U, table.seed);
  read_table_soils(reader, catalogue, table);
  reader.boolean("draw_soils", kOptional, table.draw_soils);
  read_simulation(reader, table.options);
  read_table_sensors(reader, table.sensors);
  table.terrains = read_table_terrains(reader, folder, table.soils);
  table.entries = read_table_drives(reader, table.terrains, table.rover ? *table.rover : sim::RoverModel{});
  reader.refuse_unknown();
  // What holds between the parts can only be asked of parts that were read.
  if (faults.empty()) faults = campaign::faults_of(table);
  if (!faults.empty()) return fail(ErrorCode::kInvalidRequest, summary_of(faults), faults);
  return table;
}

}  // namespace slipway::api::json
