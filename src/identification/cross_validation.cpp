// SPDX-License-Identifier: BSD-3-Clause
#include "identification/cross_validation.hpp"

#include <algorithm>
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

/// Times between which the joint goes equal ways: the joints of a check-up move one after the other.
std::vector<double> endsOfPieces(const std::vector<MotionSample>& samples, const Span& train, int pieces)
{
  std::vector<double> ways(1, 0.0);  // up to each sample but the first [rad]
  for (std::size_t i = 1; i < samples.size(); ++i)
  {
    ways.push_back(ways.back() + std::abs(samples[i].position - samples[i - 1].position));
  }
  std::vector<double> ends(1, train.from);
  for (int piece = 1; piece < pieces; ++piece)
  {
    const auto end = std::lower_bound(ways.begin(), ways.end(), ways.back() * piece / pieces);
    ends.push_back(samples[static_cast<std::size_t>(end - ways.begin())].time);
  }
  ends.push_back(train.to);
  return ends;
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
                         int folds, bool load_recorded, const std::function<void()>& fitted,
                         const std::function<void()>& look)
{
  JudgedErrors sum;
  const std::vector<double> ends = endsOfPieces(samplesWithin(all, train), train, folds);
  for (std::size_t fold = 0; fold < static_cast<std::size_t>(folds); ++fold)
  {
    const Span hole{ ends[fold], ends[fold + 1] };
    const JudgedPart left_out{ samplesWithin(all, { train.from, hole.to }), hole.from };
    const JudgedErrors judged =
        identify(parameters, samplesWithin(all, train, hole), left_out, load_recorded, look).judged;
    addError(judged.configured, sum.configured);
    addError(judged.without_ripple, sum.without_ripple);
    addError(judged.identified, sum.identified);
    addError(judged.gain_coulomb_viscous, sum.gain_coulomb_viscous);
    fitted();
  }
  return sum;
}
}  // namespace hjt
