#include "steps/slip_steps_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/angle.h"
#include "core/csv_cells.h"
#include "core/fault_words.h"
#include "steps/step_columns.h"

namespace slipway::steps {
namespace {

constexpr std::size_t kMaxFaults = 20;
constexpr std::size_t kMaxUnitBytes = 64;
constexpr std::string_view kFormatLine = "# slip-steps/1";

// Two columns of which a table has one: rows of Curiosity name the one, rows of Perseverance the other.
struct Synonyms {
  StepColumn usual, other;
  bool required;
};
constexpr std::array<Synonyms, 5> kSynonyms{{{kOdometry, kNominal, true},
                                             {kSlip, kNominalSlip, true},
                                             {kSiteEast, kEast, false},
                                             {kSiteNorth, kNorth, false},
                                             {kDriveTime, kStepTime, false}}};

class Reader {
 public:
  explicit Reader(std::string_view file) : file_(file) {}

  Result<std::vector<SlipStep>> read(std::string_view text) {
    refuse_odd_bytes(text);
    std::vector<CsvLine> lines;
    if (faults_.empty()) lines = csv_lines(text);
    const std::size_t header = !lines.empty() && csv_cells(lines[0].text)[0].starts_with('#') ? 1 : 0;
    if (header == 1 && csv_cells(lines[0].text)[0] != kFormatLine)
      fault(line_of(lines[0]), fmt::format("{}, must be \"{}\" or the header",
                                           in_quotes(csv_cells(lines[0].text)[0]), kFormatLine));
    const std::size_t rows = lines.size() > header ? lines.size() - header - 1 : 0;
    if (faults_.empty() && rows == 0)
      fault(std::string(file_), "there must be a header and a row or more");
    else if (rows > kMaxSteps)
      fault(std::string(file_), fmt::format("{} rows, must be {} at most", rows, kMaxSteps));
    if (faults_.empty()) read_lines(lines, header);
    if (faults_.empty()) return std::move(steps_);
    if (more_ > 0) faults_.push_back({std::string(file_), fmt::format("{} faults more like these", more_)});
    return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file_), std::move(faults_));
  }

 private:
  void fault(std::string place, std::string message) {
    if (faults_.size() < kMaxFaults)
      faults_.push_back({std::move(place), std::move(message)});
    else
      ++more_;
  }
  std::string line_of(const CsvLine& line) const { return fmt::format("{}, line {}", file_, line.number); }

  // A quote would make commas part of a cell, and a NUL byte is in no table: neither is guessed at.
  void refuse_odd_bytes(std::string_view text) {
    constexpr std::string_view kOdd("\"\0", 2);
    std::size_t line = 1, counted = 0;
    for (std::size_t at = text.find_first_of(kOdd);
         at != std::string_view::npos && faults_.size() < kMaxFaults; at = text.find_first_of(kOdd, at + 1)) {
      line += static_cast<std::size_t>(std::count(text.begin() + counted, text.begin() + at, '\n'));
      counted = at;
      fault(fmt::format("{}, line {}, byte {}", file_, line, at),
            text[at] == '"' ? "a quote: no cell of this format needs one" : "a NUL byte");
    }
  }

  void read_lines(const std::vector<CsvLine>& lines, std::size_t header) {
    read_header(lines[header]);
    if (!faults_.empty() || more_ > 0) return;
    steps_.reserve(lines.size() - header - 1);
    for (std::size_t k = header + 1; k < lines.size(); ++k) read_row(lines[k]);
  }

  void read_header(const CsvLine& line) {
    if (auto wrong = wrong_separator(line.text, ',')) return fault(line_of(line), std::move(*wrong));
    std::vector<std::string> known;
    for (const StepColumnRow& column : kStepColumnRows) known.emplace_back(column.name);
    std::vector<Fault> found;
    header_ = read_csv_header(line, file_, known, found);
    for (Fault& each : found) fault(std::move(each.pointer), std::move(each.message));
    if (!found.empty()) return;
    if (!has(kSol)) fault(line_of(line), "there is no column sol");
    for (const Synonyms& pair : kSynonyms) {
      const std::string_view usual = kStepColumnRows[pair.usual].name,
                             other = kStepColumnRows[pair.other].name;
      if (has(pair.usual) && has(pair.other))
        fault(line_of(line), fmt::format("columns {} and {} exclude each other", usual, other));
      else if (pair.required && !has(pair.usual) && !has(pair.other))
        fault(line_of(line), fmt::format("there is no column {} and no column {}", usual, other));
    }
    if (!has(kPathPitch) && !has(kSolPitch) && !has(kPitchStart) && !has(kPitchEnd) && !has(kDemClimb))
      fault(line_of(line),
            "there is no column of a slope: path_pitch_deg, climb_pitch_start_deg, climb_pitch_end_deg, "
            "dem_climb_deg or sol_mean_climb_deg");
  }

  bool has(StepColumn column) const { return header_.places[column].has_value(); }
  StepColumn present(StepColumn usual, StepColumn other) const { return has(usual) ? usual : other; }
  std::string_view cell(const std::vector<std::string_view>& cells, StepColumn column) const {
    return has(column) ? cells[*header_.places[column]] : std::string_view();
  }
  std::string place_of(const CsvLine& line, StepColumn column) const {
    return fmt::format("{}, column {} ({})", line_of(line), *header_.places[column] + 1,
                       kStepColumnRows[column].name);
  }

  std::optional<double> number(const CsvLine& line, const std::vector<std::string_view>& cells,
                               StepColumn column) {
    const std::string_view text = cell(cells, column);
    if (text.empty()) return std::nullopt;
    const StepColumnRow& row = kStepColumnRows[column];
    const std::optional<double> value = csv_number(text);
    if (!value)
      fault(place_of(line, column), fmt::format("{} is no number", in_quotes(text)));
    else if (*value < row.lowest || *value > row.highest)
      fault(place_of(line, column),
            fmt::format("{} = {:g}, must be in [{:g}, {:g}]", row.name, *value, row.lowest, row.highest));
    else if (row.whole && *value != std::floor(*value))
      fault(place_of(line, column), fmt::format("{} = {:g}, must be whole", row.name, *value));
    else
      return value;
    return std::nullopt;
  }

  double needed(const CsvLine& line, const std::vector<std::string_view>& cells, StepColumn column) {
    if (cell(cells, column).empty())
      fault(place_of(line, column), fmt::format("{} is missing", kStepColumnRows[column].name));
    return number(line, cells, column).value_or(0.0);
  }

  void read_row(const CsvLine& line) {
    const std::vector<std::string_view> cells = csv_cells(line.text);
    if (cells.size() != header_.width)
      return fault(line_of(line),
                   fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    SlipStep step;
    read_numbers(line, cells, step);
    read_angles(line, cells, step);
    read_words(line, cells, step);
    // Read for their faults alone.
    for (const StepColumn unused : {kClock, kStepLength, kSolLength}) number(line, cells, unused);
    if (!steps_.empty() && step.sol < steps_.back().sol)
      fault(place_of(line, kSol),
            fmt::format("sol {} after sol {}: sols never decrease", step.sol, steps_.back().sol));
    check_slope(line, cells);
    steps_.push_back(std::move(step));
  }

  void read_numbers(const CsvLine& line, const std::vector<std::string_view>& cells, SlipStep& step) {
    step.sol = static_cast<int>(needed(line, cells, kSol));
    step.et_s = number(line, cells, kEt).value_or(0.0);
    if (const auto site = number(line, cells, kSite)) step.site = static_cast<int>(*site);
    step.site_north_m = number(line, cells, present(kSiteNorth, kNorth));
    step.site_east_m = number(line, cells, present(kSiteEast, kEast));
    step.site_down_m = number(line, cells, kSiteDown);
    step.x_eqc_m = number(line, cells, kXEqc);
    step.y_eqc_m = number(line, cells, kYEqc);
    const StepColumn odometry = present(kOdometry, kNominal);
    const std::size_t before = faults_.size() + more_;
    step.odometry_m = needed(line, cells, odometry);
    if (step.odometry_m <= 0.0 && before == faults_.size() + more_)
      fault(place_of(line, odometry), fmt::format("{} = 0, must be above 0", kStepColumnRows[odometry].name));
    step.slip = needed(line, cells, present(kSlip, kNominalSlip));
    step.side_m = number(line, cells, kSide);
    step.drive_s = number(line, cells, present(kDriveTime, kStepTime));
    if (const auto backward = number(line, cells, kBackward)) step.backward = *backward != 0.0;
  }

  void read_angles(const CsvLine& line, const std::vector<std::string_view>& cells, SlipStep& step) {
    const auto angle = [&](StepColumn column) -> std::optional<double> {
      const std::optional<double> deg = number(line, cells, column);
      if (!deg) return std::nullopt;
      return rad_from_deg(*deg);
    };
    step.climb_pitch_start_rad = angle(kPitchStart);
    step.climb_pitch_end_rad = angle(kPitchEnd);
    step.roll_start_rad = angle(kRollStart);
    step.roll_end_rad = angle(kRollEnd);
    step.heading_rad = angle(kHeading);
    step.course_rad = angle(kCourse);
    step.dem_climb_rad = angle(kDemClimb);
    step.path_pitch_rad = angle(kPathPitch);
    const std::optional<double> of_sol = angle(kSolPitch);
    if (of_sol && !step.path_pitch_rad) {
      step.path_pitch_rad = of_sol;
      step.pitch_is_of_sol = true;
    }
  }

  void read_words(const CsvLine& line, const std::vector<std::string_view>& cells, SlipStep& step) {
    const std::string_view attitude = cell(cells, kAttitude);
    if (attitude == "ck")
      step.attitude = StepAttitude::kCk;
    else if (!attitude.empty() && attitude != "none")
      fault(place_of(line, kAttitude), fmt::format("{}, must be ck or none", in_quotes(attitude)));
    const std::string_view unit = cell(cells, kTerrainUnit);
    const bool plain = std::all_of(unit.begin(), unit.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (!plain || unit.size() > kMaxUnitBytes)
      fault(place_of(line, kTerrainUnit),
            fmt::format("must be {} printable ASCII characters at most", kMaxUnitBytes));
    else
      step.terrain_unit = unit;
  }

  // The mean of a sol is not known for every sol.
  void check_slope(const CsvLine& line, const std::vector<std::string_view>& cells) {
    for (const StepColumn slope : {kPathPitch, kDemClimb, kPitchStart, kPitchEnd})
      if (!cell(cells, slope).empty()) return;
    if (!has(kSolPitch)) fault(line_of(line), "no slope: path_pitch_deg and what may stand for it are empty");
  }

  std::string_view file_;
  CsvHeader header_{std::vector<std::optional<std::size_t>>(kStepColumns), 0};
  std::vector<SlipStep> steps_;
  std::vector<Fault> faults_;
  std::size_t more_ = 0;
};

// A number without the sign of a rounded zero.
std::string rounded(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string rounded(const std::optional<double>& value, int digits) {
  return value ? rounded(*value, digits) : std::string();
}

std::string degrees(const std::optional<double>& rad) {
  return rad ? rounded(deg_from_rad(*rad), 2) : std::string();
}

std::vector<std::string> cells_of(const SlipStep& s) {
  const std::optional<double> none;
  return {fmt::format("{}", s.sol),
          s.et_s == 0.0 ? std::string() : rounded(s.et_s, 1),
          s.site ? fmt::format("{}", *s.site) : std::string(),
          rounded(s.site_north_m, 3),
          rounded(s.site_east_m, 3),
          rounded(s.site_down_m, 3),
          rounded(s.x_eqc_m, 2),
          rounded(s.y_eqc_m, 2),
          rounded(s.odometry_m, 4),
          rounded(s.slip, 4),
          rounded(s.side_m, 4),
          degrees(s.climb_pitch_start_rad),
          degrees(s.climb_pitch_end_rad),
          degrees(s.roll_start_rad),
          degrees(s.roll_end_rad),
          degrees(s.heading_rad),
          s.backward ? (*s.backward ? "1" : "0") : "",
          rounded(s.drive_s, 1),
          degrees(s.pitch_is_of_sol ? none : s.path_pitch_rad),
          degrees(s.course_rad),
          s.attitude == StepAttitude::kCk ? "ck" : "none",
          degrees(s.dem_climb_rad),
          s.terrain_unit,
          degrees(s.pitch_is_of_sol ? s.path_pitch_rad : none)};
}

}  // namespace

Result<std::vector<SlipStep>> read_slip_steps(std::string_view text, std::string_view file) {
  return Reader(file).read(text);
}

std::string write_slip_steps(std::span<const SlipStep> steps) {
  const auto some = [steps](auto has) { return std::any_of(steps.begin(), steps.end(), has); };
  std::vector<bool> written(kSolPitch + 1, true);
  written[kDemClimb] = some([](const SlipStep& s) { return s.dem_climb_rad.has_value(); });
  written[kTerrainUnit] = some([](const SlipStep& s) { return !s.terrain_unit.empty(); });
  written[kSolPitch] = some([](const SlipStep& s) { return s.pitch_is_of_sol; });
  std::string out = fmt::format("{}\n", kFormatLine);
  const auto add_line = [&](const auto& cell_at) {
    for (std::size_t k = 0; k < written.size(); ++k)
      if (written[k]) out += fmt::format("{}{}", k == 0 ? "" : ",", cell_at(k));
    out += '\n';
  };
  add_line([](std::size_t k) { return kStepColumnRows[k].name; });
  for (const SlipStep& step : steps) {
    const std::vector<std::string> cells = cells_of(step);
    add_line([&](std::size_t k) { return std::string_view(cells[k]); });
  }
  return out;
}

}  // namespace slipway::steps
