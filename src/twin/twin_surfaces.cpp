// SPDX-License-Identifier: BSD-3-Clause
#include "twin/twin_surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "twin/twin_impl.hpp"

namespace hjt
{
namespace
{
/// Exception by which the progress callback ends the build of a surface.
struct GivenUp : std::exception
{
};

bool isOfThePlace(const Fault& one, const Fault& other) noexcept
{
  return one.kind == other.kind && one.place == other.place;
}

double severityOf(const FaultList& faults, const Fault& which) noexcept
{
  const ActiveFault* found = std::find_if(faults.begin(), faults.end(),
                                          [&](const ActiveFault& active) { return isOfThePlace(active.fault, which); });
  return found != faults.end() ? found->fault.severity : 0.0;
}

FaultList without(const FaultList& faults, const Fault& which)
{
  FaultList left = faults;
  Fault none = which;
  none.severity = 0.0;
  left.set(none, 0);
  return left;
}

bool hasBearingFaults(const FaultList& faults) noexcept
{
  return std::any_of(faults.begin(), faults.end(),
                     [](const ActiveFault& active) { return isOfTheBalls(active.fault); });
}

/// Finds the only fault that changes from the list `before` to the list `after`. `growing` receives the fault with its
/// severity in `after`. @returns false if several faults change, or if `after` has a fault of the bearing.
bool grows(const FaultList& before, const FaultList& after, Fault& growing)
{
  for (const FaultList* list : { &after, &before })
  {
    for (const ActiveFault& active : *list)
    {
      if (severityOf(before, active.fault) != severityOf(after, active.fault))
      {
        growing = active.fault;
        growing.severity = severityOf(after, active.fault);
        return !hasBearingFaults(after) && isSame(without(before, growing), without(after, growing));
      }
    }
  }
  return false;
}

/// Weights [-] by which the values at `places` add up to the value at `x` of their Lagrange polynomial.
std::vector<double> lagrangeWeights(const std::vector<double>& places, double x)
{
  std::vector<double> weights(places.size(), 1.0);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (std::size_t j = 0; j < places.size(); ++j)
    {
      weights[i] *= i == j ? 1.0 : (x - places[j]) / (places[i] - places[j]);
    }
  }
  return weights;
}
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
    catch (const std::exception&)  // the function `notice` threw; no exception may leave the thread
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

bool isSame(const FaultList& one, const FaultList& other) noexcept
{
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const ActiveFault& a, const ActiveFault& b)
                    { return isOfThePlace(a.fault, b.fault) && a.fault.severity == b.fault.severity; });
}

void SurfaceStages::prepare(const Parameters& parameters, const FaultList& active, FaultSchedule later,
                            SurfaceSource source)
{
  if (!source.pool)
  {
    // With a pool, all severities of a fault of the bearing share the tables of gear and balls.
    source.pool = std::make_shared<SurfacePool>(2);
  }
  parameters_ = &parameters;
  source_ = &source;
  const bool few = list(active, std::move(later)) <= MAX_TABLES;
  std::size_t left_out = 0;
  for (std::size_t i = 0; i < stages_.size(); ++i)
  {
    Fault growing;
    const std::size_t last = few ? i : endOfGrowth(i, growing);
    if (last - i > NODES)
    {
      interpolate(i, last, growing);
      i = last - 1;  // the growth of another fault can begin at stage `last`
    }
    else if (few || i == 0 || i + 1 == stages_.size())
    {
      obtain(stages_[i]);
    }
    else
    {
      left_out += stages_[i].surface ? 0 : 1;
    }
  }
  if (left_out > 0 && source.notice)
  {
    source.notice(std::to_string(left_out) + " of " + std::to_string(stages_.size()) +
                  " sets of faults have no response surface. The twin solves the full ring while such a set is active");
  }
  parameters_ = nullptr;
  source_ = nullptr;
}

/// Lists the sets of active faults in the order of time. @returns the number of gear tables that all sets would need.
int SurfaceStages::list(const FaultList& active, FaultSchedule later)
{
  stages_.clear();
  FaultList faults = active;
  Stamp since = 0;
  int tables = 0;
  bool is_another = true;  // whether the set needs another table of the gear than the set before
  for (bool more = true; more;)
  {
    Fault fault;
    Stamp stamp{};
    more = later.pop(std::numeric_limits<Stamp>::max(), fault, stamp);
    if (!more || stamp > since)
    {
      stages_.push_back({ faults, nullptr });
      since = stamp;
      tables += is_another ? 1 : 0;
      is_another = false;
    }
    if (more)
    {
      faults.set(fault, stamp);
      is_another = is_another || !isOfTheBalls(fault);
    }
  }
  return tables;
}

void SurfaceStages::obtain(Stage& stage)
{
  if (!stage.surface)
  {
    stage.surface = surfaceWithFaults(*parameters_, stage.faults, *source_);
  }
}

/// Index of the last stage up to which a single fault grows from the stage `first` on, while all other faults stay;
/// `first` if no fault grows. `growing` receives the growing fault.
std::size_t SurfaceStages::endOfGrowth(std::size_t first, Fault& growing) const
{
  std::size_t last = first;
  Fault next;
  while (last + 1 < stages_.size() && grows(stages_[last].faults, stages_[last + 1].faults, next) &&
         (last == first || isOfThePlace(next, growing)) && next.severity > severityOf(stages_[last].faults, next))
  {
    growing = next;
    ++last;
  }
  return last;
}

/// Obtains tables for some stages of a growth, and weighted sums of tables for the stages between. The tables of the
/// first and last stage come first, because they show whether the teeth differ, so that fewer tables are built.
void SurfaceStages::interpolate(std::size_t first, std::size_t last, const Fault& growing)
{
  obtain(stages_[first]);
  obtain(stages_[last]);
  const bool differ = stages_[last].surface && !stages_[last].surface->deviations().pitches.empty();
  const std::size_t intervals = differ ? FEW_NODES : NODES;
  std::vector<std::size_t> nodes;
  for (std::size_t i = 0; i <= intervals; ++i)
  {
    const std::size_t node = first + (last - first) * i / intervals;
    obtain(stages_[node]);
    if (stages_[node].surface)
    {
      nodes.push_back(node);
    }
  }
  for (std::size_t stage = first + 1; stage < last; ++stage)
  {
    const auto above = static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), stage) - nodes.begin());
    if (above == 0 || above == nodes.size() || nodes[above] == stage)
    {
      continue;
    }
    const std::size_t count = std::min(nodes.size(), ResponseSurface::MAX_SHARES);
    const std::size_t begin = std::min(above > 2 ? above - 2 : 0, nodes.size() - count);
    std::vector<double> places;
    for (std::size_t i = 0; i < count; ++i)
    {
      places.push_back(severityOf(stages_[nodes[begin + i]].faults, growing));
    }
    const std::vector<double> weights = lagrangeWeights(places, severityOf(stages_[stage].faults, growing));
    std::vector<ResponseSurface::Share> shares;
    for (std::size_t i = 0; i < count; ++i)
    {
      shares.push_back({ stages_[nodes[begin + i]].surface, weights[i] });
    }
    stages_[stage].surface = std::make_shared<const ResponseSurface>(std::move(shares));
  }
}

const ResponseSurface* SurfaceStages::of(const FaultList& faults) const noexcept
{
  const auto stage =
      std::find_if(stages_.begin(), stages_.end(), [&](const Stage& each) { return isSame(faults, each.faults); });
  return stage != stages_.end() ? stage->surface.get() : nullptr;
}

/// Obtains the surfaces for the configured faults, or starts a thread that obtains the surface for the active faults.
void Twin::Impl::prepareSurface(const SurfaceSource& source)
{
  if (source.background)
  {
    surface_faults = active;
    surface_worker.emplace(parameters, active, source);
  }
  else
  {
    stages.prepare(parameters, active, waiting, source);
  }
}

/// Surface of the drive with the active faults; null if there is none or it is not ready.
const ResponseSurface* Twin::Impl::presentSurface() const noexcept
{
  if (surface_worker)
  {
    return isSame(active, surface_faults) ? surface_worker->surface() : nullptr;
  }
  return stages.of(active);
}

/// Makes the joint use the surface of the active faults or, while there is none, the full ring. @returns false if the
/// full ring has no equilibrium.
bool Twin::Impl::useSurface() noexcept
{
  const ResponseSurface* present = presentSurface();
  surface_awaited = surface_worker.has_value() && present == nullptr;
  return stepper.useSurface(present);
}

/// If the twin waits for a surface from the background, requests the surface of the active faults, and uses it when it
/// is ready. @returns false if the full ring has no equilibrium.
bool Twin::Impl::takeSurface() noexcept
{
  if (!surface_awaited)
  {
    return true;
  }
  if (!isSame(active, surface_faults))
  {
    if (surface_worker->request(active))
    {
      surface_faults = active;
    }
  }
  else if (surface_worker->surface() != nullptr)
  {
    return useSurface();
  }
  return true;
}
}  // namespace hjt
