// SPDX-License-Identifier: BSD-3-Clause
#include "arm/check_up.hpp"

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
constexpr double ACCELERATION = 300.0 * DEGREE;  // moderate: 17 N.m at a stretched UR5 [rad/s^2]
constexpr double REST = 0.5;                     // before and after [s]
constexpr std::size_t MAX_INSTANTS = 450'000;    // an hour at a controller's 125 Hz
constexpr double LIMIT_SHARE = 5.0 / 6.0;        // largest share of the joint's speed limit in a stroke [-]

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

/// Share of a distance over time: the speed a trapezoid, or its mean over the time in which its acceleration comes.
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
      // Where nothing lies between the two accelerations, their mean goes from the one to the other.
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

  /// Integral of the trapezoid's position, which is odd about its middle.
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
  double end_;     // of the trapezoid
  double mean_{};  // time over which it is taken [s]
};

void requireWithin(const ArmDescription& arm, const ArmInstant& instant)
{
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    const ArmJoint& joint = arm.joints[i];
    const auto refuse = [&](const char* what, double value, double limit, const char* unit)
    {
      // Written so that NaN fails.
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
/// Takes moves one after the other.
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
    // Written so that NaN fails.
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
  double begin_{};  // of the next piece [s]
  std::vector<ArmInstant> instants_;
};
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
