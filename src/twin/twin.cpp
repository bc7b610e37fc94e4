// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/twin.hpp"

#include <memory>
#include <vector>

#include "harmonic_joint_twin/base/errors.hpp"
#include "statics/flexspline_stress.hpp"
#include "statics/gear_checks.hpp"
#include "statics/inertia_error.hpp"
#include "twin/tooth_forces.hpp"
#include "twin/twin_impl.hpp"

namespace hjt
{
Twin::Twin(const Parameters& parameters, const SurfaceSource& surface_source)
{
  if (parameters.contact.law == ContactLaw::POLAR)
  {
    throw ParameterError(
        "contact.law = polar is not the gradient of an energy: only the insertion analysis may use it; "
        "allowed for the running twin: normal");
  }
  if (const std::string jam = jamOf(parameters); !jam.empty())
  {
    throw ParameterError(jam);
  }
  impl_ = std::make_unique<Impl>(parameters, surface_source);
}

Twin::~Twin() = default;
Twin::Twin(Twin&&) noexcept = default;
Twin& Twin::operator=(Twin&&) noexcept = default;

Twin::Twin(const Twin& other) : impl_(Impl::copyOf(*other.impl_)) {}

Twin& Twin::operator=(const Twin& other)
{
  return *this = Twin(other);
}

const Parameters& Twin::parameters() const noexcept
{
  return impl_->parameters;
}

bool Twin::reset(Stamp stamp) noexcept
{
  if (!isStamp(stamp))
  {
    return false;
  }
  impl_->reset(stamp);
  return true;
}

void Twin::injectFault(Stamp stamp, const Fault& fault) noexcept
{
  FaultCounters& counted = impl_->counters.faults;
  if (!isStamp(stamp) || !isValid(fault, impl_->parameters))
  {
    ++counted.refused;
    return;
  }
  const Stamp sets_in = stamp + Impl::delayOf(fault);
  if (!impl_->waiting.push(fault, sets_in))
  {
    ++counted.no_room;
    return;
  }
  ++counted.accepted;
  counted.late += sets_in < impl_->simulated_until ? 1 : 0;
}

const FaultList& Twin::activeFaults() const noexcept
{
  return impl_->active;
}

void Twin::push(const Input& input) noexcept
{
  impl_->queue.push(input, impl_->simulated_until);
  impl_->counters.input = impl_->queue.counters();
}

void Twin::push(const TwinInput& input) noexcept
{
  if (const auto* fault = std::get_if<StampedFault>(&input))
  {
    injectFault(fault->stamp, fault->fault);
  }
  else
  {
    push(*std::get_if<Input>(&input));
  }
}

void Twin::coupleArm(double inertia, double torque) noexcept
{
  impl_->stepper.setOutputInertia(impl_->parameters.output.circular_spline_inertia + inertia);
  impl_->arm_torque = torque;
}

double Twin::linkTorque() const noexcept
{
  return impl_->stepper.linkTorque();
}

double Twin::deliveredEnergy() const noexcept
{
  return impl_->stepper.deliveredEnergy();
}

bool Twin::step(Stamp until) noexcept
{
  if (impl_->now + impl_->step_length > until)
  {
    return false;
  }
  impl_->step();
  return true;
}

Stamp Twin::stamp() const noexcept
{
  return impl_->now;
}

Stamp Twin::stepLength() const noexcept
{
  return impl_->step_length;
}

JointOutputs Twin::outputs() const noexcept
{
  return impl_->outputs();
}

const TwinCounters& Twin::counters() const noexcept
{
  return impl_->counters;
}

bool Twin::onSurface() const noexcept
{
  return impl_->stepper.dynamics().onSurface();
}

EncoderReadings Twin::encoders() const noexcept
{
  return impl_->sensors.encoders();
}

double Twin::motorTorqueReading() const noexcept
{
  return impl_->sensors.motorTorque();
}

HealthReport Twin::health(Stamp since) const noexcept
{
  const JointOutputs now = outputs();
  return { impl_->monitor.indicators(), impl_->lobes(), impl_->solverState(since),
           expectedMeshForceError(impl_->parameters.ring, impl_->parameters.gear, now.motor_velocity,
                                  now.joint_torque) };
}

void Twin::watchSignals(bool on) noexcept
{
  impl_->watching = on;
}

bool Twin::watchesSignals() const noexcept
{
  return impl_->watching;
}

const SignalIndicators& Twin::signalIndicators() const noexcept
{
  return impl_->signals.indicators();
}

const Assessment& Twin::assessment() const noexcept
{
  return impl_->assessor.assessment();
}

ToothForces Twin::makeToothForces() const
{
  const std::vector<double> zeros(static_cast<std::size_t>(impl_->parameters.gear.teeth_flexspline), 0.0);
  return { zeros, zeros, zeros, zeros, zeros, zeros };
}

bool Twin::toothForces(ToothForces& out) noexcept
{
  if (fillToothForces(impl_->stepper.dynamics(), out))
  {
    return true;
  }
  const RingEquilibrium* ring = impl_->observed_ring.at(impl_->stepper.dynamics());
  if (ring == nullptr)
  {
    return false;
  }
  fillToothForces(*ring, 0, out);
  return true;
}

bool Twin::toothStress(ToothStress& stress) noexcept
{
  const RingEquilibrium* ring = impl_->observed_ring.at(impl_->stepper.dynamics());
  if (ring == nullptr)
  {
    return false;
  }
  FlexsplineStress(impl_->parameters).at(*ring, 0, stress);
  return true;
}
}  // namespace hjt
