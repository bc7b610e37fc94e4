// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_assessment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "arm/load_fit.hpp"

namespace hjt
{
namespace
{
/// Where no joint has a reference of its own, and the controller's is that of sound joints.
void holdAgainstController(const std::vector<AssessedJoint*>& joints)
{
  std::vector<const JointEvidence*> evidences;
  for (const AssessedJoint* joint : joints)
  {
    if (joint->hasReference())
    {
      return;
    }
    evidences.push_back(&joint->evidence());
  }
  if (controllerIsReference(evidences))
  {
    for (AssessedJoint* joint : joints)
    {
      joint->holdAgainstController();
    }
  }
}

/// Of samples that come by joints: all of one time at once.
class LoadCollector
{
public:
  explicit LoadCollector(const ArmRecording& recording)
    : fit_(recording.arm(), gainsOf(recording)), waiting_(recording.joints().size())
  {
  }

  void add(std::size_t joint, const MotionSample& sample, const JointEvidence& evidence)
  {
    waiting_[joint].push_back({ sample, evidence.predicted().current, evidence.isTouched() });
    while (std::none_of(waiting_.begin(), waiting_.end(), [](const std::deque<Row>& rows) { return rows.empty(); }))
    {
      samples_.clear();
      predicted_.clear();
      bool is_touched = false;
      for (std::deque<Row>& rows : waiting_)
      {
        samples_.push_back(rows.front().sample);
        predicted_.push_back(rows.front().predicted);
        is_touched = is_touched || rows.front().is_touched;
        rows.pop_front();
      }
      fit_.add(samples_, predicted_, is_touched);
    }
  }

  FoundLoad solve() { return fit_.solve(); }

private:
  struct Row
  {
    MotionSample sample;
    double predicted{};  // [A]
    bool is_touched{};
  };

  static std::vector<double> gainsOf(const ArmRecording& recording)
  {
    std::vector<double> gains;
    for (const Parameters& parameters : recording.parameters())
    {
      gains.push_back(parameters.telemetry.torque_per_current);
    }
    return gains;
  }

  LoadFit fit_;
  std::vector<std::deque<Row>> waiting_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;
};

ArmAssessment pass(const ArmRecording& recording, const AssessmentSettings& settings, bool gives_notice,
                   RecordingFit& fit)
{
  ArmAssessment arm;
  arm.joints = settings.make_joints();
  std::optional<LoadCollector> load;
  if (recording.isArm() && !recording.usesRecordedLoad())
  {
    load.emplace(recording);
  }
  fit = RecordingFit(recording.parameters());
  StreamTiming timing;
  arm.found = recording.readSamples(
      [&](std::size_t i, const MotionSample& sample)
      {
        if (i == 0)
        {
          timing.add(sample.time, sample.received);
        }
        arm.joints[i]->update(sample);
        if (load)
        {
          load->add(i, sample, arm.joints[i]->evidence());
        }
      },
      fit);
  arm.timing = timing.report();
  if (gives_notice)
  {
    recording.noticeOf(arm.found);
  }
  arm.misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ arm.found.misfit };
  if (settings.beside_controller)
  {
    holdAgainstController(arm.joints);
  }
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    frictions.push_back(arm.joints[i]->friction(arm.misfits[i]));
  }
  arm.friction = commonFriction(frictions, recording.parameters(0).comparison.repeat_tolerance);
  for (Misfit& misfit : arm.misfits)
  {
    misfit = misfitOf(misfit, arm.friction.misfit);
  }
  if (load && !settings.watch.stopped())
  {
    arm.load = load->solve();
  }
  return arm;
}

/// Of the currents less what is predicted, as torques of all joints, rms [N.m].
double residualTorque(const ArmAssessment& arm)
{
  double squares = 0.0;
  for (const AssessedJoint* joint : arm.joints)
  {
    squares += std::pow(joint->parameters().telemetry.torque_per_current * joint->evidence().residualRms(), 2);
  }
  return std::sqrt(squares);
}

/// Angles, stamps and efforts are in order, and no joint's friction is one that no drive has. The load may be another.
bool fits(const ArmAssessment& arm)
{
  return std::none_of(arm.misfits.begin(), arm.misfits.end(),
                      [](const Misfit& misfit) { return misfit.exists() && misfit.reason != Reason::LOAD_WRONG; });
}

/// Another load is the reason only if every joint fits with it.
bool isExplained(const ArmAssessment& with)
{
  return std::none_of(with.misfits.begin(), with.misfits.end(), [](const Misfit& misfit) { return misfit.exists(); }) &&
         std::all_of(with.joints.begin(), with.joints.end(),
                     [](const AssessedJoint* joint)
                     { return !joint->friction({}).is_below_faults && joint->frictionReason() != Reason::LOAD_WRONG; });
}

/// The load that the pass shows in place of the one that it assumed; none: it stands.
bool takeOther(const ArmAssessment& arm, ArmRecording& recording, AssumedLoad& assumed)
{
  if (!arm.load)
  {
    return false;
  }
  if (arm.load->showsMounting() && !assumed.mounting)
  {
    assumed.mounting = arm.load->mounting;
    recording.setGravity(assumed.mounting->gravity);
    return true;
  }
  // A payload explains no telemetry that does not fit, nor an arm led by hand.
  if (arm.load->payload.isCarried() && !assumed.payload && fits(arm))
  {
    assumed.payload = arm.load->payload;
    recording.setPayload(assumed.payload->payload());
    return true;
  }
  return false;
}
}  // namespace

std::string AssumedLoad::text() const
{
  std::string text = mounting ? sentence(mounting->text()) + " " : std::string();
  text += payload ? sentence(payload->text()) + " " : std::string();
  return text + (mounting || payload ? "The joints are judged with it. " : "");
}

ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit)
{
  ArmAssessment arm = pass(recording, settings, settings.gives_notice, fit);
  const double before = residualTorque(arm);
  const double share_of_gain = arm.load ? arm.load->share_of_gain : 1.0;
  AssumedLoad tried;
  AssumedLoad explained;
  const Payload payload = recording.arm().payload;
  const std::array<double, 3> gravity = recording.arm().gravity;
  bool is_explained = true;
  while (!settings.watch.stopped() && takeOther(arm, recording, tried))
  {
    arm = pass(recording, settings, false, fit);
    // As long as the mounting is another most rows look touched, and count for nothing.
    // Where the friction of the whole arm is another with it, one multiple of all currents is no worse a reason.
    is_explained = isExplained(arm) && (tried.mounting || residualTorque(arm) < FoundLoad::CLEARLY * before) &&
                   (arm.friction.median == 1.0 || !tried.payload || tried.payload->residual_share < share_of_gain);
    explained = is_explained ? tried : explained;
  }
  if (!is_explained)
  {
    recording.setPayload(explained.payload ? explained.payload->payload() : payload);
    recording.setGravity(explained.mounting ? explained.mounting->gravity : gravity);
    arm = pass(recording, settings, false, fit);
  }
  arm.assumed = explained;
  return arm;
}
}  // namespace hjt
