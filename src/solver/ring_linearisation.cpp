// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_linearisation.hpp"

#include <algorithm>

#include "solver/ring_vectors.hpp"

namespace hjt
{
namespace
{
/// How often the teeth that a tangent is of stand in the ring.
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
}  // namespace hjt
