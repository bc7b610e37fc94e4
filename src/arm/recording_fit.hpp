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
/// Largest time between rows that show accelerations: that of 20 Hz, with jitter [s].
constexpr double SLOW_ROWS = 0.06;

/// Factor that makes seconds of stamps in ms, us or ns. The unit is recognised by the time between rows, `period`, as
/// it looks in seconds. 1: the stamps are in seconds.
double likelyTimeScale(double period);

/// Name of the unit for people, as "the motor's current in A".
const char* effortUnitName(EffortUnit unit);
/// Keyword of the unit in the configuration.
const char* effortKeyword(EffortUnit unit);

/// A contradiction in a recording of an arm.
struct RecordingFinding
{
  std::string kind;  ///< for documents: reading, period, stamps, ratio, angle_unit, effort_unit, gain, current_lag,
                     ///< effort_constant, velocity_zero, velocity_sign, velocity_unit, velocity_scale, lag,
                     ///< no_velocity, at_rest
  std::string text;  ///< a clause without a full stop
  std::optional<Reason> stops;  ///< reason why nothing can be judged; none if the finding does not prevent it
};

/// Ranges of a joint in a recording; empty before the first row.
struct JointReach
{
  std::uint64_t rows{};
  double least_angle{ std::numeric_limits<double>::infinity() };    ///< least angle [rad]
  double most_angle{ -std::numeric_limits<double>::infinity() };    ///< [rad]
  double least_speed{};                                             ///< least speed; 0 without negative motion [rad/s]
  double most_speed{};                                              ///< [rad/s]
  double least_current{ std::numeric_limits<double>::infinity() };  ///< least current by the effort [A]
  double most_current{ -std::numeric_limits<double>::infinity() };  ///< [A]
};

/// How the currents of an arm change with its load.
struct EffortFit
{
  FittedFactor factor;  ///< current per load, over that of telemetry.torque_per_current; NaN with too little load
  EffortUnit unit{};    ///< unit that the recording shows, or the configured unit
  bool is_known{};      ///< whether the factor is that of a unit
};

/// Checks whether the rows of an arm fit together: angles with velocities and stamps, and currents with the load.
///
/// The rows of all joints come live or from a recording. The findings are of the last minutes of motion. `update`
/// neither throws nor allocates.
class RecordingFit
{
public:
  static constexpr double PATIENCE = 30.0;  ///< motion after which the findings are final [s]

  /// `joints`: parameters of the arm's joints, by which the currents of the samples follow from the efforts.
  explicit RecordingFit(const std::vector<Parameters>& joints);

  void reset() noexcept;
  /// `torques`: loads of the joints, NaN where a load is not known [N.m].
  void update(const std::vector<MotionSample>& joints, const std::vector<double>& torques) noexcept;

  /// Factor by which the stamps must be stretched to fit the velocities of most joints; NaN if it is not known.
  FittedFactor stampFactor() const;
  EffortFit effort() const;
  const JointReach& reach(std::size_t joint) const { return joints_[joint].reach; }
  std::vector<bool> measured() const;  ///< whether the current of each joint changes, as a measured current does
  bool hasVelocity(std::size_t joint) const { return joints_[joint].time.hasVelocity(); }
  /// Fit of the joint's angle and velocity.
  const TimeFit& timeFit(std::size_t joint) const { return joints_[joint].time; }

  /// Sets a misfit with which no joint can be judged, or none.
  void refuse(const Misfit& misfit) { refusal_ = misfit; }

  /// Currents of the moving joints, rms; NaN if nothing moved.
  struct LoadRest
  {
    double current{};  ///< current less fitted constant, friction and rotor inertia [A]
    double left{};     ///< `current` less the current of the load [A]

    /// Share of the current that the load leaves; not finite without motion [-].
    double share() const { return left / current; }
  };
  /// The currents if the efforts were of this unit.
  LoadRest loadRest(EffortUnit unit) const;

  std::vector<RecordingFinding> ofArm() const;
  std::vector<RecordingFinding> ofJoint(std::size_t joint) const;

  /// Whether the rows suffice for the findings, or PATIENCE of motion has passed.
  bool isSettled() const;

  /// The misfit of each joint: the first finding of the arm or the joint with which nothing can be judged.
  std::vector<Misfit> whyNotJudged() const;

private:
  bool isMeasured(std::size_t joint) const;
  std::optional<RecordingFinding> ofTimes() const;
  std::optional<RecordingFinding> ofCurrents() const;

  struct Joint
  {
    double gain{};  // torque per current [N.m/A]
    EffortUnit effort{};
    std::vector<double> current_per_effort;  // current per effort of each unit [A], [A/(N.m)]
    TimeFit time;
    RatioFit ratio;
    CurrentLag lag;
    JointReach reach;
    std::uint64_t moving_rows{};
    std::uint64_t fast_rows{};  // rows with a speed that no joint has
    double last_current{};      // [A]
    double unchanged{};         // motion since the current changed [s]
  };

  std::vector<FittedFactor> timeFactors() const;

  Misfit refusal_;
  std::vector<Joint> joints_;
  double last_time_{ std::numeric_limits<double>::quiet_NaN() };
  double moving_{};     // time in which a joint moved [s]
  double slow_time_{};  // sum of the steps that are longer than SLOW_ROWS [s]
  std::uint64_t slow_rows_{};
  std::uint64_t rows_{};
};
}  // namespace hjt
