#include "server/cli/commands/sky_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "api/departure_setting.h"
#include "api/documents/departure.h"
#include "api/files/catalogue.h"
#include "api/json/writer.h"
#include "api/place_sky.h"
#include "api/requests/plan_request.h"
#include "core/angle.h"
#include "core/utc.h"
#include "dem/horizon/horizon.h"
#include "dem/write/horizon_map.h"
#include "server/cli/inquiry/command_parts.h"
#include "server/cli/inquiry/data_folder.h"
#include "server/cli/inquiry/data_option.h"
#include "server/cli/inquiry/kernel_files.h"
#include "server/cli/terminal/terminal_progress.h"

namespace slipway::server {
namespace {

// Where the question is asked: degrees for the sky, a terrain for the horizon.
struct Place {
  std::optional<dem::MapPlace> degrees = {};
  std::shared_ptr<const api::TerrainSite> site = {};
};

Result<Place> place_of(const SkyOptions& options) {
  Place place;
  if (!options.lonlat.empty()) {
    dem::MapPlace degrees;
    char end = 0;
    if (std::sscanf(options.lonlat.c_str(), "%lf,%lf%c", &degrees.x, &degrees.y, &end) != 2 ||
        !(std::abs(degrees.y) <= 90.0) || !(std::abs(degrees.x) <= 360.0))
      return fail(
          ErrorCode::kInvalidRequest,
          fmt::format("--lonlat {} is no longitude,latitude in degrees such as 137.4,-4.6", options.lonlat));
    place.degrees = degrees;
  }
  if (options.terrain.empty()) return place;
  const auto folder = data_folder(options.data);
  if (!folder) return fail(folder.error());
  const auto catalogue = api::load_catalogue(*folder);
  if (!catalogue) return fail(catalogue.error());
  const auto found = catalogue->terrains.find(options.terrain);
  if (found == catalogue->terrains.end())
    return fail(ErrorCode::kInvalidRequest, api::unknown_terrain(*catalogue, options.terrain));
  place.site = found->second;
  const dem::ElevationInfo& info = place.site->info();
  const dem::Extent extent = info.geometry.extent();
  if (place.degrees || (options.sky.empty() && api::why_no_sky(*place.site))) return place;
  const dem::MapPlace on_map = options.place ? dem::MapPlace{options.place->x_m, options.place->y_m}
                                             : dem::MapPlace{0.5 * (extent.west_m + extent.east_m),
                                                             0.5 * (extent.south_m + extent.north_m)};
  place.degrees = place.site->degrees_at(on_map);
  return place;
}

struct Answer {
  std::int64_t utc_ms = 0;
  Place place;
  std::optional<std::vector<double>> horizon_rad = {};
  std::string body = {};                                  // of what kernels say:
  std::optional<sky::SkySample> by_kernels = {};          // at that time
  std::optional<std::vector<sky::SkySample>> table = {};  // from then on
};

using Bearings = std::initializer_list<std::pair<std::string_view, sky::Bearing>>;

std::string bearing_lines(const Bearings& bearings) {
  std::string out;
  for (const auto& [name, bearing] : bearings)
    out += fmt::format("{}: azimuth {:.2f} deg, elevation {:.2f} deg\n", name,
                       deg_from_rad(bearing.azimuth_rad), deg_from_rad(bearing.elevation_rad));
  return out;
}

// What kernels say, in an object that is open and in words.
std::string printed_kernels(api::json::Writer& w, const Answer& answer) {
  const sky::SkySample& seen = *answer.by_kernels;
  w.text("body", answer.body).significant("sun_distance_au", seen.sun_distance_au);
  api::write_bearing(w, "sun", seen.sun);
  api::write_bearing(w, "earth", seen.earth.value());
  std::string out =
      fmt::format("{} at {:.4f} deg east, {:.4f} deg north: {:.5f} au from the sun\n", answer.body,
                  answer.place.degrees->x, answer.place.degrees->y, seen.sun_distance_au) +
      bearing_lines({{"Sun", seen.sun}, {"Earth", *seen.earth}});
  if (answer.table)
    out += fmt::format("Table: {} moments from {} to {}\n", answer.table->size(),
                       utc_words(answer.table->front().utc_ms), utc_words(answer.table->back().utc_ms));
  return out;
}

std::string printed(const Answer& answer, bool json) {
  api::json::Writer w;
  w.begin_object().text("format", "sky/1").text("at", utc_text(answer.utc_ms));
  std::string out = fmt::format("At {}\n", utc_words(answer.utc_ms));
  if (answer.place.degrees)
    w.significant("longitude_deg", answer.place.degrees->x)
        .significant("latitude_deg", answer.place.degrees->y);
  if (answer.by_kernels) {
    out += printed_kernels(w, answer);
  } else if (answer.place.degrees) {
    const api::SkyMoment moment = api::sky_moment(answer.utc_ms, *answer.place.degrees);
    api::write_sky_moment(w, moment);
    const auto clock = [](double hours) {
      const long seconds = std::lround(3600.0 * hours);
      return fmt::format("{:02}:{:02}:{:02}", seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    };
    out += fmt::format(
        "Mars at {:.4f} deg east, {:.4f} deg north: Ls {:.3f} deg, local mean solar time {}, true {}\n",
        answer.place.degrees->x, answer.place.degrees->y, deg_from_rad(moment.time.season_rad),
        clock(moment.time.mean_solar_h), clock(moment.time.true_solar_h));
    out += bearing_lines({{"Sun", moment.sun}, {"Earth", moment.earth}});
  }
  if (answer.horizon_rad) {
    w.key("horizon_deg").begin_array();
    out += "Horizon, azimuth and elevation in degrees:\n";
    for (std::size_t k = 0; k < answer.horizon_rad->size(); ++k) {
      const double elevation = deg_from_rad((*answer.horizon_rad)[k]);
      w.significant(elevation);
      out += fmt::format("{:8.1f} {:7.2f}\n",
                         360.0 * static_cast<double>(k) / static_cast<double>(answer.horizon_rad->size()),
                         elevation);
    }
    w.end_array();
  }
  w.end_object();
  return json ? w.take() + "\n" : out;
}

Result<std::int64_t> time_of(std::string_view option, const std::string& text) {
  const auto at = utc_of_text(text);
  if (!at)
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("{} {} is no time of UTC such as 2026-07-01T12:00:00Z", option, text));
  return *at;
}

// Of an answer whose place is known in degrees.
Result<void> look_into_kernels(const SkyOptions& options, Answer& answer) {
  answer.body = answer.place.site ? answer.place.site->info().body : options.body;
  const auto sky = read_kernel_sky(options.sky, answer.body);
  if (!sky) return fail(sky.error());
  const steps::SkyPlace place{rad_from_deg(answer.place.degrees->x), rad_from_deg(answer.place.degrees->y)};
  const auto seen = sky->over(place, answer.utc_ms);
  if (!seen) return fail(seen.error());
  answer.by_kernels = *seen;
  if (options.table.empty()) return {};
  const auto until = time_of("--until", options.until.value_or(""));
  if (!until) return fail(until.error());
  if (*until < answer.utc_ms) return fail(ErrorCode::kInvalidRequest, "--until is before --at");
  auto moments = sky->table(place, answer.utc_ms, *until, *until, api::RequestLimits::kSkyMoments);
  if (!moments) return fail(moments.error());
  answer.table = *std::move(moments);
  return {};
}

Result<Answer> look(const SkyOptions& options) {
  Answer answer{.utc_ms = now_ms(), .place = {}};
  if (options.at) {
    const auto at = time_of("--at", *options.at);
    if (!at) return fail(at.error());
    answer.utc_ms = *at;
  }
  if (options.sky.empty())
    if (auto why = sky::why_not_known(answer.utc_ms))
      return fail(ErrorCode::kInvalidRequest, *std::move(why));
  auto place = place_of(options);
  if (!place) return fail(place.error());
  answer.place = std::move(*place);
  const bool wants_horizon = options.horizon || !options.horizon_map.empty();
  if (!answer.place.degrees && !wants_horizon)
    return fail(ErrorCode::kInvalidRequest,
                answer.place.site ? api::why_no_sky(*answer.place.site)
                                        .value_or("the place has no longitude and latitude on this map")
                                  : std::string("give a place: --lonlat, or --terrain with --place"));
  if (!options.sky.empty()) {
    if (!answer.place.degrees)
      return fail(ErrorCode::kInvalidRequest, "the place has no longitude and latitude on this map");
    if (auto looked = look_into_kernels(options, answer); !looked) return fail(looked.error());
  }
  if (!wants_horizon) return answer;
  if (!answer.place.site)
    return fail(ErrorCode::kInvalidRequest, "a horizon is of a terrain: give --terrain");
  const dem::ElevationInfo& info = answer.place.site->info();
  auto terrain = answer.place.site->read_elevation(info.geometry.extent());
  if (!terrain) return fail(terrain.error());
  const double body_radius_m = api::body_radius_m(info.body);
  if (options.horizon) {
    if (!options.place)
      return fail(ErrorCode::kInvalidRequest, "a horizon is seen from a place: give --place");
    const double north = api::map_north_rad(*answer.place.site, options.place->x_m, options.place->y_m);
    const dem::Horizon horizon(*terrain, body_radius_m);
    answer.horizon_rad = horizon.all_around_rad(options.place->x_m, options.place->y_m, options.eye_m,
                                                options.directions, -north);
    if (!answer.horizon_rad)
      return fail(ErrorCode::kOffMap, fmt::format("the terrain has no height at ({:g}, {:g})",
                                                  options.place->x_m, options.place->y_m));
    if (auto damage = (*terrain)->damage()) return fail(*damage);
  }
  if (!options.horizon_map.empty()) {
    constexpr int kMostCells = 2048;
    const int every =
        options.every > 0
            ? options.every
            : std::min({1 + (std::max(info.geometry.rows, info.geometry.columns) - 1) / kMostCells,
                        info.geometry.rows, info.geometry.columns});
    if (every > std::min(info.geometry.rows, info.geometry.columns))
      return fail(ErrorCode::kInvalidRequest,
                  fmt::format("--every {}: the terrain has {} x {} cells, so that the map would have none",
                              every, info.geometry.rows, info.geometry.columns));
    if (std::filesystem::exists(options.horizon_map))
      return fail(ErrorCode::kUnwritableFile, options.horizon_map + " exists already");
    TerminalProgress progress;
    const dem::HorizonSweep ground(**terrain, body_radius_m);
    const dem::Eyes eyes = dem::eyes_over(**terrain, dem::coarser_grid(info.geometry, every), options.eye_m);
    if (auto damage = (*terrain)->damage()) return fail(*damage);
    auto written = dem::write_horizon_map(options.horizon_map, ground, eyes, info.crs_wkt, options.eye_m,
                                          options.directions, 0, progress);
    if (!written) return fail(written.error());
  }
  return answer;
}

// The list that a departure has as its "sky".
std::vector<OutputFile> files_of(const SkyOptions& options, const Answer& answer) {
  if (!answer.table) return {};
  api::json::Writer w;
  api::json::write_sky(w, *answer.table);
  return {{options.table, w.take() + "\n"}};
}

}  // namespace

void add_sky_command(CLI::App& app, std::function<int()>& run) {
  const auto options = std::make_shared<SkyOptions>();
  CLI::App* const command =
      app.add_subcommand("sky", "time, sun, Earth and the ground's horizon over a place");
  command->add_option("--at", options->at, "time of UTC, 2026-07-01T12:00:00Z; now where it is not given");
  command->add_option("--lonlat", options->lonlat,
                      "a place on Mars, or --body: east longitude,planetocentric latitude in degrees");
  CLI::Option* const terrain =
      command->add_option("--terrain", options->terrain, "the terrain whose place or horizon is asked for");
  add_place(*command, "--place", options->place,
            "x,y in map metres; the middle of the terrain where it is not given");
  CLI::Option* const kernels = command->add_option(
      "--sky", options->sky,
      "SPICE kernels that sun and Earth are taken from: positions (SPK, as de440s.bsp) and "
      "where wanted constants (text PCK)");
  command->add_option("--body", options->body, "whose place --lonlat is, Mars or Moon")
      ->needs(kernels)
      ->capture_default_str();
  CLI::Option* const table =
      command
          ->add_option(
              "--table", options->table,
              "write sun and Earth from --at to --until to this file, as the list sky of a departure "
              "(JSON)")
          ->needs(kernels);
  table->needs(command->add_option("--until", options->until, "the last time of --table, UTC")->needs(table));
  command
      ->add_flag("--horizon", options->horizon,
                 "print the horizon's elevation all around --place, from true north")
      ->needs(terrain);
  CLI::Option* const map =
      command
          ->add_option(
              "--horizon-map", options->horizon_map,
              "write the horizon from every cell to this file, a GeoTIFF with a band for each direction, "
              "clockwise from the map's north")
          ->needs(terrain);
  command->add_option("--every", options->every, "cells of the terrain along a side to one of the map")
      ->needs(map)
      ->check(CLI::Range(1, 1000));
  command->add_option("--directions", options->directions, "of the horizon")
      ->capture_default_str()
      ->check(CLI::Range(4, 720));
  command->add_option("--eye-m", options->eye_m, "height of the eye over the ground")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1000.0));
  command->add_flag("--json", options->json, "print JSON (sky/1)");
  add_data_option(*command, options->data, "terrains");
  command->footer(
      "Example: where Spirit landed, then\n  slipway sky --lonlat 175.298,-14.64 --at 2004-01-03T13:46:31Z\n"
      "and two days of sun and Earth near the Moon's south pole, for a request\n"
      "  slipway sky --sky de440s.bsp --body Moon --lonlat 12.3,-88.6 --at 2027-01-10T00:00:00Z --until "
      "2027-01-12T00:00:00Z --table sky.json");
  command->callback([options, &run] {
    run = [options] {
      const auto answer = look(*options);
      if (!answer) return options->sky.empty() ? refuse(answer.error()) : refuse_unreadable(answer.error());
      return deliver(files_of(*options, *answer), printed(*answer, options->json));
    };
  });
}

}  // namespace slipway::server
