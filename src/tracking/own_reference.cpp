// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tracking/friction_verdict.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
OwnReference ownReference(const std::vector<SoundFriction>& recordings)
{
  OwnReference own;
  if (recordings.empty())
  {
    return own;
  }
  std::vector<FrictionPoint> all;
  double variance = 0.0;
  for (const SoundFriction& recording : recordings)
  {
    all.insert(all.end(), recording.points.begin(), recording.points.end());
    variance += recording.deviation * recording.deviation;
  }
  const auto count = static_cast<double>(recordings.size());
  own.friction = FrictionPoints::merged(all);
  own.friction_deviation = std::sqrt(variance) / count;
  std::vector<double> logarithms;
  for (const SoundFriction& recording : recordings)
  {
    const double ratio = FrictionPoints::ratioOf(FrictionPoints::common(recording.points, own.friction));
    if (ratio > 0.0)
    {
      logarithms.push_back(std::log(ratio));
    }
  }
  own.recordings = std::max<std::size_t>(logarithms.size(), 1);
  double sum = 0.0;
  double squares = 0.0;
  for (const double logarithm : logarithms)
  {
    sum += logarithm;
    squares += logarithm * logarithm;
  }
  const auto known = static_cast<double>(own.recordings);
  own.recordings_deviation =
      own.recordings > 1 ? std::sqrt(std::max(0.0, squares - sum * sum / known) / (known - 1.0)) : 0.0;
  return own;
}
}  // namespace hjt
