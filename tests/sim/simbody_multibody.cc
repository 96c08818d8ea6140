#include "tests/sim/simbody_multibody.h"

#include <Simbody.h>

namespace slipway::sim {
namespace {

SimTK::Vec3 to_simtk(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3d to_eigen(const SimTK::Vec3& v) {
  return {v[0], v[1], v[2]};
}

SimTK::Rotation rotation_of(const Eigen::Matrix3d& r) {
  return SimTK::Rotation(
      SimTK::Mat33(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)));
}

// About a frame's origin that lies at a place of B.
SimTK::MassProperties about(const MassProperties& mass, const Eigen::Vector3d& origin_m) {
  const Eigen::Matrix3d& i = mass.inertia_kg_m2;
  const SimTK::Vec3 com = to_simtk(mass.com_m - origin_m);
  const SimTK::Inertia central(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2));
  return {mass.mass_kg, com, central.shiftFromMassCenter(com, mass.mass_kg)};
}

}  // namespace

// Every body's frame has its origin on the pivot, and B's axes where all joints are at 0.
struct SimbodyMultibody::System {
  explicit System(const Multibody& multibody) : origins_m{Eigen::Vector3d::Zero()} {
    bodies.push_back(SimTK::MobilizedBody::Free(matter.Ground(),
                                                SimTK::Body::Rigid(about(multibody.base(), origins_m[0]))));
    for (const RevoluteBody& body : multibody.bodies()) {
      // A pin of Simbody turns about its z axis.
      const SimTK::Rotation along(SimTK::UnitVec3(to_simtk(body.axis)), SimTK::ZAxis);
      const Eigen::Vector3d from_parent = body.pivot_m - origins_m[body.parent + 1];
      bodies.push_back(SimTK::MobilizedBody::Pin(
          bodies[body.parent + 1], SimTK::Transform(along, to_simtk(from_parent)),
          SimTK::Body::Rigid(about(body.mass, body.pivot_m)), SimTK::Transform(along)));
      origins_m.push_back(body.pivot_m);
    }
    state = multibody_system.realizeTopology();
  }

  SimTK::MultibodySystem multibody_system;
  SimTK::SimbodyMatterSubsystem matter{multibody_system};
  std::vector<SimTK::MobilizedBody> bodies;  // the base first
  std::vector<Eigen::Vector3d> origins_m;
  SimTK::State state;
};

SimbodyMultibody::SimbodyMultibody(const Multibody& multibody)
    : system_(std::make_unique<System>(multibody)) {}

SimbodyMultibody::~SimbodyMultibody() = default;

Accelerations SimbodyMultibody::accelerations(const LoadedState& loaded) {
  SimTK::State& state = system_->state;
  const auto& bodies = system_->bodies;
  const auto& matter = system_->matter;
  const Eigen::Matrix3d& R_MB = loaded.R_MB;
  const Eigen::Vector3d omega_M = R_MB * loaded.base.head<3>(), v_M = R_MB * loaded.base.tail<3>();
  bodies[0].setQToFitTransform(state, SimTK::Transform(rotation_of(R_MB)));
  bodies[0].setUToFitVelocity(state, SimTK::SpatialVec(to_simtk(omega_M), to_simtk(v_M)));
  for (Eigen::Index i = 0; i < loaded.angles_rad.size(); ++i) {
    bodies[i + 1].setOneQ(state, 0, loaded.angles_rad[i]);
    bodies[i + 1].setOneU(state, 0, loaded.rates_rad_s[i]);
  }
  system_->multibody_system.realize(state, SimTK::Stage::Dynamics);

  SimTK::Vector mobility_forces(state.getNU(), 0.0), mobility_accelerations;
  SimTK::Vector_<SimTK::SpatialVec> body_forces(matter.getNumBodies(), SimTK::SpatialVec(SimTK::Vec3(0))),
      body_accelerations;
  for (const LoadedState::Force& force : loaded.forces) {
    // The point of the body that is there now: B's origin is the map's.
    const SimTK::MobilizedBody& body = bodies[force.body + 1];
    const SimTK::Vec3 arm = to_simtk(R_MB * force.p_B) - body.getBodyOriginLocation(state);
    const SimTK::Vec3 f = to_simtk(R_MB * force.force_B);
    body_forces[body.getMobilizedBodyIndex()] +=
        SimTK::SpatialVec(to_simtk(R_MB * force.moment_B) + arm % f, f);
  }
  for (const SimTK::MobilizedBody& body : bodies) {
    const SimTK::Vec3 arm = body.getBodyRotation(state) * body.getBodyMassCenterStation(state);
    const SimTK::Vec3 weight = body.getBodyMass(state) * to_simtk(loaded.gravity_M);
    body_forces[body.getMobilizedBodyIndex()] += SimTK::SpatialVec(arm % weight, weight);
  }
  for (Eigen::Index i = 0; i < loaded.torques_nm.size(); ++i)
    bodies[i + 1].updOneFromUPartition(state, 0, mobility_forces) = loaded.torques_nm[i];
  matter.calcAccelerationIgnoringConstraints(state, mobility_forces, body_forces, mobility_accelerations,
                                             body_accelerations);

  Accelerations found{SpatialVector::Zero(), Eigen::VectorXd(loaded.angles_rad.size())};
  const SimTK::SpatialVec& base = body_accelerations[bodies[0].getMobilizedBodyIndex()];
  // Of the components in B: the axes turn away under the velocity.
  found.base << R_MB.transpose() * to_eigen(base[0]),
      R_MB.transpose() * (to_eigen(base[1]) - omega_M.cross(v_M));
  for (Eigen::Index i = 0; i < found.joints.size(); ++i)
    found.joints[i] = bodies[i + 1].getOneFromUPartition(state, 0, mobility_accelerations);
  return found;
}

}  // namespace slipway::sim
