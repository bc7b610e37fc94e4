// SPDX-License-Identifier: BSD-3-Clause
#include "harmonic_joint_twin/twin/surface_worker.hpp"

#include <exception>

namespace hjt
{
namespace
{
/// Thrown out of the report of progress to end the building.
struct GivenUp : std::exception
{
};
}  // namespace

SurfaceWorker::SurfaceWorker(const Parameters& parameters, const JointModel& model, const std::string& faults,
                             const SurfaceSource& source)
{
  SurfaceSource watched = source;
  watched.progress = [this, tell = source.progress](double done)
  {
    if (stopping_)
    {
      throw GivenUp{};
    }
    if (tell)
    {
      tell(done);
    }
  };
  thread_ = std::thread(
      [this, parameters, model, faults, watched]
      {
        try
        {
          surface_ = sharedSurface(parameters, model, faults, watched);
          ready_.store(true, std::memory_order_release);
        }
        catch (const std::exception& error)
        {
          if (!stopping_ && watched.notice)
          {
            watched.notice(std::string("no response surface: ") + error.what());
          }
        }
      });
}

SurfaceWorker::~SurfaceWorker()
{
  stopping_ = true;
  thread_.join();
}
}  // namespace hjt
