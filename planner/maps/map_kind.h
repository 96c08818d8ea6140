#pragma once

#include <span>
#include <string_view>

namespace slipway::planner {

// What a map of the ground shows.
enum class MapKind {
  kSlipBest,
  kSlipWorst,
  kSlip,
  kStopRisk,
  kEmbeddingRisk,
  kVerdict,
  kBelief,
  kUnknown,
  kCostToGo,
  kReachable,
};

struct MapKindRow {
  MapKind kind;
  std::string_view name;         // as commands and requests have it
  std::string_view description;  // of the band
  std::string_view unit;         // "1": a ratio
  bool of_classes = false;
  bool takes_heading = false;  // may be asked for at one heading
  bool by_search = false;      // of ways to or from a place, not of each cell by itself
};

std::span<const MapKindRow> map_kinds();
const MapKindRow& row_of(MapKind kind);

// Values of the bytes of maps of classes. 0 is ground of which nothing is said, but on kBelief and kUnknown,
// whose nodata is 255.
namespace map_class {
inline constexpr int kNoElevation = 0;
inline constexpr int kGo = 1, kGoInSomeHeadings = 2, kVerdictUnknown = 3, kNoGo = 4;
inline constexpr int kReachable = 1, kReachableOverUnknown = 2, kNotReachable = 3;
inline constexpr int kKnownGround = 0, kUnknownGround = 1, kWithoutElevation = 2;
inline constexpr int kBeliefUnknown = 0;  // soils count from 1
inline constexpr int kNothing = 255;
}  // namespace map_class

}  // namespace slipway::planner
