// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <cstddef>
#include <limits>

#include <gmock/gmock.h>

#include "solver/ring_equilibrium.hpp"
#include "solver/surface_tables.hpp"
#include "statics/static_solver.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"
#include "test/core/response_surface_support.hpp"
#include "twin/tooth_forces.hpp"

namespace hjt
{
namespace
{
TEST(ResponseSurface, TorquesAreMinusTheEnergysDerivatives)
{
  constexpr double STEP = 1e-7;
  SeededRandom random(5);
  for (int i = 0; i < 2000; ++i)
  {
    const double motor = 3.0 * random.uniform();
    const double output = motor / 101.0 + 5e-3 * random.uniform();
    const RingResponse here = at(motor, output);
    const double by_motor = (at(motor + STEP, output).energy - at(motor - STEP, output).energy) / (2.0 * STEP);
    const double by_output = (at(motor, output + STEP).energy - at(motor, output - STEP).energy) / (2.0 * STEP);
    EXPECT_NEAR(here.wave_generator_torque, -by_motor, 2e-6);
    EXPECT_NEAR(here.output_torque, -by_output, 2e-4);
  }
}

TEST(ResponseSurface, HousingStiffnessIsTheTorquesDerivative)
{
  constexpr double STEP = 1e-9;
  const double motor = 0.3;
  const double output = motor / 101.0 + 1.7e-3;
  Eigen::Vector2d stiffness;
  surface().response(placeOn(surface(), motor, output), stiffness);
  const auto housing = [](const RingResponse& r) { return -r.wave_generator_torque - r.output_torque; };
  EXPECT_NEAR(stiffness[1], (housing(at(motor, output + STEP)) - housing(at(motor, output - STEP))) / (2.0 * STEP),
              1e-3 * stiffness[1]);
  const double by_motor =
      (housing(at(motor + 10.0 * STEP, output)) - housing(at(motor - 10.0 * STEP, output))) / (20.0 * STEP);
  EXPECT_NEAR(stiffness[0], by_motor, 1e-3 * std::abs(by_motor));
}

/// The table of the golden gear with these parameters.
SurfaceBuild buildWith(const std::vector<std::string>& assignments, std::size_t max_points = MAX_SURFACE_POINTS)
{
  std::vector<std::string> all{ "solver.scene=auto" };
  all.insert(all.end(), assignments.begin(), assignments.end());
  const Parameters parameters = goldenParameters(all);
  return buildSurface(parameters, JointModel(parameters), {}, max_points);
}

TEST(ResponseSurface, IsNotBuiltBeyondABoundedNumberOfPoints)
{
  constexpr std::size_t MOST = 10000;
  const SurfaceBuild build = buildWith({ "gear.wave_amplitude=2.0e-3" }, MOST);
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("more than 10000 points"));
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("gear.wave_amplitude = 0.002"));
  EXPECT_THAT(build.failure_reason, testing::HasSubstr("motor.torque_limit = 2.87"));
  EXPECT_TRUE(build.table.nodes.empty());
  EXPECT_LT(build.solves, static_cast<int>(MOST));
  EXPECT_EQ(MAX_SURFACE_POINTS, 500000U);
}

/// Nor on which of them does what; a small range is enough.
TEST(ResponseSurface, BitsDoNotDependOnTheNumberOfThreads)
{
  const Parameters parameters = shippedParameters({ "output.load_torque_limit=40.0", "motor.torque_limit=0.39" });
  const auto built = [&](unsigned threads)
  { return buildSurface(parameters, JointModel(parameters), {}, MAX_SURFACE_POINTS, threads).table; };
  const SurfaceTable one = built(1);
  const SurfaceTable three = built(3);
  EXPECT_GT(one.lines.size(), 65U);
  EXPECT_EQ(one.lines, three.lines);
  EXPECT_TRUE(one.nodes == three.nodes);
}

/// A gear that is its own mirror image is measured one way only. This one, with the ellipse off its axis, is not.
TEST(ResponseSurface, OfAGearThatIsNotItsMirrorImageIsMeasuredBothWays)
{
  const std::vector<std::string> narrow{ "output.load_torque_limit=40.0", "motor.torque_limit=0.39" };
  std::vector<std::string> oblique = narrow;
  oblique.emplace_back("manufacture.wave_generator_eccentricity=[5.0e-6, 2.0e-6]");
  std::vector<double> solves_a_node;
  for (const bool mirrored : { true, false })
  {
    const Parameters parameters = shippedParameters(mirrored ? narrow : oblique);
    const JointModel model(parameters);
    EXPECT_EQ(SurfaceRing(parameters, model).isMirrored(), mirrored);
    const SurfaceBuild build = buildSurface(parameters, model, {});
    ASSERT_EQ(build.failure_reason, "");
    solves_a_node.push_back(static_cast<double>(build.solves) / static_cast<double>(build.table.nodes.size()));
    const ResponseSurface table(build.table);
    SurfaceRing ring(parameters, model);
    ASSERT_TRUE(ring.insert());
    for (const double v : { 0.3e-3, -0.3e-3, -0.9e-3 })
    {
      for (int i = 0; i < 20; ++i)
      {
        const double motor = (0.123 + 1.7 * i) * ring.pitch();
        ASSERT_TRUE(ring.moveTo(motor, v));
        const SurfaceNode node = ring.measure();
        const ResponseSurface::Place place = placeOn(table, motor, v + motor / ring.ratio());
        EXPECT_NEAR(table.response(place).output_torque, -node[SurfaceNode::ENERGY_BY_V], 1e-3);
        EXPECT_NEAR(table.response(place).energy, node[SurfaceNode::ENERGY], 1e-7);
        EXPECT_NEAR(ResponseSurface::value(place, SurfaceNode::CONTACT_FORCE), node[SurfaceNode::CONTACT_FORCE], 0.5);
      }
    }
  }
  EXPECT_LT(solves_a_node[0], 0.5 * solves_a_node[1]);
}

TEST(ResponseSurface, NeedsOneTorqueLimit)
{
  EXPECT_EQ(buildWith({ "motor.torque_limit=0.0", "output.load_torque_limit=20.0" }).failure_reason, "");
  EXPECT_THAT(buildWith({ "motor.torque_limit=0.0", "output.load_torque_limit=0.0" }).failure_reason,
              testing::HasSubstr("motor.torque_limit and output.load_torque_limit are 0"));
}

TEST(ResponseSurface, MotorStiffnessIsTheTorquesDerivative)
{
  constexpr double STEP = 1e-7;
  for (const double motor : { 0.3, 1.7, -2.2 })
  {
    for (const double v : { -3.1e-3, 1.7e-3, 4.3e-3 })
    {
      const double output = motor / 101.0 + v;
      const double by_motor =
          (at(motor + STEP, output).wave_generator_torque - at(motor - STEP, output).wave_generator_torque) /
          (2.0 * STEP);
      EXPECT_NEAR(at(motor, output).motor_stiffness, -by_motor, 1e-3 * std::abs(by_motor)) << motor << " " << v;
    }
  }
}

TEST(ResponseSurface, IsTheSameAgainAfterEveryPitch)
{
  const double pitch = TWO_PI / 200;
  for (const double v : { -4e-3, -1e-5, 2e-3 })
  {
    const RingResponse here = at(0.4 * pitch, v + 0.4 * pitch / 101.0);
    const RingResponse later = at(1000.4 * pitch, v + 1000.4 * pitch / 101.0);
    EXPECT_NEAR(here.energy, later.energy, 1e-10);
    EXPECT_NEAR(here.output_torque, later.output_torque, 1e-7);
    EXPECT_NEAR(here.wave_generator_torque, later.wave_generator_torque, 1e-7);
  }
}

TEST(ResponseSurface, SaysWhereItEnds)
{
  ResponseSurface::Place place;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(surface().locate(0.0, surface().highest() * 1.001, place));
  EXPECT_FALSE(surface().locate(0.0, surface().lowest() * 1.001, place));
  EXPECT_FALSE(surface().locate(nan, 0.0, place));
  EXPECT_FALSE(surface().locate(0.0, nan, place));
  EXPECT_FALSE(surface().locate(1e300, 1e300 / 101.0, place));
}

/// How well a table has to agree with the full ring.
struct Bounds
{
  double motor_torque;      // of the rated one [-]
  double stiffness;         // at the motor, beyond 15 %: of the mixed one [-]
  double stiffness_misses;  // places where it may be off by more [-]
};

/// At equal angles: torques within a thousandth of the rated ones, and the angle that the torque's error stands for
/// within a tenth of a second of arc. The bounds are a tenth of that. `farthest`: of the output [rad].
void expectTheFullRing(const Parameters& parameters, const ResponseSurface& table, double farthest, int places,
                       const Bounds& bounds)
{
  const JointModel model(parameters);
  RingEquilibrium ring(model.ring, staticSolver(parameters.solver));
  ASSERT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  SeededRandom random(6);
  double v = 0.0;
  double motor = 0.0;
  int stiffness_misses = 0;
  for (int i = 0; i < places; ++i)
  {
    v = i % 50 == 0 ? farthest * random.uniform() : v + 1e-5 * random.uniform();
    motor += 0.05 * random.uniform();
    ASSERT_TRUE(ring.moveTo({ motor, v + motor / 101.0, parameters.gear.wave_amplitude }).ok());
    const RingResponse response = at(motor, v + motor / 101.0, table);
    const double miss = response.output_torque - ring.forces().output_torque;
    EXPECT_LT(std::abs(miss), 1e-4 * RATED_TORQUE);
    EXPECT_LT(std::abs(miss) / ring.stiffness()(1, 1), 0.01 * ARC_SECOND);
    EXPECT_LT(std::abs(response.wave_generator_torque - ring.forces().wave_generator_torque),
              bounds.motor_torque * RATED_MOTOR_TORQUE);
    EXPECT_NEAR(response.energy, ring.forces().energy, 1e-7);
    const Eigen::Matrix2d& k = ring.stiffness();
    stiffness_misses +=
        std::abs(response.motor_stiffness - k(0, 0)) > 0.15 * k(0, 0) + bounds.stiffness * std::abs(k(0, 1)) ? 1 : 0;
  }
  // A second derivative of a table, and it jumps where teeth begin to touch within an interval: it warns of long steps
  // only.
  EXPECT_LE(stiffness_misses, bounds.stiffness_misses * places);
}

/// On balls the table's own tolerance, 1e-4 of the motor's torque limit, is used up.
TEST(ResponseSurface, AgreesWithTheFullRingAtRandomAngles)
{
  expectTheFullRing(surfaceParameters(), surface(), 5e-3, 3000, { 4e-4, 5e-3, 0.01 });
}

/// Its motor, held fast, would bring 142 N.m, which no table of its gear holds. Up to the gear's momentary peak torque.
TEST(ResponseSurface, OfAWristAgreesWithTheFullRing)
{
  const Parameters parameters = shippedParameters({ "solver.scene=auto" }, { "size_14" });
  const SurfaceBuild build = buildSurface(parameters, JointModel(parameters), {});
  ASSERT_EQ(build.failure_reason, "");
  EXPECT_LT(build.table.nodes.size(), 100'000U);
  const ResponseSurface table(build.table);
  SurfaceRing ring(parameters, JointModel(parameters));
  ASSERT_TRUE(ring.insert());
  const double farthest = 0.4 * table.highest();
  SeededRandom random(8);
  double v = 0.0;
  double motor = 0.0;
  double largest = 0.0;
  for (int i = 0; i < 2000; ++i)
  {
    v = i % 50 == 0 ? farthest * random.uniform() : v + 1e-5 * random.uniform();
    motor += 0.05 * random.uniform();
    ASSERT_TRUE(ring.moveTo(motor, v));
    const SurfaceNode node = ring.measure();
    const RingResponse response = at(motor, v + motor / ring.ratio(), table);
    const double output = response.output_torque + node[SurfaceNode::ENERGY_BY_V];
    const double shaft = response.wave_generator_torque + node[SurfaceNode::ENERGY_BY_U] / ring.pitch() -
                         node[SurfaceNode::ENERGY_BY_V] / ring.ratio();
    largest = std::max(largest, std::abs(node[SurfaceNode::ENERGY_BY_V]));

    // A tenth of a second of arc, a thousandth of the motor's torque limit.
    EXPECT_LT(std::abs(output) / node[SurfaceNode::OUTPUT_STIFFNESS], 0.1 * ARC_SECOND);
    EXPECT_LT(std::abs(shaft), 1e-3 * parameters.motor.torque_limit);
  }
  EXPECT_GT(largest, parameters.life.momentary_peak_torque);
}

/// Of the golden gear; a part of the range is enough here.
TEST(ResponseSurface, AgreesWithTheFullRingOnSprings)
{
  const Parameters parameters = goldenParameters({ "output.load_torque_limit=80.0", "motor.torque_limit=0.79" });
  const SurfaceBuild build = buildSurface(parameters, JointModel(parameters), {});
  ASSERT_EQ(build.failure_reason, "");
  expectTheFullRing(parameters, ResponseSurface(build.table), 1.3e-3, 1000, { 1e-4, 0.0, 0.001 });
}

/// Where a tooth begins to touch, friction jumps by some per cent, between two lines at a place that no table has; what
/// a drive feels is its mean.
TEST(ResponseSurface, FrictionIsThatOfTheFullRing)
{
  constexpr int PLACES = 1500;
  const Parameters parameters = surfaceParameters();
  SurfaceRing ring(parameters, JointModel(parameters));
  ASSERT_TRUE(ring.insert());
  SeededRandom random(7);
  double v = 0.0;
  double motor = 0.0;
  double sum = 0.0;
  double misses = 0.0;
  double squares = 0.0;
  for (int i = 0; i < PLACES; ++i)
  {
    v = i % 50 == 0 ? 4.3e-3 * random.uniform() : v + 1e-5 * random.uniform();
    motor += 0.05 * random.uniform();
    ASSERT_TRUE(ring.moveTo(motor, v));
    const double friction = ring.frictionTorque(ring.measure());
    const ResponseSurface::Place place = placeOn(surface(), motor, v + motor / ring.ratio());
    const double miss = ring.frictionTorque(ResponseSurface::bilinear(place)) - friction;
    sum += friction;
    misses += miss;
    squares += miss * miss;
  }
  EXPECT_LT(std::abs(misses), 2e-4 * sum);
  EXPECT_LT(std::sqrt(squares * PLACES), 3e-3 * sum);
}

TEST(ResponseSurface, IsNotOfSingleBalls)
{
  std::string notice;
  SurfaceSource source = cached();
  source.notice = [&notice](const std::string& text) { notice = text; };
  const Parameters parameters = shippedParameters({ "solver.scene=auto", "contact.support=single_balls" });
  EXPECT_EQ(surfaceWithFaults(parameters, {}, source), nullptr);
  EXPECT_THAT(notice, testing::HasSubstr("single balls"));
}

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
  SeededRandom random(12);
  Arrays arrays = arraysFor(table.teeth);
  ToothForces exact{ arrays[0], arrays[0], arrays[0], arrays[0], arrays[0], arrays[0] };
  const std::array<const std::vector<double>*, ToothResponse::QUANTITIES> wanted{
    &exact.wave_generator_force, &exact.rim_tension, &exact.bending_force,
    &exact.mesh_force,           &exact.tooth_x,     &exact.tooth_y,
  };
  Errors errors;
  for (int i = 0; i < places; ++i)
  {
    const double motor = 8.0 * random.uniform();
    const double output =
        motor / table.ratio + v_limit * std::pow(random.uniform(), 3.0);  // more of them at small loads
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
