#include "sim/prediction/odometry_shortfall.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/wheel/slip_ratio.h"

namespace slipway::sim {

double roll_per_way(double slip_ratio) {
  constexpr double kMostSlip = 0.999;
  return 1.0 / speed_ratio_from_slip(std::clamp(slip_ratio, -kMostSlip, kMostSlip));
}

void ShortfallFollower::add(double way_m, double slip_ratio) {
  if (way_m <= 0.0) return;  // a turn in place
  roll_per_way_ = roll_per_way(slip_ratio);
  const double rolled_m = rolled_m_ + way_m * roll_per_way_;
  while (shortfall_m_.size() < wanted_m_.size() && wanted_m_[shortfall_m_.size()] <= rolled_m) {
    const double wanted_m = wanted_m_[shortfall_m_.size()];
    const double come_m = come_m_ + (wanted_m - rolled_m_) / roll_per_way_;
    shortfall_m_.push_back(static_cast<float>(wanted_m - come_m));
  }
  rolled_m_ = rolled_m;
  come_m_ += way_m;
}

std::vector<float> ShortfallFollower::finish(bool stuck) {
  while (shortfall_m_.size() < wanted_m_.size()) {
    const double wanted_m = wanted_m_[shortfall_m_.size()];
    const double come_m = stuck ? come_m_ : come_m_ + (wanted_m - rolled_m_) / roll_per_way_;
    shortfall_m_.push_back(static_cast<float>(wanted_m - come_m));
  }
  return shortfall_m_;
}

void DriftFollower::add(double way_m, double side_slip_rad, double turned_rad) {
  turned_rad_ += turned_rad;
  drift_m_ += way_m * (std::sin(turned_rad_) + std::tan(side_slip_rad) * std::cos(turned_rad_));
  come_m_ += way_m;
  while (drifts_m_.size() < wanted_m_.size() && wanted_m_[drifts_m_.size()] <= come_m_ + 1e-9) {
    drifts_m_.push_back(static_cast<float>(drift_m_));
    turns_rad_.push_back(static_cast<float>(turned_rad_));
  }
}

void DriftFollower::finish(std::vector<float>& drift_m, std::vector<float>& turned_rad) {
  drifts_m_.resize(wanted_m_.size(), static_cast<float>(drift_m_));
  turns_rad_.resize(wanted_m_.size(), static_cast<float>(turned_rad_));
  drift_m = std::move(drifts_m_);
  turned_rad = std::move(turns_rad_);
}

}  // namespace slipway::sim
