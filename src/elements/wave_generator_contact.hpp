// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "elements/bearing_sag.hpp"
#include "elements/ring_forces.hpp"
#include "gear/ellipse.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Contact of the flexspline's inner rim with the elliptic wave generator, semi-axes r0 + w and r0 - w, turned by theta.
/// Errors of manufacture add to w (ellipticity) and move the ellipse's centre off the axis it turns about (eccentricity).
///
/// Energy (normal):  U = sum_i k_i r(depth_i - gap_i), r the contact ramp, depth_i inside the ellipse along its true normal
/// Law (polar):      F_i = k_i <depth_i>+ along atan2(a^2 y, b^2 x), depth from the point (a cos psi, b sin psi)
///                   (thesis eq. 5.11-5.23): not a gradient; only for the insertion of the thesis. Its tangent leaves
///                   the unsymmetric part out, which costs Newton some iterations and nothing else.
/// where             k_i  stiffness per tooth, >= 0 [N/m]
///                   gap_i  worn off rim and race there, plus the sag of a faulty bearing's outer race [m]
class WaveGeneratorContact
{
public:
  WaveGeneratorContact(const ContactParameters& parameters, const GearParameters& gear,
                       const ManufactureParameters& manufacture, const BearingParameters& bearing);

  void addForces(const RingShape& shape, const DrivePosition& position, RingForces& forces) const noexcept;
  /// `forces`: of the same shape and position.
  void addTangent(const RingShape& shape, const RingForces& forces, RingTangent& tangent) const noexcept;

  /// Of the ellipse, in the housing's axes [m].
  Eigen::Vector2d centre(const DrivePosition& position) const noexcept;

  /// Advance of the wave generator's surface along the normal of each touching tooth by the wave amplitude, 0 for the
  /// others; N [-]. `forces`: of the same position.
  void surfaceByAmplitude(const DrivePosition& position, const RingForces& forces,
                          Eigen::VectorXd& rates) const noexcept;

  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }  ///< N, editable per tooth [N/m]
  Eigen::VectorXd& gap() noexcept { return gap_; }              ///< N, editable per tooth, >= 0 [m]
  BearingSag& bearing() noexcept { return bearing_; }           ///< editable

  /// Shortens the major semi-axis at lobe 0 and at lobe 1, from how it was made [m]. The minor axis stays.
  void wear(double lobe, double other_lobe) noexcept;

private:
  void addSag(const DrivePosition& position, RingForces& forces) const noexcept;
  const double* gapOf(const RingForces& forces) const noexcept
  {
    return bearing_.sound() ? gap_.data() : forces.gap.data();
  }
  void findFeet(const RingShape& shape, const DrivePosition& position, RingForces& forces) const noexcept;

  ContactLaw law_;
  double smoothing_;
  double mean_radius_;
  double ellipticity_;  // [m]
  double centre_x_;     // of the ellipse, in the axes of the wave generator [m]
  double centre_y_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd gap_;
  BearingSag bearing_;
  double made_radius_;  // mean, as manufacture left it, and so on [m]
  double made_ellipticity_;
  double made_centre_x_;
};
}  // namespace hjt
