// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "harmonic_joint_twin/twin/motion_smoother.hpp"

namespace hjt
{
/// Which joint of which recording.
struct MotionSource
{
  std::string path;                      ///< .bag or .csv
  std::string joint;                     ///< its name in the messages
  int csv_joint{};                       ///< its number in the columns of a CSV file
  std::string topic{ "/joint_states" };  ///< sensor_msgs/JointState, effort the motor current [A]
  std::string load_topic;                ///< sensor_msgs/JointState, effort the load [N.m]
};

/// What a reading found.
struct MotionCount
{
  std::uint64_t rows{};
  std::uint64_t corrupt{};  ///< messages that could not be read, or hold no finite angle and current of the joint
  double duration{};        ///< of the recording [s]
};

/// True if the recording gives the load; else it is zero in the rows. @throws InputError if the file cannot be read.
bool recordsLoad(const MotionSource& source);

/// Reads a recording row by row, in memory that does not grow with it beyond the bag's own index.
///
/// Bag: header stamps count, or the time of recording where they are zero; times start at the first row. A load counts for
/// rows from its stamp on. CSV: columns timestamp, actual_q_N, actual_current_N, target_moment_N, as `joint_twin import`.
/// `visit` returns false to stop. `progress`: 0 ... 1.
/// @throws InputError if the file, the topic or the joint is not there; it names those that are.
MotionCount readMotion(const MotionSource& source, const std::function<bool(const MotionRow&)>& visit,
                       const std::function<void(double)>& progress);
}  // namespace hjt
