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
/// Rows further apart tell no acceleration: 20 Hz at least, with jitter [s].
constexpr double SLOW_ROWS = 0.06;

/// By which stamps are multiplied that are in ms, us or ns, where rows so far apart [s] mean one of these; 1: they do
/// not.
double likelyTimeScale(double period);

/// For people: "the motor's current in A".
const char* effortUnitName(EffortUnit unit);
/// In configuration.
const char* effortKeyword(EffortUnit unit);

/// Something in a recording of an arm that does not fit.
struct RecordingFinding
{
  std::string kind;  ///< for documents: reading, period, stamps, ratio, angle_unit, effort_unit, gain, current_lag,
                     ///< effort_constant, velocity_zero, velocity_sign, velocity_unit, velocity_scale, lag,
                     ///< no_velocity, at_rest
  std::string text;  ///< a clause without a full stop
  std::optional<Reason> stops;  ///< nothing can be judged with it
};

/// Ranges of a joint in a recording; empty before the first row.
struct JointReach
{
  std::uint64_t rows{};
  double least_angle{ std::numeric_limits<double>::infinity() };    ///< [rad]
  double most_angle{ -std::numeric_limits<double>::infinity() };    ///< [rad]
  double least_speed{};                                             ///< 0: never moves in negative direction [rad/s]
  double most_speed{};                                              ///< [rad/s]
  double least_current{ std::numeric_limits<double>::infinity() };  ///< of the effort [A]
  double most_current{ -std::numeric_limits<double>::infinity() };  ///< [A]
};

/// How much of the load is found in the currents of an arm.
struct EffortFit
{
  FittedFactor factor;  ///< current per load, over that of telemetry.torque_per_current; NaN: too little load to tell
  EffortUnit unit{};    ///< that the recording shows; as configured where it does not show another
  bool is_known{};      ///< the factor is that of a unit
};

/// Does a recording of an arm fit together: angles, velocities and stamps; currents and the load of the arm?
///
/// Fed with the rows of all joints, live or offline. What it knows is of the last minutes of motion. `update` neither
/// throws nor allocates.
class RecordingFit
{
public:
  static constexpr double PATIENCE = 30.0;  ///< [s]

  /// @param joints of the arm; the currents in the samples follow from their efforts as these are configured.
  explicit RecordingFit(const std::vector<Parameters>& joints);

  void reset() noexcept;
  /// `torques`: NaN where the load is not known.
  void update(const std::vector<MotionSample>& joints, const std::vector<double>& torques) noexcept;

  /// By how much the stamps must be stretched to fit the velocities of most joints; NaN: not known.
  FittedFactor stampFactor() const;
  EffortFit effort() const;
  const JointReach& reach(std::size_t joint) const { return joints_[joint].reach; }
  std::vector<bool> measured() const;  ///< of each joint: its current changes, as a measured one does
  bool hasVelocity(std::size_t joint) const { return joints_[joint].time.hasVelocity(); }
  /// Of angle and velocity of the joint.
  const TimeFit& timeFit(std::size_t joint) const { return joints_[joint].time; }

  /// Nothing can be judged of any joint; none: nothing stands against it.
  void refuse(const Misfit& misfit) { refusal_ = misfit; }

  /// Of the moving joints, rms; NaN: nothing moved.
  struct LoadRest
  {
    double current{};  ///< current less constant, friction and rotor inertia, fitted [A]
    double left{};     ///< and the load as it is too [A]

    double share() const { return left / current; }  ///< of the current that the load leaves; not finite: no motion [-]
  };
  /// If the efforts were of this unit.
  LoadRest loadRest(EffortUnit unit) const;

  std::vector<RecordingFinding> ofArm() const;
  std::vector<RecordingFinding> ofJoint(std::size_t joint) const;

  /// Whether the rows suffice for its findings, or PATIENCE of motion has passed without any.
  bool isSettled() const;

  /// For each joint the first finding of arm or joint with which nothing can be judged.
  std::vector<Misfit> whyNotJudged() const;

private:
  bool isMeasured(std::size_t joint) const;
  std::optional<RecordingFinding> ofTimes() const;
  std::optional<RecordingFinding> ofCurrents() const;

  struct Joint
  {
    double gain{};  // [N.m/A]
    EffortUnit effort{};
    std::vector<double> current_per_effort;  // by unit [A], [A/(N.m)]
    TimeFit time;
    RatioFit ratio;
    CurrentLag lag;
    JointReach reach;
    std::uint64_t moving_rows{};
    std::uint64_t fast_rows{};  // faster than any joint
    double last_current{};      // [A]
    double unchanged{};         // motion since it changed [s]
  };

  std::vector<FittedFactor> timeFactors() const;

  Misfit refusal_;
  std::vector<Joint> joints_;
  double last_time_{ std::numeric_limits<double>::quiet_NaN() };
  double moving_{};     // time in which a joint moved [s]
  double slow_time_{};  // between rows too far from each other [s]
  std::uint64_t slow_rows_{};
  std::uint64_t rows_{};
};
}  // namespace hjt
