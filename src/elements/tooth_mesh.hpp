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
/// Position of a tooth in the axes of its space.
struct ToothEngagement
{
  Eigen::Vector2d radial;  ///< axis of the space [-]
  Eigen::Vector2d across;  ///< perpendicular to `radial`, counter-clockwise [-]
  Chord chord;
  double xi;           ///< across, from the position of the space in the perfect gear [m]
  double zeta;         ///< along the axis [m]
  double tooth_ahead;  ///< error of manufacture of the tooth minus that of the space, across [m]
  double space_out;    ///< error of manufacture of the space minus that of the tooth, along the axis [m]
};

/// Energy of a tooth and its derivatives by xi and zeta.
struct FlankLaw
{
  double energy;        ///< [J]
  double by_xi;         ///< [N]
  double by_zeta;       ///< [N]
  double by_xi_xi;      ///< [N/m]
  double by_xi_zeta;    ///< [N/m]
  double by_zeta_zeta;  ///< [N/m]
  double slope;         ///< tangent of the flank's angle at the contact [-]
  double cosine;        ///< cosine of the flank's angle [-]
};

/// A tooth that touches a flank, with the data for its force, tangent and friction.
struct FlankContact
{
  int tooth;
  ToothEngagement place;
  FlankLaw law;
};

/// The teeth that touch a flank, ordered by tooth. The storage has room for all teeth.
class FlankContacts
{
public:
  explicit FlankContacts(int teeth) : contacts_(static_cast<std::size_t>(teeth)) {}

  void clear() noexcept { count_ = 0; }
  FlankContact& add() noexcept { return contacts_[count_++]; }  ///< call at most once for each tooth

  const FlankContact* begin() const noexcept { return contacts_.data(); }
  const FlankContact* end() const noexcept { return contacts_.data() + count_; }

private:
  std::vector<FlankContact> contacts_;
  std::size_t count_{};
};

/// Position of a tooth in its space.
struct ToothPlace
{
  double across;  ///< distance from the axis of the space, counter-clockwise > 0 [m]
  double depth;   ///< depth of the tip below the circular spline's tip circle; < 0 outside [m]
  double tilt;    ///< angle of the tooth against the axis, counter-clockwise > 0 [rad]
  double gap;     ///< distance to the nearer flank, across; < 0 in contact [m]
};

/// Contact of the flexspline's teeth with the flanks of the circular spline (complements thesis ch. 7.4-7.5).
///
/// Energy:  U = sum_i k_i cos^2(beta) [r(xi_i - c_i) + r(-xi_i - c_i)] s(d_i), r the contact ramp
/// where    P_i     tooth at mid-height, X_i + z_t n_i, n_i outward normal of the chord X_{i+1} - X_{i-1}   [m]
///          xi_i    P_i across the axis of its space of the circular spline, counter-clockwise > 0,
///                  plus the error of the tooth, minus that of the space                                    [m]
///          zeta_i  P_i along that axis, plus the error of the tooth, minus that of the space               [m]
///          c_i     half clearance of the profile at zeta_i, plus the additional clearance of the tooth     [m]
///          beta    nominal flank angle for all profiles, which only scales the stiffness                   [rad]
///          d_i     depth of the tip below the circular spline's tip circle,
///                  zeta_i + h/2 - lost height - r_a                                                        [m]
///          s       0 at d <= 0, 1 at d >= d_s, smooth between                                              [-]
///          k_i     stiffness of the tooth pair along the flank normal, >= 0                                [N/m]
class ToothMesh
{
public:
  /// @throws ParameterError if a table of pitch errors is invalid.
  ToothMesh(const Parameters& parameters, const ToothRing& rest);

  /// Intermediate results with one entry for each tooth.
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
    std::vector<char> meshed;     ///< N, whether the tooth touches a flank [-]
    FlankContacts flanks;         ///< solved teeth that touch
    Eigen::VectorXd pressed;      ///< N, depth of each tooth in the nearer flank, across; > 0 in contact [m]
    Eigen::VectorXd along;        ///< N, zeta of the solved teeth [m]
  };
  /// `scratch` must be zero before.
  void addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept;

  /// Assigns every tooth the space nearest to its angle at rest.
  void pairAtRest(const DrivePosition& position, RingShape& shape) const noexcept;

  /// Assigns every tooth out of contact its nearest space. For a tooth in contact the energy would jump.
  /// @returns the number of teeth that changed their space below the circular spline's tip circle, and thus through a
  /// tip.
  int pairNearest(const DrivePosition& position, RingShape& shape) const noexcept;

  ToothPlace place(const RingShape& shape, const DrivePosition& position, int i) const noexcept;

  /// Sliding speed [m/s] along the loaded flank of a tooth, for speeds of the ring's points and of the output.
  double slidingSpeed(const RingShape& shape, const FlankContact& contact, const Eigen::VectorXd& speeds,
                      double output_speed) const noexcept;

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  /// N, stiffness of each tooth, which faults change [N/m]
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }
  /// N, reduction of each tooth's height, >= 0, which faults change [m].
  Eigen::VectorXd& tipLoss() noexcept { return tip_loss_; }
  /// Moves the circular spline's spaces by `distance` off their axis, towards space 0 [m].
  void moveSpaces(double distance) noexcept;
  /// N, additional clearance of each tooth, which faults change [m]
  Eigen::VectorXd& clearance() noexcept { return clearance_; }

private:
  ToothMesh(const MeshParameters& parameters, const GearParameters& gear, const ManufactureErrors& errors);

  struct Space
  {
    double axis_x;  // x of the unit vector at output angle 0
    double axis_y;
    double across;  // error of manufacture, see ManufactureErrors [m]
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
  double tip_offset_;  // half the tooth height minus the circular spline's tip radius [m]
  double reach_;       // radius of a tooth point below which the tip cannot touch [m]
  double depth_;
  double smoothing_;
  double cos_flank_;
  double half_space_;  // tangent of half the angle of a space
  ToothProfile profile_;
  std::vector<Space> space_;
  Eigen::VectorXd tooth_across_;  // errors of manufacture, see ManufactureErrors
  Eigen::VectorXd tooth_along_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd clearance_;
  Eigen::VectorXd tip_loss_;
};
}  // namespace hjt
