#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "steps/spice_ck.h"
#include "steps/spice_clock.h"
#include "steps/spice_spk.h"
#include "steps/steps_from_spice.h"

namespace slipway::steps {

// What is needed of several kernels together.
class KernelSet {
 public:
  // Errors: as of steps_from_spice().
  static Result<KernelSet> read(std::span<const KernelBytes> files, const SpiceStepOptions& options,
                                SpiceStepSummary& summary);

  const std::vector<SpkSegment>& rover() const { return rover_; }  // by rising start
  bool has_attitudes() const { return !attitudes_.empty(); }
  // Turns the level frame into the body's. Nothing where no kernel says.
  std::optional<Eigen::Quaterniond> attitude(double et_s) const;
  // North, east, down from the landing site.
  std::optional<std::array<double, 3>> offset_of_site(int site) const;
  // Body-fixed.
  const std::optional<std::array<double, 3>>& landing_m() const { return landing_m_; }

 private:
  Result<void> read_binary(const KernelBytes& file, SpiceStepSummary& summary);
  Result<void> read_text(const KernelBytes& file);
  Result<void> take_positions(const DafFile& daf, const DafArray& array, SpiceStepSummary& summary);
  Result<void> take_attitudes(const DafFile& daf, const DafArray& array, SpiceStepSummary& summary);
  void put_in_order();

  SpiceStepOptions options_;
  std::vector<SpkSegment> rover_;
  std::vector<CkSegment> attitudes_;  // by rising start
  std::vector<double> latest_end_;    // of an attitude segment and those before it
  std::optional<SpacecraftClock> clock_;
  std::optional<EphemerisTime> ephemeris_;
  std::map<int, std::array<double, 3>> sites_;
  std::optional<std::array<double, 3>> landing_m_;
};

}  // namespace slipway::steps
