// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work_precision/operating.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/operating_journey.hpp"
#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "sensors/joint_sensors.hpp"
#include "solver/joint_stepper.hpp"
#include "surface/faulty_surface.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
using namespace boost::numeric::odeint;

/// The twin's own. Its inputs are held over a step.
Run leapfrog(const OperatingProblem& problem, Way way, double step, double limit)
{
  Journey journey(problem, way);
  Leapfrog stepper;
  return travel(journey, limit,
                [&](double due, Run& run)
                {
                  const int steps = stepsToASample(step);
                  for (int k = 0; k < steps; ++k)
                  {
                    const double end = due - SAMPLE_PERIOD + (k + 1) * step;
                    journey.dynamics.inputs.motor_torque = motorTorque(end - 0.5 * step);
                    stepper.do_step(journey.dynamics, journey.x, end - step, step);
                  }
                  run.steps += steps;
                  run.force_evaluations += steps;
                  return journey.x.allFinite();
                });
}

/// The table at angles as the encoders give them, at 1 kHz: no motion is computed.
Run motionDriven(const OperatingProblem& problem, double limit)
{
  constexpr double FINE = 1e-5;  // step [s]
  constexpr int READINGS = 10;   // to a sample
  const Series motion = leapfrog(problem, Way::TABLE_ANGLES, FINE, limit).series;
  Journey journey(problem, Way::TABLE);
  const IncrementalEncoder motor(problem.parameters.sensors);
  const AbsoluteEncoder output(problem.parameters.sensors);
  Eigen::Index sample = 0;
  return travel(journey, limit,
                [&](double /*due*/, Run& run)
                {
                  for (int i = 0; i < READINGS; ++i)
                  {
                    journey.x[joint_state::MOTOR_ANGLE] = motor.angle(motor.count(motion.angles(sample, 0)));
                    journey.x[joint_state::OUTPUT_ANGLE] = output.unwrappedAngle(motion.angles(sample, 1));
                    if (!journey.dynamics.placeOnSurface(journey.x[joint_state::MOTOR_ANGLE],
                                                         journey.x[joint_state::OUTPUT_ANGLE]))
                    {
                      return false;
                    }
                  }
                  ++sample;
                  run.steps += READINGS;
                  return true;
                });
}

Run rungeKutta4(const OperatingProblem& problem, double step, double limit)
{
  Journey journey(problem);
  runge_kutta4<JointState, double, JointState, double, vector_space_algebra> stepper;
  return travel(journey, limit,
                [&](double due, Run& run)
                {
                  const int steps = stepsToASample(step);
                  for (int k = 0; k < steps; ++k)
                  {
                    stepper.do_step(journey.dynamics, journey.x, due - SAMPLE_PERIOD + k * step, step);
                  }
                  run.steps += steps;
                  run.force_evaluations += 4 * steps;
                  return journey.x.allFinite();
                });
}

/// Units that a tolerance of 1 means: 1 mrad at the motor, 10 urad at the output, their speeds, joules, and 1 N.m.
JointState scale()
{
  JointState scale;
  scale << 1e-3, 1e-5, 1.0, 1e-2, 1.0, 1.0, 1.0, 1.0;
  return scale;
}

Run dopri5(const OperatingProblem& problem, double tolerance, double limit)
{
  using State = std::array<double, JointState::SizeAtCompileTime>;
  Journey journey(problem);
  auto stepper = make_controlled(tolerance, 0.0, runge_kutta_dopri5<State>());
  const JointState unit = scale();
  long evaluations = 0;
  const auto unscaled = [&](const State& scaled)
  { return JointState(Eigen::Map<const JointState>(scaled.data()).cwiseProduct(unit)); };
  const auto system = [&](const State& scaled, State& derivative, double time)
  {
    JointState rate;
    journey.dynamics(unscaled(scaled), rate, time);
    Eigen::Map<JointState>(derivative.data()) = rate.cwiseQuotient(unit);
    ++evaluations;
  };
  State scaled{};
  Eigen::Map<JointState>(scaled.data()) = journey.x.cwiseQuotient(unit);
  double time = 0.0;
  double step = 1e-5;
  return travel(journey, limit,
                [&](double due, Run& run)
                {
                  stepper.reset();
                  while (time < due * (1.0 - 1e-14))
                  {
                    double next = std::min(step, due - time);
                    const bool cut = next < step;
                    const bool good = stepper.try_step(system, scaled, time, next) == success;
                    step = good && cut ? step : next;
                    ++(good ? run.steps : run.rejections);
                    if (step < 1e-12)
                    {
                      return false;
                    }
                  }
                  time = due;
                  journey.x = unscaled(scaled);
                  run.force_evaluations = evaluations;
                  return true;
                });
}

/// CVODE on the four states of the joint (those of ledger and drive are left out), dense Jacobian by differences.
Run cvode(const OperatingProblem& problem, int method, double tolerance, double limit)
{
  constexpr int STATES = 4;
  Journey journey(problem);
  SUNContext context = nullptr;
  SUNContext_Create(nullptr, &context);
  N_Vector y = N_VNew_Serial(STATES, context);
  N_Vector weights = N_VNew_Serial(STATES, context);
  using State = Eigen::Map<Eigen::Vector4d>;
  State(N_VGetArrayPointer(y)) = journey.x.head<STATES>();
  State(N_VGetArrayPointer(weights)) = tolerance * scale().head<STATES>();
  void* memory = CVodeCreate(method, context);
  const auto rates = [](double time, N_Vector from, N_Vector derivative, void* data)
  {
    JointState x = JointState::Zero();
    JointState rate;
    x.head<STATES>() = State(N_VGetArrayPointer(from));
    (*static_cast<JointDynamics*>(data))(x, rate, time);
    State(N_VGetArrayPointer(derivative)) = rate.head<STATES>();
    return 0;
  };
  CVodeInit(memory, rates, 0.0, y);
  CVodeSVtolerances(memory, 0.0, weights);
  CVodeSetUserData(memory, &journey.dynamics);
  CVodeSetMaxNumSteps(memory, 100000000);
  CVodeSetErrFile(memory, nullptr);
  SUNMatrix matrix = SUNDenseMatrix(STATES, STATES, context);
  SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
  CVodeSetLinearSolver(memory, linear, matrix);
  Run run = travel(journey, limit,
                   [&](double due, Run& so_far)
                   {
                     double time = 0.0;
                     if (due - SAMPLE_PERIOD < REVERSAL + 0.5 * SAMPLE_PERIOD && due > REVERSAL + 0.5 * SAMPLE_PERIOD)
                     {
                       CVodeReInit(memory, due - SAMPLE_PERIOD, y);  // the torque has changed
                     }
                     CVodeSetStopTime(memory, due);
                     while (time < due)
                     {
                       if (CVode(memory, due, y, &time, CV_ONE_STEP) < 0)
                       {
                         return false;
                       }
                       ++so_far.steps;
                     }
                     journey.x.head<STATES>() = State(N_VGetArrayPointer(y));
                     return true;
                   });
  CVodeGetNumRhsEvals(memory, &run.force_evaluations);
  CVodeGetNumErrTestFails(memory, &run.rejections);
  CVodeFree(&memory);
  SUNLinSolFree(linear);
  SUNMatDestroy(matrix);
  N_VDestroy(y);
  N_VDestroy(weights);
  SUNContext_Free(&context);
  return run;
}

Parameters parameters(OperatingProblem::Friction friction)
{
  Parameters parameters = shippedParameters();
  parameters.solver.force_tolerance = 1e-6;  // below what any of these steps leaves
  if (friction == OperatingProblem::Friction::FOR_PEERS)
  {
    parameters.solver.stiction_velocity = 1e-3;  // the others take friction at rest for a slope as steep as this
    parameters.cup.friction_torque = 0.0;
  }
  return parameters;
}

const std::vector<double> STEPS{ 2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 5e-5, 2e-5, 1e-5, 5e-6 };

/// By steps of equal length [s].
void addSteps(const std::string& solver, const std::function<Run(double step, double limit)>& run,
              std::vector<Contender>& contenders)
{
  for (const double step : STEPS)
  {
    contenders.push_back(
        { solver, "h = " + text("%.3g us", 1e6 * step), [=](double limit) { return run(step, limit); } });
  }
}

/// The twin's own: the ring and its table.
std::vector<Contender> ownOperatingContenders(const OperatingProblem& problem)
{
  std::vector<Contender> contenders;
  addSteps(
      "ours, leapfrog on the ring",
      [&problem](double step, double limit) { return leapfrog(problem, Way::RING, step, limit); }, contenders);
  addSteps(
      "ours, leapfrog on the table",
      [&problem](double step, double limit) { return leapfrog(problem, Way::TABLE, step, limit); }, contenders);
  addSteps(
      "ours, leapfrog on the table, angles alone",
      [&problem](double step, double limit) { return leapfrog(problem, Way::TABLE_ANGLES, step, limit); }, contenders);
  return contenders;
}
}  // namespace

OperatingProblem::OperatingProblem(Friction friction)
  : parameters(hjt::parameters(friction))
  , model(parameters)
  , surface(surfaceWithFaults(parameters, {}, SurfaceSource{ surfaceCacheDirectory() }))
{
  if (!surface)
  {
    throw std::runtime_error("operating: the gear has no table");
  }
}

std::vector<Contender> operatingContenders(const OperatingProblem& problem)
{
  std::vector<Contender> contenders = ownOperatingContenders(problem);
  addSteps(
      "odeint RK4", [&problem](double step, double limit) { return rungeKutta4(problem, step, limit); }, contenders);
  for (const double tolerance : { 1e-1, 1e-2, 1e-3, 1e-4, 1e-5 })
  {
    const std::string setting = "tol = " + text("%.0e", tolerance);
    contenders.push_back(
        { "odeint dopri5", setting, [=, &problem](double limit) { return dopri5(problem, tolerance, limit); } });
    contenders.push_back({ "CVODE, BDF, dense", setting,
                           [=, &problem](double limit) { return cvode(problem, CV_BDF, tolerance, limit); } });
    contenders.push_back({ "CVODE, Adams", setting,
                           [=, &problem](double limit) { return cvode(problem, CV_ADAMS, tolerance, limit); } });
  }
  return contenders;
}

std::vector<Contender> levelContenders(const OperatingProblem& problem)
{
  std::vector<Contender> contenders = ownOperatingContenders(problem);
  contenders.push_back({ "ours, table at the encoders' angles", "1 kHz",
                         [&problem](double limit) { return motionDriven(problem, limit); } });
  return contenders;
}

std::vector<Contender> levelReferences(const OperatingProblem& problem)
{
  std::vector<Contender> contenders;
  for (const double step : { 2e-6, 4e-6 })
  {
    contenders.push_back({ "leapfrog on the ring", "h = " + text("%.3g us", 1e6 * step),
                           [=, &problem](double limit) { return leapfrog(problem, Way::RING, step, limit); } });
  }
  return contenders;
}

std::vector<Contender> operatingReferences(const OperatingProblem& problem)
{
  constexpr double TOLERANCE = 1e-9;
  const std::string setting = "tol = " + text("%.0e", TOLERANCE);
  return { { "odeint dopri5", setting, [=, &problem](double limit) { return dopri5(problem, TOLERANCE, limit); } },
           { "CVODE, Adams", setting,
             [=, &problem](double limit) { return cvode(problem, CV_ADAMS, TOLERANCE, limit); } } };
}
}  // namespace hjt
