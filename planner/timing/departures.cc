#include "planner/timing/departures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/utc.h"
#include "planner/timing/drive_in_time.h"

namespace slipway::planner {
namespace {

constexpr int kHaltPlaces = 20;
constexpr std::int64_t kHaltDepartures = 100;  // that are tried with a halt
constexpr double kLongest_s = 60.0 * 86400.0;  // beyond it nothing is known of the sky
constexpr std::array<double, 10> kHaltHours{0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 24.0, 48.0};
constexpr std::int64_t kNarrowed_ms = 1000;
constexpr double kLook_ms = 60'000.0;  // between moments at which the rules are looked at
constexpr double kMostLooks = 10'000.0;

bool keeps_rules(const TimedDrive& drive) {
  return std::all_of(drive.rules.begin(), drive.rules.end(),
                     [](const JudgedRule& rule) { return rule.verdict == Verdict::kGo; });
}

// The worst verdict of the rules, and how many do not hold.
std::pair<int, std::ptrdiff_t> broken(const TimedDrive& drive) {
  int worst = 0;
  for (const JudgedRule& rule : drive.rules) worst = std::max(worst, severity(rule.verdict));
  return {worst, std::count_if(drive.rules.begin(), drive.rules.end(),
                               [](const JudgedRule& rule) { return rule.verdict != Verdict::kGo; })};
}

// More charge would make it keep the rules.
bool lacks_charge_alone(const TimedDrive& drive) {
  return broken(drive).second == 1 &&
         std::any_of(drive.rules.begin(), drive.rules.end(), [](const JudgedRule& rule) {
           return rule.name == "charge" && rule.verdict == Verdict::kNoGo;
         });
}

// When the sun stands highest, of a day about the first departure that the sky knows; nothing where it knows
// none.
std::optional<std::int64_t> noon_of(const Departure& departure) {
  constexpr int kLooks = 288;
  for (const double begin : {0.0, -0.5, -1.0}) {
    std::int64_t noon = 0;
    double highest = -2.0;
    bool is_known = true;
    for (int k = 0; is_known && k < kLooks; ++k) {
      const std::int64_t at = departure.from_ms + std::llround(1000.0 * departure.day_s *
                                                               (begin + static_cast<double>(k) / kLooks));
      const auto sun = departure.sky->sun(at);
      is_known = sun.has_value();
      if (!sun || sun->elevation_rad <= highest) continue;
      highest = sun->elevation_rad;
      noon = at;
    }
    if (is_known) return noon;
  }
  return std::nullopt;
}

// The rules that do not hold, by their names.
std::vector<std::string> broken_rules(const TimedDrive& drive) {
  std::vector<std::string> names;
  for (const JudgedRule& rule : drive.rules)
    if (rule.verdict != Verdict::kGo) names.push_back(rule.name);
  return names;
}

// Whether all of these hold.
bool keeps(const TimedDrive& drive, const std::vector<std::string>& names) {
  return std::all_of(drive.rules.begin(), drive.rules.end(), [&](const JudgedRule& rule) {
    return rule.verdict == Verdict::kGo || std::find(names.begin(), names.end(), rule.name) == names.end();
  });
}

// The moment nearest to `bad` at which `holds` holds of the drive.
template <class Holds>
std::int64_t edge_of(const DriveInTime& drive, std::int64_t good, std::int64_t bad, const Progress& progress,
                     const Holds& holds) {
  while (std::abs(bad - good) > kNarrowed_ms && !progress.cancelled()) {
    const std::int64_t middle = good + (bad - good) / 2;
    (holds(drive.at(middle)) ? good : bad) = middle;
  }
  return good;
}

// The window between two moments that break rules, where what breaks first holds before others break.
std::optional<DepartureWindow> window_between(const DriveInTime& drive, const TimedDrive& before,
                                              const TimedDrive& after, const Progress& progress) {
  const std::vector<std::string> names = broken_rules(before);
  if (!keeps(after, names)) return std::nullopt;
  const std::int64_t from = edge_of(drive, after.departs_ms, before.departs_ms, progress,
                                    [&](const TimedDrive& timed) { return keeps(timed, names); });
  if (!keeps_rules(drive.at(from))) return std::nullopt;
  return DepartureWindow{from, edge_of(drive, from, after.departs_ms, progress, keeps_rules)};
}

struct WithHalt {
  ChargingHalt halt;
  TimedDrive drive;
};

// The shortest halt at a place, to a minute, with which the rules hold.
std::optional<WithHalt> halt_at(const DriveInTime& drive, std::int64_t departs_ms, double at_m,
                                double most_hours) {
  const std::vector<std::string> charge{"charge"};
  const auto halting = [&](double hours) {
    return WithHalt{{at_m, hours}, drive.at(departs_ms, false, ChargingHalt{at_m, hours})};
  };
  double too_short = 0.0;
  bool was_charged = false;
  for (const double hours : kHaltHours) {
    WithHalt with = halting(hours);
    if (!was_charged && keeps(with.drive, charge)) {
      was_charged = true;
      WithHalt shortest = with;
      while (60.0 * (shortest.halt.hours - too_short) > 1.0) {
        WithHalt between = halting(0.5 * (too_short + shortest.halt.hours));
        if (keeps(between.drive, charge))
          shortest = std::move(between);
        else
          too_short = between.halt.hours;
      }
      if (keeps_rules(shortest.drive)) return shortest;
    }
    if (keeps_rules(with.drive)) return with;
    if (!was_charged) too_short = hours;
    if (hours > most_hours) break;
  }
  return std::nullopt;
}

std::optional<WithHalt> with_halt(const DriveInTime& drive, double length_m, const Departure& departure,
                                  Progress& progress) {
  std::optional<WithHalt> earliest;
  const std::int64_t span_ms = departure.to_ms - departure.from_ms;
  const std::int64_t steps = std::min<std::int64_t>(kHaltDepartures, span_ms / std::llround(kLook_ms));
  for (std::int64_t k = 0; k <= steps; ++k) {
    const TimedDrive direct = drive.at(departure.from_ms + (steps > 0 ? k * (span_ms / steps) : 0));
    if (!lacks_charge_alone(direct)) continue;
    progress.report("looking for a halt to charge", static_cast<double>(k) / static_cast<double>(steps + 1));
    for (int place = 0; place < kHaltPlaces; ++place) {
      if (progress.cancelled()) return std::nullopt;
      // A longer one can't come earlier than the earliest.
      const double most_hours =
          earliest ? static_cast<double>(earliest->drive.arrives_ms - direct.arrives_ms) / 3.6e6
                   : kHaltHours.back();
      if (most_hours <= 0.0) break;
      auto found = halt_at(drive, direct.departs_ms, length_m * place / kHaltPlaces, most_hours);
      if (found && (!earliest || found->drive.arrives_ms < earliest->drive.arrives_ms))
        earliest = std::move(found);
    }
  }
  return earliest;
}

}  // namespace

DepartureWindow to_the_minute(const DepartureWindow& window) {
  using std::chrono::milliseconds, std::chrono::minutes, std::chrono::seconds;
  const milliseconds from(window.from_ms), to(window.to_ms);
  const auto within = [](milliseconds first, milliseconds last) {
    return DepartureWindow{first.count(), last.count()};
  };
  const DepartureWindow whole_minutes =
      within(std::chrono::ceil<minutes>(from), std::chrono::floor<minutes>(to));
  if (whole_minutes.from_ms <= whole_minutes.to_ms) return whole_minutes;
  const DepartureWindow whole_seconds =
      within(std::chrono::ceil<seconds>(from), std::chrono::floor<seconds>(to));
  return whole_seconds.from_ms <= whole_seconds.to_ms ? whole_seconds : window;
}

Departures departures_of(const Departure& departure, const sim::RoverModel& rover,
                         const sim::DrivePrediction& prediction, Progress& progress) {
  Departure at_hand = departure;
  if (departure.air) {
    const auto noon = noon_of(departure);
    at_hand.noon_is_known = noon.has_value();
    at_hand.noon_ms = noon.value_or(departure.from_ms);
  }
  if (!departure.sky->is_table()) {
    const double longest_s =
        std::min(kLongest_s, 4.0 * prediction.duration_s + 3600.0 * (kHaltHours.back() + 24.0) +
                                 departure.rules.light_left_s.value_or(0.0));
    at_hand.sky = std::make_shared<sky::SkyTable>(
        sky::table_of(*departure.sky, departure.from_ms, departure.to_ms + std::llround(1000.0 * longest_s),
                      departure.rules.min_earth_rad.has_value()));
  }
  const DriveInTime drive(at_hand, rover, prediction, progress);
  Departures found;
  const double span_ms = static_cast<double>(departure.to_ms - departure.from_ms) + 1.0;
  const std::int64_t step_ms = std::llround(1000.0 * departure.every_s);
  const auto looks = static_cast<std::int64_t>(
      std::ceil(static_cast<double>(step_ms) / std::max(kLook_ms, span_ms / kMostLooks)));
  const auto is_nearer = [](const TimedDrive& a, const TimedDrive& b) {
    return std::pair(broken(a), -a.charge_at_arrival_low) < std::pair(broken(b), -b.charge_at_arrival_low);
  };
  std::optional<TimedDrive> nearest;
  const auto consider = [&](const TimedDrive& timed) {
    if (!nearest || is_nearer(timed, *nearest)) nearest = timed;
  };
  std::optional<TimedDrive> before;  // at the moment looked at before this one
  bool held = false;                 // the rules, then
  for (std::int64_t k = 0; !progress.cancelled(); ++k) {
    const std::int64_t at = std::min(departure.from_ms + k * step_ms / looks, departure.to_ms);
    progress.report("looking for departures", static_cast<double>(at - departure.from_ms) / span_ms);
    TimedDrive timed = drive.at(at);
    const bool holds = keeps_rules(timed);
    if (holds && !held)
      found.windows.push_back(
          {before ? edge_of(drive, at, before->departs_ms, progress, keeps_rules) : at, at});
    else if (!holds && held)
      found.windows.back().to_ms = edge_of(drive, before->departs_ms, at, progress, keeps_rules);
    else if (!holds && before)
      if (const auto window = window_between(drive, *before, timed, progress)) {
        found.windows.push_back(*window);
        consider(drive.at(window->from_ms));
      }
    if (holds) found.windows.back().to_ms = at;
    held = holds;
    before = timed;
    consider(timed);
    const bool is_last = at >= departure.to_ms;
    if (k % looks == 0 || is_last) found.tried.push_back(std::move(timed));
    if (is_last) break;
  }
  if (found.tried.empty()) return found;
  std::int64_t departs_ms = nearest->departs_ms;
  if (found.windows.empty())
    if (const auto halting = with_halt(drive, prediction.length_m, departure, progress)) {
      found.halt = halting->halt;
      departs_ms = halting->drive.departs_ms;
    }
  found.drive = drive.at(departs_ms, true, found.halt);
  return found;
}

void judge_departures(const Departures& departures, DriveVerdict& verdict) {
  const TimedDrive& drive = departures.drive;
  std::vector<std::string> why;
  for (const JudgedRule& rule : drive.rules)
    if (rule.verdict != Verdict::kGo) why.push_back(rule.words);
  if (!departures.is_kept() && !why.empty()) {
    const int worst = broken(drive).first;
    const bool is_open = worst == severity(Verdict::kUnknown);
    std::string words =
        fmt::format("no departure {} the rules of the day; at {} {}", is_open ? "is known to keep" : "keeps",
                    utc_words(drive.departs_ms), why.front());
    for (std::size_t k = 1; k < why.size(); ++k) words += "; " + why[k];
    const bool decides = worst > severity(verdict.verdict);
    verdict.reasons.insert(decides ? verdict.reasons.begin() : verdict.reasons.end(), std::move(words));
  } else if (departures.halt) {
    std::string words = fmt::format(
        "{} the rover must wait for {:.2f} h {} to charge, without which no departure keeps the rules of the "
        "day; its commands hold no wait",
        departures.halt->at_m > 0.0 ? fmt::format("departing at {}", utc_words(drive.departs_ms))
                                    : fmt::format("from {} on", utc_words(drive.departs_ms)),
        departures.halt->hours,
        departures.halt->at_m > 0.0 ? fmt::format("at {:.1f} m", departures.halt->at_m)
                                    : std::string("where it stands, before it drives,"));
    const bool decides = verdict.verdict == Verdict::kGo;
    verdict.reasons.insert(decides ? verdict.reasons.begin() : verdict.reasons.end(), std::move(words));
  } else if (!departures.windows.empty()) {
    const DepartureWindow first = to_the_minute(departures.windows.front());
    verdict.reasons.push_back(
        departures.tried.size() == 1
            ? fmt::format("a departure at {} keeps the rules of the day", utc_words(drive.departs_ms))
            : fmt::format("a departure between {} and {}{} keeps the rules of the day, best at {}",
                          utc_words(first.from_ms), utc_words(first.to_ms),
                          departures.windows.size() > 1 ? " and in later windows" : "",
                          utc_words(drive.departs_ms)));
  }
  for (const JudgedRule& rule : drive.rules) add_rule(rule, verdict);
}

void add_departures(const PlanProblem& problem, const sim::DrivePrediction& prediction, DriveVerdict& verdict,
                    Progress& progress) {
  if (!problem.departure || prediction.stations.empty()) return;
  auto found = std::make_shared<const Departures>(
      departures_of(*problem.departure, *problem.rover, prediction, progress));
  if (found->tried.empty()) return;
  judge_departures(*found, verdict);
  verdict.departures = std::move(found);
}

}  // namespace slipway::planner
