// SPDX-License-Identifier: BSD-3-Clause
#include <dlfcn.h>

#include <algorithm>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/solvers.hpp"

namespace hjt
{
namespace
{
using Rates = void (*)(int*, double*, double*, double*, double*, int*);
using Jacobian = void (*)(int*, double*, double*, int*, int*, double*, int*, double*, int*);
using Mass = void (*)(int*, double*, int*, double*, int*);
using StepDone = void (*)(int*, double*, double*, double*, double*, int*, int*, double*, int*, int*);
using Radau5 = void (*)(int*, Rates, double*, double*, double*, double*, double*, double*, int*, Jacobian, int*, int*,
                        int*, Mass, int*, int*, int*, StepDone, int*, double*, int*, int*, int*, double*, int*, int*);

/// Hairer and Wanner's code as R's deSolve has it (the Jacobian's bandwidths are two arguments more). Null if that
/// package is not installed.
Radau5 loadRadau5()
{
  static void* const LIBRARY = dlopen("/usr/lib/R/site-library/deSolve/libs/deSolve.so", RTLD_NOW | RTLD_LOCAL);
  return LIBRARY == nullptr ? nullptr : reinterpret_cast<Radau5>(dlsym(LIBRARY, "radau5_"));
}

/// RADAU5, told that half of the states are the derivatives of the other half; analytic Jacobian, dense factorisation.
class Radau : public Integrator
{
public:
  Radau(const Problem& problem, double tolerance)
    : radau5_(loadRadau5())
    , ring_(problem.ring())
    , state_(ring_.states())
    , weights_(tolerance * problem.scale())
    , relative_(ring_.states())
    , absolute_(ring_.states())
  {
    state_ << problem.q, problem.v;
    const auto n = static_cast<std::size_t>(ring_.states());
    const std::size_t half = n / 2;
    reals_.resize(n * (half + 12) + half * 3 * half + 20);
    integers_.resize(3 * n + 20);
  }

  void enter(const Phase& phase, double /*time*/) override
  {
    ring_.setWave(phase.wave);
    step_ = FIRST_STEP;
  }

  bool advance(double due, double /*end*/, double& time) override
  {
    // It takes 0.1 r^(2/3) for a relative tolerance r and scales the absolute one alike: made so that what it uses are
    // 1e-9 and the weights.
    relative_.setConstant(1e-12);
    absolute_ = 1e-3 * weights_;
    std::fill(reals_.begin(), reals_.end(), 0.0);
    std::fill(integers_.begin(), integers_.end(), 0);
    int n = ring_.states();
    int half = n / 2;
    integers_[1] = MAX_STEPS;
    integers_[8] = half;
    int real_size = static_cast<int>(reals_.size());
    int integer_size = static_cast<int>(integers_.size());
    int one = 1;
    int none = 0;
    int result = 0;
    g_active = this;
    radau5_(&n, rates, &time, state_.data(), &due, &step_, relative_.data(), absolute_.data(), &one, jacobian, &one,
            &half, &half, nullptr, &none, &none, &none, stepDone, &one, reals_.data(), &real_size, integers_.data(),
            &integer_size, nullptr, nullptr, &result);
    evaluations_ += integers_[13];
    steps_ += integers_[16];
    rejections_ += integers_[17];
    factorisations_ += integers_[18];
    return result == 1;
  }

  const double* at(double /*time*/) override { return state_.data(); }

  void count(Run& run) override
  {
    run.steps = steps_;
    run.force_evaluations = evaluations_;
    run.factorisations = factorisations_;
    run.rejections = rejections_;
  }

private:
  static constexpr double FIRST_STEP = 1e-7;  // [s]
  static constexpr int MAX_STEPS = 100000000;

  static void rates(int* /*n*/, double* time, double* state, double* derivative, double*, int*)
  {
    g_active->ring_.rates(state, *time, derivative);
  }

  /// Of the speeds' derivatives only: the others are known.
  static void jacobian(int* /*n*/, double* time, double* state, int*, int*, double* values, int* rows, double*, int*)
  {
    DynamicRing& ring = g_active->ring_;
    Eigen::VectorXd derivative(ring.states());
    ring.rates(state, *time, derivative.data());
    Eigen::Map<Eigen::MatrixXd>(values, *rows, ring.states()) =
        ring.jacobian(DynamicRing::Cup::DENSE).bottomRows(*rows);
  }

  static void stepDone(int* /*count*/, double* /*before*/, double* time, double* state, double*, int*, int*, double*,
                       int*, int* go_on)
  {
    DynamicRing& ring = g_active->ring_;
    ring.pairTeeth(Eigen::Map<const Eigen::VectorXd>(state, ring.coordinates()), *time);
    *go_on = 0;
  }

  static inline Radau* g_active = nullptr;  // the code passes no pointer of ours on

  Radau5 radau5_;
  DynamicRing ring_;
  Eigen::VectorXd state_;
  Eigen::VectorXd weights_;
  Eigen::VectorXd relative_;
  Eigen::VectorXd absolute_;
  std::vector<double> reals_;
  std::vector<int> integers_;
  double step_{ FIRST_STEP };
  long steps_{};
  long evaluations_{};
  long factorisations_{};
  long rejections_{};
};
}  // namespace

std::vector<Contender> radauContenders(const Problem& problem)
{
  // Dense factorisation of 400 x 400 real and complex: given longer than the others.
  constexpr double PATIENCE = 2.0;
  std::vector<Contender> contenders;
  if (loadRadau5() == nullptr)
  {
    return contenders;
  }
  for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
  {
    contenders.push_back({ "RADAU5, dense", "tol = " + text("%.0e", tolerance),
                           [=, &problem](double limit)
                           {
                             Radau integrator(problem, tolerance);
                             return follow(problem, integrator, PATIENCE * limit);
                           } });
  }
  return contenders;
}
}  // namespace hjt
