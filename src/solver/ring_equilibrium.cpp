// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/solver/ring_equilibrium.hpp"

#include <cmath>

#include "harmonic_joint_twin/gear/angle.hpp"

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

double largest(const Eigen::VectorXd& forces) noexcept
{
  return forces.lpNorm<Eigen::Infinity>();
}
}  // namespace

RingEquilibrium::RingEquilibrium(const RingModel& model, const SolverParameters& parameters)
  : model_(model)
  , parameters_(parameters)
  , pitch_output_angle_(model.rest.pitchAngle() - TWO_PI / model.gear.teeth_circular_spline)
  , solver_(model.rest.teeth())
  , tangent_(model.rest.teeth())
  , shape_(model.restShape({}))
  , forces_(model.rest.teeth())
  , by_wave_generator_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , by_output_(Eigen::VectorXd::Zero(2 * model.rest.teeth()))
  , stiffness_(Eigen::Matrix2d::Zero())
  , good_shape_(shape_)
  , kept_shape_(shape_)
  , start_points_(shape_.points)
  , scratch_(shape_.points)
  , old_space_(shape_.space)
  , step_(shape_.points)
  , columns_(2 * model.rest.teeth(), 2)
{
}

SolveStatus RingEquilibrium::insert(const DrivePosition& target) noexcept
{
  position_ = target;
  position_.wave_amplitude = 0.0;
  shape_.points = model_.rest.points();
  shape_.updateGeometry();
  by_wave_generator_.setZero();
  by_output_.setZero();
  stiffness_.setZero();
  const SolveStatus round = solve(position_);
  return round.ok() ? moveTo(target) : round;
}

SolveStatus RingEquilibrium::moveTo(const DrivePosition& target) noexcept
{
  SolveStatus total;
  if (target == position_)
  {
    total.residual = residual_;
    return total;
  }
  const DrivePosition start = position_;
  good_shape_ = shape_;
  DrivePosition good_position = position_;
  double done = 0.0;
  double stride = 1.0;
  while (done < 1.0)
  {
    const double next = std::min(1.0, done + stride);
    const SolveStatus status = solve(next < 1.0 ? between(start, target, next) : target);
    total.iterations += status.iterations;
    total.residual = status.residual;
    total.code = status.code;
    if (status.ok())
    {
      residual_ = status.residual;
      done = next;
      good_shape_ = shape_;
      good_position = position_;
      stride *= 2.0;
      continue;
    }
    shape_ = good_shape_;
    position_ = good_position;
    stride *= 0.5;
    if (++total.cuts > parameters_.max_step_cuts)
    {
      model_.forces(shape_, position_, forces_);
      return total;
    }
  }
  return total;
}

SolveStatus RingEquilibrium::reinsert(const DrivePosition& target) noexcept
{
  kept_shape_ = shape_;
  const DrivePosition kept = position_;
  const SolveStatus status = insert(target);
  if (!status.ok())
  {
    shape_ = kept_shape_;
    position_ = kept;
    model_.forces(shape_, position_, forces_);
  }
  return status;
}

/// Values of a ring turned by `pitches` tooth pitches: those of tooth i, rotated, take the place of tooth i + pitches.
void RingEquilibrium::turn(const Eigen::VectorXd& values, int pitches, Eigen::VectorXd& turned) const noexcept
{
  const int n = shape_.teeth();
  const double c = std::cos(pitches * model_.rest.pitchAngle());
  const double s = std::sin(pitches * model_.rest.pitchAngle());
  int j = (pitches % n + n) % n;
  for (int i = 0; i < n; ++i)
  {
    turned[2 * j] = c * values[2 * i] - s * values[2 * i + 1];
    turned[2 * j + 1] = s * values[2 * i] + c * values[2 * i + 1];
    j = j + 1 == n ? 0 : j + 1;
  }
}

/// The whole state turned by `pitches` tooth pitches, the spaces with it.
/// On a drive of equal teeth this is an equilibrium again, exactly; on a faulty one a good guess.
void RingEquilibrium::shift(int pitches) noexcept
{
  const int n = shape_.teeth();
  const int spaces = model_.gear.teeth_circular_spline;
  for (Eigen::VectorXd* values : { &shape_.points, &by_wave_generator_, &by_output_ })
  {
    turn(*values, pitches, scratch_);
    values->swap(scratch_);
  }
  for (int i = 0; i < n; ++i)
  {
    old_space_[((i + pitches) % n + n) % n] = ((shape_.space[i] + pitches) % spaces + spaces) % spaces;
  }
  shape_.space.swap(old_space_);
  position_.wave_generator_angle += pitches * model_.rest.pitchAngle();
  position_.output_angle += pitches * pitch_output_angle_;
}

/// First guess at the target. Whole tooth pitches of wave generator travel renumber the teeth. What is left of a pitch is
/// a cubic between the state and its copy one pitch on, with the tangents at both ends; the rest of the output's angle
/// goes along its own tangent.
void RingEquilibrium::predict(const DrivePosition& target) noexcept
{
  constexpr double SMALL = 0.02;  // of a pitch; below it the tangent alone is as good
  const double pitch = model_.rest.pitchAngle();
  const double pitches = (target.wave_generator_angle - position_.wave_generator_angle) / pitch;
  if (model_.meshed && std::abs(pitches) > SMALL && std::abs(pitches) < shape_.teeth())
  {
    const int whole = static_cast<int>(std::floor(pitches));
    if (whole != 0)
    {
      shift(whole);
    }
    const double u = pitches - whole;
    const double blend = u * u * (3.0 - 2.0 * u);
    const double start_slope = u * (1.0 - u) * (1.0 - u);
    const double end_slope = -u * u * (1.0 - u);
    const Eigen::VectorXd& slope = step_ = pitch * by_wave_generator_ + pitch_output_angle_ * by_output_;
    turn(slope, 1, scratch_);
    scratch_ = start_slope * slope + end_slope * scratch_;
    turn(shape_.points, 1, start_points_);
    shape_.points += blend * (start_points_ - shape_.points) + scratch_;
    shape_.points += (target.output_angle - position_.output_angle - u * pitch_output_angle_) * by_output_;
  }
  else
  {
    shape_.points += (target.wave_generator_angle - position_.wave_generator_angle) * by_wave_generator_ +
                     (target.output_angle - position_.output_angle) * by_output_;
  }
  shape_.updateGeometry();
  position_ = target;
}

SolveStatus RingEquilibrium::solve(const DrivePosition& target) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.1;  // better than this, the factors serve another iteration
  SolveStatus status;
  predict(target);
  if (model_.meshed)
  {
    model_.mesh.pairNearest(position_, shape_);
  }
  model_.forces(shape_, position_, forces_);
  status.residual = largest(forces_.teeth);
  if (status.residual <= parameters_.force_tolerance)
  {
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
    if (++status.iterations > parameters_.max_iterations || !searchLine(status.residual))
    {
      status.code = SolveCode::NOT_CONVERGED;
      return status;
    }
    const double residual = largest(forces_.teeth);
    fresh = residual < GOOD_CONTRACTION * status.residual;
    status.residual = residual;
  } while (true);
  updateSensitivities();
  return status;
}

bool RingEquilibrium::refactor() noexcept
{
  model_.tangent(shape_, position_, forces_, tangent_);
  return solver_.factor(tangent_);
}

/// One Newton step, shortened until the largest force falls (or is at the level of rounding).
bool RingEquilibrium::searchLine(double residual) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  step_ = forces_.teeth;
  solver_.solve<1>(step_);
  start_points_ = shape_.points;
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    shape_.points = start_points_ + length * step_;
    shape_.updateGeometry();
    model_.forces(shape_, position_, forces_);
    const double trial = largest(forces_.teeth);
    if (trial < (1.0 - 1e-4 * length) * residual || trial <= parameters_.force_tolerance)
    {
      return true;
    }
  }
  return false;
}

void RingEquilibrium::updateSensitivities() noexcept
{
  columns_.col(0) = -tangent_.wave_generator;
  columns_.col(1) = -tangent_.output;
  solver_.solve<2>(columns_);
  by_wave_generator_ = columns_.col(0);
  by_output_ = columns_.col(1);
  const double cross = tangent_.wave_generator.dot(by_output_);
  stiffness_(0, 0) = tangent_.wave_generator_stiffness + tangent_.wave_generator.dot(by_wave_generator_);
  stiffness_(1, 1) = tangent_.output_stiffness + tangent_.output.dot(by_output_);
  stiffness_(0, 1) = stiffness_(1, 0) = cross;
}
}  // namespace hjt
