// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_check.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "arm/arm_configuration.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/recorded_arms.hpp"
#include "recordings/recorded_ranking.hpp"
#include "recordings/stated_gains.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
/// Taken where no arm explains the currents clearly better than others.
constexpr const char* DEFAULT_ARM = "ur5";

RecordingOptions optionsFor(const RecordingOptions& options, const CheckedArm& arm, const std::string& name)
{
  RecordingOptions own = options;
  own.arm = name;
  own.load = LOAD_OF_ARM;
  own.affixes = arm.affixes;
  return own;
}

/// The best of the ranking where it is clearly better than the default.
std::string choice(const CheckedArm& arm)
{
  const auto preset =
      std::find_if(arm.ranked.begin(), arm.ranked.end(), [](const ArmFit& fit) { return fit.arm == DEFAULT_ARM; });
  const ArmFit& best = arm.ranked.front();
  return preset == arm.ranked.end() || best.isBetter(*preset, ArmFit::CLEARLY) ? best.arm : preset->arm;
}

void takeFit(const RecordingFit& fit, const std::vector<Parameters>& parameters, CheckedArm& arm)
{
  arm.stamps = fit.stampFactor();
  arm.effort = fit.effort();
  arm.configured_effort = parameters.front().telemetry.effort;
  arm.rest = fit.loadRest(arm.configured_effort);
  arm.temperature = parameters.front().input.temperature;
  arm.findings = fit.ofArm();
  const std::vector<Misfit> misfits = fit.whyNotJudged();
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    CheckedJoint& joint = arm.joints[i];
    joint.reach = fit.reach(i);
    joint.gain = parameters[i].telemetry.torque_per_current;
    joint.has_velocity = fit.hasVelocity(i);
    joint.time_factor = fit.timeFit(i).factor();
    joint.lag = fit.timeFit(i).lag();
    joint.findings = fit.ofJoint(i);
    joint.misfit = misfits[i];
  }
}

/// Samples that the differentiators of all joints have ready.
void addReady(std::vector<MotionDifferentiator>& joints, bool at_end, const AssessedTwins& twins)
{
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    while (const std::optional<MotionSample> sample = joints[i].pop(at_end))
    {
      twins[i].update(*sample);
    }
  }
}

void addJoint(const std::string& name, const std::string& in_messages, CheckedArm& arm)
{
  CheckedJoint& joint = arm.joints.emplace_back();
  joint.name = name;
  joint.joint = in_messages;
}

void readArm(const RecordingOptions& options, CheckedArm& arm)
{
  const RecordingOptions own = optionsFor(options, arm, arm.taken);
  ArmRecording recording(own);
  RecordingFit fit(recording.parameters());
  AssessedTwins twins;
  AssessmentSettings settings;
  settings.make_joints = [&]
  { return twins.make(recording.parameters(), recording.loadOrigin(), !options.identified.empty()); };
  settings.gives_notice = false;
  settings.looks_for_arm = arm.ranked.empty();
  settings.watch = options.watch;
  const ArmAssessment assessment = assess(recording, settings, fit);
  arm.found = assessment.found;
  arm.timing = assessment.timing;
  arm.assumed = assessment.assumed;
  arm.joints.clear();
  for (const ArmJoint& joint : recording.joints())
  {
    addJoint(joint.short_name, arm.affixes(joint.name), arm);
    arm.joints.back().stated_gain = recording.statedGains()[arm.joints.size() - 1];
  }
  takeFit(fit, recording.parameters(), arm);
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    arm.joints[i].verdict = judge(twins[i].evidence(), assessment.context(i));
  }
}

/// Of joints that are not a whole arm.
Misfit misfitOfParts(const CheckedArm& arm)
{
  if (arm.found.misfit.exists() || arm.missing.empty())
  {
    return arm.found.misfit;
  }
  return { Reason::LOAD_UNKNOWN,
           "an arm's load takes the angles of all its joints, and there is no angle or no effort of " +
               joined(arm.missing) };
}

/// Each joint after what the friction of all has in common.
void judgeJoints(const AssessedTwins& twins, const RecordingFit& fit, const std::vector<Parameters>& parameters,
                 CheckedArm& arm)
{
  takeFit(fit, parameters, arm);
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    frictions.push_back(twins[i].friction(arm.joints[i].misfit));
  }
  const ArmFriction common = commonFriction(frictions, parameters.front().comparison.repeat_tolerance);
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    CheckedJoint& joint = arm.joints[i];
    const Misfit& misfit = misfitOf(joint.misfit, common.misfit);
    joint.verdict = judge(twins[i].evidence(), twins[i].context(misfit, common.factors[i], common.deviations[i]));
  }
}

/// Reads all joints at hand without an arm: the load is what one joint is configured to carry.
void readJoints(const RecordingOptions& options, CheckedArm& arm)
{
  const std::vector<std::string>& names = arm.joints_at_hand;
  const std::vector<Parameters> parameters(names.size(), loadParameters(options));
  const MotionDriven twin(parameters.front());
  StreamTiming timing;
  RecordingFit fit(parameters);
  AssessedTwins twins;
  twins.make(parameters, LoadOrigin::CONFIGURED, false);
  std::vector<MotionDifferentiator> differentiators(names.size(), MotionDifferentiator(ArmRates::HALF_WIDTH));
  std::vector<MotionDifferentiator> own(names.size());
  std::vector<MotionSample> samples(names.size());
  const std::vector<double> unknown(names.size(), std::nan(""));
  const auto forward = [&](bool at_end)
  {
    while (std::optional<MotionSample> first = differentiators[0].pop(at_end))
    {
      samples[0] = *first;
      for (std::size_t i = 1; i < names.size(); ++i)
      {
        samples[i] = differentiators[i].pop(at_end).value_or(samples[i]);
      }
      fit.update(samples, unknown);
      for (std::size_t i = 0; i < names.size(); ++i)
      {
        samples[i].load = twin.modelledLoad(samples[i]);
        own[i].push(samples[i]);
      }
    }
    addReady(own, at_end, twins);
  };
  static_cast<MotionCount&>(arm.found) = readArmMotion(
      motionSource(options), names,
      [&](const std::vector<MotionRow>& rows)
      {
        timing.add(rows.front().time, rows.front().received);
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          MotionRow row = rows[i];
          row.current *= currentPerEffort(parameters.front());
          differentiators[i].push(row);
        }
        forward(false);
        return !options.watch.stopped();
      },
      options.watch.progress("reading"));
  forward(true);
  arm.found.refused = differentiators[0].refused();
  arm.found.gaps = differentiators[0].gaps();
  arm.found.has_load = recordsLoad(motionSource(options));
  arm.timing = timing.report();
  for (const std::string& name : names)
  {
    addJoint(name, name, arm);
    arm.joints.back().stated_gain = std::nan("");
  }
  fit.refuse(misfitOfParts(arm));
  judgeJoints(twins, fit, parameters, arm);
}

bool hasFinding(const CheckedArm& arm, const std::string& kind)
{
  return std::any_of(arm.findings.begin(), arm.findings.end(),
                     [&](const RecordingFinding& finding) { return finding.kind == kind; });
}

/// A number that a person would write, within what is known of it.
std::string plainFactor(const FittedFactor& factor)
{
  int digits = 1;
  const double slack = std::max(0.01 * factor.value, 3.0 * factor.uncertainty);
  while (digits < 4 && std::abs(decimalNumber(roundedText(factor.value, digits)).value() - factor.value) > slack)
  {
    ++digits;
  }
  return roundedText(factor.value, digits);
}

/// Reads the recording again with what would mend its findings.
void tryRemedies(const RecordingOptions& options, CheckedArm& arm)
{
  RecordingOptions changed = options;
  TriedRemedy remedy;
  std::string kind;
  const double unit_of_time = likelyTimeScale(arm.timing.period);
  if (hasFinding(arm, "period") && unit_of_time < 1.0)
  {
    kind = "period";
    changed.time_scale = unit_of_time * options.time_scale;
    remedy.options = " --time-scale " + roundedText(changed.time_scale, 6);
  }
  else if (hasFinding(arm, "stamps"))
  {
    kind = "stamps";
    const std::string factor = plainFactor({ options.time_scale * arm.stamps.value, arm.stamps.uncertainty });
    changed.time_scale = *decimalNumber(factor);
    remedy.options = " --time-scale " + factor;
  }
  else if (hasFinding(arm, "effort_unit") && arm.effort.is_known)
  {
    kind = "effort_unit";
    const std::string assignment = std::string("telemetry.effort=") + effortKeyword(arm.effort.unit);
    changed.assignments.push_back(assignment);
    remedy.options = " --set " + assignment;
  }
  else
  {
    return;
  }
  CheckedArm mended = arm;
  mended.joints.clear();
  readArm(changed, mended);
  remedy.before = arm.rest.share();
  remedy.after = mended.rest.share();
  // Another time changes the inertia alone, which may be little of the load.
  constexpr double NOT_WORSE = 1.05;
  const double bound = kind == "effort_unit" ? 1.0 : NOT_WORSE;
  const bool is_left = hasFinding(mended, kind) || (kind == "period" && hasFinding(mended, "stamps"));
  remedy.helps = !is_left && (std::isfinite(remedy.before) ? remedy.after < bound * remedy.before : remedy.after < 1.0);
  arm.tried.push_back(remedy);
}
}  // namespace

bool CheckedArm::isUsable() const
{
  return std::any_of(joints.begin(), joints.end(), [](const CheckedJoint& joint) { return joint.verdict.isJudged(); });
}

std::vector<std::string> CheckedArm::alike() const
{
  const auto own = std::find_if(ranked.begin(), ranked.end(), [this](const ArmFit& fit) { return fit.arm == taken; });
  std::vector<std::string> names;
  for (const ArmFit& fit : ranked)
  {
    if (fit.arm != taken && fit.cost < own->cost + ArmFit::CLEARLY)
    {
      names.push_back(fit.arm);
    }
  }
  return names;
}

bool RecordingCheck::isUsable() const
{
  return std::any_of(arms.begin(), arms.end(), [](const CheckedArm& arm) { return arm.isUsable(); });
}

RecordingCheck checkRecording(const RecordingOptions& options)
{
  RecordingCheck check;
  check.options = options;
  const MotionSource source = motionSource(options);
  check.contents = readCheckedContents(source);
  check.arms = findArms(options, check.contents);
  RecordingOptions own = options;
  if (!options.rows && !check.arms.empty())
  {
    own.stated = std::make_shared<const RecordedStatements>(readStatements(source, true));
  }
  for (CheckedArm& arm : check.arms)
  {
    if (arm.taken.empty() && !arm.fitting.empty())
    {
      arm.ranked = rankArms(optionsFor(own, arm, ""), arm.fitting);
      arm.taken = choice(arm);
    }
    if (arm.taken.empty() && !arm.joints_at_hand.empty())
    {
      readJoints(options, arm);
    }
    else if (!arm.taken.empty())
    {
      readArm(own, arm);
      tryRemedies(own, arm);
    }
  }
  return check;
}
}  // namespace hjt
