// SPDX-License-Identifier: BSD-3-Clause
#include "studies/ring_method.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

#include "studies/implicit_ring_stepper.hpp"

namespace hjt
{
namespace
{
/// Marches a dynamic ring in steps of its own choice, so that no tooth is further off by one step than the tolerance.
///
/// Proportional and integral control of the step's length (Gustafsson 1991; Hairer and Wanner IV.2):
///   next / present = 0.9 e_n^(-0.7 / k) e_(n-1)^(0.4 / k),   0.2 ... 5
/// where   e_n   error estimate of step n over the tolerance, at most 1; k   the power of the step it goes with
///
/// A step whose e_n is above 1 is done again, shorter, and the one after it does not grow. Where a tooth touches or
/// lets go the forces have a kink: no event is looked for, the estimate sees it and the step shrinks for as long as it
/// must. No allocation after construction.
class AdaptiveRingStepper : public RingStepper
{
public:
  /// `tolerance` > 0 [m].
  AdaptiveRingStepper(DynamicRing& ring, const RungeKuttaTableau& tableau, const SolverParameters& solver,
                      double tolerance)
    : ring_(ring)
    , method_(ring, tableau, solver)
    , tolerance_(tolerance)
    , begin_(ring.coordinates())
    , before_(ring.coordinates())
  {
  }

  /// Covers `length` in as many steps as it takes; what the last of them taught is kept for the next call. False if
  /// they became shorter than a billionth of it.
  bool step(RingMotion& motion, double length) noexcept override
  {
    constexpr double SHORTEST = 1e-9;  // share of the whole length
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
      // The remaining time is divided evenly: no tiny step at the end.
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
        next_ = stride * (change > MIN_CHANGE ? change : MIN_CHANGE);  // also if it is not a number
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
  static constexpr double MIN_RATIO = 1e-6;  // an error of nothing is not taken for more than luck

  /// Length in which the present accelerations move no tooth by more than the tolerance [s].
  double firstStep(const RingMotion& motion, double length) noexcept
  {
    ring_.evaluate(motion.q, motion.v, motion.time);
    const int teeth = 2 * ring_.teeth();
    const double largest = ring_.force().cwiseProduct(ring_.inverseMass()).head(teeth).lpNorm<Eigen::Infinity>();
    const double step = std::sqrt(tolerance_ / largest);
    return step < length ? step : length;  // the whole length where nothing accelerates
  }

  /// Of the step after an accepted one.
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
  double next_{};           // step that the control asks for; 0: none yet [s]
  double previous_{ 1.0 };  // e of the last accepted step
  bool just_rejected_{};
  RingMotion begin_;
  RingMotion before_;
};

/// The classical Runge-Kutta method of Boost.odeint: no damping of its own worth speaking of, but the step is bounded
/// by the stiffest mode (2.8 over its angular frequency). The reference for the implicit methods.
class ExplicitRingStepper : public RingStepper
{
public:
  explicit ExplicitRingStepper(DynamicRing& ring) : ring_(ring), state_(static_cast<std::size_t>(ring.states()) + 2)
  {
    method_.adjust_size(state_);
  }

  /// False if a value ceased to be finite.
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
  using State = std::vector<double>;  // the ring's, energy supplied, energy dissipated

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
