// SPDX-License-Identifier: BSD-3-Clause
#include "solver/response_surface.hpp"

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "surface/faulty_surface.hpp"
#include "surface/parallel_tasks.hpp"
#include "test/core/response_surface_support.hpp"

namespace hjt
{
namespace
{
TEST(ParallelTasks, PassOnWhatOneThrows)
{
  std::atomic<int> done{ 0 };
  const auto fail_at = [&](std::size_t number)
  {
    return [&done, number](std::size_t i)
    {
      if (i == number)
      {
        throw std::runtime_error("of the task");
      }
      ++done;
    };
  };
  for (const unsigned threads : { 1u, 3u })
  {
    EXPECT_THROW(runTasks(50, threads, fail_at(20), [](std::size_t) {}), std::runtime_error);
    EXPECT_THROW(runTasks(50, threads, fail_at(99), [](std::size_t) -> void { throw std::logic_error("of any task"); }),
                 std::logic_error);
    done = 0;
    std::size_t last = 0;
    runTasks(50, threads, fail_at(99), [&last](std::size_t finished) { last = finished; });
    EXPECT_EQ(done, 50);
    EXPECT_EQ(last, 50U);
  }
}

TEST(SurfacePool, TriesAgainWhereTheMakerFailed)
{
  SurfacePool pool(2);
  std::atomic<bool> failing{ false };
  const auto fail = [&]() -> SurfacePool::Surface
  {
    failing = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    throw std::runtime_error("given up");
  };
  const auto make = []
  {
    return std::make_shared<const ResponseSurface>(
        SurfaceTable{ 1.0, 1.0, 1, { 0.0, 1.0 }, SurfaceNodes(std::vector<SurfaceNode>(4)), {} });
  };
  EXPECT_THROW(pool.obtain("a", fail), std::runtime_error);
  EXPECT_TRUE(pool.obtain("a", make));
  failing = false;
  std::thread other([&] { EXPECT_THROW(pool.obtain("b", fail), std::runtime_error); });
  while (!failing)
  {
    std::this_thread::yield();
  }
  EXPECT_TRUE(pool.obtain("b", make));  // waits for the other's, then makes its own
  other.join();
}

TEST(SurfacePool, MakesEachSurfaceOnceForAllThreads)
{
  SurfacePool pool(2);
  std::atomic<int> made{ 0 };
  const auto make = [&made]
  {
    ++made;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return std::make_shared<const ResponseSurface>(
        SurfaceTable{ 1.0, 1.0, 1, { 0.0, 1.0 }, SurfaceNodes(std::vector<SurfaceNode>(4)), {} });
  };
  SurfacePool::Surface first;
  SurfacePool::Surface second;
  std::thread other([&] { first = pool.obtain("a", make); });
  second = pool.obtain("a", make);
  other.join();
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(first);
  EXPECT_EQ(first, second);

  pool.obtain("b", make);
  EXPECT_EQ(pool.obtain("a", make), first);
  pool.obtain("c", make);  // b was asked for longest ago
  EXPECT_EQ(pool.obtain("a", make), first);
  EXPECT_EQ(made, 3);
  pool.obtain("b", make);
  EXPECT_EQ(made, 4);
}
}  // namespace
}  // namespace hjt
