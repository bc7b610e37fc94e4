// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_pool.hpp"

#include <algorithm>
#include <exception>

namespace hjt
{
SurfacePool::Surface SurfacePool::obtain(const std::string& key, const std::function<Surface()>& make)
{
  while (true)
  {
    std::promise<Surface> promise;
    std::shared_future<Surface> surface;
    bool mine = false;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      const auto found = find(key);
      mine = found == entries_.end();
      if (mine)
      {
        entries_.emplace_front(key, promise.get_future().share());
        if (entries_.size() > kept_)
        {
          entries_.pop_back();
        }
      }
      else
      {
        entries_.splice(entries_.begin(), entries_, found);
      }
      surface = entries_.front().second;
    }
    if (mine)
    {
      try
      {
        promise.set_value(make());
      }
      catch (...)
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = find(key);
        if (found != entries_.end())
        {
          entries_.erase(found);
        }
        promise.set_exception(std::current_exception());
        throw;
      }
    }
    try
    {
      return surface.get();
    }
    catch (...)
    {
      // The reason that stopped the other thread, perhaps only a request, need not stop this one.
    }
  }
}

std::list<SurfacePool::Entry>::iterator SurfacePool::find(const std::string& key)
{
  return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.first == key; });
}
}  // namespace hjt
