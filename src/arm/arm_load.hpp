// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "arm/arm_dynamics.hpp"
#include "arm/payload_course.hpp"
#include "arm/row_times.hpp"
#include "arm/unit_loads.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// All joints of an arm at the time of one row.
struct ArmSample
{
  std::vector<MotionSample> joints;  ///< rates within ArmRates::HALF_WIDTH, for the load
  /// The same with a joint's own rates, within MotionDifferentiator::HALF_WIDTH, stamp errors and vibration.
  std::vector<MotionSample> own;
  /// Of the links and the payload at the output of each joint, the motor's own inertia not in it, > 0 resists positive
  /// motion [N.m].
  std::vector<double> torques;
};

/// Rates of all joints of an arm from a stream of their angles, rows of one time each: what is the same of every arm.
///
/// They are the slopes of parabolas through the angles within HALF_WIDTH of a row, so they need no recorded velocity
/// and have no phase, and a row comes out at most HALF_WIDTH late. Velocities mend the rows' times (RowTimes): for load
/// and vibration if they are recorded, else, from the slow rates, for the vibration alone, and a row comes out later by
/// MotionDifferentiator::HALF_WIDTH. Live and offline alike. After construction nothing throws; nothing allocates.
class ArmRates
{
public:
  /// Wider than that of a joint's own rates: the load is that of the commanded motion, without vibration [s].
  static constexpr double HALF_WIDTH = 0.1;

  explicit ArmRates(std::size_t joints);

  /// Starts a new stream.
  void reset() noexcept;

  /// One row for each joint, all of one time. False: the row is not later than the one before, or one that no joint can
  /// have, and is left out.
  bool push(const std::vector<MotionRow>& rows) noexcept;

  /// The next sample that is ready, without its torques and vibration; none: nullptr. Valid until the next call. With
  /// `at_end` also those that wait for later rows.
  ArmSample* pop(bool at_end = false) noexcept;

private:
  /// Rows that wait for their fast rates, at most.
  static constexpr std::size_t ROOM = 256;

  static bool take(std::vector<MotionDifferentiator>& from, bool at_end, std::vector<MotionSample>& samples) noexcept;
  void pushFast() noexcept;

  RowTimes times_;
  // One a joint, all with rows of the same times, for load and vibration.
  std::vector<MotionDifferentiator> slow_;
  std::vector<MotionDifferentiator> fast_;
  std::vector<ArmSample> waiting_;  // with slow rates, from first_waiting_ to end_waiting_, round and round
  std::uint64_t first_waiting_{};
  std::uint64_t end_waiting_{};
  std::vector<MotionRow> rows_;
  bool has_velocities_{};  // of the first row
  double last_time_{ -std::numeric_limits<double>::infinity() };
};

/// Torques at the joints of an arm in the motion of a sample. What the faster rates, within a joint's own half width,
/// take beyond the load is the torque of the arm's vibration: mostly the answer to the drives' ripple. After
/// construction nothing throws; nothing allocates.
class LinkTorques
{
public:
  /// @throws ParameterError as ArmDynamics.
  explicit LinkTorques(const ArmDescription& arm, PayloadCourse course = {});

  /// `sample` with its torques and vibration.
  void addTo(ArmSample& sample) noexcept;

  std::size_t joints() const noexcept { return motion_.size(); }

private:
  static constexpr std::size_t NONE = static_cast<std::size_t>(-1);

  void find(const std::vector<MotionSample>& samples, std::vector<double>& torques) noexcept;
  void carry(double time) noexcept;

  UnitLoads links_;
  const PayloadCourse course_;
  std::size_t carried_{ NONE };  // of the course
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
