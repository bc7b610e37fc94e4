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
/// Derivatives of the ring's points by the two angles of the joint.
struct RingRates
{
  const RingShape& shape;
  const Eigen::VectorXd& by_motor;   ///< 2 N, derivatives by the wave generator angle [m/rad]
  const Eigen::VectorXd& by_output;  ///< 2 N, derivatives by the output angle [m/rad]

  /// Derivatives of the rim's mean rotation by motor and output angle [-].
  Eigen::Vector2d meanRotation() const noexcept
  {
    return { CupTorsion::meanRotationRate(shape, by_motor), CupTorsion::meanRotationRate(shape, by_output) };
  }
};

/// Friction of the tooth flanks: mu |F| against the sliding along the flank. mu decreases from static to kinetic with
/// the sliding speed (Stribeck curve, Gaussian).
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
  /// N, factor on the friction of each tooth's flanks, which faults change [-].
  Eigen::VectorXd& toothFactor() noexcept { return tooth_factor_; }

  /// Adds one term for each loaded tooth. `found`: result of the mesh at the same shape; `speeds`: motor and output
  /// [rad/s], for the Stribeck curve.
  void addTerms(const ToothMesh& mesh, const ToothMesh::Scratch& found, const RingRates& rates,
                const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Sets the strengths of the terms that `addTerms` added, from index `first` on, for other speeds.
  void setStrengths(int first, const Eigen::Vector2d& speeds, JointFriction& friction) const noexcept;

  /// Friction coefficient [-] of the Stribeck curve at a sliding speed along the flank [m/s].
  double coefficient(double sliding_speed) const noexcept
  {
    const double relative = sliding_speed / stribeck_velocity_;
    return friction_kinetic_ + (friction_static_ - friction_kinetic_) * std::exp(-relative * relative);
  }

  /// Coefficients for several speeds, an array of fixed size. This is faster; its error is below 3e-4 of the difference
  /// between static and kinetic friction, because exp(-q) is approximated by (1 + x + x^2/2)^-32 with x = q/32.
  template <class Speeds>
  Speeds coefficients(const Speeds& sliding_speeds) const noexcept
  {
    const double scale = 1.0 / (32.0 * stribeck_velocity_ * stribeck_velocity_);
    const Speeds x = (scale * sliding_speeds.square()).min(8.0);  // beyond 8 the coefficient is the kinetic one
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
/// The race does not slide in the rim but rolls, because mu F r is much larger than the bearing friction. Slip arises
/// because rim and race bend: their neutral fibres have a distance, the lever, and the slip is the lever times the rate
/// at which the rim tilts. Taken literally, thesis eq. 7.25-7.28 lets the race slide at motor speed, which gives 74 N.m
/// for a motor of 2.87 N.m.
class InterfaceFriction
{
public:
  explicit InterfaceFriction(const ContactParameters& parameters)
    : slip_lever_(parameters.slip_lever), coefficient_(parameters.friction_coefficient)
  {
  }

  void scale(double factor) noexcept { coefficient_ *= factor; }

  /// Magnitude of the torque at the motor shaft, >= 0 [N.m]. `found`: result of the contact at the same shape; `rates`:
  /// derivatives of the points by the motor angle [m/rad], while the output turns at the velocity ratio.
  double torque(const RingShape& shape, const WaveGeneratorContact::Scratch& found,
                const Eigen::VectorXd& rates) const noexcept;

private:
  double slip_lever_;  // [m]
  double coefficient_;
};

/// Hysteresis loss of the rim's steel, which the wave bends cyclically; it does not depend on the speed:
///
///   torque at the motor shaft = (pi / 2) eta sum_i |M_i dkappa_i/dtheta|
/// where  M_i     bending moment at tooth i [N.m]
///       kappa_i angle between the segments on either side of the tooth [rad]
///       theta   motor angle, while the output turns at the velocity ratio [rad]
///        eta     ring.loss_factor: a cycle of amplitude M_a loses pi eta M_a^2 / k, k = stiffness at the tooth
///
/// Exact for a moment that alternates about zero, as that of the wave does. A constant part counts as alternating too.
class FlexingLoss
{
public:
  explicit FlexingLoss(const RingParameters& parameters) : factor_(parameters.loss_factor) {}

  /// Torque >= 0 [N.m]. `found`: result of the bending at the same shape; `rates`: as for InterfaceFriction.
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
  double supplied{};  ///< power that the growing wave generator supplies
};

/// Dashpots of the ring (thesis eq. 5.1, 5.23, 5.33 with corrected signs).
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

  /// Adds the damping with respect to the joint's two angles, with the ring in equilibrium, to the viscous matrix.
  void add(const Contact& contact, const RingRates& rates, JointFriction& friction) const noexcept;

  /// Adds the dashpot forces on each coordinate: 2 N of the tooth points, wave generator angle, output angle. `speeds`:
  /// speeds of these coordinates; `growth`: N, speed of the wave generator's surface along each tooth's normal by its
  /// growing amplitude [m/s].
  DashpotPower addForces(const RingShape& shape, const Contact& contact, const Eigen::VectorXd& speeds,
                         const Eigen::VectorXd& growth, Eigen::VectorXd& force) const noexcept;

  /// Adds `scale` [1/s] times the damping matrix.
  void addTangent(const RingShape& shape, const Contact& contact, double scale, RingTangent& tangent) const noexcept;

private:
  double contactStrength(const Contact& contact, int i) const noexcept;

  double tension_;    // damping of each segment [N.s/m]
  double tooth_;      // damping of each tooth to the housing [N.s/m]
  double contact_;    // damping of each tooth to the wave generator [N.s/m]
  double smoothing_;  // width of the contact ramp [m]
};
}  // namespace hjt
