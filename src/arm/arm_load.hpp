// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "arm/arm_description.hpp"
#include "arm/arm_dynamics.hpp"
#include "arm/unit_loads.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Estimates the errors of the stamps of an arm's rows, from the recorded angles and velocities.
///
/// The estimate e of the time between two rows is a least-squares fit over all joints: the mean velocities v times e
/// should give the changes of angle dq. The interval d of the stamps is one more observation:
///   e = (v.dq / ANGLE^2 + d / STAMP^2) / (v.v / ANGLE^2 + 1 / STAMP^2)
/// If a recorder gave rows even stamps but took the rows at uneven times, or lost a row, e differs from d. Differences
/// below SIGNIFICANT are noise, and the class ignores them. The class uses a joint only while the velocities times the
/// stamped time agree with the changes of angle within the share AGREES, in the mean of the last seconds. So the class
/// does not use a joint whose velocity has the wrong sign or unit. The errors of the rows after a gap have an unknown
/// constant in common. Nothing allocates or throws after construction.
class RowTimes
{
public:
  static constexpr double ANGLE = 1e-4;  ///< standard deviation: change of an angle - integral of its velocity [rad]
  static constexpr double STAMP = 4e-3;  ///< standard deviation of a stamp's interval [s]
  static constexpr double SIGNIFICANT = 0.35;  ///< least error that counts, as a share of the stamps' interval [-]
  static constexpr double AGREES = 0.1;  ///< largest share by which velocities and changes of angle may differ [-]

  explicit RowTimes(std::size_t joints) : last_(joints), agreements_(joints) {}

  /// Returns the error of the stamp of `rows`: stamp - estimated time [s]. `rows`: later rows than in the last call,
  /// one for each joint.
  double stampError(const std::vector<MotionRow>& rows) noexcept
  {
    const double step = started_ ? rows.front().time - last_.front().time : HUGE_VAL;
    error_ = step > MotionDifferentiator::MAX_GAP ? 0.0 : error_ + step - interval(rows);
    std::copy(rows.begin(), rows.end(), last_.begin());
    started_ = true;
    return error_;
  }

  void reset() noexcept
  {
    std::fill(agreements_.begin(), agreements_.end(), Agreement{});
    started_ = false;
    error_ = 0.0;
  }

private:
  /// Sums over the rows of one joint: velocity x change of angle, and velocity^2 x interval of the stamps [rad^2/s].
  /// The sums forget old rows over the time MEMORY. Both begin at START.
  struct Agreement
  {
    double change{ START };
    double expected{ START };
  };
  static constexpr double MEMORY = 10.0;  // time constant with which the sums forget old rows [s]
  static constexpr double START = 0.25;   // first value of both sums, as after 1 s at 0.5 rad/s [rad^2/s]

  /// Time from the rows of the last call to `rows` [s]: the estimate from the motion if it differs from the interval of
  /// the stamps by more than SIGNIFICANT, otherwise the interval of the stamps.
  double interval(const std::vector<MotionRow>& rows) noexcept
  {
    const double by_stamps = rows.front().time - last_.front().time;
    double weight = 1.0 / (STAMP * STAMP);
    double weighted = by_stamps * weight;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const double velocity = 0.5 * (rows[i].recorded_velocity + last_[i].recorded_velocity);
      if (!std::isfinite(velocity))
      {
        continue;
      }
      const double change = rows[i].position - last_[i].position;
      Agreement& agreement = agreements_[i];
      const double kept = 1.0 - by_stamps / MEMORY;
      agreement.change = kept * agreement.change + velocity * change;
      agreement.expected = kept * agreement.expected + velocity * velocity * by_stamps;
      if (std::abs(agreement.change - agreement.expected) <= AGREES * agreement.expected)
      {
        weight += velocity * velocity / (ANGLE * ANGLE);
        weighted += velocity * change / (ANGLE * ANGLE);
      }
    }
    const double by_motion = weighted / weight;
    const double difference = std::abs(by_motion - by_stamps);
    constexpr double MOST = 4.0;  // largest ratio of time by motion to time by stamps without damaged angles [-]
    const bool is_usable = by_motion > by_stamps / MOST && by_motion < by_stamps * MOST;
    return is_usable && difference > SIGNIFICANT * by_stamps ? by_motion : by_stamps;
  }

  std::vector<MotionRow> last_;
  std::vector<Agreement> agreements_;
  bool started_{};
  double error_{};
};

/// All joints of an arm at the time of one row.
struct ArmSample
{
  std::vector<MotionSample> joints;  ///< samples whose rates use the rows within ArmRates::HALF_WIDTH, for the load
  /// Samples whose rates use the rows within MotionDifferentiator::HALF_WIDTH, with stamp errors and vibration.
  std::vector<MotionSample> own;
  /// Load of each joint by links and payload, without the motor's inertia; > 0 resists positive motion [N.m].
  std::vector<double> torques;
};

/// Speeds and accelerations of all joints of an arm from a stream of rows of their angles, for any type of arm.
///
/// The rates are slopes of parabolas through the angles within HALF_WIDTH of a row. So the rates need no recorded
/// velocity and have no phase lag. A sample is ready at most HALF_WIDTH after its row. Recorded velocities correct the
/// times of the rows (RowTimes) for load and vibration. Without recorded velocities, the rates for the load correct the
/// times for the vibration alone, and a sample is ready later by MotionDifferentiator::HALF_WIDTH. Rates of a live
/// stream and of a recording are equal. After construction nothing throws or allocates.
class ArmRates
{
public:
  /// Half width of the rates for the load [s]. It is wider than MotionDifferentiator::HALF_WIDTH, because the load is
  /// that of the commanded motion without vibration.
  static constexpr double HALF_WIDTH = 0.1;

  explicit ArmRates(std::size_t joints);

  void reset() noexcept;  ///< forgets all rows, because those of another stream follow

  /// Takes one row of each joint, all of one time. Returns false and ignores the rows if they are not later than the
  /// last rows that were taken, or if a value is impossible.
  bool push(const std::vector<MotionRow>& rows) noexcept;

  /// The next sample that is ready, without torques and vibration; nullptr if none is ready. The pointer is valid until
  /// the next call. With `at_end` the function also returns samples that wait for later rows.
  ArmSample* pop(bool at_end = false) noexcept;

private:
  static constexpr std::size_t ROOM = 256;  // largest number of rows that wait for their rates for the vibration

  static bool take(std::vector<MotionDifferentiator>& from, bool at_end, std::vector<MotionSample>& samples) noexcept;
  void pushFast() noexcept;

  RowTimes times_;
  // Differentiators of each joint: slow_ for the load, fast_ for the vibration. Both get rows of the same times.
  std::vector<MotionDifferentiator> slow_;
  std::vector<MotionDifferentiator> fast_;
  std::vector<ArmSample> waiting_;  // ring buffer of samples with slow rates, from first_waiting_ to end_waiting_
  std::uint64_t first_waiting_{};
  std::uint64_t end_waiting_{};
  std::vector<MotionRow> rows_;
  bool has_velocities_{};  // whether the first rows of the stream have velocities of all joints
  double last_time_{ -std::numeric_limits<double>::infinity() };
};

/// Torques that an arm needs at its joints in the motion of a sample. ArmSample::own contains the vibration of the arm,
/// mostly its response to the drives' ripple. The torque for `own` minus that for `joints` is the torque of the
/// vibration. After construction nothing throws or allocates.
class LinkTorques
{
public:
  /// @throws ParameterError for the reasons that ArmDynamics names.
  explicit LinkTorques(const ArmDescription& arm, PayloadCourse course = {});

  void addTo(ArmSample& sample) noexcept;  ///< sets `sample.torques` and the vibrations in `sample.own`

  std::size_t joints() const noexcept { return motion_.size(); }

private:
  static constexpr std::size_t NONE = static_cast<std::size_t>(-1);

  void find(const std::vector<MotionSample>& samples, std::vector<double>& torques) noexcept;
  void carry(double time) noexcept;

  UnitLoads links_;
  const PayloadCourse course_;
  std::size_t carried_{ NONE };  // index in course_ of the payload that the arm carries now
  std::vector<JointMotion> motion_;
  std::vector<double> fast_torques_;
};

/// Load of each joint of an arm, from a stream of the angles of all joints (ArmRates).
class ArmLoad
{
public:
  /// @throws ParameterError for the reasons that ArmDynamics names.
  explicit ArmLoad(const ArmDescription& arm, PayloadCourse course = {})
    : torques_(arm, std::move(course)), rates_(torques_.joints())
  {
  }

  void reset() noexcept { rates_.reset(); }                                             ///< as ArmRates
  bool push(const std::vector<MotionRow>& rows) noexcept { return rates_.push(rows); }  ///< as ArmRates

  /// As ArmRates::pop(), but with torques and vibration.
  const ArmSample* pop(bool at_end = false) noexcept
  {
    ArmSample* sample = rates_.pop(at_end);
    if (sample != nullptr)
    {
      torques_.addTo(*sample);
    }
    return sample;
  }

private:
  LinkTorques torques_;
  ArmRates rates_;
};
}  // namespace hjt
