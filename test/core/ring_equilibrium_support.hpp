// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ring_equilibrium.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "model/joint_model.hpp"
#include "ring_fixture.hpp"
#include "test_parameters.hpp"

namespace hjt
{
// The rounding of a coordinate, some 1e-17 m, against 5e9 N/m: forces are not to be had better than to some 1e-7 N.
inline const std::string TIGHT = "solver.force_tolerance=5.0e-7";

// Newton keeps its factors while they serve, so the rates may belong to a shape a little way back; measured 2.5e-4.
constexpr double SENSITIVITY = 1e-3;

/// The shipped ring in equilibrium; positions are given without the wave amplitude, which stays full.
class Ring : public testing::Test
{
protected:
  explicit Ring(const std::vector<std::string>& assignments = { TIGHT })
    : parameters_(goldenParameters(assignments)), model_(parameters_), ring_(model_, parameters_.solver)
  {
    EXPECT_TRUE(ring_.insert(at(0.0, 0.0)).ok());
  }

  DrivePosition at(double wave_generator_angle, double output_angle) const
  {
    return { wave_generator_angle, output_angle, parameters_.gear.wave_amplitude };
  }

  SolveStatus moveTo(double wave_generator_angle, double output_angle)
  {
    return ring_.moveTo(at(wave_generator_angle, output_angle));
  }

  /// At one angle, under loads of both senses.
  void expectSensitivitiesToBeRates(bool refactored)
  {
    for (const double twist : { -0.2e-3, -1e-3, 4e-3 })
    {
      SCOPED_TRACE("twist " + std::to_string(twist));
      const double angle = 0.1234;
      const double output = angle / ratio() + twist;
      ASSERT_TRUE(moveTo(angle - 1e-4, output).ok());
      ASSERT_TRUE(moveTo(angle, output).ok());
      if (refactored)
      {
        model_.edit<RimTension>();  // as it is; but nobody knows that
        ASSERT_TRUE(ring_.updateModel().ok());
      }
      const Eigen::VectorXd by_wave_generator = ring_.byWaveGenerator();
      const Eigen::VectorXd by_output = ring_.byOutput();
      const Eigen::Matrix2d stiffness = ring_.stiffness();
      Eigen::Matrix2d numeric;
      for (const int column : { 0, 1 })
      {
        // So small that no tooth comes into contact or leaves it, so large that the tolerance of the solver, 5e-7 N
        // over 1e5 N/m, is no more than 1e-4 of the way of the points.
        const double step = column == 0 ? 2e-5 : 5e-7;
        const Eigen::Vector2d direction = step * Eigen::Vector2d::Unit(column);
        ASSERT_TRUE(moveTo(angle + direction[0], output + direction[1]).ok());
        const Eigen::VectorXd after = ring_.shape().points;
        const Eigen::Vector2d torque_after(ring_.forces().wave_generator_torque, ring_.forces().output_torque);
        ASSERT_TRUE(moveTo(angle - direction[0], output - direction[1]).ok());
        const Eigen::Vector2d torque_before(ring_.forces().wave_generator_torque, ring_.forces().output_torque);
        const Eigen::VectorXd rate = (after - ring_.shape().points) / (2.0 * step);
        const Eigen::VectorXd& expected = column == 0 ? by_wave_generator : by_output;
        EXPECT_LT((rate - expected).lpNorm<Eigen::Infinity>(), SENSITIVITY * expected.lpNorm<Eigen::Infinity>());
        numeric.col(column) = (torque_before - torque_after) / (2.0 * step);
      }
      EXPECT_NEAR(numeric(1, 1), stiffness(1, 1), SENSITIVITY * stiffness(1, 1));
      EXPECT_NEAR(numeric(0, 1), stiffness(0, 1), SENSITIVITY * std::abs(stiffness(0, 1)));
      EXPECT_NEAR(numeric(1, 0), stiffness(1, 0), SENSITIVITY * std::abs(stiffness(1, 0)));
      // The smallest: some 1 N.m/rad, a difference of terms a hundred times larger.
      EXPECT_NEAR(numeric(0, 0), stiffness(0, 0), SENSITIVITY * std::abs(stiffness(0, 1)));
    }
  }

  double pitch() const { return TWO_PI / parameters_.gear.teeth_flexspline; }
  double ratio() const { return nominalRatio(parameters_.gear); }

  Parameters parameters_;
  RingModel model_;
  RingEquilibrium ring_;
};

/// After one tooth pitch the state is the old one, turned by a pitch and renumbered.
inline void expectShifted(const Eigen::VectorXd& points, const RingForces& forces, const RingEquilibrium& ring,
                          int pitches)
{
  const int n = ring.shape().teeth();
  const Eigen::VectorXd expected = turned(points, pitches * TWO_PI / n);
  for (int i = 0; i < n; ++i)
  {
    const int j = ((i + pitches) % n + n) % n;
    ASSERT_LT((expected.segment<2>(2 * i) - ring.shape().points.segment<2>(2 * j)).norm(), 5e-12) << i;
    ASSERT_NEAR(forces.of<ToothMesh>().flank_force[i], ring.forces().of<ToothMesh>().flank_force[j], 1e-4) << i;
  }
  EXPECT_NEAR(ring.forces().energy, forces.energy, 1e-9 * forces.energy);
  EXPECT_NEAR(ring.forces().output_torque, forces.output_torque, 1e-6 * std::abs(forces.output_torque));
}
}  // namespace hjt
