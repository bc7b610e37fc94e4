// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include "harmonic_joint_twin/model/faults/fault_list.hpp"
#include "harmonic_joint_twin/twin/fault_schedule.hpp"
#include "surface/faulty_surface.hpp"

namespace hjt
{
/// Obtains response surfaces in a thread of its own, beside a twin that runs.
class SurfaceWorker
{
public:
  /// Starts the thread with a first request.
  SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source);

  /// Shares the other's surface if it is ready; else the new thread obtains it. Call it from the thread that calls
  /// `request`.
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

/// Whether both hold the same faults with the same severities, since whenever.
bool isSame(const FaultList& one, const FaultList& other) noexcept;

/// The response surfaces of a twin that waits for them: one for each set of faults that the configured ones make as
/// they set in one after the other. Where these are many, each table but the first and the last being a build: of a
/// fault that grows in more steps than NODES tables of some of them, and for those between a sum of the nearest, cubic
/// in the severity; of others none.
class SurfaceStages
{
public:
  /// `later`: what sets in after `active`.
  void prepare(const Parameters& parameters, const FaultList& active, FaultSchedule later, SurfaceSource source);

  /// Null: there is none.
  const ResponseSurface* of(const FaultList& faults) const noexcept;

private:
  static constexpr int MAX_TABLES = 4;         // with more, those between the first and the last are left out
  static constexpr std::size_t NODES = 8;      // intervals that a growth is divided into, of a gear of equal teeth
  static constexpr std::size_t FEW_NODES = 4;  // where teeth differ: each table takes several times as long

  struct Stage
  {
    FaultList faults;
    SurfacePool::Surface surface;  ///< may be none
  };

  int list(const FaultList& active, FaultSchedule later);
  void obtain(Stage& stage);
  std::size_t endOfGrowth(std::size_t first, Fault& growing) const;
  void interpolate(std::size_t first, std::size_t last, const Fault& growing);

  std::vector<Stage> stages_;
  const Parameters* parameters_{};  // while it prepares
  const SurfaceSource* source_{};
};
}  // namespace hjt
