// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>

#include "tracking/telemetry_rows.hpp"

namespace hjt
{
namespace
{
using Rows = RowFilter::Rows;

constexpr double SPEED = 3.14;    // of both joints, greatest [rad/s]
constexpr double PERIOD = 0.008;  // [s]
constexpr int ROWS = 600;

/// Of two joints that turn to and fro, up to 1 rad/s.
Rows rowsAt(double time, double stamp)
{
  Rows rows(2);
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const double phase = 2.0 * time + static_cast<double>(i);
    rows[i].time = stamp;
    rows[i].position = 0.5 * std::sin(phase);
    rows[i].recorded_velocity = std::cos(phase);
    rows[i].current = 2.0 + rows[i].recorded_velocity;
  }
  return rows;
}

Rows rowsAt(double time)
{
  return rowsAt(time, time);
}

struct Filtered
{
  std::vector<Rows> rows;
  LeftOutRows left_out;
};

Filtered filtered(const std::function<void(int, Rows&)>& change)
{
  RowFilter filter({ SPEED, SPEED });
  Filtered result;
  const auto visit = [&](const Rows& rows)
  {
    result.rows.push_back(rows);
    return true;
  };
  for (int k = 0; k < ROWS; ++k)
  {
    Rows rows = rowsAt(PERIOD * k);
    change(k, rows);
    filter.push(rows, visit);
  }
  filter.finish(visit);
  result.left_out = filter.leftOut();
  return result;
}

/// What it lets through is true.
void expectTrue(const Filtered& filtered)
{
  for (const Rows& rows : filtered.rows)
  {
    const Rows expected = rowsAt(rows.front().time);
    EXPECT_EQ(rows[0].position, expected[0].position) << rows.front().time;
    EXPECT_EQ(rows[1].position, expected[1].position) << rows.front().time;
  }
}

TEST(RowFilter, LetsASoundStreamThrough)
{
  const Filtered sound = filtered([](int, Rows&) {});
  EXPECT_EQ(sound.rows.size(), ROWS);
  EXPECT_EQ(sound.left_out.all(), 0U);
  expectTrue(sound);
}

TEST(RowFilter, LeavesOutAnAngleThatTheRowsBesideItContradict)
{
  for (const double off : { 0.15, -0.5, 50.0 })
  {
    for (const int bad : { 0, 300, ROWS - 1 })
    {
      const Filtered one = filtered([&](int k, Rows& rows) { rows[1].position += k == bad ? off : 0.0; });
      EXPECT_EQ(one.rows.size(), ROWS - 1) << off << " in row " << bad;
      EXPECT_EQ(one.left_out.unreachable, 1U) << off << " in row " << bad;
      expectTrue(one);
    }
  }
  const Filtered three = filtered([](int k, Rows& rows) { rows[0].position += k >= 300 && k < 303 ? 0.5 : 0.0; });
  EXPECT_EQ(three.left_out.unreachable, 3U);
  expectTrue(three);
}

TEST(RowFilter, LeavesOutWhatNoMessageHolds)
{
  for (const double value : { 1e300, std::nan(""), -HUGE_VAL })
  {
    const Filtered one = filtered([&](int k, Rows& rows) { rows[0].position = k == 300 ? value : rows[0].position; });
    EXPECT_EQ(one.left_out.impossible, 1U) << value;
    expectTrue(one);
  }
}

TEST(RowFilter, KeepsAJumpOfTheArmAndStampsOfAnotherUnit)
{
  const Filtered jump = filtered([](int k, Rows& rows) { rows[0].position += k >= 300 ? 0.5 : 0.0; });
  EXPECT_EQ(jump.rows.size(), ROWS);
  const Filtered fast = filtered([](int, Rows& rows) { rows[0].time *= 1e-3; });
  EXPECT_GT(fast.rows.size(), 0.9 * ROWS) << "for others to name the unit";
}

TEST(RowFilter, LeavesOutValuesThatRepeatInMotion)
{
  const Filtered held = filtered([](int k, Rows& rows) { rows = rowsAt(PERIOD * (k - k % 4), rows[0].time); });
  EXPECT_EQ(held.left_out.repeated, 3U * ROWS / 4U);
  expectTrue(held);
  const Filtered stuck = filtered(
      [](int k, Rows& rows)
      {
        rows = k > 300 && k <= 320 ? rowsAt(PERIOD * 300, rows[0].time) : rows;
        rows[0].recorded_velocity = rows[1].recorded_velocity = std::nan("");
      });
  EXPECT_EQ(stuck.left_out.repeated, 20U);
  expectTrue(stuck);
  const Filtered rest = filtered([](int, Rows& rows) { rows.assign(2, { rows[0].time, 0.3, 1.0 }); });
  EXPECT_EQ(rest.left_out.all(), 0U) << "an arm that stands repeats its values";
}

TEST(RowFilter, LeavesOutRowsOfABunch)
{
  const Filtered bunched = filtered(
      [](int k, Rows& rows)
      {
        const int last = k / 4 * 4 + 3;
        rows[0].time = rows[1].time = PERIOD * last + 0.0002 * (k % 4);
      });
  EXPECT_NEAR(static_cast<double>(bunched.left_out.bunched), 0.75 * ROWS, 20.0);
  const Filtered jitter =
      filtered([](int k, Rows& rows) { rows[0].time = rows[1].time += k % 2 == 0 ? 0.002 : -0.002; });
  EXPECT_EQ(jitter.left_out.all(), 0U);
}
}  // namespace
}  // namespace hjt
