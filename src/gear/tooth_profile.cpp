// SPDX-License-Identifier: BSD-3-Clause
#include "gear/tooth_profile.hpp"

#include <cmath>
#include <limits>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
double involuteFunction(double angle)
{
  return std::tan(angle) - angle;
}

/// Half thickness of a tooth of an involute gear at a radius [m]. Inside the base circle the flank is radial.
/// `reference`: radius at which the pressure angle holds and tooth and space have equal widths [m].
double involuteHalfWidth(double radius, double reference, double pressure_angle, int teeth)
{
  const double at_radius = std::acos(std::min(1.0, reference * std::cos(pressure_angle) / radius));
  const double half_angle = PI / (2 * teeth) + involuteFunction(pressure_angle) - involuteFunction(at_radius);
  return radius * std::sin(half_angle);
}

/// Flank of a double-arc tooth. `fall`: half thickness at mid-height minus that at the height `y` above it [m].
class DoubleArc
{
public:
  DoubleArc(const MeshParameters& mesh, const GearParameters& gear, const EngagementPath& path)
    : half_tangent_(0.5 * mesh.tangent_length), sine_(std::sin(mesh.tangent_angle))
  {
    const double arc_height = 0.5 * gear.tooth_height_flexspline - half_tangent_;
    const double tip_sine = std::sin(std::atan(path.slope(path.entry())));
    // If the tangent is steeper than the path at entry, or as long as the tooth, the flank is straight, without an arc.
    curvature_ = arc_height > 0.0 ? std::max(0.0, tip_sine - sine_) / arc_height : 0.0;
  }

  double fall(double y) const
  {
    const double straight = std::min(std::abs(y), half_tangent_);
    const double beyond = std::abs(y) - straight;
    const double sine = sine_ + curvature_ * beyond;
    const double cosine = std::sqrt(1.0 - sine * sine);
    const double tangent_cosine = std::sqrt(1.0 - sine_ * sine_);
    const double fall = straight * sine_ / tangent_cosine + beyond * (sine + sine_) / (cosine + tangent_cosine);
    return std::copysign(fall, y);
  }

private:
  double half_tangent_;
  double sine_;
  double curvature_;
};
}  // namespace

EngagementPath::EngagementPath(const GearParameters& gear)
  : amplitude_(gear.wave_amplitude)
  , travel_((gear.flexspline_inner_radius + gear.toothMidHeight()) *
            (gear.teeth_circular_spline - gear.teeth_flexspline) / gear.teeth_circular_spline)
  , entry_(gear.engagementDepth())
{
}

double EngagementPath::tau(double drop) const noexcept
{
  return std::acos(std::clamp(1.0 - drop / amplitude_, -1.0, 1.0));
}

double EngagementPath::across(double drop) const noexcept
{
  const double at = tau(drop);
  return 0.5 * travel_ * (at - std::sin(at));
}

double EngagementPath::slope(double drop) const noexcept
{
  return 0.5 * travel_ / amplitude_ * std::tan(0.5 * tau(drop));
}

FlankShapes::FlankShapes(const MeshParameters& mesh, const GearParameters& gear, int intervals, int beyond)
  : step(EngagementPath(gear).entry() / intervals)
  , tooth(static_cast<Eigen::Index>(gear.tooth_height_flexspline / step) + 1)
  , space(intervals + beyond + 1)
{
  const EngagementPath path(gear);
  const double tip = 0.5 * gear.tooth_height_flexspline;
  const double slope = std::tan(mesh.flank_angle);
  const auto sample = [this](auto&& tooth_at, auto&& space_at)
  {
    for (Eigen::Index j = 0; j < tooth.size(); ++j)
    {
      tooth[j] = tooth_at(step * static_cast<double>(j));
    }
    for (Eigen::Index k = 0; k < space.size(); ++k)
    {
      space[k] = space_at(step * static_cast<double>(k));
    }
  };
  switch (mesh.profile)
  {
    case ProfileKind::TRAPEZOID:
      sample([&](double down) { return down * slope; }, [&](double out) { return -out * slope; });
      break;
    case ProfileKind::INVOLUTE:
    {
      const double reference = gear.flexspline_inner_radius + gear.toothMidHeight();
      const double ratio = static_cast<double>(gear.teeth_circular_spline) / gear.teeth_flexspline;
      sample([&](double down)
             { return involuteHalfWidth(reference + tip - down, reference, mesh.flank_angle, gear.teeth_flexspline); },
             [&](double out)
             {
               return involuteHalfWidth(gear.tip_radius_circular_spline + out, ratio * reference, mesh.flank_angle,
                                        gear.teeth_circular_spline);
             });
      break;
    }
    case ProfileKind::CYCLOID:
      sample([&](double down) { return -0.5 * path.across(std::max(0.0, path.entry() - 2.0 * down)); },
             [&](double out) { return 0.5 * path.across(std::max(0.0, path.entry() - 2.0 * out)); });
      break;
    case ProfileKind::DOUBLE_ARC:
    {
      const DoubleArc arc(mesh, gear, path);
      sample([&](double down) { return -arc.fall(tip - down); },
             [](double) { return -std::numeric_limits<double>::infinity(); });
      // The space is the envelope of the tooth along its path. Where the tip does not reach, it is as wide as the tip.
      space.tail(beyond).setConstant(tooth[0]);
      for (int drop = 0; drop <= intervals; ++drop)
      {
        const double across = path.across(drop * step);
        for (Eigen::Index j = 0; j < tooth.size() && j <= intervals - drop; ++j)
        {
          const Eigen::Index k = intervals - drop - j;
          space[k] = std::max(space[k], tooth[j] + across);
        }
      }
      break;
    }
  }
}

namespace
{
constexpr int ENGAGEMENT_INTERVALS = 128;  // number of intervals of the table from entry to full engagement
constexpr int BEYOND_INTERVALS = 16;       // number of intervals beyond full engagement, where a load can push a tooth
constexpr int SAMPLES = 4;                 // number of samples of the flanks in an interval of the table

/// Half clearance of a tooth whose tip is at the sample `tip` of the space [m].
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

/// Second derivatives of the C2 spline through equidistant values, by Thomas' algorithm. They are zero at both ends.
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
