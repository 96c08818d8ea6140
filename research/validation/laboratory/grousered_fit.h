#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/result.h"
#include "gap/estimate/least_squares.h"
#include "research/validation/laboratory/pavlov_rig.h"

namespace slipway::validation {

// Conditions of one of the two wheels of the sandbox, which share their soil.
struct SandboxWheelTests {
  bool grousered = false;
  std::vector<WheelCondition> conditions;
};

// The smooth wheel's tests, and the half of the grousered wheel's that is here. Errors: unreadable_data.
Result<std::vector<SandboxWheelTests>> load_sandbox_wheels(const std::filesystem::path& data);

// The soil and the smooth rim that both wheels share, from the fitted numbers. c1 and c2
// are 0 and so is the cohesion (fits ended there), n is that of the plate tests, friction angle and density
// are upstream's, and the shear law is the hyperbola.
struct SandboxModel {
  sim::Soil sand;
  double rim_friction = 1.0;

  sim::WheelGeometry wheel(bool grousered) const;
};
SandboxModel sandbox_model(std::span<const double> x);
std::vector<gap::Unknown> sandbox_unknowns();

// Fits all conditions that `used` takes, in units of 7 % of the load, 15 % at 90 deg, and of 5 mm, 12 mm at
// 90 deg. Errors: those of the search.
Result<gap::LeastSquaresFit> fit_sandbox(
    const std::vector<SandboxWheelTests>& tests, std::span<const gap::Unknown> unknowns,
    const std::function<bool(bool grousered, const WheelCondition&)>& used, bool covariance);

}  // namespace slipway::validation
