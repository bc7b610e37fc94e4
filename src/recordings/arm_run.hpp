// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "arm/arm_motion.hpp"
#include "arm/arm_recorder.hpp"
#include "base/range.hpp"
#include "base/statistics.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "output/progress.hpp"
#include "output/report.hpp"
#include "twin/options.hpp"

namespace hjt
{
inline constexpr Range ROW_RATE{ 1e-6, 1e6 };  ///< allowed rates of an arm's rows [Hz]

/// Options of a motion that the twin of a whole arm makes. A fault is written JOINT:KIND:SEVERITY[:PLACE[:ONSET]].
struct ArmRunOptions : ConfigurationOptions
{
  std::string motion;                   ///< file of set points, as readSetPoints reads it
  std::vector<ArmSetPoint> set_points;  ///< set points in memory; empty: the set points of the file count
  std::string arm;                      ///< name of an arm in config/arms, or path of its file
  std::string identified;               ///< directory of overlays, SHORT_NAME.yaml; empty: no overlays
  std::string out;                      ///< file that gets every row: CSV, bag or HDF5, by its ending; empty: no file
  std::optional<double> rate;           ///< rate of the rows [Hz]; none: rate of the arm's states
  bool force{};                         ///< whether existing files are overwritten
  /// Function that is called for every row, with the time [s] and the row.
  std::function<void(double, const ArmRow&)> take{ [](double, const ArmRow&) {} };
  Watch watch;
};

void addOptions(OptionTable& table, ArmRunOptions& options);

/// Rms and largest magnitude of an error in the rows of a motion.
class RunErrors
{
public:
  void add(double error)
  {
    rms_.add(error);
    largest_ = std::max(largest_, std::abs(error));
  }
  double rms() const { return rms_.value(); }
  double largest() const { return largest_; }

private:
  Rms rms_;
  double largest_{};
};

struct ArmRunJoint
{
  std::string name;       ///< short name of the joint
  RunErrors angle_error;  ///< actual less target angle of the joint [rad]
  Rms current;            ///< current of the motor [A]
};

struct ArmRunStop
{
  double time{};      ///< time of the stop, on the time axis of the motion [s]
  std::string joint;  ///< short name of the joint
  std::string reason;
};

struct ArmRun
{
  double duration{};                 ///< simulated time, including the start while the brakes hold [s]
  double wall_time{};                ///< computing time, without the time for building tables [s]
  RunErrors tool_error;              ///< distance of the tool from its target position in the rows [m]
  double energy_residual{};          ///< energy that the drives delivered less the change of the arm's energy [J]
  std::vector<ArmRunJoint> joints;   ///< joints from the base on; none if the run was stopped before the first step
  std::optional<ArmRunStop> stop;    ///< protective stop; none if the motion was completed
  std::uint64_t feedback_limited{};  ///< number of times that the feedback of an unbraked joint was at its limit [-]
  TwinCounters counters;             ///< sum of the counters of all drives
};

/// Moves an arm along its set points. Drives, links and controller form a closed loop (docs/arm_twin.md).
/// @throws ParameterError, InputError if a file cannot be read or written.
ArmRun runArm(const ArmRunOptions& options);

Report reportOf(const ArmRun& run);
}  // namespace hjt
