// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/arm_trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "arm/set_points.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"

namespace hjt
{
namespace
{
using trajectory_msgs::JointTrajectory;
using trajectory_msgs::JointTrajectoryPoint;

constexpr double SAME_PLACE = 0.01;       // largest difference of a point at time 0 from the present set point [rad]
constexpr std::size_t MAX_SHOWN = 300;    // largest shown length of the names in a message [bytes]
constexpr double SPEED_TOLERANCE = 1e-6;  // share by which a speed may exceed its limit [-]

constexpr std::size_t NOT_NAMED = static_cast<std::size_t>(-1);

/// Index of each joint of the arm in the message, or NOT_NAMED. @returns the error in the names; empty if the names are
/// valid.
std::string placesOf(const JointTrajectory& message, const ArmDescription& arm, std::vector<std::size_t>& places)
{
  const std::vector<std::string>& names = message.joint_names;
  places.assign(arm.joints.size(), NOT_NAMED);
  for (std::size_t place = 0; place < names.size(); ++place)
  {
    const auto joint = std::find_if(arm.joints.begin(), arm.joints.end(),
                                    [&](const ArmJoint& each) { return each.name == names[place]; });
    const bool is_known = joint != arm.joints.end();
    std::size_t* const its = is_known ? &places[static_cast<std::size_t>(joint - arm.joints.begin())] : nullptr;
    if (its == nullptr || *its != NOT_NAMED)
    {
      return (is_known ? "the message names more than once " : "the arm has no joint ") +
             printable(names[place], MAX_SHOWN) + "; the message names " + printable(joined(names, ", "), MAX_SHOWN);
    }
    *its = place;
  }
  return names.empty() ? "the message names no joint" : "";
}

/// Position at which a joint comes to rest after a deceleration of `length` [s]. The speed decreases with the square of
/// the remaining time, as in the cubic between two set points.
JointMotion restOf(const JointMotion& joint, double length)
{
  return { joint.position + joint.velocity * length / 3.0, 0.0, 0.0 };
}

std::string sizeErrors(const JointTrajectoryPoint& point, std::size_t joints)
{
  if (point.positions.size() != joints)
  {
    return std::to_string(point.positions.size()) + " positions for " + std::to_string(joints) + " joints";
  }
  if (!point.velocities.empty() && point.velocities.size() != joints)
  {
    return std::to_string(point.velocities.size()) + " velocities for " + std::to_string(joints) + " joints";
  }
  const auto is_finite = [](double value) { return std::isfinite(value); };
  return std::all_of(point.positions.begin(), point.positions.end(), is_finite) &&
                 std::all_of(point.velocities.begin(), point.velocities.end(), is_finite) ?
             "" :
             "not all values are finite";
}

/// Largest speed of a joint between two set points [rad/s].
double greatestSpeed(const JointMotion& from, const JointMotion& to, double length)
{
  const double way = (to.position - from.position) / length;
  const double linear = 6.0 * way - 4.0 * from.velocity - 2.0 * to.velocity;
  const double square = 3.0 * (from.velocity + to.velocity) - 6.0 * way;
  double greatest = std::max(std::abs(from.velocity), std::abs(to.velocity));
  const double at = square == 0.0 ? 0.0 : -0.5 * linear / square;
  if (at > 0.0 && at < 1.0)
  {
    greatest = std::max(greatest, std::abs(from.velocity + at * (linear + at * square)));
  }
  return greatest;
}

/// Sets missing velocities: at a point the slope from the point before to the point after; 0 at the last point, and
/// for joints that the message does not name.
void fillVelocities(const JointTrajectory& message, const std::vector<std::size_t>& places,
                    std::vector<ArmSetPoint>& points)
{
  const std::size_t first = points.size() - message.points.size();
  for (std::size_t k = 1; k + 1 < points.size(); ++k)
  {
    if (k >= first && !message.points[k - first].velocities.empty())
    {
      continue;
    }
    const ArmSetPoint& before = points[k - 1];
    const ArmSetPoint& after = points[k + 1];
    for (std::size_t i = 0; i < points[k].joints.size(); ++i)
    {
      points[k].joints[i].velocity =
          places[i] == NOT_NAMED ? 0.0 :
                                   (after.joints[i].position - before.joints[i].position) / (after.time - before.time);
    }
  }
}

std::string speedErrors(const std::vector<ArmSetPoint>& points, const ArmDescription& arm)
{
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    for (std::size_t i = 0; i < arm.joints.size(); ++i)
    {
      const double limit = arm.joints[i].speed_limit;
      const double speed =
          greatestSpeed(points[k - 1].joints[i], points[k].joints[i], points[k].time - points[k - 1].time);
      // With this form of the comparison, a speed that is NaN is an error.
      if (limit > 0.0 && !(speed <= limit * (1.0 + SPEED_TOLERANCE)))
      {
        return arm.joints[i].name + " would reach " + roundedText(speed, 3) + " rad/s between the set point at " +
               roundedText(points[k].time, 4) + " s and the point before; its limit is " + roundedText(limit, 4) +
               " rad/s";
      }
    }
  }
  return {};
}
}  // namespace

std::vector<ArmSetPoint> stopFrom(const std::vector<JointMotion>& present)
{
  // largest deceleration of the fastest joint, twice that of the gentle motion [rad/s^2]
  constexpr double ACCELERATION = 4.0;
  constexpr double SHORTEST = 0.2;  // least time until all joints rest [s]
  double fastest = 0.0;
  for (const JointMotion& joint : present)
  {
    fastest = std::max(fastest, std::abs(joint.velocity));
  }
  const double length = std::max(2.0 * fastest / ACCELERATION, SHORTEST);
  std::vector<ArmSetPoint> points{ { 0.0, present }, { length, {} } };
  std::transform(present.begin(), present.end(), std::back_inserter(points.back().joints),
                 [&](const JointMotion& joint) { return restOf(joint, length); });
  return points;
}

std::string jointErrors(const JointTrajectory& message, const ArmDescription& arm)
{
  std::vector<std::size_t> places;
  return placesOf(message, arm, places);
}

std::string readTrajectory(const JointTrajectory& message, const ArmDescription& arm,
                           const std::vector<JointMotion>& present, double delay, std::vector<ArmSetPoint>& points)
{
  std::vector<std::size_t> places;
  if (std::string errors = placesOf(message, arm, places); !errors.empty())
  {
    return errors;
  }
  points.assign(1, { 0.0, present });
  std::vector<JointMotion> rest = present;  // set points of the joints that the message does not name
  for (const JointTrajectoryPoint& point : message.points)
  {
    const std::string place = "points[" + std::to_string(&point - message.points.data()) + "]: ";
    const std::string errors = sizeErrors(point, message.joint_names.size());
    if (!errors.empty())
    {
      return place + errors;
    }
    ArmSetPoint set_point{ delay + point.time_from_start.toSec(), {} };
    double farthest = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      rest[i] = points.size() == 1 ? restOf(present[i], std::max(set_point.time, 0.0)) : rest[i];
      set_point.joints.push_back(places[i] == NOT_NAMED ?
                                     rest[i] :
                                     JointMotion{ point.positions[places[i]],
                                                  point.velocities.empty() ? 0.0 : point.velocities[places[i]], 0.0 });
      farthest = std::max(farthest, std::abs(set_point.joints[i].position - points.back().joints[i].position));
    }
    if (set_point.time <= points.back().time)
    {
      if (points.size() == 1 && set_point.time == 0.0 && farthest <= SAME_PLACE)
      {
        continue;
      }
      return place + "time_from_start = " + numberText(point.time_from_start.toSec()) + " s" +
             (points.size() == 1 ?
                  ", but the point is " + roundedText(farthest, 3) + " rad from the arm's present position" :
                  " is not after the point before");
    }
    points.push_back(set_point);
  }
  if (points.size() == 1)
  {
    return "the trajectory does not move the arm";
  }
  fillVelocities(message, places, points);
  const auto is_moving = [](const JointMotion& joint) { return joint.velocity != 0.0; };
  if (std::any_of(points.back().joints.begin(), points.back().joints.end(), is_moving))
  {
    return "the trajectory does not end at rest";
  }
  const std::string errors = motionErrors(points, arm);
  return errors.empty() ? speedErrors(points, arm) : errors;
}
}  // namespace hjt
