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
/// One quantity that was looked for in a recording.
struct IdentifiedValue
{
  std::string name;
  std::string key;  ///< of the parameter it is; empty: the twin has none for it
  std::string unit;
  double configured{};    ///< before
  double value{};         ///< identified, or the configured one where `refusal` says why
  double half_width{};    ///< of the 95 % confidence interval; 0 where refused
  std::string refusal{};  ///< empty: identified
};

/// A line of the current in the joint's angle, as TorqueRipple has it.
struct RippleLine
{
  std::string key;                 ///< of the parameter it is
  std::array<double, 2> torque{};  ///< cos and sin; zero where refused [N.m at the joint]
  double order{};                  ///< per turn of the joint
  double amplitude{};              ///< [N.m at the joint]
  double half_width{};             ///< of its 95 % confidence interval [N.m]
  double phase{};                  ///< of the cosine at joint angle 0 [rad]
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

/// Of the part to judge on.
struct JudgedErrors
{
  CurrentError configured;            ///< as configured
  CurrentError without_ripple;        ///< with the identified parameters but the ripple's
  CurrentError identified;            ///< with all identified parameters, which is what the overlay gives
  CurrentError gain_coulomb_viscous;  ///< for comparison: three numbers fitted to the same training part
};

struct Identification
{
  std::vector<IdentifiedValue> values;
  std::vector<RippleLine> lines;

  JudgedErrors judged;
  Parameters parameters;  ///< with the identified values
};

/// Errors by which the identified parameters are judged.
struct JudgedPart
{
  std::vector<MotionSample> samples;
  double from{ -1e300 };  ///< earlier samples only lead up to it [s]
};

/// Friction, inertia, gain and ripple of a joint that a motion shows; the model is the one of MotionDriven, its
/// parameters are the twin's. In this order, each with what came before: FrictionFit and RippleFit on the rows that
/// move, presliding on all.
///
/// Intervals are widened by the correlation of the residual. A quantity is refused, and stays as configured, if the
/// motion does not move its column, if others explain it, if its interval is too wide or if it leaves the range that it
/// can have. `train` and `judge`: samples of one stream each, in the order of time. `load_recorded`: their load comes
/// from the recording, which may hold a part of the motor's inertia; that part is identified then, else the rotor's
/// inertia. `look` is called every few tenths of a second, at half an hour of rows; what it throws ends the fit.
/// @throws InputError if the training part hardly moves.
Identification identify(
    const Parameters& parameters, const std::vector<MotionSample>& train, const JudgedPart& judge, bool load_recorded,
    const std::function<void()>& look = [] {});

/// A stretch of a recording [s].
struct Span
{
  double from{};
  double to{};

  bool contains(double time) const { return time >= from && time < to; }
};

/// Samples within `span` and not within `hole`; the first one after the hole follows a gap.
std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole = {});

/// `train`, which has samples, is cut into `folds` pieces in which the joint goes equal ways. Each is judged by what
/// the others give; the errors are pooled. 0 folds: no rows. `fitted` is called after each, `look` as in identify.
/// @throws InputError as identify.
JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look);
}  // namespace hjt
