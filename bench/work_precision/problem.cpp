// SPDX-License-Identifier: BSD-3-Clause
#include "bench/work_precision/problem.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <time.h>

#include "gear/ratio.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "studies/ring_stepper.hpp"
#include "test/core/test_parameters.hpp"

namespace hjt
{
namespace
{
Problem fromParameters(const std::string& name, const std::string& title, const Parameters& parameters)
{
  Problem problem;
  problem.name = name;
  problem.title = title;
  problem.parameters = std::make_shared<Parameters>(parameters);
  problem.model = std::make_shared<JointModel>(*problem.parameters);
  const int teeth = problem.model->ring.rest.teeth();
  problem.fastest = 2.0 * std::sqrt(parameters.ring.tension_stiffness * teeth / parameters.ring.mass);
  problem.force_floor = 2e-17 * parameters.ring.tension_stiffness;  // a coordinate of 30 mm is rounded to 3e-18 m
  return problem;
}

/// Thesis, chapter 6: the wave grows from nothing to its amplitude in 5 ms, then stays; masses of the teeth times 50.
Problem insertion()
{
  Parameters parameters = thesisParameters();
  Problem problem = fromParameters("insertion", "Insertion of the wave generator, thesis masses, 0.05 s", parameters);
  auto model = std::make_shared<JointModel>(*problem.parameters);
  model->ring.setMeshed(false);
  problem.model = model;
  problem.drive.wave_generator_driven = true;
  problem.drive.output_driven = true;
  const double amplitude = parameters.gear.wave_amplitude;
  constexpr double GROWTH_TIME = 5e-3;
  problem.phases = { { GROWTH_TIME, { 0.0, 0.0, amplitude / GROWTH_TIME } },
                     { 0.05, { GROWTH_TIME, amplitude, 0.0 } } };
  problem.drive.wave = problem.phases.front().wave;
  problem.sample_period = 1e-3;
  problem.q = Eigen::VectorXd::Zero(2 * model->ring.rest.teeth() + 2);
  problem.q.head(2 * model->ring.rest.teeth()) = model->ring.rest.points();
  problem.v = Eigen::VectorXd::Zero(problem.q.size());
  problem.spaces = model->ring.restShape({}).space;
  return problem;
}

/// The working drive at 100 rad/s, wave generator and circular spline free; at the start the load steps from 10 to 40
/// N.m.
Problem drive()
{
  constexpr double DURATION = 0.05;     // [s]
  constexpr double SPEED = 100.0;       // [rad/s]
  constexpr double LOAD_BEFORE = 10.0;  // [N.m]
  constexpr double LOAD_AFTER = 40.0;
  const Parameters parameters = shippedParameters();
  Problem problem = fromParameters("drive", "Working drive, load step, 0.05 s", parameters);
  const double amplitude = parameters.gear.wave_amplitude;
  RingEquilibrium ring(problem.model->ring, staticSolver(parameters.solver));
  RingMotion motion(2 * problem.model->ring.rest.teeth() + 2);
  if (!ring.insert({ 0.0, 0.0, amplitude }).ok() || !balanceOutput(ring, 0.0, LOAD_BEFORE).ok() ||
      !travelInEquilibrium(ring, SPEED, LOAD_BEFORE, motion).ok())
  {
    throw std::runtime_error(problem.name + ": no equilibrium to start from");
  }
  problem.drive.wave.amplitude = amplitude;
  problem.drive.motor_torque = LOAD_AFTER / nominalRatio(parameters.gear);
  problem.drive.load_torque = LOAD_AFTER;
  problem.phases = { { DURATION, problem.drive.wave } };
  problem.sample_period = 1e-3;
  problem.q = motion.q;
  problem.v = motion.v;
  problem.spaces = ring.shape().space;
  return problem;
}

double largestDeviation(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& reference)
{
  if (reference.size() == 0)
  {
    return 0.0;
  }
  const Eigen::MatrixXd deviation = reference.rowwise() - reference.colwise().mean();
  const double spread = std::sqrt(deviation.cwiseAbs2().mean());
  return std::sqrt(errors.cwiseAbs2().mean()) / spread;
}

template <class Part>
Errors compare(const Series& series, const Series& reference, Part&& part)
{
  const auto error = [&](const Eigen::MatrixXd& values, const Eigen::MatrixXd& right)
  { return largestDeviation(right.size() == 0 ? right : part(Eigen::MatrixXd(values - right)), right); };
  return { error(series.angles, reference.angles), error(series.positions, reference.positions),
           error(series.forces, reference.forces) };
}

void writeMatrix(std::ofstream& out, const Eigen::MatrixXd& matrix)
{
  const Eigen::Index size[] = { matrix.rows(), matrix.cols() };
  out.write(reinterpret_cast<const char*>(size), sizeof size);
  out.write(reinterpret_cast<const char*>(matrix.data()),
            static_cast<std::streamsize>(sizeof(double)) * static_cast<std::streamsize>(matrix.size()));
}

Eigen::MatrixXd readMatrix(std::ifstream& in)
{
  Eigen::Index size[2] = {};
  in.read(reinterpret_cast<char*>(size), sizeof size);
  Eigen::MatrixXd matrix(size[0], size[1]);
  in.read(reinterpret_cast<char*>(matrix.data()),
          static_cast<std::streamsize>(sizeof(double)) * static_cast<std::streamsize>(matrix.size()));
  return matrix;
}
}  // namespace

DynamicRing Problem::ring() const
{
  DynamicRing ring(*model, parameters->ring, drive);
  ring.setSpaces(spaces);
  return ring;
}

Eigen::VectorXd Problem::scale() const
{
  constexpr double POSITION = 5e-6;  // [m]
  constexpr double ANGLE = 1e-3;     // [rad]
  constexpr double SPEED = 0.1;      // [m/s]
  constexpr double TURNING = 10.0;   // [rad/s]
  const Eigen::Index n = q.size();
  Eigen::VectorXd scale(2 * n);
  scale.head(n - 2).setConstant(POSITION);
  scale.segment(n - 2, 2).setConstant(ANGLE);
  scale.segment(n, n - 2).setConstant(SPEED);
  scale.tail(2).setConstant(TURNING);
  return scale;
}

const std::vector<std::string>& problemNames()
{
  static const std::vector<std::string> NAMES{ "insertion", "drive" };
  return NAMES;
}

Problem makeProblem(const std::string& name)
{
  return name == "insertion" ? insertion() : drive();
}

const Phase& Problem::phaseAt(double time) const
{
  const auto holds = [&](const Phase& phase) { return time <= phase.end * (1.0 + 1e-12); };
  const auto found = std::find_if(phases.begin(), phases.end(), holds);
  return found == phases.end() ? phases.back() : *found;
}

Recorder::Recorder(const Problem& problem) : problem_(problem), states_(2 * problem.q.size(), problem.samples()) {}

void Recorder::add(const double* state)
{
  states_.col(taken_++) = Eigen::Map<const Eigen::VectorXd>(state, states_.rows());
}

Series Recorder::series() const
{
  const Eigen::Index n = problem_.q.size();
  const bool driven = problem_.drive.wave_generator_driven && problem_.drive.output_driven;
  DynamicRing ring = problem_.ring();
  const int teeth = ring.teeth();
  Series series{ Eigen::MatrixXd(states_.cols(), driven ? 0 : 2), Eigen::MatrixXd(states_.cols(), n - 2),
                 Eigen::MatrixXd(states_.cols(), 2 * teeth) };
  for (int i = 0; i < states_.cols(); ++i)
  {
    const double time = problem_.sample_period * (i + 1);
    ring.setWave(problem_.phaseAt(time).wave);
    const Eigen::VectorXd q = states_.col(i).head(n);
    ring.pairTeeth(q, time);
    ring.evaluate(q, states_.col(i).tail(n), time);
    if (!driven)
    {
      series.angles.row(i) = q.tail(2);
    }
    series.positions.row(i) = q.head(n - 2);
    series.forces.row(i) << ring.forces().of<WaveGeneratorContact>().force.transpose(),
        ring.forces().of<ToothMesh>().flank_force.transpose();
  }
  return series;
}

double Errors::worst() const
{
  return std::max({ angle, position, force });
}

Errors seriesError(const Series& series, const Series& reference)
{
  return compare(series, reference, [](const Eigen::MatrixXd& errors) { return errors; });
}

Errors endError(const Series& series, const Series& reference)
{
  return compare(series, reference,
                 [](const Eigen::MatrixXd& errors) { return Eigen::MatrixXd(errors.bottomRows(1)); });
}

void writeSeries(const Series& series, const std::string& file)
{
  std::ofstream out(file, std::ios::binary);
  writeMatrix(out, series.angles);
  writeMatrix(out, series.positions);
  writeMatrix(out, series.forces);
  if (!out.flush())
  {
    throw std::runtime_error("cannot write " + file);
  }
}

Series readSeries(const std::string& file)
{
  std::ifstream in(file, std::ios::binary);
  if (!in)
  {
    throw std::runtime_error("cannot read " + file);
  }
  Series series;
  series.angles = readMatrix(in);
  series.positions = readMatrix(in);
  series.forces = readMatrix(in);
  return series;
}

double Stopwatch::now()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
}  // namespace hjt
