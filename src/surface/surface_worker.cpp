// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_worker.hpp"

#include <algorithm>
#include <exception>
#include <sstream>
#include <string>

#include "base/number_text.hpp"
#include "model/faults/joint_faults.hpp"

namespace hjt
{
namespace
{
/// Thrown out of the report of progress to end the building.
struct GivenUp : std::exception
{
};

/// The faults, for the cache of surfaces; empty without.
std::string keyOf(const FaultList& faults)
{
  std::ostringstream text;
  for (const ActiveFault& active : faults)
  {
    text << describe(active.fault.kind).name << ' ' << numberText(active.fault.severity) << ' ' << active.fault.place
         << '\n';
  }
  return text.str();
}

/// Balls meet a spall differently at every turn: a table over the angles of motor and output cannot contain that.
bool isOfTheBalls(const ActiveFault& active) noexcept
{
  const FaultKind kind = active.fault.kind;
  return kind == FaultKind::BEARING_INNER_RACE || kind == FaultKind::BEARING_OUTER_RACE ||
         kind == FaultKind::BEARING_BALL || kind == FaultKind::BEARING_CAGE;
}
}  // namespace

SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source)
{
  if (parameters.contact.support == SupportKind::SINGLE_BALLS)
  {
    if (source.notice)
    {
      source.notice("no response surface on single balls: the twin solves the full ring at every step");
    }
    return nullptr;
  }
  if (std::any_of(faults.begin(), faults.end(), isOfTheBalls))
  {
    if (source.notice)
    {
      source.notice("no response surface with a fault of the bearing: the twin solves the full ring at every step");
    }
    return nullptr;
  }
  return sharedSurface(parameters, JointFaults(parameters, faults).model(), keyOf(faults), source);
}

SurfaceWorker::SurfaceWorker(const Parameters& parameters, const FaultList& faults, const SurfaceSource& source)
  : parameters_(parameters), source_(source), faults_(faults), thread_([this] { run(); })
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
  for (std::uint64_t taken = 0; !stopping_;)
  {
    if (taken == asked_)
    {
      wake_up_.wait(lock);
      continue;
    }
    const FaultList faults = faults_;
    taken = asked_;
    lock.unlock();
    obtain(taken, faults);
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
  done_.store(request, std::memory_order_release);
}
}  // namespace hjt
