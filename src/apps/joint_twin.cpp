// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <iostream>
#include <optional>

#include "apps/common/command.hpp"
#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"

int main(int argc, char** argv)
{
  hjt::CommandLine line(
      "joint_twin",
      "Tooth-level digital twin of a robot joint's harmonic drive. All quantities in SI units, angles "
      "in rad.");
  line.addSubcommands();
  hjt::catchInterrupts();
  try
  {
    const std::optional<int> ended = line.parse(argc, argv);
    return ended ? *ended : line.run();
  }
  catch (const std::exception& error)
  {
    std::cerr << "joint_twin: " << error.what() << '\n';
    return hjt::EXIT_FAILED;
  }
}
