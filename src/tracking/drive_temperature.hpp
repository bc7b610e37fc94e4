// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "elements/drive_heat.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Keeps values, and for each value the time from which on it holds, for rows that arrive later. Nothing allocates.
class HeldValues
{
public:
  static constexpr std::size_t ROOM = 512;  ///< number of values that are kept

  void push(double time, double value) noexcept
  {
    values_[end_ % ROOM] = { time, value };
    ++end_;
  }

  /// The last value from `time` [s] or earlier that is at most `max_age` [s] old at `time`; none: there is no such
  /// value.
  std::optional<double> at(double time, double max_age = std::numeric_limits<double>::infinity()) const noexcept
  {
    for (std::uint64_t i = end_; i > begin_ && end_ - i < ROOM; --i)
    {
      const ValueAt& held = values_[(i - 1) % ROOM];
      if (held.time <= time)
      {
        return time - held.time <= max_age ? std::make_optional(held.value) : std::nullopt;
      }
    }
    return std::nullopt;
  }

  void clear() noexcept { begin_ = end_; }

  void mark() noexcept { marked_ = end_; }  ///< marks all values so far as values for rows that have arrived

  /// Call this function when the time of the rows jumps back. Forgets the values up to the mark, and those after it up
  /// to the first value before `earliest` [s]. This value and later ones belong to rows to come.
  void jumpBack(double earliest) noexcept
  {
    begin_ = std::max({ begin_, marked_, end_ > ROOM ? end_ - ROOM : 0 });
    while (begin_ < end_ && values_[begin_ % ROOM].time >= earliest)
    {
      ++begin_;
    }
  }

private:
  struct ValueAt
  {
    double time;
    double value;
  };

  std::array<ValueAt, ROOM> values_{};
  std::uint64_t begin_{};
  std::uint64_t marked_{};
  std::uint64_t end_{};
};

/// Received temperatures of one drive. The class counts and ignores impossible temperatures. Nothing allocates.
class TemperatureRecord
{
public:
  /// Age up to which a temperature is used [s]. The joints of a UR warm up with a time constant of 1600 s or more. So
  /// in 60 s a joint warms up by at most 4 % of the whole rise, which is 1 K or less.
  static constexpr double MAX_AGE = 60.0;
  static constexpr double LOWEST = -20.0;   ///< lowest possible temperature [degC]
  static constexpr double HIGHEST = 120.0;  ///< highest possible temperature [degC]

  static bool isPossible(double temperature) noexcept { return temperature >= LOWEST && temperature <= HIGHEST; }

  /// Keeps a temperature [degC] measured at `time` [s]. Refuses impossible temperatures and numbers that are not
  /// finite.
  void push(double time, double temperature) noexcept
  {
    if (std::isfinite(time) && isPossible(temperature))
    {
      values_.push(time, temperature);
    }
    else
    {
      ++refused_;
    }
  }

  /// The latest temperature that is not later than `time` and not older than MAX_AGE [degC]; NaN: there is none.
  double at(double time) const noexcept
  {
    return values_.at(time, MAX_AGE).value_or(std::numeric_limits<double>::quiet_NaN());
  }

  void clear() noexcept { values_.clear(); }
  void mark() noexcept { values_.mark(); }                                 ///< as HeldValues::mark()
  void jumpBack(double earliest) noexcept { values_.jumpBack(earliest); }  ///< as HeldValues::jumpBack()

  std::uint64_t refused() const noexcept { return refused_; }

private:
  HeldValues values_;
  std::uint64_t refused_{};
};

/// Temperature of the grease of a measured joint, computed from the losses in the joint's motion.
///
/// With thermal.model = none the grease has the temperature of the sample, or the configured temperature if the sample
/// has none. With two_nodes a measured temperature is that of the housing near the motor, and the grease is warmer than
/// the housing. Without a measured temperature, grease and housing warm up from input.temperature. During a gap the
/// joint is assumed to stand. Nothing allocates.
class GreaseTemperature
{
public:
  explicit GreaseTemperature(const Parameters& parameters)
    : heat_(parameters.thermal)
    , housing_rise_(parameters.thermal.housing_rise)
    , copper_loss_(parameters.motor.copper_loss)
    , configured_(parameters.input.temperature)
    , on_(parameters.thermal.model == ThermalModel::TWO_NODES)
  {
  }

  /// Temperature of the grease at the time of a sample, by the losses before this time [degC].
  double at(const MotionSample& sample) noexcept
  {
    if (!on_)
    {
      return sample.temperatureOr(configured_);
    }
    const bool measured = std::isfinite(sample.temperature);
    if (!started_)
    {
      heat_.reset(measured ? sample.temperature - housing_rise_ : configured_);
      last_ = sample.time;
      started_ = true;
    }
    const double seconds = std::max(sample.time - last_, 0.0);
    last_ = sample.time;
    elapsed_ += seconds;
    if (!sample.after_gap)
    {
      losses_.friction += friction_power_ * seconds;
      losses_.copper += copper_power_ * seconds;
    }
    if (elapsed_ >= DriveHeat::PERIOD)
    {
      if (measured)
      {
        heat_.advanceGrease(elapsed_, losses_.friction, sample.temperature);
      }
      else
      {
        heat_.advance(elapsed_, losses_, configured_);
      }
      losses_ = {};
      elapsed_ = 0.0;
    }
    return std::clamp(heat_.grease(), MIN_TEMPERATURE, MAX_TEMPERATURE);
  }

  /// Sets the losses until the next sample: speed of the joint [rad/s], friction at the joint and motor torque [N.m].
  void book(double velocity, double friction_torque, double motor_torque) noexcept
  {
    friction_power_ = std::abs(friction_torque * velocity);
    copper_power_ = copper_loss_ * motor_torque * motor_torque;
  }

  /// Temperature of the housing in the model two_nodes, otherwise `grease`, the temperature of the grease [degC].
  double housing(double grease) const noexcept { return on_ ? heat_.housing() : grease; }

private:
  DriveHeat heat_;
  double housing_rise_;  // thermal.housing_rise [K]
  double copper_loss_;   // motor.copper_loss [W/(N.m)^2]
  double configured_;    // input.temperature [degC]
  bool on_;
  bool started_{};
  double last_{};             // time of the last sample [s]
  double elapsed_{};          // time since the last step of heat_ [s]
  DriveHeat::Losses losses_;  // losses since the last step of heat_ [J]
  double friction_power_{};   // power of the friction since the last sample [W]
  double copper_power_{};     // power of the copper loss since the last sample [W]
};
}  // namespace hjt
