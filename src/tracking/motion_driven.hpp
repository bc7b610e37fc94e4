// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <utility>

#include "elements/friction_laws.hpp"
#include "elements/load.hpp"
#include "elements/motor.hpp"
#include "gear/angle.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/twin.hpp"
#include "params/variants.hpp"
#include "tracking/friction_map.hpp"
#include "tracking/motion_differentiator.hpp"

namespace hjt
{
/// Motor current for an effort of 1 A or 1 N.m, in the unit `effort` [A].
inline double currentPerEffort(EffortUnit effort, const Parameters& parameters) noexcept
{
  const double gain = parameters.telemetry.torque_per_current;
  switch (effort)
  {
    case EffortUnit::CURRENT:
      break;
    case EffortUnit::JOINT_TORQUE:
      return 1.0 / gain;
    case EffortUnit::MOTOR_TORQUE:
      return nominalRatio(parameters.gear) / gain;
  }
  return 1.0;
}

/// Motor current for an effort of 1 A or 1 N.m, in the configured unit [A].
inline double currentPerEffort(const Parameters& parameters) noexcept
{
  return currentPerEffort(parameters.telemetry.effort, parameters);
}

/// Ripple of the motor torque that the kinematic error causes, as a torque at the joint.
///
/// On a load that does not move, a line would be a torque K e: stiffness K of the joint x amplitude e of the line. A
/// real load oscillates on K with the resonance w0 and the damping ratio z, so the torque of the line in the gear is
///   T = K e (-w^2) / (w0^2 - w^2 + 2 i z w0 w),   w = order times the joint's speed.
/// At rest there is no ripple, because the load follows the kinematic error. There are four lines: two and four waves
/// per turn of the motor against the circular spline, which turns with the output, and as many against the flexspline.
/// Above the joint speed telemetry.ripple_fastest at() returns 0, because the lines are not known there.
class TorqueRipple
{
public:
  static constexpr std::size_t LINES = 4;
  using Orders = std::array<double, LINES>;
  using Waves = std::array<std::complex<double>, LINES>;

  TorqueRipple(const TelemetryParameters& p, double ratio)
    : orders_(orders(ratio))
    , lines_{ { { p.ripple_circular_spline_2[0], p.ripple_circular_spline_2[1] },
                { p.ripple_flexspline_2[0], p.ripple_flexspline_2[1] },
                { p.ripple_circular_spline_4[0], p.ripple_circular_spline_4[1] },
                { p.ripple_flexspline_4[0], p.ripple_flexspline_4[1] } } }
    , response_{ p.ripple_resonance, p.ripple_damping, p.ripple_lag }
    , fastest_(lines_ == Waves() ? -1.0 : p.ripple_fastest)
  {
  }

  /// Ripple [N.m] at an angle [rad] and a speed [rad/s] of the joint.
  double at(double position, double velocity) const noexcept
  {
    double sum = 0.0;
    if (std::abs(velocity) <= fastest_)
    {
      const Waves felt = waves(orders_, position, velocity, response_.data());
      for (std::size_t i = 0; i < LINES; ++i)
      {
        sum += (std::conj(lines_[i]) * felt[i]).real();
      }
    }
    return sum;
  }

  /// Orders of the lines per turn of the joint: two waves against circular spline and flexspline, then four waves.
  static Orders orders(double ratio) { return { 2.0 * ratio - 2.0, 2.0 * ratio, 4.0 * ratio - 4.0, 4.0 * ratio }; }

  /// w0^2 - w^2 + 2 i z w0 w of the class comment [rad^2/s^2]. `response`: resonance [Hz], damping [-], lag [s].
  static std::complex<double> stiffness(double w, const double* response) noexcept
  {
    const double natural = TWO_PI * response[0];
    return { natural * natural - w * w, 2.0 * response[1] * natural * w };
  }

  /// Torque in the gear by each line if K e = 1 N.m; real part: by a cosine line, imaginary part: by a sine line.
  static Waves waves(const Orders& orders, double position, double velocity, const double* response) noexcept
  {
    Waves turned;
    Waves felt;
    for (std::size_t i = 0; i < LINES; ++i)
    {
      const double w = orders[i] * velocity;
      const std::complex<double> inverse = std::conj(stiffness(w, response));
      // The orders of the last two lines are twice those of the first two lines.
      turned[i] = i < 2 ? std::polar(1.0, orders[i] * position - w * response[2]) : turned[i - 2] * turned[i - 2];
      felt[i] = -w * w / std::norm(inverse) * inverse * turned[i];
    }
    return felt;
  }

private:
  Orders orders_;
  Waves lines_;                     // each line as cosine + i sine [N.m]
  std::array<double, 3> response_;  // resonance [Hz], damping [-], lag [s]
  double fastest_;                  // largest joint speed with ripple; negative: the joint has no line [rad/s]
};

/// Share of the friction that has built up, between -1 and 1. After a reversal the share builds up over an angle of the
/// motor (function `mobilised`). The share has two parts. The part of the contacts builds up over
/// telemetry.presliding_angle. This part decays with the time constant RELAXATION, as the current of standing joints
/// does (UR5 CB series, K. Kufieta, NTNU 2014: 5 to 10 s). The lasting part, telemetry.lasting_share of the whole,
/// builds up over LASTING_ANGLE and does not decay. Noise of an encoder at standstill hardly changes the lasting part.
class Presliding
{
public:
  static constexpr double RELAXATION = 5.0;     ///< time constant of the decay at rest [s]
  static constexpr double LASTING_ANGLE = 0.4;  ///< angle of the motor over which the lasting part builds up [rad]

  explicit Presliding(const TelemetryParameters& parameters)
    : angle_(parameters.presliding_angle), lasting_share_(parameters.lasting_share)
  {
  }

  /// Turns the motor by `motor_step` [rad] in `duration` [s].
  void move(double motor_step, double duration) noexcept
  {
    contacts_ = mobilised(contacts_ * std::exp(-duration / RELAXATION), motor_step, angle_);
    lasting_ = mobilised(lasting_, motor_step, LASTING_ANGLE);
  }

  void reset() noexcept { contacts_ = lasting_ = 0.0; }

  double share() const noexcept { return (1.0 - lasting_share_) * contacts_ + lasting_share_ * lasting_; }

private:
  double angle_;
  double lasting_share_;
  double contacts_{};
  double lasting_{};
};

/// Torque of a load's weight and inertia in a motion; > 0 resists positive motion [N.m].
inline double ownTorque(const Load& load, const MotionSample& sample) noexcept
{
  return load.inertia() * sample.acceleration - load.gravityTorque(sample.position);
}

/// Motor torque and motor current that a sound joint needs for a motion, at one instant.
struct MotionPrediction
{
  double motor_torque{};     ///< torque at the motor shaft [N.m]
  double current{};          ///< current of the motor [A]
  double friction_torque{};  ///< friction of the whole drive at the joint, with the sign of the motion [N.m]
  double friction_limit{};   ///< largest possible friction at this speed and load [N.m]
  double band{};             ///< half width of the band: current of the friction that has not built up [A]

  /// Whether nearly all of the friction has built up, so that the current shows the friction.
  bool tellsFriction() const
  {
    constexpr double LEFT = 0.05;  // largest friction that has not built up, over friction [-]
    return friction_limit - std::abs(friction_torque) < LEFT * std::abs(friction_torque);
  }
};

/// The twin driven by a measured motion: predicts torque and current of the motor. The friction comes from a table
/// (FrictionMap), so the twin solves no ring.
///
///   current = (load + vibration + J_m n^2 a + n s T_f(n |v|, load) + T_r) / gain + offset
/// where n   ratio; a, v: acceleration and speed of the joint; J_m: inertia of motor and wave generator
///       T_f friction at the motor shaft (FrictionMap); s: share of T_f that has built up (Presliding)
///       T_r torque ripple by the kinematic error (TorqueRipple); gain, offset: torque_per_current, current_offset
///
/// The load of a sample includes inertia and weight. A step takes some hundred nanoseconds; nothing allocates.
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

  double ratio() const noexcept { return ratio_; }  ///< nominal ratio with its sign [-]

  MotionPrediction step(const MotionSample& sample) noexcept
  {
    move(sample);
    return bear(sample);
  }

  /// Makes the part of a step that needs no load. bear() makes the other part.
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

  /// The prediction for `sample`, with its load and vibration. Call move() for this sample before.
  MotionPrediction bear(const MotionSample& sample) noexcept
  {
    last_ = sample;
    predicted_at_ = sample.temperatureOr(temperature_);
    return predicted_ = predict(predicted_at_);
  }

  /// The prediction for the last sample, if the temperature of the grease were `temperature` [degC].
  MotionPrediction at(double temperature) const noexcept
  {
    return temperature == predicted_at_ ? predicted_ : predict(temperature);
  }

  /// Motor current for an effort of 1 A or 1 N.m, in the configured unit [A].
  double currentPerEffort() const noexcept { return current_per_effort_; }

  /// Friction [N.m] at the joint in steady motion, >= 0, at a speed [rad/s], load [N.m] and temperature [degC].
  double frictionAt(double velocity, double load, double temperature) const noexcept
  {
    return ratio_ * friction_.atViscosity(ratio_ * velocity, load, viscosity(temperature)).sum();
  }

  /// Torque of configured weight and inertia, for recordings without a load; > 0 resists positive motion [N.m].
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

  /// Viscosity of the grease [m^2/s] at a temperature [degC].
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
  double inertia_;  // inertia of motor and wave generator - telemetry.inertia_in_load [kg.m^2]
  double ratio_;
  double temperature_;  // assumed temperature of samples without one [degC]
  double current_per_effort_;
  MotionSample last_;
  MotionPrediction predicted_;  // prediction for the last sample at the temperature predicted_at_
  mutable std::array<Viscosity, 2> known_;
  double predicted_at_{ std::numeric_limits<double>::quiet_NaN() };  // temperature of predicted_; NaN: none [degC]
  bool started_{};
};

/// The whole twin, driven by a measured motor current, predicts the motion. The prediction drifts away with time.
///
/// The current of a sample drives the twin from the sample's time on. The weight is that at the measured angle, so that
/// the weight stays right if the twin's angle drifts away. At the first sample, and at the first one after a gap, the
/// twin starts at rest at the measured angle.
class TorqueDriven
{
public:
  /// @throws ParameterError for the reasons that Twin names.
  explicit TorqueDriven(const Parameters& parameters, const SurfaceSource& surface_source = {})
    : twin_(withoutHeat(withoutWeight(parameters)), surface_source)
    , load_(parameters.output)
    , telemetry_(parameters.telemetry)
    , ratio_(nominalRatio(parameters.gear))
    , temperature_(parameters.input.temperature)
  {
  }

  struct Motion
  {
    double position{};         ///< angle of the joint at the time of the sample [rad]
    double velocity{};         ///< speed of the joint [rad/s]
    double joint_torque{};     ///< torque of the mesh on the output [N.m]
    double friction_torque{};  ///< friction of the whole drive at the joint, > 0 against the motion [N.m]
  };

  /// Returns the state of the twin's joint at the time of `sample`, from which on its current and `load` act.
  /// @param load external torque at the output, without the configured weight and inertia [N.m]
  Motion step(const MotionSample& sample, double load) noexcept
  {
    const Stamp stamp = std::llround(1e9 * sample.time);
    if (!started_ || sample.after_gap)
    {
      solver_failures_ = solverFailures();
      twin_.reset(stamp);
      start_position_ = sample.position;
      started_ = true;
    }
    while (twin_.step(stamp))
    {
    }
    twin_.setTemperature(stamp, sample.temperatureOr(temperature_));
    twin_.commandMotorTorque(stamp,
                             telemetry_.torque_per_current * (sample.current - telemetry_.current_offset) / ratio_);
    twin_.commandLoadTorque(stamp, load - load_.gravityTorque(sample.position));

    const JointOutputs& now = twin_.outputs();
    Motion motion;
    motion.velocity = now.output_velocity;
    motion.position =
        start_position_ + now.output_angle + 1e-9 * static_cast<double>(stamp - now.stamp) * now.output_velocity;
    motion.joint_torque = now.joint_torque;
    motion.friction_torque = std::copysign(ratio_ * now.friction_torque, now.motor_velocity);
    return motion;
  }

  std::uint64_t solverFailures() const noexcept { return solver_failures_ + twin_.counters().solver_failures; }

private:
  Twin twin_;
  Load load_;
  TelemetryParameters telemetry_;
  double ratio_;
  double temperature_;       // assumed temperature of samples without one [degC]
  double start_position_{};  // measured angle of the joint at which the twin's output angle is 0 [rad]
  bool started_{};
  std::uint64_t solver_failures_{};  // number of solver failures before the last start of the twin [-]
};
}  // namespace hjt
