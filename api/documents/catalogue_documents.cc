#include "api/documents/catalogue_documents.h"

#include <charconv>
#include <cmath>

#include "api/files/rover_file.h"
#include "api/files/soil_file.h"
#include "api/json/writer.h"
#include "core/angle.h"
#include "core/error_code.h"
#include "core/utc.h"
#include "core/version.h"
#include "sim/effects/effect_catalogue.h"

namespace slipway::api::json {
namespace {

void write_field(Writer& w, const Field& field) {
  w.begin_object().text("name", field.name).text("unit", field.unit).text("summary", field.summary);
  w.exact("lowest", field.lowest).exact("highest", field.highest).exact("initial", field.initial);
  if (field.neutral) w.exact("neutral", *field.neutral);
  w.end_object();
}

// A table's cell as a number where it is one.
void write_cell(Writer& w, const std::string& cell) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (error == std::errc() && end == cell.data() + cell.size() && std::isfinite(number)) {
    w.exact(number);
  } else {
    w.text(cell);
  }
}

void write_extent(Writer& w, const dem::Extent& extent) {
  w.key("extent").begin_object().exact("west_m", extent.west_m).exact("south_m", extent.south_m);
  w.exact("east_m", extent.east_m).exact("north_m", extent.north_m).end_object();
}

void write_legend(Writer& w, const Legend& legend) {
  w.text("assumption", legend.assumption).exact("confidence", legend.confidence).key("legend").begin_array();
  for (const dem::SoilClass& entry : legend.classes) {
    w.begin_object().whole("value", entry.value).text("label", entry.label).key("soil");
    if (entry.soil) {
      w.text(*entry.soil);
    } else {
      w.null();
    }
    w.end_object();
  }
  w.end_array();
}

void write_soil_source(Writer& w, const TerrainDescription& terrain) {
  w.key("soil").begin_object();
  w.text("source", terrain.soil_source == SoilSource::kRaster     ? "raster"
                   : terrain.soil_source == SoilSource::kPolygons ? "polygons"
                                                                  : "none");
  w.text("unknown_soil", unknown_ground_at(terrain.gravity_m_s2))
      .text("legend_name", terrain.legends.front().name);
  write_legend(w, terrain.legends.front());
  w.key("other_legends").begin_array();
  for (std::size_t l = 1; l < terrain.legends.size(); ++l) {
    w.begin_object().text("name", terrain.legends[l].name);
    write_legend(w, terrain.legends[l]);
    w.end_object();
  }
  w.end_array().end_object();
}

void write_campaign(Writer& w, const ShippedCampaign& campaign) {
  w.text("name", campaign.name).text("rover", campaign.rover);
  w.exact("gravity_m_s2", campaign.gravity_m_s2);
  w.texts("soils", campaign.soils).texts("terrains", campaign.terrains);
  w.key("drives").begin_array();
  for (const gap::MeasuredDriveSeries& drive : campaign.drives) {
    w.begin_object().text("id", drive.id).text("terrain", campaign.terrains.at(drive.terrain));
    w.exact("duration_s", drive.duration_s).exact("speed_m_s", drive.command.speed_m_s);
    if (drive.repeat_of) w.text("repeat_of", *drive.repeat_of);
    w.end_object();
  }
  w.end_array();
}

void write_origin(Writer& w, const UploadOrigin& origin) {
  w.text("sent_at", utc_text(origin.at_ms));
  if (!origin.from.empty()) w.text("upload", origin.from);
  if (!origin.follows.empty()) w.text("follows", origin.follows);
}

}  // namespace

void write_terrain(Writer& w, const TerrainSite& site) {
  const TerrainDescription& terrain = site.description();
  const dem::ElevationInfo& info = site.info();
  w.begin_object().text("name", terrain.name).text("title", terrain.title);
  w.text("version", site.version());
  write_extent(w, info.geometry.extent());
  w.exact("cell_x_m", info.geometry.cell_x_m).exact("cell_y_m", info.geometry.cell_y_m);
  w.whole("rows", info.geometry.rows).whole("columns", info.geometry.columns);
  w.text("crs_name", info.crs_name).text("crs_wkt", info.crs_wkt).text("body", info.body);
  w.exact("semi_major_axis_m", info.semi_major_axis_m).exact("gravity_m_s2", terrain.gravity_m_s2);
  write_soil_source(w, terrain);
  w.key("stops").begin_array();
  for (const Stop& stop : site.stops()) {
    w.begin_object().exact("x_m", stop.x_m).exact("y_m", stop.y_m).key("columns").begin_object();
    for (const auto& [name, cell] : stop.columns) {
      w.key(name);
      write_cell(w, cell);
    }
    w.end_object().end_object();
  }
  w.end_array().end_object();
}

std::string write_terrains(const Catalogue& catalogue) {
  Writer w;
  w.begin_object().key("terrains").begin_array();
  for (const auto& [name, site] : catalogue.terrains) write_terrain(w, *site);
  w.end_array().end_object();
  return w.take();
}

std::string write_rovers(const Catalogue& catalogue) {
  Writer w;
  w.begin_object().key("rovers").begin_array();
  for (const auto& [name, rover] : catalogue.rovers) write_rover(w, *rover);
  w.end_array().end_object();
  return w.take();
}

std::string write_rules(const Catalogue& catalogue) {
  Writer w;
  w.begin_object().key("rules").begin_array();
  for (const auto& [name, set] : catalogue.rules) {
    w.begin_object().text("name", name).text("summary", set.summary).text("source", set.source);
    write_drive_rules(w, set.rules);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take();
}

std::string write_soils(const Catalogue& catalogue) {
  Writer w;
  w.begin_object().text("unknown_soil", kUnknownGround).key("soils").begin_array();
  for (const auto& [name, soil] : catalogue.soils) write_soil(w, soil, *catalogue.soil_format);
  w.end_array().end_object();
  return w.take();
}

std::string write_effects() {
  Writer w;
  w.begin_object().key("effects").begin_array();
  for (const sim::Effect& effect : sim::effect_catalogue()) {
    w.begin_object()
        .text("name", effect.name)
        .text("summary", effect.summary)
        .text("reference", effect.reference);
    w.key("parameters").begin_array();
    for (const Field& field : effect.fields) write_field(w, field);
    w.end_array().end_object();
  }
  w.end_array().end_object();
  return w.take();
}

std::string write_planners(std::span<const planner::PlannerRow> planners,
                           std::span<const planner::CostTerm> costs) {
  Writer w;
  w.begin_object().key("planners").begin_array();
  for (const planner::PlannerRow& row : planners) {
    w.begin_object().text("name", row.name).text("summary", row.summary).text("reference", row.reference);
    w.boolean("in_default_set", row.in_default_set).end_object();
  }
  w.end_array().key("cost_terms").begin_array();
  for (const planner::CostTerm& term : costs) {
    w.begin_object()
        .text("name", term.name)
        .text("summary", term.summary)
        .text("unit", term.unit)
        .key("weight");
    write_field(w, term.weight);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take();
}

std::string write_drive_campaigns(const std::vector<ShippedCampaign>& campaigns,
                                  const std::vector<UploadedCampaign>& sent) {
  Writer w;
  w.begin_object().key("campaigns").begin_array();
  for (const ShippedCampaign& campaign : campaigns) {
    if (campaign.rover.empty()) continue;  // at fault: it cannot be diagnosed
    w.begin_object();
    write_campaign(w, campaign);
    w.end_object();
  }
  for (const UploadedCampaign& one : sent) {
    if (one.campaign.rover.empty()) continue;
    w.begin_object();
    write_campaign(w, one.campaign);
    write_origin(w, one.origin);
    w.end_object();
  }
  w.end_array().end_object();
  return w.take();
}

std::string write_campaign_taken(const CampaignTaken& taken) {
  Writer w;
  w.begin_object();
  write_campaign(w, taken.campaign);
  write_origin(w, taken.origin);
  w.texts("notes", taken.notes).end_object();
  return w.take();
}

std::string write_errors() {
  Writer w;
  w.begin_object().key("errors").begin_array();
  for (const ErrorRow& row : error_table()) {
    w.begin_object()
        .text("name", row.name)
        .whole("status", row.http_status)
        .text("help", row.help)
        .end_object();
  }
  w.end_array().end_object();
  return w.take();
}

std::string write_ground_at(const GroundAt& at) {
  Writer w;
  w.begin_object().metres("x_m", at.x_m).metres("y_m", at.y_m).metres("height_m", at.height_m);
  w.significant("slope_deg", deg_from_rad(at.slope_rad))
      .significant("aspect_deg", deg_from_rad(at.aspect_rad));
  if (at.roughness_m) w.significant("roughness_m", *at.roughness_m);
  w.exact("roughness_radius_m", at.roughness_radius_m);
  if (at.label) w.text("label", *at.label);
  w.key("soil");
  if (at.soil) {
    w.text(*at.soil);
  } else {
    w.null();
  }
  w.end_object();
  return w.take();
}

std::string write_health() {
  Writer w;
  w.begin_object().text("status", "ok").text("version", version()).end_object();
  return w.take();
}

}  // namespace slipway::api::json
