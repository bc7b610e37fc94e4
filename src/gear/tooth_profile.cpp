// SPDX-License-Identifier: BSD-3-Clause
#include "gear/tooth_profile.hpp"

#include <cmath>
#include <limits>

#include "gear/flank_shapes.hpp"

namespace hjt
{
namespace
{
constexpr int ENGAGEMENT_INTERVALS = 128;  // of the table, from entry to full engagement
constexpr int BEYOND_INTERVALS = 16;       // and beyond, where a loaded tooth may be pushed
constexpr int SAMPLES = 4;                 // of the flanks per interval of the table

/// Half clearance with the tip at sample `tip` of the space [m].
double clearanceOf(const FlankShapes& flanks, Eigen::Index tip)
{
  const Eigen::Index beside = std::min(tip + 1, flanks.tooth.size());
  double clearance = std::numeric_limits<double>::infinity();
  for (Eigen::Index j = 0; j < beside; ++j)
  {
    clearance = std::min(clearance, flanks.space[tip - j] - flanks.tooth[j]);
  }
  return clearance;
}

/// Second derivatives of the C2 spline through equidistant values, zero at both ends: Thomas' algorithm.
std::vector<double> secondDerivatives(const std::vector<double>& values, double interval)
{
  std::vector<double> bend(values.size(), 0.0);
  std::vector<double> factor(values.size(), 0.0);
  for (std::size_t i = 1; i + 1 < values.size(); ++i)
  {
    const double right = 6.0 * (values[i + 1] - 2.0 * values[i] + values[i - 1]) / (interval * interval);
    const double pivot = 4.0 - factor[i - 1];
    factor[i] = 1.0 / pivot;
    bend[i] = (right - bend[i - 1]) / pivot;
  }
  for (std::size_t i = values.size() - 1; i-- > 1;)
  {
    bend[i] -= factor[i] * bend[i + 1];
  }
  return bend;
}
}  // namespace

ToothProfile::ToothProfile(const MeshParameters& mesh, const GearParameters& gear)
  : clearance_(mesh.flank_clearance)
  , full_engagement_(gear.flexspline_inner_radius + gear.toothMidHeight() + gear.wave_amplitude)
  , slope_(std::tan(mesh.flank_angle))
  , cosine_(std::cos(mesh.flank_angle))
{
  if (mesh.profile == ProfileKind::TRAPEZOID)
  {
    return;
  }
  const FlankShapes flanks(mesh, gear, SAMPLES * ENGAGEMENT_INTERVALS, SAMPLES * BEYOND_INTERVALS);
  interval_ = SAMPLES * flanks.step;
  start_ = full_engagement_ - ENGAGEMENT_INTERVALS * interval_;
  std::vector<double> values;
  for (int m = 0; m <= ENGAGEMENT_INTERVALS + BEYOND_INTERVALS; ++m)
  {
    values.push_back(clearanceOf(flanks, SAMPLES * m));
  }
  const double zero = values[ENGAGEMENT_INTERVALS] - clearance_;
  const std::vector<double> bend = secondDerivatives(values, interval_);
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
  {
    const double rise = (values[i + 1] - values[i]) / interval_ - interval_ * (2.0 * bend[i] + bend[i + 1]) / 6.0;
    cubics_.push_back({ values[i] - zero, rise, 0.5 * bend[i], (bend[i + 1] - bend[i]) / (6.0 * interval_) });
  }
  end_ = interval_ * static_cast<double>(cubics_.size());
  intervals_per_metre_ = 1.0 / interval_;
}

HalfClearance ToothProfile::tabled(double zeta) const noexcept
{
  const Place at = place(zeta);
  const double rise = at.rise();
  return { at.value(), -rise, -(2.0 * at.cubic[2] + 6.0 * at.u * at.cubic[3]), 1.0 / std::sqrt(1.0 + rise * rise) };
}
}  // namespace hjt
