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
/// How the ring's points move with the two angles of the joint.
struct RingRates
{
  const RingShape& shape;
  const Eigen::VectorXd& by_motor;   ///< 2 N, by wave generator angle [m/rad]
  const Eigen::VectorXd& by_output;  ///< 2 N, by output angle [m/rad]

  /// Of the rim's mean rotation, by motor and output angle [-].
  Eigen::Vector2d meanRotation() const noexcept
  {
    return { CupTorsion::meanRotationRate(shape, by_motor), CupTorsion::meanRotationRate(shape, by_output) };
  }
};

/// Friction on the tooth flanks: mu |F| against the sliding along the flank, mu falling from static to kinetic with the
/// sliding speed (Stribeck, Gaussian).
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

  /// Friction of all flanks times this [-].
  void scale(double factor) noexcept
  {
    friction_static_ *= factor;
    friction_kinetic_ *= factor;
  }
  /// N, friction of each tooth's flanks to that of the others, editable [-].
  Eigen::VectorXd& toothFactor() noexcept { return tooth_factor_; }

  /// One term per loaded tooth. `found`: by the mesh, at the same shape; `speeds`: motor and output [rad/s], for the
  /// Stribeck curve.
  void addTerms(const ToothMesh& mesh, const ToothMesh::Scratch& found, const RingRates& rates,
                const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Strengths of the terms that `addTerms` added, the first of them `first`, at other speeds.
  void setStrengths(int first, const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Friction coefficient by the Stribeck curve, at a sliding speed along the flank [m/s], [-].
  double coefficient(double sliding_speed) const noexcept
  {
    const double relative = sliding_speed / stribeck_velocity_;
    return friction_kinetic_ + (friction_static_ - friction_kinetic_) * std::exp(-relative * relative);
  }

  /// The same for several speeds at once, an array of fixed size: quicker, and off by less than 3e-4 of the difference
  /// between static and kinetic friction, exp(-q) taken as (1 + x + x^2/2)^-32 with x = q/32.
  template <class Speeds>
  Speeds coefficients(const Speeds& sliding_speeds) const noexcept
  {
    const double scale = 1.0 / (32.0 * stribeck_velocity_ * stribeck_velocity_);
    const Speeds x = (scale * sliding_speeds.square()).min(8.0);  // beyond it nothing is left of the difference
    const Speeds base = 1.0 + x * (1.0 + 0.5 * x);
    return friction_kinetic_ +
           (friction_static_ - friction_kinetic_) / base.square().square().square().square().square();
  }

private:
  double friction_static_;
  double friction_kinetic_;
  double stribeck_velocity_;  // [m/s]
  Eigen::VectorXd tooth_factor_;
};

/// Friction between the outer race of the wave generator's bearing and the flexspline.
///
/// The race does not slide in the rim: it rolls, held by mu F r >> bearing friction. What slips are the two surfaces as
/// rim and race bend: their neutral fibres lie a lever apart, so the slip is the lever times the rate at which the rim
/// tilts. Taken literally, thesis eq. 7.25-7.28 lets the race slide at motor speed and gives 74 N.m on a 2.87 N.m
/// motor.
class InterfaceFriction
{
public:
  explicit InterfaceFriction(const ContactParameters& parameters)
    : slip_lever_(parameters.slip_lever), coefficient_(parameters.friction_coefficient)
  {
  }

  void scale(double factor) noexcept { coefficient_ *= factor; }

  /// Size of the torque at the motor shaft, >= 0 [N.m]. `found`: by the contact, at the same shape; `rates`: of the
  /// points by motor angle while running [m/rad].
  double torque(const RingShape& shape, const WaveGeneratorContact::Scratch& found,
                const Eigen::VectorXd& rates) const noexcept;

private:
  double slip_lever_;  // [m]
  double coefficient_;
};

/// Energy that the rim's steel loses as the wave bends it to and fro, whatever the speed:
///
///   torque at the motor shaft = (pi / 2) eta sum_i |M_i dkappa_i/dtheta|
/// where  M_i     bending moment at tooth i [N.m]
///        kappa_i angle between the segments on either side of it [rad]; theta the motor's, the output following
///        eta     ring.loss_factor: a cycle of the amplitude M_a loses pi eta M_a^2 / k, k the stiffness at the tooth
///
/// Exact where the moment swings about zero, as that of the wave does; a moment that stays counts as swinging too.
class FlexingLoss
{
public:
  explicit FlexingLoss(const RingParameters& parameters) : factor_(parameters.loss_factor) {}

  /// >= 0 [N.m]. `found`: by the bending, at the same shape; `rates`: as InterfaceFriction's.
  double torque(const RingShape& shape, const RimBending::Scratch& found, const Eigen::VectorXd& rates) const noexcept
  {
    return factor_ > 0.0 ? factor_ * bendingRate(shape, found.moment, rates) : 0.0;
  }

private:
  static double bendingRate(const RingShape& shape, const Eigen::VectorXd& moment,
                            const Eigen::VectorXd& rates) noexcept;

  double factor_;
};

/// Power through the dashpots at one instant [W].
struct DashpotPower
{
  double dissipated{};
  double supplied{};  ///< by the growing wave generator
};

/// Dashpots of the ring (thesis eq. 5.1, 5.23, 5.33, signs mended).
///
/// Force:  c_tooth against the speed of each tooth point, c_tension against the stretching of each segment,
///         c_contact r'(depth) against the rate of depth of each tooth in the wave generator, r the contact ramp
/// where   c   [N.s/m], >= 0; r' is 1 in contact and 0 out of it where the ramp has no width
///
/// The damping matrix is symmetric and positive semi-definite: power = v^T C v.
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

  using Contact = WaveGeneratorContact::Scratch;  ///< result of the contact at the same shape

  /// Seen through the joint's two angles, the ring following them: adds to the viscous matrix.
  void add(const Contact& contact, const RingRates& rates, JointFriction& friction) const noexcept;

  /// Adds the dashpots' force on each coordinate of the ring: 2 N of the tooth points, wave generator and output angle.
  /// `speeds`: of the same coordinates; `growth`: N, speed of the wave generator's surface by its growing amplitude
  /// along each tooth's normal [m/s].
  DashpotPower addForces(const RingShape& shape, const Contact& contact, const Eigen::VectorXd& speeds,
                         const Eigen::VectorXd& growth, Eigen::VectorXd& force) const noexcept;

  /// Adds `scale` [1/s] times the damping matrix.
  void addTangent(const RingShape& shape, const Contact& contact, double scale, RingTangent& tangent) const noexcept;

private:
  double contactStrength(const Contact& contact, int i) const noexcept;

  double tension_;    // [N.s/m]
  double tooth_;      // [N.s/m]
  double contact_;    // [N.s/m]
  double smoothing_;  // [m]
};
}  // namespace hjt
