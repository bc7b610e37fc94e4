// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harmonic_joint_twin/surface/surface_source.hpp"
#include "python/bindings.hpp"

namespace hjt
{
/// Source of response surfaces for a builder that runs without the interpreter's lock.
class SurfaceSourceOf
{
public:
  /// `cache`: a directory; none: the tool's. `progress`: called with 0 ... 1, or Python's None.
  SurfaceSourceOf(const std::optional<std::string>& cache, const py::object& progress)
  {
    source_.cache_directory = cache ? *cache : surfaceCacheDirectory();
    source_.progress = [this, &progress](double done)
    {
      check_();
      if (!progress.is_none())
      {
        const py::gil_scoped_acquire acquire;
        progress(done);
      }
    };
    source_.notice = [this](const std::string& what) { notices_.push_back(what); };
  }
  SurfaceSourceOf(const SurfaceSourceOf&) = delete;
  SurfaceSourceOf& operator=(const SurfaceSourceOf&) = delete;

  const SurfaceSource& source() const { return source_; }

  /// Tells Python's warnings why there is no surface, or why it could not be kept.
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
  std::vector<std::string> notices_;
};
}  // namespace hjt
