// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/motion_smoother.hpp"

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

/// A line of the current in the joint's angle: torque at the joint, cos and sin of order times angle.
struct RippleLine
{
  double order{};       ///< per turn of the joint
  double amplitude{};   ///< [N.m at the joint]
  double half_width{};  ///< of its 95 % confidence interval [N.m]
  double phase{};       ///< of the cosine at joint angle 0 [rad]
  std::string refusal{};
};

/// Error of the current that a motion-driven twin predicts, rms [A].
struct CurrentError
{
  std::size_t rows{};
  double all{};
  double moving{};
  double resting{};
  double signal{};  ///< rms of the measured current
};

struct Identification
{
  std::vector<IdentifiedValue> values;
  std::vector<RippleLine> lines;
  double loop_frequency{};    ///< of the drive's speed loop, through which the ripple is seen [Hz]
  double loop_damping{};      ///< [-]
  double lag{};               ///< of the current behind the angle [s]
  double correlation_rows{};  ///< rows after which the residual forgets itself, widens every interval [-]

  CurrentError before;                ///< judging part, as configured
  CurrentError after;                 ///< with the identified parameters, which is what the overlay gives
  CurrentError with_lines;            ///< and with the ripple
  CurrentError gain_coulomb_viscous;  ///< for comparison: three numbers fitted to the same training part

  Parameters parameters;  ///< with the identified values
};

/// What of a joint's friction, inertia and gain a motion shows, by least squares (Ceres) on the rows that move.
///
/// The model is the one of MotionDriven; its parameters are the twin's. Intervals are widened by the correlation of the
/// residual. A quantity is refused, and stays as configured, if the motion does not move its column, if others explain it,
/// if its interval is wider than half its value or if it comes out of the range that it can have.
/// `train` and `judge`: samples of one stream each, in the order of time. `load_recorded`: their load comes from the
/// recording, which may hold a part of the motor's inertia; that part is identified then, else the rotor's inertia.
/// @throws InputError if the training part hardly moves.
Identification identify(const Parameters& parameters, const std::vector<MotionSample>& train,
                        const std::vector<MotionSample>& judge, bool load_recorded);
}  // namespace hjt
