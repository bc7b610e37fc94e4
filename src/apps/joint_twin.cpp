// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <iostream>

#include "apps/common/exit_code.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/tool/commands.hpp"

int main(int argc, char** argv)
{
  CLI::App app("Tooth-level digital twin of a robot joint's harmonic drive. All quantities in SI units, angles in rad.",
               "joint_twin");
  app.set_version_flag("--version", "joint_twin " HJT_VERSION);
  app.require_subcommand(1);
  int exit_code = hjt::EXIT_DONE;
  hjt::addInsertCommand(app, exit_code);
  hjt::addStiffnessCommand(app, exit_code);
  hjt::addTurnCommand(app, exit_code);
  hjt::addLossesCommand(app, exit_code);
  hjt::addBreakawayCommand(app, exit_code);
  hjt::addHysteresisCommand(app, exit_code);
  hjt::addInvariantsCommand(app, exit_code);
  hjt::addManufactureCommand(app, exit_code);
  hjt::addProfileCommand(app, exit_code);
  hjt::addRatchetCommand(app, exit_code);
  hjt::addLifeCommand(app, exit_code);
  hjt::addTransientCommand(app, exit_code);
  hjt::addDynamicsCommand(app, exit_code);
  hjt::addSimulateCommand(app, exit_code);
  hjt::addTrialCommand(app, exit_code);
  hjt::addFollowCommand(app, exit_code);
  hjt::addCompareCommand(app, exit_code);
  hjt::addIdentifyCommand(app, exit_code);
  hjt::addImportCommand(app, exit_code);
  hjt::addReplayCommand(app, exit_code);
  hjt::addIndicatorsCommand(app, exit_code);
  hjt::addFaultsCommand(app, exit_code);
  hjt::addSweepCommand(app, exit_code);
  hjt::addParametersCommand(app, exit_code);

  hjt::catchInterrupts();
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& error)
  {
    return app.exit(error) == 0 ? hjt::EXIT_DONE : hjt::EXIT_USAGE;
  }
  catch (const std::exception& error)
  {
    std::cerr << "joint_twin: " << error.what() << '\n';
    return hjt::EXIT_FAILED;
  }
  return exit_code;
}
