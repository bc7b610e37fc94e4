// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "elements/race_deflection.hpp"
#include "elements/ring_sums.hpp"
#include "gear/ellipse.hpp"
#include "gear/ring_shape.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// The balls of the wave generator's bearing under the rim, each at its place.
///
/// Energy:  U = 2/5 K sum_b depth_b^(5/2),   depth_b = <sum_i w_bi z_i - h_b>+
/// where    w_bi  quadratic B-spline of the tooth pitches between ball b and tooth i: the three teeth next to the ball,
///                1/8, 3/4, 1/8 where it is below the middle one; they add up to 1
///          z_i   depth of tooth i inside the wave generator, less the gap between rim and race there [m]
///          h_b   how far ball b drops into a spall or carries nothing, see RaceDeflection             [m]
///          K     Hertz, of one ball [N/m^1.5]
/// The balls move with the wave generator's angle (RaceDeflection): theta enters through w and h too. The race's turn
/// with the rim, some mrad, is left out of their places, so the torque on the cage has its reaction on the housing: it
/// is less than a thousandth of the torque on the wave generator.
class SingleBalls
{
public:
  SingleBalls(double stiffness, int teeth);

  struct Ball
  {
    std::array<int, 3> tooth;      ///< next to it
    std::array<double, 3> weight;  ///< [-]
    std::array<double, 3> rate;    ///< derivative of the weight by the wave generator's angle [1/rad]
    std::array<double, 3> second;  ///< the second one [1/rad^2]
    RaceDeflection::Drop drop;
    double depth;  ///< < 0: it carries nothing [m]
    double force;  ///< [N]
    double slope;  ///< of the force over the depth [N/m]
  };
  struct Scratch
  {
    explicit Scratch(int teeth) : balls(static_cast<std::size_t>(teeth)) {}

    std::vector<Ball> balls;  ///< one per tooth; entries beyond the number of balls have no force
  };

  /// Finds the forces of the balls, and with them those on the teeth; adds the torque on the wave generator by the
  /// motion of the balls along the rim. `depth`: z above. @returns the energy [J].
  double press(const RaceDeflection& bearing, double wave_generator_angle, const Eigen::VectorXd& depth,
               Scratch& scratch, Eigen::VectorXd& force, double& torque) const noexcept;

  /// All of the Hessian but the turn of the normals under the teeth's forces.
  void addTangent(const RaceDeflection& bearing, const RingShape& shape, const Eigen::VectorXd& depth,
                  const Eigen::VectorXd& normal, const Scratch& scratch, RingTangent& tangent) const noexcept;

private:
  double stiffness_;    // [N/m^1.5]
  double tooth_pitch_;  // [rad]
};

/// Contact of the flexspline's inner rim with the elliptic wave generator, semi-axes r0 + w and r0 - w, turned by
/// theta. r0 is the rim's inner radius with the fit and its thermal growth. Errors of manufacture add to w
/// (ellipticity) and move the ellipse's centre off the axis it turns about (eccentricity).
///
/// Energy (normal):  U = sum_i k_i r(depth_i - gap_i), depth_i inside the ellipse along its normal; r the contact ramp
///                   where each tooth has a spring, Hertz' point contact where it has its share of the balls
///                   Single balls: SingleBalls
/// Law (polar):      F_i = k_i <depth_i>+ along atan2(a^2 y, b^2 x), depth from the point (a cos psi, b sin psi)
///                   (thesis eq. 5.11-5.23): not a gradient; only for the insertion of the thesis. Its tangent leaves
///                   the unsymmetric part out, which costs Newton some iterations and nothing else.
/// where             k_i  stiffness per tooth, >= 0: of its spring [N/m], or Z/N times that of a ball [N/m^1.5]
///                   gap_i  worn off rim and race there, plus the sag of a faulty bearing's outer race [m]
class WaveGeneratorContact
{
public:
  WaveGeneratorContact(const Parameters& parameters, const ToothRing& rest);

  /// Intermediate results, one entry per tooth.
  struct Scratch : SingleBalls::Scratch
  {
    explicit Scratch(int teeth);
    void setZero() noexcept {}  // `addForces` writes every entry
    void repeat() noexcept;

    Eigen::VectorXd force;       ///< N, normal force of the wave generator on each tooth, >= 0 [N]
    Eigen::VectorXd depth;       ///< N, depth of each tooth point inside the wave generator, less the gap [m]
    Eigen::VectorXd slope;       ///< N, of the force over the depth; 0 on single balls [N/m]
    Eigen::VectorXd curvature;   ///< N, of the wave generator there [1/m]
    Eigen::VectorXd normal;      ///< 2 N, direction of the force, outward [-]
    Eigen::VectorXd gap;         ///< N, while the bearing is faulty: between wave generator and rim [m]
    Eigen::VectorXd gap_rate;    ///< N, likewise: its derivative by the wave generator's angle [m/rad]
    Eigen::VectorXd gap_second;  ///< N, likewise: the second derivative [m/rad^2]
  };
  void addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept
  {
    return centre_x_ == 0.0 && centre_y_ == 0.0 && bearing_.sound() && !isOnSingleBalls() && halvesAgree(stiffness_) &&
           halvesAgree(gap_);
  }

  /// Of the ellipse, in the housing's axes [m].
  Eigen::Vector2d centre(const DrivePosition& position) const noexcept;

  /// Advance of the wave generator's surface along the normal of each touching tooth by the wave amplitude, 0 for the
  /// others; N [-]. `scratch`: of the same position.
  void surfaceByAmplitude(const DrivePosition& position, const Scratch& scratch, Eigen::VectorXd& rates) const noexcept;

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }  ///< N, editable per tooth [N/m], [N/m^1.5]
  const Eigen::VectorXd& gap() const noexcept { return gap_; }
  Eigen::VectorXd& gap() noexcept { return gap_; }  ///< N, editable per tooth, >= 0 [m]
  const RaceDeflection& bearing() const noexcept { return bearing_; }
  RaceDeflection& bearing() noexcept { return bearing_; }  ///< editable

  /// Whether the force's slope jumps where a tooth makes contact.
  bool hasKinks() const noexcept { return support_ == SupportKind::SPRINGS; }

  /// Shortens the major semi-axis at lobe 0 and at lobe 1 [m]. The minor axis stays.
  void wear(double lobe, double other_lobe) noexcept;

private:
  void addSag(const DrivePosition& position, Scratch& scratch) const noexcept;
  const double* gapOf(const Scratch& scratch) const noexcept { return hasSag() ? scratch.gap.data() : gap_.data(); }
  bool isOnSingleBalls() const noexcept { return support_ == SupportKind::SINGLE_BALLS; }
  bool hasSag() const noexcept { return !bearing_.sound() && !isOnSingleBalls(); }
  double press(int solved, Scratch& scratch) const noexcept;
  void findFeet(const RingShape& shape, const DrivePosition& position, Scratch& scratch) const noexcept;

  ContactLaw law_;
  SupportKind support_;
  double smoothing_;
  double mean_radius_;
  double ellipticity_;  // [m]
  double centre_x_;     // of the ellipse, in the axes of the wave generator [m]
  double centre_y_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd gap_;
  RaceDeflection bearing_;
  SingleBalls single_balls_;
};
}  // namespace hjt
