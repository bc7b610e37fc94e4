// SPDX-License-Identifier: BSD-3-Clause
// Time of the parts of a cycle, to see where it goes. Options are Google Benchmark's.
#include <cstdint>
#include <string>

#include <benchmark/benchmark.h>

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "health/health_monitor.hpp"
#include "solver/ring_equilibrium.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
const Parameters& parameters()
{
  static const Parameters PARAMETERS = shippedParameters();
  return PARAMETERS;
}

/// Where the drive stands, unloaded, when the motor stands at `motor_angle`.
DrivePosition positionAt(double motor_angle)
{
  return { motor_angle, motor_angle / nominalRatio(parameters().gear), parameters().gear.wave_amplitude };
}

/// Ring equilibrium, the motor turning by state.range(0) mrad from one solve to the next.
void solveRing(benchmark::State& state)
{
  const RingModel model(parameters());
  RingEquilibrium ring(model, parameters().solver);
  double motor_angle = 0.0;
  bool good = ring.insert(positionAt(motor_angle)).ok();
  std::int64_t iterations = 0;
  for (auto _ : state)
  {
    motor_angle += 1e-3 * static_cast<double>(state.range(0));
    const SolveStatus status = ring.moveTo(positionAt(motor_angle));
    good = good && status.ok();
    iterations += status.iterations;
  }
  if (!good)
  {
    state.SkipWithError("the ring did not converge");
  }
  state.counters["newton"] = benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
}
BENCHMARK(solveRing)->Arg(1)->Arg(10)->Arg(30);

/// Cold start: the wave generator inserted into the round ring inside the circular spline.
void insertFromCold(benchmark::State& state)
{
  const RingModel model(parameters());
  bool good = true;
  for (auto _ : state)
  {
    RingEquilibrium ring(model, parameters().solver);
    good = ring.insert(positionAt(0.0)).ok() && good;
  }
  if (!good)
  {
    state.SkipWithError("the ring did not converge");
  }
}
BENCHMARK(insertFromCold)->Unit(benchmark::kMillisecond);

void ringForces(benchmark::State& state)
{
  const RingModel model(parameters());
  const DrivePosition position = positionAt(0.3);
  RingEquilibrium ring(model, parameters().solver);
  benchmark::DoNotOptimize(ring.insert(position).ok());
  RingForces forces = ring.forces();
  for (auto _ : state)
  {
    model.forces(ring.shape(), position, forces);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(ringForces);

/// A ring of state.range(0) teeth, pressed round on a round wave generator: every tooth in contact, none in mesh.
struct RingOf
{
  explicit RingOf(const benchmark::State& state)
    : parameters(shippedParameters({ "gear.teeth_flexspline=" + std::to_string(state.range(0)),
                                     "gear.teeth_circular_spline=" + std::to_string(state.range(0) + 2) }))
    , model(parameters)
    , position{ 0.3, 0.003, 0.0 }
    , shape(model.restShape(position))
    , forces(shape.teeth())
    , tangent(shape.teeth())
    , solver(shape.teeth())
  {
    constexpr double PRESSED = 1e-6;  // of the radius
    shape.points *= 1.0 - PRESSED;
    shape.updateGeometry();
    model.forces(shape, position, forces);
    model.tangent(shape, forces, tangent);
  }

  Parameters parameters;
  RingModel model;
  DrivePosition position;
  RingShape shape;
  RingForces forces;
  RingTangent tangent;
  CyclicSolver solver;
};

/// One Newton iteration, geometry and forces included, against the number of teeth.
void newtonIteration(benchmark::State& state)
{
  RingOf ring(state);
  Eigen::VectorXd step(ring.forces.teeth.size());
  for (auto _ : state)
  {
    ring.shape.updateGeometry();
    ring.model.forces(ring.shape, ring.position, ring.forces);
    ring.model.tangent(ring.shape, ring.forces, ring.tangent);
    benchmark::DoNotOptimize(ring.solver.factor(ring.tangent));
    step = ring.forces.teeth;
    ring.solver.solve<1>(step);
    benchmark::ClobberMemory();
  }
  state.SetComplexityN(state.range(0));
}
BENCHMARK(newtonIteration)->RangeMultiplier(2)->Range(100, 3200)->Complexity(benchmark::oN);

void ringTangent(benchmark::State& state)
{
  RingOf ring(state);
  for (auto _ : state)
  {
    ring.model.tangent(ring.shape, ring.forces, ring.tangent);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(ringTangent)->Arg(200);

void ringFactor(benchmark::State& state)
{
  RingOf ring(state);
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(ring.solver.factor(ring.tangent));
  }
}
BENCHMARK(ringFactor)->Arg(200);

void ringSubstitution(benchmark::State& state)
{
  RingOf ring(state);
  benchmark::DoNotOptimize(ring.solver.factor(ring.tangent));
  Eigen::VectorXd step(ring.forces.teeth.size());
  for (auto _ : state)
  {
    step = ring.forces.teeth;
    ring.solver.solve<1>(step);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(ringSubstitution)->Arg(200);

/// A twin that has run for a quarter of a second under load.
Twin runningTwin()
{
  Twin twin(parameters());
  twin.commandLoadTorque(0, 20.0);
  for (Stamp until = twin.stepLength(); until < 250'000'000; until += twin.stepLength())
  {
    twin.commandMotorTorque(until, 0.5);
    twin.step(until);
  }
  return twin;
}

void toothForces(benchmark::State& state)
{
  Twin twin = runningTwin();
  ToothForces forces = twin.makeToothForces();
  for (auto _ : state)
  {
    twin.toothForces(forces);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(toothForces);

void encoders(benchmark::State& state)
{
  Twin twin = runningTwin();
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(twin.encoders());
  }
}
BENCHMARK(encoders);

void healthReport(benchmark::State& state)
{
  Twin twin = runningTwin();
  if (!twin.health().motion.kinematic_error.valid)
  {
    state.SkipWithError("the report is not complete");
  }
  for (auto _ : state)
  {
    benchmark::DoNotOptimize(twin.health());
  }
}
BENCHMARK(healthReport);

/// The motor turning by state.range(0) mrad from one sample to the next.
void healthUpdate(benchmark::State& state)
{
  HealthMonitor monitor(parameters().health, parameters().gear);
  HealthSample sample;
  sample.motor_velocity = 100.0;
  sample.output_velocity = 1.0;
  sample.motor_torque = 0.5;
  for (auto _ : state)
  {
    sample.stamp += 100000;
    sample.motor_angle += 1e-3 * static_cast<double>(state.range(0));
    sample.output_angle = sample.motor_angle / 101.0;
    sample.joint_torque = 40.0 + sample.motor_angle;
    monitor.update(sample);
  }
}
BENCHMARK(healthUpdate)->Arg(1)->Arg(10)->Arg(30);
}  // namespace
}  // namespace hjt

BENCHMARK_MAIN();
