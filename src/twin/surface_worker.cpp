// SPDX-License-Identifier: BSD-3-Clause
#include "twin/surface_worker.hpp"

#include <exception>
#include <string>
#include <utility>

namespace hjt
{
namespace
{
/// Thrown out of the report of progress to end the building.
struct GivenUp : std::exception
{
};
}  // namespace

SurfaceWorker::SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source)
  : parameters_(parameters), source_(source), faults_(faults), thread_([this] { run(); })
{
}

SurfaceWorker::SurfaceWorker(const SurfaceWorker& other)
  : parameters_(other.parameters_)
  , source_(other.source_)
  , faults_(other.faults_)
  , surface_(other.isDone() ? other.surface_ : nullptr)
  , done_(surface_ ? 1 : 0)
  , thread_([this] { run(); })
{
}

SurfaceWorker::~SurfaceWorker()
{
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_up_.notify_one();
  thread_.join();
}

bool SurfaceWorker::request(const FaultList& faults) noexcept
{
  std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock())
  {
    return false;
  }
  faults_ = faults;
  asked_.fetch_add(1, std::memory_order_relaxed);
  lock.unlock();
  wake_up_.notify_one();
  return true;
}

void SurfaceWorker::run()
{
  std::unique_lock<std::mutex> lock(mutex_);
  for (std::uint64_t taken = done_; !stopping_;)
  {
    if (taken == asked_)
    {
      wake_up_.wait(lock);
      continue;
    }
    const FaultList faults = faults_;
    taken = asked_;
    lock.unlock();
    try
    {
      obtain(taken, faults);
    }
    catch (const std::exception&)  // the thread's border: not even the reason could be told
    {
      surface_ = nullptr;
    }
    done_.store(taken, std::memory_order_release);
    lock.lock();
  }
}

void SurfaceWorker::obtain(std::uint64_t request, const FaultList& faults)
{
  const auto given_up = [this, request] { return stopping_ || asked_ != request; };
  SurfaceSource watched = source_;
  watched.progress = [&](double done)
  {
    if (given_up())
    {
      throw GivenUp{};
    }
    if (source_.progress)
    {
      source_.progress(done);
    }
  };
  SurfacePool::Surface surface;
  try
  {
    surface = surfaceWithFaults(parameters_, faults, watched);
  }
  catch (const std::exception& error)
  {
    if (!given_up() && source_.notice)
    {
      source_.notice(std::string("no response surface: ") + error.what());
    }
  }
  surface_ = std::move(surface);
}
}  // namespace hjt
