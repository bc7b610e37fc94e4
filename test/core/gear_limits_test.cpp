// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/statics/static_analysis.hpp"
#include "ring_fixture.hpp"
#include "solver/ring_equilibrium.hpp"
#include "statics/static_solver.hpp"
#include "test/core/ring_robustness_support.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
TEST(PairedAtRest, IsEveryToothWithItsNearestSpaceHoweverDeepItStands)
{
  // A circular spline of smaller tip radius stands between the teeth of the flexspline before it is deformed.
  for (const std::string tip : { "31.95e-3", "31.9e-3", "31.8e-3" })
  {
    const Parameters parameters = shippedParameters({ "gear.tip_radius_circular_spline=" + tip });
    const RingModel model(parameters);
    for (const double angle : { 0.0, 0.01, 2.0 })
    {
      const RingShape shape = model.restShape({ 0.0, angle, 0.0 });
      for (int i = 0; i < shape.teeth(); ++i)
      {
        const double space = TWO_PI / parameters.gear.teeth_circular_spline;
        const double off = std::remainder(i * model.rest.pitchAngle() - angle - shape.space[i] * space, TWO_PI);
        ASSERT_LE(std::abs(off), 0.5 * space * (1.0 + 1e-9)) << "tooth " << i << " tip " << tip;
      }
    }
  }
}

TEST(Backlash, IsCrossedByTheStaticAnalysesAtAnyAngle)
{
  // With clearance no tooth touches when the output is free: there is no stiffness to go by until one does.
  const Parameters parameters = shippedParameters({ "mesh.flank_clearance=20.0e-6" });
  for (const double angle : { 0.0, 0.3 })
  {
    const std::vector<StiffnessRow> rows = analyseStiffness(parameters, angle, { 5.0, -5.0, 48.0 });
    ASSERT_TRUE(rows[0].status.ok() && rows[1].status.ok() && rows[2].status.ok()) << angle;
    EXPECT_LT(rows[0].output_angle, -0.3e-3);
    EXPECT_GT(rows[1].output_angle - rows[0].output_angle, 2.0 * 20e-6 / 32e-3);
  }
}

TEST(Overload, MakesTheTeethOfASoftGearJump)
{
  // Flat flanks on a rim that gives way: under the circular spline turned on by three of its pitches the teeth climb
  // out, and find the next space.
  const Parameters parameters = goldenParameters({ "contact.stiffness=1.0e+6", "ring.tension_stiffness=5.0e+7",
                                                   "mesh.flank_angle=1.0", "mesh.engagement_depth=200.0e-6" });
  const double w = parameters.gear.wave_amplitude;
  const double space = TWO_PI / parameters.gear.teeth_circular_spline;
  const RingModel model(parameters);
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, w }).ok());
  const int first = ring.shape().space[0];
  double highest = 0.0;
  double last = 0.0;
  int drops = 0;
  for (int k = 1; k <= 900; ++k)
  {
    // At the instant of the jump there is no equilibrium near; the next step finds one beyond it.
    const bool found = ring.moveTo({ 0.0, -k * 1e-4, w }).ok();
    expectFinite(ring);
    expectEquilibrium(ring, parameters.solver.force_tolerance);
    const double torque = ring.forces().output_torque;
    drops += found && torque < 0.5 * last ? 1 : 0;
    highest = std::max(highest, torque);
    last = torque;
  }
  EXPECT_GT(drops, 0);
  // It holds some torque before it jumps, and less than a tenth of what teeth that never jump would have built up.
  EXPECT_GT(highest, 50.0);
  EXPECT_LT(highest, 0.1 * 31e3 * 0.09);
  EXPECT_GT(ring.shape().space[0], first) << "a tooth stands " << 0.09 / space << " spaces behind";
}
}  // namespace
}  // namespace hjt
