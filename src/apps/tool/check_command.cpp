// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "apps/common/arm_recording.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/json.hpp"
#include "output/progress.hpp"
#include "output/text_table.hpp"

#include "arm/arm_configuration.hpp"
#include "bags/bag_file.hpp"
#include "bags/checked_message.hpp"
#include "base/joined.hpp"
#include "base/number_text.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "tracking/effort.hpp"
#include "tracking/stream_timing.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

/// Taken where the joints' names leave the choice: a recording does not say which of a maker's arms it is of.
constexpr const char* DEFAULT_ARM = "ur5";

/// What a recording holds, by its first messages or its header.
struct Contents
{
  std::vector<std::string> named;   ///< joints in the messages
  std::vector<std::string> usable;  ///< those with angle and effort of the message that has most of them
  std::string temperature;          ///< topic or column; empty: none
  bool has_load{};
};

/// Arms of the configuration that have the joints of the recording, and the one that is taken.
struct Arms
{
  std::vector<std::string> fitting;
  std::string taken;                 ///< empty: none
  std::vector<std::string> missing;  ///< joints of the arm without angle or effort
};

/// One joint of the recording.
struct CheckedJoint
{
  std::string name;   ///< short, of an arm's
  std::string joint;  ///< in the messages
  JointReach reach;
  bool has_velocity{};
  FittedFactor time_factor;
  FittedFactor lag;
  std::vector<RecordingFinding> findings;
  bool is_judged{};
};

struct Check
{
  Contents contents;
  Arms arms;
  MotionFindings found;
  StreamTimingReport timing;
  FittedFactor stamps;
  EffortFit effort;
  EffortUnit configured_effort{};
  double temperature{};
  std::vector<RecordingFinding> findings;
  std::vector<CheckedJoint> joints;
};

bool holds(const std::vector<std::string>& names, const std::string& name)
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

Contents readBagContents(const MotionSource& source)
{
  constexpr int MESSAGES = 1000;  // by then every publisher of the topic was heard
  Contents contents;
  rosbag::Bag bag;
  openForReading(bag, source.path);
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections())
  {
    if (connection->datatype == "sensor_msgs/Temperature")
    {
      contents.temperature = connection->topic;
    }
  }
  rosbag::View view(bag, rosbag::TopicQuery(source.topic));
  if (view.size() == 0)
  {
    throw InputError(source.path + " has no messages on " + source.topic + "; it holds:" + listTopics(bag));
  }
  CheckedMessage message;
  int read = 0;
  for (auto instance = view.begin(); read < MESSAGES && instance != view.end(); ++instance, ++read)
  {
    if (!message.read(*instance))
    {
      continue;
    }
    const sensor_msgs::JointState& state = message.state();
    std::vector<std::string> usable;
    for (std::size_t i = 0; i < state.name.size(); ++i)
    {
      if (!holds(contents.named, state.name[i]))
      {
        contents.named.push_back(state.name[i]);
      }
      if (i < std::min(state.position.size(), state.effort.size()))
      {
        usable.push_back(state.name[i]);
      }
    }
    if (usable.size() > contents.usable.size())
    {
      contents.usable = usable;
    }
  }
  return contents;
}

/// The columns of a controller: the joints of an arm go by their number.
Contents readCsvContents(const MotionSource& source)
{
  Contents contents;
  std::ifstream file(source.path);
  std::string header;
  std::getline(file, header);
  constexpr const char* TEMPERATURES = "joint_temperatures_";
  contents.temperature = header.find(TEMPERATURES) == std::string::npos ? "" : std::string(TEMPERATURES) + "N";
  return contents;
}

std::vector<std::string> missingJoints(const ArmDescription& arm, const std::vector<std::string>& names)
{
  std::vector<std::string> missing;
  for (const ArmJoint& joint : arm.joints)
  {
    if (!holds(names, joint.name))
    {
      missing.push_back(joint.name);
    }
  }
  return missing;
}

/// Leaves of the joints at hand those of the arm, if it is not complete.
Arms findArms(const ArmOptions& options, bool is_csv, Contents& contents)
{
  const fs::path directory = configDirectory(options);
  Arms arms;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory / "arms"))
  {
    if (entry.path().extension() == ".yaml")
    {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::string nearest;  // lacks less than half of its joints
  for (const fs::path& file : files)
  {
    const ArmDescription arm = readArmDescription(file.string());
    const std::size_t missing = is_csv ? 0 : missingJoints(arm, contents.named).size();
    if (missing == 0)
    {
      arms.fitting.push_back(file.stem().string());
    }
    else if (nearest.empty() && 2 * missing < arm.joints.size())
    {
      nearest = file.stem().string();
    }
  }
  if (holds(arms.fitting, DEFAULT_ARM))
  {
    nearest = DEFAULT_ARM;
  }
  else if (!arms.fitting.empty())
  {
    nearest = arms.fitting.front();
  }
  arms.taken = options.arm.empty() ? nearest : options.arm;
  if (!arms.taken.empty() && !is_csv)
  {
    const ArmDescription arm = readArmDescription(findArm(arms.taken, directory));
    arms.missing = missingJoints(arm, contents.usable);
    if (!arms.missing.empty())
    {
      arms.taken.clear();
      // What is there of the arm, without a load.
      std::vector<std::string> usable;
      for (const ArmJoint& joint : arm.joints)
      {
        if (holds(contents.usable, joint.name))
        {
          usable.push_back(joint.name);
        }
      }
      contents.usable = usable;
    }
  }
  return arms;
}

/// Reads all joints at hand without an arm: no load is known.
MotionFindings readWithoutLoad(const MotionSource& source, const std::vector<std::string>& names,
                               const Parameters& parameters, StreamTiming& timing, RecordingFit& fit)
{
  std::vector<MotionDifferentiator> differentiators(names.size(), MotionDifferentiator(ArmLoad::HALF_WIDTH));
  std::vector<MotionSample> samples(names.size());
  const std::vector<double> unknown(names.size(), std::nan(""));
  MotionFindings found;
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
    }
  };
  const InterruptScope interrupts;
  Progress progress("reading");
  static_cast<MotionCount&>(found) = readArmMotion(
      source, names,
      [&](const std::vector<MotionRow>& rows)
      {
        timing.add(rows.front().time, rows.front().received);
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          MotionRow row = rows[i];
          row.current *= currentPerEffort(parameters);
          differentiators[i].push(row);
        }
        forward(false);
        return interruptSignal() == 0;
      },
      [&](double done) { progress.update(done); });
  forward(true);
  found.refused = differentiators[0].refused();
  found.gaps = differentiators[0].gaps();
  found.has_load = recordsLoad(source);
  return found;
}

void takeFindings(const RecordingFit& fit, const std::vector<Parameters>& parameters, Check& check)
{
  constexpr double SLOWEST = 0.05;  // that shows friction [rad/s]
  check.stamps = fit.stampFactor();
  check.effort = fit.effort();
  check.configured_effort = parameters.front().telemetry.effort;
  check.temperature = parameters.front().input.temperature;
  check.findings = fit.ofArm();
  const std::vector<Misfit> misfits = fit.whyNotJudged();
  for (std::size_t i = 0; i < check.joints.size(); ++i)
  {
    CheckedJoint& joint = check.joints[i];
    joint.reach = fit.reach(i);
    joint.has_velocity = fit.hasVelocity(i);
    joint.time_factor = fit.timeFit(i).factor();
    joint.lag = fit.timeFit(i).lag();
    joint.findings = fit.ofJoint(i);
    joint.is_judged = !misfits[i].exists() && std::max(joint.reach.most_speed, -joint.reach.least_speed) > SLOWEST;
  }
}

Check checkArm(const ArmOptions& options, Check check)
{
  ArmOptions arm = options;
  arm.arm = check.arms.taken;
  arm.load = "arm";
  const ArmRecording recording(arm);
  StreamTiming timing;
  RecordingFit fit(recording.parameters());
  check.found = recording.read(
      [&](const std::vector<ArmJointRow>& rows) { timing.add(rows.front().row.time, rows.front().row.received); }, fit);
  check.timing = timing.report();
  for (const ArmJoint& joint : recording.joints())
  {
    check.joints.push_back({ joint.short_name, joint.name, {}, false, {}, {}, {}, false });
  }
  takeFindings(fit, recording.parameters(), check);
  return check;
}

Check checkJoints(const ArmOptions& options, Check check)
{
  const std::vector<std::string>& names = check.contents.usable;
  if (names.empty())
  {
    return check;
  }
  const std::vector<Parameters> parameters(names.size(), loadParameters(options));
  StreamTiming timing;
  RecordingFit fit(parameters);
  check.found = readWithoutLoad(motionSource(options), names, parameters.front(), timing, fit);
  check.timing = timing.report();
  for (const std::string& name : names)
  {
    check.joints.push_back({ name, name, {}, false, {}, {}, {}, false });
  }
  takeFindings(fit, parameters, check);
  return check;
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

bool hasFinding(const std::vector<RecordingFinding>& findings, const std::string& kind)
{
  return std::any_of(findings.begin(), findings.end(),
                     [&](const RecordingFinding& finding) { return finding.kind == kind; });
}

/// Commands to run next, ready to paste.
std::vector<std::string> nextCommands(const ArmOptions& options, const Check& check, bool is_usable)
{
  std::string corrections;
  if (hasFinding(check.findings, "stamps"))
  {
    const FittedFactor all{ options.time_scale * check.stamps.value, check.stamps.uncertainty };
    corrections += " --time-scale " + plainFactor(all);
  }
  else if (options.time_scale != 1.0)
  {
    corrections += " --time-scale " + roundedText(options.time_scale, 6);
  }
  for (const std::string& assignment : options.assignments)
  {
    corrections += " --set " + assignment;
  }
  if (hasFinding(check.findings, "effort_unit"))
  {
    corrections += std::string(" --set telemetry.effort=") + effortKeyword(check.effort.unit);
  }
  if (options.topic != DEFAULT_TOPIC)
  {
    corrections += " --topic " + options.topic;
  }
  const bool is_correctable = hasFinding(check.findings, "stamps") || hasFinding(check.findings, "effort_unit");
  if (!is_usable && !is_correctable)
  {
    return {};
  }
  const std::string& file = options.recording;
  if (check.arms.taken.empty())
  {
    const auto joint = std::find_if(check.joints.begin(), check.joints.end(),
                                    [](const CheckedJoint& joint) { return joint.is_judged; });
    return joint == check.joints.end() ? std::vector<std::string>() :
                                         std::vector<std::string>{ "joint_twin compare " + file + " --joint " +
                                                                   joint->name + corrections + " --report report" };
  }
  const std::string arm = " --arm " + check.arms.taken + corrections;
  return { (is_correctable ? "joint_twin check " : "joint_twin identify ") + file + arm +
               (is_correctable ? "" : " --out my_arm"),
           "joint_twin compare " + file + arm + " --report report", "joint_twin follow " + file + arm + " --out rows" };
}

std::string textOfLoad(const Check& check)
{
  if (!check.arms.missing.empty())
  {
    return "unknown: no angle or no effort of " + joined(check.arms.missing);
  }
  if (check.arms.taken.empty())
  {
    return "unknown: no arm in config/arms has these joints; give your own by --arm (docs/arm.md)";
  }
  return std::string("of the arm's links and payload, from all angles") +
         (check.found.has_load ? "; a load is recorded too" : "");
}

std::string textOfArm(const ArmOptions& options, const Check& check)
{
  const std::string fitting = joined(check.arms.fitting);
  if (!options.arm.empty())
  {
    return options.arm;
  }
  return fitting.empty() ? "not known; joints: " + joined(check.contents.named) :
                           fitting + " have these joints" +
                               (check.arms.taken.empty() ? "" : "; taken: " + check.arms.taken + " (--arm)");
}

std::string textOfEffort(const Check& check)
{
  if (check.joints.empty())
  {
    return "none: the motors' currents have to be recorded as effort";
  }
  const EffortFit& effort = check.effort;
  const std::string factor = roundedText(effort.factor.value, 3);
  if (!std::isfinite(effort.factor.value))
  {
    return std::string("taken for ") + effortUnitName(check.configured_effort) + ": the load varies too little to tell";
  }
  return effort.is_known && effort.unit == check.configured_effort ?
             std::string(effortUnitName(effort.unit)) + "; with the load it changes " + factor +
                 " times as configured" :
             "changes with the load " + factor + " times as " + effortUnitName(check.configured_effort) + " would";
}

std::string textOfStamps(const Check& check)
{
  const std::string rate =
      check.timing.period > 0.0 ? roundedText(1.0 / check.timing.period, 4) + " Hz" : std::string("one row");
  return rate + ", " + std::to_string(check.timing.missing) + " rows missing, " + std::to_string(check.found.gaps) +
         " gaps, " + std::to_string(check.found.refused) + " repeated or out of order, " +
         std::to_string(check.found.corrupt) + " unreadable";
}

std::string textOfVelocities(const Check& check)
{
  if (std::isfinite(check.stamps.value))
  {
    return (hasFinding(check.findings, "stamps") ? "do not fit: " : "fit: ") + std::string("the angles change ") +
           roundedText(check.stamps.value, 4) + " times as fast by the stamps";
  }
  const bool has = std::any_of(check.joints.begin(), check.joints.end(),
                               [](const CheckedJoint& joint) { return joint.has_velocity; });
  return has ? "too little motion to hold them against the angles" : "none: the stamps cannot be checked";
}

/// Names of the joints for which `is` holds.
template <class Is>
std::string namesOf(const std::vector<CheckedJoint>& joints, const Is& is)
{
  std::vector<std::string> names;
  for (const CheckedJoint& joint : joints)
  {
    if (is(joint))
    {
      names.push_back(joint.name);
    }
  }
  return joined(names);
}

void printLine(const char* label, const std::string& text)
{
  printWrapped(std::string(label) + std::string(12 - std::string(label).size(), ' ') + text, 0);
}

void printJoints(const std::vector<CheckedJoint>& joints)
{
  std::size_t width = 7;
  for (const CheckedJoint& joint : joints)
  {
    width = std::max(width, joint.name.size());
  }
  const int columns = static_cast<int>(width);
  std::printf("\n%-*s  %15s  %7s  %16s  velocity  finding\n", columns, "joint", "moves [rad]", "[rad/s]", "effort [A]");
  for (const CheckedJoint& joint : joints)
  {
    const JointReach& reach = joint.reach;
    const auto stops = std::find_if(joint.findings.begin(), joint.findings.end(),
                                    [](const RecordingFinding& finding) { return finding.stops.has_value(); });
    const auto first = stops == joint.findings.end() ? joint.findings.begin() : stops;
    const auto number = [](double value) { return fixedText(value, 2); };
    std::printf("%-*s  %6s to %5s  %7s  %6s to %6s  %-8s  %s\n", columns, joint.name.c_str(),
                number(reach.least_angle).c_str(), number(reach.most_angle).c_str(),
                number(std::max(reach.most_speed, -reach.least_speed)).c_str(), number(reach.least_current).c_str(),
                number(reach.most_current).c_str(), joint.has_velocity ? "yes" : "no",
                first == joint.findings.end() ? "fits" : first->text.c_str());
  }
  std::cout << '\n';
}

void print(const ArmOptions& options, const Check& check, const std::vector<std::string>& next)
{
  std::cout << std::flush;
  printLine("recording", options.recording + ": " + std::to_string(check.found.rows) + " rows in " +
                             roundedText(check.found.duration, 4) + " s" +
                             (isCsv(motionSource(options)) ? "" : ", " + options.topic));
  printLine("arm", textOfArm(options, check));
  printLine("rows", textOfStamps(check));
  printLine("velocities", textOfVelocities(check));
  printLine("effort", textOfEffort(check));
  printLine("load", textOfLoad(check));
  printLine("temperature", check.contents.temperature.empty() ?
                               "not recorded: " + roundedText(check.temperature, 3) + " degC counts, as configured" :
                               check.contents.temperature);
  for (const RecordingFinding& finding : check.findings)
  {
    printLine(finding.stops ? "WRONG" : "mind", finding.text);
  }
  std::cout << std::flush;
  if (!check.joints.empty())
  {
    printJoints(check.joints);
    std::fflush(stdout);
  }
  const std::string judged = namesOf(check.joints, [](const CheckedJoint& joint) { return joint.is_judged; });
  const std::string open = namesOf(check.joints, [](const CheckedJoint& joint) { return !joint.is_judged; });
  printLine("judged", judged.empty() ? "nothing" : "friction and current of " + judged);
  if (!open.empty() && !judged.empty())
  {
    printLine("not judged", open);
  }
  for (const std::string& command : next)
  {
    std::cout << (&command == &next.front() ? "next        " : "            ") << command << '\n';
  }
}

Json findingsOf(const std::vector<RecordingFinding>& findings)
{
  std::vector<Json> all;
  for (const RecordingFinding& finding : findings)
  {
    all.push_back(Json{ { "kind", finding.kind }, { "text", finding.text }, { "stops", finding.stops.has_value() } });
  }
  return all;
}

Json documentOf(const ArmOptions& options, const Check& check, bool is_usable, const std::vector<std::string>& next)
{
  std::vector<Json> joints;
  for (const CheckedJoint& joint : check.joints)
  {
    joints.push_back(Json{ { "name", joint.name },
                           { "joint", joint.joint },
                           { "rows", joint.reach.rows },
                           { "least_angle", joint.reach.least_angle },
                           { "most_angle", joint.reach.most_angle },
                           { "least_speed", joint.reach.least_speed },
                           { "most_speed", joint.reach.most_speed },
                           { "least_current", joint.reach.least_current },
                           { "most_current", joint.reach.most_current },
                           { "has_velocity", joint.has_velocity },
                           { "time_factor", joint.time_factor.value },
                           { "velocity_lag", joint.lag.value },
                           { "judged", joint.is_judged },
                           { "findings", findingsOf(joint.findings) } });
  }
  return Json{ { "recording", options.recording },
               { "rows", check.found.rows },
               { "duration", check.found.duration },
               { "period", check.timing.period },
               { "missing", check.timing.missing },
               { "gaps", check.found.gaps },
               { "refused", check.found.refused },
               { "unreadable", check.found.corrupt },
               { "arms", check.arms.fitting },
               { "arm", check.arms.taken.empty() ? Json() : Json(check.arms.taken) },
               { "missing_joints", check.arms.missing },
               { "load", check.arms.taken.empty() ? "unknown" : "arm" },
               { "load_recorded", check.found.has_load },
               { "temperature", check.contents.temperature.empty() ? Json() : Json(check.contents.temperature) },
               { "stamp_factor", check.stamps.value },
               { "stamp_factor_uncertainty", check.stamps.uncertainty },
               { "effort_factor", check.effort.factor.value },
               { "effort_factor_uncertainty", check.effort.factor.uncertainty },
               { "effort", check.effort.is_known ? Json(effortKeyword(check.effort.unit)) : Json() },
               { "findings", findingsOf(check.findings) },
               { "joints", joints },
               { "usable", is_usable },
               { "next", next } };
}

int check(const ArmOptions& options)
{
  const MotionSource source = motionSource(options);
  const bool is_csv = isCsv(source);
  Check check;
  check.contents = is_csv ? readCsvContents(source) : readBagContents(source);
  check.arms = findArms(options, is_csv, check.contents);
  check = check.arms.taken.empty() ? checkJoints(options, std::move(check)) : checkArm(options, std::move(check));
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const bool is_usable =
      std::any_of(check.joints.begin(), check.joints.end(), [](const CheckedJoint& joint) { return joint.is_judged; });
  const std::vector<std::string> next = nextCommands(options, check, is_usable);
  if (options.json)
  {
    std::cout << documentOf(options, check, is_usable, next).dump() << '\n';
  }
  else
  {
    print(options, check, next);
  }
  return is_usable ? EXIT_DONE : EXIT_FAILED;
}

void declare(Command& command, ArmOptions& options)
{
  addRecording(command, options);
  addArmOption(command, options);
  addReadingOptions(command, options);
}

const Subcommand CHECK{ Subject::RECORDING, "check",
                        "what of an arm's recording is usable, what does not fit, and the command to run next", declare,
                        check };
}  // namespace
}  // namespace hjt
