// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

/// What FMI's C interfaces, 2.0 and 3.0, share for co-simulation; their functions are in fmi2.cpp and fmi3.cpp.
namespace hjt::fmu
{
enum class Version
{
  FMI_2,
  FMI_3
};

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

/// Of a variable, its place in the unit's list; FMI 2.0 has no arrays, its reference also says which element.
using ValueReference = std::uint32_t;
constexpr unsigned ELEMENT_SHIFT = 16;  ///< element << this | variable

/// To an importer's log; empty where it has none.
using Log = std::function<void(Status status, const char* category, const std::string& message)>;
}  // namespace hjt::fmu
