// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

#include "base/philox.hpp"
#include "gear/angle.hpp"
#include "sensors/joint_sensors.hpp"
#include "test/support/allocation_count.hpp"
#include "test/support/seeded_random.hpp"

namespace hjt
{
namespace
{
constexpr int COUNTS = 4320;
constexpr int OUTPUT_COUNTS = 1335000;
constexpr double QUANTUM = TWO_PI / COUNTS;
const SensorParameters SENSORS{ COUNTS, OUTPUT_COUNTS, 10e-3 };

/// Encoders that resolve nearly everything on the motor.
SensorParameters fineSensors()
{
  SensorParameters parameters = SENSORS;
  parameters.motor_counts_per_turn = 1 << 30;
  return parameters;
}

// The known answers of the authors' own library (Random123, kat_vectors: philox4x32 10).
TEST(Philox, GivesThePublishedWords)
{
  using Words = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t ONES = 0xffffffff;
  EXPECT_EQ(philox({ 0, 0, 0, 0 }, { 0, 0 }), (Words{ 0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8 }));
  EXPECT_EQ(philox({ ONES, ONES, ONES, ONES }, { ONES, ONES }),
            (Words{ 0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd }));
  EXPECT_EQ(philox({ 0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344 }, { 0xa4093822, 0x299f31d0 }),
            (Words{ 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1 }));
}

TEST(PhiloxStream, GivesTheWordsOfEachCounterFromTheLastToTheFirst)
{
  PhiloxStream stream({ 7, 8, 9 }, { 1, 2 });
  for (std::uint32_t block = 0; block < 3; ++block)
  {
    const std::array<std::uint32_t, 4> words = philox({ 7, 8, 9, block }, { 1, 2 });
    for (std::size_t i = 4; i-- > 0;)
    {
      EXPECT_EQ(stream(), words[i]);
    }
  }
}

TEST(IncrementalEncoder, CountsDownBelowZeroWithoutAGap)
{
  const IncrementalEncoder encoder(SENSORS);
  EXPECT_EQ(encoder.count(0.0), 0);
  for (std::int64_t count = -2 * COUNTS; count < 2 * COUNTS; ++count)
  {
    ASSERT_EQ(encoder.count((static_cast<double>(count) + 0.5) * QUANTUM), count);
  }
  EXPECT_EQ(encoder.count(1e6 * TWO_PI + 0.5 * QUANTUM), 1000000ll * COUNTS);
}

TEST(IncrementalEncoder, AngleIsWithinOneCountBelowTheTrueOne)
{
  SeededRandom random(std::random_device{}());
  const IncrementalEncoder encoder(SENSORS);
  constexpr double ROUNDING = 1e-12;  // of an angle of 1000 rad
  for (int i = 0; i < 10000; ++i)
  {
    const double angle = random.uniform(-1000.0, 1000.0);
    const double behind = angle - encoder.angle(encoder.count(angle));
    ASSERT_GE(behind, -ROUNDING) << angle;
    ASSERT_LE(behind, QUANTUM + ROUNDING) << angle;
  }
}

TEST(AbsoluteEncoder, WrapsEveryTurnInBothDirections)
{
  SensorParameters parameters = SENSORS;
  parameters.output_counts_per_turn = 15;
  const AbsoluteEncoder encoder(parameters);
  for (int turn = -3; turn <= 3; ++turn)
  {
    for (int count = 0; count < 15; ++count)
    {
      const double angle = TWO_PI * (turn + (count + 0.5) / 15.0);
      ASSERT_EQ(encoder.count(angle), static_cast<std::uint32_t>(count)) << "turn " << turn;
      ASSERT_NEAR(encoder.unwrappedAngle(angle), angle - TWO_PI * 0.5 / 15.0, 1e-12) << "turn " << turn;
    }
  }
}

TEST(AbsoluteEncoder, UnwrappedAngleIsRightHoweverSeldomRead)
{
  const AbsoluteEncoder encoder(SENSORS);
  const double quantum = TWO_PI / OUTPUT_COUNTS;
  for (double angle = -100.0; angle < 100.0; angle += 7.3)  // more than a turn between two readings
  {
    const double behind = angle - encoder.unwrappedAngle(angle);
    ASSERT_GE(behind, -1e-12);
    ASSERT_LE(behind, quantum + 1e-12);
    const double turns = (encoder.unwrappedAngle(angle) - encoder.count(angle) * quantum) / TWO_PI;
    ASSERT_NEAR(turns, std::round(turns), 1e-9);
  }
  SensorParameters largest = SENSORS;
  largest.output_counts_per_turn = 1 << 30;
  EXPECT_EQ(AbsoluteEncoder(largest).count(-1e-9), (1u << 30) - 1u);
}

/// Read every millisecond.
struct VelocityReader
{
  explicit VelocityReader(double window) : sensors(parametersOf(window), 1e-3) {}

  static SensorParameters parametersOf(double window)
  {
    SensorParameters parameters = fineSensors();
    parameters.velocity_window = window;
    return parameters;
  }

  double velocityAfter(double angle)
  {
    sensors.update(++step, angle, 0.0, 0.0);
    return sensors.encoders().motor_velocity;
  }

  JointSensors sensors;
  std::int64_t step{};
};
constexpr double VELOCITY_RESOLUTION = 1e-5;  // over a millisecond [rad/s]

TEST(Velocity, IsTheDifferenceOverTheWindow)
{
  VelocityReader reader(10e-3);
  std::vector<double> angles;
  for (int i = 0; i < 40; ++i)
  {
    const double angle = 0.01 * i * i;
    angles.push_back(angle);
    const int oldest = std::max(0, i - 10);
    const double expected = i == 0 ? 0.0 : (angle - angles[oldest]) / ((i - oldest) * 1e-3);
    ASSERT_NEAR(reader.velocityAfter(angle), expected, VELOCITY_RESOLUTION) << "sample " << i;
  }
  VelocityReader brief(1e-6);  // a window shorter than a step
  brief.velocityAfter(0.0);
  brief.velocityAfter(1.0);
  EXPECT_NEAR(brief.velocityAfter(3.0), 2000.0, VELOCITY_RESOLUTION);
}

TEST(Velocity, StartsAgainAfterReset)
{
  VelocityReader reader(10e-3);
  EXPECT_EQ(reader.velocityAfter(1.0), 0.0);
  EXPECT_NEAR(reader.velocityAfter(2.0), 1000.0, VELOCITY_RESOLUTION);
  reader.sensors.reset();
  EXPECT_EQ(reader.velocityAfter(500.0), 0.0);
  EXPECT_NEAR(reader.velocityAfter(500.5), 500.0, VELOCITY_RESOLUTION);
}

constexpr double PERIOD = 1e-4;

/// Readings of sensors that have seen `steps` steps of an even turning.
std::vector<EncoderReadings> turning(const SensorParameters& parameters, int steps)
{
  JointSensors sensors(parameters, PERIOD);
  std::vector<EncoderReadings> readings;
  for (int step = 0; step < steps; ++step)
  {
    sensors.update(step, 0.01 * step, 1e-4 * step, 0.5);
    readings.push_back(sensors.encoders());
  }
  return readings;
}

TEST(JointSensors, AreTheEncodersAloneWithoutErrors)
{
  const IncrementalEncoder motor(SENSORS);
  const AbsoluteEncoder output(SENSORS);
  const std::vector<EncoderReadings> readings = turning(SENSORS, 1000);
  for (int step = 0; step < 1000; ++step)
  {
    ASSERT_EQ(readings[step].motor_count, motor.count(0.01 * step));
    ASSERT_EQ(readings[step].output_angle, output.unwrappedAngle(1e-4 * step));
  }
}

TEST(JointSensors, LagByTheirDelay)
{
  SensorParameters parameters = SENSORS;
  parameters.delay = 7 * PERIOD;
  const std::vector<EncoderReadings> prompt = turning(SENSORS, 1000);
  const std::vector<EncoderReadings> late = turning(parameters, 1000);
  for (int step = 0; step < 1000; ++step)
  {
    const EncoderReadings& expected = prompt[std::max(0, step - 7)];
    ASSERT_EQ(late[step].motor_count, expected.motor_count);
    ASSERT_EQ(late[step].output_count, expected.output_count);
    ASSERT_EQ(late[step].motor_velocity, expected.motor_velocity) << step;
    ASSERT_EQ(late[step].output_velocity, expected.output_velocity) << step;
  }
}

TEST(JointSensors, GiveTheSameToAnyNumberOfReaders)
{
  SensorParameters parameters = fineSensors();
  parameters.motor_noise = 1e-3;
  JointSensors read(parameters, PERIOD);
  JointSensors read_by_one(parameters, PERIOD);
  constexpr int STEPS = 2000;
  std::atomic<int> step{ -1 };  // that may be read
  std::atomic<int> readers{ 0 };
  std::array<std::vector<double>, 2> velocities;
  std::vector<std::thread> threads;
  for (std::vector<double>& found : velocities)
  {
    threads.emplace_back(
        [&]
        {
          for (int i = 0; i < STEPS; ++i)
          {
            while (step < i)
            {
              std::this_thread::yield();
            }
            found.push_back(read.encoders().motor_velocity);
            ++readers;
          }
        });
  }
  std::vector<double> expected;
  for (int i = 0; i < STEPS; ++i)
  {
    read.update(i, 0.01 * i, 1e-4 * i, 0.5);
    read_by_one.update(i, 0.01 * i, 1e-4 * i, 0.5);
    expected.push_back(read_by_one.encoders().motor_velocity);
    step = i;
    while (readers < 2 * (i + 1))
    {
      std::this_thread::yield();
    }
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(velocities[0], expected);
  EXPECT_EQ(velocities[1], expected);
}

TEST(JointSensors, ErrByTheirEccentricityAndTheirLines)
{
  SensorParameters parameters = fineSensors();
  parameters.motor_eccentricity = 1e-3;
  parameters.motor_lines = { 2e-4, -1e-4 };
  const std::vector<EncoderReadings> readings = turning(parameters, 2000);
  constexpr double RESOLUTION = 1e-8;
  for (int step = 0; step < 2000; ++step)
  {
    const double angle = 0.01 * step;
    ASSERT_NEAR(readings[step].motor_angle - angle,
                1e-3 * std::sin(angle) + 2e-4 * std::sin(2.0 * angle) - 1e-4 * std::sin(4.0 * angle), RESOLUTION);
  }
}

TEST(JointSensors, NoiseHasItsSizeAndDependsOnSeedAndStepAlone)
{
  SensorParameters parameters = SENSORS;
  parameters.torque_noise = 0.02;
  constexpr int STEPS = 20000;
  std::vector<double> noise;
  JointSensors sensors(parameters, PERIOD);
  for (int step = 0; step < STEPS; ++step)
  {
    sensors.update(step, 0.0, 0.0, 0.5);
    noise.push_back(sensors.motorTorque() - 0.5);
  }
  double sum = 0.0;
  double squares = 0.0;
  double neighbours = 0.0;
  for (int step = 0; step < STEPS; ++step)
  {
    sum += noise[step];
    squares += noise[step] * noise[step];
    neighbours += step > 0 ? noise[step] * noise[step - 1] : 0.0;
  }
  // Four standard deviations of the estimates themselves.
  EXPECT_NEAR(sum / STEPS, 0.0, 4.0 * 0.02 / std::sqrt(STEPS));
  EXPECT_NEAR(std::sqrt(squares / STEPS), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * STEPS));
  EXPECT_NEAR(neighbours / squares, 0.0, 4.0 / std::sqrt(STEPS));

  JointSensors again(parameters, PERIOD);
  again.update(777, 0.0, 0.0, 0.5);
  EXPECT_EQ(again.motorTorque() - 0.5, noise[777]);
  parameters.noise_seed = 1;
  JointSensors other(parameters, PERIOD);
  other.update(777, 0.0, 0.0, 0.5);
  EXPECT_NE(other.motorTorque() - 0.5, noise[777]);
}

TEST(JointSensors, AllocateNothingAndRoundTheTorque)
{
  SensorParameters parameters = SENSORS;
  parameters.motor_noise = parameters.output_noise = 1e-4;
  parameters.torque_noise = 0.1;
  parameters.torque_resolution = 0.25;
  JointSensors sensors(parameters, PERIOD);
  const std::size_t before = allocationCount();
  for (int step = 0; step < 100; ++step)
  {
    sensors.update(step, 0.0, 0.0, 0.5);
    ASSERT_EQ(sensors.motorTorque(), 0.25 * std::round(sensors.motorTorque() / 0.25));
    ASSERT_NEAR(sensors.encoders().motor_angle, 0.0, 0.01);
  }
  EXPECT_EQ(allocationCount(), before);
}
}  // namespace
}  // namespace hjt
