#include "planner/timing/drive_in_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

#include "core/number_words.h"
#include "core/pose.h"
#include "core/quantile.h"
#include "core/utc.h"

namespace slipway::planner {
namespace {

constexpr double kSunAtEarth_w_m2 = 1361.0;  // at 1 au [Kopp and Lean 2011]
constexpr double kHour_s = 3600.0;
constexpr double kHaltStep_s = 300.0;
constexpr double kEye_m = 1.0;  // the height of cells and cameras over the ground
constexpr int kDirections = 72, kFineDirections = 1440;
// So close to the horizon of the coarse directions a body is compared with that of the fine ones.
constexpr double kCloseToHorizon_rad = 0.15;
constexpr std::size_t kMostPlaces = 800;
constexpr double kHidden_rad = -0.5 * std::numbers::pi;  // the elevation of what the ground hides
constexpr double kWholeWay = 0.999;                      // a draw that came so far came to the end

// What is not known where the table of the sky ends, of a rule by its name.
std::string_view plain_name(std::string_view rule) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kNames{
      {{"charge", "the battery's charge"},
       {"motor_cold", "the coldest drive motor's temperature"},
       {"motor_hot", "the hottest drive motor's temperature"},
       {"sun", "the height of the sun"},
       {"earth", "the height of the Earth"},
       {"light_left", "the light that is left"}}};
  const auto* const found =
      std::find_if(kNames.begin(), kNames.end(), [&](const auto& row) { return row.first == rule; });
  return found == kNames.end() ? rule : found->second;
}

// Arrivals are told to the minute, the later one, and to the second where that would be behind a limit they
// keep.
std::string arrival_words(std::int64_t usual_ms, std::int64_t slow_ms, std::int64_t limit_ms) {
  const auto told = [&](std::int64_t ms) {
    return utc_words(ms <= limit_ms && minute_after(ms) > limit_ms ? ms : minute_after(ms));
  };
  return fmt::format("the rover arrives at {}, at the slow pace at {}, {} {} the limit of {}", told(usual_ms),
                     told(slow_ms), span_words(1e-3 * static_cast<double>(limit_ms - slow_ms)),
                     slow_ms > limit_ms ? "after" : "before", utc_words(limit_ms));
}

std::int64_t after(std::int64_t utc_ms, double seconds) {
  return utc_ms + std::llround(1000.0 * seconds);
}

// How much of a stretch is lit that the sun enters at one height over the ground's horizon and leaves at
// another: of the straight line between them what lies over it.
double lit_between(double one_rad, double other_rad) {
  if ((one_rad > 0.0) == (other_rad > 0.0)) return one_rad > 0.0 ? 1.0 : 0.0;
  return std::max(one_rad, other_rad) / std::abs(one_rad - other_rad);
}

}  // namespace

Light light_of(double sun_elevation_rad, double sun_distance_au, double optical_depth) {
  const double height = std::sin(sun_elevation_rad);
  if (height <= 0.0) return {};
  const double above = kSunAtEarth_w_m2 / (sun_distance_au * sun_distance_au);
  const double left = std::exp(-optical_depth / std::max(height, 0.02));
  return {above * left, 0.5 * above * height * (1.0 - left)};
}

// How a drive goes at one pace.
struct DriveInTime::Course {
  std::int64_t arrives_ms = 0;
  double charge = 1.0, least_charge = 1.0;
  double lit_s = 0.0, total_s = 0.0;
  double gained_wh = 0.0, used_wh = 0.0, spilled_wh = 0.0;
  // The least of a value on the way, and where it first falls below its limit.
  struct Least {
    double limit = 0.0;
    double value = std::numeric_limits<double>::infinity();
    double at_m = 0.0;
    std::optional<double> broken_m = {};
    void lower(double other, double other_at_m) {
      if (other < limit && !broken_m) broken_m = other_at_m;
      if (other < value) {
        value = other;
        at_m = other_at_m;
      }
    }
  };
  // Sun, Earth and charge as far as sun and Earth are known.
  Least charge_known, sun_rad, earth_rad;
  Least over_coldest_k, below_warmest_k;            // what the drive motors have left to their limits
  bool sun_is_known = true, earth_is_known = true;  // all the way
};

DriveInTime::DriveInTime(const Departure& departure, const sim::RoverModel& rover,
                         const sim::DrivePrediction& prediction, const Progress& progress)
    : departure_(departure), rover_(rover), supply_(rover.power) {
  if (departure.air) {
    air_.emplace(departure);
    motor_ = motor_warmth(rover.drive);
    if (motor_) air_of_motors_.emplace(departure, motor_->time_constant_s);
  }
  const std::vector<sim::StationPrediction>& stations = prediction.stations;
  const std::size_t step = 1 + stations.size() / kMostPlaces;
  double since_s = 0.0, before_s = 0.0;
  Eigen::Vector3d since_up = Eigen::Vector3d::Zero();
  Eigen::Array3d since_j = Eigen::Array3d::Zero();  // of the motors, and of the greatest and the least losses
  for (std::size_t k = 0; k < stations.size() && !progress.cancelled(); ++k) {
    const sim::StationPrediction& at = stations[k];
    const MotorLosses losses = motor_ ? motor_losses(rover, at.state) : MotorLosses{};
    const Eigen::Array3d here_w(at.state.electric_power_w, losses.most_w, losses.least_w);
    since_s += at.elapsed_s - before_s;
    since_j += here_w * (at.elapsed_s - before_s);
    const Eigen::Vector3d up = rotation_MB(at.state.attitude).col(2);
    since_up += up * (at.elapsed_s - before_s);
    before_s = at.elapsed_s;
    if (k % step != 0 && k + 1 != stations.size()) continue;
    const Eigen::Array3d mean_w = since_s > 0.0 ? Eigen::Array3d(since_j / since_s) : here_w;
    Place place{at.station.distance_m,
                at.elapsed_s,
                mean_w[0],
                {mean_w[1], mean_w[2]},
                at.station.pose.x_m,
                at.station.pose.y_m,
                since_s > 0.0 ? Eigen::Vector3d(since_up / since_s) : up,
                {}};
    since_s = 0.0;
    since_j.setZero();
    since_up.setZero();
    if (departure.horizon) {
      auto horizon =
          departure.horizon->all_around_rad(at.station.pose.x_m, at.station.pose.y_m, kEye_m, kDirections);
      if (horizon) place.horizon_rad = *std::move(horizon);
    }
    places_.push_back(std::move(place));
  }
  set_paces(prediction);
}

// Of the draws that come to the end; the others are the halts that the verdict counts.
void DriveInTime::set_paces(const sim::DrivePrediction& prediction) {
  std::vector<double> times, energies;
  for (const sim::DrawFigures& draw : prediction.drawn) {
    if (draw.driven_m < kWholeWay * prediction.length_m || prediction.duration_s <= 0.0) continue;
    times.push_back(draw.duration_s / prediction.duration_s);
    if (prediction.energy_j > 0.0) energies.push_back(draw.energy_j / prediction.energy_j);
  }
  const auto set = [](std::vector<double>& ratios, double& usual, double& slow) {
    if (ratios.empty()) return;
    usual = quantile(ratios, 0.5);
    slow = quantile(ratios, 0.95);
  };
  set(times, usual_.time, slow_.time);
  set(energies, usual_.energy, slow_.energy);
}

// Without a body under the terrain its level is the same everywhere.
sky::Bearing DriveInTime::over_level(const Place& place, const sky::Bearing& over_start) const {
  if (!departure_.horizon) return over_start;
  const double per_m = 1.0 / departure_.horizon->body_radius_m();
  return sky::seen_from(over_start, per_m * (place.x_m - places_.front().x_m),
                        per_m * (place.y_m - places_.front().y_m));
}

double DriveInTime::over_horizon_rad(const Place& place, const sky::Bearing& bearing) const {
  if (place.horizon_rad.empty()) return bearing.elevation_rad;
  // Ground below the level hides nothing that is above it, and lights nothing below.
  const auto over = [&](double horizon_rad) { return bearing.elevation_rad - std::max(0.0, horizon_rad); };
  const double coarse = over(dem::horizon_between_rad(place.horizon_rad, bearing.azimuth_rad));
  if (std::abs(coarse) > kCloseToHorizon_rad) return coarse;
  return over(fine_horizon_rad(place, bearing.azimuth_rad));
}

// Between the two nearest fine directions.
double DriveInTime::fine_horizon_rad(const Place& place, double azimuth_rad) const {
  constexpr double kApart_rad = 2.0 * std::numbers::pi / kFineDirections;
  if (place.fine_rad.empty()) place.fine_rad.assign(kFineDirections, std::numeric_limits<float>::quiet_NaN());
  const double at = std::fmod(azimuth_rad / kApart_rad + kFineDirections, double{kFineDirections});
  const auto looked_at = [&](std::size_t k) {
    float& known = place.fine_rad[k % kFineDirections];
    if (std::isnan(known))
      known = static_cast<float>(*departure_.horizon->elevation_rad(place.x_m, place.y_m, kEye_m,
                                                                    kApart_rad * static_cast<double>(k)));
    return double{known};
  };
  const auto k = static_cast<std::size_t>(at);
  const double share = at - std::floor(at);
  return (1.0 - share) * looked_at(k) + share * looked_at(k + 1);
}

DriveInTime::Course DriveInTime::run(std::int64_t departs_ms, const Pace& pace,
                                     const std::optional<ChargingHalt>& halt,
                                     std::vector<TimedStation>* stations) const {
  Course course;
  course.charge = departure_.charge;
  course.charge_known.limit = departure_.rules.min_charge.value_or(0.0);
  // What is hidden is below every limit.
  const auto limit_of = [](const std::optional<double>& least_rad) {
    return std::max(least_rad.value_or(kHidden_rad), kHidden_rad + 1e-9);
  };
  course.sun_rad.limit = limit_of(departure_.rules.min_sun_rad);
  course.earth_rad.limit = limit_of(departure_.rules.min_earth_rad);
  std::int64_t now = departs_ms;
  // Of the motor that loses most and of the one that loses least, over what follows the air alone.
  double most_k = 0.0, least_k = 0.0;
  const sim::DriveMotor& drive = rover_.drive;
  const bool asks_of_motors = motor_ && (stations != nullptr || drive.min_temp_c || drive.max_temp_c);
  const auto look_at_motors = [&](double distance_m) {
    const double air_c = air_of_motors_->at_c(now);
    if (drive.min_temp_c) course.over_coldest_k.lower(air_c + least_k - *drive.min_temp_c, distance_m);
    if (drive.max_temp_c) course.below_warmest_k.lower(*drive.max_temp_c - air_c - most_k, distance_m);
    return air_c + most_k;
  };
  std::optional<double> over_before;  // the sun over the horizon, at the place before
  double reached_m = 0.0;
  // `effort`: the motors' power over that on the mean soils; nothing where the rover stands.
  const auto spend = [&](const Place& place, double seconds, std::optional<double> effort) {
    const std::int64_t middle = after(now, 0.5 * seconds);
    const double distance_m = place.distance_m;
    auto sun = departure_.sky->sun(middle);
    if (sun) sun = over_level(place, *sun);
    const double over = sun ? over_horizon_rad(place, *sun) : 0.0;
    const bool is_lit = sun && over > 0.0;
    const double lit = sun ? lit_between(over_before.value_or(over), over) : 0.0;
    over_before = over;
    course.sun_is_known &= sun.has_value();
    if (sun) course.sun_rad.lower(is_lit ? sun->elevation_rad : kHidden_rad, distance_m);
    if (departure_.rules.min_earth_rad) {
      auto earth = departure_.sky->earth(middle);
      if (earth) earth = over_level(place, *earth);
      const bool in_sight = earth && over_horizon_rad(place, *earth) > 0.0;
      if (earth) course.earth_rad.lower(in_sight ? earth->elevation_rad : kHidden_rad, distance_m);
      course.earth_is_known &= earth.has_value();
    }
    double in_w = 0.0, out_w = 0.0;
    if (supply_) {
      in_w = supply_->constant_w;
      if (sun && supply_->has_array()) {
        Light light =
            light_of(sun->elevation_rad, departure_.sky->sun_distance_au(middle), departure_.optical_depth);
        light.beam_w_m2 *= lit;
        in_w += supply_->array_w(light.beam_w_m2, sky::towards(*sun).dot(place.up), light.diffuse_w_m2);
      }
      out_w = effort ? place.motors_w * *effort + supply_->driving_w : supply_->standing_w;
      if (air_ && air_->at_c(middle) < supply_->heating_below_c) out_w += supply_->heating_w;
      const double hours = seconds / kHour_s;
      course.gained_wh += in_w * hours;
      course.used_wh += out_w * hours;
      double held_wh = course.charge * supply_->battery_wh + (in_w - out_w) * hours;
      if (held_wh > supply_->battery_wh) {
        course.spilled_wh += held_wh - supply_->battery_wh;
        held_wh = supply_->battery_wh;
      }
      course.charge = held_wh / supply_->battery_wh;
    }
    if (course.sun_is_known || !(supply_ && supply_->has_array()))
      course.charge_known.lower(course.charge, distance_m);
    course.least_charge = std::min(course.least_charge, course.charge);
    course.total_s += seconds;
    course.lit_s += lit * seconds;
    std::optional<double> motor_c;
    if (asks_of_motors) {
      if (effort && seconds > 0.0) look_at_motors(reached_m);
      most_k = motor_->after(most_k, place.losses.most_w * effort.value_or(0.0), seconds);
      least_k = motor_->after(least_k, place.losses.least_w * effort.value_or(0.0), seconds);
    }
    now = after(now, seconds);
    reached_m = distance_m;
    if (asks_of_motors && effort)
      motor_c = seconds > 0.0 ? look_at_motors(distance_m) : air_of_motors_->at_c(now) + most_k;
    return TimedStation{distance_m, now,   now,           over,          is_lit,
                        in_w,       out_w, course.charge, course.charge, motor_c};
  };
  bool halted = !halt;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const Place& place = places_[k];
    const double before_s = k == 0 ? 0.0 : places_[k - 1].elapsed_s;
    const double seconds = pace.time * (place.elapsed_s - before_s);
    // What more energy is needed goes into the same time's power.
    const TimedStation at = spend(place, seconds, pace.energy / pace.time);
    if (stations != nullptr && course.sun_is_known) stations->push_back(at);
    if (halted || place.distance_m < halt->at_m) continue;
    halted = true;
    for (double left = halt->hours * kHour_s; left > 0.0; left -= kHaltStep_s)
      spend(place, std::min(left, kHaltStep_s), std::nullopt);
  }
  course.arrives_ms = now;
  return course;
}

// How long the sun stays over the horizon of the last place, up to `enough_s`; nothing where it is not known.
std::optional<double> DriveInTime::light_left_s(std::int64_t from_ms, double enough_s) const {
  constexpr double kStep_s = 60.0, kNarrowed_s = 1.0;
  if (places_.empty()) return std::nullopt;
  const auto is_lit = [&](double s) -> std::optional<bool> {
    const auto sun = departure_.sky->sun(after(from_ms, s));
    if (!sun) return std::nullopt;
    return over_horizon_rad(places_.back(), over_level(places_.back(), *sun)) > 0.0;
  };
  // An earlier arrival may have shown that the sun shines on.
  const bool shines = from_ms >= lit_from_ms_ && from_ms <= lit_to_ms_;
  double s = shines ? std::min(enough_s, static_cast<double>(lit_to_ms_ - from_ms) / 1000.0) : 0.0;
  for (double lit_s = s;; lit_s = s, s = std::min(s + kStep_s, enough_s)) {
    const auto lit = is_lit(s);
    if (lit.value_or(false)) {
      if (!shines) lit_from_ms_ = from_ms;
      lit_to_ms_ = shines ? std::max(lit_to_ms_, after(from_ms, s)) : after(from_ms, s);
    }
    if (!lit) return std::nullopt;
    if (!*lit) {
      double dark_s = s;
      while (dark_s - lit_s > kNarrowed_s) {
        const double middle = 0.5 * (lit_s + dark_s);
        (is_lit(middle).value_or(false) ? lit_s : dark_s) = middle;
      }
      return lit_s;
    }
    if (s >= enough_s) return enough_s;
  }
}

void DriveInTime::judge(const Course& usual, const Course& slow, TimedDrive& drive) const {
  const DepartureRules& rules = departure_.rules;
  const auto add = [&](std::string name, bool is_known, double value, double low, double limit,
                       std::string unit, std::optional<double> at_m, std::string words) {
    // What is broken stays so, whatever is not known.
    JudgedRule rule{.name = std::move(name),
                    .verdict = low < limit ? Verdict::kNoGo
                               : is_known  ? Verdict::kGo
                                           : Verdict::kUnknown};
    rule.value = rule.high = value;
    rule.low = low;
    rule.go_below = rule.no_go_above = limit;
    rule.unit = std::move(unit);
    rule.at_m = at_m;
    rule.words = rule.verdict == Verdict::kUnknown
                     ? fmt::format("the table of the sky ends before {} is known: give a longer one",
                                   plain_name(rule.name))
                     : std::move(words);
    drive.rules.push_back(std::move(rule));
  };
  const bool sun_is_known = usual.sun_is_known && slow.sun_is_known;
  if (supply_) {
    const double least = std::min(usual.least_charge, slow.least_charge);
    const Course::Least& known =
        usual.charge_known.value < slow.charge_known.value ? usual.charge_known : slow.charge_known;
    // Without any sun from where the table ends there is no less.
    const bool is_known = sun_is_known || !supply_->has_array() || least >= known.limit;
    const double low = is_known ? least : std::min(known.value, departure_.charge);
    add("charge", is_known, 100.0 * usual.least_charge, 100.0 * low, 100.0 * known.limit, "%",
        known.broken_m.value_or(known.at_m),
        !known.broken_m
            ? fmt::format("the battery holds {:.1f} % or more, at the worse pace {:.1f} %, limit {:g} %",
                          100.0 * usual.least_charge, 100.0 * low, 100.0 * known.limit)
        : low < 0.0
            ? fmt::format("the battery falls below the limit of {:g} % at {:.1f} m, and is empty before "
                          "the arrival",
                          100.0 * known.limit, *known.broken_m)
            : fmt::format("the battery falls below the limit of {:g} % at {:.1f} m, to {} % at its lowest",
                          100.0 * known.limit, *known.broken_m,
                          number_beside(100.0 * low, 100.0 * known.limit, 1)));
  }
  if (motor_) {
    const auto motors = [&](const char* name, const char* which, double sign, std::optional<double> limit_c,
                            const Course::Least& a, const Course::Least& b) {
      if (!limit_c) return;
      const Course::Least& least = a.value < b.value ? a : b;
      const double worst_c = *limit_c + sign * least.value;
      add(name, departure_.noon_is_known, a.value, least.value, 0.0, "K", least.broken_m.value_or(least.at_m),
          least.broken_m
              ? fmt::format("the {} drive motor {} the limit of {:g} degC at {:.1f} m, to {:.0f} degC", which,
                            sign > 0.0 ? "falls below" : "rises above", *limit_c, *least.broken_m, worst_c)
              : fmt::format(
                    "the {} drive motor comes to {:.0f} degC, at the worse pace to {:.0f} degC, limit "
                    "{:g} degC",
                    which, *limit_c + sign * a.value, worst_c, *limit_c));
    };
    motors("motor_cold", "coldest", 1.0, rover_.drive.min_temp_c, usual.over_coldest_k, slow.over_coldest_k);
    motors("motor_hot", "hottest", -1.0, rover_.drive.max_temp_c, usual.below_warmest_k,
           slow.below_warmest_k);
  }
  const auto in_sight = [&](const char* name, const char* what, bool is_known, const Course::Least& a,
                            const Course::Least& b) {
    const Course::Least& least = a.value < b.value ? a : b;
    const double limit_deg = deg_from_rad(least.limit), lowest_deg = deg_from_rad(least.value);
    const bool is_hidden = least.value <= kHidden_rad;
    const double first_m = least.broken_m.value_or(least.at_m);
    std::string words =
        !least.broken_m
            ? fmt::format("{} stands {:.2f} deg high or more, limit {:.2f} deg", what, lowest_deg, limit_deg)
        : !is_hidden ? fmt::format(
                           "{} falls below the limit of {:.2f} deg at {:.1f} m, to {} deg at its "
                           "lowest",
                           what, limit_deg, first_m, number_beside(lowest_deg, limit_deg, 2))
        : least.at_m > first_m
            ? fmt::format(
                  "{} falls below the limit of {:.2f} deg at {:.1f} m, and is not in sight at {:.1f} m", what,
                  limit_deg, first_m, least.at_m)
            : fmt::format("{} is not in sight at {:.1f} m", what, first_m);
    add(name, is_known, deg_from_rad(a.value), lowest_deg, limit_deg, "deg", first_m, std::move(words));
  };
  if (rules.min_sun_rad) in_sight("sun", "the sun", sun_is_known, usual.sun_rad, slow.sun_rad);
  if (rules.min_earth_rad)
    in_sight("earth", "the Earth", usual.earth_is_known && slow.earth_is_known, usual.earth_rad,
             slow.earth_rad);
  if (rules.light_left_s) {
    const double enough = *rules.light_left_s;
    const auto at_usual = light_left_s(usual.arrives_ms, enough),
               at_slow = light_left_s(slow.arrives_ms, enough);
    const double left = at_slow.value_or(enough);
    add("light_left", at_usual && at_slow, at_usual.value_or(enough) / kHour_s, left / kHour_s,
        enough / kHour_s, "h", {},
        left < enough ? fmt::format("{} h of light are left at the arrival, limit {:g} h",
                                    number_beside(left / kHour_s, enough / kHour_s, 2), enough / kHour_s)
                      : fmt::format("{:.2f} h of light or more are left at the arrival", enough / kHour_s));
  }
  if (rules.arrive_by) {
    const auto hours_before = [&](std::int64_t at) {
      return static_cast<double>(*rules.arrive_by - at) / 3.6e6;
    };
    add("arrival", true, hours_before(usual.arrives_ms), hours_before(slow.arrives_ms), 0.0, "h", {},
        arrival_words(usual.arrives_ms, slow.arrives_ms, *rules.arrive_by));
  }
}

TimedDrive DriveInTime::at(std::int64_t departs_ms, bool keep_stations,
                           const std::optional<ChargingHalt>& halt) const {
  TimedDrive drive;
  std::vector<TimedStation> at_slow_pace;
  const Course usual = run(departs_ms, usual_, halt, keep_stations ? &drive.stations : nullptr);
  const Course slow = run(departs_ms, slow_, halt, keep_stations ? &at_slow_pace : nullptr);
  // The later of the two may come to where the sky is not known sooner.
  drive.stations.resize(std::min(drive.stations.size(), at_slow_pace.size()));
  for (std::size_t k = 0; k < drive.stations.size(); ++k) {
    drive.stations[k].charge_low = std::min(drive.stations[k].charge, at_slow_pace[k].charge);
    drive.stations[k].late_ms = at_slow_pace[k].utc_ms;
    drive.stations[k].motor_slow_c = at_slow_pace[k].motor_c;
  }
  drive.departs_ms = departs_ms;
  drive.arrives_ms = usual.arrives_ms;
  drive.arrives_late_ms = slow.arrives_ms;
  drive.charge_at_arrival = usual.charge;
  drive.charge_at_arrival_low = std::min(usual.charge, slow.charge);
  drive.least_charge = usual.least_charge;
  drive.least_charge_low = std::min(usual.least_charge, slow.least_charge);
  drive.lit_share = usual.total_s > 0.0 ? usual.lit_s / usual.total_s : 0.0;
  drive.gained_wh = usual.gained_wh;
  drive.used_wh = usual.used_wh;
  drive.spilled_wh = usual.spilled_wh;
  judge(usual, slow, drive);
  return drive;
}

}  // namespace slipway::planner
