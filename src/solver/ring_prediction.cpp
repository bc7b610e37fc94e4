// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_prediction.hpp"

#include <algorithm>
#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
constexpr int KEPT = 256;            // number of stored states over a pitch
constexpr double MAX_PITCHES = 1e9;  // largest number of pitches that is converted to int

constexpr int VECTORS = 3;  // number of vectors of a stored state

/// Index of the stored state for a wave generator angle in pitches.
int placeOf(double pitches) noexcept
{
  return std::min(static_cast<int>((pitches - std::floor(pitches)) * KEPT), KEPT - 1);
}

/// `number` modulo `size`: 0 ... size - 1.
int wrapped(int number, int size) noexcept
{
  return (number % size + size) % size;
}
}  // namespace

RingPrediction::RingPrediction(const RingModel& model)
  : model_(&model)
  , pitch_cos_(std::cos(model.rest.pitchAngle()))
  , pitch_sin_(std::sin(model.rest.pitchAngle()))
  , pitch_output_angle_(model.rest.pitchAngle() - TWO_PI / model.gear.teeth_circular_spline)
  , kept_(KEPT)
  , kept_vectors_(model.rest.teeth(), VECTORS * KEPT)
  , kept_spaces_(model.rest.teeth(), KEPT)
  , guess_(model.rest.points())
  , guess_error_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , scratch_(guess_)
  , old_space_(static_cast<std::size_t>(model.rest.teeth()))
{
}

void RingPrediction::predict(const DrivePosition& target, RingState& state) noexcept
{
  constexpr double ALIKE = 0.8;  // least similarity of two errors for a correction of the guess [-]
  const int teeth = state.shape.solved;
  double share = 0.0;
  if (guessed_)
  {
    ring_vectors::addScaled(state.shape.points, -1.0, guess_, scratch_, teeth);
    const double size = ring_vectors::dot(guess_error_, guess_error_, teeth);
    share = size > 0.0 ? std::min(1.0, ring_vectors::dot(scratch_, guess_error_, teeth) / size) : 0.0;
    guess_error_.swap(scratch_);
  }
  if (!guessFromKept(target, state))
  {
    guess(target, state);
  }
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
  from_ = {};
  guess_error_.setZero();
  for (Kept& kept : kept_)
  {
    kept.known = false;
  }
}

void RingPrediction::keep(const RingState& state) noexcept
{
  const double pitches = state.position.wave_generator_angle / model_->rest.pitchAngle();
  if (state.shape.copies() == 1 || !model_->meshed() || !(std::abs(pitches) < MAX_PITCHES))
  {
    return;
  }
  constexpr double SAME_TWIST = 1e-7;  // twists with a smaller difference count as equal [rad]
  const int place = placeOf(pitches);
  Kept& kept = kept_[static_cast<std::size_t>(place)];
  if (kept.known &&
      std::abs(state.position.wave_generator_angle - kept.position.wave_generator_angle) * KEPT <
          model_->rest.pitchAngle() &&
      std::abs(twistSince(kept, state.position)) < SAME_TWIST)
  {
    return;  // the stored state is at this position already
  }
  kept.known = true;
  kept.position = state.position;
  kept.stiffness = state.stiffness;
  kept.cup_stiffness = state.cup_stiffness;
  auto vectors = kept_vectors_.middleCols<VECTORS>(static_cast<Eigen::Index>(VECTORS) * place);
  vectors.col(0) = state.shape.points.head(vectors.rows());
  vectors.col(1) = state.by_wave_generator.head(vectors.rows());
  vectors.col(2) = state.by_output.head(vectors.rows());
  std::copy(state.shape.space.begin(), state.shape.space.end(), kept_spaces_.col(place).data());
}

/// Turn of the output since the stored state minus the turn of the wave generator over the nominal ratio [rad].
double RingPrediction::twistSince(const Kept& kept, const DrivePosition& position) const noexcept
{
  return position.output_angle - kept.position.output_angle -
         (position.wave_generator_angle - kept.position.wave_generator_angle) * pitch_output_angle_ /
             model_->rest.pitchAngle();
}

/// Guesses from the nearest stored state. @returns false and does nothing if no stored state is near `target`.
bool RingPrediction::guessFromKept(const DrivePosition& target, RingState& state) noexcept
{
  constexpr double NEAR_TWIST = 2e-5;  // largest difference of twist from a stored state that gives a guess [rad]
  from_ = {};
  const double pitch = model_->rest.pitchAngle();
  const double pitches = target.wave_generator_angle / pitch;
  const double moved = std::abs(target.wave_generator_angle - state.position.wave_generator_angle) / pitch;
  if (state.shape.copies() == 1 || !model_->meshed() || !(std::abs(pitches) < MAX_PITCHES) || moved < 0.5 / KEPT)
  {
    return false;
  }
  const int place = placeOf(pitches);
  const Kept& kept = kept_[static_cast<std::size_t>(place)];
  if (!kept.known || !(std::abs(twistSince(kept, target)) < NEAR_TWIST))
  {
    return false;
  }
  const double away = (target.wave_generator_angle - kept.position.wave_generator_angle) / pitch;
  const int whole = static_cast<int>(std::lround(away));
  const double rest = target.output_angle - kept.position.output_angle - whole * pitch_output_angle_;
  const int half = state.shape.solved;
  const int places = wrapped(whole, 2 * half);
  const double sign = places < half ? 1.0 : -1.0;
  const double angle = whole * pitch;
  from_ = { place, places % half, sign * std::cos(angle), sign * std::sin(angle) };
  turnKept({ 1.0, (away - whole) * pitch, rest }, half, state.shape.points);
  turnSpaces(kept_spaces_.col(place).data(), whole, state.shape.space);
  return true;
}

void RingPrediction::turnKept(const ring_vectors::Combination::Factors& factors, int half,
                              Eigen::VectorXd& result) const noexcept
{
  const Eigen::Index size = kept_vectors_.rows();
  const double* vectors = kept_vectors_.data() + VECTORS * size * from_.kept;
  ring_vectors::turnHalf({ vectors, vectors + size, vectors + 2 * size }, factors, from_.places, from_.cosine,
                         from_.sine, result, half);
}

void RingPrediction::takeKeptRates(RingState& state) const noexcept
{
  turnKept({ 0.0, 1.0, 0.0 }, state.shape.solved, state.by_wave_generator);
  turnKept({ 0.0, 0.0, 1.0 }, state.shape.solved, state.by_output);
  repeatHalfTurned(state.by_wave_generator);
  repeatHalfTurned(state.by_output);
  const Kept& kept = kept_[static_cast<std::size_t>(from_.kept)];
  state.stiffness = kept.stiffness;
  state.cup_stiffness = kept.cup_stiffness;
}

void RingPrediction::guess(const DrivePosition& target, RingState& state) noexcept
{
  constexpr double SMALL = 0.02;  // turn below which the tangent alone gives as good a guess [pitches]
  const double pitch = model_->rest.pitchAngle();
  const double pitches = (target.wave_generator_angle - state.position.wave_generator_angle) / pitch;
  if (model_->meshed() && std::abs(pitches) > SMALL && std::abs(pitches) < MAX_PITCHES)
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
    ring_vectors::addTurned({ state.shape.points.data(), state.by_wave_generator.data(), state.by_output.data() },
                            { 1.0 - blend, start_slope * pitch, start_slope * pitch_output_angle_ + rest },
                            { blend, end_slope * pitch, end_slope * pitch_output_angle_ },
                            wrapped(sense, state.shape.teeth()), pitch_cos_, sense * pitch_sin_, scratch_,
                            state.shape.solved);
    state.shape.points.swap(scratch_);
    if (u > 0.5)
    {
      turnSpaces(state.shape.space.data(), sense, old_space_);  // the copy one pitch further is nearer
      state.shape.space.swap(old_space_);
    }
  }
  else
  {
    state.shape.points +=
        (target.wave_generator_angle - state.position.wave_generator_angle) * state.by_wave_generator +
        (target.output_angle - state.position.output_angle) * state.by_output;
  }
}

/// Turns the whole state with its spaces by `pitches` tooth pitches. With equal teeth the result is an exact
/// equilibrium.
void RingPrediction::shift(int pitches, RingState& state) noexcept
{
  for (Eigen::VectorXd* values : { &state.shape.points, &state.by_wave_generator, &state.by_output })
  {
    turn(*values, pitches, scratch_);
    values->swap(scratch_);
  }
  turnSpaces(state.shape.space.data(), pitches, old_space_);
  state.shape.space.swap(old_space_);
  state.position.wave_generator_angle += pitches * model_->rest.pitchAngle();
  state.position.output_angle += pitches * pitch_output_angle_;
}

/// Turns the vectors of all teeth by `pitches` tooth pitches. Tooth i + pitches gets the rotated vector of tooth i.
void RingPrediction::turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept
{
  const double angle = pitches * model_->rest.pitchAngle();
  ring_vectors::turn(values, wrapped(pitches, model_->rest.teeth()), std::cos(angle), std::sin(angle), turned);
}

void RingPrediction::turnSpaces(const int* space, int pitches, std::vector<int>& turned) const noexcept
{
  const int spaces = model_->gear.teeth_circular_spline;
  const int places = wrapped(pitches, model_->rest.teeth());
  const int further = wrapped(pitches, spaces);
  const std::ptrdiff_t teeth = model_->rest.teeth();
  std::rotate_copy(space, space + teeth - places, space + teeth, turned.begin());
  for (int& one : turned)
  {
    one += one + further < spaces ? further : further - spaces;
  }
}
}  // namespace hjt
