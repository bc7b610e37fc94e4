// SPDX-License-Identifier: BSD-3-Clause
#include "identification/cross_validation.hpp"

#include <cmath>

namespace hjt
{
namespace
{
/// Errors of several judged parts as one.
void addError(const CurrentError& part, CurrentError& sum)
{
  const auto rms = [](double a, std::size_t n, double b, std::size_t m)
  {
    return n + m > 0 ? std::sqrt((a * a * static_cast<double>(n) + b * b * static_cast<double>(m)) /
                                 static_cast<double>(n + m)) :
                       0.0;
  };
  sum.moving = rms(sum.moving, sum.moving_rows, part.moving, part.moving_rows);
  sum.resting = rms(sum.resting, sum.rows - sum.moving_rows, part.resting, part.rows - part.moving_rows);
  sum.all = rms(sum.all, sum.rows, part.all, part.rows);
  sum.signal = rms(sum.signal, sum.rows, part.signal, part.rows);
  sum.rows += part.rows;
  sum.moving_rows += part.moving_rows;
}
}  // namespace

std::vector<MotionSample> samplesWithin(const std::vector<MotionSample>& all, const Span& span, const Span& hole)
{
  std::vector<MotionSample> samples;
  bool gap = true;
  for (const MotionSample& sample : all)
  {
    if (!span.contains(sample.time) || hole.contains(sample.time))
    {
      gap = true;
      continue;
    }
    samples.push_back(sample);
    samples.back().after_gap |= gap;
    gap = false;
  }
  return samples;
}

JudgedErrors leaveOneOut(const Parameters& parameters, const std::vector<MotionSample>& all, const Span& train,
                         int folds, bool load_recorded, const std::function<void()>& fitted)
{
  JudgedErrors sum;
  for (int fold = 0; fold < folds; ++fold)
  {
    const double piece = (train.to - train.from) / folds;
    const Span hole{ train.from + fold * piece, train.from + (fold + 1) * piece };
    const JudgedPart left_out{ samplesWithin(all, { train.from, hole.to }), hole.from };
    const JudgedErrors judged = identify(parameters, samplesWithin(all, train, hole), left_out, load_recorded).judged;
    addError(judged.configured, sum.configured);
    addError(judged.without_ripple, sum.without_ripple);
    addError(judged.identified, sum.identified);
    addError(judged.gain_coulomb_viscous, sum.gain_coulomb_viscous);
    fitted();
  }
  return sum;
}
}  // namespace hjt
