// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "apps/common/configuration.hpp"

namespace hjt
{
/// Options of a sweep on the command line.
struct SweepArguments : CommonOptions
{
  std::string plan;
  std::string out;
  unsigned jobs{ 1 };
  std::uint64_t shard{};
  std::uint64_t shards{ 1 };
  bool quiet{};
  bool dry_run{};
  bool list{};
  bool lives{};  ///< only a plan of lives will do
};

/// Options and arguments that every way of running a sweep takes.
void addSweepOptions(Command& command, SweepArguments& arguments);

/// Works off the plan, or its part. @returns the process' exit code. @throws InputError.
int sweep(const SweepArguments& arguments);
}  // namespace hjt
