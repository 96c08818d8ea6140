#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace slipway::sim {

struct MassProperties {
  double mass_kg = 0.0;
  Eigen::Vector3d com_m = Eigen::Vector3d::Zero();          // where all joints are at 0, frame B
  Eigen::Matrix3d inertia_kg_m2 = Eigen::Matrix3d::Zero();  // about the centre of mass, axes of B
};

// A body that turns against its parent about one axis.
struct RevoluteBody {
  std::string name;
  int parent = -1;                                    // index of an earlier body; -1 is the base
  Eigen::Vector3d pivot_m = Eigen::Vector3d::Zero();  // on the axis, where all joints are at 0, frame B
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();    // unit, where all joints are at 0, frame B
  MassProperties mass = {};
  // The inertia of the motor's rotor about this joint, which is the gear ratio squared times its own. An
  // infinite armature welds the joint at rate 0.
  double armature_kg_m2 = 0.0;
  // True for a wheel: it is centred on its axis and has the same moment of inertia about all axes square to
  // it, so that its angle is never read.
  bool round = false;
};

// A floating base with a tree of bodies on revolute joints: immutable, shared by pointer. The base's frame is
// B.
class Multibody {
 public:
  // Bodies come after their parents. Throws std::invalid_argument where a body does not, where a joint
  // without armature carries no mass, and where a body is marked round without being so.
  Multibody(MassProperties base, std::vector<RevoluteBody> bodies);

  int joint_count() const { return static_cast<int>(bodies_.size()); }
  const MassProperties& base() const { return base_; }
  const std::vector<RevoluteBody>& bodies() const { return bodies_; }
  double mass_kg() const { return mass_kg_; }

 private:
  MassProperties base_;
  std::vector<RevoluteBody> bodies_;
  double mass_kg_;
};

// A spatial vector: angular part first. A velocity is (omega, velocity of the point of the body at B's
// origin), a force (moment about B's origin, force), both in axes of B [Featherstone 2008, chapter 2].
using SpatialVector = Eigen::Matrix<double, 6, 1>;
using SpatialMatrix = Eigen::Matrix<double, 6, 6>;

// clang-format off
// Forward dynamics of a multibody by the articulated-body algorithm [Featherstone 2008, section 7.3], all in
// axes of B about B's origin, so that inertias need no transform on their way down the tree:
//
//   V_i = V_p + S_i qd_i          S_i = (a_i, r_i x a_i)          c_i = V_i x S_i qd_i
//   U_i = I^A_i S_i               D_i = S_i . U_i + armature      u_i = tau_i - S_i . p^A_i
//   I^A_p += I^A_i - U_i U_i^T / D_i       p^A_p += p^A_i + (I^A_i - U_i U_i^T / D_i) c_i + U_i u_i / D_i
//   A_0 = -(I^A_0)^-1 p^A_0,      qdd_i = (u_i - U_i . (A_p + c_i)) / D_i,       A_i = A_p + c_i + S_i qdd_i
//
//   a_i, r_i  axis and a point on it      p^A  bias force, V x* I V less the external forces
// Gravity enters as an acceleration that is added to the base's at the end.
//
// This is a workspace for one thread; it does not allocate after construction. Tests show that it agrees with an
// independent library to 1e-9, and that energy and both momenta are conserved without forces.
// clang-format on
class MultibodyDynamics {
 public:
  explicit MultibodyDynamics(const Multibody& multibody);  // which must outlive it

  // R_MB turns B into the map; base is B's spatial velocity; the arrays have joint_count() values. Clears the
  // forces and torques.
  void set_state(const Eigen::Matrix3d& R_MB, const SpatialVector& base, const double* angles_rad,
                 const double* rates_rad_s);

  // Values at the state, in axes of B about B's origin.
  const Eigen::Matrix3d& R_Bi(int body) const { return links_[body].R_Bi; }  // at angle 0 for a round body
  const Eigen::Vector3d& pivot_B(int body) const { return links_[body].pivot; }
  const Eigen::Vector3d& axis_B(int body) const { return links_[body].axis; }
  const SpatialVector& velocity(int body) const { return body < 0 ? base_velocity_ : links_[body].velocity; }
  // Velocity of the body's point that is at p_B now.
  Eigen::Vector3d point_velocity(int body, const Eigen::Vector3d& p_B) const;

  void add_force(int body, const Eigen::Vector3d& p_B, const Eigen::Vector3d& force_B,
                 const Eigen::Vector3d& moment_B);  // body -1 is the base
  void add_torque(int joint, double torque_nm) { links_[joint].torque += torque_nm; }

  // Computes the base's spatial acceleration (the rate of change of its components in B) and the joints'
  // accelerations (joint_count() values). gravity_M is the gravitational acceleration in map axes [m/s^2].
  void accelerations(const Eigen::Vector3d& gravity_M, SpatialVector& base, double* joint_accelerations);

  double kinetic_energy_j() const;  // includes the armatures' share
  // About B's origin in axes of B. The armatures are left out, since their rotors are not bodies.
  SpatialVector momentum() const;
  Eigen::Vector3d com_B() const;

 private:
  // The inertia of one body, in axes of B.
  struct RigidInertia {
    double mass_kg = 0.0;
    Eigen::Vector3d com = Eigen::Vector3d::Zero();
    Eigen::Matrix3d about_com = Eigen::Matrix3d::Zero();

    SpatialVector momentum(const SpatialVector& velocity) const;
    void write_to(SpatialMatrix& about_origin) const;
  };
  struct Link {
    Eigen::Matrix3d R_Bi;
    Eigen::Vector3d pivot, axis;
    SpatialVector velocity, subspace, coriolis, force;
    double rate = 0.0, torque = 0.0;
    RigidInertia inertia;
    double along = 0.0, across = 0.0;  // moments of a round body about its axis and square to it
    SpatialMatrix articulated;
    SpatialVector bias, u_vector;
    double per_d = 0.0, u = 0.0;
  };

  const Multibody& multibody_;
  std::vector<Link> links_;
  Eigen::Matrix3d R_MB_ = Eigen::Matrix3d::Identity();
  SpatialVector base_velocity_ = SpatialVector::Zero(), base_force_ = SpatialVector::Zero();
  RigidInertia base_inertia_;
};

}  // namespace slipway::sim
