#include "research/sealed_set/hidden_traces_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "api/json/faults.h"
#include "core/csv_cells.h"

namespace slipway::api {
namespace {

constexpr std::size_t kMaxRows = 200'000;
constexpr std::size_t kFirstVariable = 2, kFirstChannel = kFirstVariable + gap::kWindowVariables;

using Traces = std::map<std::string, std::vector<gap::HiddenTrace>>;

std::vector<std::string> column_names() {
  std::vector<std::string> names{"campaign", "drive"};
  for (int v = 0; v < gap::kWindowVariables; ++v)
    names.emplace_back(gap::name_of(static_cast<gap::WindowVariable>(v)));
  for (std::size_t c = 0; c < gap::channel_count(); ++c)
    names.push_back(fmt::format("{}_mean_square", gap::name_of(static_cast<gap::Channel>(c))));
  return names;
}

// Where to put a window's variable, in their order.
constexpr std::array<double gap::WindowVariables::*, gap::kWindowVariables> kVariables{
    &gap::WindowVariables::slope_deg,     &gap::WindowVariables::cross_slope_deg,
    &gap::WindowVariables::slip,          &gap::WindowVariables::speed_m_s,
    &gap::WindowVariables::curvature_1_m, &gap::WindowVariables::temperature_c,
    &gap::WindowVariables::turning,       &gap::WindowVariables::time_s};

class TraceTable {
 public:
  explicit TraceTable(std::string_view file) : file_(file), names_(column_names()) {}

  Result<Traces> read(std::string_view text) {
    const std::vector<CsvLine> lines = csv_lines(text);
    Traces traces;
    if (lines.empty()) {
      faults_.push_back({std::string(file_), "the file is empty"});
    } else if (lines.size() - 1 > kMaxRows) {
      faults_.push_back(
          {std::string(file_), fmt::format("{} rows, must be {} at most", lines.size() - 1, kMaxRows)});
    } else {
      read_header(lines.front());
      for (std::size_t i = 1; i < lines.size(); ++i) read_row(lines[i], traces);
    }
    if (!faults_.empty())
      return fail(ErrorCode::kUnreadableData, fmt::format("{} can't be read", file_), std::move(faults_));
    return traces;
  }

 private:
  void fault(std::size_t line, std::string message) {
    faults_.push_back({fmt::format("{}, line {}", file_, line), std::move(message)});
  }

  void read_header(const CsvLine& line) {
    header_ = read_csv_header(line, file_, names_, faults_);
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (!header_.places[k]) fault(line.number, fmt::format("there is no column {}", names_[k]));
  }

  void read_row(const CsvLine& line, Traces& traces) {
    const std::vector<std::string_view> cells = csv_cells(line.text);
    if (cells.size() != header_.width)
      fault(line.number, fmt::format("{} cells, must be {} as in the header", cells.size(), header_.width));
    std::string campaign;
    gap::HiddenTrace trace;
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (!header_.places[k] || *header_.places[k] >= cells.size()) continue;
      const std::string_view cell = cells[*header_.places[k]];
      const std::string place =
          fmt::format("{}, line {}, column {} ({})", file_, line.number, *header_.places[k] + 1, names_[k]);
      if (cell.empty()) {
        if (k < kFirstChannel) faults_.push_back({place, fmt::format("{} is missing", names_[k])});
        continue;
      }
      if (k < kFirstVariable) {
        (k == 0 ? campaign : trace.drive) = cell;
        continue;
      }
      const std::optional<double> value = csv_number(cell);
      if (!value)
        faults_.push_back({place, fmt::format("{} is no number", in_quotes(cell))});
      else if (k < kFirstChannel)
        trace.at.*kVariables[k - kFirstVariable] = *value;
      else if (*value < 0.0)
        faults_.push_back({place, fmt::format("{} = {:g}, must be 0 or more", names_[k], *value)});
      else
        trace.mean_square[k - kFirstChannel] = *value;
    }
    if (faults_.empty()) traces[campaign].push_back(std::move(trace));
  }

  std::string_view file_;
  std::vector<std::string> names_;
  CsvHeader header_;
  std::vector<Fault> faults_;
};

}  // namespace

Result<Traces> read_hidden_traces_csv(std::string_view file, std::string_view text) {
  return TraceTable(file).read(text);
}

}  // namespace slipway::api
