// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iostream>
#include <memory>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "output/progress.hpp"

namespace hjt
{
/// Response surfaces from the user's cache; building shows its progress and what is amiss on stderr.
inline SurfaceSource surfaceSource()
{
  const auto progress = std::make_shared<Progress>("building the response surface");
  return { surfaceCacheDirectory(), [progress](double done) { progress->update(done); },
           [](const std::string& what) { std::cerr << "warning: " << what << '\n'; } };
}
}  // namespace hjt
