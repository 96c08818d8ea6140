#include <fmt/format.h>

#include <array>
#include <cmath>

#include "gap/diagnosis/model/outside_cause_rows.h"
#include "gap/diagnosis/model/window_model.h"

namespace slipway::gap {
namespace {

using Values = OutsideValues;

// Prior deviation: a tenth is what a few per cent of water or a warm day do to the strength of a soil.
constexpr double kStrengthShare = 0.1;

// One drive can't tell a drift from the soil's own strength, two not from a difference between them.
std::vector<sim::EffectVariant> drifts(const DriveCampaign& campaign) {
  constexpr std::size_t kMinDrives = 3;
  if (campaign.drives.size() < kMinDrives) return {};
  std::vector<sim::EffectVariant::Free> free;
  for (const char* field : {"last_share", "middle_share"})
    free.push_back({.field = field, .std = kStrengthShare, .lowest = -0.6, .highest = 0.6});
  return {outside_variant(std::move(free))};
}

// Over several terrains nobody can say where one lies beside the other.
template <const auto& Fields, bool OverMap>
std::vector<sim::EffectVariant> changes(const DriveCampaign& campaign) {
  if (OverMap && campaign.terrains.size() > 1) return {};
  std::vector<sim::EffectVariant::Free> free;
  for (const char* field : Fields)
    free.push_back({.field = field, .std = kStrengthShare, .lowest = -0.45, .highest = 0.45});
  return {outside_variant(std::move(free))};
}
constexpr std::array kEnd{"end_share"};
constexpr std::array kOver{"x_share", "y_share"};

void drift(const Values& values, ModelState& state) {
  state.soil_drift.last += values.at("last_share");
  state.soil_drift.middle += values.at("middle_share");
}

std::string percent(double share) {
  return fmt::format("{:.1f} % {}", 100.0 * std::abs(share), share < 0.0 ? "weaker" : "stronger");
}

std::string drift_words(const Values& v, const DriveCampaign& /*campaign*/) {
  const double last = v.at("last_share"), middle = 0.5 * last + v.at("middle_share");
  return fmt::format(
      "the soils' strength changes from drive to drive: {} in the middle and {} at the end than in the first "
      "drive",
      percent(middle), percent(last));
}

std::string along_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format("the soils' strength changes along each drive: {} at its end than at its start",
                     percent(2.0 * v.at("end_share")));
}

std::string over_words(const Values& v, const DriveCampaign& /*campaign*/) {
  return fmt::format(
      "the soils' strength changes over the map: {} at the greatest x than at the least, {} at the greatest "
      "y "
      "than at the least",
      percent(2.0 * v.at("x_share")), percent(2.0 * v.at("y_share")));
}

constexpr std::array kSoilRows{
    OutsideCause{.name = "soil_along_drive",
                 .form = "smooth_function",
                 .entry = "soil_strength",
                 .depends = "along",
                 .unit = "1",
                 .variants = &changes<kEnd, false>,
                 .act = [](const Values& v, ModelState& s) { s.soil_drift.end += v.at("end_share"); },
                 .words = &along_words,
                 .has_shape = false},
    OutsideCause{
        .name = "soil_over_map",
        .form = "smooth_function",
        .entry = "soil_strength",
        .depends = "place",
        .unit = "1",
        .variants = &changes<kOver, true>,
        .act = [](const Values& v,
                  ModelState& s) { s.soil_drift.over += Eigen::Vector2d(v.at("x_share"), v.at("y_share")); },
        .words = &over_words,
        .has_shape = false},
    OutsideCause{.name = "soil_drift",
                 .form = "smooth_function",
                 .entry = "soil_strength",
                 .depends = "order",
                 .unit = "1",
                 .variants = &drifts,
                 .act = &drift,
                 .words = &drift_words,
                 .has_shape = false}};

}  // namespace

std::span<const OutsideCause> outside_soil_rows() {
  return kSoilRows;
}

}  // namespace slipway::gap
