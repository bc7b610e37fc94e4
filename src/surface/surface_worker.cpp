// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_worker.hpp"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "base/number_text.hpp"
#include "base/text_stream.hpp"
#include "model/faults/joint_faults.hpp"
#include "params/variants.hpp"

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
  TextStream text;
  for (const ActiveFault& active : faults)
  {
    text << describe(active.fault.kind).name << ' ' << numberText(active.fault.severity) << ' ' << active.fault.place
         << '\n';
  }
  return text.str();
}

/// The one fault of a gear of equal teeth that sits on a tooth or segment of the flexspline; null: it is not so.
const Fault* singleFaultOfATooth(const Parameters& parameters, const FaultList& faults)
{
  Parameters without = parameters;
  without.faults.clear();
  const Fault* fault = faults.size() == 1 ? &faults.begin()->fault : nullptr;
  const bool local =
      fault != nullptr && fault->place >= 0 &&
      (describe(fault->kind).place == FaultPlace::TOOTH || describe(fault->kind).place == FaultPlace::SEGMENT);
  return local && teethAreAlike(without) ? fault : nullptr;
}

/// The surface of a fault of tooth 0 serves for all: the gear is the same, turned by so many pitches.
SurfacePool::Surface shiftedSurface(const Parameters& parameters, Fault fault, const SurfaceSource& source)
{
  const int place = fault.place;
  fault.place = 0;
  FaultList first;
  first.set(fault, 0);
  const SurfacePool::Surface surface =
      sharedSurface(parameters, JointFaults(parameters, first).model(), keyOf(first), source);
  if (!surface)
  {
    return nullptr;
  }
  DeviationTable deviations = surface->deviations();
  deviations.shift = place;
  return std::make_shared<const ResponseSurface>(surface->table(), std::move(deviations));
}

SurfacePool::Surface none(const std::string& why, const SurfaceSource& source)
{
  if (source.notice)
  {
    source.notice("no response surface " + why + ": the twin solves the full ring at every step");
  }
  return nullptr;
}
}  // namespace

bool isOfTheBalls(const Fault& fault) noexcept
{
  return fault.kind == FaultKind::BEARING_INNER_RACE || fault.kind == FaultKind::BEARING_OUTER_RACE ||
         fault.kind == FaultKind::BEARING_BALL || fault.kind == FaultKind::BEARING_CAGE;
}

SurfacePool::Surface surfaceWithFaults(const Parameters& parameters, const FaultList& faults,
                                       const SurfaceSource& source)
{
  if (parameters.contact.support == SupportKind::SINGLE_BALLS)
  {
    return none("on single balls", source);
  }
  FaultList of_the_balls;
  FaultList others;
  for (const ActiveFault& active : faults)
  {
    (isOfTheBalls(active.fault) ? of_the_balls : others).set(active.fault, active.since);
  }
  const Fault* of_a_tooth = singleFaultOfATooth(parameters, others);
  const auto surface_of_others = [&]
  {
    return of_a_tooth != nullptr ?
               shiftedSurface(parameters, *of_a_tooth, source) :
               sharedSurface(parameters, JointFaults(parameters, others).model(), keyOf(others), source);
  };
  if (of_the_balls.empty())
  {
    return surface_of_others();
  }
  const RaceDeflection bearing =
      JointFaults(parameters, of_the_balls).model().ring.of<WaveGeneratorContact>().bearing();
  if (!bearing.dropsOneBall())
  {
    return none("with more than one fault of the bearing, or a spall longer than from ball to ball", source);
  }
  // One tooth alone changes little in what a ball does.
  const bool adds_up = of_a_tooth != nullptr && describe(of_a_tooth->kind).place == FaultPlace::TOOTH;
  const FaultList felt_by_balls = adds_up ? FaultList() : others;
  const SurfacePool::Surface balls =
      sharedBallSurface(parameters, JointFaults(parameters, felt_by_balls).model(), keyOf(felt_by_balls), source);
  const SurfacePool::Surface surface = balls && adds_up ? surface_of_others() : balls;
  return surface ? std::make_shared<const ResponseSurface>(surface->table(), surface->deviations(),
                                                           BallDrops(balls->balls()->table(), bearing)) :
                   nullptr;
}

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
