// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace hjt
{
/// Reason of a verdict, or reason why there is no verdict. Numbers and names are those of Verdict.msg.
enum class Reason : std::uint8_t
{
  SOUND = 0,                ///< the joint is judged: all results are as in a sound joint
  FRICTION = 1,             ///< the joint is judged: the friction is not that of a sound joint
  TORSION = 2,              ///< the joint is judged: the torsion is not that of a sound joint
  SIGNALS = 3,              ///< the joint is judged: the indicators of the signals are not those of a sound joint
  SOLVER_FAILED = 4,        ///< the twin found no solution and holds its last good state
  NO_STEADY_MOTION = 5,     ///< the joint never moves steadily for long enough to measure its friction
  ONE_DIRECTION = 6,        ///< the joint moves in one direction only, so friction and load cannot be separated
  LOAD_UNKNOWN = 7,         ///< telemetry.load expects a load, but none was received
  LOAD_WRONG = 8,           ///< the currents do not fit the load
  CONTACT = 9,              ///< something touched the arm
  EFFORT_NOT_CURRENT = 10,  ///< the effort is not the motor's current
  EFFORT_TOO_LARGE = 11,  ///< the effort is several times the current that the motion needs: its unit or gain is wrong
  COMMON_FRICTION = 12,   ///< no temperature explains the friction of the whole arm
  TELEMETRY_UNSETTLED = 13,  ///< the program does not know yet whether angles and efforts fit together
  ROW_RATE = 14,             ///< the rows are too far apart in time to show accelerations
  STAMPS = 15,               ///< the stamps do not fit the angles, velocities or currents
  ANGLE_UNIT = 16,           ///< the angles are not in rad
  EFFORT_UNIT = 17,          ///< the effort has another unit or gain than configured
  EFFORT_CONSTANT = 18,      ///< the effort never changes
  VELOCITY_SIGN = 19,        ///< angle and velocity have opposite signs
  VELOCITY_SCALE = 20,       ///< the velocity is a multiple of the rate of the angle
  VELOCITY_LAG = 21,         ///< the velocity is earlier or later than the angle
  NO_MOTOR_ANGLE = 22,       ///< torsion is not judged: the recording has only one angle for each joint
  LOAD_CONSTANT = 23,        ///< torsion is not judged: the load hardly varies
  TOO_FEW_WINDOWS = 24,      ///< the signals are not judged: there are fewer windows than a verdict needs
  NO_REFERENCE = 25,         ///< the reference lacks the speeds or the operating points of the recording
  TOO_SHORT = 26,            ///< too few rows to measure the friction, or to learn a reference of the signals
  TWO_SOURCES = 27,          ///< several sources send rows of the same joints in turn
  GEAR_RATIO = 28,           ///< motor and joint do not turn by the ratio of the configured gear
  AT_REST = 29,              ///< the joint does not move
  ONE_SPEED = 30,            ///< the joint has too few speeds, so the uncertainty of its friction is unknown
  NO_FRICTION = 31,          ///< the effort contains no friction: it is a modelled or commanded torque
  LESS_THAN_FAULTS = 32,     ///< less friction than with any fault: a hand leads the arm, or gain or ratio are wrong
  FRICTION_SCATTER = 33,     ///< the rows scatter too much to measure the friction: the load is wrong
  TORSION_NO_DRIVE = 34      ///< no fault explains the torsion: load or angles are not those of this joint
};
constexpr std::size_t REASON_COUNT = 35;

const char* reasonName(Reason reason) noexcept;  ///< name of a reason, for example "ONE_DIRECTION"

/// Reason why a joint is not judged.
struct Misfit
{
  Reason reason{};
  std::string clause;  ///< the reason in words, without a full stop; empty: the joint is judged

  bool exists() const { return !clause.empty(); }
};

/// Measured over expected friction of a joint in fits of the currents of all joints, apart from the factor that the
/// joints share [-]. `factor` is that of the likeliest fit. `lower` and `upper` are the ends of an interval that
/// contains the 95 % intervals of all fits that are not clearly less likely than the likeliest fit.
struct FittedFriction
{
  double factor{ 1.0 };
  double lower{ 0.0 };
  double upper{ HUGE_VAL };    ///< upper end of the interval; HUGE_VAL with `lower` = 0: there is no fit
  double of_rows{ HUGE_VAL };  ///< half width of the interval by the rows alone, without prior knowledge [-]
  /// Clauses that say why the friction may be as expected although the joint's own rows show more friction, or less
  /// friction. Empty: the fits do not show that.
  std::string not_more{};
  std::string not_less{};

  /// Least deviation of the factor from 1 that counts in departs() [-]. Sound joints of a UR5 and a UR10e deviate by up
  /// to 0.07, and a sound joint beside a joint with 60 % more friction deviates by 0.11.
  static constexpr double BOUND = 0.15;
  bool departs() const { return lower > 1.0 + BOUND || upper < 1.0 - BOUND; }
  /// Whether the interval of the factor lies within 1 - tolerance and 1 + tolerance, also the interval from the rows
  /// alone.
  bool isWithin(double tolerance) const
  {
    return std::max(upper, factor + of_rows) < 1.0 + tolerance && std::min(lower, factor - of_rows) > 1.0 - tolerance;
  }
};
}  // namespace hjt
