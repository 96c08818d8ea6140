#include "sim/dynamic/multibody.h"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace slipway::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The bias force: V x* momentum less the external force.
SpatialVector bias_force(const SpatialVector& velocity, const SpatialVector& momentum,
                         const SpatialVector& outside) {
  const Vector3d omega = velocity.head<3>(), v = velocity.tail<3>();
  const Vector3d angular = momentum.head<3>(), linear = momentum.tail<3>();
  SpatialVector bias;
  bias << omega.cross(angular) + v.cross(linear) - outside.head<3>(), omega.cross(linear) - outside.tail<3>();
  return bias;
}

// Whether the body's centre is on its axis and it has one moment of inertia about all axes square to it.
bool is_round(const RevoluteBody& body) {
  const MassProperties& mass = body.mass;
  const Vector3d& a = body.axis;
  const double along = a.dot(mass.inertia_kg_m2 * a), across = 0.5 * (mass.inertia_kg_m2.trace() - along);
  const Matrix3d round = across * Matrix3d::Identity() + (along - across) * a * a.transpose();
  return (mass.com_m - body.pivot_m).cross(a).norm() <= 1e-9 * (1.0 + body.pivot_m.norm()) &&
         (mass.inertia_kg_m2 - round).norm() <= 1e-9 * round.norm();
}

}  // namespace

Multibody::Multibody(MassProperties base, std::vector<RevoluteBody> bodies)
    : base_(std::move(base)), bodies_(std::move(bodies)), mass_kg_(base_.mass_kg) {
  std::vector<double> carried(bodies_.size(), 0.0);
  for (int i = joint_count() - 1; i >= 0; --i) {
    const RevoluteBody& body = bodies_[i];
    if (body.parent >= i || body.parent < -1)
      throw std::invalid_argument("Multibody: body " + body.name + " comes before its parent");
    if (body.round && !is_round(body))
      throw std::invalid_argument("Multibody: body " + body.name + " is not round");
    mass_kg_ += body.mass.mass_kg;
    carried[i] += body.mass.mass_kg;
    if (!(carried[i] > 0.0) && !(body.armature_kg_m2 > 0.0))
      throw std::invalid_argument("Multibody: nothing has mass behind joint " + body.name);
    if (body.parent >= 0) carried[body.parent] += carried[i];
  }
}

SpatialVector MultibodyDynamics::RigidInertia::momentum(const SpatialVector& velocity) const {
  const Vector3d omega = velocity.head<3>();
  const Vector3d linear = mass_kg * (velocity.tail<3>() + omega.cross(com));
  SpatialVector sum;
  sum.head<3>() = about_com * omega + com.cross(linear);
  sum.tail<3>() = linear;
  return sum;
}

void MultibodyDynamics::RigidInertia::write_to(SpatialMatrix& about_origin) const {
  const Vector3d mc = mass_kg * com;
  Matrix3d coupling;  // mc x
  coupling << 0.0, -mc.z(), mc.y(), mc.z(), 0.0, -mc.x(), -mc.y(), mc.x(), 0.0;
  about_origin.topLeftCorner<3, 3>() = about_com - mc * com.transpose();
  about_origin.topLeftCorner<3, 3>().diagonal().array() += mc.dot(com);
  about_origin.topRightCorner<3, 3>() = coupling;
  about_origin.bottomLeftCorner<3, 3>() = -coupling;
  about_origin.bottomRightCorner<3, 3>() = mass_kg * Matrix3d::Identity();
}

MultibodyDynamics::MultibodyDynamics(const Multibody& multibody)
    : multibody_(multibody),
      links_(multibody.bodies().size()),
      base_inertia_{multibody.base().mass_kg, multibody.base().com_m, multibody.base().inertia_kg_m2} {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const RevoluteBody& body = multibody.bodies()[i];
    links_[i].inertia.mass_kg = body.mass.mass_kg;
    links_[i].along = body.axis.dot(body.mass.inertia_kg_m2 * body.axis);
    links_[i].across = 0.5 * (body.mass.inertia_kg_m2.trace() - links_[i].along);
  }
}

void MultibodyDynamics::set_state(const Matrix3d& R_MB, const SpatialVector& base, const double* angles,
                                  const double* rates) {
  R_MB_ = R_MB;
  base_velocity_ = base;
  base_force_.setZero();
  for (int i = 0; i < multibody_.joint_count(); ++i) {
    const RevoluteBody& body = multibody_.bodies()[i];
    Link& link = links_[i];
    const bool on_base = body.parent < 0;
    if (on_base) {
      link.R_Bi.setIdentity();
      link.pivot = body.pivot_m;
      link.axis = body.axis;
    } else {
      const Link& parent = links_[body.parent];
      link.R_Bi = parent.R_Bi;
      link.pivot = parent.pivot + parent.R_Bi * (body.pivot_m - multibody_.bodies()[body.parent].pivot_m);
      link.axis.noalias() = parent.R_Bi * body.axis;
    }
    if (!body.round) link.R_Bi *= Eigen::AngleAxisd(angles[i], body.axis).toRotationMatrix();
    link.rate = rates[i];
    const Vector3d moment = link.pivot.cross(link.axis);
    link.subspace << link.axis, moment;
    // V_p x S qd, since S x S is 0; angular and linear halves stay in registers.
    const SpatialVector& carried = on_base ? base_velocity_ : links_[body.parent].velocity;
    const Vector3d omega = carried.head<3>(), v = carried.tail<3>();
    const Vector3d turning = link.rate * link.axis, moving = link.rate * moment;
    link.velocity << omega + turning, v + moving;
    link.coriolis << omega.cross(turning), omega.cross(moving) + v.cross(turning);
    if (body.mass.mass_kg > 0.0) {
      link.inertia.com = link.pivot + link.R_Bi * (body.mass.com_m - body.pivot_m);
      if (body.round) {
        link.inertia.about_com = ((link.along - link.across) * link.axis) * link.axis.transpose();
        link.inertia.about_com.diagonal().array() += link.across;
      } else {
        link.inertia.about_com = link.R_Bi * body.mass.inertia_kg_m2 * link.R_Bi.transpose();
      }
    }
    link.force.setZero();
    link.torque = 0.0;
  }
}

Vector3d MultibodyDynamics::point_velocity(int body, const Vector3d& p_B) const {
  const SpatialVector& v = body < 0 ? base_velocity_ : links_[body].velocity;
  return v.tail<3>() + v.head<3>().cross(p_B);
}

void MultibodyDynamics::add_force(int body, const Vector3d& p_B, const Vector3d& force,
                                  const Vector3d& moment) {
  SpatialVector& sum = body < 0 ? base_force_ : links_[body].force;
  sum.head<3>() += p_B.cross(force) + moment;
  sum.tail<3>() += force;
}

void MultibodyDynamics::accelerations(const Vector3d& gravity_M, SpatialVector& base,
                                      double* joint_accelerations) {
  SpatialMatrix base_articulated;
  base_inertia_.write_to(base_articulated);
  SpatialVector base_bias = bias_force(base_velocity_, base_inertia_.momentum(base_velocity_), base_force_);
  for (Link& link : links_) {
    link.inertia.write_to(link.articulated);
    link.bias = bias_force(link.velocity, link.inertia.momentum(link.velocity), link.force);
  }
  for (int i = multibody_.joint_count() - 1; i >= 0; --i) {
    const RevoluteBody& body = multibody_.bodies()[i];
    Link& link = links_[i];
    link.u_vector.noalias() = link.articulated * link.subspace;
    link.per_d = 1.0 / (link.subspace.dot(link.u_vector) + body.armature_kg_m2);
    link.u = link.torque - link.subspace.dot(link.bias);
    link.articulated.noalias() -= (link.u_vector * link.per_d) * link.u_vector.transpose();
    link.bias.noalias() += link.articulated * link.coriolis;
    link.bias += link.u_vector * (link.u * link.per_d);
    if (body.parent < 0) {
      base_articulated += link.articulated;
      base_bias += link.bias;
    } else {
      links_[body.parent].articulated += link.articulated;
      links_[body.parent].bias += link.bias;
    }
  }
  // Gravity is left out at first: the whole tree falls alike, so that it does not act on the joints.
  SpatialVector seen = -base_articulated.llt().solve(base_bias);
  for (int i = 0; i < multibody_.joint_count(); ++i) {
    const int parent = multibody_.bodies()[i].parent;
    Link& link = links_[i];
    // The bias force is no longer needed, so its storage carries the acceleration outwards.
    link.bias = (parent < 0 ? seen : links_[parent].bias) + link.coriolis;
    joint_accelerations[i] = (link.u - link.u_vector.dot(link.bias)) * link.per_d;
    link.bias += link.subspace * joint_accelerations[i];
  }
  base = seen;
  base.tail<3>() += R_MB_.transpose() * gravity_M;
}

double MultibodyDynamics::kinetic_energy_j() const {
  double twice = base_velocity_.dot(base_inertia_.momentum(base_velocity_));
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const Link& link = links_[i];
    twice += link.velocity.dot(link.inertia.momentum(link.velocity));
    if (link.rate != 0.0) twice += multibody_.bodies()[i].armature_kg_m2 * link.rate * link.rate;
  }
  return 0.5 * twice;
}

SpatialVector MultibodyDynamics::momentum() const {
  SpatialVector sum = base_inertia_.momentum(base_velocity_);
  for (const Link& link : links_) sum += link.inertia.momentum(link.velocity);
  return sum;
}

Vector3d MultibodyDynamics::com_B() const {
  Vector3d sum = multibody_.base().mass_kg * multibody_.base().com_m;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const RevoluteBody& body = multibody_.bodies()[i];
    sum += body.mass.mass_kg * (links_[i].pivot + links_[i].R_Bi * (body.mass.com_m - body.pivot_m));
  }
  return sum / multibody_.mass_kg();
}

}  // namespace slipway::sim
