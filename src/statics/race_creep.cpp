// SPDX-License-Identifier: BSD-3-Clause
#include "statics/race_creep.hpp"

#include <algorithm>
#include <cmath>

#include "elements/race_fit.hpp"
#include "statics/gear_rules.hpp"

namespace hjt
{
RaceCreep::RaceCreep(const Parameters& parameters)
  : lever_(parameters.contact.slip_lever)
  , radius_(parameters.gear.flexspline_inner_radius)
  , fit_(raceFit(parameters))
  , rest_length_(segmentLength(parameters.gear))
{
}

RaceCreep::Rates RaceCreep::at(const RingEquilibrium& ring, const Eigen::VectorXd& running)
{
  const RingShape& shape = ring.shape();
  const Eigen::VectorXd& force = ring.forces().of<WaveGeneratorContact>().force;
  const Eigen::VectorXd& gap = ring.model().of<WaveGeneratorContact>().gap();
  double total = 0.0;
  slips_.clear();
  for (int i = 0; i < shape.solved; ++i)
  {
    if (force[i] <= 0.0)
    {
      continue;
    }
    const int h = shape.previous(i);
    const int j = shape.next(i);
    const Eigen::Vector2d chord = shape.points.segment<2>(2 * j) - shape.points.segment<2>(2 * h);
    const Eigen::Vector2d rate = running.segment<2>(2 * j) - running.segment<2>(2 * h);
    const double tilt = (chord.y() * rate.x() - chord.x() * rate.y()) / chord.squaredNorm();
    const double strain = (shape.lengths[h] + shape.lengths[i]) / (2.0 * rest_length_) - 1.0;
    slips_.push_back({ lever_ * tilt - radius_ * strain + fit_ - gap[i], force[i] });
    total += force[i];
  }
  std::sort(slips_.begin(), slips_.end(), [](const Slip& a, const Slip& b) { return a.rate < b.rate; });
  Rates rates;
  double below = 0.0;
  for (const Slip& slip : slips_)
  {
    below += slip.force;
    if (below >= 0.5 * total)
    {
      rates.advance = slip.rate;
      break;
    }
  }
  for (const Slip& slip : slips_)
  {
    rates.sliding += shape.copies() * slip.force * std::abs(slip.rate - rates.advance);
  }
  return rates;
}
}  // namespace hjt
