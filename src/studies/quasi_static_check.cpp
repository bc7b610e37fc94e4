// SPDX-License-Identifier: BSD-3-Clause
#include "studies/quasi_static_check.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "solver/output_balance.hpp"
#include "statics/static_solver.hpp"
#include "studies/travelling_ring.hpp"

namespace hjt
{
namespace
{
/// Sums up differences.
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

  /// `among_loaded`: quantities that are zero on most teeth count only where they are not.
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

/// The comparisons of one run.
class Comparison
{
public:
  explicit Comparison(const RingModel& model) : model_(model), rest_(model.rest.points()) {}

  /// `same`: equilibrium at the angles of the dynamic ring; `balanced`: that under the load at the same motor angle.
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

/// The equilibria of the dynamic ring's position: at the same angles, and under the same load.
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
    else  // the equilibrium finds its way over less than a turn: it must not be left behind
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
