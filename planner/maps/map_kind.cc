#include "planner/maps/map_kind.h"

#include <array>

namespace slipway::planner {

std::span<const MapKindRow> map_kinds() {
  static constexpr std::array<MapKindRow, 10> kRows{{
      {MapKind::kSlipBest, "slip_best", "size of the slip ratio in the heading that slips least", "1"},
      {MapKind::kSlipWorst, "slip_worst", "size of the slip ratio in the heading that slips most", "1"},
      {.kind = MapKind::kSlip,
       .name = "slip",
       .description = "slip ratio at the heading",
       .unit = "1",
       .takes_heading = true},
      {.kind = MapKind::kStopRisk,
       .name = "stop_risk",
       .description = "probability that a drive of the distance is stopped",
       .unit = "1",
       .takes_heading = true},
      {.kind = MapKind::kEmbeddingRisk,
       .name = "embedding_risk",
       .description = "probability that a drive of the distance ends embedded",
       .unit = "1",
       .takes_heading = true},
      {.kind = MapKind::kVerdict,
       .name = "verdict",
       .description = "verdict on a drive of the distance",
       .unit = "",
       .of_classes = true,
       .takes_heading = true},
      {.kind = MapKind::kBelief,
       .name = "belief",
       .description = "soil that the ground is believed to be",
       .unit = "",
       .of_classes = true},
      {.kind = MapKind::kUnknown,
       .name = "unknown",
       .description = "ground whose soil or elevation no map names",
       .unit = "",
       .of_classes = true},
      {.kind = MapKind::kCostToGo,
       .name = "cost_to_go",
       .description = "cost of the cheapest way on the grid from here to the place",
       .unit = "1",
       .by_search = true},
      {.kind = MapKind::kReachable,
       .name = "reachable",
       .description = "whether the budget takes the rover here",
       .unit = "",
       .of_classes = true,
       .by_search = true},
  }};
  return kRows;
}

const MapKindRow& row_of(MapKind kind) {
  return map_kinds()[static_cast<std::size_t>(kind)];
}

}  // namespace slipway::planner
