// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/philox.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/sensors/encoder_readings.hpp"

namespace hjt
{
/// Absolute encoder at the joint's output: the position within one turn, in N counts.
///
/// Law:   n = floor(phi / q) mod N,  q = 2 pi / N
/// where  phi  output angle                      [rad]
///        N    counts per turn                   [-]
///        n    count, 0 ... N - 1                [counts]
///
/// The count does not contain whole turns. A real drive derives the turns from the jumps of the count, and needs at
/// least two readings per turn. This model derives the turns from the true angle.
class AbsoluteEncoder
{
public:
  explicit AbsoluteEncoder(const SensorParameters& parameters)
    : counts_per_turn_(parameters.output_counts_per_turn), quantum_(TWO_PI / static_cast<double>(counts_per_turn_))
  {
  }

  std::uint32_t count(double output_angle) const noexcept
  {
    const std::int64_t in_turn = stepsFromZero(output_angle) % counts_per_turn_;
    return static_cast<std::uint32_t>(in_turn < 0 ? in_turn + counts_per_turn_ : in_turn);
  }

  /// Whole turns of the true angle plus the angle of the count [rad].
  double unwrappedAngle(double output_angle) const noexcept
  {
    return static_cast<double>(stepsFromZero(output_angle)) * quantum_;
  }

private:
  std::int64_t stepsFromZero(double output_angle) const noexcept
  {
    return static_cast<std::int64_t>(std::floor(output_angle / TWO_PI * static_cast<double>(counts_per_turn_)));
  }

  std::int64_t counts_per_turn_;
  double quantum_;  // angle of one count [rad]
};

/// Optical encoder on the motor shaft, which counts in both directions from the angle at reset.
///
/// Law:   n = floor(theta / q),  q = 2 pi / C
/// where  theta  motor angle since reset                                             [rad]
///        C      counts per turn after quadrature: four times the lines of the disc  [-]
///        n      count, since reset                                                  [counts]
class IncrementalEncoder
{
public:
  explicit IncrementalEncoder(const SensorParameters& parameters)
    : counts_per_radian_(parameters.motor_counts_per_turn / TWO_PI), quantum_(TWO_PI / parameters.motor_counts_per_turn)
  {
  }

  std::int64_t count(double motor_angle) const noexcept
  {
    return static_cast<std::int64_t>(std::floor(motor_angle * counts_per_radian_));
  }

  /// Smallest angle that has the count `count` [rad].
  double angle(std::int64_t count) const noexcept { return static_cast<double>(count) * quantum_; }

private:
  double counts_per_radian_;
  double quantum_;  // angle of one count [rad]
};

/// Pairs of independent standard normal numbers. Each number is a function of seed, channel and index. A reading
/// therefore has equal noise live, in a replay, offline, and with any number of threads.
///
/// Source: Philox4x32-10 (Salmon, Moraes, Dror, Shaw: Parallel random numbers, as easy as 1, 2, 3. SC 2011), then the
/// Box-Muller transform.
class CounterNoise
{
public:
  explicit CounterNoise(std::uint32_t seed) : seed_(seed) {}

  /// Two standard normal numbers for the reading `index` of a channel [-].
  std::array<double, 2> normals(std::uint32_t channel, std::int64_t index) const noexcept
  {
    const auto counter = static_cast<std::uint64_t>(index);
    const std::array<std::uint32_t, 4> words = philox(
        { static_cast<std::uint32_t>(counter), static_cast<std::uint32_t>(counter >> 32), 0, 0 }, { seed_, channel });
    const double radius = std::sqrt(-2.0 * std::log(unitInterval(words[0], words[1])));
    const double angle = TWO_PI * unitInterval(words[2], words[3]);
    return { radius * std::cos(angle), radius * std::sin(angle) };
  }

private:
  /// Converts two words to a number in the open interval (0, 1).
  static double unitInterval(std::uint32_t high, std::uint32_t low) noexcept
  {
    constexpr double STEP = 1.0 / 9007199254740992.0;  // 2^-53
    const std::uint64_t word = (std::uint64_t{ high } << 32) | low;
    return (static_cast<double>(word >> 11) + 0.5) * STEP;
  }

  std::uint32_t seed_;
};

/// Sensors of a joint: encoders of motor and output, and the current, from which the drive estimates the torque.
///
/// Law:   a' = a + e sin a + e_2 sin 2 a + e_4 sin 4 a + s n
///                                   angle that an encoder resolves into counts          [rad]
///        T' = T + s_T n, rounded    motor torque estimated from the current             [N.m]
/// where  a, T      true angle, true motor torque                                        [rad], [N.m]
///        e         amplitude of the error of an eccentric disc or magnet, once per turn [rad]
///        e_2, e_4  amplitudes of the errors by an oval disc and by the read head        [rad]
///        s, s_T    rms noise of the angle and of the torque                             [rad], [N.m]
///        n         standard normal number, a function of seed, sensor and step          [-]
/// All readings have the same delay, a whole number of steps. An error with parameter 0 changes no bit of a reading.
///
/// A velocity is the difference quotient of two readings of an angle, as in a drive:
/// Law:   v = (a_k - a_(k-n)) / (n P),  n = sensors.velocity_window / P rounded, at least 1
/// where  a_k  reading of the angle in step k [rad];  P  time between two steps [s];  n  number of steps
/// With fewer than n + 1 readings the difference is over the available readings. With fewer than two readings, and
/// during the delay, the velocity is zero.
///
/// `update` only stores true values. The first read of a step adds the errors. Several threads may read at once.
class JointSensors
{
public:
  /// `period`: time between two updates [s].
  JointSensors(const SensorParameters& parameters, double period)
    : parameters_(parameters)
    , period_(period)
    , noise_(static_cast<std::uint32_t>(parameters.noise_seed))
    , motor_encoder_(parameters)
    , output_encoder_(parameters)
    , delay_(static_cast<std::size_t>(std::lround(parameters.delay / period)))
    , window_(std::max<std::size_t>(1, std::lround(parameters.velocity_window / period)))
    , instants_(delay_ + window_ + 1)
  {
  }

  void reset() noexcept { count_ = 0; }

  /// Stores the values of a step. `step`: number of the instant, a function of its stamp; angles [rad], torque [N.m].
  void update(std::int64_t step, double motor_angle, double output_angle, double motor_torque) noexcept
  {
    newest_ = newest_ + 1 == instants_.size() ? 0 : newest_ + 1;
    Instant& now = instants_[newest_];
    now.step = step;
    now.angles = { motor_angle, output_angle };
    now.motor_torque = motor_torque;
    now.sensed.store(false, std::memory_order_relaxed);
    count_ = std::min(count_ + 1, instants_.size());
  }

  /// Readings of the encoders; requires an update.
  EncoderReadings encoders() const noexcept
  {
    const std::size_t intervals = std::min(window_, count_ - 1 - std::min(delay_, count_ - 1));
    const Angles now = sensed(delay_);
    EncoderReadings readings;
    readings.motor_count = motor_encoder_.count(now.motor);
    readings.motor_angle = motor_encoder_.angle(readings.motor_count);
    readings.output_count = output_encoder_.count(now.output);
    readings.output_angle = output_encoder_.unwrappedAngle(now.output);
    if (intervals > 0)
    {
      const Angles before = sensed(delay_ + intervals);
      const double time = static_cast<double>(intervals) * period_;
      readings.motor_velocity =
          (readings.motor_angle - motor_encoder_.angle(motor_encoder_.count(before.motor))) / time;
      readings.output_velocity = (readings.output_angle - output_encoder_.unwrappedAngle(before.output)) / time;
    }
    return readings;
  }

  /// Torque estimated from the current [N.m]; requires an update.
  double motorTorque() const noexcept
  {
    const Instant& now = instant(delay_);
    double torque = now.motor_torque;
    if (parameters_.torque_noise > 0.0)
    {
      torque += parameters_.torque_noise * noise_.normals(TORQUE, now.step)[0];
    }
    const double resolution = parameters_.torque_resolution;
    return resolution > 0.0 ? resolution * std::round(torque / resolution) : torque;
  }

private:
  enum Channel : std::uint32_t
  {
    ENCODERS,
    TORQUE
  };

  struct Angles
  {
    double motor{};   // [rad]
    double output{};  // [rad]
  };

  struct Instant
  {
    Instant() = default;
    Instant(const Instant& other) noexcept  // without the computed errors, which a reading of the copy computes again
      : step(other.step), angles(other.angles), motor_torque(other.motor_torque)
    {
    }
    Instant& operator=(const Instant&) = delete;

    std::int64_t step{};
    Angles angles;
    double motor_torque{};  // [N.m]
    // Angles with errors, set by the first reading. Concurrent readers store equal values.
    mutable std::atomic<bool> sensed{};
    mutable std::atomic<double> sensed_motor{};   // [rad]
    mutable std::atomic<double> sensed_output{};  // [rad]
  };

  /// The instant `back` steps ago, or the oldest stored instant.
  const Instant& instant(std::size_t back) const noexcept
  {
    const std::size_t kept = std::min(back, count_ - 1);
    return instants_[newest_ >= kept ? newest_ - kept : newest_ + instants_.size() - kept];
  }

  Angles sensed(std::size_t back) const noexcept
  {
    const Instant& at = instant(back);
    if (at.sensed.load(std::memory_order_acquire))
    {
      return { at.sensed_motor.load(std::memory_order_relaxed), at.sensed_output.load(std::memory_order_relaxed) };
    }
    Angles angles = at.angles;
    angles.motor += lines(angles.motor, parameters_.motor_eccentricity, parameters_.motor_lines);
    angles.output += lines(angles.output, parameters_.output_eccentricity, parameters_.output_lines);
    if (parameters_.motor_noise > 0.0 || parameters_.output_noise > 0.0)
    {
      const std::array<double, 2> normals = noise_.normals(ENCODERS, at.step);
      angles.motor += parameters_.motor_noise * normals[0];
      angles.output += parameters_.output_noise * normals[1];
    }
    at.sensed_motor.store(angles.motor, std::memory_order_relaxed);
    at.sensed_output.store(angles.output, std::memory_order_relaxed);
    at.sensed.store(true, std::memory_order_release);
    return angles;
  }

  /// Part of an encoder's error that repeats every turn, with 1, 2 and 4 cycles per turn [rad].
  static double lines(double angle, double eccentricity, const std::array<double, 2>& others) noexcept
  {
    double error = 0.0;
    const auto add = [&](double amplitude, double order)
    {
      if (amplitude != 0.0)
      {
        error += amplitude * std::sin(order * angle);
      }
    };
    add(eccentricity, 1.0);
    add(others[0], 2.0);
    add(others[1], 4.0);
    return error;
  }

  SensorParameters parameters_;
  double period_;  // [s]
  CounterNoise noise_;
  IncrementalEncoder motor_encoder_;
  AbsoluteEncoder output_encoder_;
  std::size_t delay_;              // delay of the readings [steps]
  std::size_t window_;             // window of the velocities [steps]
  std::vector<Instant> instants_;  // ring buffer of the last steps
  std::size_t newest_{};
  std::size_t count_{};  // number of stored instants
};
}  // namespace hjt
