// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "studies/dynamic_ring.hpp"
#include "studies/ring_stepper.hpp"

namespace hjt
{
/// A stretch of a problem in which the right-hand side is smooth in time.
struct Phase
{
  double end{};  ///< [s]
  WaveGrowth wave;
};

/// An initial value problem of the dynamic ring, the same for every solver.
struct Problem
{
  std::string name;
  std::string title;
  std::shared_ptr<const Parameters> parameters;
  std::shared_ptr<const JointModel> model;
  RingDrive drive;
  std::vector<int> spaces;  ///< of the teeth at the start
  Eigen::VectorXd q;        ///< at the start
  Eigen::VectorXd v;
  std::vector<Phase> phases;
  double sample_period{};  ///< [s]
  double fastest{};        ///< angular frequency of the rim's stiffest mode; bounds explicit steps [rad/s]
  double force_floor{};    ///< smallest out-of-balance force that the rounding of coordinates allows to ask for [N]

  double duration() const { return phases.back().end; }
  int samples() const { return static_cast<int>(duration() / sample_period + 0.5); }
  const Phase& phaseAt(double time) const;  ///< that ends there or later
  DynamicRing ring() const;                 ///< as it is at the start
  Eigen::VectorXd scale() const;  ///< of the states, what a tolerance of 1 means: 5 um of depth is a contact's force
};

/// One of problemNames(). Throws std::runtime_error if it has no start.
Problem makeProblem(const std::string& name);
const std::vector<std::string>& problemNames();

/// What a run went through, a row every `sample_period`.
struct Series
{
  Eigen::MatrixXd angles;     ///< wave generator, output, in columns; none if both are driven [rad]
  Eigen::MatrixXd positions;  ///< tooth points [m]
  Eigen::MatrixXd forces;     ///< wave generator's and flanks', per tooth [N]
};

/// Keeps the states at the samples; forces are worked out afterwards, outside the time measured.
class Recorder
{
public:
  explicit Recorder(const Problem& problem);

  double due() const { return problem_.sample_period * (taken_ + 1); }  ///< time of the next sample [s]
  bool done() const { return taken_ == static_cast<int>(states_.cols()); }
  void add(const double* state);
  Series series() const;

private:
  const Problem& problem_;
  Eigen::MatrixXd states_;
  int taken_{};
};

/// Root mean square over the samples, or of the last one, over the reference's standard deviation.
struct Errors
{
  double angle{};
  double position{};
  double force{};

  double worst() const;
};
Errors seriesError(const Series& series, const Series& reference);
Errors endError(const Series& series, const Series& reference);

void writeSeries(const Series& series, const std::string& file);
Series readSeries(const std::string& file);  ///< throws std::runtime_error

/// What one run of a solver came to.
struct Run
{
  std::string failure;  ///< empty: it finished
  double time{};        ///< of the processor [s]
  long steps{};
  double reached{};  ///< in the problem's time [s]
  long force_evaluations{};
  long factorisations{};
  long rejections{};
  Series series;
};

/// Processor time of this thread: what other programs take from a busy machine does not count.
class Stopwatch
{
public:
  Stopwatch() : start_(now()) {}
  double elapsed() const { return now() - start_; }  ///< [s]

private:
  static double now();

  double start_;
};
}  // namespace hjt
