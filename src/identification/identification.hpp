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
/// A quantity that the identification estimates from a recording, with its interval.
struct IdentifiedValue
{
  std::string name;
  std::string key;  ///< key of the twin's parameter; empty if the twin has none
  std::string unit;
  double configured{};    ///< configured value
  double value{};         ///< identified value, or the configured value if there is a `refusal`
  double half_width{};    ///< half width of the 95 % confidence interval; 0 if the value is refused
  std::string refusal{};  ///< why the value was not identified; empty if it was identified
};

/// A line of TorqueRipple, which repeats with the joint's angle, as identified from the current.
struct RippleLine
{
  std::string key;                 ///< key of the parameter
  std::array<double, 2> torque{};  ///< amplitudes of cosine and sine; zero if refused [N.m at the joint]
  double order{};                  ///< cycles per turn of the joint [-]
  double amplitude{};              ///< amplitude of the line [N.m at the joint]
  double half_width{};             ///< half width of the amplitude's 95 % confidence interval [N.m]
  double phase{};                  ///< phase of the cosine at joint angle 0 [rad]
  std::string refusal{};
};

/// Errors (rms) of the current that a motion-driven twin predicts [A], over all rows, moving rows and resting rows.
struct CurrentError
{
  std::size_t rows{};
  std::size_t moving_rows{};
  double all{};
  double moving{};
  double resting{};
  double signal{};  ///< rms of the measured current [A]
};

/// Errors of the predicted current in the part of the recording that is not used for the identification.
struct JudgedErrors
{
  CurrentError configured;            ///< errors with the configured parameters
  CurrentError without_ripple;        ///< errors with the identified parameters, but without ripple
  CurrentError identified;            ///< errors with all identified parameters, as in the overlay
  CurrentError gain_coulomb_viscous;  ///< errors of the simple fit to the part for training
};

struct Identification
{
  std::vector<IdentifiedValue> values;
  std::vector<RippleLine> lines;

  JudgedErrors judged;
  Parameters parameters;  ///< the parameters, with the identified values
};

/// Part of the recording in which the prediction with the identified parameters is judged.
struct JudgedPart
{
  std::vector<MotionSample> samples;
  double from{ -1e300 };  ///< time from which samples are judged [s]; earlier ones only set the twin's state
};

/// Estimates friction, inertia, gain and ripple of a joint from a motion, as parameters of the twin. The model is
/// MotionDriven. The steps are FrictionFit and RippleFit on the moving rows, then the fit of presliding on all rows.
/// Each step uses the results of the earlier steps.
///
/// Correlation of the residual widens the intervals. A quantity is refused and keeps its configured value if the motion
/// does not excite it, if other quantities explain its effect, if its interval is too wide, or if its result is not
/// possible. `train` and `judge` each hold samples of one stream, ordered by time. `load_recorded`: whether the
/// recording contains the load. A recorded load may include a part of the motor's inertia; then that part is
/// identified, else the rotor's inertia. The fit calls `look` every few tenths of a second if `train` has half an hour
/// of rows. An exception of `look` ends the fit.
/// @throws InputError if the joint hardly moves in `train`.
Identification identify(
    const Parameters& parameters, const std::vector<MotionSample>& train, const JudgedPart& judge, bool load_recorded,
    const std::function<void()>& look = [] {});

/// A time interval of a recording [s].
struct Span
{
  double from{};
  double to{};

  bool contains(double time) const { return time >= from && time < to; }
};

/// Samples within `span` and outside of `hole`. The first sample after the hole is marked as one after a gap.
std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole = {});

/// Divides `train`, which must have samples, into `folds` pieces of equal travel. Each piece is judged with the fit to
/// the other pieces, and the errors are pooled. With 0 folds the result has no rows. The function calls `fitted` after
/// each fold, and `look` like `identify`. @throws InputError for the reason that `identify` names.
JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look);
}  // namespace hjt
