// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/surface_source.hpp"

#include <iostream>
#include <memory>

#include "apps/common/progress.hpp"

namespace hjt
{
SurfaceSource surfaceSource()
{
  const auto progress = std::make_shared<Progress>("building the response surface");
  return { surfaceCacheDirectory(), [progress](double done) { progress->update(done); },
           [](const std::string& what) { std::cerr << "warning: " << what << '\n'; } };
}
}  // namespace hjt
