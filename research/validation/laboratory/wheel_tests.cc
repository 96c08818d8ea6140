#include "research/validation/laboratory/wheel_tests.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"
#include "research/validation/report/csv_table.h"

namespace slipway::validation {
namespace {

WheelTest test_of(const CsvTable& table, std::size_t row) {
  const auto number = [&](std::string_view column) { return table.number(row, column); };
  WheelTest test;
  test.trial = static_cast<int>(number("trial"));
  test.commanded_rim_speed_m_s = 1e-3 * number("cmd_rim_speed_mmps");
  test.rim_speed_m_s = 1e-3 * number("rim_speed_mmps");
  test.travel_speed_m_s = 1e-3 * number("vx_mmps");
  test.slip_ratio = number("slip_ratio");
  test.slip_angle_rad = rad_from_deg(number("slip_angle_deg"));
  test.drawbar_pull_n = number("drawbar_pull_N");
  test.drawbar_pull_std_n = number("drawbar_std_N");
  test.side_force_n = number("side_force_N");
  test.side_force_std_n = number("side_std_N");
  test.load_n = number("normal_load_N");
  test.load_std_n = number("normal_std_N");
  test.sinkage_m = 1e-3 * number("sinkage_mm");
  return test;
}

}  // namespace

double travel_slip(double rim_speed_m_s, double travel_speed_m_s) {
  return (rim_speed_m_s - travel_speed_m_s) / std::max(travel_speed_m_s, rim_speed_m_s);
}

double WheelCondition::mean(double WheelTest::*quantity) const {
  double sum = 0.0;
  for (const WheelTest& test : repeats) sum += test.*quantity;
  return sum / static_cast<double>(repeats.size());
}

double WheelCondition::scatter(double WheelTest::*quantity) const {
  if (repeats.size() < 2) return 0.0;
  const double middle = mean(quantity);
  double sum = 0.0;
  for (const WheelTest& test : repeats) sum += std::pow(test.*quantity - middle, 2);
  return std::sqrt(sum / static_cast<double>(repeats.size() - 1));
}

Result<std::vector<WheelCondition>> load_wheel_conditions(const std::filesystem::path& csv) {
  const auto table = CsvTable::read(
      csv, {.numbers = {"trial", "cmd_rim_speed_mmps", "slip_angle_deg", "vx_mmps", "rim_speed_mmps",
                        "slip_ratio", "drawbar_pull_N", "drawbar_std_N", "side_force_N", "side_std_N",
                        "normal_load_N", "normal_std_N", "sinkage_mm"},
            .numbers_or_empty = {},
            .texts = {}});
  if (!table) return fail(table.error());
  std::map<std::pair<double, double>, std::vector<WheelTest>> by_condition;
  std::set<double> angles, speeds;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    const WheelTest test = test_of(*table, row);
    by_condition[{test.slip_angle_rad, test.commanded_rim_speed_m_s}].push_back(test);
    angles.insert(test.slip_angle_rad);
    speeds.insert(test.commanded_rim_speed_m_s);
  }
  std::vector<WheelCondition> conditions;
  for (auto& [key, tests] : by_condition) {
    const auto number = std::distance(angles.begin(), angles.find(key.first)) +
                        std::distance(speeds.begin(), speeds.find(key.second));
    conditions.push_back(
        {key.second, key.first, number % 2 == 0 ? Half::kFit : Half::kPredict, std::move(tests)});
  }
  return conditions;
}

}  // namespace slipway::validation
