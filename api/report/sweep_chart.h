#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "api/chart/chart.h"
#include "core/result.h"
#include "sim/single_wheel/wheel_sweep.h"

namespace slipway::api {

// One quantity over the places of a sweep, in the sweep's order: the first axis slowest.
struct SweptQuantity {
  std::string title;  // with its unit: "drawbar pull, N"
  std::vector<std::optional<double>> values;
};

// The most lines that one chart of a sweep tells apart.
constexpr std::size_t kMaxSweepLines = 7;

// A parameter of a sweep as an axis says it, with its unit: "load, N", "slip angle, deg", "grousers height,
// m".
std::string parameter_title(std::string_view parameter);

// The quantity over the first axis, a line for each value of the second; at least one axis, and at most
// kMaxSweepLines values on the second. An axis whose values stand in equal ratios is logarithmic.
Chart sweep_chart(std::string_view title, std::span<const sim::SweepAxis> axes,
                  const SweptQuantity& quantity);

// Charts of all quantities beside each other; where the second axis has more values than lines can be told
// apart, a heat map of the first quantity.
std::string draw_sweep(std::string_view title, std::span<const sim::SweepAxis> axes,
                       std::span<const SweptQuantity> quantities);

// The picture of a wheel sweep's answer (json::write_wheel_sweep_answer): pull, sinkage, torque, current,
// efficiency, and the side force where there is any. Errors: invalid_request, where nothing was swept.
Result<std::string> draw_wheel_sweep(std::string_view document);

}  // namespace slipway::api
