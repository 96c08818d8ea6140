#include "api/files/campaign/import_wheel_order.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/files/campaign/best_assignment.h"
#include "api/files/campaign/import_attitude.h"
#include "core/angle.h"

namespace slipway::api {
namespace {

using sim::WheelCommand;

class OrderJudge {
 public:
  explicit OrderJudge(const ImportedWheels& wheels) : wheels_(wheels) {}

  std::vector<std::string> warnings() {
    judge_order();
    return std::move(warnings_);
  }

 private:
  // By how much a wheel's readings differ from what another was told, over all drives that turn; 1 is 0.1 rad
  // or a tenth of the greatest rate in each of them.
  double cost(std::size_t wheel, std::size_t as, const std::vector<double>& sense, bool otherwise) const {
    constexpr double kSteer_rad = 0.1, kRelativeRate = 0.1;
    double sum = 0.0;
    for (const DriveOfWheels& drive : wheels_.drives()) {
      if (!drive.turns) continue;
      const std::vector<WheelCommand>& told = otherwise ? drive.told_otherwise : drive.told;
      const double steer = (sense[wheel] * drive.steer_rad[wheel] - told[as].steer_rad) / kSteer_rad;
      const double rate = (relative(drive.rate_rad_s)[wheel] - relative(rates_of(told))[as]) / kRelativeRate;
      if (std::isfinite(steer)) sum += steer * steer;
      if (std::isfinite(rate)) sum += rate * rate;
    }
    return sum;
  }

  double cost_of(const std::vector<std::size_t>& order, const std::vector<double>& sense,
                 bool otherwise) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < wheels_.count(); ++k) sum += cost(k, order[k], sense, otherwise);
    return sum;
  }

  std::size_t readings() const {
    std::size_t count = 0;
    for (const DriveOfWheels& drive : wheels_.drives())
      for (std::size_t k = 0; drive.turns && k < wheels_.count(); ++k)
        count +=
            (std::isfinite(drive.rate_rad_s[k]) ? 1U : 0U) + (std::isfinite(drive.steer_rad[k]) ? 1U : 0U);
    return count;
  }

  // The sense in which each wheel's steering angles were recorded, by the commanded ones: 1 or -1.
  std::vector<double> senses_of_steering() const {
    std::vector<double> senses;
    for (std::size_t k = 0; k < wheels_.count(); ++k) {
      double both = 0.0, told = 0.0;
      for (const DriveOfWheels& drive : wheels_.drives()) {
        if (!drive.turns || !std::isfinite(drive.steer_rad[k])) continue;
        both += drive.steer_rad[k] * drive.told[k].steer_rad;
        told += drive.told[k].steer_rad * drive.told[k].steer_rad;
      }
      senses.push_back(both < kOtherSense * told ? -1.0 : 1.0);
    }
    return senses;
  }

  std::vector<std::size_t> best_order() const {
    std::vector<std::vector<double>> costs(wheels_.count(), std::vector<double>(wheels_.count()));
    const std::vector<double> as_read(wheels_.count(), 1.0);
    for (std::size_t i = 0; i < wheels_.count(); ++i)
      for (std::size_t k = 0; k < wheels_.count(); ++k)
        costs[i][k] = cost(i, k, as_read, false) + (i == k ? 0.0 : 1e-6);  // as read where orders agree alike
    return best_assignment(costs);
  }

  // Explanations of readings that are not those of the commanded turns, the simpler before the less simple.
  void judge_order() {
    constexpr double kAsTold = 1.0, kExplains = 0.3, kAsGood = 1.5;
    constexpr double kNearlyAsTold = 0.03, kExplainsAll = 0.1;  // of gentle turns, which differ by little
    const std::size_t count = readings();
    if (count == 0) {
      judge_sense_of_turns(false, false);
      return;
    }
    std::vector<std::size_t> as_read(wheels_.count());
    std::iota(as_read.begin(), as_read.end(), 0U);
    const std::vector<double> one(wheels_.count(), 1.0), senses = senses_of_steering();
    const double read = cost_of(as_read, one, false), floor = 0.005 * static_cast<double>(count);
    const double otherwise = cost_of(as_read, one, true);
    const double turned = cost_of(as_read, senses, false);
    const std::vector<std::size_t> order = best_order();
    const double ordered = cost_of(order, one, false);
    const double reads = static_cast<double>(count), best = std::min({otherwise, turned, ordered});
    const bool fits = read < kNearlyAsTold * reads || (read < kAsTold * reads && best > kExplainsAll * read);
    if (judge_sense_of_turns(fits, otherwise < kExplains * read) || fits) return;
    if (turned < kExplains * read && turned < kAsGood * ordered + floor)
      tell_sense_of_steering(senses, ordered < kAsGood * turned + floor ? order : as_read);
    else if (ordered < kExplains * read)
      tell_order(order);
    else
      tell_no_order();
  }

  // Returns whether headings were against the commanded turns, which then is told.
  bool judge_sense_of_turns(bool wheels_as_told, bool wheels_otherwise) {
    std::vector<double> shares;
    for (const DriveOfWheels& drive : wheels_.drives())
      if (drive.turns) shares.push_back(drive.yaw_share);
    const auto half = median_of(std::move(shares));
    if (!half || *half >= kOtherSense) return false;
    const std::string yaw =
        wheels_.campaign().columns.empty() ? "" : key_words(wheels_.campaign(), yaw_key());
    const std::string of_yaw = yaw_key() == kAttitudeKey
                                   ? fmt::format("change the keys order and inverse of {}", yaw)
                                   : fmt::format("change the key sign of {}, or frame.axes", yaw);
    const std::string of_drives = fmt::format(
        "change the sign of curvature_1_m and turn_rate_deg_s of the drives of {} (positive turns left)",
        wheels_.campaign().mapping_file);
    warnings_.push_back(fmt::format(
        "in half of the drives that turn the heading turned by {:.2f} times the commanded angle or less, as "
        "read from {}; expected is about 1. {}",
        *half, sources_of(wheels_.campaign(), yaw_key()),
        wheels_as_told     ? "The wheels turned as commanded, so " + of_yaw
        : wheels_otherwise ? "The wheels turned to that side too, so " + of_drives
                           : fmt::format("Either {}, or {}", of_drives, of_yaw)));
    return true;
  }

  std::string_view yaw_key() const {
    for (const ImportedColumn& column : wheels_.campaign().columns)
      if (column.to == "yaw_deg") return column.key;
    return "yaw_deg";
  }

  // The [wheels] of the mapping in that order, or which wheel's columns are whose where it has none.
  std::string order_words(const std::vector<std::size_t>& order) const {
    std::vector<std::string> words;
    for (std::size_t k = 0; k < wheels_.count(); ++k) {
      const auto slot = static_cast<std::size_t>(std::find(order.begin(), order.end(), k) - order.begin());
      const std::string &own = wheels_.rover().wheels[k].name, &other = wheels_.rover().wheels[slot].name;
      const auto names = std::find_if(wheels_.campaign().wheels.begin(), wheels_.campaign().wheels.end(),
                                      [&](const WheelNames& wheel) { return wheel.own == other; });
      if (names != wheels_.campaign().wheels.end())
        words.push_back(fmt::format("{} = \"{}\"", own, names->theirs));
      else if (slot != k)
        words.push_back(fmt::format("{}_... from the columns that {}_... are read from now", own, other));
    }
    return fmt::format("{}: change {} of {}", fmt::join(words, ", "),
                       wheels_.campaign().wheels.empty() ? "[columns]" : "[wheels]",
                       wheels_.campaign().mapping_file);
  }

  // The wheels that are read to steer though they can't, and those that are not though they are told to.
  std::string steering_words() const {
    constexpr double kSteers_rad = rad_from_deg(3.0);
    std::vector<std::size_t> wrongly, idle;
    double most = 0.0;
    for (std::size_t k = 0; k < wheels_.count(); ++k) {
      double recorded = 0.0, told = 0.0;
      for (const DriveOfWheels& drive : wheels_.drives()) {
        if (!drive.turns || !std::isfinite(drive.steer_rad[k])) continue;
        recorded = std::max(recorded, std::abs(drive.steer_rad[k]));
        told = std::max(told, std::abs(drive.told[k].steer_rad));
      }
      if (!wheels_.rover().wheels[k].steerable && recorded > kSteers_rad) {
        wrongly.push_back(k);
        most = std::max(most, recorded);
      }
      if (wheels_.rover().wheels[k].steerable && wheels_.column_of(k, kSteerColumn) != nullptr &&
          told > kSteers_rad && recorded < 0.2 * told)
        idle.push_back(k);
    }
    std::string words;
    if (!wrongly.empty())
      words +=
          fmt::format("; {}, which can't steer, show steering angles of up to {:.3g} deg (read from {})",
                      wheels_.names_of(wrongly), deg_from_rad(most), wheels_.sources(wrongly, kSteerColumn));
    if (!idle.empty())
      words += fmt::format("; {}, which can, show none while turning (read from {})", wheels_.names_of(idle),
                           wheels_.sources(idle, kSteerColumn));
    return words;
  }

  // Wheels whose rates are further from what they were told than a tenth of the greatest.
  std::string rate_words() const {
    constexpr double kOff = 0.1;
    std::vector<std::size_t> off;
    for (std::size_t k = 0; k < wheels_.count(); ++k) {
      double furthest = 0.0;
      for (const DriveOfWheels& drive : wheels_.drives()) {
        const double by = std::abs(relative(drive.rate_rad_s)[k] - relative(rates_of(drive.told))[k]);
        if (drive.turns && std::isfinite(by)) furthest = std::max(furthest, by);
      }
      if (furthest > kOff) off.push_back(k);
    }
    if (off.empty()) return "";
    return fmt::format(
        "; the rates of {} are not those of the commanded curves, on which inner wheels turn "
        "slower than outer ones (read from {})",
        wheels_.names_of(off), wheels_.sources(off, kRateColumn));
  }

  void tell_order(const std::vector<std::size_t>& order) {
    warnings_.push_back(fmt::format(
        "the wheels seem to be read in another order than the logs have them{}{}. The order that agrees best "
        "with the commanded turns is {}",
        steering_words(), rate_words(), order_words(order)));
  }

  void tell_no_order() {
    const std::string words = steering_words();  // rates of a wheel that is stuck are what they are
    if (words.empty()) return;
    warnings_.push_back(
        fmt::format("the wheels' readings are not those of the commanded turns{}. No order of the wheels "
                    "agrees with them: "
                    "look at curvature_1_m of the drives, and at [wheels] and [columns] of {}",
                    words, wheels_.campaign().mapping_file));
  }

  void tell_sense_of_steering(const std::vector<double>& senses, const std::vector<std::size_t>& order) {
    std::vector<std::size_t> turned;
    bool all_that_steer = true;
    for (std::size_t k = 0; k < wheels_.count(); ++k) {
      if (senses[k] < 0.0) turned.push_back(k);
      all_that_steer = all_that_steer && (senses[k] < 0.0 || !wheels_.rover().wheels[k].steerable);
    }
    // Wheels that don't steer have zeros, whose sign is no matter.
    std::vector<std::size_t> named = turned;
    for (std::size_t k = 0; k < wheels_.count() && all_that_steer; ++k)
      if (!wheels_.rover().wheels[k].steerable) named.push_back(k);
    const bool other_order = !std::is_sorted(order.begin(), order.end());
    warnings_.push_back(fmt::format(
        "the steering angles of {} are of the other sign than commanded, as read from {}; expected is that "
        "positive ones point to the left. If they were recorded in the other sense, {}{}",
        wheels_.names_of(turned), wheels_.sources(turned, kSteerColumn), wheels_.remedy(named, kSteerColumn),
        other_order
            ? fmt::format("; if the logs list the wheels in another order, it is {}", order_words(order))
            : ""));
  }

  const ImportedWheels& wheels_;
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> order_warnings(const ImportedWheels& wheels) {
  return OrderJudge(wheels).warnings();
}

}  // namespace slipway::api
