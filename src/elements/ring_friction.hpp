// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "elements/cup_torsion.hpp"
#include "elements/friction_laws.hpp"
#include "elements/rim_elasticity.hpp"
#include "elements/ring_sums.hpp"
#include "elements/tooth_mesh.hpp"
#include "elements/wave_generator_contact.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Derivatives of the tooth points by motor angle and output angle.
struct RingRates
{
  const RingShape& shape;
  const Eigen::VectorXd& by_motor;   ///< derivatives of x and y of each tooth point by the motor angle [m/rad]
  const Eigen::VectorXd& by_output;  ///< derivatives of x and y of each tooth point by the output angle [m/rad]

  /// Derivatives of the rim's mean rotation by motor and output angle [-].
  Eigen::Vector2d meanRotation() const noexcept
  {
    return { CupTorsion::meanRotationRate(shape, by_motor), CupTorsion::meanRotationRate(shape, by_output) };
  }
};

/// Friction of the tooth flanks: the force mu |F| opposes the sliding along the flank under the normal force F. With
/// the sliding speed mu decreases from the static to the kinetic coefficient (Gaussian Stribeck curve).
class MeshFriction
{
public:
  MeshFriction(const MeshParameters& parameters, int teeth)
    : friction_static_(parameters.friction_static)
    , friction_kinetic_(parameters.friction_kinetic)
    , stribeck_velocity_(parameters.stribeck_velocity)
    , tooth_factor_(Eigen::VectorXd::Ones(teeth))
  {
  }

  /// Multiplies the friction of all flanks by `factor` [-].
  void scale(double factor) noexcept
  {
    friction_static_ *= factor;
    friction_kinetic_ *= factor;
  }
  /// factor on the friction of each tooth's flanks, which faults change [-]
  Eigen::VectorXd& toothFactor() noexcept { return tooth_factor_; }

  /// Adds one dry term for each loaded tooth. `found`: result of the mesh at the shape of `rates`; `speeds`: speeds of
  /// motor and output for the Stribeck curve [rad/s].
  void addTerms(const ToothMesh& mesh, const ToothMesh::Scratch& found, const RingRates& rates,
                const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Computes the strengths of the terms of `addTerms` for other `speeds`. `first`: index of the first of these terms.
  void setStrengths(int first, const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Friction coefficient by the Stribeck curve at a sliding speed along the flank [m/s] [-].
  double coefficient(double sliding_speed) const noexcept
  {
    const double relative = sliding_speed / stribeck_velocity_;
    return friction_kinetic_ + (friction_static_ - friction_kinetic_) * std::exp(-relative * relative);
  }

  /// Friction coefficients for an array of sliding speeds. The exp(-q) of the Stribeck curve is approximated by (1 + x
  /// + x^2/2)^-32, x = q/32, with an error below 3e-4 of the difference between static and kinetic coefficient.
  template <class Speeds>
  Speeds coefficients(const Speeds& sliding_speeds) const noexcept
  {
    const double scale = 1.0 / (32.0 * stribeck_velocity_ * stribeck_velocity_);
    const Speeds x = (scale * sliding_speeds.square()).min(8.0);  // for x > 8 the coefficient is the kinetic one
    const Speeds base = 1.0 + x * (1.0 + 0.5 * x);
    return friction_kinetic_ +
           (friction_static_ - friction_kinetic_) / base.square().square().square().square().square();
  }

private:
  double friction_static_;
  double friction_kinetic_;
  double stribeck_velocity_;  // sliding speed scale of the Stribeck curve [m/s]
  Eigen::VectorXd tooth_factor_;
};

/// Friction between the outer race of the wave generator's bearing and the flexspline.
///
/// The race does not slide in the rim but rolls, because the torque mu F r of full sliding (coefficient of friction,
/// contact force, radius) is much larger than the bearing friction. Slip arises because the neutral fibres of rim and
/// race are a distance apart, the lever. The slip is the lever times the rate at which the rim tilts. By thesis eq.
/// 7.25-7.28 the race would slide at motor speed, with a torque of 74 N.m against a motor of 2.87 N.m.
class InterfaceFriction
{
public:
  explicit InterfaceFriction(const ContactParameters& parameters)
    : slip_lever_(parameters.slip_lever), coefficient_(parameters.friction_coefficient)
  {
  }

  void scale(double factor) noexcept { coefficient_ *= factor; }

  /// Magnitude of the torque at the motor shaft, >= 0 [N.m]. `found`: result of the contact at `shape`; `rates`:
  /// derivatives of the tooth points by the motor angle, at constant load [m/rad].
  double torque(const RingShape& shape, const WaveGeneratorContact::Scratch& found,
                const Eigen::VectorXd& rates) const noexcept;

private:
  double slip_lever_;  // lever of the slip [m]
  double coefficient_;
};

/// Hysteresis loss of the rim's steel, which the wave bends cyclically. The loss does not depend on the speed:
///
///   torque at the motor shaft = (pi / 2) eta sum_i |M_i dkappa_i/dtheta|
/// where  M_i     bending moment at tooth i [N.m]
///       kappa_i angle between the segments on either side of the tooth [rad]
///       theta   motor angle, at constant load [rad]
///       eta     ring.loss_factor: a cycle of amplitude M_a loses pi eta M_a^2 / k, k = stiffness at the tooth [-]
///
/// The law is exact for a moment that alternates about zero, like that of the wave, and is applied to all moments.
class FlexingLoss
{
public:
  explicit FlexingLoss(const RingParameters& parameters) : factor_(parameters.loss_factor) {}

  /// Torque at the motor shaft, >= 0 [N.m]. `found`: result of the bending at `shape`; `rates`: see InterfaceFriction.
  double torque(const RingShape& shape, const RimBending::Scratch& found, const Eigen::VectorXd& rates) const noexcept
  {
    return factor_ > 0.0 ? factor_ * bendingRate(shape, found.moment, rates) : 0.0;
  }

private:
  static double bendingRate(const RingShape& shape, const Eigen::VectorXd& moment,
                            const Eigen::VectorXd& rates) noexcept;

  double factor_;
};

/// Power of the dashpots at one instant [W].
struct DashpotPower
{
  double dissipated{};
  double supplied{};  ///< power that a wave generator of growing amplitude supplies [W]
};

/// Dashpots of the ring (thesis eq. 5.1, 5.23, 5.33 with corrected signs).
///
/// Force:  c_tooth times the speed of each tooth point, c_tension times the rate of stretch of each segment,
///         c_contact r'(depth) times the rate of the depth of each tooth in the wave generator
/// where   c_tooth, c_tension, c_contact  damping coefficients, >= 0 [N.s/m]
///         r  ContactRamp; without a width r' is 1 in contact and 0 out of contact [-]
///
/// The damping matrix C is symmetric and positive semi-definite. The dissipated power is v^T C v for the speeds v.
class RingDamping
{
public:
  RingDamping(const RingParameters& ring, const ContactParameters& contact)
    : tension_(ring.tension_damping)
    , tooth_(ring.tooth_damping)
    , contact_(contact.damping)
    , smoothing_(contact.smoothing)
  {
  }

  using Contact = WaveGeneratorContact::Scratch;  ///< result of WaveGeneratorContact::addForces for the shape

  /// Adds the damping of a ring in equilibrium, with respect to motor and output angle, to the viscous matrix.
  void add(const Contact& contact, const RingRates& rates, JointFriction& friction) const noexcept;

  /// Adds the dashpot forces on each coordinate: x and y of each tooth point, wave generator angle, output angle.
  /// `speeds`: speeds of these coordinates; `growth`: speed of the wave generator's surface along the contact normal of
  /// each tooth by the growth of the amplitude [m/s].
  DashpotPower addForces(const RingShape& shape, const Contact& contact, const Eigen::VectorXd& speeds,
                         const Eigen::VectorXd& growth, Eigen::VectorXd& force) const noexcept;

  /// Adds `scale` [1/s] times the damping matrix to the tangent.
  void addTangent(const RingShape& shape, const Contact& contact, double scale, RingTangent& tangent) const noexcept;

private:
  double contactStrength(const Contact& contact, int i) const noexcept;

  double tension_;    // damping of each segment [N.s/m]
  double tooth_;      // damping of each tooth to the housing [N.s/m]
  double contact_;    // damping of each tooth to the wave generator [N.s/m]
  double smoothing_;  // width of the contact ramp [m]
};
}  // namespace hjt
