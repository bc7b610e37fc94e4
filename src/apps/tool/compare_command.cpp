// SPDX-License-Identifier: BSD-3-Clause
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "apps/common/motion_options.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/text_table.hpp"
#include "recordings/compare.hpp"

#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

struct Options : Printed<ComparisonOptions>
{
  std::string fail_on;  // warn or error; empty: the exit code is no verdict
};

/// A directory that is removed with it.
class TemporaryDirectory
{
public:
  TemporaryDirectory()
  {
    std::string name = (fs::temp_directory_path() / "joint_twin_compare_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
    {
      throw InputError("no directory can be made in " + fs::temp_directory_path().string() + ": " +
                       std::strerror(errno));
    }
    path_ = name;
  }
  ~TemporaryDirectory()
  {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  std::string path() const { return path_.string(); }

private:
  fs::path path_;
};

/// What the process answers to a verdict.
int exitCodeOf(const std::string& fail_on, const ComparedRecording& compared)
{
  if (fail_on.empty())
  {
    return EXIT_DONE;
  }
  const HealthLevel least = fail_on == "warn" ? HealthLevel::WARN : HealthLevel::ERROR;
  return compared.health >= least ? EXIT_DEPARTS : compared.is_judged ? EXIT_DONE : EXIT_NOT_JUDGED;
}

void printArm(const ComparedRecording& compared)
{
  std::cout << compared.level << '\n';
  printWrapped(compared.text, 0);
  std::cout << '\n';
  tableOf(compared).print();
}

void printJoint(const ComparedRecording& compared)
{
  const ComparedJoint& joint = compared.joints.front();
  for (const ContentLine& line : joint.contents.lines)
  {
    printWrapped((line.found ? "found   " : "missing ") + line.name + " (" + line.gives + ")", 0);
  }
  std::cout << '\n' << compared.level << '\n';
  for (const Finding& finding : joint.verdict.findings)
  {
    printWrapped(subjectTitle(finding.subject) + (": " + std::string(levelName(finding.level))) + ". " +
                     findingText(joint.verdict, finding),
                 0);
  }
  std::cout << '\n';
  printReport(false, { { "", "rows", joint.rows },
                       { "", "duration", compared.found.duration, "s" },
                       { "", "current, rms", joint.current_rms, "A" },
                       { "", "measured less predicted current, rms", joint.residual_rms, "A" } });
}

int run(const Options& given)
{
  Options options = given;
  options.watch = consoleWatch();
  if (options.report.empty() && !options.json)
  {
    std::cerr << "--report is required: the directory of the page; --json goes without\n";
    return EXIT_USAGE;
  }
  std::optional<TemporaryDirectory> directory;
  if (options.report.empty())
  {
    options.report = directory.emplace().path();
    options.has_page = false;
  }
  const ComparedRecording compared = compare(options);
  if (interruptSignal() != 0)
  {
    return EXIT_BY_SIGNAL + interruptSignal();
  }
  if (options.json)
  {
    std::cout << compared.document.dump() << '\n';
    return exitCodeOf(options.fail_on, compared);
  }
  compared.is_arm ? printArm(compared) : printJoint(compared);
  std::cout << (compared.is_arm ? "\n" : "") << "written: " << compared.page << '\n';
  return exitCodeOf(options.fail_on, compared);
}

void declare(Command& command, Options& options)
{
  addArmOptions(command, options, options.json);
  command
      .add("--report", options.report,
           "directory of the page, its figures and data; of an arm a directory for each joint; --json goes without")
      .type("DIR");
  command
      .add("--reference", options.references, "earlier reports of this joint or arm in sound condition, for comparison")
      .follow()
      .type("DIR")
      .existingDirectory();
  command
      .add("--fail-on", options.fail_on,
           "exit code 3 if the verdict is this or worse, 4 if nothing can be judged; else the verdict changes none")
      .choice({ "warn", "error" });
}

const Subcommand COMPARE{ Subject::RECORDING, "compare",
                          "compares a recorded joint or arm with the twin: verdict, figures and data as a page",
                          declare, run };
}  // namespace
}  // namespace hjt
