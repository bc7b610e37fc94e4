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
inline constexpr Range ROW_RATE{ 1e-6, 1e6 };  ///< of an arm's rows [Hz]

/// A motion for the twin of a whole arm. `faults`: JOINT:KIND:SEVERITY[:PLACE[:ONSET]].
struct ArmRunOptions : ConfigurationOptions
{
  std::string motion;                   ///< file of set points (readSetPoints)
  std::vector<ArmSetPoint> set_points;  ///< at hand; none: those of the file
  std::string arm;                      ///< name in config/arms, or a file
  std::string identified;               ///< directory of overlays, SHORT_NAME.yaml; empty: none
  std::string out;                      ///< every row, as CSV, bag or HDF5 by its ending; empty: none
  std::optional<double> rate;           ///< of the rows, within ROW_RATE [Hz]; none: that of the arm's states
  bool force{};                         ///< overwrite files
  /// Given every row and its time [s].
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
  std::string name;       ///< short
  RunErrors angle_error;  ///< actual less target [rad]
  Rms current;            ///< [A]
};

/// A protective stop.
struct ArmRunStop
{
  double time{};      ///< of the motion [s]
  std::string joint;  ///< short
  std::string reason;
};

struct ArmRun
{
  double duration{};                 ///< simulated, with the start in the brakes [s]
  double wall_time{};                ///< without building tables [s]
  RunErrors tool_error;              ///< of its position [m]
  double energy_residual{};          ///< of the coupling [J]
  std::vector<ArmRunJoint> joints;   ///< from the base on; none: stopped before the first step
  std::optional<ArmRunStop> stop;    ///< none: it came to its end
  std::uint64_t feedback_limited{};  ///< controls of a joint whose feedback was at its limit [-]
  TwinCounters counters;             ///< of all drives: how their steps went
};

/// Moves an arm along its set points, its drives, links and controller in closed loop (docs/arm_twin.md).
/// @throws ParameterError, InputError: unreadable, or a file that cannot be written.
ArmRun runArm(const ArmRunOptions& options);

Report reportOf(const ArmRun& run);
}  // namespace hjt
