// SPDX-License-Identifier: BSD-3-Clause
#include "statics/flexspline_stress.hpp"

#include <cmath>

#include "gear/angle.hpp"

namespace hjt
{
namespace
{
constexpr double POISSON = 0.3;
}  // namespace

FlexsplineStress::FlexsplineStress(const Parameters& parameters)
  : tension_stiffness_(parameters.ring.tension_stiffness)
  , section_(parameters.life.face_width * parameters.gear.rim_thickness)
{
  const GearParameters& gear = parameters.gear;
  const StressParameters& stress = parameters.stress;
  const double modulus = parameters.life.elastic_modulus;
  const double wall = stress.wall_thickness;
  const double pitch = toothSpace(gear, stress) / (1.0 - stress.tooth_base);
  const double rim_radius = gear.flexspline_inner_radius + 0.5 * gear.rim_thickness;
  const double wall_radius = gear.flexspline_inner_radius + 0.5 * wall;
  const double to_middle = stress.cup_length - 0.5 * parameters.life.face_width;
  const double to_teeth = stress.cup_length - parameters.life.face_width;

  const double by_curvature = 1.0 / pitch;
  const double bulge = rim_radius * rim_radius / 3.0 * by_curvature;  // radial displacement of the rim [m/rad]
  const double fading = std::pow(3.0 * (1.0 - POISSON * POISSON), 0.25) / std::sqrt(wall_radius * wall);
  const double cones = 0.5 * modulus * wall / (1.0 - POISSON) * by_curvature * to_teeth / to_middle;
  const double held = modulus * wall / (1.0 - POISSON * POISSON) * bulge *
                      (fading * fading * (1.0 - to_teeth / to_middle) + fading / to_middle);
  by_turn_ = { 0.5 * modulus * gear.rim_thickness / toothSpace(gear, stress), cones + stress.coning_restraint * held,
               stress.warping_restraint * 0.5 * modulus * bulge * rim_radius / (to_middle * to_middle) };
  shear_by_torque_ = 1.0 / (TWO_PI * wall_radius * wall_radius * wall);
}

double FlexsplineStress::turn(const RingEquilibrium& ring, int i) noexcept
{
  const RingShape& shape = ring.shape();
  const int h = shape.previous(i);
  const double* before = &shape.directions[2 * h];
  const double* behind = &shape.directions[2 * i];
  return smallAngle(before[0] * behind[1] - before[1] * behind[0], before[0] * behind[0] + before[1] * behind[1]) -
         ring.model().rest.pitchAngle() - ring.model().of<RimBending>().naturalAngle()[i];
}

FlexsplineStress::Parts FlexsplineStress::parts(const RingEquilibrium& ring, int i, double turn) const noexcept
{
  const RimTension& tension = ring.model().of<RimTension>();
  // share of a segment's cross section that a crack leaves [-]
  const auto left = [&](int segment) { return tension.stiffness()[segment] / tension_stiffness_; };
  const auto pull = [&](int segment)
  { return left(segment) > 0.0 ? tension.tension(ring.shape(), segment) / (section_ * left(segment)) : 0.0; };
  return { by_turn_[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)] * turn * left(i),
           0.5 * (pull(ring.shape().previous(i)) + pull(i)) };
}

void FlexsplineStress::at(const RingEquilibrium& ring, int shift, ToothStress& stress) const noexcept
{
  const int teeth = ring.shape().teeth();
  for (int i = 0; i < teeth; ++i)
  {
    const double angle = turn(ring, i);
    const Parts rim = parts(ring, i, angle);
    const auto place = static_cast<std::size_t>((i + shift) % teeth);
    stress.normal[static_cast<std::size_t>(StressPlace::TOOTH_SPACE)][place] = rim.bending + rim.tension;
    for (const StressPlace wall : { StressPlace::TRANSITION, StressPlace::FLANGE })
    {
      const auto at = static_cast<std::size_t>(wall);
      stress.normal[at][place] = by_turn_[at] * angle;
    }
  }
  const double shear =
      shear_by_torque_ * std::abs(ring.model().of<CupTorsion>().torque(ring.forces().of<CupTorsion>().rotation));
  stress.shear = { 0.0, shear, shear };
}
}  // namespace hjt
