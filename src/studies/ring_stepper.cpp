// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ring_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

namespace hjt
{
ImplicitRingStepper::ImplicitRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau,
                                         const SolverParameters& solver)
  : ring_(ring)
  , tableau_(tableau)
  , parameters_(solver)
  , weight_(Eigen::VectorXd::Ones(ring.coordinates()))
  , tangent_(ring.teeth())
  , solver_(ring.teeth())
  , speeds_(static_cast<std::size_t>(tableau.stages()), Eigen::VectorXd::Zero(ring.coordinates()))
  , accelerations_(speeds_)
  , powers_(speeds_.size())
  , q_bar_(ring.coordinates())
  , v_bar_(ring.coordinates())
  , q_(ring.coordinates())
  , v_(ring.coordinates())
  , residual_(ring.coordinates())
  , newton_(ring.coordinates())
  , start_(ring.coordinates())
  , begin_(ring.coordinates())
{
  weight_.tail<2>().setConstant(1.0 / ring.shape().points.head<2>().norm());
  free_ = ring.mass().cwiseProduct(ring.inverseMass());
}

bool ImplicitRingStepper::step(RingMotion& motion, double length) noexcept
{
  const double end = motion.time + length;
  begin_ = motion;
  double stride = length;
  int halvings = 0;
  restart();
  ring_.pairTeeth(motion.q, motion.time);
  double done = 0.0;
  while (done < length)
  {
    const double next = std::min(stride, length - done);
    if (attempt(motion, next))
    {
      done = next < length - done ? done + next : length;
      stride *= 2.0;
      accept();
      ring_.pairTeeth(motion.q, motion.time);
      continue;
    }
    ++counts_.halvings;
    if (++halvings > parameters_.max_step_cuts)
    {
      motion = begin_;
      return false;
    }
    stride = 0.5 * next;
  }
  motion.time = end;
  ++counts_.steps;
  return true;
}

bool ImplicitRingStepper::attempt(RingMotion& motion, double length) noexcept
{
  stage_step_ = tableau_.gamma * length;
  factored_ = false;
  const int stages = tableau_.stages();
  q_ = motion.q;
  v_ = motion.v;
  for (int i = 0; i < stages; ++i)
  {
    const auto k = static_cast<std::size_t>(i);
    const double time = motion.time + tableau_.times[k] * length;
    if (i == 0 && tableau_.explicit_first)
    {
      if (!begun_)
      {
        ring_.evaluate(motion.q, motion.v, time);
        ++counts_.force_evaluations;
        begin(motion.v);
      }
    }
    else
    {
      q_bar_ = motion.q;
      v_bar_ = motion.v;
      for (std::size_t j = 0; j < k; ++j)
      {
        q_bar_ += length * tableau_.before[k][j] * speeds_[j];
        v_bar_ += length * tableau_.before[k][j] * accelerations_[j];
      }
      // The first guess extrapolates the last stage with its acceleration. A driven body keeps its speed exactly.
      if (i > 0)
      {
        v_ += (tableau_.times[k] - tableau_.times[k - 1]) * length * accelerations_[k - 1];
      }
      if (!solveStage(time))
      {
        return false;
      }
      speeds_[k] = v_;
      accelerations_[k] = (v_ - v_bar_) / stage_step_;
      powers_[k] = ring_.power();
    }
  }
  error_ = 0.0;
  if (!tableau_.error.empty())
  {
    start_.setZero();
    for (int i = 0; i < stages; ++i)
    {
      start_ += length * tableau_.error[static_cast<std::size_t>(i)] * speeds_[static_cast<std::size_t>(i)];
    }
    error_ = start_.head(start_.size() - 2).lpNorm<Eigen::Infinity>();
  }
  for (int i = 0; i < stages; ++i)
  {
    motion.supplied += length * tableau_.weight(i) * powers_[static_cast<std::size_t>(i)].supplied;
    motion.dissipated += length * tableau_.weight(i) * powers_[static_cast<std::size_t>(i)].dissipated;
  }
  motion.q = q_;
  motion.v = v_;
  motion.time += length;
  return true;
}

/// Computes the explicit first stage of a step from the last evaluated forces.
void ImplicitRingStepper::begin(const Eigen::VectorXd& speeds) noexcept
{
  speeds_.front() = speeds;
  accelerations_.front() = ring_.force().cwiseProduct(ring_.inverseMass());
  powers_.front() = ring_.power();
  begun_ = true;
}

void ImplicitRingStepper::accept() noexcept
{
  if (tableau_.explicit_first)
  {
    begin(v_);  // the last stage of the accepted step is the first stage of the next step
  }
}

/// Computes q_ from the speeds v_, and the out-of-balance force into residual_. The unknowns are speeds, because
/// differences of positions lose digits in short steps. @returns the Euclidean norm, torques as forces at the rim [N].
double ImplicitRingStepper::residual(double time) noexcept
{
  q_ = q_bar_ + stage_step_ * v_;
  ring_.evaluate(q_, v_, time);
  ++counts_.force_evaluations;
  residual_ = (ring_.force() - ring_.mass().cwiseProduct(v_ - v_bar_) / stage_step_).cwiseProduct(free_);
  largest_ = residual_.cwiseProduct(weight_).lpNorm<Eigen::Infinity>();
  return residual_.cwiseProduct(weight_).norm();
}

bool ImplicitRingStepper::factor() noexcept
{
  ring_.tangent(1.0 / stage_step_, tangent_);
  const double inverse_square = 1.0 / (stage_step_ * stage_step_);
  const Eigen::VectorXd& mass = ring_.mass();
  for (int i = 0; i < tangent_.teeth(); ++i)
  {
    tangent_.addDiagonal(i, Block2((inverse_square * mass.segment<2>(2 * i)).asDiagonal()));
  }
  tangent_.wave_generator_stiffness += inverse_square * mass[ring_.waveGenerator()];
  tangent_.output_stiffness += inverse_square * mass[ring_.output()];
  ++counts_.factorisations;
  factored_ = solver_.factor(tangent_, { ring_.driven(ring_.waveGenerator()), ring_.driven(ring_.output()) });
  return factored_;
}

bool ImplicitRingStepper::solveStage(double time) noexcept
{
  constexpr double GOOD_CONTRACTION = 0.01;  // norm over last norm, below which the next iteration keeps the factors
  double norm = residual(time);
  bool useful = factored_;
  bool own = false;  // whether the factors belong to the current point of the iteration
  for (int i = 0; i < parameters_.max_iterations; ++i)
  {
    if (!std::isfinite(norm))
    {
      return false;
    }
    if (largest_ <= parameters_.force_tolerance)
    {
      return true;
    }
    own = !useful;
    if (own && !factor())
    {
      return false;
    }
    const double before = norm;
    if (!searchLine(time, norm))
    {
      if (own)
      {
        return false;
      }
      useful = false;  // old factors may give no descent, so the iteration is repeated with new ones
      continue;
    }
    useful = norm < GOOD_CONTRACTION * before;
  }
  return largest_ <= parameters_.force_tolerance;
}

/// One Newton step, shortened until the out-of-balance force decreases.
bool ImplicitRingStepper::searchLine(double time, double& norm) noexcept
{
  constexpr int MAX_HALVINGS = 7;
  newton_ = residual_;
  solver_.solve(newton_);
  newton_ /= stage_step_;
  start_ = v_;
  double length = 1.0;
  for (int i = 0; i < MAX_HALVINGS; ++i, length *= 0.5)
  {
    v_ = start_ + length * newton_;
    const double trial = residual(time);
    if (trial < (1.0 - 1e-4 * length) * norm || largest_ <= parameters_.force_tolerance)
    {
      norm = trial;
      return true;
    }
  }
  v_ = start_;
  norm = residual(time);
  return false;
}

namespace
{
/// Integrates a dynamic ring with step control, so that no tooth's error in one step exceeds the tolerance.
///
/// Proportional-integral control of the step length (Gustafsson 1991; Hairer and Wanner IV.2):
///   next length / this length = 0.9 e_n^(-0.7 / k) e_(n-1)^(0.4 / k),  limited to 0.2 ... 5
/// where   e_n   error estimate of the accepted step n over the tolerance;  k   order of the estimate
///
/// A step with e_n > 1 is repeated with a shorter length, and the step after it is not longer. The forces have a kink
/// when a tooth begins or ends contact. The class does not detect these events, but the error estimate increases at
/// such an event, so that the steps become shorter. Only the constructor allocates.
class AdaptiveRingStepper : public RingStepper
{
public:
  /// `tolerance`: largest error of a tooth's position in one step, > 0 [m].
  AdaptiveRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau, const SolverParameters& solver,
                      double tolerance)
    : ring_(ring)
    , method_(ring, tableau, solver)
    , tolerance_(tolerance)
    , begin_(ring.coordinates())
    , before_(ring.coordinates())
  {
  }

  /// Integrates over `length` in as many steps as needed. The next call starts with the last step length. @returns
  /// false if a step would be shorter than the share SHORTEST of `length`.
  bool step(RingMotion& motion, double length) noexcept override
  {
    constexpr double SHORTEST = 1e-9;  // shortest step over `length` [-]
    const double end = motion.time + length;
    begin_ = motion;
    method_.restart();
    if (next_ == 0.0)
    {
      next_ = firstStep(motion, length);
    }
    double rest = length;
    while (rest > 0.0)
    {
      // Equal division of the remaining time avoids a tiny last step.
      const double stride = rest / std::max(1.0, std::ceil(rest / next_ - 1e-9));
      before_ = motion;
      ring_.pairTeeth(motion.q, motion.time);
      const bool good = method_.attempt(motion, stride);
      counts_.force_evaluations = method_.counts().force_evaluations;
      counts_.factorisations = method_.counts().factorisations;
      if (!good)
      {
        ++counts_.halvings;
        just_rejected_ = true;
        next_ = 0.5 * stride;
      }
      else if (const double ratio = method_.errorEstimate() / tolerance_; !(ratio <= 1.0))
      {
        ++counts_.rejections;
        just_rejected_ = true;
        motion = before_;
        const double change = SAFETY * std::pow(ratio, -1.0 / method_.errorPower());
        next_ = stride * (change > MIN_CHANGE ? change : MIN_CHANGE);  // also for NaN
      }
      else
      {
        ++counts_.steps;
        method_.accept();
        next_ = stride * growth(ratio);
        rest = stride == rest ? 0.0 : rest - stride;
        continue;
      }
      if (next_ < SHORTEST * length)
      {
        motion = begin_;
        next_ = 0.0;
        return false;
      }
    }
    motion.time = end;
    return true;
  }

private:
  static constexpr double SAFETY = 0.9;
  static constexpr double MIN_CHANGE = 0.2;
  static constexpr double MAX_CHANGE = 5.0;
  static constexpr double MIN_RATIO = 1e-6;  // lower limit of e_n, which may be small by chance

  /// Length of the first step, in which its first accelerations move no tooth by more than the tolerance [s].
  double firstStep(const RingMotion& motion, double length) noexcept
  {
    ring_.evaluate(motion.q, motion.v, motion.time);
    const int teeth = 2 * ring_.teeth();
    const double largest = ring_.force().cwiseProduct(ring_.inverseMass()).head(teeth).lpNorm<Eigen::Infinity>();
    const double step = std::sqrt(tolerance_ / largest);
    return step < length ? step : length;  // also `length` if all accelerations are 0
  }

  /// Factor on the step length after an accepted step with e_n = `ratio`.
  double growth(double ratio) noexcept
  {
    const double power = 1.0 / method_.errorPower();
    const double bounded = std::max(ratio, MIN_RATIO);
    const double change = SAFETY * std::pow(bounded, -0.7 * power) * std::pow(previous_, 0.4 * power);
    const double most = just_rejected_ ? 1.0 : MAX_CHANGE;
    previous_ = bounded;
    just_rejected_ = false;
    return std::clamp(change, MIN_CHANGE, most);
  }

  DynamicRing& ring_;
  ImplicitRingStepper method_;
  double tolerance_;
  double next_{};           // length of the next step by the control; 0: not determined yet [s]
  double previous_{ 1.0 };  // e_n of the last accepted step
  bool just_rejected_{};
  RingMotion begin_;
  RingMotion before_;
};

/// The classical Runge-Kutta method of Boost.odeint, as reference for the implicit methods. The method has little
/// numerical damping, but the step must be shorter than 2.8 over the angular frequency of the stiffest mode.
class ExplicitRingStepper : public RingStepper
{
public:
  explicit ExplicitRingStepper(DynamicRing& ring) : ring_(ring), state_(static_cast<std::size_t>(ring.states()) + 2)
  {
    method_.adjust_size(state_);
  }

  /// @returns false if a value became infinite or NaN.
  bool step(RingMotion& motion, double length) noexcept override
  {
    const int n = ring_.coordinates();
    const int size = ring_.states();
    ring_.pairTeeth(motion.q, motion.time);
    Eigen::Map<Eigen::VectorXd>(state_.data(), n) = motion.q;
    Eigen::Map<Eigen::VectorXd>(state_.data() + n, n) = motion.v;
    double* ledger = state_.data() + size;
    ledger[0] = motion.supplied;
    ledger[1] = motion.dissipated;
    const auto system = [&](const State& state, State& derivative, double time)
    {
      ring_.rates(state.data(), time, derivative.data());
      derivative[static_cast<std::size_t>(size)] = ring_.power().supplied;
      derivative[static_cast<std::size_t>(size) + 1] = ring_.power().dissipated;
      ++counts_.force_evaluations;
    };
    method_.do_step(system, state_, motion.time, length);
    if (!Eigen::Map<const Eigen::VectorXd>(state_.data(), size + 2).allFinite())
    {
      return false;
    }
    motion.q = Eigen::Map<const Eigen::VectorXd>(state_.data(), n);
    motion.v = Eigen::Map<const Eigen::VectorXd>(state_.data() + n, n);
    motion.time += length;
    motion.supplied = ledger[0];
    motion.dissipated = ledger[1];
    ++counts_.steps;
    return true;
  }

private:
  using State = std::vector<double>;  // state of the ring, supplied energy, dissipated energy

  DynamicRing& ring_;
  boost::numeric::odeint::runge_kutta4<State> method_;
  State state_;
};

const RungeKuttaTableau& tableauOf(RingMethod method)
{
  return method == RingMethod::TR_BDF2 ? trBdf2() : method == RingMethod::ESDIRK4 ? esdirk4() : implicitEuler();
}
}  // namespace

bool judgesItsError(RingMethod method)
{
  return method == RingMethod::TR_BDF2 || method == RingMethod::ESDIRK4;
}

std::unique_ptr<RingStepper> makeRingStepper(RingMethod method, DynamicRing& ring, const SolverParameters& solver,
                                             double tolerance)
{
  if (method == RingMethod::RUNGE_KUTTA4)
  {
    return std::make_unique<ExplicitRingStepper>(ring);
  }
  if (judgesItsError(method) && tolerance > 0.0)
  {
    return std::make_unique<AdaptiveRingStepper>(ring, tableauOf(method), solver, tolerance);
  }
  return std::make_unique<ImplicitRingStepper>(ring, tableauOf(method), solver);
}
}  // namespace hjt
