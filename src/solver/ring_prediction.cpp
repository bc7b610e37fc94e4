// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"
#include "solver/ring_vectors.hpp"

namespace hjt
{
namespace
{
/// `number` less a multiple of `size`: 0 ... size - 1.
int wrapped(int number, int size) noexcept
{
  return (number % size + size) % size;
}
}  // namespace

RingPrediction::RingPrediction(const RingModel& model)
  : model_(model)
  , pitch_cos_(std::cos(model.rest.pitchAngle()))
  , pitch_sin_(std::sin(model.rest.pitchAngle()))
  , pitch_output_angle_(model.rest.pitchAngle() - TWO_PI / model.gear.teeth_circular_spline)
  , guess_(model.rest.points())
  , guess_error_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , scratch_(guess_)
  , old_space_(static_cast<std::size_t>(model.rest.teeth()))
{
}

void RingPrediction::predict(const DrivePosition& target, RingState& state) noexcept
{
  constexpr double ALIKE = 0.8;  // smaller similarities are chance
  const int teeth = state.shape.solved;
  double share = 0.0;
  if (guessed_)
  {
    ring_vectors::addScaled(state.shape.points, -1.0, guess_, scratch_, teeth);
    const double size = ring_vectors::dot(guess_error_, guess_error_, teeth);
    share = size > 0.0 ? std::min(1.0, ring_vectors::dot(scratch_, guess_error_, teeth) / size) : 0.0;
    guess_error_.swap(scratch_);
  }
  guess(target, state);
  guess_ = state.shape.points;
  guessed_ = true;
  if (share > ALIKE)
  {
    ring_vectors::addScaled(guess_, share, guess_error_, state.shape.points, teeth);
  }
  state.shape.updateGeometry();
  state.position = target;
}

void RingPrediction::forget() noexcept
{
  guessed_ = false;
  guess_error_.setZero();
}

void RingPrediction::guess(const DrivePosition& target, RingState& state) noexcept
{
  constexpr double SMALL = 0.02;       // of a pitch; below it the tangent alone is as good
  constexpr double MAX_PITCHES = 1e9;  // counted as an int
  const double pitch = model_.rest.pitchAngle();
  const double pitches = (target.wave_generator_angle - state.position.wave_generator_angle) / pitch;
  if (model_.meshed() && std::abs(pitches) > SMALL && std::abs(pitches) < MAX_PITCHES)
  {
    const int whole = static_cast<int>(pitches);
    if (whole != 0)
    {
      shift(whole, state);
    }
    const int sense = pitches < 0.0 ? -1 : 1;
    const double u = std::abs(pitches - whole);
    const double blend = u * u * (3.0 - 2.0 * u);
    const double start_slope = sense * u * (1.0 - u) * (1.0 - u);
    const double end_slope = -sense * u * u * (1.0 - u);
    const double rest = target.output_angle - state.position.output_angle - sense * u * pitch_output_angle_;
    ring_vectors::addTurned({ state.shape.points, state.by_wave_generator, state.by_output },
                            { 1.0 - blend, start_slope * pitch, start_slope * pitch_output_angle_ + rest },
                            { blend, end_slope * pitch, end_slope * pitch_output_angle_ },
                            wrapped(sense, state.shape.teeth()), pitch_cos_, sense * pitch_sin_, scratch_,
                            state.shape.solved);
    state.shape.points.swap(scratch_);
    if (u > 0.5)
    {
      turnSpaces(sense, state.shape);  // the copy is the nearer one
    }
  }
  else
  {
    state.shape.points +=
        (target.wave_generator_angle - state.position.wave_generator_angle) * state.by_wave_generator +
        (target.output_angle - state.position.output_angle) * state.by_output;
  }
}

/// The whole state turned by `pitches` tooth pitches, the spaces with it.
/// On a drive of equal teeth this is an equilibrium again, exactly; on a faulty one a good guess.
void RingPrediction::shift(int pitches, RingState& state) noexcept
{
  for (Eigen::VectorXd* values : { &state.shape.points, &state.by_wave_generator, &state.by_output })
  {
    turn(*values, pitches, scratch_);
    values->swap(scratch_);
  }
  turnSpaces(pitches, state.shape);
  state.position.wave_generator_angle += pitches * model_.rest.pitchAngle();
  state.position.output_angle += pitches * pitch_output_angle_;
}

/// Values of a ring turned by `pitches` tooth pitches: those of tooth i, rotated, take the place of tooth i + pitches.
void RingPrediction::turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept
{
  const double angle = pitches * model_.rest.pitchAngle();
  ring_vectors::turn(values, wrapped(pitches, model_.rest.teeth()), std::cos(angle), std::sin(angle), turned);
}

/// The spaces turned likewise.
void RingPrediction::turnSpaces(int pitches, RingShape& shape) noexcept
{
  const int n = shape.teeth();
  const int spaces = model_.gear.teeth_circular_spline;
  const int places = wrapped(pitches, n);
  const int further = wrapped(pitches, spaces);
  const std::vector<int>& space = shape.space;
  std::rotate_copy(space.begin(), space.end() - places, space.end(), old_space_.begin());
  for (int& turned : old_space_)
  {
    turned += turned + further < spaces ? further : further - spaces;
  }
  shape.space.swap(old_space_);
}
}  // namespace hjt
