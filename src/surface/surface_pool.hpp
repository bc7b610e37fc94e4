// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "solver/response_surface.hpp"

namespace hjt
{
/// Surfaces in memory for the twins of one process, one for each set of parameters. Safe to use from several threads:
/// who asks for one that is being made waits for it, and who asks for another does not. Where `make` throws, its caller
/// gets the exception and the next asker tries again.
class SurfacePool
{
public:
  using Surface = std::shared_ptr<const ResponseSurface>;

  /// `kept`: number of surfaces, at least one, that stay in memory, the last requested ones, 8 MB each, also while no
  /// twin uses them.
  explicit SurfacePool(std::size_t kept) : kept_(kept) {}
  virtual ~SurfacePool() = default;
  SurfacePool(const SurfacePool&) = delete;
  SurfacePool& operator=(const SurfacePool&) = delete;

  /// The surface under this key, made by `make` if it is not there; may be none.
  virtual Surface obtain(const std::string& key, const std::function<Surface()>& make);

private:
  using Entry = std::pair<std::string, std::shared_future<Surface>>;

  std::list<Entry>::iterator find(const std::string& key);

  std::size_t kept_;
  std::mutex mutex_;
  std::list<Entry> entries_;  // last requested first
};
}  // namespace hjt
