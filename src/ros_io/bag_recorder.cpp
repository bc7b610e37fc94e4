// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/bag_recorder.hpp"

#include <limits>

#include "ros_io/topics.hpp"

namespace hjt
{
BagRecorder::BagRecorder(const Twin& twin, const std::string& joint_namespace, BagWriter& bag)
  : bag_(bag)
  , schedule_(twin.parameters())
  , tooth_forces_(twin.makeToothForces())
  , prefix_(joint_namespace + "/")
  , names_(twin.parameters().joint.name)
  , recorded_faults_(twin.activeFaults().empty() ? twin.activeFaults().version() :
                                                   std::numeric_limits<std::uint64_t>::max())
  , joint_states_(makeJointStates(JointNames(twin.parameters().joint.name)))
  , encoders_(makeEncoders(JointNames(twin.parameters().joint.name)))
  , contact_forces_(
        makeContactForces(JointNames(twin.parameters().joint.name), twin.parameters().gear.teeth_flexspline))
  , health_(makeHealth(JointNames(twin.parameters().joint.name)))
  , indicators_(makeIndicators(JointNames(twin.parameters().joint.name)))
  , assessment_(makeAssessment(JointNames(twin.parameters().joint.name)))
{
}

void BagRecorder::record(Twin& twin)
{
  const JointOutputs& outputs = twin.outputs();
  const Stamp stamp = outputs.stamp;
  if (const FaultList& faults = twin.activeFaults(); faults.version() != recorded_faults_)
  {
    recorded_faults_ = faults.version();
    bag_.write(prefix_ + topics::FAULTS, stamp, makeFaults(names_, stamp, faults));
  }
  const bool joint_states = schedule_.isDue(Output::JOINT_STATES, stamp);
  const bool encoders = schedule_.isDue(Output::ENCODERS, stamp);
  if (joint_states || encoders)
  {
    const EncoderReadings readings = twin.encoders();
    if (joint_states)
    {
      fillJointStates(outputs, readings, joint_states_);
      bag_.write(prefix_ + topics::JOINT_STATES, stamp, joint_states_);
    }
    if (encoders)
    {
      fillEncoders(outputs, readings, encoders_);
      bag_.write(prefix_ + topics::ENCODERS, stamp, encoders_);
    }
  }
  if (schedule_.isDue(Output::CONTACT_FORCES, stamp) && twin.toothForces(tooth_forces_))
  {
    fillContactForces(outputs, tooth_forces_, contact_forces_);
    bag_.write(prefix_ + topics::CONTACT_FORCES, stamp, contact_forces_);
  }
  if (schedule_.isDue(Output::HEALTH, stamp))
  {
    fillHealth(twin, health_since_, health_);
    health_since_ = stamp;
    bag_.write(prefix_ + topics::HEALTH, stamp, health_);
  }
  if (twin.watchesSignals() && schedule_.isDue(Output::INDICATORS, stamp))
  {
    fillIndicators(stamp, twin.signalIndicators(), indicators_);
    bag_.write(prefix_ + topics::INDICATORS, stamp, indicators_);
    fillAssessment(stamp, twin.assessment(), assessment_);
    bag_.write(prefix_ + topics::ASSESSMENT, stamp, assessment_);
  }
}
}  // namespace hjt
