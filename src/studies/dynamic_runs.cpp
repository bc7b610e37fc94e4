// SPDX-License-Identifier: BSD-3-Clause
#include "studies/dynamic_runs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
namespace
{
/// Number of equal steps, none longer than `step`, that fill a duration.
long stepsIn(double duration, double step)
{
  return std::max(1L, std::lround(std::ceil(duration / step - 1e-6)));
}

/// Collects the rows of a transient, and the statistics of the largest force over the window.
class TransientRecord
{
public:
  TransientRecord(const TransientSetup& setup, double stored_at_start)
    : setup_(setup), stored_at_start_(stored_at_start)
  {
  }

  void add(const DynamicRing& ring, const RingMotion& motion, TransientResult& result)
  {
    const double force = ring.forces().of<WaveGeneratorContact>().force.maxCoeff();
    lowest_ = std::min(lowest_, force);
    highest_ = std::max(highest_, force);
    if (motion.time >= setup_.window_start)
    {
      result.window_lowest = in_window_ == 0 ? force : std::min(result.window_lowest, force);
      result.window_highest = std::max(result.window_highest, force);
      result.window_mean += (force - result.window_mean) / static_cast<double>(++in_window_);
    }
    const double due = setup_.sample_period * static_cast<double>(result.rows.size());
    if (motion.time < due - 1e-6 * setup_.step)
    {
      return;
    }
    result.rows.push_back({ motion.time, force, lowest_, highest_, motion.q.head<2>().norm(),
                            ring.storedEnergy() - stored_at_start_, ring.kineticEnergy(motion.v), motion.supplied,
                            motion.dissipated });
    lowest_ = std::numeric_limits<double>::max();
    highest_ = 0.0;
  }

private:
  const TransientSetup& setup_;
  double stored_at_start_;
  double lowest_{ std::numeric_limits<double>::max() };
  double highest_{};
  long in_window_{};
};
}  // namespace

TransientResult analyseTransient(const Parameters& parameters, const TransientSetup& setup,
                                 const std::function<void(double)>& progress)
{
  using Clock = std::chrono::steady_clock;
  JointModel model(parameters);
  model.ring.setMeshed(false);
  const double full = parameters.gear.wave_amplitude;
  RingDrive drive;
  drive.wave_generator_driven = true;
  drive.output_driven = true;
  DynamicRing ring(model, parameters.ring, drive);
  const std::unique_ptr<RingStepper> stepper = makeRingStepper(setup.method, ring, parameters.solver, setup.tolerance);
  RingMotion motion(ring.coordinates());
  motion.q.head(2 * ring.teeth()) = model.ring.rest.points();
  ring.evaluate(motion.q, motion.v, 0.0);

  TransientResult result;
  TransientRecord record(setup, ring.storedEnergy());
  record.add(ring, motion, result);
  const double growth = std::min(setup.growth_time, setup.duration);
  const WaveGrowth phases[] = { { 0.0, 0.0, full / setup.growth_time }, { setup.growth_time, full, 0.0 } };
  const double durations[] = { growth, setup.duration - growth };
  Clock::duration busy{};
  for (int phase = 0; phase < 2; ++phase)
  {
    ring.setWave(phases[phase]);
    const long steps = durations[phase] > 0.0 ? stepsIn(durations[phase], setup.step) : 0;
    const double begin = phases[phase].begin;
    for (long k = 0; k < steps; ++k)
    {
      const auto start = Clock::now();
      const bool good = stepper->step(motion, durations[phase] / static_cast<double>(steps));
      busy += Clock::now() - start;
      motion.time = begin + durations[phase] * static_cast<double>(k + 1) / static_cast<double>(steps);
      if (!good)
      {
        result.stopped_at = motion.time;
        result.counts = stepper->counts();
        return result;
      }
      ring.evaluate(motion.q, motion.v, motion.time);
      record.add(ring, motion, result);
      progress(motion.time / setup.duration);
    }
  }
  result.finished = true;
  result.stopped_at = motion.time;
  result.counts = stepper->counts();
  result.solve_time = std::chrono::duration<double>(busy).count();
  for (int i = 0; i < ring.teeth(); ++i)
  {
    result.tooth_x.push_back(motion.q[2 * i]);
    result.tooth_y.push_back(motion.q[2 * i + 1]);
  }
  return result;
}

namespace
{
class ErrorSum
{
public:
  void add(double value, double quasi_static) noexcept
  {
    const double error = value - quasi_static;
    ++count_;
    squares_ += quasi_static * quasi_static;
    errors_ += error * error;
    largest_ = std::max(largest_, std::abs(error));
    loaded_ += quasi_static != 0.0 ? 1 : 0;
  }

  /// Error of all values. `among_loaded`: the means are over the number of equilibrium values other than zero.
  DynamicError error(bool among_loaded = false) const noexcept
  {
    const double n = static_cast<double>(among_loaded ? loaded_ : count_);
    return { std::sqrt(squares_ / n), std::sqrt(errors_ / n), largest_ };
  }

private:
  long count_{};
  long loaded_{};
  double squares_{};
  double errors_{};
  double largest_{};
};

std::vector<double> toVector(const Eigen::VectorXd& values)
{
  return { values.data(), values.data() + values.size() };
}

class Comparison
{
public:
  explicit Comparison(const RingModel& model) : model_(model), rest_(model.rest.points()) {}

  /// Adds a comparison. `same`: equilibrium at motor and output angle of the dynamic ring; `balanced`: equilibrium
  /// under the load at the motor angle of the dynamic ring.
  void add(const DynamicRing& ring, double time, const RingEquilibrium& same, const RingEquilibrium& balanced,
           QuasiStaticResult& result)
  {
    const RingForces& now = ring.forces();
    const RingForces& should = same.forces();
    double contact_square = 0.0;
    double mesh_square = 0.0;
    for (int i = 0; i < ring.teeth(); ++i)
    {
      contact_.add(now.of<WaveGeneratorContact>().force[i], should.of<WaveGeneratorContact>().force[i]);
      mesh_.add(now.of<ToothMesh>().flank_force[i], should.of<ToothMesh>().flank_force[i]);
      contact_square +=
          std::pow(now.of<WaveGeneratorContact>().force[i] - should.of<WaveGeneratorContact>().force[i], 2);
      mesh_square += std::pow(now.of<ToothMesh>().flank_force[i] - should.of<ToothMesh>().flank_force[i], 2);
    }
    for (Eigen::Index k = 0; k < rest_.size(); ++k)
    {
      position_.add(ring.shape().points[k] - rest_[k], same.shape().points[k] - rest_[k]);
    }
    wave_generator_torque_.add(now.wave_generator_torque, should.wave_generator_torque);
    output_torque_.add(now.output_torque, should.output_torque);
    const double torsion = torsionAt(ring.position());
    const double balanced_torsion = torsionAt(balanced.position());
    torsion_.add(torsion, balanced_torsion);
    result.rows.push_back({ time, torsion, balanced_torsion, now.wave_generator_torque, should.wave_generator_torque,
                            std::sqrt(contact_square / ring.teeth()), std::sqrt(mesh_square / ring.teeth()) });
    result.last = { time, toVector(now.of<WaveGeneratorContact>().force),
                    toVector(should.of<WaveGeneratorContact>().force), toVector(now.of<ToothMesh>().flank_force),
                    toVector(should.of<ToothMesh>().flank_force) };
  }

  void sumUp(QuasiStaticResult& result) const
  {
    result.contact_force = contact_.error();
    result.mesh_force = mesh_.error(true);
    result.position = position_.error();
    result.wave_generator_torque = wave_generator_torque_.error();
    result.output_torque = output_torque_.error();
    result.torsion = torsion_.error();
  }

private:
  double torsionAt(const DrivePosition& position) const
  {
    return position.output_angle - position.wave_generator_angle / nominalRatio(model_.gear);
  }

  const RingModel& model_;
  Eigen::VectorXd rest_;
  ErrorSum contact_;
  ErrorSum mesh_;
  ErrorSum position_;
  ErrorSum wave_generator_torque_;
  ErrorSum output_torque_;
  ErrorSum torsion_;
};
RingDrive driveOf(const Parameters& parameters, const QuasiStaticSetup& setup)
{
  RingDrive drive;
  drive.wave.amplitude = parameters.gear.wave_amplitude;
  drive.wave_generator_driven = true;
  drive.load_torque = setup.load;
  return drive;
}

/// Solves two equilibria: `same` at motor and output angle of `position`, `balanced` under the load at its motor angle.
SolveStatus follow(const DrivePosition& position, double load, RingEquilibrium& same, RingEquilibrium& balanced)
{
  const SolveStatus status = same.moveTo(position);
  return status.ok() ? balanceOutput(balanced, position.wave_generator_angle, load) : status;
}
}  // namespace

QuasiStaticResult checkQuasiStatic(const Parameters& parameters, const QuasiStaticSetup& setup,
                                   const std::function<void(double)>& progress)
{
  using Clock = std::chrono::steady_clock;
  const JointModel model(parameters);
  RingEquilibrium balanced(model.ring, staticSolver(parameters.solver));
  QuasiStaticResult result;
  if (result.status = insertUnderLoad(balanced, 0.0, setup.load); !result.status.ok())
  {
    return result;
  }
  RingEquilibrium same = balanced;
  DynamicRing ring(model, parameters.ring, driveOf(parameters, setup));
  ring.setSpaces(balanced.shape().space);
  const std::unique_ptr<RingStepper> stepper = makeRingStepper(setup.method, ring, parameters.solver, setup.tolerance);
  RingMotion motion(ring.coordinates());
  if (result.status = travelInEquilibrium(balanced, setup.speed, setup.load, motion); !result.status.ok())
  {
    return result;
  }

  Comparison comparison(model.ring);
  const double end = setup.settle_time + setup.duration;
  const double half_turn_time = PI / std::max(std::abs(setup.speed), 1.0);
  const long steps = std::lround(std::ceil(end / setup.step - 1e-6));
  double due = std::min(setup.settle_time, half_turn_time);
  Clock::duration busy{};
  for (long k = 1; k <= steps; ++k)
  {
    const auto start = Clock::now();
    const bool good = stepper->step(motion, end / static_cast<double>(steps));
    busy += Clock::now() - start;
    result.stopped_at = motion.time;
    if (!good)
    {
      result.outcome = QuasiStaticOutcome::STEP_FAILED;
      return result;
    }
    progress(motion.time / end);
    if (motion.time < due - 1e-6 * setup.step)
    {
      continue;
    }
    ring.evaluate(motion.q, motion.v, motion.time);
    if (result.status = follow(ring.position(), setup.load, same, balanced); !result.status.ok())
    {
      return result;
    }
    if (motion.time >= setup.settle_time - 1e-6 * setup.step)
    {
      comparison.add(ring, motion.time, same, balanced, result);
      due += setup.compare_period;
    }
    else  // before the comparisons the equilibria follow every half turn, because they cannot follow a whole turn
    {
      due = std::min(setup.settle_time, due + half_turn_time);
    }
  }
  comparison.sumUp(result);
  result.outcome = QuasiStaticOutcome::DONE;
  result.force_evaluations = stepper->counts().force_evaluations;
  result.solve_time = std::chrono::duration<double>(busy).count();
  return result;
}
}  // namespace hjt
