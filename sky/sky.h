#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sky/bearing.h"

namespace slipway::sky {

// What stands over a place, at any moment. Thread-safe.
class Sky {
 public:
  virtual ~Sky() = default;
  // At milliseconds of UTC since 1970; nothing where it is not known.
  virtual std::optional<Bearing> sun(std::int64_t utc_ms) const = 0;
  virtual std::optional<Bearing> earth(std::int64_t utc_ms) const = 0;
  // Distance to the sun [au].
  virtual double sun_distance_au(std::int64_t utc_ms) const = 0;
  // Looked up, so that many looks cost little; otherwise see table_of().
  virtual bool is_table() const { return false; }
};

// By formulas, see mars_time.h.
class MarsSky final : public Sky {
 public:
  MarsSky(double east_longitude_rad, double latitude_rad)
      : east_longitude_rad_(east_longitude_rad), latitude_rad_(latitude_rad) {}
  std::optional<Bearing> sun(std::int64_t utc_ms) const override;
  std::optional<Bearing> earth(std::int64_t utc_ms) const override;
  double sun_distance_au(std::int64_t utc_ms) const override;

 private:
  double east_longitude_rad_, latitude_rad_;
};

// One moment of a table.
struct SkySample {
  std::int64_t utc_ms = 0;
  Bearing sun;
  std::optional<Bearing> earth;
  double sun_distance_au = 1.0;  // as over the Moon
};

// By a table: along great circles between its moments, and not known before the first and behind the last.
class SkyTable final : public Sky {
 public:
  // At least two, by rising times; all have the Earth or none.
  explicit SkyTable(std::vector<SkySample> samples);
  std::optional<Bearing> sun(std::int64_t utc_ms) const override;
  std::optional<Bearing> earth(std::int64_t utc_ms) const override;
  // That of the moment before.
  double sun_distance_au(std::int64_t utc_ms) const override;
  bool is_table() const override { return true; }

 private:
  // From one moment to the next, along a great circle.
  struct Arc {
    Arc(const Bearing& first, const Bearing& last);
    Bearing at(double share) const;
    Eigen::Vector3d from, to;
    double angle_rad;
  };
  struct Between {
    std::size_t arc;
    double share;
  };
  std::optional<Between> between(std::int64_t utc_ms) const;

  std::vector<SkySample> samples_;
  std::vector<Arc> sun_, earth_;
};

// A sky whose directions count from a map's north: the map's own stands `map_north_rad` clockwise of the
// true one at the place.
class SkyOverMap final : public Sky {
 public:
  SkyOverMap(std::shared_ptr<const Sky> sky, double map_north_rad)
      : sky_(std::move(sky)), map_north_rad_(map_north_rad) {}
  std::optional<Bearing> sun(std::int64_t utc_ms) const override { return turned(sky_->sun(utc_ms)); }
  std::optional<Bearing> earth(std::int64_t utc_ms) const override { return turned(sky_->earth(utc_ms)); }
  double sun_distance_au(std::int64_t utc_ms) const override { return sky_->sun_distance_au(utc_ms); }
  bool is_table() const override { return sky_->is_table(); }

 private:
  std::optional<Bearing> turned(std::optional<Bearing> bearing) const;

  std::shared_ptr<const Sky> sky_;
  double map_north_rad_;
};

// The moments between two times of a sky that is known at all times, so that many looks at it cost little.
// Between moments of five minutes the sun of Mars is within 0.002 deg.
SkyTable table_of(const Sky& sky, std::int64_t from_ms, std::int64_t to_ms, bool with_earth);

}  // namespace slipway::sky
