// SPDX-License-Identifier: BSD-3-Clause
#include "arm/arm_estimator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "base/statistics.hpp"

namespace hjt
{
namespace
{
/// Indices of the unknowns of the fit (terms): those of the arm, then of the two groups of joints, then of each joint.
enum Term : int
{
  JUMP = ArmEstimator::LOAD,
  GAIN = JUMP + ArmEstimator::PAYLOAD,
  FRICTION,
  COLD,
  GROUP,
  OWN = GROUP + 2
};
enum OwnTerm : int
{
  OWN_GAIN,
  OWN_FRICTION,
  OWN_COLD,
  OWN_OFFSET,
  OWN_LOSS,
  OWN_INERTIA,
  PER_JOINT,
  USED = GROUP + 1 + PER_JOINT  // number of terms on which the rows of one joint depend
};

constexpr double NEVER = 1e-6;   // prior width of a term that the estimator does not change
constexpr double STUDENT = 4.0;  // degrees of freedom of Student's t distribution for the errors of the rows
constexpr int STARTS = 4;
constexpr int HELD = -1;  // argument `start` of looseness(): all priors have their full weight

int groupOf(std::size_t joint)
{
  constexpr std::size_t TO_ELBOW = 3;
  return GROUP + (joint < TO_ELBOW ? 0 : 1);
}

int ownOf(std::size_t joint)
{
  return OWN + PER_JOINT * static_cast<int>(joint);
}

/// Index in Slope of the derivative of the explained current by term number `used`. Several terms share a derivative:
/// the payload and its jump, or the terms of arm, group and joint. Slope holds the derivatives by load, gain, friction,
/// cold friction, offset, loss and inertia.
int slopeOf(int used)
{
  constexpr std::array<int, USED - GAIN> OF_OTHERS{ 0, 1, 2, 1, 0, 1, 2, 3, 4, 5 };
  return used < JUMP ? used :
         used < GAIN ? used - JUMP :
                       ArmEstimator::LOAD + OF_OTHERS[static_cast<std::size_t>(used - GAIN)];
}

// Widths of the priors of the terms, chosen from recordings of a UR5 and a UR10e (docs/arm.md, Payload).
constexpr double MASS = 0.3;             // prior width of the payload's mass [kg]
constexpr double MOMENT = 0.05;          // prior width of the payload's moments [kg.m]
constexpr double TILT = 0.2;             // prior width of the change of gravity [m/s^2]
constexpr double TOOL_DRAG = 2.0;        // prior width of the drag [N]
constexpr double JUMP_MASS = 1.0;        // prior width of the change of the payload's mass from leg to leg [kg]
constexpr double JUMP_MOMENT = 0.1;      // prior width of the change of the payload's moments from leg to leg [kg.m]
constexpr double ARM_GAIN = 0.01;        // prior width of the common factor of all gains [-]
constexpr double ARM_FRICTION = 0.1;     // prior width of the common factor of all frictions [-]
constexpr double ARM_COLD = 1.0;         // prior width of the common coldness of all drives [10 K]
constexpr double GROUP_FRICTION = 0.04;  // prior width of the common factor of a group's frictions [-]
constexpr double JOINT_GAIN = 0.03;      // prior width of the factor of one joint's gain [-]
constexpr double ALIKE_GAIN = 0.003;     // as JOINT_GAIN, if the joint's load is less than its friction [-]
constexpr double JOINT_FRICTION = 0.05;  // prior width of the factor of one joint's friction [-]
constexpr double JOINT_COLD = 0.3;       // prior width of the coldness of one joint's drive [10 K]
constexpr double JOINT_OFFSET = 0.1;     // prior width of the offset of one joint's current [A]
constexpr double JOINT_LOSS = 0.02;      // prior width of one joint's loss over its load [-]
constexpr double JOINT_INERTIA = 0.3;    // prior width of the relative change of one rotor's inertia [-]

constexpr std::size_t FEWEST = 20;  // least number of rows of a joint that counts

constexpr double INDEPENDENT = 40.0;  // largest number of independent rows that the rows of a joint stand for
constexpr double LEAST = 0.02;        // least standard deviation of the errors in the rows of a real arm [A]

/// Negative logarithm of the density of a row's error over that of 0. `square`: squared error in standard deviations.
double rarer(double square)
{
  return 0.5 * (STUDENT + 1.0) * std::log1p(square / STUDENT);
}

/// Factor on the weight of a term's prior in the first rounds [-]. The factor is below 1 for the terms of the load in
/// start 0, for all terms in start 1, for those of load and friction in start 2, and for those of friction in start 3.
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

/// Width and kind of the prior of each term.
struct ArmEstimator::Prior
{
  Eigen::VectorXd width;
  std::vector<bool> normal;  // true: the prior is normal; false: it is a Cauchy distribution
};

/// Values of all terms, with the information matrix and the cost at these values.
struct ArmEstimator::Point
{
  Eigen::VectorXd at;
  Eigen::MatrixXd information;
  Eigen::VectorXd of_prior;        // part of each term's information that comes from its prior
  std::vector<double> deviations;  // standard deviation of the errors in the rows of each joint [A]
  double rareness{};
  double cost{ std::numeric_limits<double>::infinity() };
};

/// Errors of the rows of one joint, with the derivatives of the explained currents by the terms.
struct ArmEstimator::Work
{
  Eigen::VectorXd error;  // error of each row [A]
  std::vector<Slope> slopes;
};

/// Sums over a joint's rows in legs of one state: products of the rows' slopes with each other and with the errors.
struct ArmEstimator::Products
{
  Eigen::Matrix<double, SLOPES, SLOPES> slopes = Eigen::Matrix<double, SLOPES, SLOPES>::Zero();
  Slope error = Slope::Zero();
};

bool ArmEstimator::Known::isBeyond(double least) const
{
  return std::abs(value) - half_width > least;
}

ArmEstimator::ArmEstimator(Rows rows, const Eigen::Vector3d& gravity, std::vector<double> repeats)
  : rows_(std::move(rows)), gravity_(gravity), repeats_(std::move(repeats)), size_(ownOf(rows_.size()))
{
  repeats_.resize(rows_.size(), JOINT_FRICTION);
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

ArmEstimator::Prior ArmEstimator::priorOf(const Freedom& may) const
{
  Prior prior{ Eigen::VectorXd::Constant(size_, NEVER), std::vector<bool>(static_cast<std::size_t>(size_)) };
  prior.width.head<PAYLOAD>() << MASS, MOMENT, MOMENT, MOMENT;
  if (may.mounting)
  {
    prior.width.segment<GRAVITY>(PAYLOAD).setConstant(TILT);
  }
  if (may.drag)
  {
    prior.width[DRAG] = TOOL_DRAG;
  }
  if (may.jump)
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
    const double known = std::min(1.0, repeats_[i] / JOINT_FRICTION);
    prior.width.segment<PER_JOINT>(ownOf(i)) << (load < friction ? ALIKE_GAIN : JOINT_GAIN), known * JOINT_FRICTION,
        known * JOINT_COLD, JOINT_OFFSET, known * JOINT_LOSS, JOINT_INERTIA;
    std::fill_n(prior.normal.begin() + ownOf(i) + OWN_COLD, PER_JOINT - OWN_COLD, true);
  }
  return prior;
}

/// Error of a row: measured - explained current [A]. `state`: state of the row's leg. `slope`: derivatives of the
/// explained current, in the order of slopeOf.
double ArmEstimator::errorOf(std::size_t joint, const Row& of, bool state, const Eigen::VectorXd& at, Slope* slope)
{
  const int own = ownOf(joint);
  const double gain = 1.0 + at[GAIN] + at[own + OWN_GAIN];
  const auto carried = of.load.head<PAYLOAD>();
  const double load = of.load.dot(at.head<LOAD>()) + (state ? carried.dot(at.segment<PAYLOAD>(JUMP)) : 0.0);
  const double friction_factor = 1.0 + at[FRICTION] + at[groupOf(joint)] + at[own + OWN_FRICTION];
  const double way = std::copysign(1.0, of.friction);
  const double size = std::abs(of.torque + load);
  const double friction = of.friction + way * of.rise * (size - std::abs(of.torque));
  const double inner = of.predicted + load + friction_factor * friction - of.friction +
                       (at[COLD] + at[own + OWN_COLD]) * of.cold + at[own + OWN_LOSS] * way * size +
                       at[own + OWN_INERTIA] * of.inertia;
  if (slope != nullptr)
  {
    const double by_load =
        1.0 + (friction_factor * of.rise + at[own + OWN_LOSS]) * way * std::copysign(1.0, of.torque + load);
    slope->head<LOAD>() = gain * by_load * of.load;
    slope->tail<SLOPES - LOAD>() << inner, gain * friction, gain * of.cold, 1.0, gain * way * size, gain * of.inertia;
  }
  return of.current - gain * inner - at[own + OWN_OFFSET];
}

/// Factor on the predicted currents of all rows that fits the measured currents best, by least squares [-].
double ArmEstimator::multiple() const
{
  double both = 0.0;
  double squares = std::numeric_limits<double>::min();
  for (const std::vector<Row>& joint : rows_)
  {
    for (const Row& row : joint)
    {
      both += row.current * row.predicted;
      squares += row.predicted * row.predicted;
    }
  }
  return both / squares;
}

/// Likeliest point from several starts. The last start assumes that one factor scales all predicted currents.
ArmEstimator::Point ArmEstimator::best(const Prior& prior, const std::vector<bool>& states) const
{
  Point best;
  for (int start = 0; start <= STARTS; ++start)
  {
    Eigen::VectorXd at = Eigen::VectorXd::Zero(size_);
    at[GAIN] = start < STARTS ? 0.0 : multiple() - 1.0;
    Point other = refine(prior, states, std::move(at), start < STARTS ? start : HELD, best);
    if (other.cost < best.cost)
    {
      best = std::move(other);
    }
  }
  return best;
}

/// State of each leg, by the mass at the tip that explains the errors which the point `by` leaves in the leg. A leg has
/// state 1 if its mass is above the middle between the smallest and the largest mass.
std::vector<bool> ArmEstimator::parted(const Point& by) const
{
  constexpr double NOISE = 0.05;  // least assumed standard deviation of the errors in a joint's rows [A]
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(legs_), 2);
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const double weight = 1.0 / std::pow(std::max(by.deviations[i], NOISE), 2);
    for (const Row& row : rows_[i])
    {
      const auto leg = static_cast<Eigen::Index>(row.leg);
      sums(leg, 0) += weight * row.load[0] * errorOf(i, row, false, by.at, nullptr);
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

/// Returns for each leg the state that fits the leg's rows better, with the terms of the point `by`.
std::vector<bool> ArmEstimator::likelier(const Point& by) const
{
  std::vector<double> costs(legs_);  // cost of state 1 - cost of state 0, for each leg
  for (const bool state : { false, true })
  {
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      for (const Row& row : rows_[i])
      {
        const double t = errorOf(i, row, state, by.at, nullptr) / by.deviations[i];
        costs[row.leg] += (state ? 1.0 : -1.0) * std::log1p(t * t / STUDENT);
      }
    }
  }
  std::vector<bool> states(legs_);
  std::transform(costs.begin(), costs.end(), states.begin(), [](double cost) { return cost < 0.0; });
  return states;
}

/// The likeliest point with a payload that changes between two states from leg to leg. Sets the state of each leg in
/// `states`. `states` stays empty if all legs have the same state. The search begins with two choices of the states
/// (parted()): one from the errors that the point `without` leaves, one from those of the configured arm.
ArmEstimator::Point ArmEstimator::withJump(const Freedom& may, const Point& without, std::vector<bool>& states) const
{
  constexpr int TURNS = 6;
  const Prior prior = priorOf(may);
  Point best;
  Point configured = without;
  configured.at.setZero();
  std::vector<std::vector<bool>> begun{ parted(without), parted(configured) };
  begun.resize(begun.front() == begun.back() ? 1 : 2);
  for (std::vector<bool>& tried : begun)
  {
    Point now;
    for (int turn = 0; turn < TURNS; ++turn)
    {
      now = turn == 0 ? this->best(prior, tried) : refine(prior, tried, now.at, HELD, {});
      const bool is_changing = std::find(tried.begin(), tried.end(), !tried.front()) != tried.end();
      if (is_changing && now.cost < best.cost)
      {
        best = now;
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

std::vector<ArmEstimator::Push> ArmEstimator::pushesOf(const Point& point, const std::vector<bool>& states) const
{
  constexpr double USUAL_MASS = 3.0;  // prior standard deviation of a push along gravity, as a mass [kg]
  constexpr double USUAL = 50.0;      // prior standard deviation of a push across gravity [N]
  struct Leg
  {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
  };
  std::vector<Leg> legs(legs_);
  for (Leg& leg : legs)
  {
    leg.information.diagonal() = Eigen::Array3d(USUAL_MASS, USUAL, USUAL).square().inverse();
  }
  for (std::size_t i = 0; i < rows_.size(); ++i)
  {
    const double told = std::min(1.0, INDEPENDENT / static_cast<double>(rows_[i].size()));
    const double weight = told / std::pow(point.deviations[i], 2);
    for (const Row& row : rows_[i])
    {
      const Eigen::Vector3d slope(row.load[0], row.across[0], row.across[1]);
      Leg& leg = legs[row.leg];
      leg.information += weight * slope * slope.transpose();
      leg.right += weight * errorOf(i, row, stateOf(row, states), point.at, nullptr) * slope;
    }
  }
  std::vector<Push> pushes;
  for (const Leg& leg : legs)
  {
    const Eigen::Vector3d found = leg.information.ldlt().solve(leg.right);
    const double across = found.tail<2>().norm();
    pushes.push_back({ std::hypot(gravity_.norm() * found[0], across), across });
  }
  return pushes;
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
  found.drag = known(Eigen::VectorXd::Unit(size_, DRAG));
  found.gain = known(Eigen::VectorXd::Unit(size_, GAIN));
  found.states = states;
  found.pushes = pushesOf(point, states);
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
    for (const Row& row : rows_[i])
    {
      power += row.friction * row.friction;
      cold += row.friction * row.cold;
      loss += std::abs(row.friction * row.torque);
      left += std::pow(errorOf(i, row, stateOf(row, states), point.at, nullptr), 2);
      all += row.current * row.current;
    }
    found.gains.push_back(known(Eigen::VectorXd::Unit(size_, own + OWN_GAIN)));
    // Of the currents by the terms for cold and loss, the part that is proportional to the friction counts as friction.
    Eigen::VectorXd terms = Eigen::VectorXd::Zero(size_);
    terms[groupOf(i)] = terms[own + OWN_FRICTION] = 1.0;
    terms[own + OWN_COLD] = cold / power;
    terms[own + OWN_LOSS] = loss / power;
    found.own.push_back(known(terms));
    const int friction = own + OWN_FRICTION;
    const double of_rows = 1.0 / covariance(friction, friction) - point.of_prior[friction];
    found.own.back().of_rows = NORMAL_95 / std::sqrt(std::max(0.0, of_rows));
    terms[FRICTION] = 1.0;
    terms[COLD] = cold / power;
    found.frictions.push_back(known(terms));
    found.frictions.back().value += 1.0;
  }
  found.left = all > 0.0 ? std::sqrt(left / all) : 1.0;
  return found;
}

std::vector<ArmEstimator::Estimate> ArmEstimator::solve(const Freedom& may) const
{
  Freedom constant = may;
  constant.jump = false;
  const Point point = best(priorOf(constant), {});
  std::vector<Estimate> found{ estimateOf(point, {}) };
  std::vector<bool> states;
  if (may.jump && legs_ > 1)
  {
    const Point changing = withJump(may, point, states);
    if (!states.empty())
    {
      found.push_back(estimateOf(changing, states));
    }
  }
  return found;
}

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
  // This prior keeps the size of gravity within the errors of the links' masses, which have the same effect as another
  // size. The prior is off while the weight of the load's priors is reduced, so that gravity can turn over. Without
  // configured gravity the prior has no meaning.
  constexpr double LINKS = 0.02;  // standard deviation of the links' masses, as a share [-]
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
  Eigen::VectorXd& error = work.error;
  error.resize(static_cast<Eigen::Index>(rows.size()));
  work.slopes.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    error[static_cast<Eigen::Index>(k)] = errorOf(joint, rows[k], stateOf(rows[k], states), point.at, &work.slopes[k]);
  }
  double& deviation = point.deviations[joint];
  if (!(deviation > 0.0))
  {
    deviation = std::max(robustDeviation(error), LEAST);
  }
  // The last standard deviation gives the weights of the rows, and these weights give a likelier standard deviation.
  Eigen::ArrayXd squares = (error / deviation).array().square();
  deviation = std::max(deviation * std::sqrt((squares * (STUDENT + 1.0) / (STUDENT + squares)).mean()), LEAST);
  squares = (error / deviation).array().square();
  const double told = std::min(1.0, INDEPENDENT / static_cast<double>(rows.size()));
  const Eigen::ArrayXd weights = told * (STUDENT + 1.0) / (STUDENT + squares) / (deviation * deviation);
  point.cost += told * (static_cast<double>(rows.size()) * std::log(deviation) + squares.unaryExpr(&rarer).sum());
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
}

bool ArmEstimator::isNear(const Point& point, const Point& other)
{
  constexpr double NEAR = 0.1;  // largest distance between near points, in posterior standard deviations of a term [-]
  return other.at.size() == point.at.size() &&
         ((point.at - other.at).array().square() * point.information.diagonal().array()).maxCoeff() < NEAR * NEAR;
}

/// Refines the values `at` of the terms by Gauss-Newton steps until the cost stays constant, or until the point is near
/// `best`, the result of another start. `start`: as in looseness(). Each step computes weights, standard deviations and
/// priors from the last values (expectation and maximisation), so that no single step makes the values less likely.
ArmEstimator::Point ArmEstimator::refine(const Prior& prior, const std::vector<bool>& states, Eigen::VectorXd at,
                                         int start, const Point& best) const
{
  constexpr int ROUNDS = 60;
  constexpr int LOOSE_ROUNDS = 5;
  constexpr double NOTHING = 1e-3;
  constexpr double MOST = 0.8;  // largest assumed ratio of the length of a step to that of the step before [-]
  Point point;
  point.at = std::move(at);
  point.deviations.resize(rows_.size());
  Work work;
  double cost = point.cost;
  Eigen::VectorXd last_step = Eigen::VectorXd::Zero(size_);
  bool is_single = false;
  for (int round = 0; round < ROUNDS; ++round)
  {
    point.information = Eigen::MatrixXd::Zero(size_, size_);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
    point.rareness = point.cost = 0.0;
    addPrior(prior, round < LOOSE_ROUNDS ? start : HELD, point, right);
    point.of_prior = point.information.diagonal();
    for (std::size_t i = 0; i < rows_.size(); ++i)
    {
      if (!rows_[i].empty())
      {
        addRows(i, states, work, point, right);
      }
    }
    point.cost += point.rareness;
    if (round > LOOSE_ROUNDS && (std::abs(cost - point.cost) < NOTHING || isNear(point, best)))
    {
      break;
    }
    cost = point.cost;
    // Steps shrink by nearly the same ratio each round, so every second step is replaced by the sum of this step and
    // all later steps.
    const Eigen::VectorXd step = point.information.ldlt().solve(right);
    const Eigen::VectorXd weighted = point.information.diagonal().cwiseProduct(last_step);
    const double size = last_step.dot(weighted);
    const double ratio = size > 0.0 ? std::clamp(step.dot(weighted) / size, 0.0, MOST) : 0.0;
    is_single = round <= LOOSE_ROUNDS || !is_single;
    point.at += is_single ? step : Eigen::VectorXd(step / (1.0 - ratio));
    last_step = step;
  }
  return point;
}
}  // namespace hjt
