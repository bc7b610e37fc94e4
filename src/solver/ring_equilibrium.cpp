// SPDX-License-Identifier: BSD-3-Clause
#include "solver/ring_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gear/angle.hpp"
#include "solver/ring_vectors.hpp"

namespace hjt
{
using ring_vectors::largest;

namespace
{
DrivePosition between(const DrivePosition& a, const DrivePosition& b, double fraction) noexcept
{
  return { a.wave_generator_angle + fraction * (b.wave_generator_angle - a.wave_generator_angle),
           a.output_angle + fraction * (b.output_angle - a.output_angle),
           a.wave_amplitude + fraction * (b.wave_amplitude - a.wave_amplitude) };
}

/// Largest entry on the tangent's diagonal [N/m].
double stiffest(const RingTangent& tangent) noexcept
{
  return std::max(tangent.diagonal.xx.maxCoeff(), tangent.diagonal.yy.maxCoeff());
}

/// `number` less a multiple of `size`: 0 ... size - 1.
int wrapped(int number, int size) noexcept
{
  return (number % size + size) % size;
}

/// One attempt after another: the second's outcome, the effort of both.
SolveStatus add(const SolveStatus& first, SolveStatus second) noexcept
{
  second.iterations += first.iterations;
  second.cuts += first.cuts;
  return second;
}
}  // namespace

RingEquilibrium::Equilibrium::Equilibrium(const RingModel& model)
  : shape(model.restShape({}))
  , by_wave_generator(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , by_output(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , stiffness(Eigen::Matrix2d::Zero())
{
}

RingEquilibrium::RingEquilibrium(const RingModel& model, const SolverParameters& parameters)
  : model_(model)
  , model_version_(model.version())
  , parameters_(parameters)
  , pitch_output_angle_(model.rest.pitchAngle() - TWO_PI / model.gear.teeth_circular_spline)
  , solver_(model.rest.teeth())
  , tangent_(model.rest.teeth())
  , forces_(model.rest.teeth())
  , now_(model)
  , start_(now_)
  , halfway_(now_)
  , kept_(now_)
  , start_points_(now_.shape.points)
  , scratch_(now_.shape.points)
  , old_space_(now_.shape.space)
  , factored_meshed_(forces_.of<ToothMesh>().meshed)
  , factored_depth_(forces_.of<WaveGeneratorContact>().depth)
  , guess_(now_.shape.points)
  , guess_error_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , step_(now_.shape.points)
  , start_forces_(now_.shape.points)
  , by_wave_generator_(now_.by_wave_generator)
  , by_output_(now_.by_output)
{
  parameters_.force_tolerance = std::max(parameters_.force_tolerance, rounding());
}

/// What a coordinate's last digit is worth as a force [N]: no solve comes below it. It is less than the shipped
/// tolerance by a factor of 1000, and counts for rims much stiffer or teeth much finer than the shipped gear's.
double RingEquilibrium::rounding() noexcept
{
  model_.forces(now_.shape, now_.position, forces_);
  model_.tangent(now_.shape, forces_, tangent_);
  return std::numeric_limits<double>::epsilon() * model_.gear.flexspline_inner_radius * stiffest(tangent_);
}

SolveStatus RingEquilibrium::insert(const DrivePosition& target) noexcept
{
  beginRound(target);
  const bool wedged = now_.residual > parameters_.force_tolerance;
  SolveStatus status = moveTo(target);
  if (!status.ok() && wedged)
  {
    status = add(status, insertWedged(target));
  }
  if (!status.ok())
  {
    beginRound(target);
    descending_ = true;
    status = add(status, moveTo(target));
    descending_ = false;
  }
  return status;
}

/// A round ring that wedges in an eccentric circular spline goes nearly the whole way without it.
SolveStatus RingEquilibrium::insertWedged(const DrivePosition& target) noexcept
{
  constexpr double NEARLY = 0.99;
  DrivePosition before = target;
  before.wave_amplitude *= NEARLY;
  circular_spline_in_ = false;
  beginRound(target);
  const SolveStatus status = moveTo(before);
  circular_spline_in_ = true;
  if (!status.ok())
  {
    return status;
  }
  updateForces();
  now_.residual = largest(forces_.teeth);
  return add(status, moveTo(target));
}

SolveStatus RingEquilibrium::relax(const Eigen::VectorXd& points, const DrivePosition& position) noexcept
{
  begin(points, position);
  return moveTo(position);
}

/// The round ring about the wave generator's centre, before the insertion.
void RingEquilibrium::beginRound(const DrivePosition& target) noexcept
{
  const Eigen::Vector2d centre = model_.of<WaveGeneratorContact>().centre(target);
  for (int i = 0; i < now_.shape.teeth(); ++i)
  {
    scratch_.segment<2>(2 * i) = model_.rest.points().segment<2>(2 * i) + centre;
  }
  begin(scratch_, { target.wave_generator_angle, target.output_angle, 0.0 });
}

/// The ring at these points, in equilibrium or not.
void RingEquilibrium::begin(const Eigen::VectorXd& points, const DrivePosition& position) noexcept
{
  now_.position = position;
  now_.shape.points = points;
  now_.shape.updateGeometry();
  forgetGuess();
  model_version_ = model_.version();
  model_.of<ToothMesh>().pairAtRest(now_.position, now_.shape);
  now_.by_wave_generator.setZero();
  now_.by_output.setZero();
  now_.stiffness.setZero();
  updateForces();
  now_.residual = largest(forces_.teeth);
}

void RingEquilibrium::updateForces() noexcept
{
  model_.forces(now_.shape, now_.position, forces_, circular_spline_in_);
}

SolveStatus RingEquilibrium::reinsert(const DrivePosition& target) noexcept
{
  kept_ = now_;
  const SolveStatus status = insert(target);
  if (!status.ok())
  {
    now_ = kept_;
    forgetGuess();
    updateForces();
  }
  return status;
}

SolveStatus RingEquilibrium::followModel() noexcept
{
  constexpr char NONE = 8;  // no tooth's contacts: the tangent is no longer that of the model
  std::fill(factored_meshed_.begin(), factored_meshed_.end(), NONE);
  forgetGuess();
  model_version_ = model_.version();
  updateForces();
  const DrivePosition target = now_.position;
  start_ = now_;
  SolveStatus status = approach(target);
  if (!status.ok())
  {
    now_ = start_;
    status = add(status, reinsert(target));
  }
  return status;
}

SolveStatus RingEquilibrium::moveTo(const DrivePosition& target) noexcept
{
  if (model_version_ != model_.version())
  {
    const SolveStatus status = followModel();
    return status.ok() ? add(status, moveTo(target)) : status;
  }
  if (target == now_.position && now_.residual <= parameters_.force_tolerance)
  {
    SolveStatus unmoved;
    unmoved.residual = now_.residual;
    return unmoved;
  }
  start_ = now_;
  SolveStatus status = approach(target);
  if (!status.ok())
  {
    now_ = start_;
    forgetGuess();
    updateForces();
    status.residual = std::isfinite(status.residual) ? status.residual : now_.residual;
  }
  return status;
}

SolveStatus RingEquilibrium::settle(const DrivePosition& target) noexcept
{
  constexpr int MAX_STEPS = 2000;
  constexpr double FIRST_DAMPING = 1e6;  // N/m, added to every tooth's stiffness
  constexpr double LEAST_DAMPING = 1e-3;
  constexpr double MOST_DAMPING = 1e16;
  start_ = now_;
  forgetGuess();
  now_.position = target;
  SolveStatus status;
  double damping = FIRST_DAMPING;
  while (status.iterations < MAX_STEPS && damping < MOST_DAMPING)
  {
    updateForces();
    status.residual = largest(forces_.teeth);
    if (status.residual > parameters_.force_tolerance)
    {
      ++status.iterations;
      damping = descend(damping) ? std::max(LEAST_DAMPING, 0.2 * damping) : 5.0 * damping;
      continue;
    }
    // In equilibrium as paired. Teeth that have been lifted out may be nearer to another space now.
    old_space_ = now_.shape.space;
    if (model_.meshed())
    {
      model_.of<ToothMesh>().pairNearest(now_.position, now_.shape);
    }
    if (old_space_ == now_.shape.space)
    {
      status.code = refactor() ? SolveCode::CONVERGED : SolveCode::SINGULAR;
      break;
    }
    damping = FIRST_DAMPING;
  }
  if (status.iterations >= MAX_STEPS || damping >= MOST_DAMPING)
  {
    status.code = SolveCode::NOT_CONVERGED;
  }
  if (!status.ok())
  {
    now_ = start_;
    updateForces();
    return status;
  }
  updateSensitivities();
  now_.residual = status.residual;
  return status;
}

/// One damped Newton step, taken if it lowers the energy (or, at the level of rounding, the forces).
bool RingEquilibrium::descend(double damping) noexcept
{
  constexpr double ROUNDING = 1e-12;  // of the energy
  const double energy = forces_.energy;
  const double residual = largest(forces_.teeth);
  model_.tangent(now_.shape, forces_, tangent_);
  for (int i = 0; i < now_.shape.teeth(); ++i)
  {
    tangent_.addDiagonal(i, damping * Block2::Identity());
  }
  if (!solver_.factor(tangent_))
  {
    return false;
  }
  step_ = forces_.teeth;
  solver_.solve<1>(step_);
  start_points_ = now_.shape.points;
  now_.shape.points += step_;
  now_.shape.updateGeometry();
  updateForces();
  if (forces_.energy < energy * (1.0 - ROUNDING) ||
      (forces_.energy < energy * (1.0 + ROUNDING) && largest(forces_.teeth) < residual))
  {
    return true;
  }
  now_.shape.points = start_points_;
  now_.shape.updateGeometry();
  return false;
}

/// Straight to the target; where that fails, by halved paths that grow again.
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
    if (++total.cuts > parameters_.max_step_cuts)
    {
      break;
    }
    now_ = done > 0.0 ? halfway_ : start_;
    forgetGuess();
    stride *= 0.5;
  }
  return total;
}

/// Values of a ring turned by `pitches` tooth pitches: those of tooth i, rotated, take the place of tooth i + pitches.
void RingEquilibrium::turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept
{
  const double angle = pitches * model_.rest.pitchAngle();
  ring_vectors::turn(values, wrapped(pitches, now_.shape.teeth()), std::cos(angle), std::sin(angle), turned);
}

/// The spaces turned likewise.
void RingEquilibrium::turnSpaces(int pitches) noexcept
{
  const int n = now_.shape.teeth();
  const int spaces = model_.gear.teeth_circular_spline;
  const int places = wrapped(pitches, n);
  const int further = wrapped(pitches, spaces);
  const std::vector<int>& space = now_.shape.space;
  std::rotate_copy(space.begin(), space.end() - places, space.end(), old_space_.begin());
  for (int& turned : old_space_)
  {
    turned += turned + further < spaces ? further : further - spaces;
  }
  now_.shape.space.swap(old_space_);
}

/// The whole state turned by `pitches` tooth pitches, the spaces with it.
/// On a drive of equal teeth this is an equilibrium again, exactly; on a faulty one a good guess.
void RingEquilibrium::shift(int pitches) noexcept
{
  for (Eigen::VectorXd* values : { &now_.shape.points, &now_.by_wave_generator, &now_.by_output })
  {
    turn(*values, pitches, scratch_);
    values->swap(scratch_);
  }
  turnSpaces(pitches);
  now_.position.wave_generator_angle += pitches * model_.rest.pitchAngle();
  now_.position.output_angle += pitches * pitch_output_angle_;
}

/// What the last guess was off by is what the next one will be, as far as the one before was off alike: errors of single
/// teeth stay where they are, while the guess takes them for turning with the wave generator.
void RingEquilibrium::predict(const DrivePosition& target) noexcept
{
  constexpr double ALIKE = 0.8;  // less has come about by chance
  double share = 0.0;
  if (guessed_)
  {
    ring_vectors::addScaled(now_.shape.points, -1.0, guess_, scratch_);
    const double size = ring_vectors::dot(guess_error_, guess_error_);
    share = size > 0.0 ? std::min(1.0, ring_vectors::dot(scratch_, guess_error_) / size) : 0.0;
    guess_error_.swap(scratch_);
  }
  guess(target);
  guess_ = now_.shape.points;
  guessed_ = true;
  if (share > ALIKE)
  {
    ring_vectors::addScaled(guess_, share, guess_error_, now_.shape.points);
  }
  now_.shape.updateGeometry();
  now_.position = target;
}

void RingEquilibrium::forgetGuess() noexcept
{
  guessed_ = false;
  guess_error_.setZero();
}

/// First guess at the target. Whole tooth pitches of wave generator travel renumber the teeth. What is left of a pitch is
/// a cubic between the state and its copy one pitch on, forwards or back, with the tangents at both ends; the rest of the
/// output's angle goes along its own tangent.
void RingEquilibrium::guess(const DrivePosition& target) noexcept
{
  constexpr double SMALL = 0.02;        // of a pitch; below it the tangent alone is as good
  constexpr double MOST_PITCHES = 1e9;  // counted as an int
  const double pitch = model_.rest.pitchAngle();
  const double pitches = (target.wave_generator_angle - now_.position.wave_generator_angle) / pitch;
  if (model_.meshed() && std::abs(pitches) > SMALL && std::abs(pitches) < MOST_PITCHES)
  {
    const int whole = static_cast<int>(pitches);
    if (whole != 0)
    {
      shift(whole);
    }
    const int sense = pitches < 0.0 ? -1 : 1;
    const double u = std::abs(pitches - whole);
    const double blend = u * u * (3.0 - 2.0 * u);
    const double start_slope = sense * u * (1.0 - u) * (1.0 - u);
    const double end_slope = -sense * u * u * (1.0 - u);
    const double rest = target.output_angle - now_.position.output_angle - sense * u * pitch_output_angle_;
    ring_vectors::addTurned({ now_.shape.points, now_.by_wave_generator, now_.by_output },
                            { 1.0 - blend, start_slope * pitch, start_slope * pitch_output_angle_ + rest },
                            { blend, end_slope * pitch, end_slope * pitch_output_angle_ },
                            wrapped(sense, now_.shape.teeth()), std::cos(pitch), sense * std::sin(pitch), scratch_);
    now_.shape.points.swap(scratch_);
    if (u > 0.5)
    {
      turnSpaces(sense);  // the copy is the nearer one
    }
  }
  else
  {
    now_.shape.points += (target.wave_generator_angle - now_.position.wave_generator_angle) * now_.by_wave_generator +
                         (target.output_angle - now_.position.output_angle) * now_.by_output;
  }
}

SolveStatus RingEquilibrium::solve(const DrivePosition& target) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.1;  // better than this, the factors serve another iteration
  constexpr int DESCENT = 5;                // times as many iterations: one for every few teeth that touch or let go
  const int max_iterations = (descending_ ? DESCENT : 1) * parameters_.max_iterations;
  SolveStatus status;
  predict(target);
  if (model_.meshed())
  {
    status.jumps = model_.of<ToothMesh>().pairNearest(now_.position, now_.shape);
  }
  updateForces();
  status.residual = largest(forces_.teeth);
  if (status.residual <= parameters_.force_tolerance && !slopesChanged())
  {
    now_.residual = status.residual;
    return status;  // the tangent of the last solve is good enough to have predicted this
  }
  bool fresh = false;
  do
  {
    if (!std::isfinite(status.residual))
    {
      status.code = SolveCode::NOT_FINITE;
      return status;
    }
    if (!fresh && !refactor())
    {
      status.code = SolveCode::SINGULAR;
      return status;
    }
    if (status.residual <= parameters_.force_tolerance)
    {
      break;
    }
    if (++status.iterations > max_iterations || !(descending_ ? stepDownhill() : searchLine(status.residual)))
    {
      status.code = SolveCode::NOT_CONVERGED;
      return status;
    }
    const double residual = largest(forces_.teeth);
    fresh = !descending_ && residual < GOOD_CONTRACTION * status.residual;
    status.residual = residual;
  } while (true);
  if (slopesChanged() && !refactor())
  {
    status.code = SolveCode::SINGULAR;
    return status;
  }
  updateSensitivities();
  now_.residual = status.residual;
  return status;
}

/// Whether a tooth has begun or ceased to touch, or the cup has come to another slope, since the tangent was factored.
bool RingEquilibrium::slopesChanged() const noexcept
{
  if (model_.of<CupTorsion>().stiffness(forces_.of<CupTorsion>().rotation) != tangent_.cup_stiffness)
  {
    return true;
  }
  return forces_.of<ToothMesh>().meshed != factored_meshed_ ||
         ring_vectors::signsChanged(forces_.of<WaveGeneratorContact>().depth, factored_depth_) != 0;
}

bool RingEquilibrium::refactor() noexcept
{
  factored_meshed_ = forces_.of<ToothMesh>().meshed;
  factored_depth_ = forces_.of<WaveGeneratorContact>().depth;
  model_.tangent(now_.shape, forces_, tangent_);
  rates_known_ = false;
  return solver_.factor(tangent_);
}

/// The Newton step; with it, once a tangent, the rates by both angles: a sweep costs little more for three columns.
void RingEquilibrium::solveStep() noexcept
{
  step_ = forces_.teeth;
  if (rates_known_)
  {
    solver_.solve<1>(step_);
    return;
  }
  by_wave_generator_ = -tangent_.wave_generator;
  by_output_ = -tangent_.output;
  solver_.solve(step_, by_wave_generator_, by_output_);
  rates_known_ = true;
}

/// One Newton step, shortened until the largest force falls (or is at the level of rounding).
bool RingEquilibrium::searchLine(double residual) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  solveStep();
  start_points_.swap(now_.shape.points);
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    ring_vectors::addScaled(start_points_, length, step_, now_.shape.points);
    now_.shape.updateGeometry();
    updateForces();
    const double trial = largest(forces_.teeth);
    if (trial < (1.0 - 1e-4 * length) * residual || trial <= parameters_.force_tolerance)
    {
      return true;
    }
  }
  return false;
}

/// The Newton step as a way down the energy: where the tangent is not positive along it, the tangent is shifted until it
/// is. Leaves the step in `step_`, its start in `start_points_`.
bool RingEquilibrium::downhill() noexcept
{
  constexpr int MAX_SHIFTS = 30;
  constexpr double FIRST_SHIFT = 1e-6;  // of the stiffest diagonal entry
  double shift = 0.0;
  for (int i = 0; i < MAX_SHIFTS; ++i)
  {
    step_ = start_forces_ = forces_.teeth;
    solver_.solve<1>(step_);
    const double slope = step_.dot(start_forces_);
    if (std::isfinite(slope) && slope > 0.0)
    {
      start_points_ = now_.shape.points;
      return true;
    }
    const double add = shift > 0.0 ? 3.0 * shift : FIRST_SHIFT * stiffest(tangent_);
    tangent_.diagonal.xx.array() += add;
    tangent_.diagonal.yy.array() += add;
    shift += add;
    if (!solver_.factor(tangent_))
    {
      return false;
    }
  }
  return false;
}

/// Moves to `length` steps from the start. @returns how steeply the energy falls there along the step [J].
double RingEquilibrium::slopeAt(double length) noexcept
{
  now_.shape.points = start_points_ + length * step_;
  now_.shape.updateGeometry();
  updateForces();
  return forces_.teeth.dot(step_);
}

/// One step down the energy: all the way if that is still downhill or nearly level, else to where the energy is lowest.
/// Looks at slopes only: energies near a minimum differ by less than their rounding.
bool RingEquilibrium::stepDownhill() noexcept
{
  constexpr int MAX_TRIALS = 40;
  constexpr double LEVEL = 0.3;  // of the first slope
  if (!downhill())
  {
    return false;
  }
  const double first = step_.dot(start_forces_);
  double low = 0.0;
  double high = 1.0;
  double length = 1.0;
  for (int i = 0; i < MAX_TRIALS; ++i)
  {
    const double slope = slopeAt(length);
    if (largest(forces_.teeth) <= parameters_.force_tolerance || (length == 1.0 && slope >= -LEVEL * first) ||
        std::abs(slope) <= LEVEL * first)
    {
      return true;
    }
    (slope > 0.0 ? low : high) = length;
    length = 0.5 * (low + high);
  }
  return false;
}

void RingEquilibrium::updateSensitivities() noexcept
{
  if (!rates_known_)
  {
    solveStep();
  }
  now_.by_wave_generator.swap(by_wave_generator_);
  now_.by_output.swap(by_output_);
  rates_known_ = false;
  const double cross = ring_vectors::dot(tangent_.wave_generator, now_.by_output);
  now_.stiffness(0, 0) =
      tangent_.wave_generator_stiffness + ring_vectors::dot(tangent_.wave_generator, now_.by_wave_generator);
  now_.stiffness(1, 1) = tangent_.output_stiffness + ring_vectors::dot(tangent_.output, now_.by_output);
  now_.stiffness(0, 1) = now_.stiffness(1, 0) = cross;
}
}  // namespace hjt
