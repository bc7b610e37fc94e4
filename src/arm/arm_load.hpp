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
/// If the recorder stamped the rows evenly but took them unevenly, or lost a row, e differs from d. Differences below
/// SIGNIFICANT are noise, and the class ignores them. The class uses a joint only while the velocities times the
/// stamped time agree with the changes of angle within the share AGREES, in the mean of the last seconds. So it does
/// not use a joint whose velocity has the wrong sign or unit. Only the differences between the errors of rows are
/// known, up to the next gap. Nothing allocates or throws after construction.
class RowTimes
{
public:
  static constexpr double ANGLE = 1e-4;  ///< standard deviation of an angle's change from its velocity's integral [rad]
  static constexpr double STAMP = 4e-3;  ///< standard deviation of a stamp's interval [s]
  static constexpr double SIGNIFICANT = 0.35;  ///< least error, as a share of the interval by the stamps [-]
  static constexpr double AGREES = 0.1;        ///< share by which velocities and angles may differ [-]

  explicit RowTimes(std::size_t joints) : last_(joints), agreements_(joints) {}

  /// Returns how late the stamp of these rows is [s]. There is one row of each joint, later than the rows before.
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
  /// Sums of v dq and of v v d of one joint, which are forgotten over MEMORY. Both sums begin in agreement.
  struct Agreement
  {
    double change{ START };
    double expected{ START };
  };
  static constexpr double MEMORY = 10.0;  // time constant of the forgetting [s]
  static constexpr double START = 0.25;   // value of both sums after 1 s at 0.5 rad/s [rad^2/s]

  /// Time between the last rows and these, by the motion where the motion is surer than the stamps [s].
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
    constexpr double MOST = 4.0;  // a damaged angle
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
  std::vector<MotionSample> joints;  ///< samples with rates within ArmRates::HALF_WIDTH, for the load
  /// Samples with a joint's own rates, within MotionDifferentiator::HALF_WIDTH, with stamp errors and vibration.
  std::vector<MotionSample> own;
  /// Torque of links and payload at the output of each joint, without the motor's own inertia. A positive torque
  /// resists positive motion [N.m].
  std::vector<double> torques;
};

/// Rates of all joints of an arm from a stream of rows of their angles. The rates do not depend on the type of the arm.
///
/// They are the slopes of parabolas through the angles within HALF_WIDTH of a row, so they need no recorded velocity
/// and have no phase, and a row comes out at most HALF_WIDTH late. Velocities mend the rows' times (RowTimes): for load
/// and vibration if they are recorded, else, from the slow rates, for the vibration alone, and a row comes out later by
/// MotionDifferentiator::HALF_WIDTH. Live and offline alike. After construction nothing throws; nothing allocates.
class ArmRates
{
public:
  /// Half width of the rates for the load. It is wider than that of a joint's own rates, because the load is that of
  /// the commanded motion without vibration [s].
  static constexpr double HALF_WIDTH = 0.1;

  explicit ArmRates(std::size_t joints);

  /// Starts a new stream.
  void reset() noexcept;

  /// Takes one row for each joint, all of one time. Ignores rows that are not later than the rows before, or that no
  /// joint can have, and then returns false.
  bool push(const std::vector<MotionRow>& rows) noexcept;

  /// The next sample that is ready, without torques and vibration, or nullptr. It is valid until the next call. With
  /// `at_end` also samples are ready that wait for later rows.
  ArmSample* pop(bool at_end = false) noexcept;

private:
  /// Rows that wait for their fast rates, at most.
  static constexpr std::size_t ROOM = 256;

  static bool take(std::vector<MotionDifferentiator>& from, bool at_end, std::vector<MotionSample>& samples) noexcept;
  void pushFast() noexcept;

  RowTimes times_;
  // Differentiators of each joint, for load (slow) and vibration (fast); all have rows of the same times.
  std::vector<MotionDifferentiator> slow_;
  std::vector<MotionDifferentiator> fast_;
  std::vector<ArmSample> waiting_;  // ring of samples with slow rates, from first_waiting_ to end_waiting_
  std::uint64_t first_waiting_{};
  std::uint64_t end_waiting_{};
  std::vector<MotionRow> rows_;
  bool has_velocities_{};  // the first row has velocities of all joints
  double last_time_{ -std::numeric_limits<double>::infinity() };
};

/// Torques at the joints of an arm in the motion of a sample. The rates within a joint's own half width take more
/// torque than the load: the difference is the torque of the arm's vibration, mostly its answer to the drives' ripple.
/// After construction nothing throws or allocates.
class LinkTorques
{
public:
  /// @throws ParameterError as ArmDynamics.
  explicit LinkTorques(const ArmDescription& arm, PayloadCourse course = {});

  /// Adds torques and vibration to `sample`.
  void addTo(ArmSample& sample) noexcept;

  std::size_t joints() const noexcept { return motion_.size(); }

private:
  static constexpr std::size_t NONE = static_cast<std::size_t>(-1);

  void find(const std::vector<MotionSample>& samples, std::vector<double>& torques) noexcept;
  void carry(double time) noexcept;

  UnitLoads links_;
  const PayloadCourse course_;
  std::size_t carried_{ NONE };  // place of the present payload in the course
  std::vector<JointMotion> motion_;
  std::vector<double> fast_torques_;
};

/// Load of each joint of an arm from a stream of the angles of all, by ArmRates.
class ArmLoad
{
public:
  /// @throws ParameterError as ArmDynamics.
  explicit ArmLoad(const ArmDescription& arm, PayloadCourse course = {})
    : torques_(arm, std::move(course)), rates_(torques_.joints())
  {
  }

  void reset() noexcept { rates_.reset(); }                                             ///< as ArmRates
  bool push(const std::vector<MotionRow>& rows) noexcept { return rates_.push(rows); }  ///< as ArmRates

  /// As ArmRates, with torques and vibration.
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
