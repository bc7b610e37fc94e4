// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace hjt
{
/// Reason of a verdict, or why there is no verdict. Numbers and names are those of Verdict.msg.
enum class Reason : std::uint8_t
{
  SOUND = 0,                 ///< judged: all results are as in a sound joint
  FRICTION = 1,              ///< judged: the friction is not that of a sound joint
  TORSION = 2,               ///< judged: the torsion is not that of a sound drive
  SIGNALS = 3,               ///< judged: the signals' indicators are not those of a sound drive
  SOLVER_FAILED = 4,         ///< the twin found no solution: its last good state is held
  NO_STEADY_MOTION = 5,      ///< the joint never moves steadily for long enough
  ONE_DIRECTION = 6,         ///< the joint moves in one direction only, so friction and load cannot be separated
  LOAD_UNKNOWN = 7,          ///< a load is expected, but none was received
  LOAD_WRONG = 8,            ///< the currents do not fit the load
  CONTACT = 9,               ///< something touched the arm
  EFFORT_NOT_CURRENT = 10,   ///< the effort is not the motor's current
  EFFORT_TOO_LARGE = 11,     ///< the effort is several times the current that the motion needs: wrong unit or gain
  COMMON_FRICTION = 12,      ///< the friction of all joints differs by more than a temperature causes
  TELEMETRY_UNSETTLED = 13,  ///< it is not known yet whether angles and efforts fit
  ROW_RATE = 14,             ///< the rows come too rarely
  STAMPS = 15,               ///< angles, velocities or currents are of another time than the stamps
  ANGLE_UNIT = 16,           ///< the angles are not in rad
  EFFORT_UNIT = 17,          ///< the effort is of another unit or gain than configured
  EFFORT_CONSTANT = 18,      ///< the effort never changes
  VELOCITY_SIGN = 19,        ///< angle and velocity are of opposite sign
  VELOCITY_SCALE = 20,       ///< the velocity is a multiple of the angle's change
  VELOCITY_LAG = 21,         ///< angle and velocity are of different times
  NO_MOTOR_ANGLE = 22,       ///< torsion: each joint has one angle only
  LOAD_CONSTANT = 23,        ///< torsion: the load hardly varies
  TOO_FEW_WINDOWS = 24,      ///< signals: fewer windows than a verdict needs
  NO_REFERENCE = 25,         ///< the reference knows none of the speeds; of signals none of the operating points
  TOO_SHORT = 26,            ///< too few rows: to measure the friction, or to learn the signals without a reference
  TWO_SOURCES = 27,          ///< several sources give the same joints in turn
  GEAR_RATIO = 28,           ///< motor and joint do not turn by the configured gear's ratio
  AT_REST = 29,              ///< the joint does not move
  ONE_SPEED = 30,            ///< the joint moves at one speed only, so the uncertainty of its friction is unknown
  NO_FRICTION = 31,          ///< the effort contains no friction: it is a modelled or commanded torque
  LESS_THAN_FAULTS = 32,     ///< less friction than with any fault: a hand leads the arm, or gain or ratio are wrong
  FRICTION_SCATTER = 33,     ///< the rows scatter too much to measure the friction: the load is wrong
  TORSION_NO_DRIVE = 34      ///< no fault causes so large or small a torsion: load or angles are not of this joint
};
constexpr std::size_t REASON_COUNT = 35;

const char* reasonName(Reason reason) noexcept;  ///< "ONE_DIRECTION"

/// Why a joint is not judged.
struct Misfit
{
  Reason reason{};
  std::string clause;  ///< reason in words, without a full stop; empty: the joint is judged

  bool exists() const { return !clause.empty(); }
};

/// Friction of a joint over the expected friction in fits of the currents of all joints, apart from the factor that the
/// joints share. The factor is that of the likeliest fit; the interval covers those of all fits that are not clearly
/// less likely.
struct FittedFriction
{
  double factor{ 1.0 };
  double lower{ 0.0 };
  double upper{ HUGE_VAL };    ///< lower end 0 and this upper end: there is no fit
  double of_rows{ HUGE_VAL };  ///< half width of the interval by the rows alone, without prior knowledge of joints
  /// Clauses: why the friction may be as expected although the joint's own rows show more, or less. Empty: it may not.
  std::string not_more{};
  std::string not_less{};

  /// Deviation from 1 that counts as a departure. Joints of a sound UR5 and UR10e deviate by up to 0.07, and a sound
  /// joint beside a joint with 60 % more friction by 0.11.
  static constexpr double BOUND = 0.15;
  bool departs() const { return lower > 1.0 + BOUND || upper < 1.0 - BOUND; }
  /// The friction is within `tolerance` of the expected friction, by the rows alone too.
  bool isWithin(double tolerance) const
  {
    return std::max(upper, factor + of_rows) < 1.0 + tolerance && std::min(lower, factor - of_rows) > 1.0 - tolerance;
  }
};
}  // namespace hjt
