#include "api/maps/map_layer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "api/documents/drive_assumptions.h"
#include "api/maps/map_documents.h"
#include "core/angle.h"
#include "core/version.h"
#include "planner/maps/cell_map.h"

namespace slipway::api {
namespace {

using ClassColour = std::array<std::uint8_t, 3>;
using planner::MapKind;
namespace classes = planner::map_class;

dem::RasterClass class_row(int value, std::string name, ClassColour colour) {
  return {static_cast<std::uint8_t>(value), std::move(name), colour};
}

constexpr ClassColour kClassGreen{26, 152, 80}, kClassYellow{254, 224, 139}, kClassGrey{150, 150, 150},
    kClassRed{215, 48, 39}, kClassBlue{69, 117, 180};

// Soils one after the other; after the tenth the colours come again.
constexpr std::array<ClassColour, 10> kSoilColours{{{166, 206, 227},
                                                    {178, 223, 138},
                                                    {251, 154, 153},
                                                    {253, 191, 111},
                                                    {202, 178, 214},
                                                    {255, 255, 153},
                                                    {31, 120, 180},
                                                    {51, 160, 44},
                                                    {177, 89, 40},
                                                    {106, 61, 154}}};

std::vector<dem::RasterClass> classes_of(const MapRequest& request, const Provenance& provenance) {
  switch (request.kind) {
    case MapKind::kVerdict: {
      std::vector<dem::RasterClass> rows{class_row(classes::kGo, "GO", kClassGreen)};
      if (!request.heading_rad)
        rows.push_back(class_row(classes::kGoInSomeHeadings, "GO in some headings only", kClassYellow));
      rows.push_back(
          class_row(classes::kVerdictUnknown, "UNKNOWN: the draws of the ground do not decide", kClassGrey));
      rows.push_back(class_row(classes::kNoGo, "NO-GO", kClassRed));
      return rows;
    }
    case MapKind::kReachable:
      return {
          class_row(classes::kReachable, "reachable", kClassGreen),
          class_row(classes::kReachableOverUnknown, "reachable by a way over unknown ground", kClassYellow),
          class_row(classes::kNotReachable, "not reachable", kClassRed)};
    case MapKind::kUnknown:
      return {class_row(classes::kKnownGround, "mapped soil", kClassBlue),
              class_row(classes::kUnknownGround, "unknown ground: no map names the soil", kClassYellow),
              class_row(classes::kWithoutElevation, "no elevation", kClassRed)};
    case MapKind::kBelief: {
      std::vector<dem::RasterClass> rows{class_row(classes::kBeliefUnknown, "unknown ground", kClassGrey)};
      for (std::size_t i = 0; i < provenance.soils.size() && i < 250; ++i)
        rows.push_back(
            class_row(static_cast<int>(i) + 1, provenance.soils[i], kSoilColours[i % kSoilColours.size()]));
      return rows;
    }
    default:
      return {};
  }
}

std::string unit_of_cost(const MapRequest& request) {
  std::string terms;
  for (std::size_t i = 0; i < request.weights.terms().size(); ++i)
    terms += fmt::format("{}{} {} x {}", i == 0 ? "" : " + ", request.weights[i],
                         request.weights.terms()[i].weight.unit, request.weights.terms()[i].name);
  return terms;
}

void add_ways(const MapRequest& request, dem::RasterLayer& layer) {
  auto& metadata = layer.metadata;
  if (request.place)
    metadata.emplace_back(request.kind == MapKind::kCostToGo ? "SLIPWAY_TO" : "SLIPWAY_FROM",
                          fmt::format("{},{}", request.place->x_m, request.place->y_m));
  if (request.budget_j) metadata.emplace_back("SLIPWAY_BUDGET_J", fmt::format("{}", *request.budget_j));
  if (request.budget_sols)
    metadata.emplace_back("SLIPWAY_BUDGET_SOLS", fmt::format("{}", *request.budget_sols));
  if (request.budget_sols)
    metadata.emplace_back("SLIPWAY_DRIVING_HOURS_PER_SOL", fmt::format("{}", request.driving_hours_per_sol));
  metadata.emplace_back("SLIPWAY_COST", unit_of_cost(request));
}

}  // namespace

dem::RasterLayer map_layer(const MapRequest& request, const Provenance& provenance,
                           const planner::PlanProblem& problem, const MapSources& sources,
                           const dem::GridGeometry& geometry, const std::string& crs_wkt) {
  const planner::MapKindRow& kind = planner::row_of(request.kind);
  dem::RasterLayer layer{.geometry = geometry,
                         .crs_wkt = crs_wkt,
                         .of_classes = kind.of_classes,
                         .nodata = planner::kNoMapValue,
                         .description = std::string(kind.description),
                         .unit = std::string(kind.unit)};
  layer.classes = classes_of(request, provenance);
  const bool of_soil = request.kind == MapKind::kBelief || request.kind == MapKind::kUnknown;
  if (kind.of_classes) layer.nodata = of_soil ? classes::kNothing : classes::kNoElevation;
  if (of_soil) layer.coarser = dem::Coarser::kCommonest;
  auto& metadata = layer.metadata;
  metadata = {{"TIFFTAG_SOFTWARE", fmt::format("slipway {}", version())},
              {"SLIPWAY_KIND", std::string(kind.name)},
              {"SLIPWAY_TERRAIN", request.terrain},
              {"SLIPWAY_ELEVATION_SHA256", sources.elevation_sha256},
              {"SLIPWAY_BODY", provenance.body},
              {"SLIPWAY_LEGEND", provenance.legend},
              {"SLIPWAY_SOILS", fmt::format("{}", fmt::join(provenance.soils, ","))},
              {"SLIPWAY_UNKNOWN_SOIL", provenance.unknown_soil}};
  if (!sources.soil_sha256.empty()) metadata.emplace_back("SLIPWAY_SOIL_SHA256", sources.soil_sha256);
  if (!provenance.soil_assumption.empty())
    metadata.emplace_back("SLIPWAY_SOIL_ASSUMPTION", provenance.soil_assumption);
  if (of_soil) return layer;
  metadata.emplace_back("SLIPWAY_ROVER", request.rover);
  metadata.emplace_back("SLIPWAY_GRAVITY_M_S2", fmt::format("{}", provenance.gravity_m_s2));
  metadata.emplace_back("SLIPWAY_MAX_TILT_DEG", fmt::format("{:g}", deg_from_rad(problem.max_tilt_rad())));
  metadata.emplace_back("SLIPWAY_MAX_SLIP", fmt::format("{}", problem.limits.max_slip_ratio));
  if (kind.by_search) {
    add_ways(request, layer);
    return layer;
  }
  metadata.emplace_back("SLIPWAY_HEADING", request.heading_rad
                                               ? fmt::format("{:g} deg counter-clockwise from east",
                                                             deg_from_rad(*request.heading_rad))
                                               : std::string("all headings; of risks the worst"));
  if (request.kind != MapKind::kVerdict)
    metadata.emplace_back("SLIPWAY_UNKNOWN_GROUND", request.price_unknown ? "by its belief" : "nodata");
  const bool of_distance = request.kind == MapKind::kStopRisk || request.kind == MapKind::kEmbeddingRisk ||
                           request.kind == MapKind::kVerdict;
  if (of_distance) {
    metadata.emplace_back("SLIPWAY_DISTANCE_M", fmt::format("{}", request.distance_m));
    layer.description += fmt::format(" ({:g} m)", request.distance_m);
  }
  if (request.kind == MapKind::kVerdict) {
    metadata.emplace_back("SLIPWAY_MAX_EMBEDDING", fmt::format("{}", problem.risk.bars.max_embedding));
    metadata.emplace_back("SLIPWAY_MAX_STOP", fmt::format("{}", problem.risk.bars.max_stop));
  }
  return layer;
}

void add_statistics(const MapStatistics& statistics, dem::RasterLayer& layer) {
  const double valid = statistics.cells > 0
                           ? 100.0 * static_cast<double>(statistics.cells - statistics.nodata) /
                                 static_cast<double>(statistics.cells)
                           : 0.0;
  if (!layer.of_classes && statistics.nodata < statistics.cells) {
    layer.band_metadata.emplace_back("STATISTICS_MINIMUM", fmt::format("{:.9g}", statistics.lowest));
    layer.band_metadata.emplace_back("STATISTICS_MAXIMUM", fmt::format("{:.9g}", statistics.highest));
    layer.band_metadata.emplace_back("STATISTICS_MEAN", fmt::format("{:.9g}", statistics.mean));
  }
  layer.band_metadata.emplace_back("STATISTICS_VALID_PERCENT", fmt::format("{:.4g}", valid));
}

}  // namespace slipway::api
