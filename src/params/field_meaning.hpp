// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "base/range.hpp"

#include "harmonic_joint_twin/params/parameters.hpp"

namespace hjt
{
/// Which response surface tables depend on a parameter.
enum class Shapes
{
  SURFACE,  ///< all: it changes the equilibrium of the ring, or its friction by angle
  FAULTS,   ///< those of a drive with faults
  OTHERS    ///< none, or it is a friction that is added after a table is read
};

/// Meaning of a parameter, and the tables that depend on it: all unless stated otherwise.
struct Meaning
{
  // NOLINTNEXTLINE(google-explicit-constructor): most rows of the table give a text alone
  Meaning(const char* meaning, Shapes shaped = Shapes::SURFACE) : text(meaning), shapes(shaped) {}

  const char* text;
  Shapes shapes;
};

inline Meaning ofFaults(const char* text)
{
  return { text, Shapes::FAULTS };
}

inline Meaning ofOthers(const char* text)
{
  return { text, Shapes::OTHERS };
}

constexpr double NO_LIMIT = std::numeric_limits<double>::max();
constexpr Range ERROR_SHIFT{ -1e-4, 1e-4 };  ///< for errors of manufacture and fit [m]
}  // namespace hjt
