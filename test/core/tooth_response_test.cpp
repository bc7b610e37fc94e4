// SPDX-License-Identifier: BSD-3-Clause
#include "solver/surface_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "model/joint_model.hpp"
#include "surface/surface_builder.hpp"
#include "test/core/response_surface_support.hpp"
#include "test_parameters.hpp"
#include "twin/tooth_forces.hpp"

namespace hjt
{
namespace
{
using Arrays = std::array<std::vector<double>, ToothResponse::QUANTITIES>;

Arrays arraysFor(int teeth)
{
  Arrays arrays;
  arrays.fill(std::vector<double>(static_cast<std::size_t>(teeth)));
  return arrays;
}

bool read(const ToothResponse& table, double motor_angle, double output_angle, Arrays& arrays)
{
  std::array<double*, ToothResponse::QUANTITIES> out{};
  std::transform(arrays.begin(), arrays.end(), out.begin(), [](std::vector<double>& values) { return values.data(); });
  return table.at(motor_angle, output_angle, out.data());
}

double largest(const std::vector<double>& values)
{
  return std::abs(
      *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

/// Largest and root mean square error of each quantity over random places, over the largest of its kind there but at
/// least `LEAST_TOOTH_FORCE / TOOTH_FORCE_SHARE`; of places in metres.
struct Errors
{
  std::array<double, ToothResponse::QUANTITIES> most{};
  std::array<double, ToothResponse::QUANTITIES> squares{};
};

Errors errorsOf(const Parameters& parameters, const ToothResponse& table, double v_limit, int places)
{
  const JointModel model(parameters);
  RingEquilibrium ring(model.ring, parameters.solver);
  EXPECT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  std::mt19937 random(12);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  Arrays arrays = arraysFor(table.teeth);
  ToothForces exact{ arrays[0], arrays[0], arrays[0], arrays[0], arrays[0], arrays[0] };
  const std::array<const std::vector<double>*, ToothResponse::QUANTITIES> wanted{
    &exact.wave_generator_force, &exact.rim_tension, &exact.bending_force,
    &exact.mesh_force,           &exact.tooth_x,     &exact.tooth_y,
  };
  Errors errors;
  for (int i = 0; i < places; ++i)
  {
    const double motor = 8.0 * part(random);
    const double output = motor / table.ratio + v_limit * std::pow(part(random), 3.0);  // more of them at small loads
    EXPECT_TRUE(ring.reach({ motor, output, parameters.gear.wave_amplitude }).ok());
    fillToothForces(ring, 0, exact);
    EXPECT_TRUE(read(table, motor, output, arrays));
    for (std::size_t quantity = 0; quantity < arrays.size(); ++quantity)
    {
      const bool is_force = quantity < ToothResponse::X;
      const double scale = is_force ? std::max(largest(*wanted[quantity]), LEAST_TOOTH_FORCE / TOOTH_FORCE_SHARE) : 1.0;
      for (std::size_t tooth = 0; tooth < arrays[quantity].size(); ++tooth)
      {
        const double error = std::abs(arrays[quantity][tooth] - (*wanted[quantity])[tooth]) / scale;
        errors.most[quantity] = std::max(errors.most[quantity], error);
        errors.squares[quantity] += error * error / static_cast<double>(arrays[quantity].size()) / places;
      }
    }
  }
  return errors;
}

void expectSmall(const Errors& errors)
{
  for (std::size_t quantity = 0; quantity < ToothResponse::QUANTITIES; ++quantity)
  {
    const bool is_force = quantity < ToothResponse::X;
    // Between lines and between columns the tolerance each; places to a ten-thousandth of the wave.
    EXPECT_LT(errors.most[quantity], is_force ? 2.0 * TOOTH_FORCE_SHARE : 3.5e-8) << quantity;
    EXPECT_LT(std::sqrt(errors.squares[quantity]), is_force ? 0.1 * TOOTH_FORCE_SHARE : 3.5e-9) << quantity;
  }
}

/// Anywhere up to 260 N.m, many turns of the motor both ways.
TEST(ToothResponse, IsTheRingAtRandomPlaces)
{
  const ToothResponse& table = surface().table().teeth;
  ASSERT_FALSE(table.lines.empty());
  EXPECT_EQ(table.stored, 100);
  expectSmall(errorsOf(surfaceParameters(), table, 5e-3, 1000));
}

/// Its halves differ, and so do its mirror images.
TEST(ToothResponse, OfAGearThatIsNotItsMirrorImageIsTheRingToo)
{
  const Parameters parameters = shippedParameters({ "output.load_torque_limit=40.0", "motor.torque_limit=0.39",
                                                    "manufacture.wave_generator_eccentricity=[5.0e-6, 2.0e-6]" });
  const ToothResponse table = buildSurface(parameters, JointModel(parameters), {}).table.teeth;
  ASSERT_FALSE(table.lines.empty());
  expectSmall(errorsOf(parameters, table, 0.9e-3, 200));
}

TEST(ToothResponse, RefusesWhatLiesOutside)
{
  const ToothResponse& table = surface().table().teeth;
  Arrays arrays = arraysFor(table.teeth);
  arrays[0][0] = 7.0;
  for (const double output : { table.lines.back() + 1e-9, table.lines.front() - 1e-9, std::nan("") })
  {
    EXPECT_FALSE(read(table, 0.0, output, arrays));
  }
  EXPECT_FALSE(read(table, std::numeric_limits<double>::infinity(), 0.0, arrays));
  EXPECT_FALSE(read(ToothResponse{}, 0.0, 0.0, arrays));
  EXPECT_EQ(arrays[0][0], 7.0);
}

TEST(ToothResponse, BitsDoNotDependOnTheNumberOfThreads)
{
  const Parameters parameters = shippedParameters({ "output.load_torque_limit=40.0", "motor.torque_limit=0.39" });
  const auto built = [&](unsigned threads)
  { return buildSurface(parameters, JointModel(parameters), {}, MAX_SURFACE_POINTS, threads).table.teeth; };
  const ToothResponse one = built(1);
  const ToothResponse three = built(3);
  EXPECT_EQ(one.lines, three.lines);
  EXPECT_TRUE(one.values == three.values);
}
}  // namespace
}  // namespace hjt
