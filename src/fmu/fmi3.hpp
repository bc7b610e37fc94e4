// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// What of FMI 3.0's C interface a co-simulation unit needs to know; functions in functions.cpp.
namespace hjt::fmu
{
enum class Status : int
{
  OK,
  WARNING,
  DISCARD,
  ERROR,
  FATAL
};

/// What is logged: information and warnings, errors.
constexpr const char* LOG_CATEGORIES[]{ "logStatusWarning", "logStatusError" };

using ValueReference = std::uint32_t;
using LogMessage = void (*)(void* environment, Status status, const char* category, const char* message);
}  // namespace hjt::fmu
