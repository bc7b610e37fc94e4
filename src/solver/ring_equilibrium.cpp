// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"

namespace hjt
{
namespace
{
DrivePosition between(const DrivePosition& a, const DrivePosition& b, double fraction) noexcept
{
  return { a.wave_generator_angle + fraction * (b.wave_generator_angle - a.wave_generator_angle),
           a.output_angle + fraction * (b.output_angle - a.output_angle),
           a.wave_amplitude + fraction * (b.wave_amplitude - a.wave_amplitude) };
}
}  // namespace

RingEquilibrium::RingEquilibrium(const RingModel& model, const SolverParameters& parameters)
  : model_(&model)
  , model_version_(model.version())
  , now_(model)
  , start_(now_)
  , halfway_(now_)
  , kept_(now_)
  , system_(model)
  , rounding_(measureRounding())
  , tolerance_(std::max(parameters.force_tolerance, rounding_))
  , max_step_cuts_(parameters.max_step_cuts)
  , prediction_(model)
  , goal_{ tolerance_, tolerance_, true }
  , newton_(model, parameters.max_iterations)
  , descent_(model, tolerance_)
  , round_(now_.shape.points)
{
}

/// Value of rounding() [N]. In the shipped gear this force is a thousandth of the shipped tolerance. It limits the
/// tolerance only in a gear with a much stiffer rim or much finer teeth than the shipped gear.
double RingEquilibrium::measureRounding() noexcept
{
  system_.updateForces(now_);
  system_.updateTangent(now_);
  return std::numeric_limits<double>::epsilon() * model_->gear.flexspline_inner_radius * system_.stiffest();
}

SolveStatus RingEquilibrium::insert(const DrivePosition& target) noexcept
{
  beginRound(target);
  const bool wedged = now_.residual > tolerance_;
  SolveStatus status = moveTo(target);
  if (!status.ok() && wedged)
  {
    status = insertWedged(target).addEffort(status);
  }
  if (!status.ok())
  {
    beginRound(target);
    descending_ = true;
    status = moveTo(target).addEffort(status);
    descending_ = false;
  }
  status.stage = SolveStage::INSERTION;
  return status;
}

/// Insertion for a round ring that jams in an eccentric circular spline. Without the circular spline the wave generator
/// grows to 99 % of its amplitude. Then the circular spline is added.
SolveStatus RingEquilibrium::insertWedged(const DrivePosition& target) noexcept
{
  constexpr double NEARLY = 0.99;
  DrivePosition before = target;
  before.wave_amplitude *= NEARLY;
  system_.circular_spline_in = false;
  beginRound(target);
  const SolveStatus status = moveTo(before);
  system_.circular_spline_in = true;
  if (!status.ok())
  {
    return status;
  }
  system_.updateForces(now_);
  now_.residual = system_.residual();
  return moveTo(target).addEffort(status);
}

SolveStatus RingEquilibrium::solveFrom(const Eigen::VectorXd& points, const DrivePosition& position) noexcept
{
  begin(points, position);
  return moveTo(position);
}

/// Sets the ring to the state before the insertion: round, about the wave generator's centre.
void RingEquilibrium::beginRound(const DrivePosition& target) noexcept
{
  const Eigen::Vector2d centre = model_->of<WaveGeneratorContact>().centre(target);
  for (int i = 0; i < now_.shape.teeth(); ++i)
  {
    round_.segment<2>(2 * i) = model_->rest.points().segment<2>(2 * i) + centre;
  }
  begin(round_, { target.wave_generator_angle, target.output_angle, 0.0 });
}

/// Sets the tooth points to `points`, which need not be in equilibrium.
void RingEquilibrium::begin(const Eigen::VectorXd& points, const DrivePosition& position) noexcept
{
  now_.position = position;
  now_.shape.points = points;
  prediction_.forget();
  followModel();
  model_->of<ToothMesh>().pairAtRest(now_.position, now_.shape);
  now_.by_wave_generator.setZero();
  now_.by_output.setZero();
  now_.stiffness.setZero();
  now_.cup_stiffness = 0.0;
  system_.updateForces(now_);
  now_.residual = system_.residual();
}

/// Stores the version of the model and determines the number of teeth to solve.
void RingEquilibrium::followModel() noexcept
{
  model_version_ = model_->version();
  now_.shape.solved = model_->solvedTeeth();
  now_.shape.updateGeometry();
  now_.shape.repeatSpaces(model_->gear.teeth_circular_spline);
}

void RingEquilibrium::restore(const RingState& state) noexcept
{
  now_ = state;
  now_.shape.updateGeometry();
  prediction_.forget();
  system_.updateForces(now_);
}

SolveStatus RingEquilibrium::reinsert(const DrivePosition& target) noexcept
{
  kept_ = now_;
  const SolveStatus status = insert(target);
  if (!status.ok())
  {
    restore(kept_);
  }
  return status;
}

SolveStatus RingEquilibrium::updateModel() noexcept
{
  followModel();
  now_.cup_stiffness = 0.0;
  prediction_.forget();
  system_.updateForces(now_);
  const DrivePosition target = now_.position;
  start_.keep(now_);
  SolveStatus status = approach(target);
  if (!status.ok())
  {
    now_ = start_;
    status = reinsert(target).addEffort(status);
  }
  return status;
}

Eigen::Vector2d RingEquilibrium::torques() const noexcept
{
  const RingForces& sum = system_.forces();
  const int teeth = now_.shape.solved;
  const double copies = now_.shape.copies();
  return { sum.wave_generator_torque + copies * ring_vectors::dot(sum.teeth, now_.by_wave_generator, teeth),
           sum.output_torque + copies * ring_vectors::dot(sum.teeth, now_.by_output, teeth) };
}

bool RingEquilibrium::refreshSensitivities() noexcept
{
  const bool factored = system_.refactor(now_);
  if (factored)
  {
    system_.moveSensitivities(now_);
  }
  return factored;
}

SolveStatus RingEquilibrium::moveTo(const DrivePosition& target) noexcept
{
  if (model_version_ != model_->version())
  {
    const SolveStatus followed = updateModel();
    return followed.ok() ? moveTo(target).addEffort(followed) : followed;
  }
  if (target == now_.position && now_.residual <= goal_.residual)
  {
    SolveStatus unmoved;
    unmoved.residual = now_.residual;
    return unmoved;
  }
  start_.keep(now_);
  SolveStatus status = approach(target);
  if (!status.ok())
  {
    restore(start_);
    status.residual = std::isfinite(status.residual) ? status.residual : now_.residual;
  }
  return status;
}

SolveStatus RingEquilibrium::moveTo(const DrivePosition& target, const Eigen::VectorXd& guess) noexcept
{
  start_.keep(now_);
  prediction_.forget();
  now_.shape.points = guess;
  now_.shape.updateGeometry();
  now_.position = target;
  const SolveStatus status = solvePredicted();
  if (!status.ok())
  {
    restore(start_);
  }
  return status;
}

SolveStatus RingEquilibrium::descend(const DrivePosition& target) noexcept
{
  start_.keep(now_);
  prediction_.forget();
  now_.position = target;
  const SolveStatus status = descent_.descend(system_, now_);
  if (!status.ok())
  {
    restore(start_);
    return status;
  }
  system_.moveSensitivities(now_);
  now_.residual = status.residual;
  return status;
}

SolveStatus RingEquilibrium::reach(const DrivePosition& target) noexcept
{
  return reachAfter(moveTo(target), target);
}

SolveStatus RingEquilibrium::follow(const DrivePosition& target) noexcept
{
  constexpr double FOLLOWED = 10.0;  // factor on the tolerance of the forces [-]
  goal_ = { FOLLOWED * tolerance_, tolerance_, false };
  const SolveStatus status = moveTo(target);
  goal_ = { tolerance_, tolerance_, true };
  return reachAfter(status, target);
}

/// Seeks the equilibrium by other methods if `status` is that of a failed `moveTo`. Teeth that begin to touch balls
/// have no stiffness at first, so that Newton's method can fail near an equilibrium. `descend` comes before `reinsert`,
/// because an insertion at a twist beyond half a pitch would move the teeth to the next spaces.
SolveStatus RingEquilibrium::reachAfter(SolveStatus status, const DrivePosition& target) noexcept
{
  if (status.ok() || !std::isfinite(target.wave_generator_angle) || !std::isfinite(target.output_angle))
  {
    return status;
  }
  if (!model_->of<WaveGeneratorContact>().hasKinks())
  {
    status = descend(target).addEffort(status);
  }
  return status.ok() ? status : reinsert(target).addEffort(status);
}

/// Solves at the target or, if this fails, at points on the path to it. The distance to the next point is halved after
/// each failure and doubled after each success.
SolveStatus RingEquilibrium::approach(const DrivePosition& target) noexcept
{
  SolveStatus total;
  double done = 0.0;
  double stride = 1.0;
  while (done < 1.0)
  {
    const double next = std::min(1.0, done + stride);
    const SolveStatus status = solve(next < 1.0 ? between(start_.position, target, next) : target);
    total.iterations += status.iterations;
    total.residual = status.residual;
    total.code = status.code;
    total.max_iterations = status.max_iterations;
    if (status.ok())
    {
      done = next;
      total.jumps += status.jumps;
      stride *= 2.0;
      if (done < 1.0)
      {
        halfway_ = now_;
      }
      continue;
    }
    if (++total.cuts > max_step_cuts_)
    {
      break;
    }
    now_ = done > 0.0 ? halfway_ : start_;
    prediction_.forget();
    stride *= 0.5;
  }
  return total;
}

SolveStatus RingEquilibrium::solve(const DrivePosition& target) noexcept
{
  prediction_.predict(target, now_);
  return solvePredicted();
}

SolveStatus RingEquilibrium::solvePredicted() noexcept
{
  const int jumps = model_->meshed() ? model_->of<ToothMesh>().pairNearest(now_.position, now_.shape) : 0;
  system_.updateForces(now_);
  goal_.guess = tolerance_;
  if (prediction_.fromKept())
  {
    goal_.guess = goal_.residual;  // no tighter limit, because this guess's error does not enter the next guess
    now_.cup_stiffness = 0.0;      // the derivatives are not those of the present teeth
    if (!goal_.present_rates)
    {
      prediction_.takeKeptRates(now_);
    }
  }
  SolveStatus status = newton_.solve(goal_, system_, now_, descending_ ? &descent_ : nullptr);
  status.jumps = jumps;
  if (status.ok() && (status.iterations > 0 || goal_.present_rates))
  {
    prediction_.keep(now_);
  }
  return status;
}

namespace
{
double toothSpace(const RingEquilibrium& ring) noexcept
{
  return TWO_PI / ring.model().gear.teeth_circular_spline;
}

SolveStatus turnWaveGenerator(RingEquilibrium& ring, double angle) noexcept
{
  DrivePosition target = ring.position();
  const double turn = angle - target.wave_generator_angle;
  if (turn == 0.0)
  {
    return {};
  }
  target.wave_generator_angle = angle;
  // Predicts the output angle at constant load. Without stiffness (backlash) the output turns by motor turn / ratio.
  const double stiffness = ring.stiffness()(1, 1);
  target.output_angle +=
      stiffness > 0.0 ? -turn * ring.stiffness()(1, 0) / stiffness : turn / nominalRatio(ring.model().gear);
  return ring.moveTo(target);
}

SolveCode codeOfFailure(const RingEquilibrium& ring, double load_torque) noexcept
{
  if (!std::isfinite(load_torque))
  {
    return SolveCode::NOT_FINITE;
  }
  return ring.forces().output_torque == 0.0 ? SolveCode::DISENGAGED : SolveCode::UNBALANCED;
}
}  // namespace

double balanceTolerance(const RingEquilibrium& ring) noexcept
{
  constexpr double SHARE = 1e-11;  // a few rounding errors of an angle of some radians, over a tooth space [-]
  return std::max(SHARE * toothSpace(ring) * ring.stiffness()(1, 1),
                  ring.rounding() * ring.model().gear.flexspline_inner_radius);
}

SolveStatus balanceOutput(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept
{
  constexpr int MAX_IDLE = 20;          // largest number of successive iterations without progress
  constexpr double CLOSER = 0.999;      // an excess below this share of the least excess so far is progress [-]
  constexpr double FIRST_REACH = 0.01;  // largest length of the first step [tooth spaces]
  constexpr double MAX_REACH = 0.25;    // largest length of a step; teeth change spaces in longer ones [tooth spaces]
  SolveStatus total = turnWaveGenerator(ring, wave_generator_angle);
  double reach = FIRST_REACH * toothSpace(ring);
  double excess = ring.forces().output_torque - load_torque;
  double least = std::abs(excess);
  for (int idle = 0; total.ok() && !(std::abs(excess) <= balanceTolerance(ring));)
  {
    const double stiffness = ring.stiffness()(1, 1);
    const double step = stiffness > 0.0 ? excess / stiffness : std::copysign(reach, excess);
    DrivePosition target = ring.position();
    target.output_angle += std::clamp(step, -reach, reach);
    const SolveStatus moved = ring.moveTo(target);
    total.iterations += moved.iterations;
    total.cuts += moved.cuts;
    total.jumps += moved.jumps;
    total.residual = moved.residual;
    total.max_iterations = moved.max_iterations;
    const double before = std::abs(excess);
    excess = ring.forces().output_torque - load_torque;
    idle = std::abs(excess) < CLOSER * least ? 0 : idle + 1;
    least = std::min(least, std::abs(excess));
    reach =
        moved.ok() && std::abs(excess) <= before ? std::min(2.0 * reach, MAX_REACH * toothSpace(ring)) : 0.5 * reach;
    if (idle > MAX_IDLE)
    {
      total.code = codeOfFailure(ring, load_torque);
      total.stage = SolveStage::BALANCE;
      total.unbalanced_torque = -excess;
    }
  }
  return total;
}

SolveStatus insertUnderLoad(RingEquilibrium& ring, double wave_generator_angle, double load_torque) noexcept
{
  const SolveStatus status = ring.insert({ 0.0, 0.0, ring.model().gear.wave_amplitude });
  return status.ok() ? balanceOutput(ring, wave_generator_angle, load_torque).addEffort(status) : status;
}
}  // namespace hjt
