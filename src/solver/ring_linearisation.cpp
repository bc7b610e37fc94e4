// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_linearisation.hpp"

#include <algorithm>

#include "solver/ring_vectors.hpp"

namespace hjt
{
RingLinearisation::RingLinearisation(const RingModel& model)
  : model_(model)
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
  model_.forces(state.shape, state.position, forces_, circular_spline_in);
}

void RingLinearisation::updateTangent(const RingState& state) noexcept
{
  model_.tangent(state.shape, forces_, tangent_);
}

void RingLinearisation::shift(double stiffness) noexcept
{
  tangent_.diagonal.xx.array() += stiffness;
  tangent_.diagonal.yy.array() += stiffness;
}

bool RingLinearisation::refactor(const RingState& state) noexcept
{
  factored_ = true;
  factored_meshed_ = forces_.of<ToothMesh>().meshed;
  factored_depth_ = forces_.of<WaveGeneratorContact>().depth;
  updateTangent(state);
  rates_known_ = false;
  return factor();
}

bool RingLinearisation::slopesChanged() const noexcept
{
  const double copies = tangent_.solved < tangent_.teeth() ? 2.0 : 1.0;
  if (!factored_ ||
      copies * model_.of<CupTorsion>().stiffness(forces_.of<CupTorsion>().rotation) != tangent_.cup_stiffness)
  {
    return true;
  }
  return forces_.of<ToothMesh>().meshed != factored_meshed_ ||
         (model_.of<WaveGeneratorContact>().hasKinks() &&
          ring_vectors::signsChanged(forces_.of<WaveGeneratorContact>().depth, factored_depth_, tangent_.solved) != 0);
}

void RingLinearisation::solve(Eigen::VectorXd& step) noexcept
{
  step = forces_.teeth;
  solver().solve<1>(step);
  if (tangent_.solved < tangent_.teeth())
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
  if (tangent_.solved < tangent_.teeth())
  {
    repeatHalfTurned(by_wave_generator_);
    repeatHalfTurned(by_output_);
    repeatHalfTurned(tangent_.wave_generator);
    repeatHalfTurned(tangent_.output);
  }
  state.by_wave_generator.swap(by_wave_generator_);
  state.by_output.swap(by_output_);
  rates_known_ = false;
  const double cross = ring_vectors::dot(tangent_.wave_generator, state.by_output, model_.rest.teeth());
  state.stiffness(0, 0) = tangent_.wave_generator_stiffness +
                          ring_vectors::dot(tangent_.wave_generator, state.by_wave_generator, model_.rest.teeth());
  state.stiffness(1, 1) =
      tangent_.output_stiffness + ring_vectors::dot(tangent_.output, state.by_output, model_.rest.teeth());
  state.stiffness(0, 1) = state.stiffness(1, 0) = cross;
}

double RingLinearisation::residual() const noexcept
{
  return ring_vectors::largest(forces_.teeth, model_.rest.teeth());
}

double RingLinearisation::stiffest() const noexcept
{
  return std::max(tangent_.diagonal.xx.maxCoeff(), tangent_.diagonal.yy.maxCoeff());
}
}  // namespace hjt
