#include "steps/kernel_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "sky/mars_time.h"
#include "steps/spice_clock.h"
#include "steps/spice_orientation.h"

namespace slipway::steps {
namespace {

constexpr int kSun = 10;
constexpr int kEarth = 399;
constexpr double kLight_m_s = 299'792'458.0;
constexpr double kAu_m = 149'597'870'700.0;
constexpr double kDay_s = 86'400.0;

constexpr std::array<KernelBody, 2> kBodies{{{"Mars", 499, 4, sky::kMarsRadius_m, sky::kMarsPolar, 300'000},
                                             {"Moon", 301, 0, 1'737'400.0, 1.0, 3'600'000}}};

// What was read of the files before the body's own is looked for.
struct Read {
  std::vector<DafFile> positions;
  std::optional<sky::Orientation> orientation;
  std::vector<Fault> faults;

  void add(const Error& error) { faults.insert(faults.end(), error.faults.begin(), error.faults.end()); }
};

void read_binary(const KernelBytes& file, Read& read) {
  auto daf = DafFile::read(file.bytes, file.name);
  if (!daf)
    read.add(daf.error());
  else if (daf->kind() != DafKind::kSpk)
    read.faults.push_back({file.name, "attitudes (CK) say nothing of the sky: give positions (SPK)"});
  else
    read.positions.push_back(std::move(*daf));
}

void read_text(const KernelBytes& file, int body, Read& read) {
  if (looks_like_constants(file.bytes)) {
    auto found = read_orientation(file.bytes, file.name, body);
    if (!found)
      read.add(found.error());
    else if (*found)
      read.orientation = std::move(*found);
  } else if (!looks_like_leap_seconds(file.bytes)) {
    read.faults.push_back(
        {file.name, "neither positions (SPK), nor constants of bodies (text PCK), nor leap seconds (LSK)"});
  }
}

// From a place to where a body was when the light left it that is at the place then.
Result<Eigen::Vector3d> way_of_light(const SpiceEphemeris& ephemeris, int seen, const Eigen::Vector3d& from_m,
                                     double et_s) {
  constexpr int kTimes = 3;  // of which each is nearer by v / c, a ten-thousandth
  Eigen::Vector3d way_m = Eigen::Vector3d::Zero();
  for (int k = 0; k <= kTimes; ++k) {
    const auto there = ephemeris.motion(seen, et_s - way_m.norm() / kLight_m_s);
    if (!there) return fail(there.error());
    way_m = there->position_m - from_m;
  }
  return way_m;
}

}  // namespace

KernelSky::KernelSky(const KernelBody& body, sky::Orientation orientation, SpiceEphemeris ephemeris)
    : body_(body), orientation_(std::move(orientation)), ephemeris_(std::move(ephemeris)) {}

Result<KernelSky> KernelSky::read(std::span<const KernelBytes> files, std::string_view body) {
  const auto* const found = std::find_if(kBodies.begin(), kBodies.end(),
                                         [body](const KernelBody& each) { return each.name == body; });
  if (found == kBodies.end())
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("a sky of kernels is made for Mars and the Moon, not for {}: give a table of sun "
                            "and Earth instead",
                            body == "Earth" ? "the Earth" : "another body"));
  Read read;
  for (const KernelBytes& file : files)
    if (looks_like_daf(file.bytes))
      read_binary(file, read);
    else
      read_text(file, found->id, read);
  if (read.faults.empty() && read.positions.empty())
    read.faults.push_back({"", "no kernel has positions (SPK) of sun and planets"});
  if (!read.faults.empty())
    return fail(ErrorCode::kUnreadableData, "the SPICE kernels can't be read", std::move(read.faults));
  auto ephemeris = SpiceEphemeris::read(read.positions, {found->id, found->barycentre, kSun, kEarth});
  if (!ephemeris) return fail(ephemeris.error());
  KernelBody used = *found;
  // Mars stands within a metre of the barycentre of itself and its moons, and many kernels have that alone.
  if (!ephemeris->has(used.id) && used.barycentre != 0 && ephemeris->has(used.barycentre))
    used.id = used.barycentre;
  return KernelSky(used,
                   read.orientation ? *std::move(read.orientation)
                   : body == "Mars" ? sky::mars_orientation()
                                    : sky::moon_orientation(),
                   std::move(*ephemeris));
}

Result<sky::SkySample> KernelSky::over(const SkyPlace& place, std::int64_t utc_ms) const {
  const double et_s = EphemerisTime().tdb_of(kDay_s * sky::terrestrial_days(utc_ms));
  const auto centre = ephemeris_.motion(body_.id, et_s);
  if (!centre) return fail(centre.error());
  const Eigen::Matrix3d level = sky::level_frame(place.east_longitude_rad, place.latitude_rad, body_.polar);
  const Eigen::Matrix3d fixed = orientation_.fixed(et_s / kDay_s);
  const Eigen::Vector3d eye_m =
      centre->position_m + fixed.transpose() * sky::on_ellipsoid(place.east_longitude_rad, place.latitude_rad,
                                                                 body_.radius_m, body_.polar);
  const auto seen = [&](const Eigen::Vector3d& way_m) {
    return sky::bearing_of(level * fixed * (way_m.normalized() + centre->velocity_m_s / kLight_m_s));
  };
  const auto sun = way_of_light(ephemeris_, kSun, eye_m, et_s);
  if (!sun) return fail(sun.error());
  const auto earth = way_of_light(ephemeris_, kEarth, eye_m, et_s);
  if (!earth) return fail(earth.error());
  return sky::SkySample{utc_ms, seen(*sun), seen(*earth), sun->norm() / kAu_m};
}

Result<std::vector<sky::SkySample>> KernelSky::table(const SkyPlace& place, std::int64_t from_ms,
                                                     std::int64_t to_ms, std::int64_t beyond_ms,
                                                     std::size_t most) const {
  const std::int64_t needed = (to_ms - from_ms + body_.step_ms - 1) / body_.step_ms + 2;
  if (needed > static_cast<std::int64_t>(most))
    return fail(ErrorCode::kInvalidRequest,
                fmt::format("a sky of {:.1f} days has {} moments, must have {} at most: ask for fewer days",
                            static_cast<double>(to_ms - from_ms) / 86.4e6, needed, most));
  std::vector<sky::SkySample> moments;
  const std::int64_t last_ms = std::max(to_ms, from_ms + 1000);
  for (std::int64_t at = from_ms; moments.empty() || moments.back().utc_ms < last_ms; at += body_.step_ms) {
    const auto sample = over(place, std::min(at, last_ms));
    if (!sample) return fail(sample.error());
    moments.push_back(*sample);
  }
  for (std::int64_t at = last_ms + body_.step_ms; at <= beyond_ms && moments.size() < most;
       at += body_.step_ms) {
    const auto sample = over(place, at);
    if (!sample) break;
    moments.push_back(*sample);
  }
  return moments;
}

bool looks_like_kernel(std::string_view bytes) {
  return looks_like_daf(bytes) || bytes.starts_with("KPL/");
}

}  // namespace slipway::steps
