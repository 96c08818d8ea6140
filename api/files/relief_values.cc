#include "api/files/relief_values.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <unordered_map>

namespace slipway::api {
namespace {

struct Field {
  std::string_view key;
  json::NumberRule rule;
  std::optional<double> ReliefValues::*value;
  double sim::ReliefSpread::*drawn;
};

constexpr std::array<Field, 7> kFields{{
    {"elevation_error_m",
     {"m", 0.0, 100.0},
     &ReliefValues::elevation_error_m,
     &sim::ReliefSpread::elevation_error_m},
    {"error_length_m",
     {"m", 0.1, 10000.0},
     &ReliefValues::error_length_m,
     &sim::ReliefSpread::error_length_m},
    {"roughness_m", {"m", 0.0, 1.0}, &ReliefValues::roughness_m, &sim::ReliefSpread::roughness_m},
    {"roughness_length_m",
     {"m", 0.05, 100.0},
     &ReliefValues::roughness_length_m,
     &sim::ReliefSpread::roughness_length_m},
    {"rock_share", json::kRockShareRule, &ReliefValues::rock_share, &sim::ReliefSpread::rock_share},
    {"min_rock_m", {"m", 0.05, 1.0}, &ReliefValues::min_rock_m, &sim::ReliefSpread::min_rock_m},
    {"max_rock_m", {"m", 0.05, 2.0}, &ReliefValues::max_rock_m, &sim::ReliefSpread::max_rock_m},
}};

}  // namespace

std::shared_ptr<const sim::ReliefSpread> relief_spread(const ReliefValues& terrain,
                                                       const ReliefValues& request, const Legend& legend,
                                                       const std::shared_ptr<const dem::SoilMap>& classes) {
  auto spread = std::make_shared<sim::ReliefSpread>();
  for (const Field& field : kFields)
    for (const ReliefValues* const values : {&terrain, &request})
      if (const std::optional<double>& value = values->*field.value) (*spread).*field.drawn = *value;
  if (!request.rock_share) {
    std::unordered_map<int, double> shares;
    for (const dem::SoilClass& row : legend.classes)
      if (row.rock_share) shares[row.value] = *row.rock_share;
    if (!shares.empty()) {
      const double elsewhere = spread->rock_share;
      for (const auto& [value, share] : shares) spread->rock_share = std::max(spread->rock_share, share);
      spread->rock_share_at = [shares, elsewhere, classes](double x_m, double y_m) {
        const auto value = classes->class_at(x_m, y_m);
        const auto found = value ? shares.find(*value) : shares.end();
        return found == shares.end() ? elsewhere : found->second;
      };
    }
  }
  if (spread->elevation_error_m <= 0.0 && spread->roughness_m <= 0.0 && spread->rock_share <= 0.0)
    return nullptr;
  return spread;
}

namespace json {

void read_relief(ObjectReader& reader, std::optional<ReliefValues>& relief) {
  auto object = reader.object("relief", kOptional);
  if (!object) return;
  relief.emplace();
  for (const Field& field : kFields) object->number(field.key, kOptional, field.rule, (*relief).*field.value);
  object->refuse_unknown();
}

void write_relief(Writer& w, const ReliefValues& relief) {
  w.key("relief").begin_object();
  for (const Field& field : kFields)
    if (const std::optional<double>& value = relief.*field.value) w.exact(field.key, *value);
  w.end_object();
}

void write_relief(Writer& w, const sim::ReliefSpread& relief) {
  w.key("relief").begin_object();
  for (const Field& field : kFields) w.exact(field.key, relief.*field.drawn);
  w.end_object();
}

}  // namespace json
}  // namespace slipway::api
