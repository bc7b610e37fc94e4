// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_assessment.hpp"

#include <algorithm>
#include <utility>

#include "recordings/load_collector.hpp"
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

/// `part`: of the time, whose rows count.
ArmAssessment pass(const ArmRecording& recording, const AssessmentSettings& settings, const LoadPart& part,
                   bool gives_notice, RecordingFit& fit)
{
  ArmAssessment arm;
  arm.joints = settings.make_joints();
  std::optional<LoadCollector> load;
  if (recording.isArm() && !recording.usesRecordedLoad())
  {
    load.emplace(recording);
  }
  fit = RecordingFit(recording.parameters(), part);
  StreamTiming timing;
  arm.found = recording.readSamples(
      [&](std::size_t i, const MotionSample& sample)
      {
        if (i == 0)
        {
          timing.add(sample.time, sample.received);
        }
        if (!part.holds(sample.time))
        {
          return;
        }
        arm.joints[i]->update(sample);
        if (load)
        {
          const JointEvidence& evidence = arm.joints[i]->evidence();
          load->add(i, sample, evidence.predicted().current, evidence.isTouched());
        }
      },
      fit);
  arm.timing = timing.report();
  if (gives_notice)
  {
    recording.noticeOf(arm.found);
  }
  const std::vector<Misfit> misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ arm.found.misfit };
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
  if (load && !settings.watch.stopped())
  {
    arm.load = load->fit().solve(arm.judged.measured, LoadFit::Part::LONGEST);
  }
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
  LoadLaw law;
  ArmAssessment arm = pass(recording, settings, {}, settings.gives_notice, fit);
  while (arm.load && !settings.watch.stopped() && law.take(*arm.load, arm.judged))
  {
    ArmDescription other = configured;
    law.counts().configure(other);
    recording.setPayload(other.payload);
    recording.setGravity(other.gravity);
    arm = pass(recording, settings, law.counts().part, false, fit);
    if (!law.isTrying())
    {
      break;  // taken back: it would be found again
    }
  }
  arm.assumed = law.counts();
  if (arm.load && settings.looks_for_arm && recording.options().identified.empty() && !settings.watch.stopped())
  {
    nameOther(recording, arm.judged.misfits);
  }
  return arm;
}
}  // namespace hjt
