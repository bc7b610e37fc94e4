// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

namespace hjt
{
// Each adds one subcommand; when it is chosen, parsing runs it and leaves its answer in `exit_code`.
void addInsertCommand(CLI::App& app, int& exit_code);
void addStiffnessCommand(CLI::App& app, int& exit_code);
void addTurnCommand(CLI::App& app, int& exit_code);
void addLossesCommand(CLI::App& app, int& exit_code);
void addBreakawayCommand(CLI::App& app, int& exit_code);
void addHysteresisCommand(CLI::App& app, int& exit_code);
void addInvariantsCommand(CLI::App& app, int& exit_code);
void addManufactureCommand(CLI::App& app, int& exit_code);
void addProfileCommand(CLI::App& app, int& exit_code);
void addRatchetCommand(CLI::App& app, int& exit_code);
void addLifeCommand(CLI::App& app, int& exit_code);
void addTransientCommand(CLI::App& app, int& exit_code);
void addDynamicsCommand(CLI::App& app, int& exit_code);
void addSimulateCommand(CLI::App& app, int& exit_code);
void addTrialCommand(CLI::App& app, int& exit_code);
void addFollowCommand(CLI::App& app, int& exit_code);
void addCompareCommand(CLI::App& app, int& exit_code);
void addIdentifyCommand(CLI::App& app, int& exit_code);
void addImportCommand(CLI::App& app, int& exit_code);
void addReplayCommand(CLI::App& app, int& exit_code);
void addIndicatorsCommand(CLI::App& app, int& exit_code);
void addFaultsCommand(CLI::App& app, int& exit_code);
void addSweepCommand(CLI::App& app, int& exit_code);
void addParametersCommand(CLI::App& app, int& exit_code);
}  // namespace hjt
