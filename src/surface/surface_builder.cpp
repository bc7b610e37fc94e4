// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_builder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <mutex>

#include "base/number_text.hpp"
#include "surface/surface_lines.hpp"

namespace hjt
{
namespace
{
using Node = SurfaceNode;
using Line = SurfaceLine;
using Lines = std::map<double, Line>;  // lines by their v, see SurfaceTable [rad]

constexpr double TORQUE_MARGIN = 2.0;  // largest torque of the table over the torque limit [-]
constexpr int COARSE_LINES = 32;       // approximate number of lines on each side of no load before refinement
constexpr int MAX_HALVINGS = 9;        // largest number of halvings of an interval between two lines
constexpr int MIN_COLUMNS = 16;
constexpr int MAX_COLUMNS = 64;

/// Mirror image of a line: the line at the opposite v of a gear with mirror symmetry.
Line mirrorImage(const Line& line)
{
  Line image(line.rbegin(), line.rend());
  for (Node& node : image)
  {
    node.set(SurfaceNode::ENERGY_BY_U, -node[SurfaceNode::ENERGY_BY_U]);
    node.set(SurfaceNode::ENERGY_BY_V, -node[SurfaceNode::ENERGY_BY_V]);
  }
  return image;
}

/// Builder of a SurfaceTable. Every coarse line (line before refinement), and every interval between two coarse lines,
/// is a separate task that begins with a newly inserted ring. The bits of a table therefore do not depend on the number
/// of threads.
class SurfaceBuilder
{
public:
  SurfaceBuilder(const SurfaceParameters& parameters, const JointModel& model,
                 const std::function<void(double)>& progress, std::size_t max_points, unsigned threads)
    : parameters_(parameters), model_(model), progress_(progress), max_points_(max_points), threads_(threads)
  {
  }

  SurfaceBuild build()
  {
    SurfaceBuild result;
    LineRing line_ring(parameters_, model_);
    SurfaceRing& ring = line_ring.ring();
    limit_ = ring.torqueLimit();
    step_ = ring.twist(TORQUE_MARGIN * limit_) / COARSE_LINES;
    if (!(limit_ > 0.0))
    {
      failure_reason_ = "motor.torque_limit and output.load_torque_limit are 0, so that a table would have no range";
    }
    else if (!ring.insert())
    {
      failure_reason_ = "the insertion of the wave generator did not converge";
    }
    if (good())
    {
      columns_ = fewestColumns(line_ring);
      mirrored_ = ring.isMirrored();
      coverRange(line_ring);
    }
    if (good())
    {
      refine();
    }
    if (good())
    {
      result.table = { ring.pitch(), ring.ratio(), columns_, {}, {}, {}, checks_ };
      fill(result.table);
      result.table.teeth = buildToothResponse(parameters_, model_, withinLimit(), step_, mirrored_, threads_, solves_);
    }
    result.failure_reason = failure_reason_;
    result.solves = solves_ + ring.solves();
    return result;
  }

private:
  bool good() const { return failure_reason_.empty(); }

  /// Least number of columns that meets the tolerance between the columns, at the loads that the ring can carry.
  int fewestColumns(LineRing& ring)
  {
    int columns = MIN_COLUMNS;
    for (const double load : { 0.1, 0.3, 1.0 })
    {
      const double v = -ring.ring().twist(load * limit_);
      const Line finest = ring.leadTo(v, step_) ? ring.measure(v, 2 * MAX_COLUMNS) : Line{};
      const auto miss = [&] { return LineCheck(ring.ring(), columns).missOfColumns(v, finest); };
      while (!finest.empty() && columns < MAX_COLUMNS && miss() > 1.0)
      {
        columns *= 2;
      }
      if (!finest.empty())
      {
        note(finest, miss());
      }
    }
    return columns;
  }

  /// Measures the coarse lines up to TORQUE_MARGIN times the torque limit in both directions of load, or in one
  /// direction if the gear has mirror symmetry.
  void coverRange(LineRing& ring)
  {
    for (const double direction : { 1.0, -1.0 })
    {
      bool found = ring.leadTo(0.0, step_);
      double reached = 0.0;
      for (int i = direction > 0.0 ? 0 : 1;
           i <= 2 * COARSE_LINES && found && reached < TORQUE_MARGIN * limit_ && !(mirrored_ && direction < 0.0); ++i)
      {
        const double v = direction * i * step_;
        found = ring.ring().moveTo(0.0, v);
        if (found)
        {
          reached = std::abs(ring.ring().measure()[SurfaceNode::ENERGY_BY_V]);
          coarse_.push_back(v);
        }
      }
    }
    std::sort(coarse_.begin(), coarse_.end());
    std::vector<Line> lines(coarse_.size());
    run(coarse_.size(), 0.0, 0.1,
        [&](std::size_t i)
        {
          LineRing own(parameters_, model_);
          if (own.leadTo(coarse_[i], step_))
          {
            lines[i] = measure(own, coarse_[i]);
          }
          solves_ += own.ring().solves();
        });
    keepRange(lines);
  }

  /// Keeps the lines from no load up to the first line without an equilibrium in each direction of load.
  void keepRange(std::vector<Line>& lines)
  {
    const auto none = static_cast<std::size_t>(std::find(coarse_.begin(), coarse_.end(), 0.0) - coarse_.begin());
    std::size_t first = none;
    std::size_t end = none;
    while (end < lines.size() && !lines[end].empty())
    {
      ++end;
    }
    while (first > 0 && !lines[first - 1].empty())
    {
      --first;
    }
    const auto reached = [&](std::size_t i) { return std::abs(lines[i].front()[SurfaceNode::ENERGY_BY_V]); };
    const double least = end == none ? 0.0 : mirrored_ ? reached(end - 1) : std::min(reached(end - 1), reached(first));
    if (good() && least < limit_)
    {
      TextStream text;
      text << "the teeth have no equilibrium for more than " << least
           << " N.m at the output, but load or motor can apply " << limit_ << " N.m";
      failure_reason_ = text.str();
    }
    coarse_ = { coarse_.begin() + static_cast<std::ptrdiff_t>(first),
                coarse_.begin() + static_cast<std::ptrdiff_t>(end) };
    for (std::size_t i = first; i < end; ++i)
    {
      lines_[coarse_[i - first]] = std::move(lines[i]);
    }
  }

  /// v of the coarse lines up to the first line above the torque limit in each direction of load [rad].
  std::vector<double> withinLimit() const
  {
    const auto beyond = [&](double v) { return std::abs(lines_.at(v).front()[SurfaceNode::ENERGY_BY_V]) >= limit_; };
    std::vector<double> within;
    for (std::size_t i = 0; i < coarse_.size(); ++i)
    {
      const std::size_t inner = coarse_[i] > 0.0 ? i - 1 : coarse_[i] < 0.0 ? i + 1 : i;
      if (!beyond(coarse_[inner]))
      {
        within.push_back(coarse_[i]);
      }
    }
    return within;
  }

  void refine()
  {
    std::vector<Lines> between(coarse_.size() - 1);
    run(between.size(), 0.1, 1.0,
        [&](std::size_t i)
        {
          LineRing own(parameters_, model_);
          const double inner = std::abs(coarse_[i]) < std::abs(coarse_[i + 1]) ? coarse_[i] : coarse_[i + 1];
          if (own.leadTo(inner, step_))
          {
            refine(own, { coarse_[i], lines_.at(coarse_[i]) }, { coarse_[i + 1], lines_.at(coarse_[i + 1]) }, 0,
                   between[i]);
          }
          else
          {
            fail("the ring has no equilibrium where an earlier solve had found one");
          }
          solves_ += own.ring().solves();
        });
    for (Lines& lines : between)
    {
      lines_.merge(lines);
    }
  }

  struct Placed
  {
    double v;
    const Line& line;
  };

  void refine(LineRing& ring, const Placed& below, const Placed& above, int halvings, Lines& found)
  {
    const double middle = 0.5 * (below.v + above.v);
    const Line& line = found[middle] = measure(ring, middle);
    if (line.empty())
    {
      fail("the ring has no equilibrium between two angles at which it has equilibria");
      return;
    }
    const double miss = LineCheck(ring.ring(), columns_).miss(below.v, below.line, above.v, above.line, middle, line);
    if (miss > 1.0 && halvings < MAX_HALVINGS)
    {
      refine(ring, below, { middle, line }, halvings + 1, found);
      if (!failed_)
      {
        refine(ring, { middle, line }, above, halvings + 1, found);
      }
      return;
    }
    note(line, miss);
  }

  /// Stores the result of a check. Lines above the torque limit do not count, because teeth can snap above this limit.
  void note(const Line& line, double miss)
  {
    if (std::abs(line.front()[SurfaceNode::ENERGY_BY_V]) <= limit_)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      checks_.add(miss);
    }
  }

  /// Measures the line of the table at `v`. Empty: no equilibrium, no room for its points, or another task has failed.
  Line measure(LineRing& ring, double v)
  {
    const std::size_t size = (static_cast<std::size_t>(columns_) + 1) * (mirrored_ ? 2 : 1);
    if (points_.fetch_add(size) + size > max_points_)
    {
      fail(tooManyPoints(parameters_, max_points_));
    }
    return failed_ ? Line{} : ring.measure(v, columns_);
  }

  /// Stores the reason of a failure if it is the first failure.
  void fail(const std::string& reason)
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failed_)
    {
      failure_reason_ = reason;
    }
    failed_ = true;
  }

  void fill(SurfaceTable& table)
  {
    if (mirrored_)
    {
      Lines mirrored;
      for (const auto& [v, line] : lines_)
      {
        mirrored[-v] = v > 0.0 ? mirrorImage(line) : line;
      }
      lines_.merge(mirrored);
    }
    Line nodes;
    for (const auto& [v, line] : lines_)
    {
      table.lines.push_back(v);
      nodes.insert(nodes.end(), line.begin(), line.end());
    }
    table.nodes = SurfaceNodes(std::move(nodes));
  }

  void run(std::size_t count, double from, double to, const std::function<void(std::size_t)>& task)
  {
    runTasks(count, threads_, task,
             [&](std::size_t done)
             {
               if (progress_ && count > 0)
               {
                 progress_(from + (to - from) * static_cast<double>(done) / static_cast<double>(count));
               }
             });
  }

  const SurfaceParameters parameters_;
  const JointModel& model_;
  std::function<void(double)> progress_;
  std::size_t max_points_;
  unsigned threads_;
  int columns_{};
  double limit_{};              // torque limit at the output [N.m]
  double step_{};               // distance of coarse lines in v [rad]
  bool mirrored_{};             // whether the gear has mirror symmetry; then only lines of v >= 0 are measured
  std::vector<double> coarse_;  // v of the coarse lines, ascending
  Lines lines_;
  std::atomic<std::size_t> points_{ 0 };
  std::atomic<int> solves_{ 0 };
  std::atomic<bool> failed_{ false };
  std::mutex mutex_;  // protects failure_reason_ and checks_
  GridChecks checks_;
  std::string failure_reason_;
};
}  // namespace

SurfaceBuild buildSurface(const Parameters& parameters, const JointModel& model,
                          const std::function<void(double)>& progress, std::size_t max_points, unsigned threads)
{
  return SurfaceBuilder(parameters, model, progress, max_points, threads).build();
}
}  // namespace hjt
