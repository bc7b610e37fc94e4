// SPDX-License-Identifier: BSD-3-Clause
#include "arm/check_up.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/number_text.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double DEGREE = TWO_PI / 360.0;
constexpr double ACCELERATION = 300.0 * DEGREE;  // moderate: 17 N.m at a stretched UR5 [rad/s^2]
constexpr double REST = 0.5;                     // before and after [s]
constexpr std::size_t MAX_INSTANTS = 450'000;    // an hour at a controller's 125 Hz
constexpr double LIMIT_SHARE = 5.0 / 6.0;        // of the joint's speed limit that a stroke takes at most [-]

/// To an angle about the pose.
struct Stroke
{
  double angle;  // [deg]
  double speed;  // [deg/s]
};
constexpr std::array<Stroke, 16> STROKES{ {
    // Slow, all of the load's range, 42 motor turns each way.
    { 75.0, 20.0 },
    { -75.0, 20.0 },
    { 0.0, 20.0 },
    // Reversals about no load.
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    // Fast: a lobe over a place of the flexspline up to 84 times a second, where the joint can.
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 0.0, 150.0 },
} };

/// Trapezoid over a distance of one.
class Trapezoid
{
public:
  Trapezoid(double distance, double speed, double acceleration)
    : distance_(distance)
    , acceleration_(acceleration)
    , rise_(std::min(speed, std::sqrt(distance * acceleration)) / acceleration)
    , end_(distance / (acceleration * rise_) + rise_)
  {
  }

  double duration() const { return end_; }

  /// Shares of the distance.
  JointMotion at(double time) const
  {
    const double peak = acceleration_ * rise_;
    const double left = end_ - time;
    JointMotion motion{ (time - 0.5 * rise_) * peak, peak, 0.0 };
    if (time < rise_)
    {
      motion = { 0.5 * acceleration_ * time * time, acceleration_ * time, acceleration_ };
    }
    else if (left < rise_)
    {
      motion = { distance_ - 0.5 * acceleration_ * left * left, acceleration_ * left, -acceleration_ };
    }
    return { motion.position / distance_, motion.velocity / distance_, motion.acceleration / distance_ };
  }

private:
  double distance_;
  double acceleration_;
  double rise_;
  double end_;
};

void requireWithin(const ArmDescription& arm, const ArmInstant& instant)
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const ArmJoint& joint = arm.joints[i];
    const auto refuse = [&](const char* what, double value, double limit, const char* unit)
    {
      // Written so that NaN fails.
      if (!(std::abs(value) <= limit * (1.0 + 1e-9)))
      {
        throw ParameterError(arm.origin + ": " + joint.name + " would have a " + what + " of " +
                             std::to_string(std::abs(value)) + " " + unit + " in the check-up, its limit is " +
                             std::to_string(limit));
      }
    };
    refuse("speed", instant.joints[i].velocity, joint.speed_limit, "[rad/s]");
    refuse("torque", instant.torques[i], joint.torque_limit, "[N.m]");
  }
}
}  // namespace

std::vector<ArmMove> checkUpMoves(const ArmDescription& arm, std::size_t joint)
{
  const ArmJoint& own = arm.joints[joint];
  if (own.check_up.empty())
  {
    throw ParameterError(arm.origin + ": joint " + own.name + " has no check_up, the angles where it begins");
  }
  for (const ArmJoint& each : arm.joints)
  {
    if (each.speed_limit == 0.0 || each.torque_limit == 0.0)
    {
      throw ParameterError(arm.origin + ": joint " + each.name + " has no limits, within which a check-up stays");
    }
  }
  std::vector<ArmMove> moves;
  for (const Stroke& stroke : STROKES)
  {
    moves.push_back({ own.check_up, std::min(stroke.speed * DEGREE, LIMIT_SHARE * own.speed_limit), ACCELERATION });
    moves.back().target[joint] += stroke.angle * DEGREE;
  }
  return moves;
}

std::vector<ArmInstant> sampleMoves(const ArmDescription& arm, const ArmPose& start, const std::vector<ArmMove>& moves,
                                    double period)
{
  ArmDynamics dynamics(arm);
  std::vector<ArmInstant> instants;
  const std::size_t joints = arm.joints.size();
  ArmPose from = start;
  const auto add = [&](const ArmPose& target, const JointMotion& share)
  {
    ArmInstant instant;
    instant.time = static_cast<double>(instants.size()) * period;
    instant.torques.resize(joints);
    for (std::size_t i = 0; i < joints; ++i)
    {
      const double way = target[i] - from[i];
      instant.joints.push_back({ from[i] + way * share.position, way * share.velocity, way * share.acceleration });
    }
    dynamics.torques(instant.joints, instant.torques);
    requireWithin(arm, instant);
    instants.push_back(instant);
  };
  double begin = REST;  // of the move
  const auto add_until = [&](double end, const auto& motion, const ArmPose& target)
  {
    for (double time = 0.0; (time = static_cast<double>(instants.size()) * period) < end;)
    {
      add(target, motion(time));
    }
  };
  add_until(
      REST, [](double) { return JointMotion{}; }, from);
  for (const ArmMove& move : moves)
  {
    double distance = 0.0;
    for (std::size_t i = 0; i < joints; ++i)
    {
      distance = std::max(distance, std::abs(move.target[i] - from[i]));
    }
    if (distance > 0.0)
    {
      const Trapezoid trapezoid(distance, move.speed, move.acceleration);
      if (begin + trapezoid.duration() > static_cast<double>(MAX_INSTANTS) * period)
      {
        throw ParameterError(arm.origin + ": the check-up would take more than " +
                             roundedText(static_cast<double>(MAX_INSTANTS) * period, 4) + " s: it moves at " +
                             roundedText(move.speed, 3) + " rad/s, by the limits of the joints' speed");
      }
      add_until(
          begin + trapezoid.duration(), [&](double time) { return trapezoid.at(time - begin); }, move.target);
      begin += trapezoid.duration();
    }
    from = move.target;
  }
  add_until(
      begin + REST, [](double) { return JointMotion{}; }, from);
  return instants;
}
}  // namespace hjt
