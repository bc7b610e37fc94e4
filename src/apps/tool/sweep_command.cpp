// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/sweep_runner.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <thread>

#include "apps/common/command.hpp"

namespace hjt
{
namespace
{
struct ShardOptions : SweepArguments
{
  std::string part;
};

void declare(Command& command, ShardOptions& options)
{
  options.jobs = std::max(1u, std::thread::hardware_concurrency());
  addSweepOptions(command, options);
  command.add("--shard", options.part, "only every N-th run, from run I on: one of N processes, anywhere")
      .type("I/N")
      .check(
          [&options](const std::string& text)
          {
            char slash = 0;
            std::istringstream stream(text);
            const bool read = static_cast<bool>(stream >> options.shard >> slash >> options.shards);
            return read && stream.peek() == EOF && slash == '/' && options.shard < options.shards ?
                       std::string() :
                       "'" + text + "' must be I/N with 0 <= I < N";
          });
}

int run(const ShardOptions& options)
{
  return sweep(options);
}

int runLives(const ShardOptions& options)
{
  ShardOptions of_lives = options;
  of_lives.lives = true;
  return sweep(of_lives);
}

const Subcommand SWEEP{ Subject::DATA_SET, "sweep", "work off a plan of many runs: a labelled data set", declare, run };
const Subcommand LIVES{ Subject::DATA_SET, "lives",
                        "drives from new to their end, with a check-up every so often: a data set of run to failure",
                        declare, runLives };
}  // namespace
}  // namespace hjt
