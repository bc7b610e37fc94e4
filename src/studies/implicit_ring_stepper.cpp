// SPDX-License-Identifier: BSD-3-Clause
#include "studies/implicit_ring_stepper.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
ImplicitRingStepper::ImplicitRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau,
                                         const SolverParameters& solver)
  : ring_(ring)
  , tableau_(tableau)
  , parameters_(solver)
  , weight_(Eigen::VectorXd::Ones(ring.coordinates()))
  , tangent_(ring.teeth())
  , solver_(ring.teeth())
  , speeds_(static_cast<std::size_t>(tableau.stages()), Eigen::VectorXd::Zero(ring.coordinates()))
  , accelerations_(speeds_)
  , powers_(speeds_.size())
  , q_bar_(ring.coordinates())
  , v_bar_(ring.coordinates())
  , q_(ring.coordinates())
  , v_(ring.coordinates())
  , residual_(ring.coordinates())
  , newton_(ring.coordinates())
  , start_(ring.coordinates())
  , begin_(ring.coordinates())
{
  weight_.tail<2>().setConstant(1.0 / ring.shape().points.head<2>().norm());
  free_ = ring.mass().cwiseProduct(ring.inverseMass());
}

bool ImplicitRingStepper::step(RingMotion& motion, double length) noexcept
{
  const double end = motion.time + length;
  begin_ = motion;
  double stride = length;
  int halvings = 0;
  restart();
  ring_.pairTeeth(motion.q, motion.time);
  double done = 0.0;
  while (done < length)
  {
    const double next = std::min(stride, length - done);
    if (attempt(motion, next))
    {
      done = next < length - done ? done + next : length;
      stride *= 2.0;
      accept();
      ring_.pairTeeth(motion.q, motion.time);
      continue;
    }
    ++counts_.halvings;
    if (++halvings > parameters_.max_step_cuts)
    {
      motion = begin_;
      return false;
    }
    stride = 0.5 * next;
  }
  motion.time = end;
  ++counts_.steps;
  return true;
}

bool ImplicitRingStepper::attempt(RingMotion& motion, double length) noexcept
{
  stage_step_ = tableau_.gamma * length;
  factored_ = false;
  const int stages = tableau_.stages();
  q_ = motion.q;
  v_ = motion.v;
  for (int i = 0; i < stages; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    const double time = motion.time + tableau_.times[k] * length;
    if (i == 0 && tableau_.explicit_first)
    {
      if (!begun_)
      {
        ring_.evaluate(motion.q, motion.v, time);
        ++counts_.force_evaluations;
        begin(motion.v);
      }
    }
    else
    {
      q_bar_ = motion.q;
      v_bar_ = motion.v;
      for (std::size_t j = 0; j < k; ++j)
      {
        q_bar_ += length * tableau_.before[k][j] * speeds_[j];
        v_bar_ += length * tableau_.before[k][j] * accelerations_[j];
      }
      // Guess: on from the stage before with its acceleration. A driven body keeps its speed exactly.
      if (i > 0)
      {
        v_ += (tableau_.times[k] - tableau_.times[k - 1]) * length * accelerations_[k - 1];
      }
      if (!solveStage(time))
      {
        return false;
      }
      speeds_[k] = v_;
      accelerations_[k] = (v_ - v_bar_) / stage_step_;
      powers_[k] = ring_.power();
    }
  }
  error_ = 0.0;
  if (!tableau_.error.empty())
  {
    start_.setZero();
    for (int i = 0; i < stages; ++i)
    {
      start_ += length * tableau_.error[static_cast<std::size_t>(i)] * speeds_[static_cast<std::size_t>(i)];
    }
    error_ = start_.head(start_.size() - 2).lpNorm<Eigen::Infinity>();
  }
  for (int i = 0; i < stages; ++i)
  {
    motion.supplied += length * tableau_.weight(i) * powers_[static_cast<std::size_t>(i)].supplied;
    motion.dissipated += length * tableau_.weight(i) * powers_[static_cast<std::size_t>(i)].dissipated;
  }
  motion.q = q_;
  motion.v = v_;
  motion.time += length;
  return true;
}

/// The explicit first stage, from the forces the ring was last evaluated at.
void ImplicitRingStepper::begin(const Eigen::VectorXd& speeds) noexcept
{
  speeds_.front() = speeds;
  accelerations_.front() = ring_.force().cwiseProduct(ring_.inverseMass());
  powers_.front() = ring_.power();
  begun_ = true;
}

void ImplicitRingStepper::accept() noexcept
{
  if (tableau_.explicit_first)
  {
    begin(v_);  // the last stage was the step's end
  }
}

/// Out-of-balance force at the speeds v_, into residual_; q_ follows. The speeds are the unknowns because they keep
/// their digits in short steps, where differences of positions would lose them. @returns its Euclidean length, torques
/// as forces at the rim [N].
double ImplicitRingStepper::residual(double time) noexcept
{
  q_ = q_bar_ + stage_step_ * v_;
  ring_.evaluate(q_, v_, time);
  ++counts_.force_evaluations;
  residual_ = (ring_.force() - ring_.mass().cwiseProduct(v_ - v_bar_) / stage_step_).cwiseProduct(free_);
  largest_ = residual_.cwiseProduct(weight_).lpNorm<Eigen::Infinity>();
  return residual_.cwiseProduct(weight_).norm();
}

bool ImplicitRingStepper::factor() noexcept
{
  ring_.tangent(1.0 / stage_step_, tangent_);
  const double inverse_square = 1.0 / (stage_step_ * stage_step_);
  const Eigen::VectorXd& mass = ring_.mass();
  for (int i = 0; i < tangent_.teeth(); ++i)
  {
    tangent_.addDiagonal(i, Block2((inverse_square * mass.segment<2>(2 * i)).asDiagonal()));
  }
  tangent_.wave_generator_stiffness += inverse_square * mass[ring_.waveGenerator()];
  tangent_.output_stiffness += inverse_square * mass[ring_.output()];
  ++counts_.factorisations;
  factored_ = solver_.factor(tangent_, { ring_.driven(ring_.waveGenerator()), ring_.driven(ring_.output()) });
  return factored_;
}

bool ImplicitRingStepper::solveStage(double time) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.01;  // better than this, the factors serve on
  double norm = residual(time);
  bool useful = factored_;
  bool own = false;  // the factors are of this very point
  for (int i = 0; i < parameters_.max_iterations; ++i)
  {
    if (!std::isfinite(norm))
    {
      return false;
    }
    if (largest_ <= parameters_.force_tolerance)
    {
      return true;
    }
    own = !useful;
    if (own && !factor())
    {
      return false;
    }
    const double before = norm;
    if (!searchLine(time, norm))
    {
      if (own)
      {
        return false;
      }
      useful = false;  // stale factors may point nowhere: once more with those of this point
      continue;
    }
    useful = norm < GOOD_CONTRACTION * before;
  }
  return largest_ <= parameters_.force_tolerance;
}

/// One Newton step, shortened until the out-of-balance force falls.
bool ImplicitRingStepper::searchLine(double time, double& norm) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  newton_ = residual_;
  solver_.solve(newton_);
  newton_ /= stage_step_;
  start_ = v_;
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    v_ = start_ + length * newton_;
    const double trial = residual(time);
    if (trial < (1.0 - 1e-4 * length) * norm || largest_ <= parameters_.force_tolerance)
    {
      norm = trial;
      return true;
    }
  }
  v_ = start_;
  norm = residual(time);
  return false;
}
}  // namespace hjt
