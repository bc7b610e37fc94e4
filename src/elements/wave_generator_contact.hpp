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
/// Contact of the balls of the wave generator's bearing with the rim, with each ball at its own angle.
///
/// Energy:  U = 2/5 K sum_b depth_b^(5/2),   depth_b = max(sum_i w_bi z_i - h_b, 0)
/// where    w_bi  quadratic B-spline of the distance between ball b and tooth i in tooth pitches. It weights the three
///                teeth nearest to the ball, with 1/8, 3/4, 1/8 if the ball is below the middle tooth; the sum is 1
///          z_i   depth of tooth i inside the wave generator, minus the gap between rim and race at tooth i [m]
///          h_b   drop of ball b into a spall, or because it carries no load, see RaceDeflection       [m]
///          K     Hertz' stiffness of one ball [N/m^1.5]
/// The balls move with the wave generator's angle theta (RaceDeflection), so that w_bi and h_b depend on theta too. The
/// positions of the balls do not include the rotation of the race with the rim, some mrad. In the model the torque on
/// the cage therefore acts on the housing. This torque is less than a thousandth of the torque on the wave generator.
class SingleBalls
{
public:
  SingleBalls(double stiffness, int teeth);

  struct Ball
  {
    std::array<int, 3> tooth;      ///< the three teeth nearest to the ball
    std::array<double, 3> weight;  ///< weight of each of these teeth [-]
    std::array<double, 3> rate;    ///< derivative of each weight by the wave generator's angle [1/rad]
    std::array<double, 3> second;  ///< second derivative of each weight [1/rad^2]
    RaceDeflection::Drop drop;
    double depth;  ///< depth_b; < 0: the ball carries no load [m]
    double force;  ///< force of the ball [N]
    double slope;  ///< derivative of the ball's force by the depth [N/m]
  };
  struct Scratch
  {
    explicit Scratch(int teeth) : balls(static_cast<std::size_t>(teeth)) {}

    std::vector<Ball> balls;  ///< as many entries as teeth; entries after the last ball have no force
  };

  /// Computes the forces of the balls and the forces on the teeth. Adds the torque on the wave generator that arises
  /// because the balls move along the rim. `depth`: z_i [m]. @returns the energy [J].
  double press(const RaceDeflection& bearing, double wave_generator_angle, const Eigen::VectorXd& depth,
               Scratch& scratch, Eigen::VectorXd& force, double& torque) const noexcept;

  /// Adds the Hessian of the energy, except the part that arises because the normals of loaded teeth turn.
  void addTangent(const RaceDeflection& bearing, const RingShape& shape, const Eigen::VectorXd& depth,
                  const Eigen::VectorXd& normal, const Scratch& scratch, RingTangent& tangent) const noexcept;

private:
  double stiffness_;    // Hertz' stiffness of a ball [N/m^1.5]
  double tooth_pitch_;  // angle from one tooth to the next [rad]
};

/// Contact of the flexspline's inner rim with the wave generator, an ellipse with the semi-axes r0 + w and r0 - w,
/// turned by its angle theta. r0 is the rim's inner radius plus the fit and its thermal expansion. Errors of
/// manufacture change the amplitude w (ellipticity) and move the centre off the axis (eccentricity).
///
/// Energy (normal):  U = sum_i k_i r(depth_i - gap_i), depth_i inside the ellipse along its normal. With springs r is
///                   that of ContactRamp, with balls that of HertzContact. Single balls: see SingleBalls
/// Law (polar):      F_i = k_i max(depth_i, 0) along atan2(a^2 y, b^2 x), depth from the point (a cos psi, b sin psi)
///                   (thesis eq. 5.11-5.23). It has no potential; only the thesis' insertion is computed with it. The
///                   tangent omits the unsymmetric part, which costs some Newton iterations.
/// where             a = r0 + w, b = r0 - w; psi, x, y  angle and position of the tooth; Z balls, N teeth
///                   k_i  stiffness at each tooth, >= 0: of its spring [N/m], or Z/N times that of a ball [N/m^1.5]
///                   gap_i  wear of rim and race at the tooth, plus the sag of a faulty bearing's outer race [m]
class WaveGeneratorContact
{
public:
  WaveGeneratorContact(const Parameters& parameters, const ToothRing& rest);

  /// Intermediate results with one entry for each tooth.
  struct Scratch : SingleBalls::Scratch
  {
    explicit Scratch(int teeth);
    void setZero() noexcept {}  // nothing to do, because `addForces` writes every entry
    void repeat() noexcept;

    Eigen::VectorXd force;       ///< normal force of the wave generator on each tooth, >= 0 [N]
    Eigen::VectorXd depth;       ///< depth of each tooth point inside the wave generator, minus the gap [m]
    Eigen::VectorXd slope;       ///< derivative of each force by the depth; 0 with single balls [N/m]
    Eigen::VectorXd curvature;   ///< curvature of the wave generator at the foot of each tooth's normal [1/m]
    Eigen::VectorXd normal;      ///< direction of the force on each tooth, outward, x and y [-]
    Eigen::VectorXd gap;         ///< with a faulty bearing: gap between wave generator and rim at each tooth [m]
    Eigen::VectorXd gap_rate;    ///< derivative of `gap` by the wave generator's angle [m/rad]
    Eigen::VectorXd gap_second;  ///< second derivative of `gap` by the wave generator's angle [m/rad^2]
  };
  void addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept
  {
    return centre_x_ == 0.0 && centre_y_ == 0.0 && bearing_.sound() && !isOnSingleBalls() && halvesAgree(stiffness_) &&
           halvesAgree(gap_);
  }

  /// Centre of the ellipse in the axes of the housing [m].
  Eigen::Vector2d centre(const DrivePosition& position) const noexcept;

  /// Derivative of the position of the wave generator's surface by the wave amplitude, along the normal of each tooth
  /// that touches the surface; 0 for other teeth [-]. `scratch`: results at this position.
  void surfaceByAmplitude(const DrivePosition& position, const Scratch& scratch, Eigen::VectorXd& rates) const noexcept;

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  /// stiffness k_i of each tooth, which faults change [N/m] or [N/m^1.5]
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }
  const Eigen::VectorXd& gap() const noexcept { return gap_; }
  Eigen::VectorXd& gap() noexcept { return gap_; }  ///< gap at each tooth without sag, >= 0, which faults change [m]
  const RaceDeflection& bearing() const noexcept { return bearing_; }
  RaceDeflection& bearing() noexcept { return bearing_; }  ///< bearing of the wave generator, which faults change

  /// Whether the stiffness jumps where a tooth makes contact.
  bool hasKinks() const noexcept { return support_ == SupportKind::SPRINGS; }

  /// Shortens the major semi-axis at lobe 0 by `lobe`, at lobe 1 by `other_lobe` [m]. The minor axis does not change.
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
  double ellipticity_;  // error of manufacture of the amplitude w [m]
  double centre_x_;     // centre of the ellipse in the axes of the wave generator [m]
  double centre_y_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd gap_;
  RaceDeflection bearing_;
  SingleBalls single_balls_;
};
}  // namespace hjt
