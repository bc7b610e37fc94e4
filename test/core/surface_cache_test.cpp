// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "base/hash.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_table.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"
#include "surface/table_file.hpp"
#include "test/core/response_surface_support.hpp"

namespace hjt
{
namespace
{
namespace fs = std::filesystem;

TEST(SurfaceRing, TellsAfterHowManyPitchesTheGearIsTheSameAgain)
{
  const auto repetition = [](const std::string& error)
  {
    const Parameters parameters = error.empty() ? shippedParameters() : shippedParameters({ error });
    return SurfaceRing(parameters, JointModel(parameters)).repetition();
  };
  EXPECT_EQ(repetition(""), 1);
  EXPECT_EQ(repetition("manufacture.wave_generator_eccentricity=[5.0e-6, 2.0e-6]"), 1);
  EXPECT_EQ(repetition("manufacture.flexspline_pitch_deviation=2.0e-6"), 100);
  EXPECT_EQ(repetition("manufacture.circular_spline_pitch_deviation=2.0e-6"), 101);
}

TEST(SurfaceBuilder, AGearWithErrorsOnBothMembersHasNone)
{
  std::string notice;
  Twin twin(shippedParameters({ "solver.scene=auto", "manufacture.flexspline_pitch_deviation=2.0e-6",
                                "manufacture.circular_spline_pitch_deviation=2.0e-6" }),
            { cacheDirectory(), {}, [&](const std::string& what) { notice = what; } });
  EXPECT_NE(notice.find("does not repeat after a turn"), std::string::npos);
  twin.commandMotorTorque(0, 0.5);
  advance(twin, SECOND / 100);
  EXPECT_FALSE(twin.onSurface());
}

TEST(SurfaceCache, ASpoiltOrForeignFileIsBuiltAnew)
{
  surface();
  const std::string file = surfaceCacheFile(surfaceParameters(), cacheDirectory());
  ASSERT_TRUE(fs::exists(file));
  const auto size = fs::file_size(file);
  int built = 0;
  const SurfaceSource counting{ cacheDirectory(), [&](double done) { built += done >= 1.0 ? 1 : 0; }, {} };
  ASSERT_TRUE(obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", counting));
  EXPECT_EQ(built, 0);
  {
    // Another file in its place: the one of before is in use.
    fs::copy_file(file, file + "_spoilt");
    std::fstream spoilt(file + "_spoilt", std::ios::in | std::ios::out | std::ios::binary);
    spoilt.seekp(static_cast<std::streamoff>(size / 2));
    spoilt.put('!');
    fs::rename(file + "_spoilt", file);
  }
  ASSERT_TRUE(obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", counting));
  EXPECT_EQ(built, 1);
  EXPECT_EQ(fs::file_size(file), size);
  EXPECT_NE(surfaceCacheFile(shippedParameters({ "mesh.stiffness=1.0e+7" }), "x"),
            surfaceCacheFile(shippedParameters(), "x"));
  for (const char* other : { "health.averaging_time=2.0", "cup.friction_torque=1.0", "output.load_inertia=3.0" })
  {
    EXPECT_EQ(surfaceCacheFile(shippedParameters({ other }), "x"), surfaceCacheFile(shippedParameters(), "x"));
  }
}

/// A gear whose table is small.
Parameters narrowParameters()
{
  return shippedParameters({ "solver.scene=auto", "output.load_torque_limit=20.0", "motor.torque_limit=0.19" });
}

/// How often and with which permissions a file is in the memory of this process: "r--s r--s ", say.
std::string mappingsOf(const std::string& path)
{
  std::ifstream maps("/proc/self/maps");
  std::string found;
  for (std::string line; std::getline(maps, line);)
  {
    std::istringstream words(line);
    std::string range;
    std::string permissions;
    words >> range >> permissions;
    found += line.find(path) != std::string::npos ? permissions + ' ' : "";
  }
  return found;
}

TEST(SurfaceCache, IsInMemoryOnceForAllWhoUseIt)
{
  const TemporaryFolder folder;
  const SurfaceSource source{ folder.path().string(), {}, {} };
  const Parameters parameters = narrowParameters();
  const std::string file = surfaceCacheFile(parameters, folder.path().string());
  std::optional<SurfaceTables> built = obtainSurface(parameters, JointModel(parameters), "", source);
  ASSERT_TRUE(built);
  EXPECT_EQ(mappingsOf(file), "r--s ") << "who builds it takes it from the file too";
  const std::optional<SurfaceTables> read = obtainSurface(parameters, JointModel(parameters), "", source);
  ASSERT_TRUE(read);
  EXPECT_EQ(mappingsOf(file), "r--s r--s ");
  EXPECT_TRUE(built->table.nodes == read->table.nodes);
  built.reset();
  EXPECT_EQ(mappingsOf(file), "r--s ");
  fs::remove_all(folder.path());
  double sum = 0.0;
  for (const SurfaceNode& node : read->table.nodes)
  {
    sum += node[SurfaceNode::ENERGY];
  }
  EXPECT_GT(sum, 0.0) << "still there without its name";
}

TEST(SurfaceCache, RemovesWhatHasNotBeenUsedForLongest)
{
  const TemporaryFolder folder;
  const Parameters parameters = narrowParameters();
  const auto put = [&](const std::string& name, std::uintmax_t size, std::chrono::hours ago)
  {
    const fs::path path = folder.path() / name;
    std::ofstream(path) << ' ';
    fs::resize_file(path, size);  // holes: they take no room
    fs::last_write_time(path, fs::file_time_type::clock::now() - ago);
    return path;
  };
  setenv("HJT_CACHE_LIMIT", "1074.5", 1);
  const auto oldest = put("surface_1.bin", 700000000, std::chrono::hours(30));
  const auto older = put("deviations_2.bin", 300000000, std::chrono::hours(20));
  const auto last = put("surface_3.bin", 500000000, std::chrono::hours(10));
  const auto abandoned = put("surface_4.bin.123.part", 10, std::chrono::hours(2));
  const auto in_work = put("surface_5.bin.124.part", 10, std::chrono::hours(0));
  const auto foreign = put("notes.bin", 2000000000, std::chrono::hours(40));
  std::string notice;
  const SurfaceSource source{ folder.path().string(), {}, [&](const std::string& text) { notice += text; } };
  ASSERT_TRUE(obtainSurface(parameters, JointModel(parameters), "", source));
  EXPECT_THAT(notice, testing::HasSubstr("removed 1 table of response surfaces, the least recently used (700 MB), "));
  EXPECT_THAT(notice, testing::HasSubstr(folder.path().string() + " holds at most 1075 MB"));
  unsetenv("HJT_CACHE_LIMIT");
  const fs::path own = surfaceCacheFile(parameters, folder.path().string());
  for (const fs::path& path : { older, last, in_work, foreign, own })
  {
    EXPECT_TRUE(fs::exists(path)) << path;
  }
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_FALSE(fs::exists(abandoned));

  // Reading counts as use.
  fs::last_write_time(own, fs::file_time_type::clock::now() - std::chrono::hours(50));
  ASSERT_TRUE(obtainSurface(parameters, JointModel(parameters), "", source));
  EXPECT_THAT(tidyCache(folder.path().string(), "", 600000000), testing::HasSubstr("removed 1 table "));
  EXPECT_FALSE(fs::exists(older));
  EXPECT_THAT(tidyCache(folder.path().string(), last.string(), 0), testing::HasSubstr("removed 1 table "));
  EXPECT_TRUE(fs::exists(last));
  EXPECT_FALSE(fs::exists(own));
  EXPECT_EQ(tidyCache("/nowhere/at/all", "", 0), "");
}

TEST(SurfaceCache, LimitIsANumberInRange)
{
  EXPECT_EQ(cacheLimit(), 4000000000U);
  for (const char* bad : { "", "-1", "2 GB", "1e10", "nan" })
  {
    setenv("HJT_CACHE_LIMIT", bad, 1);
    EXPECT_THROW(cacheLimit(), ParameterError) << bad;
  }
  unsetenv("HJT_CACHE_LIMIT");
}

TEST(SurfaceCache, WritesThroughNoLinkAndToNoPipe)
{
  const TemporaryFolder folder;
  const Parameters parameters = narrowParameters();
  const fs::path file = surfaceCacheFile(parameters, folder.path().string());
  const std::string other = folder.write("precious", "text");
  const SurfaceSource source{ folder.path().string(), {}, {} };
  fs::create_symlink(other, file);
  ASSERT_TRUE(obtainSurface(parameters, JointModel(parameters), "", source));
  EXPECT_EQ(fs::file_size(other), 4U);
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file)));
  const auto size = fs::file_size(file);
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  ASSERT_TRUE(obtainSurface(parameters, JointModel(parameters), "", source));
  EXPECT_EQ(fs::file_size(file), size);
}

TEST(SurfaceCache, KeepsNothingWhereEverybodyMayWrite)
{
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::all);
  std::string notice;
  const SurfaceSource source{ folder.path().string(), {}, [&](const std::string& text) { notice += text; } };
  ASSERT_TRUE(obtainSurface(narrowParameters(), JointModel(narrowParameters()), "", source));
  EXPECT_THAT(notice, testing::HasSubstr(folder.path().string() + " is writable for everybody"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(SurfaceCache, KeyIsNotThatOfAFileCalledNone)
{
  const TemporaryFolder folder;
  const std::string key = surfaceCacheFile(shippedParameters(), "x");
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  folder.write("none", "text");
  EXPECT_EQ(surfaceCacheFile(shippedParameters(), "x"), key);
  fs::current_path(before);
}

/// Thrown when a surface begins to be built.
struct Building : std::exception
{
};

/// Whether the surface of the shipped gear is taken from this file in place of its own.
bool isTaken(const std::function<void(const std::string&)>& make_file)
{
  const std::string folder = cacheDirectory() + "/other";
  fs::create_directories(folder);
  make_file(surfaceCacheFile(surfaceParameters(), folder));
  const auto refuse = [](double) { throw Building(); };
  bool taken = true;
  try
  {
    obtainSurface(surfaceParameters(), JointModel(surfaceParameters()), "", { folder, refuse, {} });
  }
  catch (const Building&)
  {
    taken = false;
  }
  fs::remove_all(folder);
  return taken;
}

TEST(SurfaceCache, TakesOnlyRegularFilesThatNobodyElseWrites)
{
  surface();
  const std::string good = surfaceCacheFile(surfaceParameters(), cacheDirectory());
  EXPECT_EQ(fs::status(good).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_TRUE(isTaken([&](const std::string& path) { fs::copy_file(good, path); }));
  EXPECT_FALSE(isTaken([](const std::string& path) { ASSERT_EQ(mkfifo(path.c_str(), 0600), 0); }));
  EXPECT_FALSE(isTaken([](const std::string& path) { fs::create_symlink("/dev/zero", path); }));
  EXPECT_FALSE(isTaken([&](const std::string& path) { fs::create_symlink(good, path); }));
  EXPECT_FALSE(isTaken([](const std::string& path) { fs::create_directory(path); }));
  for (const fs::perms writer : { fs::perms::others_write, fs::perms::group_write })
  {
    EXPECT_FALSE(isTaken(
        [&](const std::string& path)
        {
          fs::copy_file(good, path);
          fs::permissions(path, writer, fs::perm_options::add);
        }));
  }
  EXPECT_FALSE(isTaken(
      [&](const std::string& path)
      {
        fs::copy_file(good, path);
        fs::resize_file(path, (std::uintmax_t{ 1 } << 30) + 1);  // a hole: takes no room
      }));
}

/// Numbers that are no table's are refused also where the hash of the file fits them.
TEST(SurfaceCache, RefusesATableThatIsNoneUnderTheRightHash)
{
  surface();
  std::ifstream file(surfaceCacheFile(surfaceParameters(), cacheDirectory()), std::ios::binary);
  const std::string good((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto bytes_of = [](double number)
  { return std::string(reinterpret_cast<const char*>(&number), sizeof(number)); };
  const std::size_t body = good.find(bytes_of(TWO_PI / 200) + bytes_of(101.0));  // pitch, ratio, columns, lines, values
  ASSERT_NE(body, std::string::npos);
  const auto is_taken_with = [&](std::size_t place, double number)
  {
    std::string bytes = good.substr(0, good.size() - sizeof(std::uint64_t));
    bytes.replace(body + place * sizeof(number), sizeof(number), bytes_of(number));
    const std::uint64_t sum = tableChecksum(bytes);
    bytes.append(reinterpret_cast<const char*>(&sum), sizeof(sum));
    return isTaken([&](const std::string& path) { std::ofstream(path, std::ios::binary) << bytes; });
  };
  constexpr std::size_t FIRST_LINE = 4;
  double first_line = 0.0;
  std::memcpy(&first_line, good.data() + body + FIRST_LINE * sizeof(double), sizeof(double));
  EXPECT_TRUE(is_taken_with(FIRST_LINE, first_line));
  for (const auto& [place, number] : std::vector<std::pair<std::size_t, double>>{ { 0, -TWO_PI / 200 },
                                                                                  { 1, 0.0 },
                                                                                  { 2, 1e18 },
                                                                                  { 3, 2.0 },
                                                                                  { FIRST_LINE, 1.0 },
                                                                                  { FIRST_LINE + 1, first_line },
                                                                                  { FIRST_LINE + 1, std::nan("") },
                                                                                  { 20000, HUGE_VAL } })
  {
    EXPECT_FALSE(is_taken_with(place, number)) << place << ": " << number;
  }
}

/// A parameter is in the key unless the table of fields says that it shapes no surface.
TEST(SurfaceCache, TheKeyHasEveryParameterThatShapesTheSurface)
{
  const Parameters parameters = shippedParameters();
  const std::string sound = describeSurfaceParameters(parameters, false);
  const std::string faulty = describeSurfaceParameters(parameters, true);
  visitFields(parameters,
              [&](const std::string& key, const auto&... rest)
              {
                const Meaning meaning = std::get<sizeof...(rest) - 1>(std::forward_as_tuple(rest...));
                EXPECT_EQ(sound.find(key + ": ") != std::string::npos, meaning.shapes == Shapes::SURFACE) << key;
                EXPECT_EQ(faulty.find(key + ": ") != std::string::npos, meaning.shapes != Shapes::OTHERS) << key;
              });
  EXPECT_NE(sound.find("mesh.stiffness: "), std::string::npos);
  EXPECT_EQ(sound.find("joint.name: "), std::string::npos);
  EXPECT_EQ(sound.find("fault_scale."), std::string::npos);
  EXPECT_EQ(std::string(surfaceSourceHash()).size(), 16U);
}

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

SurfacePool::Surface smallSurface()
{
  return std::make_shared<const ResponseSurface>(
      SurfaceTable{ 1.0, 1.0, 1, { 0.0, 1.0 }, SurfaceNodes(std::vector<SurfaceNode>(4)), {} });
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

  EXPECT_THROW(pool.obtain("a", fail), std::runtime_error);
  EXPECT_TRUE(pool.obtain("a", smallSurface));
  failing = false;
  std::thread other([&] { EXPECT_THROW(pool.obtain("b", fail), std::runtime_error); });
  while (!failing)
  {
    std::this_thread::yield();
  }
  EXPECT_TRUE(pool.obtain("b", smallSurface));  // waits for the other's, then makes its own
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
    return smallSurface();
  };
  SurfacePool::Surface first;
  std::thread other([&] { first = pool.obtain("a", make); });
  const SurfacePool::Surface second = pool.obtain("a", make);
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
