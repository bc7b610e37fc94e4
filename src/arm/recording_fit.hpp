// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "arm/arm_load.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/current_lag.hpp"
#include "tracking/reason.hpp"
#include "tracking/telemetry_fit.hpp"

namespace hjt
{
/// Largest time between rows that still show accelerations: the period of rows at 20 Hz, plus jitter [s].
constexpr double SLOW_ROWS = 0.06;

/// Factor that converts stamps in ms, us or ns to seconds [-]; 1: the stamps are probably in seconds. `period`: time
/// from row to row if the stamps are in seconds [s].
double likelyTimeScale(double period);

const char* effortUnitName(EffortUnit unit);  ///< name of the unit in messages, for example "the motor's current in A"
const char* effortKeyword(EffortUnit unit);   ///< keyword of the unit in the configuration

/// A contradiction in a recording of an arm, or a fact that limits what the recording shows.
struct RecordingFinding
{
  /// Name in JSON files: reading, period, stamps, ratio, angle_unit, effort_unit, gain, current_lag, effort_constant,
  /// velocity_zero, velocity_sign, velocity_unit, velocity_scale, lag, no_velocity or at_rest.
  std::string kind;
  std::string text;             ///< the finding as a clause without a full stop
  std::optional<Reason> stops;  ///< reason of the missing verdict; none: the finding prevents no verdict
};

/// Ranges of angle, speed and current of a joint in a recording; empty before the first row.
struct JointReach
{
  std::uint64_t rows{};
  double least_angle{ std::numeric_limits<double>::infinity() };    ///< least angle [rad]
  double most_angle{ -std::numeric_limits<double>::infinity() };    ///< largest angle [rad]
  double least_speed{};                                             ///< least speed; 0: no negative motion [rad/s]
  double most_speed{};                                              ///< largest speed; 0: no positive motion [rad/s]
  double least_current{ std::numeric_limits<double>::infinity() };  ///< least current, computed from the effort [A]
  double most_current{ -std::numeric_limits<double>::infinity() };  ///< largest current, computed from the effort [A]
};

/// How the currents of an arm change with its load.
struct EffortFit
{
  FittedFactor factor;  ///< measured current over the current that the load takes; NaN: too little load [-]
  EffortUnit unit{};    ///< unit of the efforts that the recording shows, otherwise the configured unit
  bool is_known{};      ///< whether the factor agrees with efforts in `unit`
};

/// Checks whether the rows of an arm fit together: angles with velocities and stamps, and currents with the load.
///
/// The rows are live or from a recording. The findings are about the last minutes of motion. update() neither throws
/// nor allocates.
class RecordingFit
{
public:
  static constexpr double PATIENCE = 30.0;  ///< time of motion after which the findings are final [s]

  /// `joints`: parameters of the arm's joints, from which the class computes currents from efforts.
  explicit RecordingFit(const std::vector<Parameters>& joints);

  void reset() noexcept;
  /// Adds one row. `joints`: sample of each joint. `torques`: load of each joint; NaN: not known [N.m].
  void update(const std::vector<MotionSample>& joints, const std::vector<double>& torques) noexcept;

  /// Factor on the times between stamps with which the stamps fit the velocities of most joints [-]; NaN: not known.
  FittedFactor stampFactor() const;
  EffortFit effort() const;
  const JointReach& reach(std::size_t joint) const { return joints_[joint].reach; }
  std::vector<bool> measured() const;  ///< whether the currents of each joint are measured, so that they vary
  bool hasVelocity(std::size_t joint) const { return joints_[joint].time.hasVelocity(); }
  /// Fit of the joint's angle and velocity.
  const TimeFit& timeFit(std::size_t joint) const { return joints_[joint].time; }

  /// Sets a misfit that prevents the verdict of each joint. An empty misfit removes the one that was set.
  void refuse(const Misfit& misfit) { refusal_ = misfit; }

  /// Root mean squares of the currents of the moving joints; NaN: no joint moved.
  struct LoadRest
  {
    double current{};  ///< current - fitted constant, friction and inertia of the rotor [A]
    double left{};     ///< `current` - current that the load takes [A]

    /// Share of `current` that the load does not explain [-]; not finite: no joint moved.
    double share() const { return left / current; }
  };
  /// LoadRest of the currents that the program computes from the efforts if their unit is `unit`.
  LoadRest loadRest(EffortUnit unit) const;

  std::vector<RecordingFinding> ofArm() const;
  std::vector<RecordingFinding> ofJoint(std::size_t joint) const;

  /// Whether the findings are final: stampFactor() and effort() are known, or the joints have moved for PATIENCE.
  bool isSettled() const;

  /// Misfit of each joint: the first finding on the arm or on the joint that prevents the joint's verdict.
  std::vector<Misfit> whyNotJudged() const;

private:
  bool isMeasured(std::size_t joint) const;
  std::optional<RecordingFinding> ofTimes() const;
  std::optional<RecordingFinding> ofCurrents() const;

  struct Joint
  {
    double gain{};  // torque at the joint per current of the motor [N.m/A]
    EffortUnit effort{};
    std::vector<double> current_per_effort;  // current for an effort of 1 in each unit [A]
    TimeFit time;
    RatioFit ratio;
    CurrentLag lag;
    JointReach reach;
    std::uint64_t moving_rows{};
    std::uint64_t fast_rows{};  // number of rows with a speed that no joint has
    double last_current{};      // current of the last row [A]
    double unchanged{};         // time of motion since the last change of the current [s]
  };

  std::vector<FittedFactor> timeFactors() const;

  Misfit refusal_;
  std::vector<Joint> joints_;
  double last_time_{ std::numeric_limits<double>::quiet_NaN() };
  double moving_{};     // time in which at least one joint moved [s]
  double slow_time_{};  // sum of the times between rows that exceed SLOW_ROWS [s]
  std::uint64_t slow_rows_{};
  std::uint64_t rows_{};
};
}  // namespace hjt
