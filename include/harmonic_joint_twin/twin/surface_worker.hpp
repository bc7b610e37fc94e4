// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "harmonic_joint_twin/model/joint_model.hpp"
#include "harmonic_joint_twin/params/parameters.hpp"
#include "harmonic_joint_twin/twin/surface_cache.hpp"

namespace hjt
{
/// Obtains a response surface in a thread of its own, beside a twin that runs.
class SurfaceWorker
{
public:
  /// Starts the thread; arguments as of `sharedSurface`.
  SurfaceWorker(const Parameters& parameters, const JointModel& model, const std::string& faults,
                const SurfaceSource& source);

  /// Gives up what is not finished.
  ~SurfaceWorker();

  /// The surface once it is there; until then, or if there is none, null. Neither waits nor allocates.
  const ResponseSurface* surface() const noexcept
  {
    return ready_.load(std::memory_order_acquire) ? surface_.get() : nullptr;
  }

private:
  SurfacePool::Surface surface_;
  std::atomic<bool> ready_{ false };
  std::atomic<bool> stopping_{ false };
  std::thread thread_;
};
}  // namespace hjt
