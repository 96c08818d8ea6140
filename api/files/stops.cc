#include "api/files/stops.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "api/json/faults.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxStops = 10'000;

// Cells of a row; the tables that ship hold no quoted cells.
std::vector<std::string_view> cells_of(std::string_view row) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = row.find(',');
    cells.push_back(row.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    row.remove_prefix(comma + 1);
  }
}

bool read_metres(std::string_view cell, double& out) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), out);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(out);
}

struct Row {
  std::string_view text;
  std::size_t number;  // in the file, from 1
};

void read_stop(const std::vector<std::string_view>& header, const Row& row, Stop& stop,
               std::vector<Fault>& faults) {
  const auto cells = cells_of(row.text);
  if (cells.size() != header.size()) {
    faults.push_back({fmt::format("/{}", row.number), fmt::format("row {} has {} cells, the header has {}",
                                                                  row.number, cells.size(), header.size())});
    return;
  }
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (header[i] != "x_m" && header[i] != "y_m") {
      stop.columns.emplace_back(header[i], cells[i]);
    } else if (!read_metres(cells[i], header[i] == "x_m" ? stop.x_m : stop.y_m)) {
      faults.push_back({fmt::format("/{}/{}", row.number, header[i]),
                        fmt::format("row {}: {} = {}, must be a number in m", row.number, header[i],
                                    in_quotes(cells[i]))});
    }
  }
}

}  // namespace

Result<std::vector<Stop>> read_stops(std::string_view csv) {
  std::vector<Stop> stops;
  std::vector<Fault> faults;
  std::vector<std::string_view> header;
  std::size_t number = 0;
  while (!csv.empty()) {
    const std::size_t newline = csv.find('\n');
    std::string_view line = csv.substr(0, newline);
    csv.remove_prefix(newline == std::string_view::npos ? csv.size() : newline + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    ++number;
    if (line.empty()) continue;
    if (header.empty()) {
      header = cells_of(line);
      continue;
    }
    if (stops.size() == kMaxStops) {
      return fail(ErrorCode::kUnreadableData, fmt::format("more than {} stops", kMaxStops));
    }
    read_stop(header, {line, number}, stops.emplace_back(), faults);
  }
  for (const std::string_view column : {"x_m", "y_m"}) {
    if (std::count(header.begin(), header.end(), column) != 1) {
      faults.insert(faults.begin(), {fmt::format("/1/{}", column),
                                     fmt::format("the header must have the column {} once", column)});
    }
  }
  if (!faults.empty()) return fail(ErrorCode::kUnreadableData, summary_of(faults), faults);
  return stops;
}

}  // namespace slipway::api
