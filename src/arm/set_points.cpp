// SPDX-License-Identifier: BSD-3-Clause
#include "arm/set_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "arm/arm_controller.hpp"
#include "arm/arm_description.hpp"
#include "arm/arm_motion.hpp"
#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_reader.hpp"

namespace hjt
{
namespace
{
constexpr double PERIOD = 0.008;         // time between set points [s]
constexpr double LARGEST = 100.0;        // largest angle in a program, for joints that turn without limits [rad]
constexpr double LONGEST_REST = 3600.0;  // longest rest after a move [s]
constexpr const char* MOVES = "moves";

/// Reads the moves of a program. A speed, acceleration, jerk or wait at the top of the file holds for moves without it.
class ProgramReader
{
public:
  ProgramReader(const std::string& path, std::size_t joints)
    : map_(readArmFile(path)), joints_(joints), fields_(map_, path)
  {
    const auto given = map_.lower_bound(MOVES);
    if (count() == 0)
    {
      const bool is_there = holds(MOVES);
      const bool is_value = is_there && given->first == MOVES;
      throw ParameterError((is_there ? given->second.origin : path) + ": " + MOVES +
                           (is_value ? " = " + valueText(given->second) :
                            is_there ? "" :
                                       ", which is missing,") +
                           " must be a list of one move or more, {to: [...], speed: ..., acceleration: ...}");
    }
    for (std::size_t i = 0; i < count(); ++i)
    {
      for (const char* key : { "speed", "acceleration", "jerk", "wait" })
      {
        if (const auto common = map_.find(key); common != map_.end())
        {
          map_.emplace(place(i) + key, common->second);
        }
      }
    }
    for (const char* key : { "speed", "acceleration", "jerk", "wait" })
    {
      map_.erase(key);
    }
  }

  ArmPose start()
  {
    ArmPose start(joints_);
    fields_("start", "rad", start, Range{ -LARGEST, LARGEST }, "angles of all joints at the start");
    return start;
  }

  std::vector<ArmMove> moves()
  {
    std::vector<ArmMove> moves(count());
    for (std::size_t i = 0; i < moves.size(); ++i)
    {
      read(place(i), moves[i]);
    }
    fields_.refuseUnknownKeys();
    throwIfAny(fields_.errors());
    return moves;
  }

private:
  static std::string place(std::size_t move) { return MOVES + ("." + std::to_string(move)) + "."; }

  bool holds(const std::string& key) const
  {
    const auto found = map_.lower_bound(key);
    return found != map_.end() && found->first.rfind(key, 0) == 0;
  }

  std::size_t count() const
  {
    std::size_t moves = 0;
    while (holds(place(moves)))
    {
      ++moves;
    }
    return moves;
  }

  void read(const std::string& at, ArmMove& move)
  {
    move.target.resize(joints_);
    fields_(at + "to", "rad", move.target, Range{ -LARGEST, LARGEST }, "angles of all joints after the move");
    fields_(at + "speed", "rad/s", move.speed, Range{ 1e-3, 100.0 }, "largest speed of the joint that goes farthest");
    fields_(at + "acceleration", "rad/s^2", move.acceleration, Range{ 1e-2, 1e4 },
            "largest acceleration of the joint that goes farthest");
    if (holds(at + "jerk"))
    {
      fields_(at + "jerk", "rad/s^3", move.jerk, Range{ 1e-2, 1e6 }, "largest jerk of the joint that goes farthest");
    }
    if (holds(at + "wait"))
    {
      fields_(at + "wait", "s", move.wait, Range{ 0.0, LONGEST_REST }, "time at rest after the move");
    }
  }

  ParameterMap map_;
  std::size_t joints_;
  FieldReader fields_;
};

/// Reads a program and returns its set points at 125 Hz. A program is a YAML file of moves between via points
/// (docs/arm_twin.md). The arm rests for half a second before the first move and after the last one. @throws
/// ParameterError naming file, line and key, or the joint and its limit.
std::vector<ArmSetPoint> readArmProgram(const std::string& path, const ArmDescription& arm)
{
  ProgramReader reader(path, arm.joints.size());
  const ArmPose start = reader.start();
  const std::vector<ArmInstant> instants = sampleMoves(arm, start, reader.moves(), PERIOD);
  std::vector<ArmSetPoint> points(instants.begin(), instants.end());
  requireMotion(points, arm, path);
  return points;
}

/// Index of the column that has one of these names; -1: there is no such column.
int columnOf(const std::vector<std::string>& header, const std::vector<std::string>& names)
{
  for (const std::string& name : names)
  {
    const auto found = std::find(header.begin(), header.end(), name);
    if (found != header.end())
    {
      return static_cast<int>(found - header.begin());
    }
  }
  return -1;
}

/// Time from one set point to the next in which the joints' speeds give the change of their angles, by least squares
/// [s]; NaN: the joints are slower than `least_speed` [rad/s].
double stepByMotion(const ArmSetPoint& from, const ArmSetPoint& to, double least_speed)
{
  double way = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < to.joints.size(); ++i)
  {
    const double speed = 0.5 * (from.joints[i].velocity + to.joints[i].velocity);
    way += speed * (to.joints[i].position - from.joints[i].position);
    squares += speed * speed;
  }
  return squares > least_speed * least_speed ? way / squares : std::numeric_limits<double>::quiet_NaN();
}

/// Sets to 0 the speed of each joint at the first or last set point `point`, if the joint can start or stop within
/// `length`. On entry the speeds are means over the time `length` [s] between `point` and the set point beside it.
void restAtEnd(double length, ArmSetPoint& point)
{
  constexpr double ACCELERATION = 10.0;  // largest assumed acceleration of a joint [rad/s^2]
  for (JointMotion& joint : point.joints)
  {
    joint.velocity = std::abs(joint.velocity) <= ACCELERATION * length ? 0.0 : joint.velocity;
  }
}

/// Says that the speeds of a joint have another unit or sign than its angles; empty: the speeds fit the angles.
std::string rateErrors(const std::vector<ArmSetPoint>& points, std::size_t joint)
{
  constexpr double LEAST_WAY = 0.1;        // least distance that a joint must move to be checked [rad]
  constexpr double LEAST_PART = 1e-4;      // least change of the angle in a row with motion [rad]
  constexpr std::size_t LEAST_ROWS = 3;    // least number of rows with motion; fewer rows are a jump
  constexpr Range SAME_RATES{ 0.5, 2.0 };  // allowed median of the speed over the rate of the angle [-]
  double way = 0.0;                        // distance that the joint moves [rad]
  std::vector<double> ratios;
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    const JointMotion& from = points[k - 1].joints[joint];
    const JointMotion& to = points[k].joints[joint];
    const double part = to.position - from.position;
    way += std::abs(part);
    if (std::abs(part) > LEAST_PART)
    {
      ratios.push_back(0.5 * (from.velocity + to.velocity) * (points[k].time - points[k - 1].time) / part);
    }
  }
  const double ratio = way > LEAST_WAY && ratios.size() >= LEAST_ROWS ? upperMedian(ratios.begin(), ratios.end()) : 1.0;
  if (ratio < SAME_RATES.min || ratio > SAME_RATES.max)
  {
    return "its speeds are " + roundedText(ratio, 3) + " times the rate of its angles, allowed: 0.5 ... 2 (" +
           (ratio < 0.0 ? "is their sign wrong?" :
            ratio > 1.0 ? "are they degrees/s?" :
                          "are they missing?") +
           ")";
  }
  return {};
}

constexpr double LONGEST = 1e6;  // longest motion, some eleven days [s]

std::string rangeErrors(const JointMotion& motion, const ArmJoint& joint)
{
  const auto errors = [&](const char* what, double value, const char* unit, const Range& range)
  {
    return value >= range.min && value <= range.max ? std::string() :
                                                      joint.name + ": " + what + " = " + numberText(value) + " [" +
                                                          unit + "] is out of range, allowed: " + rangeText(range);
  };
  std::string angle = errors("angle", motion.position, "rad", joint.angles);
  return !angle.empty() ? angle + "; are they degrees?" :
                          errors("speed", motion.velocity, "rad/s", Range{ -100.0, 100.0 }) +
                              errors("acceleration", motion.acceleration, "rad/s^2", Range{ -1e4, 1e4 });
}

/// Says which joint would turn faster than TIMES its speed limit. A controller can exceed the limit itself slightly.
std::string speedErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm)
{
  constexpr double TIMES = 3.0;  // largest allowed speed over the joint's speed limit [-]
  constexpr double SHORT = 0.1;  // time over which speeds are averaged, because single stamps jitter [s]
  std::size_t from = 0;
  for (const ArmSetPoint& to : points)
  {
    while (points[from + 1 < points.size() ? from + 1 : from].time <= to.time - SHORT)
    {
      ++from;
    }
    const double length = to.time - points[from].time;
    for (std::size_t i = 0; i < arm.joints.size() && length >= SHORT; ++i)
    {
      const double speed = std::abs(to.joints[i].position - points[from].joints[i].position) / length;
      const double limit = arm.joints[i].speed_limit;
      if (limit > 0.0 && !(speed <= TIMES * limit))
      {
        return arm.joints[i].name + " would turn at " + roundedText(speed, 3) + " rad/s at " +
               roundedText(to.time - points.front().time, 4) + " s, its limit is " + roundedText(limit, 4) +
               " rad/s; are the angles degrees?";
      }
    }
  }
  return {};
}

/// Says which joint cannot bear links and payload at rest in a set point; empty: all joints can.
std::string weightErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm)
{
  ArmDynamics dynamics(arm);
  std::vector<JointMotion> still(arm.joints.size());
  std::vector<double> torques(arm.joints.size());
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    for (std::size_t i = 0; i < still.size(); ++i)
    {
      still[i].position = points[k].joints[i].position;
    }
    dynamics.torques(still, torques);
    for (std::size_t i = 0; i < still.size(); ++i)
    {
      const ArmJoint& joint = arm.joints[i];
      if (joint.torque_limit > 0.0 && !(std::abs(torques[i]) <= joint.torque_limit))
      {
        return "set point " + std::to_string(k + 1) + ": " + joint.name +
               " cannot bear the weight of links and payload (" + numberText(arm.payload.mass) + " kg), " +
               roundedText(std::abs(torques[i]), 4) + " N.m at rest; its limit is " +
               roundedText(joint.torque_limit, 4) + " N.m";
      }
    }
  }
  return {};
}
}  // namespace

void fillRates(std::vector<ArmSetPoint>& points, bool has_velocity, bool has_acceleration)
{
  const auto slope = [&](std::size_t k, std::size_t i, double JointMotion::*value)
  {
    const ArmSetPoint& before = points[k > 0 ? k - 1 : k];
    const ArmSetPoint& after = points[std::min(k + 1, points.size() - 1)];
    return after.time > before.time ? (after.joints[i].*value - before.joints[i].*value) / (after.time - before.time) :
                                      0.0;
  };
  for (const auto& [missing, of, rate] :
       { std::tuple(!has_velocity, &JointMotion::position, &JointMotion::velocity),
         std::tuple(!has_acceleration, &JointMotion::velocity, &JointMotion::acceleration) })
  {
    for (std::size_t k = 0; missing && k < points.size(); ++k)
    {
      for (std::size_t i = 0; i < points[k].joints.size(); ++i)
      {
        points[k].joints[i].*rate = slope(k, i, of);
      }
    }
    if (missing && rate == &JointMotion::velocity && points.size() > 1)
    {
      const std::size_t last = points.size() - 1;
      restAtEnd(points[1].time - points[0].time, points[0]);
      restAtEnd(points[last].time - points[last - 1].time, points[last]);
    }
  }
}

double straightenTimes(std::vector<ArmSetPoint>& points)
{
  constexpr double MOVING = 0.05;      // least root of the sum of squared joint speeds in motion [rad/s]
  constexpr double SAME_RATES = 0.02;  // largest share by which speeds and rates of the angles may differ [-]
  constexpr double JITTER = 0.1;       // least jitter of the stamps that counts, rms, over the time between rows [-]
  constexpr double LONGEST = 4.0;      // largest ratio of the time by the speeds to the time by the stamps [-]
  std::vector<double> steps;
  double by_stamps = 0.0;  // time between rows by the stamps, summed over the rows with motion [s]
  double by_motion = 0.0;
  double squares = 0.0;
  double moving = 0.0;
  double change = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    const double stamped = points[k].time - points[k - 1].time;
    const double step = stepByMotion(points[k - 1], points[k], MOVING);
    const bool is_known = step > 0.0 && step < LONGEST * stamped;
    steps.push_back(is_known ? step : stamped);
    if (is_known)
    {
      by_stamps += stamped;
      by_motion += step;
      squares += std::pow(step / stamped - 1.0, 2);
      moving += 1.0;
      change = std::max(change, std::abs(step - stamped));
    }
  }
  if (!(squares > JITTER * JITTER * moving) || std::abs(by_motion / by_stamps - 1.0) > SAME_RATES)
  {
    return 0.0;
  }
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    points[k].time = points[k - 1].time + steps[k - 1];
  }
  return change;
}

std::string straightenedText(double change)
{
  return "the times of the set points do not fit their angles and speeds. The program changed time steps by up to " +
         fixedText(1e3 * change, 1) + " ms";
}

std::string motionErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm)
{
  // The negated comparisons are true for NaN, so NaN is refused.
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const ArmSetPoint& point = points[k];
    const std::string place = "set point " + std::to_string(k + 1) + ": ";
    const double time = point.time - points.front().time;
    if (k > 0 && !(point.time > points[k - 1].time))
    {
      return place + "the time does not increase: " + numberText(point.time) + " s after " +
             numberText(points[k - 1].time) + " s";
    }
    if (point.joints.size() != arm.joints.size())
    {
      return place + "it has " + std::to_string(point.joints.size()) + " joints, but the arm has " +
             std::to_string(arm.joints.size());
    }
    if (!(time <= LONGEST))
    {
      return place + "it is " + numberText(time) + " s after the first one, allowed: " + numberText(LONGEST) + " s";
    }
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      std::string errors = rangeErrors(point.joints[i], arm.joints[i]);
      if (!errors.empty())
      {
        return place + errors;
      }
    }
  }
  return speedErrors(points, arm);
}

void requireMotion(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what)
{
  if (points.empty())
  {
    throw InputError(what + " has no row");
  }
  std::string errors = motionErrors(points, arm);
  errors = errors.empty() ? weightErrors(points, arm) : errors;
  if (!errors.empty())
  {
    throw InputError(what + ": " + errors);
  }
}

void requireRates(const std::vector<ArmSetPoint>& points, const ArmDescription& arm, const std::string& what)
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    if (const std::string errors = rateErrors(points, i); !errors.empty())
    {
      throw InputError(what + ": " + arm.joints[i].short_name + ": " + errors);
    }
  }
}

std::vector<ArmSetPoint> readSetPoints(const std::string& path, const ArmDescription& arm)
{
  if (const std::string type = std::filesystem::path(path).extension(); type == ".yaml" || type == ".yml")
  {
    return readArmProgram(path, arm);
  }
  CsvRows rows(path);
  const std::vector<std::string>& header = rows.header();
  const int time = columnOf(header, { "timestamp", "time" });
  std::vector<std::array<int, 3>> columns;
  std::string missing = time < 0 ? "timestamp or time" : "";
  bool has_velocity = true;
  bool has_acceleration = true;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const std::string number = std::to_string(i);
    const std::string& name = arm.joints[i].short_name;
    columns.push_back({ columnOf(header, { "target_q_" + number, name + "_position" }),
                        columnOf(header, { "target_qd_" + number, name + "_velocity" }),
                        columnOf(header, { "target_qdd_" + number, name + "_acceleration" }) });
    if (columns[i][0] < 0)
    {
      missing += (missing.empty() ? "" : ", ") + ("target_q_" + number + " or " + name + "_position");
    }
    has_velocity = has_velocity && columns[i][1] >= 0;
    has_acceleration = has_acceleration && columns[i][2] >= 0;
  }
  if (!missing.empty())
  {
    throw InputError(path + ": no column " + missing);
  }
  std::vector<ArmSetPoint> points;
  const auto number = [&](int column) { return rows.number(static_cast<std::size_t>(column)); };
  while (rows.next())
  {
    ArmSetPoint point{ number(time), {} };
    for (const std::array<int, 3>& column : columns)
    {
      point.joints.push_back(
          { number(column[0]), has_velocity ? number(column[1]) : 0.0, has_acceleration ? number(column[2]) : 0.0 });
    }
    points.push_back(point);
  }
  fillRates(points, has_velocity, has_acceleration);
  requireMotion(points, arm, path);
  return points;
}

MotionLimits::MotionLimits(const ArmDescription& arm, const std::vector<Parameters>& drives)
  : dynamics_(arm), torques_(drives.size())
{
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    joints_.push_back({ arm.joints[i].name, arm.joints[i].torque_limit,
                        nominalRatio(drives[i].gear) * drives[i].motor.torque_limit,
                        ArmController::motorInertia(drives[i]) });
  }
}

std::string MotionLimits::errors(const std::vector<ArmSetPoint>& points)
{
  std::vector<JointMotion> motion(joints_.size());
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    ArmMotion piece({ points[k - 1], points[k] }, ArmAccelerations::OF_CUBICS);
    const double length = points[k].time - points[k - 1].time;
    // The acceleration of a cubic is largest at its ends. The checked times lie just inside, away from the next cubic.
    for (const double share : { 1e-6, 0.5, 1.0 - 1e-6 })
    {
      piece.at(points[k - 1].time + share * length, motion);
      if (std::string error = errorsAt(motion, points[k].time); !error.empty())
      {
        return error;
      }
    }
  }
  return {};
}

std::string MotionLimits::errorsAt(const std::vector<JointMotion>& motion, double before)
{
  dynamics_.torques(motion, torques_);
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    const Joint& joint = joints_[i];
    const double motor = std::abs(torques_[i] + joint.motor_inertia * motion[i].acceleration);
    // The comparison is false for NaN, so NaN is refused.
    const bool links_can = joint.torque_limit == 0.0 || std::abs(torques_[i]) <= joint.torque_limit;
    if (!links_can || !(motor <= joint.motor_limit))
    {
      return joint.name + " would need " + roundedText(links_can ? motor : std::abs(torques_[i]), 3) +
             (links_can ? " N.m of its motor" : " N.m") + " before " + roundedText(before, 4) +
             " s, at an acceleration of " + roundedText(motion[i].acceleration, 3) + " rad/s^2; " +
             (links_can ? "its motor's limit is " : "its limit is ") +
             roundedText(links_can ? joint.motor_limit : joint.torque_limit, 4) + " N.m";
    }
  }
  return {};
}
}  // namespace hjt
