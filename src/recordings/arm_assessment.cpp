// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_assessment.hpp"

#include <algorithm>
#include <utility>

#include "arm/load_fit.hpp"
#include "recordings/recorded_ranking.hpp"

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

/// With the friction that each is held against.
std::vector<LoadFit::Drive> drivesOf(const std::vector<Parameters>& parameters,
                                     const std::vector<AssessedJoint*>& joints)
{
  std::vector<LoadFit::Drive> drives(parameters.begin(), parameters.end());
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    drives[i].setOwn(joints[i]->hasReference(), joints[i]->own().friction);
  }
  return drives;
}

/// `looks_for_load`: else it is what it counts as.
ArmAssessment pass(const ArmRecording& recording, const AssessmentSettings& settings, bool looks_for_load,
                   bool gives_notice, RecordingFit& fit)
{
  ArmAssessment arm;
  arm.joints = settings.make_joints();
  std::optional<LoadFit> load;
  std::vector<MotionSample> samples(arm.joints.size());
  std::vector<const MotionDriven*> twins;
  if (looks_for_load)
  {
    load.emplace(recording.arm(), drivesOf(recording.parameters(), arm.joints));
    for (const AssessedJoint* joint : arm.joints)
    {
      twins.push_back(&joint->evidence().twin());
    }
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
        samples[i] = sample;
        if (load && i + 1 == samples.size())  // rows of one time come one after the other
        {
          load->add(samples, twins);
        }
      },
      fit);
  arm.timing = timing.report();
  if (gives_notice)
  {
    recording.noticeOf(arm.found);
  }
  std::vector<Misfit> misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ arm.found.misfit };
  if (load && !settings.watch.stopped())
  {
    arm.load = load->solve(fit.measured());
    addMisfit(arm.load->misfit(), misfits);
  }
  if (settings.beside_controller)
  {
    holdAgainstController(arm.joints);
  }
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    frictions.push_back(arm.joints[i]->friction(misfits[i]));
  }
  arm.judged = JudgedJoints(fit, misfits, std::move(frictions), recording.parameters(0).comparison.repeat_tolerance);
  return arm;
}

/// Where another arm is clearly likelier.
void nameOther(const ArmRecording& recording, std::vector<Misfit>& misfits)
{
  const std::string other = mayBeOtherArm(misfits) ? betterArm(recording) : std::string();
  if (!other.empty())
  {
    nameOtherArm(other, misfits);
  }
}
}  // namespace

ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit)
{
  const ArmDescription configured = recording.arm();
  const bool shows_load = recording.isArm() && !recording.usesRecordedLoad();
  LoadLaw law;
  ArmAssessment arm = pass(recording, settings, shows_load, settings.gives_notice, fit);
  const std::vector<FittedFriction> frictions = arm.load ? arm.load->frictions : std::vector<FittedFriction>();
  while (shows_load && !settings.watch.stopped() && law.take(arm.load.value_or(FoundLoad()), arm.judged))
  {
    ArmDescription other = configured;
    law.counts().configure(other);
    recording.setPayload(other.payload, law.counts().course(configured.payload));
    recording.setGravity(other.gravity);
    recording.setDrag(other.drag);
    arm = pass(recording, settings, false, false, fit);
    if (!law.isTrying())
    {
      break;  // taken back: it would be found again
    }
  }
  arm.assumed = law.counts();
  arm.frictions = frictions;
  if (shows_load && settings.looks_for_arm && recording.options().identified.empty() && !settings.watch.stopped())
  {
    nameOther(recording, arm.judged.misfits);
  }
  return arm;
}
}  // namespace hjt
