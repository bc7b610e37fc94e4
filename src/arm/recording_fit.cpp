// SPDX-License-Identifier: BSD-3-Clause
#include "arm/recording_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "params/choices.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
constexpr double FASTEST = 10.0;      // speed that no joint of an arm exceeds [rad/s]
constexpr double FACTOR_OFF = 0.03;   // least deviation of a factor that counts; scales of encoders deviate less [-]
constexpr double DEVIATIONS = 3.0;    // least significant difference, in standard deviations [-]
constexpr double WIDE = 2.0;          // largest factor on the currents that a wrong payload or gain causes [-]
constexpr double WIDEST_FACTOR = 20;  // largest factor from stamps in seconds; a larger one shows another unit [-]
constexpr double LAG_OFF = 0.05;      // least lag of the velocity behind the angle that counts [s]
constexpr std::uint64_t MIN_ROWS = 100;
constexpr double UNCHANGED = 2.0;       // longest motion in which a measured current stays constant [s]
constexpr double LEAST_SQUARE = 1e-12;  // least assumed square of an uncertainty; simulated data may have none

/// Text on the lag of currents behind the motion [s], for example "0.2 s later". `longest`: longest tried lag [s].
std::string lagText(double lag, double longest)
{
  const bool is_longest = std::abs(lag) > longest - 0.5 * CurrentLag::SPACING;
  return roundedText(std::abs(lag), 2) + " s " + (is_longest ? "or more " : "") + (lag > 0.0 ? "later" : "earlier");
}

bool differs(const FittedFactor& factor, double from)
{
  return std::abs(factor.value - from) > std::max(FACTOR_OFF * std::abs(from), DEVIATIONS * factor.uncertainty);
}

/// Whether neither gains of one type nor payloads with which joints can be judged cause this factor on the currents.
bool isOtherLoad(const FittedFactor& factor)
{
  constexpr double OTHER = 1.7;
  constexpr double SURE = 2.0;  // standard deviations; few, because a missing verdict gives no false alarm
  return std::abs(std::log(std::max(factor.value, 1e-3))) >
         std::log(OTHER) + SURE * factor.uncertainty / std::max(factor.value, 1e-3);
}

std::string rounded(double value)
{
  return roundedText(value, 3);
}

/// Describes how angle and velocity of one joint contradict each other. `own`: change of the joint's angle over the
/// integral of its velocity [-]. `of_stamps`: the same factor in most joints, which wrong stamps cause.
RecordingFinding velocityFinding(const FittedFactor& own, double of_stamps)
{
  constexpr double STANDS = 0.01;
  if (std::isinf(own.value))
  {
    return { "velocity_zero", "zero velocity; the angles give it", std::nullopt };
  }
  if (own.value < -STANDS)
  {
    return { "velocity_sign", "angle and velocity differ in sign", Reason::VELOCITY_SIGN };
  }
  if (std::abs(own.value / DEGREE - 1.0) < FACTOR_OFF)
  {
    return { "velocity_unit", "velocity in deg/s; the angles give it", std::nullopt };
  }
  if (own.value < STANDS)
  {
    return { "velocity_scale", "the angle stands still while the velocity says that the joint moves",
             Reason::VELOCITY_SCALE };
  }
  return { "velocity_scale", "the angle changes " + rounded(own.value / of_stamps) + " times the velocity",
           Reason::VELOCITY_SCALE };
}
}  // namespace

double likelyTimeScale(double period)
{
  constexpr double FASTEST_ROWS = 0.5e-3;  // least time between rows of a robot [s]
  constexpr double LONG = 0.5;             // time between rows from which on stamps are not in seconds [s]
  if (period < LONG)
  {
    return 1.0;
  }
  double scale = 1e-3;
  while (scale * period > SLOW_ROWS)
  {
    scale *= 1e-3;
  }
  return scale * period > FASTEST_ROWS ? scale : 1.0;
}

const char* effortUnitName(EffortUnit unit)
{
  switch (unit)
  {
    case EffortUnit::CURRENT:
      break;
    case EffortUnit::JOINT_TORQUE:
      return "a torque at the joint in N.m";
    case EffortUnit::MOTOR_TORQUE:
      return "a torque of the motor in N.m";
  }
  return "the motor's current in A";
}

const char* effortKeyword(EffortUnit unit)
{
  const auto names = choiceNames(unit);
  return std::find_if(names.begin(), names.end(), [&](const auto& name) { return name.second == unit; })->first;
}

RecordingFit::RecordingFit(const std::vector<Parameters>& joints)
{
  for (const Parameters& parameters : joints)
  {
    Joint joint;
    joint.ratio = RatioFit(nominalRatio(parameters.gear));
    joint.gain = parameters.telemetry.torque_per_current;
    joint.effort = parameters.telemetry.effort;
    for (const auto& [name, unit] : choiceNames(EffortUnit()))
    {
      joint.current_per_effort.push_back(currentPerEffort(unit, parameters));
    }
    joints_.push_back(joint);
  }
}

void RecordingFit::reset() noexcept
{
  for (Joint& joint : joints_)
  {
    joint.time.reset();
    joint.ratio.reset();
    joint.lag.reset();
    joint.reach = JointReach();
    joint.moving_rows = 0;
    joint.fast_rows = 0;
    joint.unchanged = 0.0;
  }
  last_time_ = std::numeric_limits<double>::quiet_NaN();
  moving_ = 0.0;
  slow_time_ = 0.0;
  slow_rows_ = 0;
  rows_ = 0;
}

void RecordingFit::update(const std::vector<MotionSample>& joints, const std::vector<double>& torques) noexcept
{
  const double step = joints.front().time - last_time_;
  last_time_ = joints.front().time;
  bool moves = false;
  const bool follows = step > 0.0 && step <= MotionDifferentiator::MAX_GAP;
  ++rows_;
  if (step > SLOW_ROWS)
  {
    slow_time_ += step;
    ++slow_rows_;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    Joint& joint = joints_[i];
    const MotionSample& sample = joints[i];
    JointReach& reach = joint.reach;
    ++reach.rows;
    reach.least_angle = std::min(reach.least_angle, sample.position);
    reach.most_angle = std::max(reach.most_angle, sample.position);
    reach.least_speed = std::min(reach.least_speed, sample.velocity);
    reach.most_speed = std::max(reach.most_speed, sample.velocity);
    reach.least_current = std::min(reach.least_current, sample.current);
    reach.most_current = std::max(reach.most_current, sample.current);
    const bool joint_moves = std::abs(sample.velocity) > MotionDifferentiator::MOVING;
    moves = moves || joint_moves;
    joint.moving_rows += joint_moves ? 1 : 0;
    joint.fast_rows += std::abs(sample.velocity) > FASTEST ? 1 : 0;
    joint.time.add(sample.time, sample.position, sample.recorded_velocity);
    joint.ratio.add(sample);
    joint.unchanged =
        sample.current != joint.last_current ? 0.0 : joint.unchanged + (follows && joint_moves ? step : 0.0);
    joint.last_current = sample.current;
    if (std::isfinite(torques[i]))
    {
      joint.lag.add(sample, torques[i] / joint.gain);
    }
  }
  moving_ += follows && moves ? step : 0.0;
}

std::vector<FittedFactor> RecordingFit::timeFactors() const
{
  std::vector<FittedFactor> factors;
  for (const Joint& joint : joints_)
  {
    factors.push_back(joint.time.factor());
  }
  return factors;
}

FittedFactor RecordingFit::stampFactor() const
{
  std::vector<double> likely;
  for (const FittedFactor& factor : timeFactors())
  {
    if (factor.value > 1.0 / WIDEST_FACTOR && factor.value < WIDEST_FACTOR)
    {
      likely.push_back(factor.value);
    }
  }
  if (likely.empty())
  {
    return {};
  }
  FittedFactor middle{ upperMedian(likely.begin(), likely.end()), 0.0 };
  std::size_t agree = 0;
  double weights = 0.0;
  for (const FittedFactor& factor : timeFactors())
  {
    if (std::isfinite(factor.value) && !differs(factor, middle.value))
    {
      ++agree;
      weights += 1.0 / std::max(LEAST_SQUARE, factor.uncertainty * factor.uncertainty);
    }
  }
  middle.uncertainty = std::sqrt(1.0 / weights);
  return 2 * agree > likely.size() ? middle : FittedFactor();
}

/// Finding on rows that are too far apart, or on stamps that contradict angles and velocities.
std::optional<RecordingFinding> RecordingFit::ofTimes() const
{
  constexpr std::uint64_t FEW_ROWS = 10;
  if (rows_ >= FEW_ROWS && 2 * slow_rows_ > rows_)
  {
    const double period = slow_time_ / static_cast<double>(slow_rows_);
    return RecordingFinding{ "period",
                             "by their stamps the rows are " + rounded(period) + " s apart (" + rounded(1.0 / period) +
                                 " Hz), more than " + rounded(SLOW_ROWS) + " s: accelerations and loads are unknown" +
                                 (likelyTimeScale(period) < 1.0 ? ", or the stamps are of another unit (`joint_twin "
                                                                  "check` tries --time-scale on a recording)" :
                                                                  ""),
                             Reason::ROW_RATE };
  }
  const FittedFactor stamps = stampFactor();
  if (std::isfinite(stamps.value) && differs(stamps, 1.0))
  {
    const std::string factor = rounded(stamps.value);
    return RecordingFinding{ "stamps",
                             "by their stamps the angles change " + factor +
                                 " times as fast as the velocities say: times, accelerations and loads are wrong "
                                 "(`joint_twin check` tries --time-scale " +
                                 factor + " on a recording)",
                             Reason::STAMPS };
  }
  return std::nullopt;
}

/// Finding on currents that come earlier or later than their motion.
std::optional<RecordingFinding> RecordingFit::ofCurrents() const
{
  std::vector<std::array<double, CurrentLag::LAGS>> left;
  for (const Joint& joint : joints_)
  {
    left.push_back(joint.lag.left());
  }
  const double lag = commonLag(left);
  if (lag == 0.0)
  {
    return std::nullopt;
  }
  return RecordingFinding{ "current_lag",
                           "in most joints the currents come " + lagText(lag, CurrentLag::LONGEST) +
                               " than the motion that draws them: friction and load by these currents are wrong",
                           Reason::STAMPS };
}

EffortFit RecordingFit::effort() const
{
  constexpr double MAX_UNCERTAINTY = 1.0 / 3.0;  // largest uncertainty of the factor, as a share of the factor [-]
  EffortFit fit;
  fit.unit = joints_.front().effort;
  double weights = 0.0;
  double sum = 0.0;
  double squares = 0.0;
  const auto units = choiceNames(EffortUnit());
  std::vector<double> expected(units.size());
  for (const Joint& joint : joints_)
  {
    // The weight of a joint is its load. The certainty of its slope would be largest for a current that never changes.
    double weight = 0.0;
    const FittedFactor slope = joint.lag.now().slope(weight);
    if (!std::isfinite(slope.value) || joint.reach.least_current == joint.reach.most_current)
    {
      continue;
    }
    weights += weight;
    sum += weight * slope.value;
    squares += weight * weight * slope.uncertainty * slope.uncertainty;
    for (std::size_t unit = 0; unit < units.size(); ++unit)
    {
      // If the efforts have the unit number `unit`, the configured unit makes the currents too large by this factor.
      expected[unit] +=
          weight * joint.current_per_effort[static_cast<std::size_t>(joint.effort)] / joint.current_per_effort[unit];
    }
  }
  if (weights == 0.0 || std::sqrt(squares) > MAX_UNCERTAINTY * sum)
  {
    return fit;
  }
  fit.factor = { sum / weights, std::sqrt(squares) / weights };
  const auto distance = [&](EffortUnit unit)
  { return std::abs(std::log(fit.factor.value * weights / expected[static_cast<std::size_t>(unit)])); };
  fit.is_known = distance(fit.unit) < std::log(WIDE);
  for (const auto& [name, unit] : units)
  {
    if (!fit.is_known && distance(unit) < std::log(WIDE) && distance(unit) < distance(fit.unit) - std::log(WIDE))
    {
      fit.unit = unit;
      fit.is_known = true;
    }
  }
  return fit;
}

RecordingFit::LoadRest RecordingFit::loadRest(EffortUnit unit) const
{
  LoadRest sum;
  double seconds = 0.0;
  for (const Joint& joint : joints_)
  {
    const double scale = joint.current_per_effort[static_cast<std::size_t>(unit)] /
                         joint.current_per_effort[static_cast<std::size_t>(joint.effort)];
    const Eigen::Matrix2d left = joint.lag.now().left();
    sum.current += scale * scale * left(1, 1);
    sum.left += std::max(0.0, scale * scale * left(1, 1) - 2.0 * scale * left(0, 1) + left(0, 0));
    seconds += joint.lag.now().seconds();
  }
  return { std::sqrt(sum.current / seconds), std::sqrt(sum.left / seconds) };
}

std::vector<RecordingFinding> RecordingFit::ofArm() const
{
  constexpr double MIN_SHARE = 0.1;  // least fast rows over moving rows; jumps in a recording make fewer [-]
  const auto is_too_fast = [](const Joint& joint)
  { return static_cast<double>(joint.fast_rows) > static_cast<double>(MIN_ROWS) + MIN_SHARE * joint.moving_rows; };
  std::vector<RecordingFinding> findings;
  if (refusal_.exists())
  {
    findings.push_back({ "reading", refusal_.clause, refusal_.reason });
    return findings;
  }
  if (std::optional<RecordingFinding> times = ofTimes())
  {
    findings.push_back(std::move(*times));
    return findings;  // wrong times make the load wrong, so the findings below would be wrong too
  }
  if (std::any_of(joints_.begin(), joints_.end(), is_too_fast))
  {
    findings.push_back({ "angle_unit",
                         "the angles change by more than " + rounded(FASTEST) +
                             " rad/s: they are in degrees (convert them to rad), or the stamps are wrong",
                         Reason::ANGLE_UNIT });
  }
  if (std::optional<RecordingFinding> currents = ofCurrents())
  {
    findings.push_back(std::move(*currents));
  }
  constexpr double MILLI = 1000.0;
  const EffortFit found = effort();
  if (found.is_known && found.unit != joints_.front().effort)
  {
    findings.push_back({ "effort_unit",
                         std::string("the effort looks like ") + effortUnitName(found.unit) + ", not like " +
                             effortUnitName(joints_.front().effort) + ": set telemetry.effort: " +
                             effortKeyword(found.unit) + ", unless the arm is not the given one",
                         Reason::EFFORT_UNIT });
  }
  else if (std::isfinite(found.factor.value) && std::abs(std::log(found.factor.value / MILLI)) < std::log(WIDE))
  {
    findings.push_back({ "effort_unit",
                         std::string("the effort looks a thousand times too large for ") +
                             effortUnitName(joints_.front().effort) + ": divide it by 1000",
                         Reason::EFFORT_UNIT });
  }
  else if (std::isfinite(found.factor.value) &&
           (isOtherLoad(found.factor) || (!found.is_known && differs(found.factor, 1.0))))
  {
    findings.push_back({ "gain",
                         "the effort changes " + rounded(found.factor.value) +
                             " times as much with the load as telemetry.torque_per_current says. The reason is another "
                             "arm, gain, payload or mounting than configured",
                         isOtherLoad(found.factor) ? std::make_optional(Reason::LOAD_WRONG) : std::nullopt });
  }
  return findings;
}

bool RecordingFit::isMeasured(std::size_t joint) const
{
  return reach(joint).least_current != reach(joint).most_current && joints_[joint].unchanged <= UNCHANGED;
}

std::vector<bool> RecordingFit::measured() const
{
  std::vector<bool> all(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    all[i] = isMeasured(i);
  }
  return all;
}

std::vector<RecordingFinding> RecordingFit::ofJoint(std::size_t number) const
{
  const Joint& joint = joints_[number];
  std::vector<RecordingFinding> findings;
  if (joint.reach.rows < MIN_ROWS)
  {
    return findings;
  }
  if (!isMeasured(number))
  {
    findings.push_back({ "effort_constant",
                         joint.last_current == 0.0 ? "the effort is zero" : "the effort never changes",
                         Reason::EFFORT_CONSTANT });
  }
  if (const double late = ownLag(joint.lag.left()); late != 0.0)
  {
    findings.push_back({ "current_lag",
                         "current " + lagText(late, CurrentLag::LONGEST - CurrentLag::SPACING) + " than its motion",
                         Reason::STAMPS });
  }
  if (const std::string text = joint.ratio.text(); !text.empty())
  {
    findings.push_back({ "ratio", text, Reason::GEAR_RATIO });
  }
  const FittedFactor stamps = stampFactor();
  const double of_stamps = std::isfinite(stamps.value) ? stamps.value : 1.0;
  const FittedFactor own = joint.time.factor();
  const FittedFactor lag = joint.time.lag();
  if (!std::isnan(own.value) && !(std::isfinite(own.value) && !differs(own, of_stamps)))
  {
    findings.push_back(velocityFinding(own, of_stamps));
  }
  else if (std::isfinite(own.value) && std::isfinite(lag.value) &&
           std::abs(lag.value) > LAG_OFF + DEVIATIONS * lag.uncertainty)
  {
    findings.push_back(
        { "lag",
          "velocity " + rounded(std::abs(lag.value)) + " s " + (lag.value > 0.0 ? "after" : "before") + " the angle",
          Reason::VELOCITY_LAG });
  }
  if (!joint.time.hasVelocity())
  {
    findings.push_back({ "no_velocity", "no velocity; the angles give it", std::nullopt });
  }
  if (joint.reach.most_angle - joint.reach.least_angle < LEAST_MOTION)
  {
    findings.push_back({ "at_rest", "the joint does not move", std::nullopt });
  }
  return findings;
}

bool RecordingFit::isSettled() const
{
  const bool has_velocity =
      std::any_of(joints_.begin(), joints_.end(), [](const Joint& joint) { return joint.time.hasVelocity(); });
  const bool knows_stamps = !has_velocity || std::isfinite(stampFactor().value);
  return moving_ > PATIENCE || (knows_stamps && std::isfinite(effort().factor.value));
}

std::vector<Misfit> RecordingFit::whyNotJudged() const
{
  const auto first = [](const std::vector<RecordingFinding>& findings)
  {
    const auto stops = std::find_if(findings.begin(), findings.end(),
                                    [](const RecordingFinding& finding) { return finding.stops.has_value(); });
    return stops == findings.end() ? Misfit() : Misfit{ *stops->stops, stops->text };
  };
  const Misfit of_arm = first(ofArm());
  std::vector<Misfit> misfits;
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    misfits.push_back(of_arm.exists() ? of_arm : first(ofJoint(i)));
  }
  return misfits;
}
}  // namespace hjt
