// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/number_text.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
constexpr double ACCELERATION = 300.0 * DEGREE;  // acceleration in a stroke: 17 N.m for a stretched UR5 [rad/s^2]
constexpr double REST = 0.5;                     // time at rest before and after the moves [s]
constexpr std::size_t MAX_INSTANTS = 450'000;    // largest number of instants, those of an hour at 125 Hz
constexpr double LIMIT_SHARE = 5.0 / 6.0;        // largest share of the joint's speed limit in a stroke [-]

/// A stroke moves the joint to an angle, relative to the pose in which its check-up begins.
struct Stroke
{
  double angle;  // angle at the end of the stroke [deg]
  double speed;  // largest speed [deg/s]
};
constexpr std::array<Stroke, 16> STROKES{ {
    // Slow strokes over the whole range of the joint's load, with 42 turns of the motor in each direction.
    { 75.0, 20.0 },
    { -75.0, 20.0 },
    { 0.0, 20.0 },
    // Strokes that reverse where the joint's load is near zero.
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    { 20.0, 60.0 },
    { -20.0, 60.0 },
    // Fast strokes: a lobe passes a place of the flexspline up to 84 times a second, if the joint can turn so fast.
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 55.0, 150.0 },
    { -55.0, 150.0 },
    { 0.0, 150.0 },
} };

/// Share of a distance that a move has covered, over time [-]. The speed over time is that of ArmMove.
class Profile
{
public:
  Profile(double distance, const ArmMove& move)
    : distance_(distance)
    , acceleration_(move.acceleration)
    , rise_(std::min(move.speed, std::sqrt(distance * acceleration_)) / acceleration_)
    , end_(distance / (acceleration_ * rise_) + rise_)
  {
    if (move.jerk > 0.0)
    {
      // Without a phase of constant speed the acceleration changes directly from its largest to its smallest value.
      // This change takes twice the time of a change from 0.
      const double once = acceleration_ / move.jerk;
      mean_ = end_ - 2.0 * rise_ >= once ? once : 2.0 * once;
    }
  }

  double duration() const { return end_ + mean_; }

  JointMotion at(double time) const
  {
    JointMotion motion = trapezoid(time);
    if (mean_ > 0.0)
    {
      const JointMotion before = trapezoid(time - mean_);
      motion = { (travelled(time) - travelled(time - mean_)) / mean_, (motion.position - before.position) / mean_,
                 (motion.velocity - before.velocity) / mean_ };
    }
    return { motion.position / distance_, motion.velocity / distance_, motion.acceleration / distance_ };
  }

private:
  JointMotion trapezoid(double time) const
  {
    const double peak = acceleration_ * rise_;
    const double left = end_ - time;
    if (time <= 0.0 || left <= 0.0)
    {
      return { time <= 0.0 ? 0.0 : distance_, 0.0, 0.0 };
    }
    if (time < rise_)
    {
      return { 0.5 * acceleration_ * time * time, acceleration_ * time, acceleration_ };
    }
    if (left < rise_)
    {
      return { distance_ - 0.5 * acceleration_ * left * left, acceleration_ * left, -acceleration_ };
    }
    return { (time - 0.5 * rise_) * peak, peak, 0.0 };
  }

  /// Integral over time of the position on the trapezoid. The position is point-symmetric about the middle of the move.
  double travelled(double time) const
  {
    const auto risen = [&](double t) { return acceleration_ * t * t * t / 6.0; };
    if (time > 0.5 * end_)
    {
      return distance_ * (time - 0.5 * end_) + travelled(end_ - time);
    }
    const double cruised = std::max(time - rise_, 0.0);
    return time <= 0.0 ? 0.0 : risen(std::min(time, rise_)) + 0.5 * acceleration_ * rise_ * cruised * (rise_ + cruised);
  }

  double distance_;
  double acceleration_;
  double rise_;
  double end_;     // time at which the trapezoid ends [s]
  double mean_{};  // length of the moving mean of the speed; 0: no mean [s]
};

void requireWithin(const ArmDescription& arm, const ArmInstant& instant)
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const ArmJoint& joint = arm.joints[i];
    const auto refuse = [&](const char* what, double value, double limit, const char* unit)
    {
      // The negated comparison is true for NaN, so NaN is refused.
      if (limit != 0.0 && !(std::abs(value) <= limit * (1.0 + 1e-9)))
      {
        throw ParameterError(arm.origin + ": " + joint.name + " would have a " + what + " of " +
                             std::to_string(std::abs(value)) + " " + unit + " at " + numberText(instant.time) +
                             " s of the motion, its limit is " + std::to_string(limit));
      }
    };
    refuse("speed", instant.joints[i].velocity, joint.speed_limit, "[rad/s]");
    refuse("torque", instant.torques[i], joint.torque_limit, "[N.m]");
  }
}
/// Samples a list of moves, one move after the other.
class Sampler
{
public:
  Sampler(const ArmDescription& arm, ArmPose start, double period)
    : arm_(arm), dynamics_(arm), from_(std::move(start)), period_(period)
  {
  }

  void rest(double time)
  {
    addUntil(begin_ + time, "it rests for " + numberText(time) + " s", from_, [](double) { return JointMotion{}; });
  }

  void add(const ArmMove& move)
  {
    double distance = 0.0;
    for (std::size_t i = 0; i < from_.size(); ++i)
    {
      distance = std::max(distance, std::abs(move.target[i] - from_[i]));
    }
    if (distance > 0.0)
    {
      const Profile profile(distance, move);
      addUntil(begin_ + profile.duration(), "it moves at " + roundedText(move.speed, 3) + " rad/s", move.target,
               [&, begin = begin_](double time) { return profile.at(time - begin); });
    }
    from_ = move.target;
    rest(move.wait);
  }

  std::vector<ArmInstant> take() { return std::move(instants_); }

private:
  template <class Share>
  void addUntil(double end, const std::string& what, const ArmPose& target, const Share& share)
  {
    const double longest = static_cast<double>(MAX_INSTANTS) * period_;
    // The negated comparison is true for NaN, so NaN is refused.
    if (!(end < longest))
    {
      throw ParameterError(arm_.origin + ": the motion would take more than " + roundedText(longest, 4) +
                           " s: " + what);
    }
    for (double time = 0.0; (time = static_cast<double>(instants_.size()) * period_) < end;)
    {
      addInstant(time, target, share(time));
    }
    begin_ = end;
  }

  void addInstant(double time, const ArmPose& target, const JointMotion& share)
  {
    ArmInstant instant;
    instant.time = time;
    instant.torques.resize(from_.size());
    for (std::size_t i = 0; i < from_.size(); ++i)
    {
      const double way = target[i] - from_[i];
      instant.joints.push_back({ from_[i] + way * share.position, way * share.velocity, way * share.acceleration });
    }
    dynamics_.torques(instant.joints, instant.torques);
    requireWithin(arm_, instant);
    instants_.push_back(instant);
  }

  const ArmDescription& arm_;
  ArmDynamics dynamics_;
  ArmPose from_;
  double period_;
  double begin_{};  // time at which the next move or rest begins [s]
  std::vector<ArmInstant> instants_;
};
}  // namespace

void ArmMotion::goOn(double time, const std::vector<JointMotion>& joints) noexcept
{
  // A set point at the time of the last set point replaces the last set point.
  if (goes_on_ && time > end())
  {
    std::swap(points_[0], points_[1]);
  }
  goes_on_ = true;
  points_[1].time = time;
  points_[1].joints = joints;
}

void ArmMotion::at(double time, std::vector<JointMotion>& motion) noexcept
{
  if (repeats_ && time > end())
  {
    time = begin() + std::fmod(time - begin(), end() - begin());
  }
  if (time <= begin() || time >= end())
  {
    const ArmSetPoint& point = time <= begin() ? points_.front() : points_.back();
    const bool moves = goes_on_ || time == point.time;
    for (std::size_t i = 0; i < motion.size(); ++i)
    {
      motion[i] = moves ? point.joints[i] : JointMotion{ point.joints[i].position, 0.0, 0.0 };
    }
    return;
  }
  last_ = points_[last_].time > time ? 0 : last_;
  while (points_[last_ + 1].time <= time)
  {
    ++last_;
  }
  const ArmSetPoint& from = points_[last_];
  const ArmSetPoint& to = points_[last_ + 1];
  const double length = to.time - from.time;
  const double s = (time - from.time) / length;
  for (std::size_t i = 0; i < motion.size(); ++i)
  {
    const JointMotion& a = from.joints[i];
    const JointMotion& b = to.joints[i];
    const double way = b.position - a.position;
    // Hermite's cubic, which has the angles and speeds of both set points at its ends.
    const double c2 = 3.0 * way - length * (2.0 * a.velocity + b.velocity);
    const double c3 = length * (a.velocity + b.velocity) - 2.0 * way;
    motion[i].position = a.position + s * (length * a.velocity + s * (c2 + s * c3));
    motion[i].velocity = a.velocity + s * (2.0 * c2 + 3.0 * s * c3) / length;
    motion[i].acceleration = accelerations_ == ArmAccelerations::GIVEN ?
                                 a.acceleration + s * (b.acceleration - a.acceleration) :
                                 (2.0 * c2 + 6.0 * s * c3) / (length * length);
  }
}

std::vector<ArmSetPoint> fromRest(const ArmSetPoint& point)
{
  constexpr double STILL = 1e-3;        // largest speed of a joint at rest [rad/s]
  constexpr double ACCELERATION = 2.0;  // mean acceleration of the fastest joint [rad/s^2]
  constexpr double SHORTEST = 0.2;      // least duration of the path [s]
  constexpr std::size_t STEPS = 32;
  double fastest = 0.0;
  for (const JointMotion& joint : point.joints)
  {
    fastest = std::max(fastest, std::abs(joint.velocity));
  }
  if (fastest <= STILL)
  {
    return { point };
  }
  const double length = std::max(fastest / ACCELERATION, SHORTEST);
  std::vector<ArmSetPoint> points(STEPS + 1, point);
  for (std::size_t k = 0; k < STEPS; ++k)
  {
    // The speed is a cubic of s, the elapsed share of the path's time: rest at s = 0, the speed of `point` at s = 1.
    const double s = static_cast<double>(k) / static_cast<double>(STEPS);
    points[k].time = point.time - (1.0 - s) * length;
    for (std::size_t i = 0; i < point.joints.size(); ++i)
    {
      const double speed = point.joints[i].velocity;
      const double bend = length * point.joints[i].acceleration;
      JointMotion& joint = points[k].joints[i];
      joint.velocity = s * s * (speed * (3.0 - 2.0 * s) + bend * (s - 1.0));
      joint.acceleration = s * (6.0 * speed * (1.0 - s) + bend * (3.0 * s - 2.0)) / length;
      joint.position -=
          length * (0.5 * speed - bend / 12.0 - s * s * s * (speed * (1.0 - 0.5 * s) + bend * (0.25 * s - 1.0 / 3.0)));
    }
  }
  return points;
}

std::vector<ArmSetPoint> toRest(const ArmSetPoint& point)
{
  // The path to rest is the path from rest, backwards in time.
  const auto turned = [&](ArmSetPoint at)
  {
    at.time = 2.0 * point.time - at.time;
    for (JointMotion& joint : at.joints)
    {
      joint.velocity = -joint.velocity;
    }
    return at;
  };
  std::vector<ArmSetPoint> points = fromRest(turned(point));
  std::transform(points.begin(), points.end(), points.begin(), turned);
  std::reverse(points.begin(), points.end());
  return points;
}

ArmMotion gentleMotion(const ArmDescription& arm)
{
  constexpr double ACCELERATION = 2.0;             // acceleration of the joint that moves farthest [rad/s^2]
  constexpr std::array SPEEDS{ 0.35, 0.7, 1.05 };  // speed of the joint that moves farthest [rad/s]
  constexpr std::array WAYS{ 0.6, 0.4, -0.6, 0.5, -0.55, 0.6 };  // distance of each joint from the middle pose [rad]
  constexpr double PERIOD = 0.008;                               // time between set points [s]
  const std::size_t joints = arm.joints.size();
  const bool is_known =
      std::all_of(arm.joints.begin(), arm.joints.end(),
                  [](const ArmJoint& joint) { return joint.speed_limit > 0.0 && joint.torque_limit > 0.0; });
  const std::vector<double>& middle = arm.joints[std::min<std::size_t>(1, joints - 1)].check_up;
  if (!is_known || middle.empty())
  {
    return ArmMotion(std::vector<ArmSetPoint>{ { 0.0, std::vector<JointMotion>(joints) } });
  }
  std::vector<ArmMove> moves;
  for (const double speed : SPEEDS)
  {
    for (const double side : { 1.0, -1.0, 0.0 })
    {
      moves.push_back({ middle, speed, ACCELERATION });
      for (std::size_t i = 0; i < joints; ++i)
      {
        moves.back().target[i] += side * WAYS[i % WAYS.size()];
      }
    }
  }
  const std::vector<ArmInstant> instants = sampleMoves(arm, middle, moves, PERIOD);
  return ArmMotion(std::vector<ArmSetPoint>(instants.begin(), instants.end()), ArmAccelerations::GIVEN, true);
}

std::vector<ArmMove> checkUpMoves(const ArmDescription& arm, std::size_t joint)
{
  const ArmJoint& own = arm.joints[joint];
  if (own.check_up.empty())
  {
    throw ParameterError(arm.origin + ": joint " + own.name +
                         " has no check_up: the angles of all joints at the start of its check-up");
  }
  for (const ArmJoint& each : arm.joints)
  {
    if (each.speed_limit == 0.0 || each.torque_limit == 0.0)
    {
      throw ParameterError(arm.origin + ": joint " + each.name +
                           " has no limits of speed and torque, which a check-up must respect");
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
  Sampler sampler(arm, start, period);
  sampler.rest(REST);
  for (const ArmMove& move : moves)
  {
    sampler.add(move);
  }
  sampler.rest(REST);
  return sampler.take();
}
}  // namespace hjt
