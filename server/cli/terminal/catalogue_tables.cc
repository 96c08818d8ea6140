#include <fmt/format.h>

#include <string>
#include <vector>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "api/report/report_words.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::has;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

Result<JsonValue> parsed_catalogue(std::string_view document) {
  return api::json::parse(document, {.bytes = document.size(), .values = document.size()});
}

Result<std::string> catalogue_table(std::string_view document, std::string_view key,
                                    std::vector<std::string> header,
                                    std::vector<std::string> (*row)(const JsonValue&)) {
  const auto parsed = parsed_catalogue(document);
  if (!parsed) return fail(parsed.error());
  TextTable table(std::move(header));
  for (const JsonValue& entry : at(*parsed, key).elements) table.add(row(entry));
  return table.print();
}

}  // namespace

Result<std::string> terrain_table(std::string_view document) {
  return catalogue_table(document, "terrains", {"terrain", "size", "cell", "gravity", "stops", "title"},
                         [](const JsonValue& t) {
                           const JsonValue& e = at(t, "extent");
                           return std::vector<std::string>{
                               text(t, "name"),
                               fmt::format("{:.0f} x {:.0f} m", number(e, "east_m") - number(e, "west_m"),
                                           number(e, "north_m") - number(e, "south_m")),
                               fmt::format("{:g} m", number(t, "cell_x_m")),
                               fmt::format("{:g} m/s2", number(t, "gravity_m_s2")),
                               fmt::format("{}", at(t, "stops").elements.size()),
                               text(t, "title")};
                         });
}

Result<std::string> rover_table(std::string_view document) {
  return catalogue_table(
      document, "rovers", {"rover", "mass", "speed", "steepest", "summary"}, [](const JsonValue& r) {
        return std::vector<std::string>{text(r, "name"), fmt::format("{:g} kg", number(r, "mass_kg")),
                                        fmt::format("{:g} m/s", number(r, "cruise_speed_m_s")),
                                        fmt::format("{:g} deg", number(r, "max_tilt_deg")),
                                        text(r, "summary")};
      });
}

namespace {

// "reece", and "k_c = 12, k_phi = 900".
std::string law_parameters(const JsonValue& law) {
  std::string out;
  for (std::size_t i = 0; i < law.keys.size(); ++i)
    if (law.keys[i] != "name")
      out += fmt::format("{}{} = {:g}", out.empty() ? "" : ", ", law.keys[i], law.elements[i].number);
  return out;
}

std::vector<std::string> soil_row(const JsonValue& s) {
  if (const JsonValue* curve = s.find("slip_curve")) {
    const auto& slopes = at(*curve, "slope_deg").elements;
    return {text(s, "name"),
            "slip curve",
            fmt::format("{:g} to {:g} deg", slopes.front().number, slopes.back().number),
            "-",
            "-",
            "-",
            "-",
            text(s, "source")};
  }
  const JsonValue* pressure = s.find("pressure_law");
  const JsonValue* shear = s.find("shear_law");
  return {text(s, "name"),
          pressure ? text(*pressure, "name") : fmt::format("{:g}", number(s, "k_c")),
          pressure ? law_parameters(*pressure) : fmt::format("{:g}", number(s, "k_phi")),
          fmt::format("{:g}", number(s, "n")),
          fmt::format("{:g} Pa", number(s, "cohesion_pa")),
          fmt::format("{:g} deg", number(s, "friction_angle_deg")),
          fmt::format("{:g} m", number(s, "shear_modulus_x_m")) +
              (shear ? fmt::format(" ({}: {})", text(*shear, "name"), law_parameters(*shear)) : ""),
          text(s, "source")};
}

}  // namespace

Result<std::string> soil_table(std::string_view document) {
  return catalogue_table(document, "soils",
                         {"soil", "k_c", "k_phi", "n", "cohesion", "friction", "K", "source"}, &soil_row);
}

Result<std::string> effect_table(std::string_view document) {
  auto table =
      catalogue_table(document, "effects", {"effect", "what it is", "parameters"}, [](const JsonValue& e) {
        std::string parameters;
        for (const JsonValue& p : at(e, "parameters").elements)
          parameters += fmt::format("{}{} = {:g} [{:g}, {:g}]{}", parameters.empty() ? "" : "; ",
                                    text(p, "name"), number(p, "initial"), number(p, "lowest"),
                                    number(p, "highest"), api::unit_words(text(p, "unit")));
        return std::vector<std::string>{text(e, "name"), text(e, "summary"), parameters};
      });
  if (table)
    *table +=
        "slipway effects NAME explains the parameters of one effect: unit, default, range and meaning\n";
  return table;
}

Result<std::string> effect_field_table(std::string_view document) {
  const auto parsed = parsed_catalogue(document);
  if (!parsed) return fail(parsed.error());
  std::string out;
  for (const JsonValue& e : at(*parsed, "effects").elements) {
    const std::vector<JsonValue>& parameters = at(e, "parameters").elements;
    out +=
        fmt::format("{}: {}\ndescribed by: {}\n", text(e, "name"), text(e, "summary"), text(e, "reference"));
    TextTable table({"parameter", "unit", "default", "lowest", "highest", "no effect at", "meaning"});
    for (const JsonValue& p : parameters)
      table.add({text(p, "name"), text(p, "unit") == "1" ? "-" : text(p, "unit"),
                 fmt::format("{:g}", number(p, "initial")), fmt::format("{:g}", number(p, "lowest")),
                 fmt::format("{:g}", number(p, "highest")),
                 has(p, "neutral") ? fmt::format("{:g}", number(p, "neutral")) : "-", text(p, "summary")});
    out += "\n" + table.print();
    if (!parameters.empty())
      out += fmt::format(
          "\nIt is switched on with --effect {}, or with other values of its parameters as in\n"
          "  --effect {}:{}={:g}\n",
          text(e, "name"), text(e, "name"), text(parameters.front(), "name"),
          number(parameters.front(), "initial"));
  }
  return out;
}

}  // namespace slipway::server
