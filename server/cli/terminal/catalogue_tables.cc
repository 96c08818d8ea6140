#include <fmt/format.h>

#include <string>
#include <vector>

#include "api/json/lookup.h"
#include "api/json/parse.h"
#include "server/cli/terminal/tables.h"
#include "server/cli/terminal/text_table.h"

namespace slipway::server {
namespace {

using api::json::at;
using api::json::JsonValue;
using api::json::number;
using api::json::text;

Result<std::string> catalogue_table(std::string_view document, std::string_view key,
                                    std::vector<std::string> header,
                                    std::vector<std::string> (*row)(const JsonValue&)) {
  const auto parsed = api::json::parse(document, {.bytes = document.size(), .values = document.size()});
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
  return catalogue_table(document, "effects", {"effect", "what it is", "parameters"}, [](const JsonValue& e) {
    std::string parameters;
    for (const JsonValue& p : at(e, "parameters").elements)
      parameters += fmt::format("{}{} = {:g} [{:g}, {:g}]{}", parameters.empty() ? "" : "; ", text(p, "name"),
                                number(p, "initial"), number(p, "lowest"), number(p, "highest"),
                                text(p, "unit") == "1" ? "" : " " + text(p, "unit"));
    return std::vector<std::string>{text(e, "name"), text(e, "summary"), parameters};
  });
}

}  // namespace slipway::server
