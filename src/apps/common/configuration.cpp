// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/configuration.hpp"

#include <iostream>

#include "output/process_end.hpp"

namespace hjt
{
void addJsonOption(OptionTable& table, bool& json)
{
  table.flag("--json", json, "print one JSON document on stdout and nothing else").group(COMMON_GROUP);
}

void addCommonOptions(OptionTable& table, CommonOptions& options)
{
  addOptions(table, options, options.force);
  addJsonOption(table, options.json);
}

void printGearWarnings(const Parameters& parameters)
{
  for (const std::string& warning : gearWarnings(parameters))
  {
    std::cerr << "joint_twin: warning: " << warning << '\n';
  }
}

Parameters loadGear(const ConfigurationOptions& options)
{
  Parameters parameters = loadParameters(options);
  printGearWarnings(parameters);
  return parameters;
}

Parameters loadAnalysed(const ConfigurationOptions& options, Analysis analysis)
{
  Parameters parameters = loadGear(options);
  requireFaultsAct(parameters, analysis);
  return parameters;
}

int notConverged(const std::string& what, const SolveStatus& status)
{
  std::cerr << "joint_twin: no equilibrium found for " << what << ": " << explanationOf(status) << '\n';
  return EXIT_FAILED;
}
}  // namespace hjt
