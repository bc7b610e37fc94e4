// SPDX-License-Identifier: BSD-3-Clause
#include "ros_io/output_publishers.hpp"

#include <chrono>
#include <limits>
#include <sstream>

#include "ros_io/topics.hpp"

namespace hjt
{
namespace
{
using std::chrono::milliseconds;

/// Between two looks at the rings: well under the shortest publish period in use.
constexpr milliseconds DRAIN_PERIOD{ 1 };
/// How long a new subscriber may go unnoticed, in drain periods.
constexpr int HEARD_REFRESH = 5;
/// Slots for messages of a few numbers: seconds of joint states at 1 kHz.
constexpr std::size_t SMALL_MESSAGE_SLOTS = 4096;
/// Slots for messages with per-tooth arrays.
constexpr std::size_t LARGE_MESSAGE_SLOTS = 256;
/// Slots for lists of faults: one more change has to wait for the next instant.
constexpr std::size_t FAULT_SLOTS = 16;
}  // namespace

OutputPublishers::OutputPublishers(ros::NodeHandle& node, const Twin& twin)
  : schedule_(twin.parameters())
  , tooth_forces_(twin.makeToothForces())
  , joint_states_(node, topics::JOINT_STATES, SMALL_MESSAGE_SLOTS,
                  makeJointStates(JointNames(twin.parameters().joint.name)))
  , encoders_(node, topics::ENCODERS, SMALL_MESSAGE_SLOTS, makeEncoders(JointNames(twin.parameters().joint.name)))
  , contact_forces_(
        node, topics::CONTACT_FORCES, LARGE_MESSAGE_SLOTS,
        makeContactForces(JointNames(twin.parameters().joint.name), twin.parameters().gear.teeth_flexspline))
  , health_(node, topics::HEALTH, SMALL_MESSAGE_SLOTS, makeHealth(JointNames(twin.parameters().joint.name)))
  , indicators_(node, topics::INDICATORS, LARGE_MESSAGE_SLOTS, makeIndicators(JointNames(twin.parameters().joint.name)))
  , assessment_(node, topics::ASSESSMENT, LARGE_MESSAGE_SLOTS, makeAssessment(JointNames(twin.parameters().joint.name)))
  , names_(twin.parameters().joint.name)
  , faults_(FAULT_SLOTS, {})
  , faults_publisher_(node.advertise<harmonic_joint_twin::Faults>(topics::FAULTS, 1, true))
  , offered_faults_(std::numeric_limits<std::uint64_t>::max())
  , thread_([this] { run(); })
{
}

OutputPublishers::~OutputPublishers()
{
  stopping_ = true;
  thread_.join();
}

bool OutputPublishers::isWanted(Output output, bool heard, Stamp instant) const noexcept
{
  return heard && schedule_.isDue(output, instant);
}

void OutputPublishers::offer(Twin& twin) noexcept
{
  offerFaults(twin);
  const JointOutputs& outputs = twin.outputs();
  const bool joint_states = isWanted(Output::JOINT_STATES, joint_states_.isHeard(), outputs.stamp);
  const bool encoders = isWanted(Output::ENCODERS, encoders_.isHeard(), outputs.stamp);
  if (joint_states || encoders)
  {
    const EncoderReadings readings = twin.encoders();
    if (joint_states)
    {
      joint_states_.write([&](auto& message) { fillJointStates(outputs, readings, message); });
    }
    if (encoders)
    {
      encoders_.write([&](auto& message) { fillEncoders(outputs, readings, message); });
    }
  }
  if (isWanted(Output::CONTACT_FORCES, contact_forces_.isHeard(), outputs.stamp) && twin.toothForces(tooth_forces_))
  {
    contact_forces_.write([&](auto& message) { fillContactForces(outputs, tooth_forces_, message); });
  }
  if (isWanted(Output::HEALTH, health_.isHeard(), outputs.stamp))
  {
    health_.write(
        [&](auto& message)
        {
          fillHealth(twin, health_since_, message);
          health_since_ = outputs.stamp;
        });
  }
  if (isWanted(Output::INDICATORS, indicators_.isHeard(), outputs.stamp))
  {
    indicators_.write([&](auto& message) { fillIndicators(outputs.stamp, twin.signalIndicators(), message); });
  }
  if (isWanted(Output::ASSESSMENT, assessment_.isHeard(), outputs.stamp))
  {
    assessment_.write([&](auto& message) { fillAssessment(outputs.stamp, twin.assessment(), message); });
  }
}

/// The list of faults, once after each change.
void OutputPublishers::offerFaults(const Twin& twin) noexcept
{
  const FaultList& faults = twin.activeFaults();
  if (faults.version() == offered_faults_)
  {
    return;
  }
  if (FaultsAt* slot = faults_.claim())
  {
    slot->stamp = twin.stamp();
    slot->faults = faults;
    faults_.commit();
    offered_faults_ = faults.version();
  }
}

void OutputPublishers::drainFaults()
{
  for (const FaultsAt* at = faults_.front(); at != nullptr; at = faults_.front())
  {
    const harmonic_joint_twin::Faults message = makeFaults(names_, at->stamp, at->faults);
    faults_.pop();
    faults_publisher_.publish(message);
    std::ostringstream text;
    for (const harmonic_joint_twin::Fault& fault : message.faults)
    {
      text << (text.tellp() > 0 ? ", " : "") << fault.kind << ' ' << fault.severity << " at " << fault.place;
    }
    const std::lock_guard<std::mutex> lock(text_mutex_);
    active_faults_ = text.str();
  }
}

std::string OutputPublishers::activeFaults() const
{
  const std::lock_guard<std::mutex> lock(text_mutex_);
  return active_faults_;
}

std::array<ChannelCounters, OUTPUT_COUNT> OutputPublishers::counters() const noexcept
{
  return { joint_states_.counters(), encoders_.counters(),   contact_forces_.counters(),
           health_.counters(),       indicators_.counters(), assessment_.counters() };
}

void OutputPublishers::run()
{
  for (int round = 0; !stopping_;)
  {
    if (round == 0)
    {
      refreshHeard();
    }
    drain();
    // While nobody hears there is nothing to drain: only to see whether somebody comes.
    const bool heard = joint_states_.isHeard() || encoders_.isHeard() || contact_forces_.isHeard() ||
                       health_.isHeard() || indicators_.isHeard() || assessment_.isHeard();
    std::this_thread::sleep_for(heard ? DRAIN_PERIOD : HEARD_REFRESH * DRAIN_PERIOD);
    round = heard ? (round + 1) % HEARD_REFRESH : 0;
  }
  drain();
}

void OutputPublishers::refreshHeard()
{
  joint_states_.refreshHeard();
  encoders_.refreshHeard();
  contact_forces_.refreshHeard();
  health_.refreshHeard();
  indicators_.refreshHeard();
  assessment_.refreshHeard();
}

void OutputPublishers::drain()
{
  joint_states_.drain();
  encoders_.drain();
  contact_forces_.drain();
  health_.drain();
  indicators_.drain();
  assessment_.drain();
  drainFaults();
}
}  // namespace hjt
