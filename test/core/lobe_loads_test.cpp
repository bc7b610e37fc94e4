// SPDX-License-Identifier: BSD-3-Clause
#include "health/health_monitor.hpp"

#include <gtest/gtest.h>

#include "gear/angle.hpp"
#include "model/lobe_loads.hpp"
#include "test/core/health_monitor_support.hpp"
#include "test/support/allocation_count.hpp"

namespace hjt
{
namespace
{
TEST(LobeLoads, SharesTeethByTheirLobe)
{
  const int teeth = 8;
  Eigen::VectorXd angle(teeth);
  for (int i = 0; i < teeth; ++i)
  {
    angle[i] = TWO_PI * i / teeth + 0.01;
  }
  Eigen::VectorXd mesh(teeth);
  mesh << 10.0, -20.0, 0.0, 0.0, 5.0, 0.0, -1.0, 0.0;
  const Eigen::VectorXd wave_generator = Eigen::VectorXd::Constant(teeth, 4.0);
  const LobeLoads loads = lobeLoads({ mesh, wave_generator, angle, 0.0 });
  EXPECT_EQ(loads.teeth_loaded, 4);
  EXPECT_DOUBLE_EQ(loads.mesh_force[0], 31.0);
  EXPECT_DOUBLE_EQ(loads.mesh_force[1], 5.0);
  EXPECT_DOUBLE_EQ(loads.asymmetry, 26.0 / 36.0);
  EXPECT_DOUBLE_EQ(loads.wave_generator_force, 32.0);

  // Half a turn on, the lobes have changed places; after many turns they are where they were.
  EXPECT_DOUBLE_EQ(lobeLoads({ mesh, wave_generator, angle, PI }).mesh_force[0], 5.0);
  EXPECT_DOUBLE_EQ(lobeLoads({ mesh, wave_generator, angle, -50 * TWO_PI }).mesh_force[0], 31.0);
}

TEST(LobeLoads, AreEvenWithoutLoad)
{
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(10);
  const LobeLoads loads = lobeLoads({ none, none, none, 1.0 });
  EXPECT_EQ(loads.teeth_loaded, 0);
  EXPECT_EQ(loads.asymmetry, 0.0);
}
}  // namespace
}  // namespace hjt
