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
  Eigen::Vector2d across;  ///< unit vector perpendicular to `radial`, counter-clockwise [-]
  Chord chord;
  double xi;           ///< distance of the tooth from the axis of its space in the perfect gear, along `across` [m]
  double zeta;         ///< distance of the tooth from the axis of the drive, along `radial` [m]
  double tooth_ahead;  ///< error of manufacture of the tooth minus that of the space, along `across` [m]
  double space_out;    ///< error of manufacture of the space minus that of the tooth, along `radial` [m]
};

/// Energy of a tooth and its derivatives by xi and zeta.
struct FlankLaw
{
  double energy;        ///< energy of the contact [J]
  double by_xi;         ///< derivative of the energy by xi [N]
  double by_zeta;       ///< derivative of the energy by zeta [N]
  double by_xi_xi;      ///< second derivative of the energy by xi [N/m]
  double by_xi_zeta;    ///< mixed derivative of the energy by xi and zeta [N/m]
  double by_zeta_zeta;  ///< second derivative of the energy by zeta [N/m]
  double slope;         ///< tangent of the flank's angle at the contact [-]
  double cosine;        ///< cosine of the flank's angle [-]
};

/// Tooth that touches a flank, with the data for its force, tangent and friction.
struct FlankContact
{
  int tooth;
  ToothEngagement place;
  FlankLaw law;
};

/// Teeth that touch a flank, in the order of their numbers. The storage has room for all teeth.
class FlankContacts
{
public:
  explicit FlankContacts(int teeth) : contacts_(static_cast<std::size_t>(teeth)) {}

  void clear() noexcept { count_ = 0; }
  FlankContact& add() noexcept { return contacts_[count_++]; }  ///< must be called at most once for each tooth

  const FlankContact* begin() const noexcept { return contacts_.data(); }
  const FlankContact* end() const noexcept { return contacts_.data() + count_; }

private:
  std::vector<FlankContact> contacts_;
  std::size_t count_{};
};

/// Position of a tooth in its space.
struct ToothPlace
{
  double across;  ///< distance of the tooth from the axis of the space, counter-clockwise > 0 [m]
  double depth;   ///< depth of the tip below the circular spline's tip circle; < 0 outside [m]
  double tilt;    ///< angle of the tooth against the axis, counter-clockwise > 0 [rad]
  double gap;     ///< distance to the nearer flank, across the axis; < 0 in contact [m]
};

/// Contact of the flexspline's teeth with the flanks of the circular spline (complements thesis ch. 7.4-7.5).
///
/// Energy:  U = sum_i k_i cos^2(beta) [r(xi_i - c_i) + r(-xi_i - c_i)] s(d_i), r  energy of ContactRamp
/// where    X_i     tooth point                                                                             [m]
///          P_i     tooth at mid-height, X_i + z_t n_i, n_i outward normal of the chord X_{i+1} - X_{i-1}   [m]
///          z_t     distance from the tooth point to the mid-height of the tooth                            [m]
///          xi_i    P_i across the axis of its space of the circular spline, counter-clockwise > 0,
///                  plus the error of manufacture of the tooth, minus that of the space                     [m]
///          zeta_i  P_i along that axis, plus the error of the tooth, minus that of the space               [m]
///          c_i     half clearance of the profile at zeta_i, plus the additional clearance of the tooth     [m]
///          beta    nominal flank angle for all profiles, which only scales the stiffness                   [rad]
///          d_i     depth of the tip below the circular spline's tip circle, zeta_i + h/2 - lost height - r_a,
///                  h height of the flexspline's teeth, r_a radius of this tip circle                       [m]
///          s       0 for d_i <= 0, 1 for d_i >= mesh.engagement_depth, smooth between                      [-]
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

    Eigen::VectorXd flank_force;  ///< normal force on the flank of each tooth; > 0 leading, < 0 trailing flank [N]
    std::vector<char> meshed;     ///< whether each tooth touches a flank
    FlankContacts flanks;         ///< solved teeth that touch a flank
    Eigen::VectorXd pressed;      ///< depth of each tooth in the nearer flank, across the axis; > 0 in contact [m]
    Eigen::VectorXd along;        ///< zeta of the solved teeth [m]
  };
  /// Adds energy and forces to `sum`. The caller must set `scratch` to zero before.
  void addForces(const RingShape& shape, const DrivePosition& position, Scratch& scratch, ForceSum& sum) const noexcept;
  void addTangent(const RingShape& shape, const Scratch& scratch, RingTangent& tangent) const noexcept;
  bool repeats() const noexcept;

  /// Assigns to every tooth the space nearest to its angle at rest.
  void pairAtRest(const DrivePosition& position, RingShape& shape) const noexcept;

  /// Assigns the nearest space to every tooth that touches no flank. If a tooth in contact changed its space, the
  /// energy would jump. @returns the number of teeth that passed over a tip of the circular spline.
  int pairNearest(const DrivePosition& position, RingShape& shape) const noexcept;

  ToothPlace place(const RingShape& shape, const DrivePosition& position, int i) const noexcept;

  /// Sliding speed along the loaded flank of a tooth [m/s], for speeds of the tooth points [m/s] and output [rad/s].
  double slidingSpeed(const RingShape& shape, const FlankContact& contact, const Eigen::VectorXd& speeds,
                      double output_speed) const noexcept;

  const Eigen::VectorXd& stiffness() const noexcept { return stiffness_; }
  /// stiffness of the tooth pair at each tooth, which faults change [N/m]
  Eigen::VectorXd& stiffness() noexcept { return stiffness_; }
  /// reduction of each tooth's height, >= 0, which faults change [m]
  Eigen::VectorXd& tipLoss() noexcept { return tip_loss_; }
  /// Moves the centre of the circular spline off the axis of the drive by `distance`, towards space 0 [m].
  void moveSpaces(double distance) noexcept;
  /// additional clearance of each tooth, which faults change [m]
  Eigen::VectorXd& clearance() noexcept { return clearance_; }

private:
  ToothMesh(const MeshParameters& parameters, const GearParameters& gear, const ManufactureErrors& errors);

  struct Space
  {
    double axis_x;  // x of the unit vector of the axis at the output angle 0
    double axis_y;
    double across;  // error of manufacture of the space, see ManufactureErrors [m]
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
  double reach_;       // radius of a tooth point below which the tip cannot touch the circular spline [m]
  double depth_;
  double smoothing_;
  double cos_flank_;
  double half_space_;  // tangent of half the angle of a space [-]
  ToothProfile profile_;
  std::vector<Space> space_;
  Eigen::VectorXd tooth_across_;  // errors of manufacture of each tooth, see ManufactureErrors [m]
  Eigen::VectorXd tooth_along_;
  Eigen::VectorXd stiffness_;
  Eigen::VectorXd clearance_;
  Eigen::VectorXd tip_loss_;
};
}  // namespace hjt
