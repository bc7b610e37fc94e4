// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/recording_check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>

#include "arm/arm_configuration.hpp"
#include "bags/recorded_messages.hpp"
#include "base/csv_table.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "recordings/arm_assessment.hpp"
#include "recordings/controller_table.hpp"
#include "tracking/joint_evidence.hpp"
#include "tracking/motion_driven.hpp"
#include "tracking/verdict.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

CheckedContents readTableContents(const MotionSource& source)
{
  CheckedContents contents;
  contents.is_csv = true;
  const std::string temperatures = "joint_temperatures_";
  const CsvRows table(source.path);
  if (const std::string foreign = foreignTable(table.header()); !foreign.empty())
  {
    throw InputError(source.path + ": " + foreign);
  }
  for (const std::string& name : table.header())
  {
    contents.temperature =
        name.compare(0, temperatures.size(), temperatures) == 0 ? temperatures + "N" : contents.temperature;
  }
  return contents;
}

CheckedContents contentsOf(const std::vector<std::vector<MotionRow>>& rows)
{
  CheckedContents contents;
  contents.is_csv = true;
  const bool has_temperature =
      std::any_of(rows.begin(), rows.end(),
                  [](const std::vector<MotionRow>& joints)
                  {
                    return std::any_of(joints.begin(), joints.end(),
                                       [](const MotionRow& row) { return std::isfinite(row.temperature); });
                  });
  contents.temperature = has_temperature ? "temperature" : "";
  return contents;
}

/// @throws InputError if all names of joints are empty, or if all end with the name of a quantity, such as position.
void requireNames(const std::string& topic, const std::vector<std::string>& names)
{
  const auto all = [&](const auto& is) { return !names.empty() && std::all_of(names.begin(), names.end(), is); };
  if (all([](const std::string& name) { return name.empty(); }))
  {
    throw InputError(
        topic + ": the joints have no names (each name is empty), so it is not known which joint a value belongs to");
  }
  const auto names_quantity = [](const std::string& name)
  {
    const std::string quantity = name.substr(name.rfind('/') + 1);
    return quantity != name && (quantity == "position" || quantity == "velocity" || quantity == "effort");
  };
  if (all(names_quantity))
  {
    throw InputError(
        topic + ": the names of the joints end with a quantity (" + names.front() +
        "); a message has to name each joint once, with its position, velocity and effort in these fields");
  }
}

CheckedContents readMessageContents(const MotionSource& source)
{
  constexpr int MESSAGES = 1000;  // number of messages within which every publisher of the topic publishes
  CheckedContents contents;
  const std::unique_ptr<RecordedMessages> recording = RecordedMessages::open(source.path);
  recording->requireStates(source.topic);
  for (const auto& [name, topic] : recording->topics())
  {
    contents.temperature = topic.type == TEMPERATURE_TYPE ? name : contents.temperature;
  }
  int read = 0;
  recording->visit(
      { source.topic }, false,
      [&](const RecordedMessage& message)
      {
        if (message.state == nullptr)
        {
          return true;
        }
        const sensor_msgs::JointState& state = *message.state;
        contents.has_angles = contents.has_angles || !state.position.empty();
        for (std::size_t i = 0; i < state.name.size(); ++i)
        {
          if (!holds(contents.named, state.name[i]))
          {
            contents.named.push_back(state.name[i]);
          }
          if (i < std::min(state.position.size(), state.effort.size()) && !holds(contents.usable, state.name[i]))
          {
            contents.usable.push_back(state.name[i]);
          }
        }
        // A joint's effort may first appear in a later message than its angle.
        return ++read < MESSAGES || contents.usable.size() < contents.named.size();
      },
      [](double) {});
  requireNames(source.topic, contents.named);
  contents.named = withoutMotors(contents.named);
  contents.usable = withoutMotors(contents.usable);
  return contents;
}

/// Sorts the joints of an incomplete arm into usable and missing joints.
void takeParts(const std::vector<std::string>& names, const CheckedContents& contents, CheckedArm& arm)
{
  for (const std::string& name : names)
  {
    (holds(contents.usable, arm.affixes(name)) ? arm.joints_at_hand : arm.missing).push_back(arm.affixes(name));
  }
}

CheckedArm withoutArm(const std::vector<fs::path>& files, const CheckedContents& contents)
{
  CheckedArm none;
  for (const fs::path& file : files)
  {
    const std::vector<std::string> names = jointNames(readArmDescription(file.string()));
    const auto at_hand =
        std::count_if(names.begin(), names.end(), [&](const std::string& name) { return holds(contents.named, name); });
    if (2 * static_cast<std::size_t>(at_hand) > names.size())
    {
      takeParts(names, contents, none);
      return none;
    }
  }
  none.joints_at_hand = contents.usable;
  return none;
}

/// Prefixes and suffixes that the recording may use in the joint names of an arm.
std::vector<JointAffixes> affixesOf(const ArmDescription& arm, const RecordingOptions& options,
                                    const CheckedContents& contents)
{
  return contents.is_csv || !options.affixes.empty() ? std::vector<JointAffixes>{ options.affixes } :
                                                       findAffixes(jointNames(arm), contents.named);
}

bool namesAll(const CheckedContents& contents, const std::vector<std::string>& names, const JointAffixes& affixes)
{
  return contents.is_csv || std::all_of(names.begin(), names.end(),
                                        [&](const std::string& name) { return holds(contents.named, affixes(name)); });
}

CheckedArm armWith(const JointAffixes& affixes)
{
  CheckedArm arm;
  arm.affixes = affixes;
  return arm;
}

/// Arms of the configuration whose joints the recording has, with one entry for each pair of prefix and suffix.
std::vector<CheckedArm> armsOfConfiguration(const std::vector<fs::path>& files, const RecordingOptions& options,
                                            const CheckedContents& contents)
{
  std::vector<CheckedArm> arms;
  for (const fs::path& file : files)
  {
    const ArmDescription description = readArmDescription(file.string());
    for (const JointAffixes& affixes : affixesOf(description, options, contents))
    {
      const bool has_all = options.rows ? options.rows->front().size() == description.joints.size() :
                                          namesAll(contents, jointNames(description), affixes);
      if (!has_all)
      {
        continue;
      }
      auto arm = std::find_if(arms.begin(), arms.end(), [&](const CheckedArm& one) { return one.affixes == affixes; });
      if (arm == arms.end())
      {
        arm = arms.insert(arms.end(), armWith(affixes));
      }
      arm->fitting.push_back(file.stem().string());
    }
  }
  return arms;
}

/// The arm that the options name, one entry for each pair of prefix and suffix. `known`: arms of the configuration.
std::vector<CheckedArm> armsGiven(const std::vector<CheckedArm>& known, const RecordingOptions& options,
                                  const CheckedContents& contents)
{
  const ArmDescription given = readArmDescription(findArm(options.arm, configDirectory(options)));
  std::vector<CheckedArm> arms;
  for (const JointAffixes& affixes : affixesOf(given, options, contents))
  {
    const auto same =
        std::find_if(known.begin(), known.end(), [&](const CheckedArm& one) { return one.affixes == affixes; });
    arms.push_back(same == known.end() ? armWith(affixes) : *same);
    arms.back().taken = options.arm;
  }
  if (arms.empty())
  {
    arms.emplace_back();
    takeParts(jointNames(given), contents, arms.back());
  }
  return arms;
}

/// Removes an arm if a joint lacks angle or effort, because the recording cannot be read as that arm.
void leaveOutIncomplete(const RecordingOptions& options, const CheckedContents& contents, CheckedArm& arm)
{
  const std::string name = arm.taken.empty() ? (arm.fitting.empty() ? "" : arm.fitting.front()) : arm.taken;
  if (name.empty() || contents.is_csv)
  {
    return;
  }
  takeParts(jointNames(readArmDescription(findArm(name, configDirectory(options)))), contents, arm);
  if (!arm.missing.empty())
  {
    arm.taken.clear();
    arm.fitting.clear();
  }
}

/// Finds the recording's joints and its source of temperatures. @throws InputError if the recording cannot be read.
CheckedContents readCheckedContents(const MotionSource& source)
{
  return source.rows   ? contentsOf(*source.rows) :
         isCsv(source) ? readTableContents(source) :
                         readMessageContents(source);
}

/// Finds the arm of the options or, without that option, the arms whose joints the recording names. The result has one
/// entry for each pair of prefix and suffix; if no arm fits, it has one entry without an arm. `ranked` is empty;
/// `taken` is set only if the options name the arm. @throws InputError, ParameterError.
std::vector<CheckedArm> findArms(const RecordingOptions& options, const CheckedContents& contents)
{
  const std::vector<fs::path> files = armFiles(configDirectory(options));
  std::vector<CheckedArm> arms = armsOfConfiguration(files, options, contents);
  if (!options.arm.empty())
  {
    arms = armsGiven(arms, options, contents);
  }
  if (arms.empty() && options.rows)
  {
    throw InputError(
        options.recording + " has " + std::to_string(options.rows->front().size()) +
        " joints, but no arm in config/arms has this number of joints. Give the file of your own arm (docs/arm.md)");
  }
  if (arms.empty())
  {
    arms.push_back(withoutArm(files, contents));
  }
  for (CheckedArm& arm : arms)
  {
    leaveOutIncomplete(options, contents, arm);
  }
  return arms;
}

/// Arm that the joints are judged with if no arm explains the currents clearly better than the other arms.
constexpr const char* DEFAULT_ARM = "ur5";

RecordingOptions optionsFor(const RecordingOptions& options, const CheckedArm& arm, const std::string& name)
{
  RecordingOptions own = options;
  own.arm = name;
  own.load = LOAD_OF_ARM;
  own.affixes = arm.affixes;
  return own;
}

/// The best arm of the ranking if it is clearly likelier than the default arm, else the default arm.
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

/// Gives each joint the samples that its differentiator has ready.
void addReady(std::vector<MotionDifferentiator>& joints, bool at_end, AssessedJoints& twins)
{
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    while (const std::optional<MotionSample> sample = joints[i].pop(at_end))
    {
      twins[i]->update(*sample);
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
  AssessmentSettings settings;
  settings.looks_for_arm = arm.ranked.empty();
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
    arm.joints[i].verdict = judge(assessment.joints[i]->evidence(), assessment.context(i));
  }
}

/// Misfit of joints that are not a whole arm.
Misfit misfitOfParts(const CheckedArm& arm)
{
  if (arm.found.misfit.exists() || arm.missing.empty())
  {
    return arm.found.misfit;
  }
  return { Reason::LOAD_UNKNOWN,
           "the load of an arm depends on the angles of all its joints, but the recording has no angle or effort of " +
               joined(arm.missing) };
}

/// Judges each joint after division of its friction by the common factor of the joints.
void judgeJoints(const AssessedJoints& twins, const RecordingFit& fit, const std::vector<Parameters>& parameters,
                 CheckedArm& arm)
{
  takeFit(fit, parameters, arm);
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    frictions.push_back(twins[i]->friction(arm.joints[i].misfit));
  }
  const ArmFriction common = commonFriction(frictions, parameters.front().comparison.repeat_tolerance);
  for (std::size_t i = 0; i < arm.joints.size(); ++i)
  {
    CheckedJoint& joint = arm.joints[i];
    const Misfit& misfit = misfitOf(joint.misfit, common.misfit);
    joint.verdict = judge(twins[i]->evidence(), twins[i]->context(misfit, common.factors[i], common.deviations[i]));
  }
}

/// Reads all usable joints without an arm. Each joint has the load that is configured for a single joint.
void readJoints(const RecordingOptions& options, CheckedArm& arm)
{
  const std::vector<std::string>& names = arm.joints_at_hand;
  const std::vector<Parameters> parameters(names.size(), loadParameters(options));
  const MotionDriven twin(parameters.front());
  StreamTiming timing;
  RecordingFit fit(parameters);
  AssessedJoints twins;
  for (const Parameters& of : parameters)
  {
    twins.push_back(std::make_unique<AssessedJoint>(of, LoadOrigin::CONFIGURED, SoundJoint(), false));
  }
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
  static_cast<MotionCount&>(arm.found) = readMotion(
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

/// Text of the factor with the fewest digits at which rounding changes it by at most 1 % or three uncertainties.
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

/// Reads the recording again with a change that may correct one of its findings. Stores the change and its effect.
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
  // A change of the time scale changes only the torque of inertia, which may be a small part of the load.
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
