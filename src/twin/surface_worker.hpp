// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

#include "surface/faulty_surface.hpp"

namespace hjt
{
/// Obtains response surfaces in a thread of its own, beside a twin that runs.
class SurfaceWorker
{
public:
  /// Starts the thread with a first request.
  SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source);

  /// The same surface, or a thread of its own in search of it; to be called where `request` is.
  SurfaceWorker(const SurfaceWorker& other);

  /// Gives up what is not finished.
  ~SurfaceWorker();

  /// Asks for the surface of the drive with these faults in place of the last one, which must not be in use any more.
  /// False: not now, ask again. Neither waits nor allocates.
  bool request(const FaultList& faults) noexcept;

  /// The surface requested last, once it is ready; null until then or if there is none. Neither waits nor allocates.
  const ResponseSurface* surface() const noexcept { return isDone() ? surface_.get() : nullptr; }

private:
  bool isDone() const noexcept
  {
    return done_.load(std::memory_order_acquire) == asked_.load(std::memory_order_relaxed);
  }
  void run();
  void obtain(std::uint64_t request, const FaultList& faults);

  const Parameters parameters_;
  const SurfaceSource source_;
  std::mutex mutex_;
  FaultList faults_;  // requested last
  SurfacePool::Surface surface_;
  std::atomic<std::uint64_t> asked_{ 1 };  // requests so far
  std::atomic<std::uint64_t> done_{ 0 };   // the request that surface_ is for
  std::atomic<bool> stopping_{ false };
  std::condition_variable wake_up_;
  std::thread thread_;
};
}  // namespace hjt
