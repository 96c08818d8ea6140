#include "server/routes/terrain_routes.h"

#include <fmt/format.h>

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
#include "api/terrain_views/terrain_document.h"
#include "api/terrain_views/terrain_picture.h"
#include "api/terrain_views/terrain_profile.h"
#include "dem/write/rgba_image.h"
#include "server/routes/drawn_cache.h"
#include "server/routes/query.h"
#include "server/routes/responses.h"

namespace slipway::server {
namespace {

constexpr std::size_t kPictureBytes = 32'000'000;  // of pictures that are kept in memory
constexpr std::string_view kPng = ".png";

using Site = std::shared_ptr<const api::TerrainSite>;

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
    constexpr double kFarthest_m = 1e9;  // beyond every map of a planet: squares of it are still numbers
    if (std::any_of(path.begin(), path.end(), [](double c) { return std::abs(c) > kFarthest_m; }))
      query.fault("path", fmt::format("path has a coordinate beyond {:g} m, where no map is", kFarthest_m));
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
    const auto png = drawn_.get(key, [&]() -> Result<std::string> {
      const auto image = api::draw_terrain(**site, wanted);
      if (!image) return fail(image.error());
      return dem::encode_png(*image);
    });
    if (!png) return problem_response(png.error(), &request);
    HttpResponse response = document(**png);
    response.content_type = "image/png";
    // The address names what it is drawn from: it will never show anything else.
    if (request.query_value("v") == known->hash)
      response.headers = {{"Cache-Control", "private, max-age=31536000, immutable"}};
    const std::string tag = tag_of(response.body);
    return tagged(std::move(response), tag, request);
  }

  const api::Service& service_;
  DrawnCache<std::string> drawn_{kPictureBytes};
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
      {"GET", "/v1/terrains/{name}/{picture}",
       [terrains](const HttpRequest& r) { return terrains->picture(r); }, Threads::kHeavy},
      {"GET", "/v1/terrains/{name}/tiles/{layer}/{z}/{x}/{y}",
       [terrains](const HttpRequest& r) { return terrains->tile(r); }, Threads::kHeavy},
  };
}

}  // namespace slipway::server
