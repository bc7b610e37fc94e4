// SPDX-License-Identifier: BSD-3-Clause
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/common/arm_recording.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"
#include "output/report.hpp"
#include "output/text_table.hpp"
#include "recordings/comparison_files.hpp"
#include "recordings/recording_comparison.hpp"

#include "base/joined.hpp"
#include "base/whole_file.hpp"
#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "messages/conversions.hpp"
#include "messages/topics.hpp"
#include "params/configuration_files.hpp"
#include "tracking/common_friction.hpp"
#include "tracking/verdict.hpp"

extern char** environ;

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* PYTHON = "/usr/bin/python3";
constexpr const char* PAGE = "report.html";
constexpr const char* MADE_WITH = "joint_twin " HJT_VERSION;

constexpr const char* ARM_FILE = "arm.json";

struct CompareOptions : ArmOptions
{
  std::string report;
  std::string reference;
};

const std::vector<Column<JudgedWindow>> WINDOW_COLUMNS{
  { "time", [](const JudgedWindow& window) { return 1e-9 * static_cast<double>(window.indicators.stamp); } },
  { "speed", [](const JudgedWindow& window) { return window.indicators.point.speed; } },
  { "load", [](const JudgedWindow& window) { return window.indicators.point.load; } },
  { "level", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.level); } },
  { "cause", [](const JudgedWindow& window) { return static_cast<int>(window.assessment.cause); } },
  { "confidence", [](const JudgedWindow& window) { return window.assessment.confidence; } },
  { "largest_score", [](const JudgedWindow& window) { return window.assessment.largest_score; } }
};

/// @throws InputError if one of the files that the page is made of cannot be written to `directory`.
void prepareDirectory(const CompareOptions& options, const std::string& directory, const char* data_file)
{
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
  {
    throw InputError(directory + " cannot be made a directory: " + error.message());
  }
  for (const char* name : { data_file, PAGE })
  {
    requireWritable((fs::path(directory) / name).string(), options.force, options.recording);
  }
}

void refuseReferenceAsReport(const CompareOptions& options)
{
  std::error_code error;
  if (fs::equivalent(options.report, options.reference, error))
  {
    throw InputError("--report and --reference are the same directory: the reference would be lost");
  }
}

/// Runs the script that makes page and pictures of the data. @throws InputError if it does not end well.
void makePage(const std::string& directory)
{
  std::string script = (packageDirectory() / "scripts/comparison_page.py").string();
  std::string python = PYTHON;
  std::string argument = directory;
  std::array<char*, 4> arguments{ python.data(), script.data(), argument.data(), nullptr };
  pid_t child{};
  const int refused = posix_spawn(&child, PYTHON, nullptr, nullptr, arguments.data(), environ);
  int status = 0;
  if (refused == 0)
  {
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    {
    }
  }
  if (refused != 0 || status != 0)
  {
    throw InputError("the page was not made" +
                     (refused != 0 ? ": " + std::string(PYTHON) + ": " + std::strerror(refused) : std::string()) +
                     "; the data are in " + directory + ", and `" + python + " " + script + " " + directory +
                     "` makes the page of them");
  }
}

void print(const ComparisonRecord& record, const JointEvidence& evidence)
{
  const Verdict& verdict = record.verdict;
  for (const ContentLine& line : record.contents.lines)
  {
    printWrapped((line.found ? "found   " : "missing ") + line.name + " (" + line.gives + ")", 0);
  }
  std::cout << '\n' << levelName(verdict.level) << '\n';
  for (const Finding& finding : verdict.findings)
  {
    printWrapped(subjectTitle(finding.subject) + (": " + std::string(levelName(finding.level))) + ". " +
                     findingText(verdict, finding),
                 0);
  }
  std::cout << '\n';
  printReport(false, { { "", "rows", evidence.reach().rows },
                       { "", "duration", record.found.duration, "s" },
                       { "", "current, rms", evidence.currentRms(), "A" },
                       { "", "measured less predicted current, rms", evidence.residualRms(), "A" } });
}

/// A joint that is compared, its source, and the directory of its report.
class ComparedJoint
{
public:
  /// `reference`: directory of an earlier report; empty: none. `is_identified`: the parameters are of this very joint.
  ComparedJoint(const Parameters& parameters, MotionSource source, LoadOrigin load, const std::string& directory,
                const std::string& reference, bool is_identified)
    : parameters_(parameters)
    , source_(std::move(source))
    , directory_(directory)
    , sound_(reference.empty() ? SoundJoint() : readSoundJoint(reference, parameters))
    , is_identified_(is_identified)
    , windows_((fs::path(directory) / "windows.csv").string(), WINDOW_COLUMNS)
    , comparison_(parameters, load, sound_.baseline, [this](const JudgedWindow& window) { windows_.write(window); })
  {
    source_.current_per_motor_torque = nominalRatio(parameters.gear) / parameters.telemetry.torque_per_current;
  }

  void update(const MotionSample& sample) { comparison_.update(sample); }

  const MotionSource& source() const { return source_; }
  const JointEvidence& evidence() const { return comparison_.evidence(); }

  MeasuredFriction friction(const Misfit& misfit) const
  {
    return measuredFriction(evidence(), parameters_, { sound_.own, is_identified_, 0.0, 1.0, misfit });
  }

  /// Judges, and writes the data of the page. `twin_topic`: of a twin that was recorded beside the robot.
  ComparisonRecord write(const MotionFindings& found, double arm_friction, const Misfit& misfit,
                         const std::string& twin_topic)
  {
    windows_.close();
    ComparisonRecord record;
    record.recording = source_.path;
    record.joint = source_.joint;
    record.made_with = MADE_WITH;
    record.found = found;
    const MotionReach& reach = evidence().reach();
    record.contents =
        readContents(source_, twin_topic, found, reach.motor_rows, reach.temperature_rows, found.has_load);
    record.twin_states = readTwinStates(source_, twin_topic, toSeconds(found.start));
    record.verdict =
        judge(evidence(), parameters_, { sound_.own, is_identified_, found.duration, arm_friction, misfit });
    writeComparison(directory_, comparison_, parameters_, record);
    return record;
  }

private:
  const Parameters parameters_;
  MotionSource source_;
  const std::string directory_;
  const SoundJoint sound_;
  const bool is_identified_;
  TableFile<JudgedWindow> windows_;
  RecordingComparison comparison_;
};

int compareJoint(const CompareOptions& options)
{
  const Parameters parameters = loadParameters(options);
  prepareDirectory(options, options.report, COMPARISON_FILE);
  const MotionSource source = motionSource(options);
  ComparedJoint joint(parameters, source, recordsLoad(source) ? LoadOrigin::RECORDED : LoadOrigin::CONFIGURED,
                      options.report, options.reference, false);
  const MotionFindings found =
      visitMotion(joint.source(), joint.evidence().twin(), [&](const MotionSample& sample) { joint.update(sample); });
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  const ComparisonRecord record =
      joint.write(found, 1.0, Misfit(), options.joint_namespace + "/" + topics::JOINT_STATES);
  makePage(options.report);
  if (options.json)
  {
    std::ifstream data(fs::path(options.report) / COMPARISON_FILE);
    std::cout << data.rdbuf();
  }
  else
  {
    print(record, joint.evidence());
    std::cout << "written: " << (fs::path(options.report) / PAGE).string() << '\n';
  }
  return EXIT_DONE;
}

/// One joint in the summary of an arm.
struct ArmLine
{
  std::string joint;
  Verdict verdict;
  std::string misfit;  // of its recording; empty: it fits
  std::optional<double> friction_ratio;
  double temperature{};  // [degC]
  const char* temperature_source{};
  double current_rms{};
  double residual_rms{};
};

const std::vector<Column<ArmLine>> ARM_COLUMNS{
  { "joint", &ArmLine::joint, "joint" },
  { "level", [](const ArmLine& line) { return levelName(line.verdict.level); }, "verdict" },
  { "reason", [](const ArmLine& line) { return reasonName(line.verdict.reason); } },
  { "text", [](const ArmLine& line) { return verdictText(line.verdict); } },
  { "friction_factor", [](const ArmLine& line) { return line.verdict.friction.factor; } },
  { "friction_lower", [](const ArmLine& line) { return line.verdict.friction.lower; } },
  { "friction_upper", [](const ArmLine& line) { return line.verdict.friction.upper; } },
  { "friction_has_interval", [](const ArmLine& line) { return line.verdict.friction.has_interval; } },
  { "friction_ratio", &ArmLine::friction_ratio, "friction [-]" },
  { "temperature", &ArmLine::temperature, "at [degC]" },
  { "temperature_source", [](const ArmLine& line) { return line.temperature_source; }, "which is" },
  { "current_rms", &ArmLine::current_rms, "current, rms [A]" },
  { "current_residual_rms", &ArmLine::residual_rms, "less predicted [A]" }
};

/// Joints of the worst level, and what they have in common.
std::string textOf(const std::vector<ArmLine>& lines, HealthLevel level, const ArmFriction& arm)
{
  std::string text;
  if (arm.median != 1.0)
  {
    text = "Friction of the whole arm is " + shortNumber(0.01 * std::round(100.0 * arm.median)) +
           " times the reference's: another temperature or gain, not a fault of one joint. ";
    if (arm.temperature)
    {
      text += "By the twin's law of friction this is " + shortNumber(std::round(*arm.temperature)) +
              " degC in place of " + shortNumber(std::round(lines.front().temperature)) + " degC. ";
    }
  }
  std::vector<std::string> unjudged;
  for (const ArmLine& line : lines)
  {
    if (level != HealthLevel::OK && severityOf(line.verdict.level) == level)
    {
      text += line.joint + ": " + verdictText(line.verdict) + " ";
    }
    if (!line.verdict.isJudged())
    {
      unjudged.push_back(line.joint + (line.misfit.empty() ? "" : " (" + line.misfit + ")"));
    }
  }
  if (level == HealthLevel::OK && unjudged.size() < lines.size())
  {
    text += "No joint departs from a sound one. ";
  }
  if (!unjudged.empty())
  {
    text += "This recording does not show whether these are sound: " + joined(unjudged) + ". ";
  }
  text.pop_back();
  return text;
}

int compareArm(const CompareOptions& options)
{
  const ArmRecording recording(options);
  prepareDirectory(options, options.report, ARM_FILE);
  const LoadOrigin load = recording.usesRecordedLoad() ? LoadOrigin::RECORDED : LoadOrigin::ARM;
  std::vector<std::unique_ptr<ComparedJoint>> joints;
  std::vector<MotionDifferentiator> differentiators(recording.joints().size());
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const fs::path name = recording.joints()[i].short_name;
    const std::string directory = (fs::path(options.report) / name).string();
    prepareDirectory(options, directory, COMPARISON_FILE);
    joints.push_back(std::make_unique<ComparedJoint>(
        recording.parameters(i), recording.source(i), load, directory,
        options.reference.empty() ? std::string() : (fs::path(options.reference) / name).string(),
        !options.identified.empty()));
  }
  const auto forward = [&](std::size_t i, bool at_end)
  {
    while (const std::optional<MotionSample> sample = differentiators[i].pop(at_end))
    {
      joints[i]->update(*sample);
    }
  };
  RecordingFit fit(recording.parameters());
  const MotionFindings found = recording.read(
      [&](const std::vector<ArmJointRow>& rows)
      {
        for (std::size_t i = 0; i < rows.size(); ++i)
        {
          differentiators[i].push(rows[i].row);
          forward(i, false);
        }
      },
      fit);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  warnOfStamps(found);
  const std::vector<Misfit> misfits = fit.whyNotJudged();
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    forward(i, true);
    frictions.push_back(joints[i]->friction(misfits[i]));
  }
  const Parameters& parameters = recording.parameters(0);
  const ArmFriction arm = commonFriction(frictions, parameters.comparison.repeat_tolerance);
  std::vector<ArmLine> lines;
  HealthLevel level = HealthLevel::OK;
  bool judged = false;
  double temperatures = 0.0;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    const std::string& name = recording.joints()[i].short_name;
    const JointEvidence& evidence = joints[i]->evidence();
    ComparisonRecord record = joints[i]->write(found, arm.factors[i], misfits[i],
                                               "/" + name + options.joint_namespace + "/" + topics::JOINT_STATES);
    level = std::max(level, severityOf(record.verdict.level));
    judged = judged || record.verdict.isJudged();
    temperatures += evidence.temperature();
    const std::string why_not =
        !misfits[i].exists() && evidence.isTouched() ? contactText(evidence.contact().last()) : misfits[i].clause;
    lines.push_back({ name, std::move(record.verdict), why_not, frictions[i].ratio, evidence.temperature(),
                      temperatureSource(evidence), evidence.currentRms(), evidence.residualRms() });
  }
  const std::string level_name = judged ? levelName(level) : levelName(VerdictLevel::NOT_JUDGED);
  const bool same = misfits.front().exists() &&
                    std::all_of(misfits.begin(), misfits.end(),
                                [&](const Misfit& misfit) { return misfit.clause == misfits.front().clause; });
  const std::string text = same ? sentence(misfits.front().clause) : textOf(lines, level, arm);
  const Table table(ARM_COLUMNS, lines);
  const Json all{ { "recording", options.recording },
                  { "arm", options.arm },
                  { "made_with", MADE_WITH },
                  { "level", level_name },
                  { "text", text },
                  { "load", options.load },
                  { "temperature", temperatures / static_cast<double>(lines.size()) },
                  { "temperature_estimate", arm.temperature },
                  { "rows", found.rows },
                  { "duration", found.duration },
                  { "friction_ratio", arm.median },
                  { "joints", table.rows() } };
  writeTextFile((fs::path(options.report) / ARM_FILE).string(), all.dump() + "\n");
  makePage(options.report);
  if (options.json)
  {
    std::cout << all.dump() << '\n';
    return EXIT_DONE;
  }
  std::cout << level_name << '\n';
  printWrapped(text, 0);
  std::cout << '\n';
  table.print();
  std::cout << "\nwritten: " << (fs::path(options.report) / PAGE).string() << '\n';
  return EXIT_DONE;
}

int compare(const CompareOptions& options)
{
  refuseReferenceAsReport(options);
  return options.arm.empty() ? compareJoint(options) : compareArm(options);
}

void declare(Command& command, CompareOptions& options)
{
  addArmOptions(command, options);
  command
      .add("--report", options.report,
           "directory of the page, its figures and data; of an arm a directory for each joint")
      .required()
      .type("DIR");
  command
      .add("--reference", options.reference,
           "an earlier report of this joint or arm in sound condition, for comparison")
      .type("DIR")
      .existingDirectory();
}

const Subcommand COMPARE{ Subject::RECORDING, "compare",
                          "compares a recorded joint or arm with the twin: verdict, figures and data as a page",
                          declare, compare };
}  // namespace
}  // namespace hjt
