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
/// Thread that builds or reads response surfaces while the twin runs.
class SurfaceWorker
{
public:
  /// Starts the thread and requests the surface of the drive with `faults`.
  SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source);

  /// Shares the surface of `other` if it is ready. If it is not ready, the new thread obtains the surface again. Must
  /// be called in the thread that calls `request`.
  SurfaceWorker(const SurfaceWorker& other);

  /// Ends the thread. A surface that is not finished is lost.
  ~SurfaceWorker();

  /// Requests the surface of the drive with these faults. The new surface replaces the last surface, which must not be
  /// in use. @returns false if the thread is busy; request again then. Does not block or allocate.
  bool request(const FaultList& faults) noexcept;

  /// Last requested surface; null if it is not ready or does not exist. The function does not block or allocate.
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
  FaultList faults_;  // faults of the last request
  SurfacePool::Surface surface_;
  std::atomic<std::uint64_t> asked_{ 1 };  // number of requests
  std::atomic<std::uint64_t> done_{ 0 };   // number of the request that surface_ belongs to
  std::atomic<bool> stopping_{ false };
  std::condition_variable wake_up_;
  std::thread thread_;
};

/// Whether two lists have equal faults with equal severities. The times of the faults may differ.
bool isSame(const FaultList& one, const FaultList& other) noexcept;

/// Response surfaces of a twin that waits for them before it starts. Each onset of a configured fault begins a new set
/// of active faults (stage). If the sets need at most MAX_TABLES tables, every set has a surface. If they need more,
/// only some sets have one: the first and the last set, and those in which a fault grows in more than NODES steps. Such
/// a fault has tables at some severities and cubic interpolation between them.
class SurfaceStages
{
public:
  /// Obtains the surfaces. `active`: faults at the start; `later`: faults that set in later.
  void prepare(const Parameters& parameters, const FaultList& active, FaultSchedule later, SurfaceSource source);

  /// Surface for a set of faults; null if there is none.
  const ResponseSurface* of(const FaultList& faults) const noexcept;

private:
  static constexpr int MAX_TABLES = 4;     // largest number of tables of the gear for surfaces of all sets
  static constexpr std::size_t NODES = 8;  // number of intervals between tables of a growth if the teeth are equal
  // NODES if the teeth differ: fewer, because a table then takes several times as long to build
  static constexpr std::size_t FEW_NODES = 4;

  struct Stage
  {
    FaultList faults;
    SurfacePool::Surface surface;  ///< surface of the stage; may be null
  };

  int list(const FaultList& active, FaultSchedule later);
  void obtain(Stage& stage);
  std::size_t endOfGrowth(std::size_t first, Fault& growing) const;
  void interpolate(std::size_t first, std::size_t last, const Fault& growing);

  std::vector<Stage> stages_;
  const Parameters* parameters_{};  // null except within `prepare`
  const SurfaceSource* source_{};
};
}  // namespace hjt
