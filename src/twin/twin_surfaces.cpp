// SPDX-License-Identifier: BSD-3-Clause
#include "twin/twin_impl.hpp"

namespace hjt
{
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
    stages.prepare(parameters, active, waiting, source);
  }
}

/// That of the faults that are active, if it is there.
const ResponseSurface* Twin::Impl::presentSurface() const noexcept
{
  if (surface_worker)
  {
    return isSame(active, surface_faults) ? surface_worker->surface() : nullptr;
  }
  return stages.of(active);
}

/// The surface while it is that of the present faults; else the full ring, until one is there that was built beside.
bool Twin::Impl::useSurface() noexcept
{
  const ResponseSurface* present = presentSurface();
  surface_awaited = surface_worker.has_value() && present == nullptr;
  return stepper.useSurface(present);
}

/// The surface of the present faults, built in the background: requested, and used when ready.
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
