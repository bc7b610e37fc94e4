// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "elements/ring_sums.hpp"
#include "gear/manufacture_errors.hpp"
#include "gear/ring_shape.hpp"
#include "gear/tooth_profile.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// A tooth in the axes of its space.
struct ToothEngagement
{
  Eigen::Vector2d radial;  ///< axis of the space [-]
  Eigen::Vector2d across;  ///< counter-clockwise of it [-]
  Chord chord;
  double xi;           ///< across, from where the space would be in the perfect gear [m]
  double zeta;         ///< along the axis [m]
  double tooth_ahead;  ///< by errors of manufacture: the tooth's less the space's, across [m]
  double space_out;    ///< by errors of manufacture: the space's less the tooth's, along its axis [m]
};

/// Derivatives of a tooth's energy by xi and zeta.
struct FlankLaw
{
  double energy;        ///< [J]
  double by_xi;         ///< [N]
  double by_zeta;       ///< [N]
  double by_xi_xi;      ///< [N/m]
  double by_xi_zeta;    ///< [N/m]
  double by_zeta_zeta;  ///< [N/m]
  double slope;         ///< tangent of the flank's angle where the tooth touches [-]
  double cosine;        ///< of that angle [-]
};

/// A tooth that touches a flank, with all that its force, its tangent and its friction follow from.
struct FlankContact
{
  int tooth;
  ToothEngagement place;
  FlankLaw law;
};

/// The teeth that touch a flank, in the order of the teeth. Room for all of them from the start.
class FlankContacts
{
public:
  explicit FlankContacts(int teeth) : contacts_(static_cast<std::size_t>(teeth)) {}

  void clear() noexcept { count_ = 0; }
  FlankContact& add() noexcept { return contacts_[count_++]; }  ///< at most once a tooth

  const FlankContact* begin() const noexcept { return contacts_.data(); }
  const FlankContact* end() const noexcept { return contacts_.data() + count_; }

private:
  std::vector<FlankContact> contacts_;
  std::size_t count_{};
};

/// Position of a tooth in its space.
struct ToothPlace
{
  double across;  ///< of the axis of the space, counter-clockwise > 0 [m]
  double depth;   ///< of the tip below the circular spline's tip circle; < 0 outside [m]
  double tilt;    ///< of the tooth against the axis, counter-clockwise > 0 [rad]
  double gap;     ///< to the nearer flank, across; < 0 pressed [m]
};

/// Contact of the flexspline's teeth with the flanks of the circular spline (completes thesis ch. 7.4-7.5).
///
/// Energy:  U = sum_i k_i cos^2(beta) [r(xi_i - c_i) + r(-xi_i - c_i)] s(d_i), r the contact ramp
/// where    P_i     tooth at mid-height, X_i + z_t n_i, n_i outward normal of the chord X_{i+1} - X_{i-1}   [m]
///          xi_i    P_i across the axis of its space of the circular spline, counter-clockwise > 0,
///                  plus the error of the tooth, minus that of the space                                    [m]
///          zeta_i  P_i along that axis, plus the error of the tooth, minus that of the space               [m]
///          c_i     half clearance of the profile at zeta_i, plus the tooth's own clearance                 [m]
///          beta    the nominal flank angle, whichever the profile: it only scales the stiffness            [rad]
///          d_i     depth of the tip below the circular spline's tip circle,
///                  zeta_i + h/2 - lost height - r_a                                                        [m]
///          s       0 at d <= 0, 1 at d >= d_s, smooth between                                              [-]
///          k_i     stiffness of the tooth pair along the flank normal, >= 0                                [N/m]
class ToothMesh
{
public:
  /// @throws ParameterError on a bad table of pitch errors.
  ToothMesh(const Parameters& parameters, const ToothRing& rest);

  /// Intermediate results, one entry per tooth.
  struct Scratch
  {
    explicit Scratch(int teeth);
    void setZero() noexcept
    {
      flank_force.setZero();
      std::fill(meshed.begin(), meshed.end(), 0);
      flanks.clear();
    }
    void repeat() noexcept
    {
      repeatHalf(flank_force);
      repeatHalf(meshed);
      repeatHalf(pressed);
    }

    Eigen::VectorXd flank_force;  ///< N, normal force on the flank; > 0 leading, < 0 trailing flank [N]
    std::vector<char> meshed;     ///< N, tooth touches a flank [-]
    FlankContacts flanks;         ///< the solved teeth that touch
    Eigen::VectorXd pressed;      ///< N, depth of each tooth in the nearer flank, across; touching if > 0 [m]
    Eigen::VectorXd along;        ///< N, of the solved teeth: zeta [m]
  };
  /// `scratch`: set to zero before.
  void addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept;

  /// Pairs every tooth with the space nearest to its angle at rest.
  void pairAtRest(const DrivePosition& position, RingShape& shape) const noexcept;

  /// Pairs every tooth out of contact with its nearest space: a change in contact would tear the energy.
  /// @returns teeth that changed their space below the circular spline's tip circle: that went through a tip.
  int pairNearest(const DrivePosition& position, RingShape& shape) const noexcept;

  ToothPlace place(const RingShape& shape, const DrivePosition& position, int i) const noexcept;

  /// Sliding of a tooth that touches along its loaded flank [m/s] for speeds of the ring's points and of the output.
  double slidingSpeed(const RingShape& shape, const FlankContact& contact, const Eigen::VectorXd& speeds,
                      double output_speed) const noexcept;

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }  ///< N, editable per tooth [N/m]
  /// N, height lost at the tip, editable per tooth, >= 0 [m]
  Eigen::VectorXd& tipLoss() noexcept { return tip_loss_; }
  /// Moves the circular spline's spaces off their axis, towards space 0 [m].
  void moveSpaces(double distance) noexcept;
  Eigen::VectorXd& clearance() noexcept { return clearance_; }  ///< N, editable per tooth, adds to the profile's [m]

private:
  ToothMesh(const MeshParameters& parameters, const GearParameters& gear, const ManufactureErrors& errors);

  struct Space
  {
    double axis_x;  // unit vector at output angle 0
    double axis_y;
    double across;  // errors of manufacture, see ManufactureErrors [m]
    double along;
  };
  ToothEngagement engage(const RingShape& shape, double cos_output, double sin_output, int i) const noexcept;
  double pressedBy(const ToothEngagement& tooth, int i) const noexcept;
  FlankLaw law(const ToothEngagement& tooth, int i) const noexcept;
  void findPressed(const RingShape& shape, double cos_output, double sin_output, Scratch& scratch) const noexcept;
  double pairOutOfReach(const DrivePosition& position, RingShape& shape) const noexcept;
  int pairInReach(const DrivePosition& position, RingShape& shape) const noexcept;
  double firstSpace(double output_angle) const noexcept;

  int spaces_;
  double mid_height_;
  double tip_offset_;  // half tooth height minus the circular spline's tip radius [m]
  double reach_;       // radius of a tooth point below which its tip cannot touch [m]
  double depth_;
  double smoothing_;
  double cos_flank_;
  double half_space_;  // tangent of half a space
  ToothProfile profile_;
  std::vector<Space> space_;
  Eigen::VectorXd tooth_across_;  // errors of manufacture, see ManufactureErrors
  Eigen::VectorXd tooth_along_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd clearance_;
  Eigen::VectorXd tip_loss_;
};
}  // namespace hjt
