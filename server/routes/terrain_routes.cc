#include "server/routes/terrain_routes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "api/files/catalogue.h"
#include "api/json/faults.h"
#include "api/place_sky.h"
#include "api/sunlight.h"
#include "api/terrain_views/terrain_document.h"
#include "api/terrain_views/terrain_picture.h"
#include "api/terrain_views/terrain_profile.h"
#include "core/angle.h"
#include "core/utc.h"
#include "dem/write/rgba_image.h"
#include "server/routes/drawn_cache.h"
#include "server/routes/query.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

constexpr std::size_t kPictureBytes = 32'000'000;  // of pictures that are kept in memory
constexpr std::string_view kPng = ".png";

constexpr std::size_t kGrounds = 4;  // of extents that are kept: some 10 MB each

using Site = std::shared_ptr<const api::TerrainSite>;

struct KeptGround {
  api::ShadowGround ground;
  static std::size_t size() { return 1; }
};

// The text before ".png"; nothing of another name.
std::optional<std::string_view> before_png(std::string_view name) {
  if (!name.ends_with(kPng) || name.size() == kPng.size()) return std::nullopt;
  return name.substr(0, name.size() - kPng.size());
}

// -1 where it is none.
int whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : -1;
}

void no_farther(Query& query, const std::string& name, const std::vector<double>& coordinates_m) {
  constexpr double kFarthest_m = 1e9;  // beyond every map of a planet: squares of it are still numbers
  if (std::any_of(coordinates_m.begin(), coordinates_m.end(),
                  [](double c) { return std::abs(c) > kFarthest_m; }))
    query.fault(name, fmt::format("{} has a coordinate beyond {:g} m, where no map is", name, kFarthest_m));
}

// "azimuth,elevation;azimuth,elevation" in degrees.
std::vector<sky::Bearing> suns_of(Query& query) {
  std::vector<sky::Bearing> suns;
  const std::vector<std::vector<double>> rows = query.required_rows("sun");
  for (const std::vector<double>& row : rows) {
    if (row.size() == 2 && std::abs(row[0]) <= 360.0 && std::abs(row[1]) <= 90.0)
      suns.push_back({rad_from_deg(row[0]), rad_from_deg(row[1])});
  }
  if (suns.size() != rows.size())
    query.fault(
        "sun",
        "each sun must be azimuth,elevation in degrees, within 360 and 90; a semicolon lies between two");
  if (rows.size() > api::kMostSuns)
    query.fault("sun", fmt::format("there are {} suns, must be at most {}", rows.size(), api::kMostSuns));
  return suns;
}

class TerrainRoutes {
 public:
  explicit TerrainRoutes(const api::Service& service) : service_(service) {}

  HttpResponse get(const HttpRequest& request) {
    if (const auto error = Query(request, {}).error()) return problem_response(*error, &request);
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    const auto known = known_of(*site);
    if (!known) return problem_response(known.error(), &request);
    return tagged(document(known->document), tag_of(known->document), request);
  }

  // Over the extent of the query.
  HttpResponse picture(const HttpRequest& request) {
    const auto name = before_png(request.parameter("picture"));
    const api::TerrainLayerRow* const layer = name ? api::find_terrain_layer(*name) : nullptr;
    if (layer == nullptr) return no_layer(request, request.parameter("picture"));
    Query query(request, {"west_m", "south_m", "east_m", "north_m", "width", "height", "legend", "v"});
    api::TerrainPicture wanted;
    wanted.layer = layer->layer;
    wanted.extent = {query.required_number("west_m"), query.required_number("south_m"),
                     query.required_number("east_m"), query.required_number("north_m")};
    constexpr std::size_t kUsualPx = 512;
    wanted.width_px = static_cast<int>(query.count("width", kUsualPx, api::kMaxPicturePx));
    wanted.height_px = static_cast<int>(query.count("height", kUsualPx, api::kMaxPicturePx));
    wanted.legend = query.text("legend");
    const std::optional<Error> unreadable = query.error();
    if (!unreadable && !(wanted.extent.west_m < wanted.extent.east_m))
      query.fault("east_m", "east_m must be above west_m");
    if (!unreadable && !(wanted.extent.south_m < wanted.extent.north_m))
      query.fault("north_m", "north_m must be above south_m");
    if (const auto error = query.error()) return problem_response(*error, &request);
    return drawn(request, wanted);
  }

  HttpResponse tile(const HttpRequest& request) {
    Query query(request, {"legend", "v"});
    if (const auto error = query.error()) return problem_response(*error, &request);
    const api::TerrainLayerRow* const layer = api::find_terrain_layer(request.parameter("layer"));
    if (layer == nullptr) return no_layer(request, request.parameter("layer"));
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    const int z = whole_number(request.parameter("z")), x = whole_number(request.parameter("x"));
    const int y = whole_number(before_png(request.parameter("y")).value_or(""));
    const api::TerrainTiles tiles((*site)->info().geometry);
    if (!tiles.has(z, x, y)) return problem(ErrorCode::kNotFound, "the terrain has no such tile", request);
    return drawn(request, {.layer = layer->layer,
                           .extent = tiles.extent(z, x, y),
                           .width_px = api::TerrainTiles::kTilePx,
                           .height_px = api::TerrainTiles::kTilePx,
                           .legend = query.text("legend")});
  }

  HttpResponse profile(const HttpRequest& request) {
    Query query(request, {"path", "points", "legend"});
    const std::vector<double> path = query.required_numbers("path");
    constexpr std::size_t kUsualPoints = 200;
    const std::size_t points = query.count("points", kUsualPoints, api::kMaxProfilePoints);
    if (points < 2) query.fault("points", "points must be at least 2");
    if (!path.empty() &&
        (path.size() % 2 != 0 || path.size() < 4 || path.size() > 2 * api::kMaxProfileCorners))
      query.fault("path", fmt::format("path has {} numbers, must have x and y of 2 to {} corners",
                                      path.size(), api::kMaxProfileCorners));
    no_farther(query, "path", path);
    if (const auto error = query.error()) return problem_response(*error, &request);
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    std::vector<Eigen::Vector2d> corners;
    for (std::size_t k = 0; k + 1 < path.size(); k += 2) corners.emplace_back(path[k], path[k + 1]);
    const auto along = api::ground_along(**site, corners, points, query.text("legend"));
    if (!along) return problem_response(along.error(), &request);
    HttpResponse response = document(api::write_profile(**site, query.text("legend"), *along));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse sky(const HttpRequest& request) {
    Query query(request, {"place", "from", "to"});
    const std::vector<double> place = query.required_numbers("place");
    if (!place.empty() && place.size() != 2) query.fault("place", "place must be x,y in metres of the map");
    const auto time_of = [&](const std::string& name, const std::string& text) {
      const auto ms = utc_of_text(text);
      if (!ms && !text.empty())
        query.fault(name, fmt::format("{} = {} is no time of UTC such as 2026-07-01T12:00:00Z", name,
                                      in_quotes(text)));
      return ms;
    };
    const auto from = time_of("from", query.required_text("from")), to = time_of("to", query.text("to"));
    if (from && to && *to < *from) query.fault("to", "to is before from");
    if (from && to && static_cast<double>(*to - *from) > 3.6e6 * api::kMostSky_h)
      query.fault("to", fmt::format("to must be within {:.0f} h of from", api::kMostSky_h));
    if (const auto error = query.error()) return problem_response(*error, &request);
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    const auto sky = api::sky_over(**site, place[0], place[1], *from, to);
    if (!sky) return problem_response(sky.error(), &request);
    HttpResponse response = document(api::write_place_sky(**site, *sky));
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  HttpResponse shadow(const HttpRequest& request) {
    Query query(request, {"bounds", "sun", "v"});
    const std::vector<double> bounds = query.required_numbers("bounds");
    const dem::Extent extent =
        bounds.size() == 4 ? dem::Extent{bounds[0], bounds[1], bounds[2], bounds[3]} : dem::Extent{};
    if (!bounds.empty() && !(extent.west_m < extent.east_m && extent.south_m < extent.north_m))
      query.fault("bounds",
                  "bounds must be west,south,east,north in metres of the map, each below its other");
    no_farther(query, "bounds", bounds);
    const std::vector<sky::Bearing> suns = suns_of(query);
    if (const auto error = query.error()) return problem_response(*error, &request);
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    const auto known = known_of(*site);
    if (!known) return problem_response(known.error(), &request);
    const std::string where = fmt::format("{}/{}", known->hash, fmt::join(bounds, ","));
    const auto draw = [&]() -> Result<std::string> {
      const auto kept = grounds_.get(where, [&]() -> Result<KeptGround> {
        auto ground = api::ShadowGround::read(**site, extent);
        if (!ground) return fail(ground.error());
        return KeptGround{*std::move(ground)};
      });
      if (!kept) return fail(kept.error());
      return dem::encode_png((*kept)->ground.draw(extent, suns));
    };
    return png(request, drawn_.get(where + "/" + query.text("sun"), draw), known->hash);
  }

 private:
  // What was read of a terrain's files, which takes long where they are large.
  struct Known {
    std::weak_ptr<const api::TerrainSite> site;
    std::string hash, document;
  };

  static HttpResponse no_layer(const HttpRequest& request, std::string_view name) {
    return problem(ErrorCode::kNotFound, fmt::format("terrains have no layer {}", name), request);
  }

  Result<Site> site_of(const HttpRequest& request) const {
    const std::shared_ptr<const api::Catalogue> catalogue = service_.catalogue();
    const auto found = catalogue->terrains.find(request.parameter("name"));
    if (found == catalogue->terrains.end())
      return fail(ErrorCode::kNotFound, api::unknown_terrain(*catalogue, request.parameter("name")));
    if (const auto same = found->second->unaltered(); !same) return fail(same.error());
    return found->second;
  }

  Result<Known> known_of(const Site& site) {
    const std::string& name = site->description().name;
    {
      const std::scoped_lock lock(mutex_);
      if (const auto found = known_.find(name); found != known_.end() && found->second.site.lock() == site)
        return found->second;
    }
    const auto files = site->files();
    if (!files) return fail(files.error());
    auto written = api::write_terrain_document(*site, *files);
    if (!written) return fail(written.error());
    Known known{site, api::hash_of(*files), *std::move(written)};
    const std::scoped_lock lock(mutex_);
    return known_[name] = std::move(known);
  }

  HttpResponse drawn(const HttpRequest& request, const api::TerrainPicture& wanted) {
    const auto site = site_of(request);
    if (!site) return problem_response(site.error(), &request);
    const auto known = known_of(*site);
    if (!known) return problem_response(known.error(), &request);
    const dem::Extent& e = wanted.extent;
    const std::string key =
        fmt::format("{}/{}/{}/{}/{}/{}/{}/{}x{}", known->hash, static_cast<int>(wanted.layer), wanted.legend,
                    e.west_m, e.south_m, e.east_m, e.north_m, wanted.width_px, wanted.height_px);
    const auto draw = [&]() -> Result<std::string> {
      const auto image = api::draw_terrain(**site, wanted);
      if (!image) return fail(image.error());
      return dem::encode_png(*image);
    };
    return png(request, drawn_.get(key, draw), known->hash);
  }

  // What was drawn of the terrain of this hash.
  static HttpResponse png(const HttpRequest& request, const Result<DrawnCache<std::string>::Kept>& drawn,
                          const std::string& hash) {
    if (!drawn) return problem_response(drawn.error(), &request);
    HttpResponse response = document(**drawn);
    response.content_type = "image/png";
    // The address names what it is drawn from: it will never show anything else.
    if (request.query_value("v") == hash)
      response.headers = {{"Cache-Control", "private, max-age=31536000, immutable"}};
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  const api::Service& service_;
  DrawnCache<std::string> drawn_{kPictureBytes};
  DrawnCache<KeptGround> grounds_{kGrounds};
  std::mutex mutex_;
  std::map<std::string, Known> known_;
};

}  // namespace

std::vector<Route> terrain_routes(const api::Service& service) {
  const auto terrains = std::make_shared<TerrainRoutes>(service);
  return {
      {"GET", "/v1/terrains/{name}", [terrains](const HttpRequest& r) { return terrains->get(r); },
       Threads::kHeavy},
      {"GET", "/v1/terrains/{name}/profile",
       [terrains](const HttpRequest& r) { return terrains->profile(r); }, Threads::kHeavy},
      {"GET", "/v1/terrains/{name}/sky", [terrains](const HttpRequest& r) { return terrains->sky(r); },
       Threads::kHeavy},
      {"GET", "/v1/terrains/{name}/shadow.png",
       [terrains](const HttpRequest& r) { return terrains->shadow(r); }, Threads::kShadow},
      {"GET", "/v1/terrains/{name}/{picture}",
       [terrains](const HttpRequest& r) { return terrains->picture(r); }, Threads::kPicture},
      {"GET", "/v1/terrains/{name}/tiles/{layer}/{z}/{x}/{y}",
       [terrains](const HttpRequest& r) { return terrains->tile(r); }, Threads::kPicture},
  };
}

}  // namespace slipway::server
