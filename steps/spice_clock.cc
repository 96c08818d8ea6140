#include "steps/spice_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "steps/spice_text_kernel.h"

namespace slipway::steps {
namespace {

tl::unexpected<Error> refuse(std::string_view file, std::string place, std::string message) {
  return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read as a clock", file),
              {{std::move(place), std::move(message)}});
}

Result<void> read_coefficients(const KernelAssignments& all, std::string_view file, const std::string& name,
                               SpacecraftClock& clock) {
  const auto numbers = kernel_numbers(all, file, name, 3);
  if (!numbers) return fail(numbers.error());
  const std::string place = fmt::format("{}, line {}", file, all.at(name).line);
  if (numbers->size() % 3 != 0)
    return refuse(file, place,
                  fmt::format("{} has {} numbers, must have three in each row", name, numbers->size()));
  for (std::size_t k = 0; k < numbers->size(); k += 3) {
    const ClockCoefficients row{(*numbers)[k], (*numbers)[k + 1], (*numbers)[k + 2]};
    const bool rises = clock.coefficients.empty() || (row.tick > clock.coefficients.back().tick &&
                                                      row.parallel_s > clock.coefficients.back().parallel_s);
    if (!rises || !(row.rate > 0.0))
      return refuse(
          file, place,
          fmt::format("{}, row {}: ticks and times must rise and the rate be above 0", name, k / 3 + 1));
    clock.coefficients.push_back(row);
  }
  return {};
}

// A clock's row that holds from a value on, which is the first one before all of them.
const ClockCoefficients& row_of(const std::vector<ClockCoefficients>& rows, double ClockCoefficients::*by,
                                double value) {
  const auto after = std::upper_bound(rows.begin(), rows.end(), value,
                                      [by](double v, const ClockCoefficients& row) { return v < row.*by; });
  return after == rows.begin() ? rows.front() : *(after - 1);
}

}  // namespace

double EphemerisTime::tdb_of(double tdt_s) const {
  const double anomaly = anomaly_rad + anomaly_rate_rad_s * tdt_s;
  return tdt_s + amplitude_s * std::sin(anomaly + eccentricity * std::sin(anomaly));
}

// The offset changes by less than 1e-9 s in the 2 ms that it is at most.
double EphemerisTime::tdt_of(double tdb_s) const {
  return tdb_s - (tdb_of(tdb_s) - tdb_s);
}

double SpacecraftClock::et_of(double tick) const {
  const ClockCoefficients& row = row_of(coefficients, &ClockCoefficients::tick, tick);
  const double parallel_s = row.parallel_s + (tick - row.tick) / ticks_per_count * row.rate;
  return parallel_is_tdt ? ephemeris.tdb_of(parallel_s) : parallel_s;
}

double SpacecraftClock::tick_of(double et_s) const {
  const double parallel_s = parallel_is_tdt ? ephemeris.tdt_of(et_s) : et_s;
  const ClockCoefficients& row = row_of(coefficients, &ClockCoefficients::parallel_s, parallel_s);
  return row.tick + (parallel_s - row.parallel_s) * ticks_per_count / row.rate;
}

bool looks_like_clock(std::string_view text) {
  return text.starts_with("KPL/SCLK") || text.find("SCLK01_COEFFICIENTS_") != std::string_view::npos;
}

bool looks_like_leap_seconds(std::string_view text) {
  return text.starts_with("KPL/LSK") || text.find("DELTET/DELTA_AT") != std::string_view::npos;
}

Result<SpacecraftClock> read_spacecraft_clock(std::string_view text, std::string_view file, int id) {
  const auto all = read_text_kernel(text, file);
  if (!all) return fail(all.error());
  SpacecraftClock clock;
  const auto of_clock = [id](std::string_view name) { return fmt::format("{}_{}", name, id); };
  const auto type = kernel_numbers(*all, file, of_clock("SCLK_DATA_TYPE"), 1);
  if (!type) return fail(type.error());
  if (type->front() != 1.0) return refuse(file, std::string(file), "the clock is not of SCLK type 1");
  // Terrestrial time is 2; where no system is named it is TDB, 1.
  if (all->contains(of_clock("SCLK01_TIME_SYSTEM"))) {
    const auto system = kernel_numbers(*all, file, of_clock("SCLK01_TIME_SYSTEM"), 1);
    if (!system) return fail(system.error());
    if (system->front() != 1.0 && system->front() != 2.0)
      return refuse(file, std::string(file), "the parallel time must be TDB (1) or TDT (2)");
    clock.parallel_is_tdt = system->front() == 2.0;
  } else {
    clock.parallel_is_tdt = false;
  }
  // A tick is the least count; the rate is of the first field, which has the product of the others' moduli.
  const auto moduli = kernel_numbers(*all, file, of_clock("SCLK01_MODULI"), 1);
  if (!moduli) return fail(moduli.error());
  for (std::size_t k = 1; k < moduli->size(); ++k) clock.ticks_per_count *= (*moduli)[k];
  if (!(clock.ticks_per_count >= 1.0 && clock.ticks_per_count <= 1e12))
    return refuse(file, std::string(file), "the moduli of the clock's fields must be 1 or more");
  if (auto read = read_coefficients(*all, file, of_clock("SCLK01_COEFFICIENTS"), clock); !read)
    return fail(read.error());
  return clock;
}

Result<EphemerisTime> read_leap_seconds(std::string_view text, std::string_view file) {
  const auto all = read_text_kernel(text, file);
  if (!all) return fail(all.error());
  EphemerisTime time;
  const auto amplitude = kernel_numbers(*all, file, "DELTET/K", 1);
  if (!amplitude) return fail(amplitude.error());
  const auto eccentricity = kernel_numbers(*all, file, "DELTET/EB", 1);
  if (!eccentricity) return fail(eccentricity.error());
  const auto anomaly = kernel_numbers(*all, file, "DELTET/M", 2);
  if (!anomaly) return fail(anomaly.error());
  time = {amplitude->front(), eccentricity->front(), (*anomaly)[0], (*anomaly)[1]};
  if (std::abs(time.amplitude_s) > 1.0 || std::abs(time.eccentricity) > 1.0 ||
      std::abs(time.anomaly_rate_rad_s) > 1e-3)
    return refuse(file, std::string(file),
                  "DELTET/K, DELTET/EB and DELTET/M are not those of the Earth's way");
  return time;
}

}  // namespace slipway::steps
