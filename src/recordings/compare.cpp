// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/compare.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <deque>
#include <filesystem>
#include <functional>
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
#include "base/number_text.hpp"
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
  for (const std::string& reference : options.references)
  {
    std::error_code error;
    if (fs::equivalent(options.report, reference, error))
    {
      throw InputError("--report and --reference are the same directory: the reference would be lost");
    }
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
  /// `references`: directories of earlier reports; empty: none. `is_identified`: the parameters are of this very joint.
  JointComparison(const ArmRecording& recording, std::size_t joint, LoadOrigin load, const std::string& directory,
                  const std::vector<std::string>& references, bool is_identified)
    : parameters_(recording.parameters(joint))
    , source_(recording.source(joint))
    , is_file_(recording.isFile())
    , directory_(directory)
    , sound_(references.empty() ? SoundJoint() : readSoundJoint(references, parameters_))
    , is_identified_(is_identified)
    , windows_((fs::path(directory) / "windows.csv").string(), WINDOW_COLUMNS)
    , comparison_(parameters_, load, sound_.baseline, [this](const JudgedWindow& window) { windows_.write(window); })
  {
  }

  void update(const MotionSample& sample) { comparison_.update(sample); }

  const JointEvidence& evidence() const { return comparison_.evidence(); }

  MeasuredFriction friction(const std::string& misfit) const
  {
    return measuredFriction(evidence(), parameters_, { sound_.own, is_identified_, 0.0, 1.0, misfit });
  }

  /// Judges, and writes the data of the page. `twin_topic`: of a twin that was recorded beside the robot.
  ComparedJoint write(const MotionFindings& found, double arm_friction, double arm_deviation, const std::string& misfit,
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
    const JointContext context{ sound_.own, is_identified_, found.duration, arm_friction, misfit, arm_deviation };
    record.verdict = judge(evidence(), parameters_, context);
    record.friction = frictionFactor(evidence(), context);
    record.is_friction_judged = record.verdict.findings.front().judged;
    ComparedJoint compared;
    compared.friction = record.is_friction_judged ? std::make_optional(record.friction) : std::nullopt;
    compared.contact = reach.touched_rows > 0 ? sentence(contactText(evidence().contact().largest())) : std::string();
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

template <typename Member>
std::optional<double> number(const ComparedJoint& line, Member member)
{
  return line.friction ? std::make_optional(std::invoke(member, *line.friction)) : std::nullopt;
}

const std::vector<Column<ComparedJoint>> ARM_COLUMNS{
  { "joint", &ComparedJoint::name, "joint" },
  { "level", [](const ComparedJoint& line) { return verdictName(line.verdict); }, "verdict" },
  { "reason", [](const ComparedJoint& line) { return line.verdict.reason; } },
  { "friction_ratio", [](const ComparedJoint& line) { return number(line, &FrictionFactor::value); } },
  { "friction_low", [](const ComparedJoint& line) { return number(line, &FrictionFactor::low); } },
  { "friction_high", [](const ComparedJoint& line) { return number(line, &FrictionFactor::high); } },
  { "friction", [](const ComparedJoint& line) { return line.friction ? factorText(*line.friction) : "-"; },
    "friction [95 %]" },
  { "temperature", &ComparedJoint::temperature, "at [degC]" },
  { "temperature_source", [](const ComparedJoint& line) { return line.temperature_source; }, "which is" },
  { "current_rms", &ComparedJoint::current_rms, "current, rms [A]" },
  { "current_residual_rms", &ComparedJoint::residual_rms, "less predicted [A]" }
};

/// What the joints of a group have in common, if that is worth a word.
std::string groupText(const JointGroup& group, const std::vector<ComparedJoint>& lines)
{
  constexpr double NOTEWORTHY = 0.1;
  if (!group.is_known || std::abs(group.median - 1.0) < NOTEWORTHY)
  {
    return {};
  }
  return "Friction of " + lines[group.begin].name + " to " + lines[group.end - 1].name + " together is " +
         fixedText(group.median, 2) +
         " times the expected one: another temperature or lubricant of these, not a fault of one joint. ";
}

/// Every joint that departs or is not judged, and why.
std::string departuresOf(const std::vector<ComparedJoint>& lines)
{
  std::string reason;
  std::vector<std::pair<std::string, std::vector<std::string>>> unjudged;  // reason, joints
  bool departs = false;
  bool judged = false;
  for (const ComparedJoint& line : lines)
  {
    judged = judged || line.verdict.judged;
    if (line.verdict.level != HealthLevel::OK)
    {
      reason += line.name + ": " + line.verdict.reason + " ";
      departs = true;
    }
    if (!line.verdict.judged)
    {
      const std::string& why = line.verdict.findings.front().text;
      const auto same =
          std::find_if(unjudged.begin(), unjudged.end(), [&](const auto& one) { return one.first == why; });
      (same == unjudged.end() ? unjudged.emplace_back(why, std::vector<std::string>()) : *same)
          .second.push_back(line.name);
    }
    else if (!line.contact.empty())
    {
      reason += line.name + ": " + line.contact + " Judged by the rest. ";
    }
  }
  reason += judged && !departs ? "No joint departs from a sound one. " : "";
  for (const auto& [why, joints] : unjudged)
  {
    reason += "Not judged: " + joined(joints) + ". " + why + " ";
  }
  return reason;
}

/// What the joints have in common, and each that departs or is not judged.
std::string reasonOf(const std::vector<ComparedJoint>& lines, const ArmFriction& arm)
{
  std::string reason;
  if (arm.median != 1.0)
  {
    reason = "Friction of the whole arm is " + shortNumber(0.01 * std::round(100.0 * arm.median)) +
             " times the reference's: another temperature or gain, not a fault of one joint. ";
    if (arm.temperature)
    {
      reason += "By the twin's law of friction this is " + shortNumber(std::round(*arm.temperature)) +
                " degC in place of " + shortNumber(std::round(lines.front().temperature)) + " degC. ";
    }
  }
  for (const JointGroup& group : arm.groups)
  {
    reason += groupText(group, lines);
  }
  reason += departuresOf(lines);
  reason.pop_back();
  return reason;
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
    std::vector<std::string> references;
    for (const std::string& reference : options.references)
    {
      references.push_back(directoryOf(recording, reference, i));
    }
    joints.push_back(
        std::make_unique<JointComparison>(recording, i, load, directory, references, !options.identified.empty()));
  }
  return joints;
}

/// The joints beside their twins after a pass through the recording.
struct Pass
{
  std::vector<std::unique_ptr<JointComparison>> joints;
  MotionFindings found;
  std::vector<std::string> misfits;  // why the rows of each say nothing, in a sentence; empty: they fit
  ArmFriction friction;
  std::optional<IdentifiedPayload> payload;
};

/// Of samples that come by joints: all of one time at once.
class PayloadCollector
{
public:
  explicit PayloadCollector(const ArmRecording& recording)
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
      if (!is_touched)
      {
        fit_.add(samples_, predicted_);
      }
    }
  }

  IdentifiedPayload solve() { return fit_.solve(); }

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

  PayloadFit fit_;
  std::vector<std::deque<Row>> waiting_;
  std::vector<MotionSample> samples_;
  std::vector<double> predicted_;
};

Pass passThrough(const ComparisonOptions& options, const ArmRecording& recording)
{
  Pass pass;
  pass.joints = prepareJoints(options, recording);
  std::optional<PayloadCollector> payload;
  if (recording.isArm() && !recording.usesRecordedLoad())
  {
    payload.emplace(recording);
  }
  RecordingFit fit(recording.parameters());
  pass.found = recording.readSamples(
      [&](std::size_t i, const MotionSample& sample)
      {
        pass.joints[i]->update(sample);
        if (payload)
        {
          payload->add(i, sample, pass.joints[i]->evidence());
        }
      },
      fit);
  pass.misfits = recording.isArm() ? fit.whyNotJudged() : std::vector<std::string>{ pass.found.misfit };
  std::vector<MeasuredFriction> frictions;
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    pass.misfits[i] = sentence(pass.misfits[i]);
    frictions.push_back(pass.joints[i]->friction(pass.misfits[i]));
  }
  pass.friction = commonFriction(frictions, recording.parameters(0).comparison.repeat_tolerance);
  const bool fits = std::all_of(pass.misfits.begin(), pass.misfits.end(), [](const auto& why) { return why.empty(); });
  for (std::string& misfit : pass.misfits)
  {
    misfit = misfit.empty() ? pass.friction.misfit : misfit;
  }
  if (payload && fits && pass.friction.misfit.empty() && !options.watch.stopped())
  {
    pass.payload = payload->solve();
  }
  return pass;
}

std::string payloadText(const IdentifiedPayload& payload)
{
  const Payload found = payload.payload();
  return "The currents look like a payload of " + fixedText(found.mass, 1) + " +- " +
         fixedText(payload.mass_half_width, 1) + " kg at the flange in place of the configured " +
         shortNumber(payload.configured.mass) + " kg, its centre at " + fixedText(found.centre[0], 2) + ", " +
         fixedText(found.centre[1], 2) + ", " + fixedText(found.centre[2], 2) +
         " m: set payload in the arm's file. The joints are judged with it. ";
}

/// Level and reason of an arm by those of its joints. `misfits`: why the rows of each say nothing.
void judgeArm(const std::vector<std::string>& misfits, ComparedRecording& compared)
{
  for (const ComparedJoint& joint : compared.joints)
  {
    compared.health = std::max(compared.health, joint.verdict.level);
    compared.is_judged = compared.is_judged || joint.verdict.judged;
  }
  compared.level = compared.is_judged ? levelName(compared.health) : NOT_JUDGED;
  const bool same = !misfits.front().empty() && std::count(misfits.begin(), misfits.end(), misfits.front()) ==
                                                    static_cast<std::ptrdiff_t>(misfits.size());
  compared.reason = (compared.payload ? payloadText(*compared.payload) : "") +
                    (same ? misfits.front() : reasonOf(compared.joints, compared.friction));
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
           { "reason", compared.reason },
           { "load", options.load },
           { "temperature", temperatures / static_cast<double>(compared.joints.size()) },
           { "temperature_estimate", compared.friction.temperature },
           { "rows", compared.found.rows },
           { "duration", compared.found.duration },
           { "friction_ratio", compared.friction.median },
           { "payload_mass", compared.payload ? std::make_optional(compared.payload->mass) : std::nullopt },
           { "payload_half_width",
             compared.payload ? std::make_optional(compared.payload->mass_half_width) : std::nullopt },
           { "joints", tableOf(compared).rows() } };
}
}  // namespace

ComparedRecording compare(const ComparisonOptions& options)
{
  refuseReferenceAsReport(options);
  ArmRecording recording(options);
  Pass pass = passThrough(options, recording);
  ComparedRecording compared;
  compared.is_arm = recording.isArm();
  compared.page = (fs::path(options.report) / REPORT_PAGE).string();
  if (pass.payload && pass.payload->differs() && pass.payload->mass > pass.payload->mass_half_width)
  {
    compared.payload = pass.payload;
    recording.setPayload(pass.payload->payload());
    pass = passThrough(options, recording);
  }
  compared.found = pass.found;
  compared.friction = pass.friction;
  if (options.watch.stopped())
  {
    return compared;
  }
  for (std::size_t i = 0; i < pass.joints.size(); ++i)
  {
    ComparedJoint& joint = compared.joints.emplace_back(
        pass.joints[i]->write(pass.found, pass.friction.factors[i], pass.friction.deviations[i], pass.misfits[i],
                              recording.twinNamespace(i) + "/" + topics::JOINT_STATES));
    joint.name = recording.joints()[i].short_name;
  }
  if (recording.isArm())
  {
    judgeArm(pass.misfits, compared);
    compared.document = documentOfArm(options, compared);
    writeTextFile((fs::path(options.report) / ARM_FILE).string(), compared.document.dump() + "\n");
  }
  else
  {
    const Verdict& verdict = compared.joints.front().verdict;
    compared.level = verdictName(verdict);
    compared.is_judged = verdict.judged;
    compared.health = verdict.level;
    compared.reason = verdict.reason;
    compared.document = compared.joints.front().document;
  }
  if (options.has_page)
  {
    makePage(options.report);
  }
  return compared;
}

Table tableOf(const ComparedRecording& compared)
{
  return Table(ARM_COLUMNS, compared.joints);
}
}  // namespace hjt
