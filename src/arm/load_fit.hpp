// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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
/// Payload, mounting and drag of an arm from the currents of all joints while they move (ArmEstimator). A row of the
/// fit is the mean over 0.1 s of one joint that moves one way with all its friction; of long recordings as many rows
/// are kept as say what is said at all, evenly over the time. Between legs, from one standstill to the next or of 5 s,
/// the payload may change. The interval of a mass holds the fit's and 2 % of the links' own masses.
class LoadFit
{
public:
  static constexpr double PERIOD = 0.02;      ///< of the rows that count, at least [s]
  static constexpr double FIRST_LOOK = 30.0;  ///< at rows that still come, of motion [s]
  static constexpr double LAST_LOOK = 480.0;  ///< likewise: then all begins again [s]

  /// What it knows of a joint's drive.
  struct Drive
  {
    explicit Drive(const Parameters& parameters);
    /// `known`: what is expected of its friction is that of this joint when it was sound, `friction` by speed; none:
    /// as the twin's.
    void setOwn(bool known, const std::vector<FrictionPoint>& friction);

    double gain;             ///< [N.m/A]
    double rotor;            ///< inertia at the joint [kg.m^2]
    double temperature;      ///< of samples without one [degC]
    bool is_own{};           ///< the friction of this joint when it was sound is known
    double friction{ 1.0 };  ///< the known one over the twin's [-]
  };

  /// @param drives from the base on
  LoadFit(const ArmDescription& arm, const std::vector<Drive>& drives);
  LoadFit(const ArmDescription& arm, const std::vector<Parameters>& joints)
    : LoadFit(arm, std::vector<Drive>(joints.begin(), joints.end()))
  {
  }

  /// Samples of one time, and the twins, which made the step to it.
  void add(const std::vector<MotionSample>& samples, const std::vector<const MotionDriven*>& twins);

  /// `counts`: whether the current of a joint, by its number, is measured: else it is left out.
  FoundLoad solve(const std::vector<bool>& counts);
  /// All that it rests on.
  ArmEstimator::Estimate estimate(const std::vector<bool>& counts);

  /// Of the currents, what is left with the best of all terms, and how much these take.
  struct Fit
  {
    double size{ 1.0 };  ///< of all currents, where it is another than gains of a type make [-]
    double left{ 1.0 };  ///< share, rms [-]
    double cost{};       ///< logarithm of a likelihood, less is likelier; errors of models count for what they are [-]
  };
  /// How well the arm explains the currents of the joints that count, with its best payload, or the best mounting too.
  Fit explained(const std::vector<bool>& counts);
  /// The least cost of any arm: of one that explains all with no cause that is rare.
  static double leastCost();
  /// Of numbered rows the same share of all their parts, those of a motion that repeats too; those of a smaller share
  /// are among those of a larger one.
  static bool isDrawn(std::size_t number, double share);
  double moved() const { return moved_; }  ///< time in which a joint moved [s]

private:
  static constexpr double BLOCK = 0.1;  ///< that a row is the mean of [s]

  struct Open
  {
    ArmEstimator::Row sum;
    std::size_t count{};
    double begin{};     // [s]
    double velocity{};  // [rad/s]
  };
  struct Joint
  {
    Drive drive;
    double loads{};    // sum of squares [(N.m)^2]
    double weights{};  // of 1 kg at the tip, likewise
    Open open{};
  };

  /// What may explain the currents.
  struct Hypothesis
  {
    ArmEstimator::Estimate found;
    ArmEstimator::Freedom may;
    double cost{};  ///< with those of its causes
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
  std::vector<double> legs_;  // begin of each [s]
  std::vector<bool> pushed_;  // legs that do not count; empty: none
  double still_{};            // for how long [s]
  double moved_{};            // [s]
  double last_time_{};
  double share_{ 1.0 };  // of the blocks that are kept
  std::vector<std::size_t> blocks_;
};
}  // namespace hjt
