// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "python/bindings.hpp"
#include "surface/surface_cache.hpp"

namespace hjt
{
/// Source of response surfaces for twins, whose construction does not hold the interpreter's lock.
class SurfaceSourceOf
{
public:
  /// `cache`: directory of surfaces; none: that of the tool. `progress`: Python function of the finished share 0 ... 1,
  /// or None. `builders`: number of twins that are built one after the other and share equal surfaces.
  SurfaceSourceOf(const std::optional<std::string>& cache, const py::object& progress, std::size_t builders = 1)
  {
    source_.cache_directory = cache ? *cache : surfaceCacheDirectory();
    source_.progress = [this, &progress, builders](double done)
    {
      check_();
      if (!progress.is_none())
      {
        const py::gil_scoped_acquire acquire;
        progress((static_cast<double>(finished_) + done) / static_cast<double>(builders));
      }
    };
    if (builders > 1)
    {
      source_.pool = std::make_shared<SurfacePool>(std::numeric_limits<std::size_t>::max());
    }
    source_.notice = [this](const std::string& what) { notices_.push_back(what); };
  }
  SurfaceSourceOf(const SurfaceSourceOf&) = delete;
  SurfaceSourceOf& operator=(const SurfaceSourceOf&) = delete;

  const SurfaceSource& source() const { return source_; }

  /// Reports that one more twin has been built. Throws what `progress` throws.
  void next()
  {
    source_.progress(1.0);
    ++finished_;
  }

  /// Issues Python warnings: why a surface is missing, or why a surface was not stored.
  void warn() const
  {
    for (const std::string& notice : notices_)
    {
      if (PyErr_WarnEx(PyExc_RuntimeWarning, notice.c_str(), 1) != 0)
      {
        throw py::error_already_set();
      }
    }
  }

private:
  SurfaceSource source_;
  InterruptCheck check_;
  std::size_t finished_{};
  std::vector<std::string> notices_;
};
}  // namespace hjt
