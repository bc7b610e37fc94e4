// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_description.hpp"
#include "arm/arm_estimator.hpp"
#include "arm/found_load.hpp"
#include "arm/unit_loads.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/friction_points.hpp"
#include "tracking/motion_driven.hpp"

namespace hjt
{
/// Finds payload, mounting and drag of an arm from the currents of all joints while they move (ArmEstimator). A row of
/// the fit is the mean over 0.1 s of one joint that moves one way with all its friction. Of long recordings a number of
/// rows is kept that suffices, evenly over the time. A leg lasts from one standstill to the next, 5 s at most; the
/// payload may change between legs. The interval of a mass contains that of the fit and 2 % of the links' own masses.
class LoadFit
{
public:
  static constexpr double PERIOD = 0.02;      ///< least time between rows that count [s]
  static constexpr double FIRST_LOOK = 30.0;  ///< motion after which live rows are looked at first [s]
  static constexpr double LAST_LOOK = 480.0;  ///< motion after which the fit of live rows begins again [s]

  /// What the fit knows of a joint's drive.
  struct Drive
  {
    explicit Drive(const Parameters& parameters);
    /// Expects the friction that this joint had when it was sound, if `known`: the points `friction` by speed. Without
    /// points the twin's friction is expected.
    void setOwn(bool known, const std::vector<FrictionPoint>& friction);

    double gain;             ///< torque per current [N.m/A]
    double rotor;            ///< inertia at the joint [kg.m^2]
    double temperature;      ///< temperature of samples that have none [degC]
    bool is_own{};           ///< whether the friction of this joint when it was sound is known
    double friction{ 1.0 };  ///< known friction over the twin's [-]
  };

  LoadFit(const ArmDescription& arm, const std::vector<Drive>& drives);
  LoadFit(const ArmDescription& arm, const std::vector<Parameters>& joints)
    : LoadFit(arm, std::vector<Drive>(joints.begin(), joints.end()))
  {
  }

  /// Gives the twin of a joint, by the joint's number.
  using TwinOf = std::function<const MotionDriven&(std::size_t joint)>;
  /// Takes samples of one time. The twins must have made the step to that time.
  void add(const std::vector<MotionSample>& samples, const TwinOf& twin);

  /// The load by the joints that count: those whose current is measured.
  FoundLoad solve(const std::vector<bool>& counts);
  /// The likeliest estimate of all causes, by the joints that count.
  ArmEstimator::Estimate estimate(const std::vector<bool>& counts);

  /// How well the best causes explain the currents.
  struct Fit
  {
    double size{ 1.0 };  ///< factor of all currents, 1 if it is one that gains of a type have [-]
    double left{ 1.0 };  ///< share of the currents that is not explained, rms [-]
    double cost{};       ///< negative logarithm of a likelihood that allows for errors of the models [-]
  };
  /// How well the arm explains the currents of the joints that count, with the best payload and the best mounting.
  Fit explained(const std::vector<bool>& counts);
  /// The least cost that any arm can have: that of an arm that explains all currents without a rare cause.
  static double leastCost();
  /// Whether a row is drawn when a `share` of the numbered rows is: the same share of every part of the rows, of a
  /// motion that repeats too. Rows of a smaller share are also among those of a larger one.
  static bool isDrawn(std::size_t number, double share);
  double moved() const { return moved_; }  ///< time in which a joint moved [s]

private:
  static constexpr double BLOCK = 0.1;  ///< time over which a row of the fit is averaged [s]

  struct Open
  {
    ArmEstimator::Row sum;
    std::size_t count{};
    double begin{};     // time of the first row [s]
    double velocity{};  // [rad/s]
  };
  struct Joint
  {
    Drive drive;
    double loads{};    // sum of the squares of its loads [(N.m)^2]
    double weights{};  // sum of the squares of the loads of 1 kg at the tip [(N.m)^2]
    Open open{};
  };

  /// Causes that may explain the currents.
  struct Hypothesis
  {
    ArmEstimator::Estimate found;
    ArmEstimator::Freedom may;
    double cost{};  ///< cost of the estimate and of its rare causes [-]
  };

  std::vector<Hypothesis> hypotheses(const std::vector<bool>& counts);
  std::vector<Hypothesis> likeliest(const std::vector<bool>& counts) const;
  bool isPushed(std::size_t leg) const { return leg < pushed_.size() && pushed_[leg]; }
  static std::vector<FittedFriction> frictionsOf(const std::vector<Hypothesis>& all);
  void cutLegs(double time, double speed);
  std::vector<double> repeats() const;
  void addTo(std::size_t number, const MotionSample& sample, const MotionDriven& twin,
             const UnitLoads::Torques& torques);
  void close(std::size_t joint, double time);
  void thin();
  ArmEstimator::Rows rowsOf(const std::vector<bool>& counts, std::size_t most) const;
  double ofLinks(const std::vector<bool>& counts) const;
  IdentifiedPayload payloadOf(const ArmEstimator::Carried& beside, const ArmEstimator::Carried& half_width,
                              double of_links) const;
  IdentifiedMounting mountingOf(const ArmEstimator::Estimate& found) const;

  Payload payload_;
  Eigen::Vector3d gravity_;
  UnitLoads unit_;
  Eigen::MatrixXd torques_;
  std::vector<JointMotion> motion_;
  std::vector<Joint> joints_;
  ArmEstimator::Rows rows_;
  std::vector<double> legs_;  // begin of each leg [s]
  std::vector<bool> pushed_;  // legs that do not count, because something pushes the arm; empty: none
  double still_{};            // time for which all joints have stood still [s]
  double moved_{};            // time in which a joint moved [s]
  double last_time_{};
  double share_{ 1.0 };  // share of the blocks that are kept
  std::vector<std::size_t> blocks_;
};
}  // namespace hjt
