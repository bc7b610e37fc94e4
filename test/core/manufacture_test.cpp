// SPDX-License-Identifier: BSD-3-Clause
#include <complex>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "element_under_test.hpp"
#include "gear/manufacture_errors.hpp"
#include "random_ring.hpp"
#include "test/core/complaint.hpp"
#include "test/support/temporary_folder.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
using testing::HasSubstr;

/// A table of pitch deviations, removed at the end of the test.
class TableFile
{
public:
  explicit TableFile(const std::string& text) : path_(folder_.write("table.csv", text)) {}

  PitchParameters pitch() const { return { 0.0, 1, path_ }; }

  /// What is said about it as the table of a member with three teeth.
  std::string complaint() const
  {
    return complaintOf([&] { pitchDeviations(pitch(), 3, "some.table"); });
  }

private:
  TemporaryFolder folder_;
  std::string path_;
};

/// sum_i values_i exp(-2 pi j k i / Z) * 2 / Z: for a cosine of order k, its amplitude and phase.
std::complex<double> harmonic(const Eigen::VectorXd& values, int k)
{
  std::complex<double> sum;
  for (Eigen::Index i = 0; i < values.size(); ++i)
  {
    sum += values[i] * std::polar(1.0, -TWO_PI * static_cast<double>(k * i) / static_cast<double>(values.size()));
  }
  return sum * 2.0 / static_cast<double>(values.size());
}

TEST(PitchErrors, PerfectGearHasNone)
{
  const Parameters parameters = shippedParameters();
  const ManufactureErrors errors(parameters.manufacture, parameters.gear);
  EXPECT_EQ(errors.tooth_across, Eigen::VectorXd::Zero(200));
  EXPECT_EQ(errors.tooth_along, Eigen::VectorXd::Zero(200));
  EXPECT_EQ(errors.space_across, Eigen::VectorXd::Zero(202));
  EXPECT_EQ(errors.space_along, Eigen::VectorXd::Zero(202));
}

TEST(PitchErrors, HaveTheirTotalDeviationAndAmplitudesThatFallWithTheOrder)
{
  for (const int teeth : { 200, 202 })
  {
    for (const int seed : { 0, 1, 99999 })
    {
      const Eigen::VectorXd pitch = pitchDeviations({ 8e-6, seed, NO_FILE }, teeth, "");
      EXPECT_NEAR(pitch.maxCoeff() - pitch.minCoeff(), 8e-6, 1e-18);
      EXPECT_NEAR(pitch.sum(), 0.0, 1e-17);
      const double first = std::abs(harmonic(pitch, 1));
      for (const int k : { 2, 3, 7, 50, 99 })
      {
        EXPECT_NEAR(std::abs(harmonic(pitch, k)), first / k, 1e-17) << k;
      }
    }
  }
}

TEST(PitchErrors, AreTheSameOnEveryPlatform)
{
  // The first two numbers of mt19937 with seed 1, as published with the generator (mt19937ar).
  const Eigen::VectorXd pitch = pitchDeviations({ 8e-6, 1, NO_FILE }, 200, "");
  EXPECT_NEAR(std::remainder(std::arg(harmonic(pitch, 1)) - TWO_PI * 1791095845.0 / 4294967296.0, TWO_PI), 0.0, 1e-12);
  EXPECT_NEAR(std::remainder(std::arg(harmonic(pitch, 2)) - TWO_PI * 4282876139.0 / 4294967296.0, TWO_PI), 0.0, 1e-12);
  EXPECT_EQ(pitch, pitchDeviations({ 8e-6, 1, NO_FILE }, 200, ""));
  EXPECT_GT((pitch - pitchDeviations({ 8e-6, 2, NO_FILE }, 200, "")).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(PitchTable, IsTakenAsItIs)
{
  const TableFile file("deviation,tooth\n1.0e-6,0\n-2e-6,1\n1.25e-07,2\n");
  EXPECT_EQ(pitchDeviations(file.pitch(), 3, ""), Eigen::Vector3d(1e-6, -2e-6, 1.25e-7));
}

TEST(PitchTable, WhatIsWrongIsNamedWithItsLine)
{
  EXPECT_THAT(TableFile("tooth,deviation\n0,0.0\n1,0.0\n").complaint(), HasSubstr("csv:3: 2 teeth instead of 3"));
  EXPECT_THAT(TableFile("tooth,deviation\n0,0.0\n2,0.0\n1,0.0\n").complaint(),
              HasSubstr("csv:3: column 'tooth' must count from 0 to 2"));
  EXPECT_THAT(TableFile("tooth,deviation\n0,0\n1,0\n2,0\n3,0\n").complaint(), HasSubstr("csv:5: column 'tooth'"));
  EXPECT_THAT(TableFile("tooth,deviation\n0,1e-3\n").complaint(),
              HasSubstr("csv:2: column 'deviation' = 0.001 [m] is out of range, allowed: -0.0001 ... 0.0001 [m]"));
  EXPECT_THAT(TableFile("tooth,deviation\n0,wide\n").complaint(), HasSubstr("'wide' is not a finite number"));
  EXPECT_THAT(TableFile("tooth,error\n0,0.0\n").complaint(), HasSubstr("csv:1: column 'deviation' is missing"));
  EXPECT_THAT(TableFile("tooth,deviation\n0\n").complaint(), HasSubstr("some.table: "));
  PitchParameters missing;
  missing.table = "/nowhere.csv";
  EXPECT_THROW(pitchDeviations(missing, 3, ""), ParameterError);
}

TEST(Eccentricity, MovesAllTeethOrSpacesByOneVector)
{
  for (const std::string member : { "flexspline", "circular_spline" })
  {
    const Parameters parameters = shippedParameters({ "manufacture." + member + "_eccentricity=[3.0e-6, -2.0e-6]" });
    const ManufactureErrors errors(parameters.manufacture, parameters.gear);
    const Eigen::VectorXd& along = member == "flexspline" ? errors.tooth_along : errors.space_along;
    const Eigen::VectorXd& across = member == "flexspline" ? errors.tooth_across : errors.space_across;
    ASSERT_EQ(along.size(), member == "flexspline" ? 200 : 202);
    for (Eigen::Index k = 0; k < along.size(); ++k)
    {
      const Eigen::Rotation2Dd turn(TWO_PI * static_cast<double>(k) / static_cast<double>(along.size()));
      const Eigen::Vector2d moved = turn * Eigen::Vector2d(along[k], across[k]);
      EXPECT_NEAR((moved - Eigen::Vector2d(3e-6, -2e-6)).norm(), 0.0, 1e-20) << member;
    }
  }
}

TEST(CircularSpline, EllipticityBendsWithoutStretch)
{
  const Parameters parameters = shippedParameters({ "manufacture.circular_spline_ellipticity=[3.0e-6, -2.0e-6]" });
  const ManufactureErrors errors(parameters.manufacture, parameters.gear);
  const double step = TWO_PI / 202;
  // The farthest space stands half a space from the longest radius at most.
  EXPECT_NEAR(errors.space_along.maxCoeff(), std::hypot(3e-6, 2e-6), 0.5 * step * step * 3.7e-6);
  for (int k = 0; k < 202; ++k)
  {
    // A ring keeps its length where the slope of the displacement along it makes up for that outwards. The difference
    // of neighbours is off by (2 step)^2 / 6.
    const double slope = (errors.space_across[(k + 1) % 202] - errors.space_across[(k + 201) % 202]) / (2.0 * step);
    EXPECT_NEAR(slope + errors.space_along[k], 0.0, 1e-3 * 3.7e-6);
  }
}

/// Every kind of error at once, several times what a good gear has.
std::vector<std::string> allErrors()
{
  return { "manufacture.flexspline_pitch_deviation=20.0e-6", "manufacture.circular_spline_pitch_deviation=30.0e-6",
           "manufacture.flexspline_eccentricity=[-8.0e-6, 6.0e-6]",
           "manufacture.circular_spline_eccentricity=[10.0e-6, 5.0e-6]",
           "manufacture.circular_spline_ellipticity=[-4.0e-6, 6.0e-6]",
           "manufacture.wave_generator_eccentricity=[20.0e-6, -10.0e-6]",
           "manufacture.wave_generator_ellipticity=5.0e-6",
           // C1 ramps, so that no difference straddles a kink.
           "mesh.smoothing=20.0e-6", "contact.smoothing=20.0e-6" };
}

class FaultyGear : public testing::Test
{
protected:
  Parameters parameters_ = shippedParameters(allErrors());
  RingModel model_{ parameters_ };
  PlacedRing placed_{ RingShape(model_.rest.teeth()), {} };
  RingShape& shape_ = placed_.shape;
  DrivePosition& position_ = placed_.position;
};

TEST_F(FaultyGear, ContactsAreTheGradientsOfTheirEnergies)
{
  RandomRing ring(30);
  int meshed = 0;
  for (int k = 0; k < 8; ++k)
  {
    SCOPED_TRACE("shape " + std::to_string(k));
    placed_ = ring.draw(model_);
    const RingForces forces = elementOf<ToothMesh>(model_).forces(shape_, position_);
    meshed +=
        static_cast<int>(std::count(forces.of<ToothMesh>().meshed.begin(), forces.of<ToothMesh>().meshed.end(), 1));
    expectGradientAndTangent(elementOf<ToothMesh>(model_), shape_, position_);
    expectGradientAndTangent(elementOf<WaveGeneratorContact>(model_), shape_, position_);
  }
  EXPECT_GT(meshed, 100);
}

TEST_F(FaultyGear, EccentricMemberIsTheCentredOneMoved)
{
  const auto with = [](const std::string& assignment) { return RingModel(shippedParameters({ assignment })); };
  const RingModel perfect(shippedParameters());
  const RingModel spline = with("manufacture.circular_spline_eccentricity=[10.0e-6, -6.0e-6]");
  const RingModel generator = with("manufacture.wave_generator_eccentricity=[10.0e-6, -6.0e-6]");
  const auto moved_back = [&](double angle)
  {
    RingShape moved = shape_;
    for (int i = 0; i < shape_.teeth(); ++i)
    {
      moved.points.segment<2>(2 * i) -=
          Eigen::Rotation2D<double>(angle).toRotationMatrix() * Eigen::Vector2d(10e-6, -6e-6);
    }
    moved.updateGeometry();
    return moved;
  };
  RandomRing ring(31);
  for (int k = 0; k < 20; ++k)
  {
    placed_ = ring.draw(perfect);
    for (const auto& [faulty, centred, angle] :
         { std::make_tuple(elementOf<ToothMesh>(spline), elementOf<ToothMesh>(perfect), position_.output_angle),
           std::make_tuple(elementOf<WaveGeneratorContact>(generator), elementOf<WaveGeneratorContact>(perfect),
                           position_.wave_generator_angle) })
    {
      const RingForces forces = faulty.forces(shape_, position_);
      const RingForces expected = centred.forces(moved_back(angle), position_);
      // Rounding of the coordinates, 4e-18 m, against depths of 1e-6 ... 1e-4 m.
      EXPECT_NEAR(forces.energy, expected.energy, 1e-9 * expected.energy);
      EXPECT_LT(relativeError(forces.teeth, expected.teeth), 1e-9);
    }
  }
}

TEST_F(FaultyGear, EllipticityOfTheWaveGeneratorAddsToItsAmplitude)
{
  const RingModel perfect(shippedParameters());
  const RingModel faulty(shippedParameters({ "manufacture.wave_generator_ellipticity=-5.0e-6" }));
  RandomRing ring(32);
  placed_ = ring.draw(perfect);
  const RingForces forces = elementOf<WaveGeneratorContact>(faulty).forces(shape_, position_);
  position_.wave_amplitude -= 5e-6;
  EXPECT_NEAR(forces.energy, elementOf<WaveGeneratorContact>(perfect).forces(shape_, position_).energy,
              1e-12 * forces.energy);
}

/// Output angle at which the flexspline carries `load`, for each wave generator angle [rad].
std::vector<double> outputAngles(const Parameters& parameters, double load, const std::vector<double>& angles)
{
  const RingModel model(parameters);
  SolverParameters solver = parameters.solver;
  solver.force_tolerance = 1e-6;
  RingEquilibrium ring(model, solver);
  EXPECT_TRUE(ring.insert({ 0.0, 0.0, parameters.gear.wave_amplitude }).ok());
  std::vector<double> outputs;
  for (const double angle : angles)
  {
    EXPECT_TRUE(balanceOutput(ring, angle, load).ok());
    outputs.push_back(ring.position().output_angle);
  }
  return outputs;
}

TEST(WholeRing, AnErrorCommonToAllTeethTurnsTheOutput)
{
  std::string text = "tooth,deviation\n";
  for (int i = 0; i < 200; ++i)
  {
    text += std::to_string(i) + ",3.0e-6\n";
  }
  const TableFile file(text);
  const std::vector<double> angles{ 0.0, 0.01, 0.3, 1.0, 2.5 };
  const std::vector<double> perfect = outputAngles(shippedParameters(), 20.0, angles);
  const std::vector<double> moved =
      outputAngles(shippedParameters({ "manufacture.flexspline_pitch_table=" + file.pitch().table }), 20.0, angles);
  const double mid_height = 31.7e-3 + 0.35e-3;  // radius of the teeth's mid-height at the major axis [m]
  for (std::size_t i = 0; i < angles.size(); ++i)
  {
    // The teeth in mesh lie between 31.7 and 32.05 mm from the axis.
    EXPECT_NEAR(moved[i] - perfect[i], 3e-6 / mid_height, 0.01 * 3e-6 / mid_height);
    EXPECT_NEAR(moved[i] - perfect[i], moved[0] - perfect[0], 2e-3 * 3e-6 / mid_height);
  }
}

TEST(WholeRing, TorquesAreTheWorkOverAnyPath)
{
  std::vector<std::string> assignments = allErrors();
  assignments.emplace_back("solver.force_tolerance=1.0e-6");
  InsertedRing inserted(shippedParameters(assignments));
  RingEquilibrium& ring = inserted.ring;
  // A loop of the two angles over some tooth pitches, under load on either flank.
  constexpr int STEPS = 2000;
  const auto place = [&](int step)
  {
    const double a = TWO_PI * step / STEPS;
    const double motor = 0.2 * (1.0 - std::cos(a));
    return DrivePosition{ motor, motor / 101.0 + 1e-3 * std::sin(a), inserted.amplitude };
  };
  ASSERT_TRUE(ring.moveTo(place(0)).ok());
  const double start = ring.forces().energy;
  double work = 0.0;
  double largest = 0.0;
  double through = 0.0;
  for (int i = 1; i <= STEPS; ++i)
  {
    const DrivePosition from = ring.position();
    const double motor = ring.forces().wave_generator_torque;
    const double output = ring.forces().output_torque;
    ASSERT_TRUE(ring.moveTo(place(i)).ok());
    const double step = 0.5 * (motor + ring.forces().wave_generator_torque) *
                            (place(i).wave_generator_angle - from.wave_generator_angle) +
                        0.5 * (output + ring.forces().output_torque) * (place(i).output_angle - from.output_angle);
    work += step;
    through += std::abs(step);
    largest = std::max(largest, std::abs(start - work - ring.forces().energy));
  }
  // The trapezoidal rule over steps of a fiftieth of a tooth pitch.
  EXPECT_LT(largest, 1e-4 * through);
  EXPECT_NEAR(ring.forces().energy, start, 1e-9 * start);
}

TEST(WholeRing, GearAsBuiltConvergesInFewIterations)
{
  InsertedRing inserted(shippedParameters({}, { "as_built" }));
  // As at full speed: a tooth pitch a step, under load.
  constexpr int STEPS = 400;
  int iterations = 0;
  int cuts = 0;
  for (int i = 1; i <= STEPS; ++i)
  {
    const double angle = i * inserted.model.rest.pitchAngle();
    const SolveStatus status = inserted.moveTo(angle, angle / 101.0 - 1e-3);
    ASSERT_TRUE(status.ok());
    cuts += status.cuts;
    iterations += status.iterations;
  }
  EXPECT_LT(iterations, 5 * STEPS);
  EXPECT_LE(cuts, STEPS / 100);
}
}  // namespace
}  // namespace hjt
