// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "elements/friction_laws.hpp"
#include "elements/load.hpp"
#include "elements/motor.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "tracking/effort.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_differentiator.hpp"
#include "tracking/torque_ripple.hpp"

namespace hjt
{
/// Share of the friction that is mobilised, between -1 and 1: after a reversal it builds up over a presliding angle
/// (`mobilised`, by the motor's angle). Two of them add up. The contacts' builds up over telemetry.presliding_angle.
/// While the joint stands the motion does not tell it, and it forgets the last one within RELAXATION, as the current of
/// standing joints does (UR5 CB series, K. Kufieta, NTNU 2014: 5 to 10 s). The lasting part, telemetry.lasting_share of
/// the whole, builds up over LASTING_ANGLE, so that the encoder's noise at standstill hardly changes it, and remains.
class Presliding
{
public:
  static constexpr double RELAXATION = 5.0;     ///< [s]
  static constexpr double LASTING_ANGLE = 0.4;  ///< of the motor [rad]

  explicit Presliding(const TelemetryParameters& parameters)
    : angle_(parameters.presliding_angle), lasting_share_(parameters.lasting_share)
  {
  }

  /// The motor turned by this much [rad] within [s]
  void move(double motor_step, double duration) noexcept
  {
    contacts_ = mobilised(contacts_ * std::exp(-duration / RELAXATION), motor_step, angle_);
    lasting_ = mobilised(lasting_, motor_step, LASTING_ANGLE);
  }

  void reset() noexcept { contacts_ = lasting_ = 0.0; }

  double share() const noexcept { return (1.0 - lasting_share_) * contacts_ + lasting_share_ * lasting_; }
  double contacts() const noexcept { return contacts_; }  ///< of the contacts alone
  double lasting() const noexcept { return lasting_; }    ///< of the lasting part alone

private:
  double angle_;
  double lasting_share_;
  double contacts_{};
  double lasting_{};
};

/// Torque of a load's weight and inertia in a motion, > 0 resists positive motion [N.m].
inline double ownTorque(const Load& load, const MotionSample& sample) noexcept
{
  return load.inertia() * sample.acceleration - load.gravityTorque(sample.position);
}

/// Motor torque and current of a healthy joint for a motion.
struct MotionPrediction
{
  double motor_torque{};     ///< at the shaft [N.m]
  double current{};          ///< [A]
  double friction_torque{};  ///< of the whole, at the joint, with its sign [N.m]
  double friction_limit{};   ///< the most that it could be at this speed and load [N.m]
  double band{};             ///< half width of the current's band that the motion leaves open [A]

  /// Nearly all of it is mobilised: the current tells it.
  bool tellsFriction() const
  {
    constexpr double LEFT = 0.05;  // of the friction, at most [-]
    return friction_limit - std::abs(friction_torque) < LEFT * std::abs(friction_torque);
  }
};

/// The twin driven by a measured motion: motor torque and current out. No ring is solved: friction comes from a table
/// of it.
///
///   current = (load + vibration + J_m n^2 a + n s T_f(n |v|, load) + T_r) / gain + offset
/// where n   ratio, a and v the joint's acceleration and speed, J_m motor and wave generator
///       T_f friction at the motor shaft (FrictionMap), s the mobilised share of it (Presliding)
///       T_r torque ripple caused by the kinematic error (TorqueRipple)
/// The load of the sample holds all that acts at the output: inertia and weight too. Steps cost some hundred
/// nanoseconds; nothing allocates.
class MotionDriven
{
public:
  /// @throws ParameterError if the ring finds no equilibrium under load.
  explicit MotionDriven(const Parameters& parameters)
    : friction_(parameters)
    , presliding_(parameters.telemetry)
    , ripple_(parameters.telemetry, nominalRatio(parameters.gear))
    , load_(parameters.output)
    , telemetry_(parameters.telemetry)
    , inertia_(Motor(parameters.motor).inertia() - parameters.telemetry.inertia_in_load)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
    , current_per_effort_(hjt::currentPerEffort(parameters))
  {
  }

  double ratio() const noexcept { return ratio_; }  ///< nominal, signed [-]

  MotionPrediction step(const MotionSample& sample) noexcept
  {
    move(sample);
    return bear(sample);
  }

  /// The step without a prediction, whatever its load.
  void move(const MotionSample& sample) noexcept
  {
    if (!started_ || sample.after_gap)
    {
      presliding_.reset();
      last_ = sample;
      started_ = true;
    }
    presliding_.move(ratio_ * (sample.position - last_.position), sample.time - last_.time);
    last_ = sample;
    predicted_at_ = std::numeric_limits<double>::quiet_NaN();
  }

  /// The prediction for the last sample, now with its load and vibration.
  MotionPrediction bear(const MotionSample& sample) noexcept
  {
    last_ = sample;
    predicted_at_ = sample.temperatureOr(temperature_);
    return predicted_ = predict(predicted_at_);
  }

  /// The prediction for the last sample, with the grease at a temperature [degC].
  MotionPrediction at(double temperature) const noexcept
  {
    return temperature == predicted_at_ ? predicted_ : predict(temperature);
  }

  /// Of the joint's telemetry [A], [A/(N.m)].
  double currentPerEffort() const noexcept { return current_per_effort_; }

  /// Friction at the joint in steady motion at a speed [rad/s], load [N.m] and temperature [degC], >= 0 [N.m].
  double frictionAt(double velocity, double load, double temperature) const noexcept
  {
    return ratio_ * friction_.atViscosity(ratio_ * velocity, load, viscosity(temperature)).sum();
  }

  /// Torque of the configured weight and inertia, for recordings without a load [N.m].
  double modelledLoad(const MotionSample& sample) const noexcept { return ownTorque(load_, sample); }

private:
  MotionPrediction predict(double temperature) const noexcept
  {
    const double share = presliding_.share();
    const double friction = friction_.atViscosity(ratio_ * last_.velocity, last_.load, viscosity(temperature)).sum();
    MotionPrediction prediction;
    prediction.friction_limit = ratio_ * friction;
    prediction.friction_torque = share * prediction.friction_limit;
    prediction.motor_torque = (last_.load + last_.vibration) / ratio_ + inertia_ * ratio_ * last_.acceleration +
                              share * friction + ripple_.at(last_.position, last_.velocity) / ratio_;
    prediction.current = ratio_ * prediction.motor_torque / telemetry_.torque_per_current + telemetry_.current_offset;
    prediction.band = (1.0 - std::abs(share)) * prediction.friction_limit / telemetry_.torque_per_current;
    return prediction;
  }

  double viscosity(double temperature) const noexcept
  {
    if (known_[0].temperature != temperature)
    {
      std::swap(known_[0], known_[1]);
    }
    if (known_[0].temperature != temperature)
    {
      known_[0] = { temperature, friction_.viscosity(temperature) };
    }
    return known_[0].viscosity;
  }

  /// Of the grease.
  struct Viscosity
  {
    double temperature{ std::numeric_limits<double>::quiet_NaN() };
    double viscosity{};
  };

  FrictionMap friction_;
  Presliding presliding_;
  TorqueRipple ripple_;
  Load load_;
  TelemetryParameters telemetry_;
  double inertia_;  // of motor and wave generator, less the part in the load [kg.m^2]
  double ratio_;
  double temperature_;  // of samples without one [degC]
  double current_per_effort_;
  MotionSample last_;
  MotionPrediction predicted_;  // for it, at this temperature; NaN: not known
  mutable std::array<Viscosity, 2> known_;
  double predicted_at_{ std::numeric_limits<double>::quiet_NaN() };
  bool started_{};
};
}  // namespace hjt
