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
/// Builds or reads response surfaces in a separate thread while the twin runs.
class SurfaceWorker
{
public:
  /// Starts the thread with the first request.
  SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source);

  /// Shares the other's surface if it is ready; otherwise the new thread obtains it. Call it in the thread that calls
  /// `request`.
  SurfaceWorker(const SurfaceWorker& other);

  /// Abandons an unfinished surface.
  ~SurfaceWorker();

  /// Requests the surface of the drive with these faults. It replaces the last surface, which must not be in use.
  /// @returns false if the thread is busy; then the caller must request again. The function neither blocks nor
  /// allocates.
  bool request(const FaultList& faults) noexcept;

  /// The last requested surface; null if it is not ready or does not exist. The function neither blocks nor allocates.
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
  FaultList faults_;  // of the last request
  SurfacePool::Surface surface_;
  std::atomic<std::uint64_t> asked_{ 1 };  // number of requests
  std::atomic<std::uint64_t> done_{ 0 };   // number of the request that surface_ belongs to
  std::atomic<bool> stopping_{ false };
  std::condition_variable wake_up_;
  std::thread thread_;
};

/// Whether both lists have equal faults with equal severities, whatever their times.
bool isSame(const FaultList& one, const FaultList& other) noexcept;

/// Response surfaces of a twin that waits for them: one for each set of faults between the onsets of the configured
/// faults. Each table except the first and the last takes a build. With many sets, a fault that grows in more than
/// NODES steps has tables at some severities and cubic interpolation in the severity between them. Other sets have no
/// surface.
class SurfaceStages
{
public:
  /// `later`: faults that set in after `active`.
  void prepare(const Parameters& parameters, const FaultList& active, FaultSchedule later, SurfaceSource source);

  /// Surface for a set of faults; null if there is none.
  const ResponseSurface* of(const FaultList& faults) const noexcept;

private:
  static constexpr int MAX_TABLES = 4;     // with more tables, those between the first and the last are not built
  static constexpr std::size_t NODES = 8;  // intervals of a growth for a gear with equal teeth
  // intervals of a growth if the teeth differ, because each table takes several times as long
  static constexpr std::size_t FEW_NODES = 4;

  struct Stage
  {
    FaultList faults;
    SurfacePool::Surface surface;  ///< may be null
  };

  int list(const FaultList& active, FaultSchedule later);
  void obtain(Stage& stage);
  std::size_t endOfGrowth(std::size_t first, Fault& growing) const;
  void interpolate(std::size_t first, std::size_t last, const Fault& growing);

  std::vector<Stage> stages_;
  const Parameters* parameters_{};  // set during preparation
  const SurfaceSource* source_{};
};
}  // namespace hjt
