// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "arm/residual_statistics.hpp"

namespace hjt
{
namespace
{
// Terms of the arm, then of each joint.
constexpr int JUMP = ArmEstimator::LOAD;
constexpr int GAIN = JUMP + ArmEstimator::PAYLOAD;
constexpr int FRICTION = GAIN + 1;
constexpr int COLD = FRICTION + 1;
constexpr int GROUP = COLD + 1;  // base to elbow, wrists
constexpr int GROUPS = 2;
constexpr int OWN = GROUP + GROUPS;
constexpr int OWN_GAIN = 0;
constexpr int OWN_FRICTION = 1;
constexpr int OWN_COLD = 2;
constexpr int OWN_OFFSET = 3;
constexpr int OWN_LOSS = 4;
constexpr int OWN_INERTIA = 5;
constexpr int PER_JOINT = 6;
constexpr int USED = GROUP + 1 + PER_JOINT;  // of one joint's rows

// Widths of the priors, chosen on recordings of UR5 and UR10e (docs/arm.md, Payload).
constexpr double MASS = 0.3;             // [kg]
constexpr double MOMENT = 0.05;          // [kg.m]
constexpr double TILT = 0.2;             // [m/s^2]
constexpr double JUMP_MASS = 1.0;        // [kg]
constexpr double JUMP_MOMENT = 0.1;      // [kg.m]
constexpr double ARM_GAIN = 0.01;        // [-]
constexpr double ARM_FRICTION = 0.1;     // [-]
constexpr double ARM_COLD = 1.0;         // [10 K]
constexpr double GROUP_FRICTION = 0.04;  // [-]
constexpr double JOINT_GAIN = 0.03;      // [-]
constexpr double ALIKE_GAIN = 0.003;     // of a joint whose load is less than its friction [-]
constexpr double JOINT_FRICTION = 0.05;  // [-]
constexpr double JOINT_COLD = 0.3;       // [10 K]
constexpr double JOINT_OFFSET = 0.1;     // [A]
constexpr double JOINT_LOSS = 0.02;      // of the load [-]
constexpr double JOINT_INERTIA = 0.3;    // of the rotor's [-]
constexpr double NEVER = 1e-6;           // of a term that is left out

constexpr double INDEPENDENT = 40.0;  // rows of a joint, at most
constexpr double FREEDOM = 4.0;       // of Student's t
constexpr double LEAST = 0.01;        // deviation of rows [A]
constexpr std::size_t FEWEST = 20;    // rows of a joint that counts
constexpr int ROUNDS = 15;
constexpr int STARTS = 4;

int groupOf(std::size_t joint)
{
  constexpr std::size_t TO_ELBOW = 3;
  return joint < TO_ELBOW ? GROUP : GROUP + 1;
}

int ownOf(std::size_t joint)
{
  return OWN + PER_JOINT * static_cast<int>(joint);
}

/// What start it is tells the causes that are hardly held at first: the load; all; load and friction; friction.
double looseness(int start, int term)
{
  constexpr double OF_LOAD = 0.01;
  constexpr double OF_OTHERS = 0.05;
  const bool is_load = term < GAIN;
  const bool is_friction = term >= FRICTION && (term < OWN || (term - OWN) % PER_JOINT == OWN_FRICTION);
  const bool is_loose = start == 1 || (is_load && start != 3) || (is_friction && start > 1);
  return !is_loose ? 1.0 : is_load ? OF_LOAD : OF_OTHERS;
}
}  // namespace

struct ArmEstimator::Prior
{
  Eigen::VectorXd width;
  std::vector<bool> normal;  // else Cauchy's
};

struct ArmEstimator::Point
{
  Eigen::VectorXd at;
  Eigen::MatrixXd information;
  std::vector<double> deviations;  // of the rows of each joint [A]
  double rareness{};
  double cost{ std::numeric_limits<double>::infinity() };
};

bool ArmEstimator::Known::isBeyond(double least) const
{
  return std::abs(value) - half_width > least;
}

ArmEstimator::ArmEstimator(Rows rows) : rows_(std::move(rows)), size_(ownOf(rows_.size()))
{
  for (std::vector<Row>& joint : rows_)
  {
    if (joint.size() < FEWEST)
    {
      joint.clear();
    }
    for (const Row& row : joint)
    {
      legs_ = std::max(legs_, row.leg + 1);
    }
  }
}

ArmEstimator::Prior ArmEstimator::priorOf(bool with_gravity, bool with_jump) const
{
  Prior prior{ Eigen::VectorXd::Constant(size_, NEVER), std::vector<bool>(static_cast<std::size_t>(size_)) };
  prior.width.head<PAYLOAD>() << MASS, MOMENT, MOMENT, MOMENT;
  if (with_gravity)
  {
    prior.width.segment<GRAVITY>(PAYLOAD).setConstant(TILT);
  }
  if (with_jump)
  {
    prior.width.segment<PAYLOAD>(JUMP) << JUMP_MASS, JUMP_MOMENT, JUMP_MOMENT, JUMP_MOMENT;
  }
  prior.width.segment<OWN - GAIN>(GAIN) << ARM_GAIN, ARM_FRICTION, ARM_COLD, GROUP_FRICTION, GROUP_FRICTION;
  std::fill(prior.normal.begin() + COLD, prior.normal.begin() + OWN, true);
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    double load = 0.0;
    double friction = 0.0;
    for (const Row& row : rows_[i])
    {
      load += std::pow(row.predicted - row.friction, 2);
      friction += std::pow(row.friction, 2);
    }
    prior.width.segment<PER_JOINT>(ownOf(i)) << (load < friction ? ALIKE_GAIN : JOINT_GAIN), JOINT_FRICTION, JOINT_COLD,
        JOINT_OFFSET, JOINT_LOSS, JOINT_INERTIA;
    std::fill_n(prior.normal.begin() + ownOf(i) + OWN_COLD, PER_JOINT - OWN_COLD, true);
  }
  return prior;
}

/// `slope`: by the terms of the arm, of the group and of the joint.
double ArmEstimator::errorOf(std::size_t joint, std::size_t row, const std::vector<bool>& states,
                             const Eigen::VectorXd& at, Eigen::VectorXd* slope) const
{
  const Row& of = rows_[joint][row];
  const int own = ownOf(joint);
  const double gain = 1.0 + at[GAIN] + at[own + OWN_GAIN];
  const double state = !states.empty() && states[of.leg] ? 1.0 : 0.0;
  const auto carried = of.load.head<PAYLOAD>();
  const double inner = of.predicted + of.load.dot(at.head<LOAD>()) + state * carried.dot(at.segment<PAYLOAD>(JUMP)) +
                       (at[FRICTION] + at[groupOf(joint)] + at[own + OWN_FRICTION]) * of.friction +
                       (at[COLD] + at[own + OWN_COLD]) * of.cold + at[own + OWN_LOSS] * of.loss +
                       at[own + OWN_INERTIA] * of.inertia;
  if (slope != nullptr)
  {
    slope->head<LOAD>() = gain * of.load;
    slope->segment<PAYLOAD>(JUMP) = state * gain * carried;
    slope->segment<GROUP + 1 - GAIN>(GAIN) << inner, gain * of.friction, gain * of.cold, gain * of.friction;
    slope->tail<PER_JOINT>() << inner, gain * of.friction, gain * of.cold, 1.0, gain * of.loss, gain * of.inertia;
  }
  return of.current - gain * inner - at[own + OWN_OFFSET];
}

/// By Gauss and Newton; with a `start` what it names is hardly held in the first rounds, -1: all is held.
ArmEstimator::Point ArmEstimator::refine(const Prior& prior, const std::vector<bool>& states, Eigen::VectorXd at,
                                         int start, int rounds) const
{
  constexpr int LOOSE_ROUNDS = 5;
  constexpr double FLOOR = 0.02;  // that the rows of no real arm fall below [A]
  constexpr double COUNTED = 60.0;
  Point point;
  point.deviations.resize(rows_.size());
  Eigen::VectorXd slope(USED);
  std::vector<Eigen::MatrixXd> slopes;  // of each joint's rows
  std::vector<Eigen::MatrixXd> weighted;
  for (const std::vector<Row>& joint : rows_)
  {
    slopes.emplace_back(static_cast<Eigen::Index>(joint.size()), USED);
    weighted.emplace_back(static_cast<Eigen::Index>(joint.size()), USED);
  }
  for (int round = 0; round < rounds; ++round)
  {
    point.information = Eigen::MatrixXd::Zero(size_, size_);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
    point.rareness = 0.0;
    for (int k = 0; k < size_; ++k)
    {
      const double t = at[k] / prior.width[k];
      const bool is_normal = prior.normal[static_cast<std::size_t>(k)];
      const bool may_be_loose = start >= 0 && round < LOOSE_ROUNDS && prior.width[k] > NEVER;
      const double weight = (may_be_loose ? looseness(start, k) : 1.0) / (prior.width[k] * prior.width[k]) *
                            (is_normal ? 1.0 : 2.0 / (1.0 + t * t));
      point.information(k, k) = weight;
      right[k] = -weight * at[k];
      point.rareness += is_normal ? 0.5 * t * t : std::log1p(t * t);
    }
    point.cost = point.rareness;
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      const auto count = static_cast<Eigen::Index>(rows_[i].size());
      if (count == 0)
      {
        continue;
      }
      Eigen::VectorXd error(count);
      for (Eigen::Index k = 0; k < count; ++k)
      {
        error[k] = errorOf(i, static_cast<std::size_t>(k), states, at, &slope);
        slopes[i].row(k) = slope.transpose();
      }
      const double deviation = std::max(robustDeviation(error), LEAST);
      const double rows_a_tale = std::max({ 1.0, correlationRows(error), static_cast<double>(count) / INDEPENDENT });
      const Eigen::ArrayXd squares = (error / deviation).array().square();
      const Eigen::VectorXd weights = (FREEDOM + 1.0) / (FREEDOM + squares) / (deviation * deviation * rows_a_tale);
      weighted[i].noalias() = weights.asDiagonal() * slopes[i];
      const Eigen::MatrixXd products = slopes[i].transpose() * weighted[i];
      const Eigen::VectorXd sums = weighted[i].transpose() * error;
      const auto term = [&](int k) { return k < GROUP ? k : k == GROUP ? groupOf(i) : ownOf(i) + k - GROUP - 1; };
      for (int k = 0; k < USED; ++k)
      {
        right[term(k)] += sums[k];
        for (int l = 0; l < USED; ++l)
        {
          point.information(term(k), term(l)) += products(k, l);
        }
      }
      point.deviations[i] = deviation;
      point.cost += COUNTED * std::log(std::hypot(deviation, FLOOR));
    }
    at += point.information.ldlt().solve(right);
  }
  point.at = std::move(at);
  return point;
}

/// The likeliest of those that the starts lead to: they are not one.
ArmEstimator::Point ArmEstimator::best(const Prior& prior, const std::vector<bool>& states) const
{
  Point best;
  for (int start = 0; start < STARTS; ++start)
  {
    Point other = refine(prior, states, Eigen::VectorXd::Zero(size_), start, ROUNDS);
    if (other.cost < best.cost)
    {
      best = std::move(other);
    }
  }
  return best;
}

/// Legs whose own mass, beside that of a point, is in the upper half of all.
std::vector<bool> ArmEstimator::parted(const Point& by) const
{
  constexpr double NOISE = 0.05;  // deviation, at least [A]
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(legs_), 2);
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const double weight = 1.0 / std::pow(std::max(by.deviations[i], NOISE), 2);
    for (std::size_t k = 0; k < rows_[i].size(); ++k)
    {
      const Row& row = rows_[i][k];
      const auto leg = static_cast<Eigen::Index>(row.leg);
      sums(leg, 0) += weight * row.load[0] * errorOf(i, k, {}, by.at, nullptr);
      sums(leg, 1) += weight * row.load[0] * row.load[0];
    }
  }
  const Eigen::VectorXd masses = sums.col(0).array() / (sums.col(1).array() + std::numeric_limits<double>::min());
  const double middle = 0.5 * (masses.minCoeff() + masses.maxCoeff());
  std::vector<bool> states(legs_);
  for (std::size_t leg = 0; leg < legs_; ++leg)
  {
    states[leg] = masses[static_cast<Eigen::Index>(leg)] > middle;
  }
  return states;
}

/// The state that the rows of each leg fit better.
std::vector<bool> ArmEstimator::likelier(const Point& by) const
{
  std::vector<double> costs(legs_);  // of state 1 beyond that of state 0
  for (const bool state : { false, true })
  {
    const std::vector<bool> all(legs_, state);
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      for (std::size_t k = 0; k < rows_[i].size(); ++k)
      {
        const double t = errorOf(i, k, all, by.at, nullptr) / by.deviations[i];
        costs[rows_[i][k].leg] += (state ? 1.0 : -1.0) * std::log1p(t * t / FREEDOM);
      }
    }
  }
  std::vector<bool> states(legs_);
  std::transform(costs.begin(), costs.end(), states.begin(), [](double cost) { return cost < 0.0; });
  return states;
}

/// The payload may have two states, between which it changes from leg to leg; `states` stays empty where that is not
/// clearly likelier. Begun by what one payload leaves, and by what the arm as configured leaves.
ArmEstimator::Point ArmEstimator::withJump(bool with_gravity, const Point& without, std::vector<bool>& states) const
{
  constexpr double CLEARLY = 20.0;
  constexpr int TURNS = 6;
  const Prior prior = priorOf(with_gravity, true);
  Point best = without;
  double limit = without.cost - CLEARLY;
  Point configured = without;
  configured.at.setZero();
  for (const Point* from : { &without, static_cast<const Point*>(&configured) })
  {
    std::vector<bool> tried = parted(*from);
    Point now;
    for (int turn = 0; turn < TURNS; ++turn)
    {
      now = turn == 0 ? this->best(prior, tried) : refine(prior, tried, now.at, -1, ROUNDS);
      if (now.cost < limit)
      {
        best = now;
        limit = now.cost;
        states = tried;
      }
      std::vector<bool> next = likelier(now);
      if (next == tried)
      {
        break;
      }
      tried = std::move(next);
    }
  }
  return best;
}

ArmEstimator::Estimate ArmEstimator::estimateOf(const Point& point, const std::vector<bool>& states) const
{
  const Eigen::MatrixXd covariance = point.information.ldlt().solve(Eigen::MatrixXd::Identity(size_, size_));
  const Eigen::VectorXd half_widths = NORMAL_95 * covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const auto known = [&](const Eigen::VectorXd& terms) {
    return Known{ terms.dot(point.at), NORMAL_95 * std::sqrt(std::max(0.0, terms.dot(covariance * terms))) };
  };
  Estimate found;
  found.payload = point.at.head<PAYLOAD>();
  found.payload_half_width = half_widths.head<PAYLOAD>();
  found.gravity = point.at.segment<GRAVITY>(PAYLOAD);
  found.gravity_half_width = half_widths.segment<GRAVITY>(PAYLOAD);
  found.jump = point.at.segment<PAYLOAD>(JUMP);
  found.jump_half_width = half_widths.segment<PAYLOAD>(JUMP);
  found.gain = known(Eigen::VectorXd::Unit(size_, GAIN));
  found.states = states;
  found.rareness = point.rareness;
  found.cost = point.cost;
  double left = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const int own = ownOf(i);
    double power = std::numeric_limits<double>::min();
    double cold = 0.0;
    double loss = 0.0;
    for (std::size_t k = 0; k < rows_[i].size(); ++k)
    {
      const Row& row = rows_[i][k];
      power += row.friction * row.friction;
      cold += row.friction * row.cold;
      loss += row.friction * row.loss;
      left += std::pow(errorOf(i, k, states, point.at, nullptr), 2);
      all += row.current * row.current;
    }
    found.gains.push_back(known(Eigen::VectorXd::Unit(size_, own + OWN_GAIN)));
    // Of what the other terms add, the part that is in proportion to the friction.
    Eigen::VectorXd terms = Eigen::VectorXd::Zero(size_);
    terms[groupOf(i)] = terms[own + OWN_FRICTION] = 1.0;
    terms[own + OWN_COLD] = cold / power;
    terms[own + OWN_LOSS] = loss / power;
    found.own.push_back(known(terms));
    terms[FRICTION] = 1.0;
    terms[COLD] = cold / power;
    found.frictions.push_back(known(terms));
    found.frictions.back().value += 1.0;
  }
  found.left = all > 0.0 ? std::sqrt(left / all) : 1.0;
  return found;
}

ArmEstimator::Estimate ArmEstimator::solve(bool with_gravity, bool with_jump) const
{
  std::vector<bool> states;
  Point point = best(priorOf(with_gravity, false), states);
  if (with_jump && legs_ > 1)
  {
    point = withJump(with_gravity, point, states);
  }
  return estimateOf(point, states);
}
}  // namespace hjt
