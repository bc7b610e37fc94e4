// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ring_transient.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace hjt
{
namespace
{
/// Steps of equal length, none longer than wanted, that end exactly with a phase.
long stepsIn(double duration, double step)
{
  return std::max(1L, std::lround(std::ceil(duration / step - 1e-6)));
}

/// Gathers rows and the window's sums from step to step.
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
}  // namespace hjt
