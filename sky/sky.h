#pragma once

#include <cstdint>
#include <optional>
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
};

// By a table: along great circles between its moments, and not known before the first and behind the last.
class SkyTable final : public Sky {
 public:
  static constexpr double kMoonDistanceAu = 1.0;  // also of any body near the Earth

  // At least two, by rising times; all have the Earth or none.
  explicit SkyTable(std::vector<SkySample> samples, double sun_distance_au = kMoonDistanceAu);
  std::optional<Bearing> sun(std::int64_t utc_ms) const override;
  std::optional<Bearing> earth(std::int64_t utc_ms) const override;
  double sun_distance_au(std::int64_t /*utc_ms*/) const override { return sun_distance_au_; }

 private:
  struct Between {
    const SkySample *before, *after;
    double share;
  };
  std::optional<Between> between(std::int64_t utc_ms) const;

  std::vector<SkySample> samples_;
  double sun_distance_au_;
};

// A sky's moments between two times, of which the first must be known, so that many looks at it cost little.
// Between moments of five minutes the sun of Mars is within 0.002 deg.
SkyTable table_of(const Sky& sky, std::int64_t from_ms, std::int64_t to_ms, bool with_earth);

}  // namespace slipway::sky
