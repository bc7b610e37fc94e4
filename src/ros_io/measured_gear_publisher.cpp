// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/measured_gear_publisher.hpp"

#include <algorithm>
#include <cmath>

#include "gear/ratio.hpp"
#include "ros_io/time.hpp"
#include "ros_io/topics.hpp"

namespace hjt
{
namespace
{
constexpr std::uint32_t QUEUE_SIZE = 100;
}  // namespace

MeasuredGearPublisher::MeasuredGearPublisher(ros::NodeHandle& node, const Parameters& parameters)
  : torque_per_current_(parameters.telemetry.torque_per_current / nominalRatio(parameters.gear))
  , current_offset_(parameters.telemetry.current_offset)
  , ratio_(nominalRatio(parameters.gear))
  , gear_(parameters)
  , sensors_(parameters.sensors, 1.0 / parameters.publish.encoders_rate)
  , contact_forces_{ makeContactForces(parameters), StampPeriods(parameters.publish.contact_forces_rate),
                     node.advertise<harmonic_joint_twin::ContactForces>(topics::CONTACT_FORCES, QUEUE_SIZE) }
  , encoders_{ makeMessage<harmonic_joint_twin::Encoders>(parameters), StampPeriods(parameters.publish.encoders_rate),
               node.advertise<harmonic_joint_twin::Encoders>(topics::ENCODERS, QUEUE_SIZE) }
  , health_{ makeMessage<harmonic_joint_twin::Health>(parameters), StampPeriods(parameters.publish.health_rate),
             node.advertise<harmonic_joint_twin::Health>(topics::HEALTH, QUEUE_SIZE) }
{
}

void MeasuredGearPublisher::offer(Stamp stamp, const Comparison& comparison)
{
  const bool forces_due = contact_forces_.isDue(stamp);
  const bool encoders_due = encoders_.isDue(stamp);
  const bool health_due = health_.isDue(stamp);
  if (!forces_due && !encoders_due && !health_due)
  {
    return;
  }
  if (!gear_.moveTo(comparison.position.measured, comparison.joint_torque))
  {
    ++failures_;
    return;
  }
  if (forces_due)
  {
    fillContactForces(stamp, gear_, contact_forces_.message);
    contact_forces_.publisher.publish(contact_forces_.message);
  }
  if (encoders_due)
  {
    const double motor_torque = torque_per_current_ * (comparison.current.measured - current_offset_);
    sensors_.update(encoders_.periods.number(), gear_.motorAngle(), gear_.position(), motor_torque);
    fillEncoders(stamp, sensors_.encoders(), gear_.motorAngle(), gear_.position(), encoders_.message);
    encoders_.publisher.publish(encoders_.message);
  }
  if (health_due)
  {
    fillHealth(stamp, comparison);
    health_.publisher.publish(health_.message);
  }
}

/// What follows from one instant; what takes a turn of the drive is not valid here, ~indicators has it.
void MeasuredGearPublisher::fillHealth(Stamp stamp, const Comparison& comparison)
{
  const LobeLoads lobes = gear_.lobes();
  harmonic_joint_twin::Health& message = health_.message;
  message.header.stamp = toRosTime(stamp);
  message.torsion = gear_.torsion();
  message.torsional_stiffness_model = gear_.stiffness();
  message.teeth_loaded = static_cast<std::uint32_t>(lobes.teeth_loaded);
  std::copy(lobes.mesh_force.begin(), lobes.mesh_force.end(), message.lobe_mesh_force.begin());
  message.lobe_asymmetry = lobes.asymmetry;
  message.wave_generator_load = lobes.wave_generator_force;
  message.friction_torque = std::abs(comparison.friction_torque) / ratio_;
  message.grease_temperature = comparison.temperature;
  message.housing_temperature = comparison.temperature;
  message.motor_torque = torque_per_current_ * (comparison.current.measured - current_offset_);
  message.joint_torque = comparison.joint_torque;
  message.solver_residual = gear_.residual();
  message.solver_failures = failures_;
}
}  // namespace hjt
