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

/// Options of a motion for the twin of a whole arm. A fault is written JOINT:KIND:SEVERITY[:PLACE[:ONSET]].
struct ArmRunOptions : ConfigurationOptions
{
  std::string motion;                   ///< file of set points (readSetPoints)
  std::vector<ArmSetPoint> set_points;  ///< set points in memory; none: those of the file
  std::string arm;                      ///< name in config/arms, or a file
  std::string identified;               ///< directory of overlays, SHORT_NAME.yaml; empty: none
  std::string out;                      ///< file of every row, CSV, bag or HDF5 by its ending; empty: none
  std::optional<double> rate;           ///< rate of the rows [Hz]; none: that of the arm's states
  bool force{};                         ///< overwrite files
  /// Gets every row and its time [s].
  std::function<void(double, const ArmRow&)> take{ [](double, const ArmRow&) {} };
  Watch watch;
};

void addOptions(OptionTable& table, ArmRunOptions& options);

/// Errors at the rows of a motion.
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
  std::string name;       ///< short name
  RunErrors angle_error;  ///< actual less target [rad]
  Rms current;            ///< current of the motor [A]
};

/// A protective stop.
struct ArmRunStop
{
  double time{};      ///< time of the motion [s]
  std::string joint;  ///< short name
  std::string reason;
};

struct ArmRun
{
  double duration{};                 ///< simulated time, with the start in the brakes [s]
  double wall_time{};                ///< computing time without building tables [s]
  RunErrors tool_error;              ///< error of the tool's position [m]
  double energy_residual{};          ///< error of the coupling [J]
  std::vector<ArmRunJoint> joints;   ///< joints from the base on; none if the run was stopped before the first step
  std::optional<ArmRunStop> stop;    ///< protective stop; none if the motion came to its end
  std::uint64_t feedback_limited{};  ///< number of controls with a limited feedback [-]
  TwinCounters counters;             ///< counters of all drives
};

/// Moves an arm along its set points, its drives, links and controller in closed loop (docs/arm_twin.md).
/// @throws ParameterError, InputError if a file cannot be read or written.
ArmRun runArm(const ArmRunOptions& options);

Report reportOf(const ArmRun& run);
}  // namespace hjt
