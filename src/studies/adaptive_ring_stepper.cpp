// SPDX-License-Identifier: BSD-3-Clause
#include "studies/adaptive_ring_stepper.hpp"

#include <algorithm>
#include <cmath>

namespace hjt
{
namespace
{
constexpr double SAFETY = 0.9;
constexpr double MIN_CHANGE = 0.2;
constexpr double MAX_CHANGE = 5.0;
constexpr double MIN_RATIO = 1e-6;  // an error of nothing is not taken for more than luck
}  // namespace

AdaptiveRingStepper::AdaptiveRingStepper(DynamicRing& ring, std::unique_ptr<EmbeddedRingStepper> method,
                                         double tolerance)
  : ring_(ring)
  , method_(std::move(method))
  , tolerance_(tolerance)
  , begin_(ring.coordinates())
  , before_(ring.coordinates())
{
}

bool AdaptiveRingStepper::step(RingMotion& motion, double length) noexcept
{
  constexpr double SHORTEST = 1e-9;  // of the whole length
  const double end = motion.time + length;
  begin_ = motion;
  method_->restart();
  if (next_ == 0.0)
  {
    next_ = firstStep(motion, length);
  }
  double rest = length;
  while (rest > 0.0)
  {
    // What is left is shared out evenly: no tiny step at the end.
    const double stride = rest / std::max(1.0, std::ceil(rest / next_ - 1e-9));
    before_ = motion;
    ring_.pairTeeth(motion.q, motion.time);
    const bool good = method_->attempt(motion, stride);
    counts_.force_evaluations = method_->counts().force_evaluations;
    counts_.factorisations = method_->counts().factorisations;
    if (!good)
    {
      ++counts_.halvings;
      just_rejected_ = true;
      next_ = 0.5 * stride;
    }
    else if (const double ratio = method_->errorEstimate() / tolerance_; !(ratio <= 1.0))
    {
      ++counts_.rejections;
      just_rejected_ = true;
      motion = before_;
      const double change = SAFETY * std::pow(ratio, -1.0 / method_->errorPower());
      next_ = stride * (change > MIN_CHANGE ? change : MIN_CHANGE);  // also if it is not a number
    }
    else
    {
      ++counts_.steps;
      method_->accept();
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

/// In which the accelerations at hand move no tooth by more than the tolerance [s].
double AdaptiveRingStepper::firstStep(const RingMotion& motion, double length) noexcept
{
  ring_.evaluate(motion.q, motion.v, motion.time);
  const int teeth = 2 * ring_.teeth();
  const double largest = ring_.force().cwiseProduct(ring_.inverseMass()).head(teeth).lpNorm<Eigen::Infinity>();
  const double step = std::sqrt(tolerance_ / largest);
  return step < length ? step : length;  // the whole length where nothing accelerates
}

/// Of the step after an accepted one.
double AdaptiveRingStepper::growth(double ratio) noexcept
{
  const double power = 1.0 / method_->errorPower();
  const double bounded = std::max(ratio, MIN_RATIO);
  const double change = SAFETY * std::pow(bounded, -0.7 * power) * std::pow(previous_, 0.4 * power);
  const double most = just_rejected_ ? 1.0 : MAX_CHANGE;
  previous_ = bounded;
  just_rejected_ = false;
  return std::clamp(change, MIN_CHANGE, most);
}
}  // namespace hjt
