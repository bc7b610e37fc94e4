// SPDX-License-Identifier: BSD-3-Clause
// In place of identify_command.cpp where Ceres is missing.
#include "apps/common/command.hpp"

namespace hjt
{
namespace
{
const Subcommand IDENTIFY{ Subject::RECORDING, "identify", NotBuilt{ "Ceres" } };
}  // namespace
}  // namespace hjt
