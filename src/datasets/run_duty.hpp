// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "datasets/plan_values.hpp"
#include "output/ordered_json.hpp"
#include "params/field_table.hpp"

#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"

namespace hjt
{
/// A quantity as a function of time, with its slope.
class Waveform
{
public:
  virtual ~Waveform() = default;
  virtual double value(double time) const = 0;  ///< value of the quantity at `time` >= 0 [s]
  virtual double slope(double time) const = 0;  ///< slope of the quantity at `time`, in its unit per second
  virtual Range range() const = 0;              ///< range that contains all values
};

class ConstantWaveform : public Waveform
{
public:
  explicit ConstantWaveform(double value) : value_(value) {}
  double value(double) const override { return value_; }
  double slope(double) const override { return 0.0; }
  Range range() const override { return { value_, value_ }; }

private:
  double value_;
};

/// Waveform mean + amplitude sin(2 pi frequency t + phase), with the frequency in [Hz] and the phase in [rad].
class SinusWaveform : public Waveform
{
public:
  SinusWaveform(double mean, double amplitude, double frequency, double phase);
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override { return { mean_ - amplitude_, mean_ + amplitude_ }; }

private:
  double mean_, amplitude_, angular_frequency_, phase_;
};

/// Periodic waveform. It rises to the peak with a constant slope, stays there for `hold`, returns to zero with the same
/// slope, stays there for `pause`, and repeats this with the opposite sign. If the peak is zero, the value is constant.
class TrapezoidWaveform : public Waveform
{
public:
  static constexpr double SHORTEST = 1e-9;  ///< shortest half period of a waveform with a peak [s]

  /// `slope`, > 0, is in the quantity's unit per second; `hold` and `pause` are in [s].
  TrapezoidWaveform(double peak, double slope, double hold, double pause);
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override { return { -std::abs(peak_), std::abs(peak_) }; }
  double halfPeriod() const { return half_period_; }  ///< half of the waveform's period [s]

private:
  struct Place
  {
    double sign;
    double time;  // time since the beginning of the half period [s]
  };
  Place place(double time) const;

  double peak_, slope_, rise_, hold_, half_period_;
};

/// Linear interpolation between the rows of a table. The value is constant before the first and after the last row.
class TableWaveform : public Waveform
{
public:
  using Rows = std::vector<std::pair<double, double>>;

  /// Reads a column of a CSV file and its column `time` [s]. @throws InputError with line and column.
  static std::shared_ptr<const Rows> read(const std::string& path, const std::string& column, const Range& range,
                                          const std::string& unit);

  explicit TableWaveform(std::shared_ptr<const Rows> rows) : rows_(std::move(rows)) {}
  double value(double time) const override;
  double slope(double time) const override;
  Range range() const override;

private:
  std::size_t rowAfter(double time) const;

  std::shared_ptr<const Rows> rows_;
};

/// Inputs of a drive in a run: motor torque or controlled speed, load and temperature.
struct RunDuty
{
  std::shared_ptr<const Waveform> torque;       ///< torque of the motor [N.m]; null: the speed is controlled
  std::shared_ptr<const Waveform> speed;        ///< speed of the joint [rad/s]; null: the torque is given
  double bandwidth{};                           ///< bandwidth of the speed control [Hz]
  std::shared_ptr<const Waveform> load;         ///< external torque at the output [N.m]; null: no load
  std::shared_ptr<const Waveform> temperature;  ///< temperature of the drive [degC]; null: input.temperature
  /// Time in which torque, speed and load rise along half a cosine [s], because a step would excite vibration.
  double easing{};
};

/// Feeds the inputs of a duty cycle to a twin, step by step.
///
/// The speed control is that of a real drive. From readings of the motor encoder it computes the motor torque T [N.m]:
///        T = J a + 2 w J_m (v_r - v) + w^2 J_m (x_r - x)
/// where  J    inertia of motor and joint at the motor             [kg.m^2]
///        J_m  inertia of the motor alone: above the drive's resonance the joint does not follow, so a gain for motor
///             and joint would be too high                               [kg.m^2]
///        w    2 pi times the bandwidth                           [rad/s]
///        a, v_r, x_r   references of acceleration, speed, angle; v, x readings   [rad/s^2], [rad/s], [rad], at the
///                      motor
class DutyFeeder
{
public:
  DutyFeeder(const RunDuty& duty, const Twin& twin) : duty_(duty), ratio_(nominalRatio(twin.parameters().gear))
  {
    const Parameters& p = twin.parameters();
    motor_inertia_ = p.motor.rotor_inertia + p.motor.wave_generator_inertia;
    inertia_ = motor_inertia_ + (p.output.circular_spline_inertia + p.output.load_inertia) / (ratio_ * ratio_);
  }

  /// The caller calls this function before the step that ends `time` [s] after the start of the run.
  void feed(Twin& twin, double time)
  {
    const Stamp begin = twin.stamp();
    const double middle = time - 0.5 * toSeconds(twin.stepLength());  // an input acts with its mean over the step
    twin.commandMotorTorque(begin,
                            duty_.torque ? easedIn(middle) * duty_.torque->value(middle) : controlTorque(twin, time));
    if (duty_.load)
    {
      const double load = easedIn(middle) * duty_.load->value(middle);
      if (load != last_load_)
      {
        twin.commandLoadTorque(begin, load);
        last_load_ = load;
      }
    }
    if (duty_.temperature)
    {
      twin.setTemperature(begin, duty_.temperature->value(time));
    }
  }

  /// Reference of the joint's speed [rad/s]; zero if the torque is given.
  double speedReference() const { return speed_reference_; }

private:
  double easedIn(double time) const
  {
    return time < duty_.easing ? 0.5 - 0.5 * std::cos(PI * time / duty_.easing) : 1.0;
  }

  double controlTorque(const Twin& twin, double time)
  {
    const double frequency = TWO_PI * duty_.bandwidth;
    const double full_speed = duty_.speed->value(time);
    const double eased = easedIn(time);
    const double easing_slope =
        time < duty_.easing ? 0.5 * PI / duty_.easing * std::sin(PI * time / duty_.easing) : 0.0;
    const double acceleration = eased * duty_.speed->slope(time) + easing_slope * full_speed;
    const double speed = eased * full_speed;
    angle_reference_ += 0.5 * (speed + speed_reference_) * (time - last_time_);
    speed_reference_ = speed;
    last_time_ = time;
    const EncoderReadings read = twin.encoders();
    return inertia_ * ratio_ * acceleration +
           motor_inertia_ * (2.0 * frequency * (ratio_ * speed - read.motor_velocity) +
                             frequency * frequency * (ratio_ * angle_reference_ - read.motor_angle));
  }

  RunDuty duty_;
  double ratio_;
  double motor_inertia_;  // inertia of rotor and wave generator [kg.m^2]
  double inertia_;        // inertia of motor and joint, referred to the motor's shaft [kg.m^2]
  double last_load_{};
  double last_time_{};
  double angle_reference_{};  // reference of the joint's angle [rad]
  double speed_reference_{};
};

/// Reads the duty cycles of a plan for one run. All members throw InputError with file, line, key, value, unit and
/// range.
class DutyReader
{
public:
  /// Reads all tables that the list `duty` of a plan may use. `directory`: directory of the plan.
  void readTables(const PlanNode& duties, const std::string& directory);

  RunDuty read(const PlanNode& duty, const PlanValues& values) const;

  /// Rows of all tables, for the document of the plan.
  OrderedJson tables() const;

private:
  using Table = std::pair<std::string, std::string>;  // path of the file, and name of the column

  std::shared_ptr<const Waveform> waveform(const PlanNode& map, const std::string& key, const PlanValues& values) const;

  std::map<Table, std::shared_ptr<const TableWaveform::Rows>> tables_;
};
}  // namespace hjt
