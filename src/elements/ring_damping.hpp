// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/joint_friction.hpp"
#include "elements/ring_friction.hpp"
#include "elements/ring_tangent.hpp"
#include "elements/wave_generator_contact.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
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
