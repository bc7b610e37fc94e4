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
/// Finds payload, mounting and drag of an arm from the currents of its moving joints (ArmEstimator). A row of the fit
/// is the mean over 0.1 s in which one joint moves in one direction with fully built-up friction. Of a long recording
/// the class keeps a limited number of rows, evenly spread over the time. The payload may change between legs. The
/// interval of a mass contains, beside the errors of the fit, an error of 2 % of the links' masses.
class LoadFit
{
public:
  static constexpr double PERIOD = 0.02;      ///< least time between two rows that count [s]
  static constexpr double FIRST_LOOK = 30.0;  ///< time of motion before the first fit of live rows [s]
  static constexpr double LAST_LOOK = 480.0;  ///< time of motion after which a fit of live rows begins anew [s]

  /// Values of a joint's drive that the fit needs.
  struct Drive
  {
    explicit Drive(const Parameters& parameters);
    /// `known`: whether the friction of this joint when it was sound is known. `friction`: this friction over the
    /// speed. Without points the expected friction is that of the twin.
    void setOwn(bool known, const std::vector<FrictionPoint>& friction);

    double gain;             ///< torque at the joint per current of the motor [N.m/A]
    double rotor;            ///< inertia of the rotor, seen from the joint [kg.m^2]
    double temperature;      ///< assumed temperature for samples without a measured temperature [degC]
    bool is_own{};           ///< whether the friction of this joint when it was sound is known
    double friction{ 1.0 };  ///< friction of the joint when it was sound, over the twin's friction [-]
  };

  LoadFit(const ArmDescription& arm, const std::vector<Drive>& drives);
  LoadFit(const ArmDescription& arm, const std::vector<Parameters>& joints)
    : LoadFit(arm, std::vector<Drive>(joints.begin(), joints.end()))
  {
  }

  /// A function that returns the twin of a joint by the joint's number.
  using TwinOf = std::function<const MotionDriven&(std::size_t joint)>;
  /// Adds the samples of all joints at one time. All twins must have made their step with these samples before.
  void add(const std::vector<MotionSample>& samples, const TwinOf& twin);

  /// Load of the arm by the joints for which `counts` is true. Only joints with a measured current can count.
  FoundLoad solve(const std::vector<bool>& counts);
  /// The likeliest estimate of all causes, by the joints for which `counts` is true.
  ArmEstimator::Estimate estimate(const std::vector<bool>& counts);

  /// How well the best causes explain the currents.
  struct Fit
  {
    double size{ 1.0 };  ///< common factor of all currents; 1 if it is within the scatter of one type [-]
    double left{ 1.0 };  ///< share of the currents that the causes do not explain, rms [-]
    double cost{};       ///< negative logarithm of a likelihood in which the models may have errors [-]
  };
  /// How well the arm explains the currents of joints for which `counts` is true, with the best payload and mounting.
  Fit explained(const std::vector<bool>& counts);
  /// The least Fit::cost that any arm can have: that of usual causes which explain all currents.
  static double leastCost();
  /// Whether row `number` is among the drawn rows, which are the `share` [-] of all rows. The drawn rows are spread
  /// evenly, also over a motion that repeats. The rows of a smaller share also belong to any larger share.
  static bool isDrawn(std::size_t number, double share);
  double moved() const { return moved_; }  ///< time in which at least one joint moved [s]

private:
  static constexpr double BLOCK = 0.1;  ///< time over which the fit averages samples to a row [s]

  struct Open
  {
    ArmEstimator::Row sum;
    std::size_t count{};
    double begin{};     // time of the first sample [s]
    double velocity{};  // velocity of the first sample [rad/s]
  };
  struct Joint
  {
    Drive drive;
    double loads{};    // sum of the squares of the joint's load in all samples [(N.m)^2]
    double weights{};  // sum of the squares of the load by 1 kg at the tip [(N.m/kg)^2]
    Open open{};
  };

  /// A combination of causes that may explain the currents.
  struct Hypothesis
  {
    ArmEstimator::Estimate found;
    ArmEstimator::Freedom may;
    double cost{};  ///< cost of the estimate, plus OTHER_CAUSE for each rare cause [-]
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
  std::vector<double> legs_;  // time at which each leg begins [s]
  std::vector<bool> pushed_;  // true: something pushes the arm in this leg, so the leg does not count; empty: no push
  double still_{};            // time for which all joints have stood still [s]
  double moved_{};            // time in which at least one joint moved [s]
  double last_time_{};
  double share_{ 1.0 };  // share of all blocks of length BLOCK that the fit keeps [-]
  std::vector<std::size_t> blocks_;
};
}  // namespace hjt
