// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <exception>
#include <iostream>
#include <optional>
#ifdef HJT_COMPLETE_TOOL
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include <unistd.h>
#endif

#include "apps/common/command.hpp"
#include "output/output_file.hpp"
#include "output/process_end.hpp"

#ifdef HJT_COMPLETE_TOOL
namespace hjt
{
const char* toolHelp();  ///< output of joint_twin_complete --help; cmake/tool_help.cmake generates the function
}

namespace
{
bool asksForHelp(int argc, char** argv)
{
  const std::string first = argc == 2 ? argv[1] : "";
  return first == "--help" || first == "-h";
}

/// Replaces this process by joint_twin_complete, the tool with all commands, which is in the same directory.
int runComplete(char** argv)
{
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string complete = self.parent_path() / HJT_COMPLETE_TOOL;
  execv(complete.c_str(), argv);
  std::cerr << "joint_twin: cannot run " << complete << ": " << std::strerror(errno) << '\n';
  return hjt::EXIT_FAILED;
}
}  // namespace
#endif

namespace
{
int run(hjt::CommandLine& line, int argc, char** argv)
{
#ifdef HJT_COMPLETE_TOOL
  if (asksForHelp(argc, argv))
  {
    std::cout << hjt::toolHelp();
    return hjt::EXIT_DONE;
  }
  if (!hjt::CommandLine::knows(argc, argv))
  {
    return runComplete(argv);
  }
#endif
  const std::optional<int> ended = line.parse(argc, argv);
  return ended ? *ended : line.run();
}
}  // namespace

int main(int argc, char** argv)
{
  hjt::CommandLine line(
      "joint_twin",
      "Digital twin of a robot joint's harmonic drive with the force on every tooth. All quantities are in SI units, "
      "angles in rad.");
  line.addSubcommands();
  std::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of file sizes then fails like a write to a full disk
  try
  {
    const int code = run(line, argc, argv);
    hjt::finishStandardOutput();
    return code;
  }
  catch (const std::exception& error)
  {
    if (hjt::interruptSignal() != 0)  // an interrupt can cause errors that are not the user's
    {
      std::cerr << "joint_twin: interrupted\n";
      return hjt::EXIT_BY_SIGNAL + hjt::interruptSignal();
    }
    std::cerr << "joint_twin: " << error.what() << '\n';
    return hjt::EXIT_FAILED;
  }
}
