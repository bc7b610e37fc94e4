// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// A quantity that the identification estimates from a recording.
struct IdentifiedValue
{
  std::string name;
  std::string key;  ///< key of the parameter; empty: the twin has no parameter for it
  std::string unit;
  double configured{};    ///< configured value
  double value{};         ///< identified value; the configured one if there is a `refusal`
  double half_width{};    ///< half width of the 95 % confidence interval; 0 if refused
  std::string refusal{};  ///< reason of a refusal; empty: identified
};

/// A line of the current's spectrum over the joint's angle, as in TorqueRipple.
struct RippleLine
{
  std::string key;                 ///< key of the parameter
  std::array<double, 2> torque{};  ///< cosine and sine amplitude; zero if refused [N.m at the joint]
  double order{};                  ///< cycles in a turn of the joint
  double amplitude{};              ///< [N.m at the joint]
  double half_width{};             ///< half width of its 95 % confidence interval [N.m]
  double phase{};                  ///< phase of the cosine at joint angle 0 [rad]
  std::string refusal{};
};

/// Error of the current that a motion-driven twin predicts, rms [A].
struct CurrentError
{
  std::size_t rows{};
  std::size_t moving_rows{};
  double all{};
  double moving{};
  double resting{};
  double signal{};  ///< rms of the measured current
};

/// Errors on the judged part of the recording.
struct JudgedErrors
{
  CurrentError configured;            ///< with the configured parameters
  CurrentError without_ripple;        ///< with the identified parameters except the ripple's
  CurrentError identified;            ///< with all identified parameters, as in the overlay
  CurrentError gain_coulomb_viscous;  ///< for comparison: a model of three numbers fitted to the training part
};

struct Identification
{
  std::vector<IdentifiedValue> values;
  std::vector<RippleLine> lines;

  JudgedErrors judged;
  Parameters parameters;  ///< with the identified values
};

/// Part of the recording on which the identified parameters are judged.
struct JudgedPart
{
  std::vector<MotionSample> samples;
  double from{ -1e300 };  ///< time from which samples are judged; earlier ones only set the state [s]
};

/// Estimates friction, inertia, gain and ripple of a joint from a motion. The model is MotionDriven, the parameters are
/// those of the twin. The order is FrictionFit and RippleFit on the moving rows, then presliding on all rows; each uses
/// the earlier results.
///
/// The correlation of the residual widens the intervals. A quantity is refused and keeps its configured value if the
/// motion does not excite it, if others explain its effect, if its interval is too wide, or if it leaves its possible
/// range. `train` and `judge`: samples of one stream each, ordered by time. `load_recorded`: the recording contains the
/// load, which may include a part of the motor's inertia; then that part is identified, else the rotor's inertia. The
/// fit calls `look` every few tenths of a second for half an hour of rows; an exception of `look` ends the fit.
/// @throws InputError if the training part hardly moves.
Identification identify(
    const Parameters& parameters, const std::vector<MotionSample>& train, const JudgedPart& judge, bool load_recorded,
    const std::function<void()>& look = [] {});

/// An interval of a recording [s].
struct Span
{
  double from{};
  double to{};

  bool contains(double time) const { return time >= from && time < to; }
};

/// Samples within `span` and outside `hole`. The first one after the hole is marked as after a gap.
std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole = {});

/// Divides `train`, which must have samples, into `folds` pieces of equal travel. Each is judged by the fit to the
/// others, and the errors are pooled. 0 folds: no rows. The function calls `fitted` after each fold, and `look` as in
/// identify.
/// @throws InputError as identify.
JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look);
}  // namespace hjt
