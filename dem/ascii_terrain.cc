#include "dem/ascii_terrain.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace slipway::dem {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_soil(char c) {
  return (c >= 'a' && c <= 'z') || c == '?';
}

// One drawn cell. soil '.' is the default soil, '?' unknown ground.
struct DrawnCell {
  int height_steps = 0;
  char soil = '.';
  bool masked = false;
  char mark = ' ';  // 'S' or 'G'
};

std::optional<DrawnCell> drawn_cell(const std::string& token) {
  if (token.size() == 2 && is_digit(token[0]) && is_soil(token[1])) {
    return DrawnCell{.height_steps = token[0] - '0', .soil = token[1]};
  }
  if (token.size() != 1) return std::nullopt;
  const char c = token[0];
  if (is_digit(c)) return DrawnCell{.height_steps = c - '0'};
  if (c == '.') return DrawnCell{};
  if (c == '#') return DrawnCell{.masked = true};
  if (c == 'S' || c == 'G') return DrawnCell{.mark = c};
  if (is_soil(c)) return DrawnCell{.soil = c};
  return std::nullopt;
}

// A class per letter, the default soil as class 0.
std::vector<SoilClass> legend_of(const AsciiOptions& options) {
  std::vector<SoilClass> legend;
  if (!options.default_soil.empty()) legend.push_back({0, ".", options.default_soil});
  for (const auto& [letter, soil] : options.soils) legend.push_back({letter, std::string(1, letter), soil});
  return legend;
}

class Drawing {
 public:
  explicit Drawing(const AsciiOptions& options) : options_(options) {}

  void read_row(const std::string& line) {
    std::istringstream tokens(line);
    std::vector<DrawnCell> row;
    for (std::string token; tokens >> token;) {
      const std::string pointer = fmt::format("/{}/{}", rows_.size(), row.size());
      const std::optional<DrawnCell> cell = drawn_cell(token);
      if (!cell) {
        faults_.push_back(
            {pointer, fmt::format("'{}' is not one of 0-9 . # S G ? a-z, or a digit and a soil", token)});
      } else if (cell->soil >= 'a' && cell->soil <= 'z' && !options_.soils.contains(cell->soil)) {
        faults_.push_back({pointer, fmt::format("no soil is given for the letter '{}'", cell->soil)});
      } else if (cell->mark != ' ' && ++(cell->mark == 'S' ? starts_ : goals_) > 1) {
        faults_.push_back({pointer, fmt::format("'{}' is drawn twice", cell->mark)});
      }
      row.push_back(cell.value_or(DrawnCell{}));
    }
    if (row.empty()) return;
    if (!rows_.empty() && row.size() != rows_.front().size()) {
      faults_.push_back(
          {fmt::format("/{}", rows_.size()), fmt::format("{} cells in this row, must be {} as in the first",
                                                         row.size(), rows_.front().size())});
    }
    rows_.push_back(std::move(row));
  }

  Result<AsciiTerrain> build() {
    if (!(options_.cell_m > 0.0)) {
      faults_.push_back({"", fmt::format("cell_m = {} m, must be above 0", options_.cell_m)});
    }
    if (rows_.empty()) faults_.push_back({"", "the drawing has no cells"});
    if (!faults_.empty())
      return fail(ErrorCode::kUnreadableData, "The drawn terrain has faults.", std::move(faults_));
    return drawn();
  }

 private:
  AsciiTerrain drawn() const {
    const int rows = static_cast<int>(rows_.size());
    const int columns = static_cast<int>(rows_.front().size());
    const GridGeometry geometry{.rows = rows,
                                .columns = columns,
                                .west_m = 0.0,
                                .north_m = rows * options_.cell_m,
                                .cell_x_m = options_.cell_m,
                                .cell_y_m = options_.cell_m};
    std::vector<float> heights;
    std::vector<std::uint8_t> valid;
    std::vector<std::int16_t> classes;
    std::vector<std::uint8_t> known;
    AsciiTerrain answer;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const DrawnCell& cell = rows_[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
        heights.push_back(static_cast<float>(cell.height_steps * options_.height_step_m));
        valid.push_back(cell.masked ? 0 : 1);
        classes.push_back(cell.soil == '.' ? std::int16_t{0} : static_cast<std::int16_t>(cell.soil));
        known.push_back(cell.soil == '?' || (cell.soil == '.' && options_.default_soil.empty()) ? 0 : 1);
        const Eigen::Vector2d centre = geometry.centre_m({row, column});
        if (cell.mark == 'S') answer.start = Pose2{centre.x(), centre.y(), 0.0};
        if (cell.mark == 'G') answer.goal = Pose2{centre.x(), centre.y(), 0.0};
      }
    }
    answer.terrain = std::make_shared<const Terrain>(geometry, std::move(heights), std::move(valid));
    answer.soil_map =
        std::make_shared<const SoilMap>(geometry, std::move(classes), std::move(known), legend_of(options_));
    return answer;
  }

  const AsciiOptions& options_;
  std::vector<std::vector<DrawnCell>> rows_;
  std::vector<Fault> faults_;
  int starts_ = 0;
  int goals_ = 0;
};

}  // namespace

Result<AsciiTerrain> parse_ascii_terrain(std::string_view drawing, const AsciiOptions& options) {
  Drawing parsed(options);
  std::istringstream lines{std::string(drawing)};
  for (std::string line; std::getline(lines, line);) parsed.read_row(line);
  return parsed.build();
}

}  // namespace slipway::dem
