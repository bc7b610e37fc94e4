// SPDX-License-Identifier: BSD-3-Clause
#include "apps/sweep/sweep_runner.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>
#include <thread>

#include "apps/tool/commands.hpp"

namespace hjt
{
void addSweepCommand(CLI::App& app, int& exit_code)
{
  const auto arguments = std::make_shared<SweepArguments>();
  arguments->jobs = std::max(1u, std::thread::hardware_concurrency());
  auto* command = app.add_subcommand("sweep", "work off a plan of many runs: a labelled data set");
  addSweepOptions(*command, *arguments);
  const auto shard = std::make_shared<std::string>();
  const CLI::Validator part(
      [arguments](std::string& text)
      {
        char slash = 0;
        std::istringstream stream(text);
        const bool read = static_cast<bool>(stream >> arguments->shard >> slash >> arguments->shards);
        return read && stream.peek() == EOF && slash == '/' && arguments->shard < arguments->shards ?
                   std::string() :
                   "'" + text + "' must be I/N with 0 <= I < N";
      },
      "");
  command->add_option("--shard", *shard, "only every N-th run, from run I on: one of N processes, anywhere")
      ->type_name("I/N")
      ->check(part);
  command->callback([arguments, shard, &exit_code] { exit_code = sweep(*arguments); });
}
}  // namespace hjt
