// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "elements/race_deflection.hpp"
#include "elements/ring_tangent.hpp"
#include "gear/ring_shape.hpp"

namespace hjt
{
/// The balls of the wave generator's bearing under the rim, each at its place.
///
/// Energy:  U = 2/5 K sum_b depth_b^(5/2),   depth_b = <sum_i w_bi z_i - h_b>+
/// where    w_bi  quadratic B-spline of the tooth pitches between ball b and tooth i: the three teeth next to the ball,
///                1/8, 3/4, 1/8 where it is below the middle one; they add up to 1
///          z_i   depth of tooth i inside the wave generator, less the gap between rim and race there [m]
///          h_b   how far ball b drops into a spall or carries nothing, see RaceDeflection             [m]
///          K     Hertz, of one ball [N/m^1.5]
/// The balls move with the wave generator's angle (RaceDeflection): theta enters through w and h too. The race's turn
/// with the rim, some mrad, is left out of their places, so the torque on the cage has its reaction on the housing: it
/// is less than a thousandth of the torque on the wave generator.
class SingleBalls
{
public:
  SingleBalls(double stiffness, int teeth);

  struct Ball
  {
    std::array<int, 3> tooth;      ///< next to it
    std::array<double, 3> weight;  ///< [-]
    std::array<double, 3> rate;    ///< derivative of the weight by the wave generator's angle [1/rad]
    std::array<double, 3> second;  ///< the second one [1/rad^2]
    RaceDeflection::Drop drop;
    double depth;  ///< < 0: it carries nothing [m]
    double force;  ///< [N]
    double slope;  ///< of the force over the depth [N/m]
  };
  struct Scratch
  {
    explicit Scratch(int teeth) : balls(static_cast<std::size_t>(teeth)) {}

    std::vector<Ball> balls;  ///< one per tooth; entries beyond the number of balls have no force
  };

  /// Finds the forces of the balls, and with them those on the teeth; adds the torque on the wave generator by the
  /// motion of the balls along the rim. `depth`: z above. @returns the energy [J].
  double press(const RaceDeflection& bearing, double wave_generator_angle, const Eigen::VectorXd& depth,
               Scratch& scratch, Eigen::VectorXd& force, double& torque) const noexcept;

  /// All of the Hessian but the turn of the normals under the teeth's forces.
  void addTangent(const RaceDeflection& bearing, const RingShape& shape, const Eigen::VectorXd& depth,
                  const Eigen::VectorXd& normal, const Scratch& scratch, RingTangent& tangent) const noexcept;

private:
  double stiffness_;    // [N/m^1.5]
  double tooth_pitch_;  // [rad]
};
}  // namespace hjt
