// SPDX-License-Identifier: BSD-3-Clause
#include "apps/tool/plan_options.hpp"

#include <algorithm>
#include <iostream>
#include <mutex>
#include <set>
#include <thread>

#include "output/progress.hpp"

namespace hjt
{
void addJobsOption(Command& command, unsigned& jobs)
{
  jobs = std::max(1u, std::thread::hardware_concurrency());
  command.add("--jobs", jobs, "runs at the same time").range(1, 4096);
}

SurfaceSource sharedSurfaces(const Plan& plan, unsigned jobs)
{
  struct Remarks
  {
    std::mutex mutex;
    std::set<std::string> shown;
    Progress building{ "building response surfaces" };
  };
  const auto remarks = std::make_shared<Remarks>();
  const auto show = [remarks](double done)
  {
    const std::lock_guard<std::mutex> lock(remarks->mutex);
    remarks->building.update(done);
  };
  const auto tell = [remarks](const std::string& what)
  {
    const std::lock_guard<std::mutex> lock(remarks->mutex);
    if (remarks->shown.insert(what).second)
    {
      std::cerr << "warning: " << what << '\n';
    }
  };
  return { plan.lives() != nullptr ? "" : surfaceCacheDirectory(), show, tell,
           std::make_shared<SurfacePool>(jobs + 2) };
}
}  // namespace hjt
