// SPDX-License-Identifier: BSD-3-Clause
#include "arm/load_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/number_text.hpp"
#include "base/statistics.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
// Cost of a mounting other than configured, of a changing payload, or of a drag [-]: natural logarithm of how rare it
// is. In recordings of a UR5 and a UR10e with a constant payload, a changing payload lowers the cost of the fit by up
// to 8.
constexpr double OTHER_CAUSE = 10.0;
constexpr double TOLD = 1.0;    // largest half width by the rows alone with which a friction factor is known [-]
constexpr double FLOOR = 0.02;  // share of the currents of a real arm that no twin explains [-]

/// Cost of a fit that leaves the share `left` of the currents unexplained [-].
double misfitCost(double left)
{
  constexpr double COUNTED = 60.0;  // assumed number of independent rows; the error of a twin persists from row to row
  return COUNTED * std::log(std::hypot(left, FLOOR));
}
FoundDrag dragOf(const ArmEstimator::Estimate& estimate)
{
  return { estimate.drag.value, estimate.drag.half_width };
}

/// Whether something pushes the tip in each leg; empty: in no leg. A leg shows a push if its force across gravity is
/// far larger than that of most legs, because a payload has no force across gravity. If one leg shows a push, large
/// forces along gravity in the other legs count as pushes too. The force across gravity is up to 12 N, mostly 1 N, in
/// the legs of simulated days without a push, and 16 to 79 N in legs with a push of 60 N.
std::vector<bool> pushedLegs(const std::vector<ArmEstimator::Push>& pushes)
{
  constexpr double LEAST = 10.0;  // least force that counts as a push [N]
  constexpr double FAR_MORE = 6.0;
  std::vector<double> across;
  for (const ArmEstimator::Push& push : pushes)
  {
    across.push_back(push.across);
  }
  const double least = across.empty() ? LEAST : std::max(LEAST, FAR_MORE * medianOf(across));
  if (std::none_of(across.begin(), across.end(), [&](double push) { return push > least; }))
  {
    return {};
  }
  std::vector<bool> pushed(pushes.size());
  std::transform(pushes.begin(), pushes.end(), pushed.begin(), [&](const auto& push) { return push.size > least; });
  return pushed;
}
}  // namespace

LoadFit::Drive::Drive(const Parameters& parameters)
  : gain(parameters.telemetry.torque_per_current)
  , rotor(std::pow(nominalRatio(parameters.gear), 2) * Motor(parameters.motor).inertia())
  , temperature(parameters.input.temperature)
{
}

void LoadFit::Drive::setOwn(bool known, const std::vector<FrictionPoint>& points)
{
  const double ratio = FrictionPoints::ratioOf(points);
  is_own = known;
  friction = ratio > 0.0 ? ratio : 1.0;
}

LoadFit::LoadFit(const ArmDescription& arm, const std::vector<Drive>& drives)
  : payload_(arm.payload)
  , gravity_(arm.gravity.data())
  , unit_(arm)
  , torques_(static_cast<Eigen::Index>(drives.size()), UnitLoads::COLUMNS)
  , motion_(drives.size())
  , rows_(drives.size())
  , blocks_(drives.size())
{
  for (const Drive& drive : drives)
  {
    joints_.push_back({ drive });
  }
}

/// Begins a new leg when all joints stand still, or when the present leg has lasted 5 s.
void LoadFit::cutLegs(double time, double speed)
{
  constexpr double STOP = 0.2;  // time at rest that ends a leg [s]
  constexpr double SHORTEST = 1.0;
  constexpr double LONGEST = 5.0;
  if (legs_.empty())
  {
    legs_.push_back(time);
    return;
  }
  still_ = speed < MotionDifferentiator::MOVING ? still_ + std::clamp(time - last_time_, 0.0, BLOCK) : 0.0;
  const bool has_rows =
      std::any_of(rows_.begin(), rows_.end(),
                  [&](const auto& joint) { return !joint.empty() && joint.back().leg + 1 == legs_.size(); });
  const double lasted = time - legs_.back();
  if (has_rows && ((still_ > STOP && lasted > SHORTEST) || lasted > LONGEST))
  {
    legs_.push_back(time);
  }
  else if (!has_rows && speed < MotionDifferentiator::MOVING)
  {
    legs_.back() = time;
  }
}

void LoadFit::close(std::size_t joint, double time)
{
  Open& block = joints_[joint].open;
  if (block.count > 0 && time > block.begin + 0.5 * BLOCK && block.sum.load.allFinite() &&
      std::isfinite(block.sum.current) && std::isfinite(block.sum.predicted) && isDrawn(blocks_[joint]++, share_))
  {
    ArmEstimator::Row& row = rows_[joint].emplace_back(block.sum);
    const double share = 1.0 / static_cast<double>(block.count);
    for (double* part :
         { &row.current, &row.predicted, &row.friction, &row.cold, &row.torque, &row.inertia, &row.rise })
    {
      *part *= share;
    }
    row.load *= share;
    row.across *= share;
    row.time = block.begin;
  }
  block.count = 0;
}

/// A row is drawn if a fraction is below `share`. The fractions of multiples of the golden ratio are spread evenly.
bool LoadFit::isDrawn(std::size_t number, double share)
{
  constexpr double GOLDEN = 0.6180339887498949;
  const double turns = GOLDEN * static_cast<double>(number);
  return turns - std::floor(turns) < share;
}

/// Removes half of the rows if a joint has more than ENOUGH rows.
void LoadFit::thin()
{
  constexpr std::size_t ENOUGH = 6000;  // largest number of rows of a joint; ten minutes of motion give as many
  if (std::all_of(rows_.begin(), rows_.end(), [&](const auto& joint) { return joint.size() <= ENOUGH; }))
  {
    return;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    std::size_t row = 0;
    std::size_t kept = 0;
    for (std::size_t block = 0; block < blocks_[i]; ++block)
    {
      if (isDrawn(block, 0.5 * share_))
      {
        rows_[i][kept++] = rows_[i][row];
      }
      row += isDrawn(block, share_) ? 1 : 0;
    }
    rows_[i].resize(kept);
  }
  share_ *= 0.5;
}

/// Adds a sample to the open row of joint `number`. `torques`: torques at this joint by unit loads (UnitLoads).
void LoadFit::addTo(std::size_t number, const MotionSample& sample, const MotionDriven& twin,
                    const UnitLoads::Torques& torques)
{
  constexpr double COLDER = 10.0;     // by how much the drive of ArmEstimator::Row::cold is colder [K]
  constexpr double LEAST_LOAD = 0.1;  // least change of the load over which `rise` is computed [N.m]
  Joint& joint = joints_[number];
  const double gain = joint.drive.gain;
  const double own = joint.drive.friction;
  const double temperature = sample.temperatureOr(joint.drive.temperature);
  const MotionPrediction now = twin.at(temperature);
  ArmEstimator::Row& sum = joint.open.sum;
  sum.current += sample.current;
  sum.predicted += now.current + (own - 1.0) * now.friction_torque / gain;
  sum.load += torques.head<ArmEstimator::LOAD>() / gain;
  sum.across += torques.tail<2>() / gain;
  ++joint.open.count;
  joint.loads += sample.load * sample.load;
  joint.weights += torques[0] * torques[0];
  if (!isDrawn(blocks_[number], share_))
  {
    return;  // close() drops this block
  }
  const double of_mass = std::max(std::abs(torques[0]), LEAST_LOAD);
  const double most = std::abs(sample.load) + of_mass;
  const double least = std::max(std::abs(sample.load) - of_mass, 0.0);
  const auto friction_at = [&](double size) { return std::abs(twin.frictionAt(sample.velocity, size, temperature)); };
  sum.friction += own * now.friction_torque / gain;
  sum.cold += own * (twin.at(temperature - COLDER).friction_torque - now.friction_torque) / gain;
  sum.torque += sample.load / gain;
  sum.inertia += joint.drive.rotor * sample.acceleration / gain;
  sum.rise += own * (friction_at(most) - friction_at(least)) / (most - least);
}

void LoadFit::add(const std::vector<MotionSample>& samples, const TwinOf& twin)
{
  const double time = samples.front().time;
  const double step = time - last_time_;
  double speed = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    motion_[i] = { samples[i].position, samples[i].velocity, samples[i].acceleration };
    speed = std::max(speed, std::abs(samples[i].velocity));
  }
  cutLegs(time, speed);
  last_time_ = time;
  if (speed > MotionDifferentiator::SLIDING)
  {
    moved_ += step > 0.0 && step < BLOCK ? step : 0.0;
    unit_.torques(motion_, torques_);
  }
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const MotionSample& sample = samples[i];
    Open& block = joints_[i].open;
    const bool counts = std::abs(sample.velocity) > MotionDifferentiator::SLIDING && std::isfinite(sample.current) &&
                        twin(i).at(sample.temperatureOr(joints_[i].drive.temperature)).tellsFriction();
    if (sample.after_gap || !counts || sample.velocity * block.velocity < 0.0 || time > block.begin + BLOCK ||
        block.sum.leg + 1 != legs_.size())
    {
      close(i, time);
    }
    if (!counts)
    {
      continue;
    }
    if (block.count == 0)
    {
      block = { {}, 0, time, sample.velocity };
      block.sum.leg = legs_.size() - 1;
    }
    addTo(i, sample, twin(i), torques_.row(static_cast<Eigen::Index>(i)).transpose());
  }
  thin();
}

/// About `most` rows of each joint for which `counts` is true, evenly drawn, without the rows of pushed legs.
ArmEstimator::Rows LoadFit::rowsOf(const std::vector<bool>& counts, std::size_t most) const
{
  ArmEstimator::Rows rows(rows_.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const double share = static_cast<double>(most) / static_cast<double>(rows_[i].size());
    for (std::size_t k = 0; counts[i] && k < rows_[i].size(); ++k)
    {
      if (isDrawn(k, share) && !isPushed(rows_[i][k].leg))
      {
        rows[i].push_back(rows_[i][k]);
      }
    }
  }
  return rows;
}

/// Mass at the tip that adds 2 % to the load of one joint, rms: of the joint that a mass at the tip loads most [kg].
double LoadFit::ofLinks(const std::vector<bool>& counts) const
{
  constexpr double LINKS_SHARE = 0.02;
  double heaviest = 0.0;
  double mass = 0.0;
  for (std::size_t i = 0; i < joints_.size(); ++i)
  {
    if (counts[i] && joints_[i].weights > heaviest)
    {
      heaviest = joints_[i].weights;
      mass = LINKS_SHARE * std::sqrt(joints_[i].loads / joints_[i].weights);
    }
  }
  return mass;
}

IdentifiedPayload LoadFit::payloadOf(const ArmEstimator::Carried& beside, const ArmEstimator::Carried& half_width,
                                     double of_links) const
{
  constexpr double UNLOADED = 0.05;  // share of the links' mass; UR5 without a payload show up to 0.8 kg
  IdentifiedPayload found;
  found.configured = payload_;
  found.mass = payload_.mass + beside[0];
  found.mass_half_width = std::hypot(half_width[0], NORMAL_95 * of_links);
  found.least_claim = UNLOADED * unit_.linksMass();
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const auto at = static_cast<Eigen::Index>(1 + axis);
    found.moment[axis] = payload_.mass * payload_.centre[axis] + beside[at];
    found.moment_half_width[axis] = half_width[at];
  }
  return found;
}

IdentifiedMounting LoadFit::mountingOf(const ArmEstimator::Estimate& estimate) const
{
  const Eigen::Vector3d total = gravity_ + estimate.gravity;
  const Eigen::Vector3d direction = total / std::max(total.norm(), 1e-6);
  // Only errors of the gravity vector across its direction change this direction.
  const Eigen::Array3d across = (1.0 - direction.array().square()).max(0.0);
  IdentifiedMounting found;
  Eigen::Map<Eigen::Vector3d>(found.configured.data()) = gravity_;
  Eigen::Map<Eigen::Vector3d>(found.gravity.data()) = gravity_.norm() * direction;
  found.half_width =
      std::sqrt((estimate.gravity_half_width.array().square() * across).sum()) / std::max(total.norm(), 1e-6);
  found.size = total.norm() / std::max(gravity_.norm(), 1e-6);  // without configured gravity the size has no meaning
  return found;
}

/// Argument `repeats` of ArmEstimator(): relative standard deviation of each joint's friction in a sound joint [-].
std::vector<double> LoadFit::repeats() const
{
  std::vector<double> repeats;
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    double friction = 0.0;
    for (const ArmEstimator::Row& row : rows_[i])
    {
      friction += joints_[i].drive.gain * std::abs(row.friction) / static_cast<double>(rows_[i].size());
    }
    repeats.push_back(joints_[i].drive.is_own ? repeatOfOwn(friction) : HUGE_VAL);
  }
  return repeats;
}

/// The likeliest hypotheses by the rows of all legs in which nothing pushes the arm.
std::vector<LoadFit::Hypothesis> LoadFit::hypotheses(const std::vector<bool>& counts)
{
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    close(i, last_time_);
  }
  pushed_.clear();
  std::vector<Hypothesis> all = likeliest(counts);
  pushed_ = pushedLegs(all.front().found.pushes);
  return pushed_.empty() ? all : likeliest(counts);
}

/// Hypotheses that may explain the currents: first the likeliest, then those whose cost is at most OTHER_CAUSE larger.
std::vector<LoadFit::Hypothesis> LoadFit::likeliest(const std::vector<bool>& counts) const
{
  constexpr double LEAST_JUMP = 0.1;       // least change of the mass; rising friction looks like less [kg]
  constexpr std::size_t MOST_ROWS = 1500;  // largest number of rows of each joint
  const ArmEstimator estimator(rowsOf(counts, MOST_ROWS), gravity_, repeats());
  std::vector<Hypothesis> all;
  for (const ArmEstimator::Freedom& may :
       { ArmEstimator::Freedom{ false, true, false }, { true, true, false }, { false, false, true } })
  {
    for (ArmEstimator::Estimate& found : estimator.solve(may))
    {
      const ArmEstimator::Known jump{ found.jump[0], found.jump_half_width[0] };
      if ((!found.states.empty() && !jump.isBeyond(LEAST_JUMP)) || (may.drag && !dragOf(found).exists()))
      {
        continue;
      }
      const int causes = (may.mounting ? 1 : 0) + (may.drag ? 1 : 0) + (found.states.empty() ? 0 : 1);
      const double cost = found.cost + causes * OTHER_CAUSE;
      all.push_back({ std::move(found), may, cost });
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  const double most = all.front().cost + OTHER_CAUSE;
  all.erase(std::remove_if(all.begin(), all.end(), [&](const auto& of) { return of.cost > most; }), all.end());
  return all;
}

ArmEstimator::Estimate LoadFit::estimate(const std::vector<bool>& counts)
{
  return hypotheses(counts).front().found;
}

/// Friction of each joint. The likeliest hypothesis gives the friction factor: that of the joint alone, or that with
/// the common factors, whichever is nearer to 1. The interval spans the intervals of all hypotheses. If the likeliest
/// hypothesis has another mounting than the configured one, the friction is unknown, because the twins' friction is
/// that under a wrong load.
std::vector<FittedFriction> LoadFit::frictionsOf(const std::vector<Hypothesis>& all)
{
  std::vector<FittedFriction> frictions(all.front().found.own.size());
  for (std::size_t i = 0; i < frictions.size(); ++i)
  {
    FittedFriction& friction = frictions[i];
    if (all.front().may.mounting)
    {
      continue;
    }
    friction = { 1.0, HUGE_VAL, 0.0, 0.0 };
    for (const Hypothesis& of : all)
    {
      const ArmEstimator::Known& whole = of.found.frictions[i];
      const ArmEstimator::Known own{ 1.0 + of.found.own[i].value, of.found.own[i].half_width };
      const ArmEstimator::Known& counts = std::abs(own.value - 1.0) < std::abs(whole.value - 1.0) ? own : whole;
      friction.factor = &of == &all.front() ? counts.value : friction.factor;
      friction.lower = std::min({ friction.lower, own.value - own.half_width, whole.value - whole.half_width });
      friction.upper = std::max({ friction.upper, own.value + own.half_width, whole.value + whole.half_width });
      friction.of_rows = std::max(friction.of_rows, of.found.own[i].of_rows);
    }
  }
  for (const auto& [found, may, cost] : all)
  {
    const std::string cause = (found.states.empty() ? std::string() : " (with another payload in some legs)") +
                              (may.drag     ? " (with a drag of the tool)" :
                               may.mounting ? " (with another mounting)" :
                                              "");
    for (std::size_t i = 0; i < frictions.size(); ++i)
    {
      const ArmEstimator::Known& own = found.own[i];
      if (!(own.of_rows < TOLD))
      {
        continue;
      }
      const std::string text = "a fit of all joints' currents" + cause + " gives this joint " +
                               fixedText(1.0 + own.value, 2) + " times the expected friction (95 % interval " +
                               fixedText(1.0 + own.value - own.half_width, 2) + " to " +
                               fixedText(1.0 + own.value + own.half_width, 2) + ")";
      if (frictions[i].not_more.empty() && own.value < own.half_width)
      {
        frictions[i].not_more = text;
      }
      if (frictions[i].not_less.empty() && own.value > -own.half_width)
      {
        frictions[i].not_less = text;
      }
    }
  }
  return frictions;
}

FoundLoad LoadFit::solve(const std::vector<bool>& counts)
{
  const std::vector<Hypothesis> all = hypotheses(counts);
  const ArmEstimator::Estimate& estimate = all.front().found;
  const double of_links = ofLinks(counts);
  FoundLoad found{ payloadOf(estimate.payload, estimate.payload_half_width, of_links), mountingOf(estimate) };
  found.drag = dragOf(estimate);
  found.frictions = frictionsOf(all);
  found.gain = estimate.gain.value;
  found.gain_half_width = estimate.gain.half_width;
  if (estimate.states.empty())
  {
    return found;
  }
  // A payload of state 0 that agrees with the configured one differs from it by errors of the links' masses. The
  // payload of state 1 has the same errors, so the function subtracts them.
  found.otherwise = found.payload;
  const bool is_known = !found.otherwise.differs();
  const ArmEstimator::Carried other =
      is_known ? estimate.jump : ArmEstimator::Carried(estimate.payload + estimate.jump);
  found.payload = payloadOf(other, estimate.jump_half_width, of_links);
  found.payload.least_claim = 0.0;
  for (std::size_t leg = 0; leg < estimate.states.size(); ++leg)
  {
    if (isPushed(leg))
    {
      continue;
    }
    if (found.changes.empty() || estimate.states[leg] != found.changes.back().is_found)
    {
      found.changes.push_back({ legs_[leg], estimate.states[leg] });
    }
  }
  return found;
}

double LoadFit::leastCost()
{
  return misfitCost(0.0);
}

LoadFit::Fit LoadFit::explained(const std::vector<bool>& counts)
{
  constexpr std::size_t MOST_ROWS = 400;  // largest number of rows of each joint
  constexpr double OTHER_SIZE = 20.0;     // cost of a common factor of all currents other than 1 [-]
  constexpr double CLEAR = 0.3;           // least logarithm of a common factor that payloads and gains do not cause [-]
  constexpr double NO_MASS = 0.5;  // standard deviation of masses below zero, by errors of the links' masses [kg]
  const ArmEstimator estimator(rowsOf(counts, MOST_ROWS), gravity_);
  Fit best;
  const auto likelier = [&](bool is_mounted)
  {
    const std::vector<ArmEstimator::Estimate> found = estimator.solve({ is_mounted, true, false });
    return found.back().cost + OTHER_CAUSE < found.front().cost ? found.back() : found.front();
  };
  for (const bool is_mounted : { false, true })
  {
    if (is_mounted && best.cost <= leastCost() + OTHER_CAUSE)
    {
      break;  // no other mounting can be likelier
    }
    const ArmEstimator::Estimate found = likelier(is_mounted);
    const double below_zero = std::min(payload_.mass + found.payload[0], 0.0);
    double cost = found.rareness + misfitCost(found.left) + 0.5 * std::pow(below_zero / NO_MASS, 2);
    cost += is_mounted ? OTHER_CAUSE : 0.0;
    const double size = 1.0 + found.gain.value;
    const bool is_other = !(std::abs(std::log(size)) < CLEAR);
    cost += is_other ? OTHER_SIZE : 0.0;
    best = !is_mounted || cost < best.cost ? Fit{ is_other ? size : 1.0, found.left, cost } : best;
  }
  return best;
}
}  // namespace hjt
