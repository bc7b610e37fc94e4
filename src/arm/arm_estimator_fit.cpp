// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "arm/arm_estimator_terms.hpp"
#include "arm/residual_statistics.hpp"

namespace hjt
{
namespace
{
using namespace term;

constexpr double INDEPENDENT = 40.0;  // rows of a joint, at most
constexpr double LEAST = 0.01;        // deviation of rows [A]

/// How much rarer a row is, logarithm, by the square of its error in deviations.
double rarer(double square)
{
  return 0.5 * (STUDENT + 1.0) * std::log1p(square / STUDENT);
}

/// What start it is tells the causes that are hardly held at first: the load; all; load and friction; friction.
double looseness(int start, int term)
{
  constexpr double OF_LOAD = 0.01;
  constexpr double OF_OTHERS = 0.05;
  const bool is_load = term < GAIN;
  const bool is_friction = term >= FRICTION && (term < OWN || (term - OWN) % PER_JOINT == OWN_FRICTION);
  const bool is_loose = start == 1 || (is_load && (start == 0 || start == 2)) || (is_friction && start > 1);
  return !is_loose ? 1.0 : is_load ? OF_LOAD : OF_OTHERS;
}
}  // namespace

void ArmEstimator::addPrior(const Prior& prior, int start, Point& point, Eigen::VectorXd& right) const
{
  for (int k = 0; k < size_; ++k)
  {
    const double t = point.at[k] / prior.width[k];
    const bool is_normal = prior.normal[static_cast<std::size_t>(k)];
    const double weight = (prior.width[k] > NEVER ? looseness(start, k) : 1.0) / (prior.width[k] * prior.width[k]) *
                          (is_normal ? 1.0 : 2.0 / (1.0 + t * t));
    point.information(k, k) += weight;
    right[k] -= weight * point.at[k];
    point.rareness += is_normal ? 0.5 * t * t : std::log1p(t * t);
  }
  // Gravity's size is known but for the masses of the links, which look like it. At first it may turn over; weightless
  // as configured there is nothing to turn.
  constexpr double LINKS = 0.02;  // uncertainty of the links' masses, as a share
  const Eigen::Vector3d total = gravity_ + point.at.segment<GRAVITY>(PAYLOAD);
  if (looseness(start, PAYLOAD) < 1.0 || !(prior.width[PAYLOAD] > NEVER) || gravity_.isZero() || total.isZero())
  {
    return;
  }
  const double weight = 1.0 / std::pow(LINKS * gravity_.norm(), 2);
  const double error = gravity_.norm() - total.norm();
  const Eigen::Vector3d way = total.normalized();
  point.information.block<GRAVITY, GRAVITY>(PAYLOAD, PAYLOAD) += weight * way * way.transpose();
  right.segment<GRAVITY>(PAYLOAD) += weight * error * way;
  point.rareness += 0.5 * weight * error * error;
}

void ArmEstimator::addRows(std::size_t joint, const std::vector<bool>& states, Work& work, Point& point,
                           Eigen::VectorXd& right) const
{
  const std::vector<Row>& rows = rows_[joint];
  Eigen::VectorXd& error = work.errors[joint];
  error.resize(static_cast<Eigen::Index>(rows.size()));
  work.slopes.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    error[static_cast<Eigen::Index>(k)] = errorOf(joint, rows[k], stateOf(rows[k], states), point.at, &work.slopes[k]);
  }
  const double deviation = std::max(robustDeviation(error), LEAST);
  const double rows_a_tale = std::max({ 1.0, correlationRows(error), static_cast<double>(rows.size()) / INDEPENDENT });
  const Eigen::ArrayXd squares = (error / deviation).array().square();
  const Eigen::ArrayXd weights = (STUDENT + 1.0) / (STUDENT + squares) / (deviation * deviation * rows_a_tale);
  std::array<Products, 2> of_states;
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    const auto row = static_cast<Eigen::Index>(k);
    Products& products = of_states[stateOf(rows[k], states) ? 1 : 0];
    const Slope weighted = weights[row] * work.slopes[k];
    products.slopes.noalias() += weighted * work.slopes[k].transpose();
    products.error += error[row] * weighted;
  }
  const Products all{ of_states[0].slopes + of_states[1].slopes, of_states[0].error + of_states[1].error };
  const auto term = [&](int k) { return k < GROUP ? k : k == GROUP ? groupOf(joint) : ownOf(joint) + k - GROUP - 1; };
  const auto is_jump = [](int k) { return k >= JUMP && k < GAIN; };
  for (int k = 0; k < USED; ++k)
  {
    right[term(k)] += (is_jump(k) ? of_states[1] : all).error[slopeOf(k)];
    for (int l = 0; l < USED; ++l)
    {
      point.information(term(k), term(l)) +=
          (is_jump(k) || is_jump(l) ? of_states[1] : all).slopes(slopeOf(k), slopeOf(l));
    }
  }
  point.deviations[joint] = deviation;
}

/// By Gauss and Newton, until a step is nothing beside the deviations a posteriori; what `start` names is hardly held
/// in the first rounds.
ArmEstimator::Point ArmEstimator::refine(const Prior& prior, const std::vector<bool>& states, Eigen::VectorXd at,
                                         int start) const
{
  constexpr int ROUNDS = 15;
  constexpr int LOOSE_ROUNDS = 5;
  constexpr double NOTHING = 1e-3;  // of a deviation
  constexpr double FLOOR = 0.02;    // least residual of a real arm [A]
  constexpr double COUNTED = 60.0;
  Point point;
  point.at = std::move(at);
  point.deviations.resize(rows_.size());
  Work work;
  work.errors.resize(rows_.size());
  for (int round = 0; round < ROUNDS; ++round)
  {
    point.information = Eigen::MatrixXd::Zero(size_, size_);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
    point.rareness = 0.0;
    addPrior(prior, round < LOOSE_ROUNDS ? start : HELD, point, right);
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      if (!rows_[i].empty())
      {
        addRows(i, states, work, point, right);
      }
    }
    const Eigen::VectorXd step = point.information.ldlt().solve(right);
    point.at += step;
    if (round >= LOOSE_ROUNDS &&
        (step.array().square() * point.information.diagonal().array()).maxCoeff() < NOTHING * NOTHING)
    {
      break;
    }
  }
  point.cost = point.rareness;
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    if (!rows_[i].empty())
    {
      const double scale = std::hypot(point.deviations[i], FLOOR);
      point.cost += COUNTED * (std::log(scale) + (work.errors[i] / scale).array().square().unaryExpr(&rarer).mean());
    }
  }
  return point;
}
}  // namespace hjt
