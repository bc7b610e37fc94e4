// SPDX-License-Identifier: BSD-3-Clause
#include "solver/newton_solver.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
/// How many times the teeth of the tangent occur in the ring: 2 if the tangent is that of half a ring.
int copiesOf(const RingTangent& tangent) noexcept
{
  return tangent.solved < tangent.teeth() ? 2 : 1;
}
}  // namespace

RingLinearisation::RingLinearisation(const RingModel& model)
  : model_(&model)
  , solver_(model.rest.teeth())
  , half_solver_(std::max(model.rest.teeth() / 2, 8))
  , tangent_(model.rest.teeth())
  , forces_(model.rest.teeth())
  , factored_meshed_(forces_.of<ToothMesh>().meshed)
  , factored_depth_(forces_.of<WaveGeneratorContact>().depth)
  , step_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , by_wave_generator_(step_)
  , by_output_(step_)
{
}

void RingLinearisation::updateForces(const RingState& state) noexcept
{
  model_->forces(state.shape, state.position, forces_, circular_spline_in);
}

void RingLinearisation::updateTangent(const RingState& state) noexcept
{
  model_->tangent(state.shape, forces_, tangent_);
}

void RingLinearisation::shift(double stiffness) noexcept
{
  tangent_.diagonal.xx.array() += stiffness;
  tangent_.diagonal.yy.array() += stiffness;
}

bool RingLinearisation::refactor(const RingState& state) noexcept
{
  factored_meshed_ = forces_.of<ToothMesh>().meshed;
  factored_depth_ = forces_.of<WaveGeneratorContact>().depth;
  updateTangent(state);
  rates_known_ = false;
  return factor();
}

bool RingLinearisation::slopesChanged(const RingState& state, bool all_teeth) const noexcept
{
  return cupStiffness() != state.cup_stiffness || touchChanged(all_teeth);
}

bool RingLinearisation::slopesChanged(bool all_teeth) const noexcept
{
  return copiesOf(tangent_) * cupStiffness() != tangent_.cup_stiffness || touchChanged(all_teeth);
}

double RingLinearisation::cupStiffness() const noexcept
{
  return model_->of<CupTorsion>().stiffness(forces_.of<CupTorsion>().rotation);
}

bool RingLinearisation::touchChanged(bool all_teeth) const noexcept
{
  return (all_teeth && forces_.of<ToothMesh>().meshed != factored_meshed_) ||
         (model_->of<WaveGeneratorContact>().hasKinks() &&
          ring_vectors::signsChanged(forces_.of<WaveGeneratorContact>().depth, factored_depth_, tangent_.solved) != 0);
}

void RingLinearisation::solve(Eigen::VectorXd& step) noexcept
{
  step = forces_.teeth;
  solver().solve<1>(step);
  if (copiesOf(tangent_) > 1)
  {
    repeatHalfTurned(step);
  }
}

const Eigen::VectorXd& RingLinearisation::newtonStep() noexcept
{
  if (rates_known_)
  {
    solve(step_);
    return step_;
  }
  step_ = forces_.teeth;
  by_wave_generator_ = -tangent_.wave_generator;
  by_output_ = -tangent_.output;
  solver().solve(step_, by_wave_generator_, by_output_);
  rates_known_ = true;
  return step_;
}

void RingLinearisation::moveSensitivities(RingState& state) noexcept
{
  if (!rates_known_)
  {
    newtonStep();
  }
  const int copies = copiesOf(tangent_);
  if (copies > 1)
  {
    repeatHalfTurned(by_wave_generator_);
    repeatHalfTurned(by_output_);
  }
  state.by_wave_generator.swap(by_wave_generator_);
  state.by_output.swap(by_output_);
  state.cup_stiffness = tangent_.cup_stiffness / copies;
  rates_known_ = false;
  const auto work = [&](const Eigen::VectorXd& mixed, const Eigen::VectorXd& rates)
  { return copies * ring_vectors::dot(mixed, rates, tangent_.solved); };
  state.stiffness(0, 0) = tangent_.wave_generator_stiffness + work(tangent_.wave_generator, state.by_wave_generator);
  state.stiffness(1, 1) = tangent_.output_stiffness + work(tangent_.output, state.by_output);
  state.stiffness(0, 1) = state.stiffness(1, 0) = work(tangent_.wave_generator, state.by_output);
}

double RingLinearisation::residual() const noexcept
{
  return ring_vectors::largest(forces_.teeth, model_->rest.teeth());
}

double RingLinearisation::stiffest() const noexcept
{
  return std::max(tangent_.diagonal.xx.maxCoeff(), tangent_.diagonal.yy.maxCoeff());
}

EnergyDescent::EnergyDescent(const RingModel& model, double tolerance)
  : model_(&model)
  , tolerance_(tolerance)
  , start_points_(model.rest.points())
  , start_forces_(start_points_)
  , step_(start_points_)
  , old_space_(static_cast<std::size_t>(model.rest.teeth()))
{
}

/// Computes a step on which the energy decreases, stores the step in `step_`, and its start in `start_points_`.
bool EnergyDescent::findWayDown(RingLinearisation& system, const RingState& state) noexcept
{
  constexpr int MAX_SHIFTS = 30;
  constexpr double FIRST_SHIFT = 1e-6;  // first increase of the diagonal over its stiffest entry [-]
  double shift = 0.0;
  for (int i = 0; i < MAX_SHIFTS; ++i)
  {
    start_forces_ = system.forces().teeth;
    system.solve(step_);
    const double slope = step_.dot(start_forces_);
    if (std::isfinite(slope) && slope > 0.0)
    {
      start_points_ = state.shape.points;
      return true;
    }
    const double add = shift > 0.0 ? 3.0 * shift : FIRST_SHIFT * system.stiffest();
    system.shift(add);
    shift += add;
    if (!system.factor())
    {
      return false;
    }
  }
  return false;
}

/// Moves to the start plus `length` times the step. @returns minus the slope of the energy along the step [J].
double EnergyDescent::slopeAt(double length, RingLinearisation& system, RingState& state) noexcept
{
  state.shape.points = start_points_ + length * step_;
  state.shape.updateGeometry();
  system.updateForces(state);
  return system.forces().teeth.dot(step_);
}

bool EnergyDescent::step(RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_TRIALS = 40;
  constexpr double LEVEL = 0.3;  // slope that counts as level, over the slope at the start [-]
  if (!findWayDown(system, state))
  {
    return false;
  }
  const double first = step_.dot(start_forces_);
  double low = 0.0;
  double high = 1.0;
  double length = 1.0;
  for (int i = 0; i < MAX_TRIALS; ++i)
  {
    const double slope = slopeAt(length, system, state);
    if (system.residual() <= tolerance_ || (length == 1.0 && slope >= -LEVEL * first) ||
        std::abs(slope) <= LEVEL * first)
    {
      return true;
    }
    (slope > 0.0 ? low : high) = length;
    length = 0.5 * (low + high);
  }
  return false;
}

/// Solves with `damping` [N/m] added to the stiffness of every tooth. The step is kept if it lowers the energy or, if
/// the change of the energy is within rounding, the largest force. @returns whether the step is kept.
bool EnergyDescent::dampedStep(double damping, RingLinearisation& system, RingState& state) noexcept
{
  constexpr double ROUNDING = 1e-12;  // rounding of the energy, as a share of the energy [-]
  const double energy = system.forces().energy;
  const double residual = system.residual();
  system.updateTangent(state);
  system.shift(damping);
  if (!system.factor())
  {
    return false;
  }
  system.solve(step_);
  start_points_ = state.shape.points;
  state.shape.points += step_;
  state.shape.updateGeometry();
  system.updateForces(state);
  const double now = system.forces().energy;
  if (now < energy * (1.0 - ROUNDING) || (now < energy * (1.0 + ROUNDING) && system.residual() < residual))
  {
    return true;
  }
  state.shape.points = start_points_;
  state.shape.updateGeometry();
  return false;
}

/// Assigns the nearest space to teeth that have left their space. @returns whether the space of any tooth changed.
bool EnergyDescent::pairsAgain(RingState& state) noexcept
{
  old_space_ = state.shape.space;
  if (model_->meshed())
  {
    model_->of<ToothMesh>().pairNearest(state.position, state.shape);
  }
  return old_space_ != state.shape.space;
}

SolveStatus EnergyDescent::descend(RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_STEPS = 200;         // a snap of teeth needs up to 34 steps; a running twin needs a limit
  constexpr double FIRST_DAMPING = 1e6;  // damping of the first step [N/m]
  constexpr double MIN_DAMPING = 1e-3;
  constexpr double MAX_DAMPING = 1e16;
  SolveStatus status;
  double damping = FIRST_DAMPING;
  while (status.iterations < MAX_STEPS && damping < MAX_DAMPING)
  {
    system.updateForces(state);
    status.residual = system.residual();
    if (status.residual > tolerance_)
    {
      ++status.iterations;
      damping = dampedStep(damping, system, state) ? std::max(MIN_DAMPING, 0.2 * damping) : 5.0 * damping;
    }
    else if (pairsAgain(state))
    {
      damping = FIRST_DAMPING;
    }
    else
    {
      status.code = system.refactor(state) ? SolveCode::CONVERGED : SolveCode::SINGULAR;
      return status;
    }
  }
  status.code = SolveCode::NO_DESCENT;
  return status;
}

NewtonSolver::NewtonSolver(const RingModel& model, int max_iterations)
  : max_iterations_(max_iterations), start_points_(model.rest.points())
{
}

SolveStatus NewtonSolver::solve(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state,
                                EnergyDescent* descent) noexcept
{
  SolveStatus status;
  status.residual = system.residual();
  if (status.residual <= goal.guess && !system.slopesChanged(state, goal.present_rates))
  {
    state.residual = status.residual;
    return status;  // the guess is accurate enough without a Newton step
  }
  status.code = iterate(goal, system, state, descent, status);
  if (status.ok() && system.slopesChanged(goal.present_rates) && !system.refactor(state))
  {
    status.code = SolveCode::SINGULAR;
  }
  if (status.ok())
  {
    system.moveSensitivities(state);
    state.residual = status.residual;
  }
  return status;
}

SolveCode NewtonSolver::iterate(const EquilibriumGoal& goal, RingLinearisation& system, RingState& state,
                                EnergyDescent* descent, SolveStatus& status) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.1;  // largest ratio of successive forces for a second use of the factors [-]
  constexpr int DESCENT = 5;  // factor on the iterations; every few contacts that begin or end need an iteration
  const int max_iterations = (descent != nullptr ? DESCENT : 1) * max_iterations_;
  bool fresh = false;
  while (std::isfinite(status.residual))
  {
    const bool near = status.residual <= (status.iterations > 0 ? goal.residual : goal.guess);
    const bool good_rates = fresh || (near && status.iterations > 0 && !goal.present_rates);
    if (!good_rates && !system.refactor(state))
    {
      return SolveCode::SINGULAR;
    }
    if (near)
    {
      return SolveCode::CONVERGED;
    }
    if (++status.iterations > max_iterations)
    {
      status.max_iterations = max_iterations_;
      return SolveCode::ITERATION_LIMIT;
    }
    if (!(descent != nullptr ? descent->step(system, state) :
                               searchLine(status.residual, goal.residual, system, state)))
    {
      return SolveCode::NO_DESCENT;
    }
    const double residual = system.residual();
    fresh = descent == nullptr && residual < GOOD_CONTRACTION * status.residual;
    status.residual = residual;
  }
  return SolveCode::NOT_FINITE;
}

/// Takes one Newton step, shortened until the largest force decreases or is at most `enough` [N].
bool NewtonSolver::searchLine(double residual, double enough, RingLinearisation& system, RingState& state) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  const Eigen::VectorXd& step = system.newtonStep();
  start_points_.swap(state.shape.points);
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    ring_vectors::addScaled(start_points_, length, step, state.shape.points, state.shape.solved);
    state.shape.updateGeometry();
    system.updateForces(state);
    const double trial = system.residual();
    if (trial < (1.0 - 1e-4 * length) * residual || trial <= enough)
    {
      return true;
    }
  }
  return false;
}
}  // namespace hjt
