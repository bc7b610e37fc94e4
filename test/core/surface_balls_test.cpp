// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "model/faults/joint_faults.hpp"
#include "model/joint_model.hpp"
#include "surface/faulty_surface.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"
#include "test/core/response_surface_support.hpp"

namespace hjt
{
namespace
{
/// The gear with faults, and its surface.
struct FaultyGear
{
  explicit FaultyGear(const std::vector<std::string>& texts)
  {
    for (const std::string& text : texts)
    {
      faults.set(parseFault(text, parameters), 0);
    }
    model = JointFaults(parameters, faults).model();
    surface = surfaceWithFaults(parameters, faults, cached());
  }
  RingResponse at(double motor_angle, double output_angle) const
  {
    ResponseSurface::Place place;
    EXPECT_TRUE(surface->locate(motor_angle, output_angle, place));
    return surface->response(place);
  }

  Parameters parameters{ surfaceParameters() };
  FaultList faults;
  JointModel model{ parameters };
  SurfacePool::Surface surface;
};

TEST(SurfaceBalls, TorquesAndStiffnessAreTheEnergysDerivatives)
{
  constexpr double STEP = 1e-7;
  for (const char* fault : { "bearing_ball:1:4", "bearing_cage:0.6:3" })
  {
    const FaultyGear gear({ fault });
    ASSERT_TRUE(gear.surface);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i)
    {
      const double motor = 10.0 * part(random);
      const double output = motor / 101.0 + 5e-3 * part(random);
      const RingResponse here = gear.at(motor, output);
      const RingResponse before = gear.at(motor - STEP, output);
      const RingResponse after = gear.at(motor + STEP, output);
      const double by_output =
          (gear.at(motor, output + STEP).energy - gear.at(motor, output - STEP).energy) / (2.0 * STEP);
      EXPECT_NEAR(here.wave_generator_torque, -(after.energy - before.energy) / (2.0 * STEP), 2e-6);
      EXPECT_NEAR(here.output_torque, -by_output, 2e-4);
    }
    // Within a cell; at its edges the tables' curvature jumps.
    for (const double motor : { 0.31, 1.71, 4.07 })
    {
      const double output = motor / 101.0 + 1.234e-3;
      const auto torque = [&](double angle) { return gear.at(angle, output).wave_generator_torque; };
      const double stiffness = gear.at(motor, output).motor_stiffness;
      EXPECT_NEAR(stiffness, (torque(motor - STEP) - torque(motor + STEP)) / (2.0 * STEP), 1e-4 * std::abs(stiffness));
    }
  }
}

/// A fault, and how much of what it changes its surface may miss, root mean square.
struct FeltFault
{
  const char* name;
  std::string fault;
  double stride;               // of the motor, mostly where it is felt [tooth pitches]
  double output_miss;          // [-]
  double wave_generator_miss;  // [-]
};

class SurfaceOfAFault : public testing::TestWithParam<FeltFault>
{
};
INSTANTIATE_TEST_SUITE_P(All, SurfaceOfAFault,
                         testing::Values(FeltFault{ "tooth", BROKEN_TOOTH, 0.6, 0.01, 0.02 },
                                         FeltFault{ "inner", "bearing_inner_race:0.7:10", 1.0, 0.08, 0.05 },
                                         FeltFault{ "outer", "bearing_outer_race:1:17", 1.0, 0.08, 0.05 },
                                         FeltFault{ "ball", "bearing_ball:0.4:4", 1.0, 0.08, 0.05 },
                                         FeltFault{ "cage", "bearing_cage:1:3", 1.0, 0.08, 0.05 }),
                         [](const auto& row) { return std::string(row.param.name); });

TEST_P(SurfaceOfAFault, IsFeltAsOnTheFullRing)
{
  const FeltFault& felt = GetParam();
  const FaultyGear without({});
  const FaultyGear with({ felt.fault });
  ASSERT_TRUE(without.surface && with.surface);
  SurfaceRing ring_without(without.parameters, without.model);
  SurfaceRing ring_with(with.parameters, with.model);
  const RaceDeflection& bearing = with.model.ring.of<WaveGeneratorContact>().bearing();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (const double load : { -100.0, -20.0, 20.0, 100.0 })
  {
    ASSERT_TRUE(ring_without.insert() && ring_with.insert());
    Eigen::Array2d squares = Eigen::Array2d::Zero();
    Eigen::Array2d miss_squares = Eigen::Array2d::Zero();
    double motor = 0.0;
    for (int i = 0; i < 400; ++i)
    {
      motor += felt.stride * ring_with.pitch() * part(random);
      const double v = ring_with.twist(load) * (0.9 + 0.1 * part(random));
      ASSERT_TRUE(ring_without.moveTo(motor, v) && ring_with.moveTo(motor, v));
      const RingResponse sound = without.at(motor, v + motor / 101.0);
      const RingResponse faulty = with.at(motor, v + motor / 101.0);
      const Eigen::Array2d tabled(faulty.output_torque - sound.output_torque,
                                  faulty.wave_generator_torque - sound.wave_generator_torque);
      bool dropped = felt.fault == BROKEN_TOOTH;
      for (int ball = 0; ball < bearing.balls(); ++ball)
      {
        dropped = dropped || bearing.drop(ball, motor).value > 0.0;
      }
      if (!dropped)
      {
        EXPECT_TRUE((tabled == 0.0).all());
        continue;
      }
      const SurfaceNode sound_node = ring_without.measure();
      const SurfaceNode faulty_node = ring_with.measure();
      const double by_v = faulty_node[SurfaceNode::ENERGY_BY_V] - sound_node[SurfaceNode::ENERGY_BY_V];
      const double by_u = faulty_node[SurfaceNode::ENERGY_BY_U] - sound_node[SurfaceNode::ENERGY_BY_U];
      const Eigen::Array2d effect(-by_v, by_v / 101.0 - by_u / ring_with.pitch());
      squares += effect.square();
      miss_squares += (tabled - effect).square();
    }
    EXPECT_GT(squares[0], 0.0);
    EXPECT_LT(std::sqrt(miss_squares[0] / squares[0]), felt.output_miss) << load;
    EXPECT_LT(std::sqrt(miss_squares[1] / squares[1]), felt.wave_generator_miss) << load;
  }
}

TEST(SurfaceBalls, BitsDoNotDependOnTheNumberOfThreads)
{
  const Parameters parameters = surfaceParameters();
  const SurfacePool::Surface surface_of_balls = sharedBallSurface(parameters, JointModel(parameters), "", cached());
  ASSERT_TRUE(surface_of_balls);
  const std::shared_ptr<const BallTable>& kept = surface_of_balls->balls()->table();
  const BallTable one =
      buildBallTable(parameters, JointModel(parameters), kept->deepest, surface().lowest(), surface().highest(), {}, 1)
          .table;
  ASSERT_EQ(one.coefficients.size(), kept->coefficients.size());
  for (std::size_t i = 0; i < one.coefficients.size(); ++i)
  {
    ASSERT_TRUE((one.coefficients[i] == kept->coefficients[i]).all()) << i;
  }
}

/// Of the twins of one process, those whose balls may drop by another depth have another table.
TEST(SurfaceBalls, ArePooledByTheirDepth)
{
  Parameters parameters = surfaceParameters();
  SurfaceSource source = cached();
  source.pool = std::make_shared<SurfacePool>(2);
  const SurfacePool::Surface first = sharedBallSurface(parameters, JointModel(parameters), "", source);
  ASSERT_TRUE(first);
  EXPECT_EQ(sharedBallSurface(parameters, JointModel(parameters), "", source), first);
  EXPECT_EQ(first->balls()->table()->deepest, parameters.fault_scale.cage_deflection);
  parameters.fault_scale.cage_deflection *= 1.1;
  source.progress = [](double) { throw std::runtime_error("a table is built"); };
  EXPECT_THROW(sharedBallSurface(parameters, JointModel(parameters), "", source), std::runtime_error);
}

TEST(SurfaceBalls, AreNotThereForSeveralFaultsOrUnequalTeeth)
{
  const Parameters parameters = surfaceParameters();
  std::string notice;
  SurfaceSource source = cached();
  source.notice = [&](const std::string& what) { notice = what; };
  FaultList faults;
  faults.set(parseFault("bearing_cage:1:3", parameters), 0);
  faults.set(parseFault("bearing_ball:1:4", parameters), 0);
  EXPECT_EQ(surfaceWithFaults(parameters, faults, source), nullptr);
  EXPECT_THAT(notice, testing::HasSubstr("more than one fault of the bearing"));
  faults.set(parseFault("bearing_ball:0:4", parameters), 0);
  EXPECT_NE(surfaceWithFaults(parameters, faults, source), nullptr);
  faults.set(parseFault("flexspline_crack:1:40", parameters), 0);
  EXPECT_EQ(surfaceWithFaults(parameters, faults, source), nullptr);
  EXPECT_THAT(notice, testing::HasSubstr("teeth differ"));
}
}  // namespace
}  // namespace hjt
