#pragma once

#include <vector>

#include "wheel_contact.h"

namespace slipway::gap_benchmark {

// Nodes of a wheel's contact: strips across its width, nodes of each strip before and behind the lowest
// point. How many does not depend on depth or motion, so that loads are continuous in both.
struct ContactGrid {
  int strips = 16, nodes_before = 32, nodes_behind = 8, nodes_far_behind = 16;
};

// The Soil Contact Model [Krenn & Hirzinger 2009], with the elastic unloading, shear and width of the contact
// patch of Chrono's deformable soil [Tasora et al. 2019], for a rigid cylinder in steady motion. Nodes of
// soil pass through the contact along the path of the wheel over the ground; each is pressed by Bekker's law
// from where its surface was, springs back by an elastic stiffness behind the lowest point, and carries Mohr
// and Coulomb's strength as far as Janosi and Hanamoto's law mobilises it by the vector of shear displacement
// that it has itself been through. Of the soil that is pushed away a share is heaped before the rim, where it
// is run over, and beside the track.
class SoilContactModel : public WheelLaw {
 public:
  SoilContactModel(double radius_m, double width_m, const ContactGrid& grid = {});

  // `depth_m` is that of the lowest point below the highest soil that the wheel meets.
  WheelLoads loads(double depth_m, const WheelMotion& motion, const ContactSoil& soil) const override;
  Rut rut(double depth_m, const ContactSoil& soil) const override;

 private:
  double radius_m_, width_m_;
  ContactGrid grid_;
};

}  // namespace slipway::gap_benchmark
