// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "twin/twin_impl.hpp"

namespace hjt
{
namespace
{
bool isSame(const FaultList& one, const FaultList& other) noexcept
{
  return std::equal(one.begin(), one.end(), other.begin(), other.end(),
                    [](const ActiveFault& a, const ActiveFault& b) {
                      return a.fault.kind == b.fault.kind && a.fault.place == b.fault.place &&
                             a.fault.severity == b.fault.severity;
                    });
}
}  // namespace

/// The surfaces of the drive with its configured faults, or a thread that obtains that of the present ones.
void Twin::Impl::prepareSurface(const SurfaceSource& source)
{
  if (source.background)
  {
    surface_faults = active;
    surface_worker.emplace(parameters, active, source);
  }
  else
  {
    prepareStages(source);
  }
}

/// One surface for each set of faults that the configured ones make as they set in one after the other. Where these are
/// so many as a fault that grows makes, only for the first and the last: their tables would take longer than the run.
void Twin::Impl::prepareStages(SurfaceSource source)
{
  if (!source.pool)
  {
    // Faults of the bearing that grow have the tables of gear and balls in common.
    source.pool = std::make_shared<SurfacePool>(2);
  }
  FaultSchedule later = waiting;
  FaultList faults = active;
  Stamp since = 0;
  int tables = 0;
  bool is_another = true;  // table of the gear
  for (bool more = true; more;)
  {
    Fault fault;
    Stamp stamp{};
    more = later.pop(std::numeric_limits<Stamp>::max(), fault, stamp);
    if (!more || stamp > since)
    {
      stages.push_back({ faults, nullptr });
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
  const bool few = tables <= MAX_STAGE_TABLES;
  for (Stage& stage : stages)
  {
    if (few || &stage == &stages.front() || &stage == &stages.back())
    {
      stage.surface = surfaceWithFaults(parameters, stage.faults, source);
    }
  }
  if (!few && source.notice)
  {
    source.notice(
        "response surfaces of the first and the last faults only: the twin solves the full ring while "
        "the others set in, more than " +
        std::to_string(MAX_STAGE_TABLES));
  }
}

/// That of the faults that are active, if it is there.
const ResponseSurface* Twin::Impl::presentSurface() const noexcept
{
  if (surface_worker)
  {
    return isSame(active, surface_faults) ? surface_worker->surface() : nullptr;
  }
  const auto stage =
      std::find_if(stages.begin(), stages.end(), [this](const Stage& each) { return isSame(active, each.faults); });
  return stage != stages.end() ? stage->surface.get() : nullptr;
}

/// The surface while it is that of the present faults; else the full ring, until one is there that was built beside.
void Twin::Impl::useSurface() noexcept
{
  const ResponseSurface* present = presentSurface();
  stepper.useSurface(present);
  surface_awaited = surface_worker.has_value() && present == nullptr;
}

/// The surface of the present faults, built in the background: requested, and used when ready.
void Twin::Impl::takeSurface() noexcept
{
  if (!surface_awaited)
  {
    return;
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
    useSurface();
  }
}
}  // namespace hjt
