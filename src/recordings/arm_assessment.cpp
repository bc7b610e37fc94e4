// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/arm_assessment.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "arm/arm_configuration.hpp"
#include "arm/load_fit.hpp"

namespace hjt
{
namespace
{
/// Part of an arm's ArmFit::cost that follows from the gains that the recording states [-]. These gains and the known
/// gains of a type of joint are exact, so gains of a few joints show the type of the arm.
double costOfGains(const ArmRecording& recording, const RecordingOptions& options)
{
  constexpr double KNOWN = 0.01;  // standard deviation of the logarithm of a gain [-]
  constexpr double MOST = 10.0;   // largest cost of one joint, because the gain of its type may be unknown [-]
  double cost = 0.0;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const double stated = recording.statedGains()[i];
    if (std::isfinite(stated))
    {
      const double type = parseParameters(armJointParameters(recording.joints()[i], configDirectory(options), ""))
                              .telemetry.torque_per_current;
      cost += std::min(0.5 * std::pow(std::log(std::abs(stated) / type) / KNOWN, 2), MOST);
    }
  }
  return cost;
}

/// Compares the friction of the joints with the friction that the controller expects, if no joint has a reference of
/// its own and the controller expects the friction of sound joints.
void holdAgainstController(const AssessedJoints& joints)
{
  std::vector<const JointEvidence*> evidences;
  for (const auto& joint : joints)
  {
    if (joint->hasReference())
    {
      return;
    }
    evidences.push_back(&joint->evidence());
  }
  if (controllerIsReference(evidences))
  {
    for (const auto& joint : joints)
    {
      joint->holdAgainstController();
    }
  }
}

/// The drives of the joints, each with its expected friction.
std::vector<LoadFit::Drive> drivesOf(const std::vector<Parameters>& parameters, const AssessedJoints& joints)
{
  std::vector<LoadFit::Drive> drives(parameters.begin(), parameters.end());
  for (std::size_t i = 0; i < drives.size(); ++i)
  {
    drives[i].setOwn(joints[i]->hasReference(), joints[i]->own().friction);
  }
  return drives;
}

/// Reads the recording once and judges its joints. If `looks_for_load`, also finds the load that the currents show.
ArmAssessment pass(const ArmRecording& recording, const AssessmentSettings& settings, bool looks_for_load,
                   bool gives_notice, RecordingFit& fit)
{
  ArmAssessment arm;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    arm.joints.push_back(settings.make_joint ?
                             settings.make_joint(i) :
                             std::make_unique<AssessedJoint>(recording.parameters(i), recording.loadOrigin(),
                                                             SoundJoint(), !recording.options().identified.empty()));
  }
  std::optional<LoadFit> load;
  std::vector<MotionSample> samples(arm.joints.size());
  if (looks_for_load)
  {
    load.emplace(recording.arm(), drivesOf(recording.parameters(), arm.joints));
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
        if (load && i + 1 == samples.size())  // samples of the same time come in the order of the joints
        {
          load->add(samples,
                    [&](std::size_t joint) -> const MotionDriven& { return arm.joints[joint]->evidence().twin(); });
        }
      },
      fit);
  arm.timing = timing.report();
  if (gives_notice)
  {
    recording.noticeOf(arm.found);
  }
  std::vector<Misfit> misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ arm.found.misfit };
  if (load && !recording.options().watch.stopped())
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

/// If another shipped arm with the same joints explains the recording so much better that the given arm must be wrong,
/// adds the name of the other arm to the misfits. Does nothing if the given arm is a file of the user's own.
void nameOther(const ArmRecording& recording, std::vector<Misfit>& misfits)
{
  if (!mayBeOtherArm(misfits))
  {
    return;
  }
  const RecordingOptions& options = recording.options();
  const std::vector<std::string> names = armsLike(recording.arm(), configDirectory(options));
  const std::string name = mainName(options.arm, configDirectory(options));
  const std::string other =
      betterArm(name, names, [&](const std::vector<std::string>& of) { return rankArms(options, of); });
  if (!other.empty())
  {
    nameOtherArm(other, misfits);
  }
}
}  // namespace

std::vector<ArmFit> rankArms(const RecordingOptions& options, const std::vector<std::string>& names)
{
  RecordingOptions own = options;
  own.load = LOAD_OF_ARM;
  if (own.rows)
  {
    own.assignments.emplace_back("telemetry.effort=current");  // rows in memory hold currents as efforts
  }
  std::vector<ArmCandidate> candidates;
  std::unique_ptr<const ArmRecording> first;  // all candidates use its rows
  std::vector<std::string> others;            // arms with other names of joints, and so with other rows
  for (const std::string& name : names)
  {
    own.arm = name;
    auto recording = std::make_unique<const ArmRecording>(own);
    if (!candidates.empty() && jointNames(recording->arm()) != jointNames(candidates.front().arm))
    {
      others.push_back(name);
      continue;
    }
    candidates.push_back({ name, recording->arm(), recording->parameters(), costOfGains(*recording, own) });
    if (!first)
    {
      first = std::move(recording);
    }
  }
  ParameterMap given;
  addOverlays(own, given);
  const auto play = [&](const VisitArmRows& visit)
  {
    first->readRows(
        [&](const std::vector<MotionRow>& rows)
        {
          visit(rows);
          return rows.front().time < ArmFit::ENOUGH;
        });
  };
  std::vector<ArmFit> fits = rankArms(candidates, play, given.count("telemetry.effort") > 0);
  if (!others.empty())
  {
    const std::vector<ArmFit> more = rankArms(options, others);
    fits.insert(fits.end(), more.begin(), more.end());
    std::stable_sort(fits.begin(), fits.end());
  }
  return fits;
}

ArmAssessment assess(ArmRecording& recording, const AssessmentSettings& settings, RecordingFit& fit)
{
  const ArmDescription configured = recording.arm();
  const bool shows_load = recording.isArm() && !recording.usesRecordedLoad();
  LoadLaw law;
  ArmAssessment arm = pass(recording, settings, shows_load, settings.gives_notice, fit);
  const std::vector<FittedFriction> frictions = arm.load ? arm.load->frictions : std::vector<FittedFriction>();
  while (shows_load && !recording.options().watch.stopped() && law.take(arm.load.value_or(FoundLoad()), arm.judged))
  {
    ArmDescription other = configured;
    law.counts().configure(other);
    recording.setLoad(std::move(other), law.counts().course(configured.payload));
    arm.joints.clear();  // closes the files that the next pass opens
    arm = pass(recording, settings, false, false, fit);
    if (!law.isTrying())
    {
      break;  // the tried load does not explain the currents, and another pass would find this load again
    }
  }
  arm.assumed = law.counts();
  arm.frictions = frictions;
  if (shows_load && settings.looks_for_arm && recording.options().identified.empty() &&
      !recording.options().watch.stopped())
  {
    nameOther(recording, arm.judged.misfits);
  }
  return arm;
}
}  // namespace hjt
