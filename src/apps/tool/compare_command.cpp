// SPDX-License-Identifier: BSD-3-Clause
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/motion_options.hpp"
#include "apps/common/output_file.hpp"
#include "apps/common/report.hpp"
#include "apps/common/text_table.hpp"
#include "apps/compare/comparison_files.hpp"
#include "apps/compare/recording_comparison.hpp"
#include "apps/compare/verdict.hpp"

#include "gear/ratio.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "ros_io/conversions.hpp"
#include "ros_io/topics.hpp"

extern char** environ;

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

constexpr const char* PYTHON = "/usr/bin/python3";
constexpr const char* PAGE = "report.html";

struct CompareOptions : MotionOptions
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

void prepareDirectory(const CompareOptions& options)
{
  std::error_code error;
  if (fs::equivalent(options.report, options.reference, error))
  {
    throw InputError("--report and --reference are the same directory: the reference would be lost");
  }
  fs::create_directories(options.report, error);
  if (error)
  {
    throw InputError(options.report + " cannot be made a directory: " + error.message());
  }
  for (const char* name : { COMPARISON_FILE, PAGE })
  {
    requireWritable((fs::path(options.report) / name).string(), options.force, options.recording);
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

void print(const ComparisonRecord& record, const RecordingComparison& comparison)
{
  const Verdict& verdict = record.verdict;
  for (const ContentLine& line : record.contents.lines)
  {
    printWrapped((line.found ? "found   " : "missing ") + line.name + " (" + line.gives + ")", 0);
  }
  std::cout << '\n' << (verdict.judged ? levelName(verdict.level) : "NOT JUDGED") << '\n';
  for (const Finding& finding : verdict.findings)
  {
    printWrapped(
        finding.title + ": " + (finding.judged ? levelName(finding.level) : "not judged") + ". " + finding.text, 0);
  }
  std::cout << '\n';
  printReport(false, { { "", "rows", comparison.reach().rows },
                       { "", "duration", record.found.duration, "s" },
                       { "", "current, rms", comparison.currentRms(), "A" },
                       { "", "measured less predicted current, rms", comparison.residualRms(), "A" } });
}

int compare(const CompareOptions& options)
{
  const Parameters parameters = loadParameters(options);
  const SoundJoint sound = options.reference.empty() ? SoundJoint() : readSoundJoint(options.reference, parameters);
  prepareDirectory(options);
  MotionSource source = motionSource(options);
  source.current_per_motor_torque = nominalRatio(parameters.gear) / parameters.telemetry.torque_per_current;
  const std::string twin_topic = options.joint_namespace + "/" + topics::JOINT_STATES;

  TableFile<JudgedWindow> windows((fs::path(options.report) / "windows.csv").string(), WINDOW_COLUMNS);
  RecordingComparison comparison(parameters, sound.baseline,
                                 [&](const JudgedWindow& window) { windows.write(window); });
  const MotionFindings found =
      visitMotion(source, comparison.twin(), [&](const MotionSample& sample) { comparison.update(sample); });
  windows.close();
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  ComparisonRecord record;
  record.recording = options.recording;
  record.joint = source.joint;
  record.made_with = "joint_twin " HJT_VERSION;
  record.found = found;
  record.contents = readContents(source, twin_topic, found, comparison.reach().motor_rows, found.has_load);
  record.twin_states = readTwinStates(source, twin_topic, found.start);
  record.verdict = judge(comparison, parameters, sound.own, found.has_load, found.duration);
  writeComparison(options.report, comparison, parameters, record);
  makePage(options.report);
  const std::string page = (fs::path(options.report) / PAGE).string();
  if (options.json)
  {
    std::ifstream data(fs::path(options.report) / COMPARISON_FILE);
    std::cout << data.rdbuf();
  }
  else
  {
    print(record, comparison);
    std::cout << "written: " << page << '\n';
  }
  return EXIT_DONE;
}

void declare(Command& command, CompareOptions& options)
{
  addMotionOptions(command, options);
  command.add("--report", options.report, "directory of the page, its figures and data").required().type("DIR");
  command.add("--reference", options.reference, "an earlier report of this joint in sound condition, for comparison")
      .type("DIR")
      .existingDirectory();
}

const Subcommand COMPARE{ Subject::RECORDING, "compare",
                          "compares a recorded joint with the twin: verdict, figures and data as a "
                          "page",
                          declare, compare };
}  // namespace
}  // namespace hjt
