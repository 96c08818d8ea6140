#include "api/files/campaign/import_attitude.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/pose.h"

namespace slipway::api {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

// Whether the squares of four columns add up to 1 in every row that has them, and more than one row does.
bool are_unit(const RecordedTable& table, const std::array<std::size_t, 4>& places) {
  constexpr double kOff = 1e-3;
  std::size_t rows = 0;
  for (const std::vector<double>& row : table.rows) {
    double squares = 0.0;
    for (const std::size_t place : places) squares += row[place] * row[place];
    if (std::isnan(squares)) continue;
    if (std::abs(squares - 1.0) > kOff) return false;
    ++rows;
  }
  return rows > 1;
}

bool is_constant(const RecordedTable& table, std::size_t place) {
  return std::all_of(table.rows.begin(), table.rows.end(),
                     [&](const std::vector<double>& row) { return row[place] == table.rows.front()[place]; });
}

// The columns x, y, z and w with the stem of this one's name: "orientation.x", "q_w".
std::optional<std::array<std::size_t, 4>> parts_beside(const RecordedTable& table, const std::string& name) {
  std::array<std::size_t, 4> places{};
  for (std::size_t k = 0; k < places.size(); ++k) {
    std::string part = name.substr(0, name.size() - 1);
    part += "xyzw"[k];
    auto place = table.place_of(part);
    part.back() = "XYZW"[k];
    if (!place) place = table.place_of(part);
    if (!place) return std::nullopt;
    places[k] = *place;
  }
  return places;
}

// The mapped three and a fourth that nothing asked for.
std::optional<std::array<std::size_t, 4>> with_a_fourth(const RecordedTable& table,
                                                        const std::vector<std::size_t>& mapped) {
  if (mapped.size() != 3) return std::nullopt;
  for (std::size_t fourth = 0; fourth < table.names.size(); ++fourth) {
    const std::array<std::size_t, 4> places{mapped[0], mapped[1], mapped[2], fourth};
    if (std::find(mapped.begin(), mapped.end(), fourth) == mapped.end() && !is_constant(table, fourth) &&
        are_unit(table, places))
      return places;
  }
  return std::nullopt;
}

}  // namespace

std::array<std::vector<double>, 3> angles_of_quaternions(const ImportAttitude& attitude,
                                                         const std::string& file, const RecordedTable& table,
                                                         std::vector<Fault>& faults) {
  constexpr double kOff = 0.02;  // of the length: what rounding to two digits leaves
  std::array<std::size_t, 4> places{};
  for (std::size_t k = 0; k < places.size(); ++k) places[k] = *table.place_of(attitude.from[k]);
  std::array<std::vector<double>, 3> angles;
  std::vector<std::size_t> bad;
  double bad_length = 0.0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<double>& row = table.rows[i];
    Eigen::Quaterniond q(row[places[3]], row[places[0]], row[places[1]], row[places[2]]);
    const double length = q.norm();
    if (std::abs(length - 1.0) > kOff) {
      if (bad.empty()) bad_length = length;
      bad.push_back(table.lines[i]);
    }
    q.normalize();
    if (attitude.inverse) q = q.conjugate();
    const Attitude a = attitude_of(q.toRotationMatrix());
    const std::array<double, 3> rad{a.roll_rad, a.pitch_rad, a.yaw_rad};
    for (std::size_t k = 0; k < rad.size(); ++k)
      angles[k].push_back(std::isfinite(length) ? deg_from_rad(rad[k]) : kMissing);
  }
  if (!bad.empty())
    faults.push_back(
        {fmt::format("{}#/{}", file, bad.front()),
         fmt::format("{}, line {} ({}): the quaternion has the length {:.3g}, must have 1: look at "
                     "attitude.from of the mapping, or leave the cells empty{}",
                     file, bad.front(), fmt::join(attitude.from, " "), bad_length, other_lines(bad))});
  return angles;
}

std::optional<std::string> quaternion_as_angles(const ImportMapping& mapping, const RecordedTable& table) {
  std::vector<std::size_t> mapped;
  std::vector<std::string_view> to;
  for (const std::string_view angle : kAttitudeColumns)
    for (const ImportColumn& column : mapping.columns)
      if (column.to == angle)
        if (const auto place = table.place_of(column.from)) {
          mapped.push_back(*place);
          to.push_back(angle);
        }
  std::optional<std::array<std::size_t, 4>> parts;
  for (const std::size_t place : mapped)
    if (const auto beside = parts_beside(table, table.names[place]);
        !parts && beside && are_unit(table, *beside))
      parts = beside;
  if (!parts) parts = with_a_fourth(table, mapped);
  if (!parts) return std::nullopt;
  std::vector<std::string> names;
  for (const std::size_t place : *parts) names.push_back(fmt::format("\"{}\"", table.names[place]));
  return fmt::format(
      "{} {} read from parts of a quaternion: the squares of {} add up to 1 in every row. In place of {} "
      "under "
      "[columns], {} needs the table [attitude] with from = [{}] and order = \"xyzw\" (the order of x, y, z "
      "and w in from)",
      fmt::join(to, ", "), to.size() == 1 ? "is" : "are", fmt::join(names, ", "), fmt::join(to, ", "),
      mapping.file, fmt::join(names, ", "));
}

double delayed(const std::vector<double>& time_s, const std::vector<double>& values, std::size_t row,
               double delay_s, double turn) {
  if (delay_s == 0.0) return values[row];
  const double at = time_s[row] + delay_s;
  const auto next = std::lower_bound(time_s.begin(), time_s.end(), at);
  if (next == time_s.end() || (next == time_s.begin() && *next > at)) return kMissing;
  const auto j = static_cast<std::size_t>(next - time_s.begin());
  if (*next == at) return values[j];
  const double share = (at - time_s[j - 1]) / (time_s[j] - time_s[j - 1]);
  const double before = values[j - 1], after = values[j];
  if (turn == 0.0 || !(std::abs(after - before) > 0.5 * turn)) return before + share * (after - before);
  // The same direction as the recorded ones are written in: from 0 to a turn, or from minus half a turn on.
  const double there = before + share * std::remainder(after - before, turn);
  const double lowest = std::min(before, after) < 0.0 ? -0.5 * turn : 0.0;
  return there - turn * std::floor((there - lowest) / turn);
}

void blank_ends_of_delays(const std::vector<ImportedColumn>& columns, const std::vector<double>& log_s,
                          ImportedDrive& made) {
  constexpr std::array<std::string_view, 3> kPosition{"x_m", "y_m", "z_m"};
  for (const auto& group : {kPosition, kAttitudeColumns}) {
    std::vector<std::size_t> parts;
    double least_s = 0.0, most_s = 0.0;
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const ImportedColumn& column = columns[c];
      if (std::find(group.begin(), group.end(), column.to) == group.end()) continue;
      parts.push_back(c);
      least_s = std::min(least_s, column.delay_s);
      most_s = std::max(most_s, column.delay_s);
    }
    for (std::size_t i = 0; i < made.time_s.size(); ++i)
      if (made.time_s[i] + most_s > log_s.back() || made.time_s[i] + least_s < log_s.front())
        for (const std::size_t c : parts) made.values[c][i] = kMissing;
  }
}

}  // namespace slipway::api
