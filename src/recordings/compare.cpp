// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/compare.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/output_file.hpp"
#include "output/text_table.hpp"
#include "recordings/arm_recording.hpp"
#include "recordings/comparison_files.hpp"
#include "recordings/recording_comparison.hpp"

#include "base/joined.hpp"
#include "base/whole_file.hpp"
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
constexpr const char* MADE_WITH = "joint_twin " HJT_VERSION;

constexpr const char* ARM_FILE = "arm.json";

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
void prepareDirectory(const ComparisonOptions& options, const std::string& directory, const char* data_file)
{
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
  {
    throw InputError(directory + " cannot be made a directory: " + error.message());
  }
  for (const char* name : { data_file, REPORT_PAGE })
  {
    requireWritable((fs::path(directory) / name).string(), options.force, options.recording);
  }
}

void refuseReferenceAsReport(const ComparisonOptions& options)
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

/// A joint that is being compared, its source, and the directory of its report.
class JointComparison
{
public:
  /// `reference`: directory of an earlier report; empty: none. `is_identified`: the parameters are of this very joint.
  JointComparison(const ArmRecording& recording, std::size_t joint, LoadOrigin load, const std::string& directory,
                  const std::string& reference, bool is_identified)
    : parameters_(recording.parameters(joint))
    , source_(recording.source(joint))
    , is_file_(recording.isFile())
    , directory_(directory)
    , sound_(reference.empty() ? SoundJoint() : readSoundJoint(reference, parameters_))
    , is_identified_(is_identified)
    , windows_((fs::path(directory) / "windows.csv").string(), WINDOW_COLUMNS)
    , comparison_(parameters_, load, sound_.baseline, [this](const JudgedWindow& window) { windows_.write(window); })
  {
  }

  void update(const MotionSample& sample) { comparison_.update(sample); }

  const JointEvidence& evidence() const { return comparison_.evidence(); }

  MeasuredFriction friction(const Misfit& misfit) const
  {
    return measuredFriction(evidence(), parameters_, { sound_.own, is_identified_, 0.0, 1.0, misfit });
  }

  /// Judges, and writes the data of the page. `twin_topic`: of a twin that was recorded beside the robot.
  ComparedJoint write(const MotionFindings& found, double arm_friction, const Misfit& misfit,
                      const std::string& twin_topic)
  {
    windows_.close();
    ComparisonRecord record;
    record.recording = source_.path;
    record.joint = source_.joint;
    record.made_with = MADE_WITH;
    record.found = found;
    const MotionReach& reach = evidence().reach();
    if (is_file_)
    {
      record.contents =
          readContents(source_, twin_topic, found, reach.motor_rows, reach.temperature_rows, found.has_load);
      record.twin_states = readTwinStates(source_, twin_topic, toSeconds(found.start));
    }
    record.verdict =
        judge(evidence(), parameters_, { sound_.own, is_identified_, found.duration, arm_friction, misfit });
    ComparedJoint compared;
    compared.document = writeComparison(directory_, comparison_, parameters_, record);
    compared.temperature = evidence().temperature();
    compared.temperature_source = temperatureSource(evidence());
    compared.rows = reach.rows;
    compared.current_rms = evidence().currentRms();
    compared.residual_rms = evidence().residualRms();
    compared.contents = std::move(record.contents);
    compared.verdict = std::move(record.verdict);
    return compared;
  }

private:
  const Parameters parameters_;
  const MotionSource source_;
  const bool is_file_;
  const std::string directory_;
  const SoundJoint sound_;
  const bool is_identified_;
  TableFile<JudgedWindow> windows_;
  RecordingComparison comparison_;
};

const std::vector<Column<ComparedJoint>> ARM_COLUMNS{
  { "joint", &ComparedJoint::name, "joint" },
  { "level", [](const ComparedJoint& line) { return levelName(line.verdict.level); }, "verdict" },
  { "verdict", [](const ComparedJoint& line) { return verdictFields(line.verdict); } },
  { "friction_ratio", &ComparedJoint::friction_ratio, "friction [-]" },
  { "temperature", &ComparedJoint::temperature, "at [degC]" },
  { "temperature_source", [](const ComparedJoint& line) { return line.temperature_source; }, "which is" },
  { "current_rms", &ComparedJoint::current_rms, "current, rms [A]" },
  { "current_residual_rms", &ComparedJoint::residual_rms, "less predicted [A]" }
};

/// Joints of the worst level, and what they have in common.
std::string textOf(const std::vector<ComparedJoint>& lines, HealthLevel level, const ArmFriction& arm)
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
  for (const ComparedJoint& line : lines)
  {
    if (level != HealthLevel::OK && severityOf(line.verdict.level) == level)
    {
      text += line.name + ": " + verdictText(line.verdict) + " ";
    }
    if (!line.verdict.isJudged())
    {
      unjudged.push_back(line.name + (line.misfit.empty() ? "" : " (" + line.misfit + ")"));
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

/// The directory of a joint's report, or of its reference, in that of the whole.
std::string directoryOf(const ArmRecording& recording, const std::string& whole, std::size_t joint)
{
  return recording.isArm() && !whole.empty() ? (fs::path(whole) / recording.joints()[joint].short_name).string() :
                                               whole;
}

std::vector<std::unique_ptr<JointComparison>> prepareJoints(const ComparisonOptions& options,
                                                            const ArmRecording& recording)
{
  const LoadOrigin load = recording.usesRecordedLoad() ? LoadOrigin::RECORDED :
                          recording.isArm()            ? LoadOrigin::ARM :
                                                         LoadOrigin::CONFIGURED;
  if (recording.isArm())
  {
    prepareDirectory(options, options.report, ARM_FILE);
  }
  std::vector<std::unique_ptr<JointComparison>> joints;
  for (std::size_t i = 0; i < recording.joints().size(); ++i)
  {
    const std::string directory = directoryOf(recording, options.report, i);
    prepareDirectory(options, directory, COMPARISON_FILE);
    joints.push_back(std::make_unique<JointComparison>(
        recording, i, load, directory, directoryOf(recording, options.reference, i), !options.identified.empty()));
  }
  return joints;
}

/// Level and text of an arm by those of its joints. `misfits`: why the rows of each say nothing.
void judgeArm(const std::vector<Misfit>& misfits, ComparedRecording& compared)
{
  HealthLevel level = HealthLevel::OK;
  bool judged = false;
  for (const ComparedJoint& joint : compared.joints)
  {
    level = std::max(level, severityOf(joint.verdict.level));
    judged = judged || joint.verdict.isJudged();
  }
  compared.level = judged ? levelName(level) : levelName(VerdictLevel::NOT_JUDGED);
  const bool same = misfits.front().exists() &&
                    std::all_of(misfits.begin(), misfits.end(),
                                [&](const Misfit& misfit) { return misfit.clause == misfits.front().clause; });
  compared.text = same ? sentence(misfits.front().clause) : textOf(compared.joints, level, compared.friction);
}

Json documentOfArm(const ComparisonOptions& options, const ComparedRecording& compared)
{
  double temperatures = 0.0;
  for (const ComparedJoint& joint : compared.joints)
  {
    temperatures += joint.temperature;
  }
  return { { "recording", options.recording },
           { "arm", options.arm },
           { "made_with", MADE_WITH },
           { "level", compared.level },
           { "text", compared.text },
           { "load", options.load },
           { "temperature", temperatures / static_cast<double>(compared.joints.size()) },
           { "temperature_estimate", compared.friction.temperature },
           { "rows", compared.found.rows },
           { "duration", compared.found.duration },
           { "friction_ratio", compared.friction.median },
           { "joints", tableOf(compared).rows() } };
}
}  // namespace

ComparedRecording compare(const ComparisonOptions& options)
{
  refuseReferenceAsReport(options);
  const ArmRecording recording(options);
  const std::vector<std::unique_ptr<JointComparison>> joints = prepareJoints(options, recording);
  RecordingFit fit(recording.parameters());
  ComparedRecording compared;
  compared.is_arm = recording.isArm();
  compared.page = (fs::path(options.report) / REPORT_PAGE).string();
  compared.found =
      recording.readSamples([&](std::size_t i, const MotionSample& sample) { joints[i]->update(sample); }, fit);
  if (options.watch.stopped())
  {
    return compared;
  }
  const std::vector<Misfit> misfits =
      recording.isArm() ? fit.whyNotJudged() : std::vector<Misfit>{ compared.found.misfit };
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    frictions.push_back(joints[i]->friction(misfits[i]));
  }
  compared.friction = commonFriction(frictions, recording.parameters(0).comparison.repeat_tolerance);
  for (std::size_t i = 0; i < joints.size(); ++i)
  {
    ComparedJoint& joint =
        compared.joints.emplace_back(joints[i]->write(compared.found, compared.friction.factors[i], misfits[i],
                                                      recording.twinNamespace(i) + "/" + topics::JOINT_STATES));
    joint.name = recording.joints()[i].short_name;
    joint.friction_ratio = frictions[i].ratio;
    joint.misfit = !misfits[i].exists() && joints[i]->evidence().isTouched() ?
                       contactText(joints[i]->evidence().contact().last()) :
                       misfits[i].clause;
  }
  if (recording.isArm())
  {
    judgeArm(misfits, compared);
    compared.document = documentOfArm(options, compared);
    writeTextFile((fs::path(options.report) / ARM_FILE).string(), compared.document.dump() + "\n");
  }
  else
  {
    const Verdict& verdict = compared.joints.front().verdict;
    compared.level = levelName(verdict.level);
    compared.text = verdictText(verdict);
    compared.document = compared.joints.front().document;
  }
  makePage(options.report);
  return compared;
}

Table tableOf(const ComparedRecording& compared)
{
  return Table(ARM_COLUMNS, compared.joints);
}
}  // namespace hjt
