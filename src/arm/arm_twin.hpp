// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "arm/arm_dynamics.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// Settings of the coupling between the drives of an arm. docs/arm_twin.md gives cost and error of each setting.
struct ArmCoupling
{
  double mass_rate{ 1000.0 };  ///< rate at which the mass matrix is computed, at most solver.rate [Hz]
  int order{ 1 };  ///< order of the polynomial that extrapolates the other drives' torques: 0 (last torques), 1 or 2
};

/// The drives of an arm, each a Twin, coupled by the dynamics of its links. For angles q, speeds v, accelerations a:
///
///   (M(q) + D) a = tau - h(q, v)
///
/// where  M, h  inertia, and torques of weight, Coriolis and the wrench at the tip (ArmDynamics)  [kg.m^2], [N.m]
///        D     inertia of the circular splines, on the diagonal                                  [kg.m^2]
///        tau   torques of gears and output friction on the links                                 [N.m]
///
/// The equation is solved for one joint at a time. With W the inverse of M + D a drive sees the inertia 1/W_ii and the
/// load
///
///   h_i - sum_{k != i} W_ik (tau_k - h_k) / W_ii
///
/// All drives step together. Each step computes h at the predicted instant, and extrapolates tau of the other drives
/// from the steps before. M depends only on the pose and is computed at ArmCoupling::mass_rate. The rotors belong to
/// the drives; the casings of the motors belong to the links.
///
/// A copy is at the same instant as the original. Under the same inputs both give the same results to the last bit.
/// After construction only a copy throws or allocates unless stated.
class ArmTwin
{
public:
  /// `drives`: parameters of the drive of each joint, with equal solver.rate and without gravity. The least inertia of
  /// the arm that a drive moves replaces the drive's output.load_inertia. `start`: angle of each joint at which the arm
  /// stands with engaged brakes [rad]. @throws ParameterError naming the joint and the key.
  ArmTwin(const ArmDescription& arm, std::vector<Parameters> drives, const std::vector<double>& start,
          const SurfaceSource& surface_source = {}, const ArmCoupling& coupling = {});

  std::size_t joints() const noexcept { return drives_.size(); }
  Twin& drive(std::size_t joint) noexcept { return drives_[joint]; }
  const Twin& drive(std::size_t joint) const noexcept { return drives_[joint]; }

  /// Sets the arm back to its start angles at the time `stamp`. Returns false if `stamp` is beyond +-MAX_STAMP.
  bool reset(Stamp stamp) noexcept;

  /// Makes one solver step of all drives. Returns false, and does nothing, if the next instant is after `until`.
  bool step(Stamp until) noexcept;

  Stamp stamp() const noexcept { return drives_.front().stamp(); }
  Stamp stepLength() const noexcept { return drives_.front().stepLength(); }

  /// Angles, speeds and accelerations of the links at the present instant.
  const std::vector<JointMotion>& motion() const noexcept { return motion_; }
  /// Angle of the joint at which the output angle of its drive is zero [rad].
  double startAngle(std::size_t joint) const noexcept { return zero_[joint]; }
  ToolPose toolPose() noexcept { return dynamics_.toolPose(motion_); }

  /// Sets force and moment on the tip in the frame of the base, from the next step on.
  void setWrench(const ArmWrench& wrench) noexcept { dynamics_.setWrench(wrench); }

  /// Sets the payload at the tip, from the next step on.
  void setPayload(const Payload& payload) noexcept { dynamics_.setPayload(payload); }

  /// Error of the coupling since reset: energy that the drives delivered - change of the arm's energy [J]. The error
  /// has no meaning once a wrench or another payload was set.
  double energyResidual() noexcept;
  double deliveredEnergy() const noexcept;  ///< energy that all drives delivered to the links since reset [J]

private:
  double armEnergy() noexcept;
  void setMass(const std::vector<JointMotion>& pose) noexcept;
  void takeMass() noexcept;
  void couple() noexcept;
  void observe() noexcept;

  ArmDynamics dynamics_;
  std::vector<double> pose_at_start_;  // joint angles at the start [rad]
  std::vector<double> zero_;           // joint angle - output angle of each drive [rad]
  std::vector<Twin> drives_;
  std::vector<double> spline_inertia_;  // inertia of each circular spline [kg.m^2]
  std::int64_t mass_steps_;             // number of steps from one computation of the mass matrix to the next [-]
  std::int64_t steps_{};
  std::vector<JointMotion> motion_;
  std::vector<JointMotion> next_;  // predicted motion at the end of the step
  std::vector<double> bias_;       // h [N.m]
  Eigen::MatrixXd mass_;           // M + D [kg.m^2]
  Eigen::LLT<Eigen::MatrixXd> factors_;
  Eigen::MatrixXd inverse_;                      // W [1/(kg.m^2)]
  std::array<double, 3> weights_;                // weights of the last steps' torques in the extrapolation [-]
  std::array<Eigen::VectorXd, 3> link_torques_;  // tau of the last three steps, the newest first [N.m]
  Eigen::VectorXd excess_;                       // tau - h at the end of the step, extrapolated [N.m]
  double energy_at_start_{};
};
}  // namespace hjt
