#include "api/export/station_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "api/documents/soil/wheel_sweep_answer.h"
#include "api/json/lookup.h"
#include "api/json/parse.h"

namespace slipway::api::json {
namespace {

// Columns that stand in the document as they are.
constexpr std::array<std::string_view, 26> kColumns{"distance_m",
                                                    "x_m",
                                                    "y_m",
                                                    "height_m",
                                                    "yaw_deg",
                                                    "pitch_deg",
                                                    "roll_deg",
                                                    "tilt_deg",
                                                    "clearance_m",
                                                    "soil",
                                                    "on_unknown_ground",
                                                    "slip",
                                                    "slip_p05",
                                                    "slip_p50",
                                                    "slip_p95",
                                                    "sinkage_m_p95",
                                                    "current_a_p95",
                                                    "expected_stops",
                                                    "embedding",
                                                    "risk",
                                                    "elapsed_s",
                                                    "power_w",
                                                    "tilt_deg_p05",
                                                    "tilt_deg_p95",
                                                    "clearance_m_p05",
                                                    "clearance_m_p95"};
// What is made of others: of the deepest and the hottest wheel on the mean soils, and the energy up to there.
constexpr std::array<std::string_view, 3> kMade{"sinkage_m", "current_a", "energy_wh"};

std::string cell_of(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::kNumber:
      return fmt::format("{}", value.number);
    case JsonValue::Kind::kBoolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::kString:
      return csv_field(value.text);
    default:
      return {};
  }
}

// The largest size over the wheels; nothing where it is not known.
std::optional<double> largest_of(const JsonValue& wheels, std::string_view key, std::size_t station) {
  std::optional<double> largest;
  for (const JsonValue& wheel : wheels.elements) {
    const JsonValue& value = at(wheel, key).elements.at(station);
    if (!value.is(JsonValue::Kind::kNumber)) return std::nullopt;
    largest = std::max(largest.value_or(0.0), std::abs(value.number));
  }
  return largest;
}

class Rows {
 public:
  // The energy is a sum over all stations.
  explicit Rows(const JsonValue& stations)
      : stations_(stations), known_(stations.find("thinned_from") == nullptr) {}

  std::string row(std::size_t k) {
    std::string line;
    for (const std::string_view column : kColumns)
      line += (line.empty() ? "" : ",") + cell_of(at(stations_, column).elements.at(k));
    const JsonValue& wheels = at(stations_, "wheels");
    for (const auto& made :
         {largest_of(wheels, "sinkage_m", k), largest_of(wheels, "current_a", k), energy_wh(k)})
      line += made ? fmt::format(",{:.6g}", *made) : ",";
    return line + "\n";
  }

 private:
  // Sums the power of each station's part of the way, as the prediction does.
  std::optional<double> energy_wh(std::size_t k) {
    const JsonValue& power_w = at(stations_, "power_w").elements.at(k);
    const double elapsed_s = at(stations_, "elapsed_s").elements.at(k).number;
    if (!power_w.is(JsonValue::Kind::kNumber)) known_ = false;
    constexpr double kSecondsPerHour = 3600.0;
    energy_wh_ += power_w.number * (elapsed_s - before_s_) / kSecondsPerHour;
    before_s_ = elapsed_s;
    return known_ ? std::optional<double>(energy_wh_) : std::nullopt;
  }

  const JsonValue& stations_;
  double energy_wh_ = 0.0, before_s_ = 0.0;
  bool known_;
};

}  // namespace

Result<std::string> station_csv(std::string_view document) {
  const auto parsed = parse(document, {.bytes = document.size(), .values = document.size()});
  if (!parsed) return fail(parsed.error());
  const bool is_plan = text(*parsed, "format") == "plan/1";
  std::string csv = is_plan ? "route," : "";
  for (const std::string_view column : kColumns) csv += fmt::format("{},", column);
  csv += fmt::format("{},{},{}\n", kMade[0], kMade[1], kMade[2]);
  std::size_t written = 0;
  for (const JsonValue& feature : at(at(*parsed, "routes"), "features").elements) {
    const JsonValue& stations = at(at(feature, "properties"), "stations");
    const auto count = static_cast<std::size_t>(number(stations, "count"));
    Rows rows(stations);
    for (std::size_t k = 0; k < count; ++k) {
      if (is_plan) csv += fmt::format("{:.0f},", number(feature, "id"));
      csv += rows.row(k);
      ++written;
    }
  }
  if (written == 0) return fail(ErrorCode::kNoData, "the answer has no stations");
  return csv;
}

bool is_thinned(std::string_view document) {
  return has_stations(document) && document.find(R"(,"thinned_from":)") != std::string_view::npos;
}

bool has_stations(std::string_view document) {
  constexpr std::array<std::string_view, 3> kFormats{R"({"format":"check/1")", R"({"format":"prediction/1")",
                                                     R"({"format":"plan/1")"};
  return std::any_of(kFormats.begin(), kFormats.end(),
                     [&](std::string_view format) { return document.starts_with(format); });
}

}  // namespace slipway::api::json
