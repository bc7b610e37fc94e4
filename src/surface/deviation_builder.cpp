// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_builder.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "surface/deviation_rings.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
namespace
{
/// Table of a tooth pitch whose edges are not yet joined to those of its neighbours.
struct OpenPitch
{
  int columns{};
  std::vector<double> lines;
  std::vector<SurfaceNode> nodes;
};

void levelEdge(OpenPitch& pitch, std::size_t column, const std::vector<double>& common)
{
  const std::size_t stride = static_cast<std::size_t>(pitch.columns) + 1;
  std::size_t kept = 0;  // index of the last line so far that is in `common`
  for (std::size_t i = 0, in_common = 0; i < pitch.lines.size(); ++i)
  {
    if (in_common == common.size() || pitch.lines[i] != common[in_common])
    {
      continue;
    }
    const std::array<SurfaceNode, 2> low{ pitch.nodes[kept * stride + column], {} };
    const std::array<SurfaceNode, 2> high{ pitch.nodes[i * stride + column], {} };
    const double height = pitch.lines[i] - pitch.lines[kept];
    for (std::size_t between = kept + 1; between < i; ++between)
    {
      const SurfaceCell cell(low.data(), high.data(), 0.0, (pitch.lines[between] - pitch.lines[kept]) / height,
                             static_cast<double>(pitch.columns), 1.0 / height);
      const SurfaceEnergy energy = cell.energy();
      SurfaceNode& node = pitch.nodes[between * stride + column];
      for (int value = SurfaceNode::BILINEAR; value < SurfaceNode::VALUES; ++value)
      {
        node.set(value, cell.value(value));
      }
      node.set(SurfaceNode::ENERGY, energy.value);
      node.set(SurfaceNode::ENERGY_BY_U, energy.by_u);
      node.set(SurfaceNode::ENERGY_BY_V, energy.by_v);
      node.set(SurfaceNode::ENERGY_BY_UV, energy.by_uv);
    }
    kept = i;
    ++in_common;
  }
}

/// Makes the values at the end of a pitch and at the start of the next pitch equal functions of v. On lines that only
/// one of the pitches has, the values at the common edge are interpolated between the lines that both pitches have.
void joinPitches(OpenPitch& before, OpenPitch& after)
{
  std::vector<double> common;
  std::set_intersection(before.lines.begin(), before.lines.end(), after.lines.begin(), after.lines.end(),
                        std::back_inserter(common));
  if (common.empty())
  {
    return;
  }
  levelEdge(before, static_cast<std::size_t>(before.columns), common);
  levelEdge(after, 0, common);
}

/// Joins all pitches to a table. The last pitch is joined to the first pitch.
DeviationTable tableOf(std::vector<OpenPitch> pitches, bool swaps_lobes)
{
  for (std::size_t number = 0; number < pitches.size(); ++number)
  {
    joinPitches(pitches[number], pitches[number + 1 < pitches.size() ? number + 1 : 0]);
  }
  DeviationTable table;
  table.swaps_lobes = swaps_lobes;
  for (OpenPitch& pitch : pitches)
  {
    table.pitches.push_back({ pitch.columns, std::move(pitch.lines), SurfaceNodes(std::move(pitch.nodes)) });
  }
  return table;
}

/// Comparison of a grid of deviations with the solved ring, between the nodes of the grid.
class DeviationCheck
{
public:
  using Torques = Eigen::Array2d;  ///< torques on output and motor [N.m]

  /// `ring`: ring of the gear, of which only torque limits and tolerances are used.
  explicit DeviationCheck(const SurfaceRing& ring) : ring_(ring) {}

  Torques torques(const SurfaceNode& deviation) const
  {
    return torques(deviation[SurfaceNode::ENERGY_BY_U], deviation[SurfaceNode::ENERGY_BY_V]);
  }

  bool departs(const SurfaceNode& node) const
  {
    constexpr double ROUNDING = 1e-8;  // largest deviation by rounding, as a share of the torque limit [-]
    const Torques torque = torques(node).abs();
    return std::max(torque[0], torque[1] * ring_.ratio()) > ROUNDING * ring_.torqueLimit();
  }

  /// Interpolation error if only the nodes at the ends of `columns` equal intervals of a strip are kept: root mean
  /// square over the other nodes, divided by the tolerance [-].
  double missOfColumns(const Strip& strip, int columns, const Torques& tolerance) const
  {
    const std::size_t stride = (strip.size() - 1) / static_cast<std::size_t>(columns);
    Torques squares = Torques::Zero();
    for (std::size_t first = 0; first + 1 < strip.size(); first += stride)
    {
      const std::array<SurfaceNode, 2> ends{ strip[first], strip[first + stride] };
      for (std::size_t i = 1; i < stride; ++i)
      {
        const double part = static_cast<double>(i) / static_cast<double>(stride);
        squares +=
            miss({ ends.data(), ends.data(), part, 0.0, static_cast<double>(columns), 1.0 }, strip[first + i]).square();
      }
    }
    return largest(squares / (static_cast<double>(columns) * (static_cast<double>(stride) - 1.0)), tolerance);
  }

  /// Interpolation error between two strips at the strip `middle` halfway between them: root mean square divided by the
  /// tolerance [-]. `height`: difference of v between the two strips [rad]. The check uses the mean because no grid
  /// resolves the single kinks where a tooth begins to touch.
  double missBetween(const Strip& below, const Strip& above, double height, const Strip& middle,
                     const Torques& tolerance) const
  {
    const std::size_t columns = middle.size() - 1;
    Torques squares = Torques::Zero();
    for (std::size_t i = 0; i < columns; ++i)
    {
      squares +=
          miss({ &below[i], &above[i], 0.0, 0.5, static_cast<double>(columns), 1.0 / height }, middle[i]).square();
    }
    return largest(squares / static_cast<double>(columns), tolerance);
  }

private:
  static double largest(const Torques& squares, const Torques& tolerance)
  {
    return (squares > 0.0).select(squares.sqrt() / tolerance, 0.0).maxCoeff();
  }

  Torques torques(double by_u, double by_v) const { return { -by_v, by_v / ring_.ratio() - by_u / ring_.pitch() }; }

  /// Torques of a cell minus the measured torques [N.m].
  Torques miss(const SurfaceCell& cell, const SurfaceNode& measured) const
  {
    const SurfaceEnergy energy = cell.energy();
    return torques(energy.by_u, energy.by_v) - torques(measured);
  }

  const SurfaceRing& ring_;
};

using Node = SurfaceNode;
using Line = DeviationLine;
using Lines = std::map<double, Line>;  // lines by their v, see SurfaceTable [rad]
using Rings = DeviationRings;
using Torques = DeviationCheck::Torques;

constexpr double SMALLEST = 0.1;      // least share of the largest deviation that a line is assumed to have [-]
constexpr double FINEST = 0.3;        // least tolerance of a deviation, as a share of the surface's tolerance [-]
constexpr double WIDEST = 3.0;        // largest factor by which FINEST may increase the tolerance of a deviation [-]
constexpr int COARSE_LINES = 12;      // number of lines on each side of no load before refinement, closest near no load
constexpr int MAX_HALVINGS = 5;       // largest number of halvings of an interval between two lines
constexpr double SAME_TORQUE = 1e-7;  // largest difference of equal torques, as a share of the torque limit [-]
constexpr int MIN_COLUMNS = 4;
constexpr int MAX_COLUMNS = 16;

/// Builder of a DeviationTable. Every coarse line (line before refinement), and every interval between two coarse
/// lines, is a separate task that begins with newly inserted rings. The bits of a table therefore do not depend on the
/// number of threads.
class DeviationBuilder
{
public:
  DeviationBuilder(const SurfaceParameters& parameters, const JointModel& equal, const JointModel& actual,
                   int repetition, const std::function<void(double)>& progress, std::size_t max_points,
                   unsigned threads)
    : parameters_(parameters)
    , equal_(equal)
    , model_(actual)
    , progress_(progress)
    , max_points_(max_points)
    , threads_(threads)
    , ring_(parameters, actual)
    , check_(ring_)
    , pitches_(static_cast<std::size_t>(repetition))
    , columns_(pitches_, 2 * MAX_COLUMNS)
  {
  }

  DeviationBuild build(double lowest, double highest)
  {
    DeviationBuild result;
    longest_way_ = (highest - lowest) / (4.0 * COARSE_LINES);
    chooseColumns(lowest, highest);
    if (!failed_)
    {
      coverRange(lowest, highest);
    }
    if (!failed_)
    {
      refine();
    }
    if (failed_)
    {
      result.failure_reason =
          too_many_ ? tooManyPoints(parameters_, max_points_) : "the ring has no equilibrium at some angles of a turn";
    }
    else
    {
      addImages();
      result.table = table();
    }
    result.solves = solves_;
    return result;
  }

private:
  using Set = std::vector<char>;  // for each pitch, whether it is in the set

  std::size_t next(std::size_t pitch) const { return pitch + 1 < pitches_ ? pitch + 1 : 0; }
  std::size_t last(std::size_t pitch) const { return pitch > 0 ? pitch - 1 : pitches_ - 1; }

  /// Number of points of a line in the pitches of `wanted`.
  std::size_t pointsOf(const Set& wanted) const
  {
    std::size_t points = 0;
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      points += wanted[pitch] ? static_cast<std::size_t>(columns_[pitch]) + 1 : 0;
    }
    return points;
  }

  /// Measures the deviations on the line at `v` for the pitches of `wanted`: first at their edges, then, with the motor
  /// turning back, within pitches that have deviations or a neighbour with deviations. @returns false and stops all
  /// tasks if the ring has no equilibrium.
  bool measureLine(Rings& rings, double v, const Set& wanted, Line& line)
  {
    const bool there = !failed_ && rings.leadTo(v, longest_way_);
    const std::vector<Node> equal =
        there ? rings.measureEqual(*std::max_element(columns_.begin(), columns_.end())) : std::vector<Node>{};
    if (equal.empty())
    {
      failed_ = true;
      return false;
    }
    bool good = true;
    const auto deviation = [&](std::size_t pitch, double part)
    {
      const auto column = static_cast<std::size_t>(std::llround(part * static_cast<double>(equal.size())));
      Node node;
      good = good && rings.measureActual(pitch, column, node);
      const Node& reference = equal[column];
      for (int i = 0; i < SurfaceNode::VALUES; ++i)
      {
        node.set(i, node[i] - reference[i]);
      }
      return node;
    };
    std::vector<Node> edges(pitches_);  // deviations at the start of each pitch
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      if (wanted[last(last(pitch))] || wanted[last(pitch)] || wanted[pitch] || wanted[next(pitch)])
      {
        edges[pitch] = deviation(pitch, 0.0);
      }
    }
    line.strips.resize(pitches_);
    for (std::size_t pitch = pitches_; pitch-- > 0;)
    {
      if (wanted[pitch])
      {
        const int columns = columns_[pitch];
        Strip& strip = line.strips[pitch];
        strip.resize(static_cast<std::size_t>(columns) + 1);
        strip.front() = edges[pitch];
        strip.back() = edges[next(pitch)];
        if (check_.departs(edges[last(pitch)]) || check_.departs(strip.front()) || check_.departs(strip.back()) ||
            check_.departs(edges[next(next(pitch))]))
        {
          for (int column = columns - 1; column > 0; --column)
          {
            strip[static_cast<std::size_t>(column)] = deviation(pitch, static_cast<double>(column) / columns);
          }
        }
      }
    }
    for (const Strip& strip : line.strips)
    {
      for (const Node& node : strip)
      {
        line.largest = line.largest.max(check_.torques(node).abs());
      }
    }
    line.overload = ring_.overload(equal.front());
    line.of_the_surface = { ring_.outputTolerance(equal.front()), ring_.motorTolerance(equal.front()) };
    failed_ = failed_ || !good;
    return good;
  }

  /// Measures a line. If the table has no room for the line, stops all tasks.
  bool addLine(Rings& rings, double v, const Set& wanted, Line& line)
  {
    const std::size_t size = pointsOf(wanted) * (mirror_ ? 2 : 1);
    if (points_.fetch_add(size) + size > max_points_)
    {
      too_many_ = true;
      failed_ = true;
    }
    return measureLine(rings, v, wanted, line);
  }

  /// Tolerance of the torques on a line [N.m]: a share of the largest deviation on the line and the coarse lines, but
  /// up to WIDEST times this share if the deviation is small compared with the surface's tolerance.
  Torques toleranceOf(const Line& line) const
  {
    const Torques own = line.overload * share_ * line.largest.max(SMALLEST * largest_);
    return own.max((FINEST * line.of_the_surface).min(WIDEST * own));
  }

  /// Chooses for each pitch the least number of columns that meets the tolerance between the columns.
  void chooseColumns(double lowest, double highest)
  {
    const std::array<double, 6> places{ 0.02 * highest, 0.1 * highest, 0.3 * highest,
                                        0.3 * lowest,   0.1 * lowest,  0.02 * lowest };
    std::vector<Line> lines(places.size());
    const auto measure = [&](Rings& rings, std::size_t i)
    { measureLine(rings, places[i], Set(pitches_, 1), lines[i]); };
    run({ 0, 4 }, 0.0, 0.07, measure);
    if (!failed_ && lowest == -highest)
    {
      const double torque = SAME_TORQUE * ring_.torqueLimit();
      mirror_ =
          DeviationMirror::find(lines[2], lines[3], swapsLobes(), { torque * ring_.pitch() / ring_.ratio(), torque });
    }
    if (mirror_)
    {
      lines.resize(4);
    }
    run({ 4, lines.size() }, 0.07, 0.1, measure);
    for (const Line& line : lines)
    {
      largest_ = largest_.max(line.largest);
    }
    if (failed_)
    {
      return;
    }
    std::vector<int> enough(pitches_, MIN_COLUMNS);
    for (const Line& line : lines)
    {
      for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
      {
        int& columns = enough[pitch];
        const auto miss = [&] { return check_.missOfColumns(line.strips[pitch], columns, toleranceOf(line)); };
        while (columns < MAX_COLUMNS && miss() > 1.0)
        {
          columns *= 2;
        }
        note(line, miss());
      }
    }
    // Under load the deviations of a pitch can move to a neighbouring pitch.
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      columns_[pitch] = std::max({ enough[last(pitch)], enough[pitch], enough[next(pitch)] });
    }
    for (std::size_t pitch = 0; pitch < pitches_ && mirror_; ++pitch)
    {
      int& columns = columns_[pitch];
      columns = std::max(columns, columns_[mirror_->imageOf(pitch)]);
      columns_[mirror_->imageOf(pitch)] = columns;
    }
  }

  /// Measures the coarse lines, which are closest near no load. With mirror symmetry, measures only lines of v >= 0.
  void coverRange(double lowest, double highest)
  {
    for (int i = mirror_ ? 0 : -COARSE_LINES; i <= COARSE_LINES; ++i)
    {
      const double part = static_cast<double>(i) / COARSE_LINES;
      coarse_.push_back((i < 0 ? lowest : highest) * part * part);
    }
    std::vector<Line> lines(coarse_.size());
    run({ 0, coarse_.size() }, 0.1, 0.3,
        [&](Rings& rings, std::size_t i) { addLine(rings, coarse_[i], Set(pitches_, 1), lines[i]); });
    for (std::size_t i = 0; i < coarse_.size(); ++i)
    {
      largest_ = largest_.max(lines[i].largest);
      lines_[coarse_[i]] = std::move(lines[i]);
    }
  }

  void refine()
  {
    std::vector<Lines> between(coarse_.size() - 1);
    run({ 0, between.size() }, 0.3, 1.0,
        [&](Rings& rings, std::size_t i)
        {
          refine(rings, { coarse_[i], lines_.at(coarse_[i]) }, { coarse_[i + 1], lines_.at(coarse_[i + 1]) },
                 Set(pitches_, 1), 0, between[i]);
        });
    for (Lines& lines : between)
    {
      lines_.merge(lines);
    }
  }

  void addImages()
  {
    Lines images;
    for (const auto& [v, line] : lines_)
    {
      if (mirror_ && v > 0.0)
      {
        images[-v] = mirror_->image(line);
      }
    }
    lines_.merge(images);
  }

  struct Placed
  {
    double v;
    const Line& line;
  };

  /// Measures the line halfway between two lines for the pitches `wanted`, and more lines where the grid is too coarse.
  void refine(Rings& rings, const Placed& below, const Placed& above, const Set& wanted, int halvings, Lines& found)
  {
    const double middle = 0.5 * (below.v + above.v);
    Line& line = found[middle];
    if (!addLine(rings, middle, wanted, line))
    {
      return;
    }
    Set coarse(pitches_, 0);
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      if (wanted[pitch])
      {
        const double miss = check_.missBetween(below.line.strips[pitch], above.line.strips[pitch], above.v - below.v,
                                               line.strips[pitch], toleranceOf(line));
        coarse[pitch] = miss > 1.0 && halvings < MAX_HALVINGS;
        if (!coarse[pitch])
        {
          note(line, miss);
        }
      }
    }
    if (std::find(coarse.begin(), coarse.end(), 1) != coarse.end())
    {
      refine(rings, { middle, line }, above, coarse, halvings + 1, found);
      if (!failed_)
      {
        refine(rings, below, { middle, line }, coarse, halvings + 1, found);
      }
    }
  }

  /// Stores the result of a check. Lines above the torque limit do not count, because teeth can snap above this limit.
  void note(const Line& line, double miss)
  {
    if (line.overload == 1.0)
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      checks_.add(miss);
    }
  }

  DeviationTable table() const
  {
    std::vector<OpenPitch> pitches(pitches_);
    for (std::size_t number = 0; number < pitches_; ++number)
    {
      OpenPitch& pitch = pitches[number];
      pitch.columns = columns_[number];
      for (const auto& [v, line] : lines_)
      {
        const Strip& strip = line.strips[number];
        if (!strip.empty())
        {
          pitch.lines.push_back(v);
          pitch.nodes.insert(pitch.nodes.end(), strip.begin(), strip.end());
        }
      }
      if (std::none_of(pitch.nodes.begin(), pitch.nodes.end(), [&](const Node& node) { return check_.departs(node); }))
      {
        pitch = {};
      }
    }
    DeviationTable table = tableOf(std::move(pitches), swapsLobes());
    table.checks = checks_;
    return table;
  }

  bool swapsLobes() const { return static_cast<int>(pitches_) <= model_.ring.rest.teeth() / 2 + 1; }

  /// Runs the tasks from numbers.first to numbers.second - 1. `from`, `to`: progress before and after these, 0 ... 1.
  void run(std::pair<std::size_t, std::size_t> numbers, double from, double to,
           const std::function<void(Rings&, std::size_t)>& task)
  {
    const std::size_t count = numbers.second - numbers.first;
    const auto with_rings = [&](std::size_t i)
    {
      Rings rings(parameters_, equal_, model_);
      failed_ = failed_ || !rings.insert();
      if (!failed_)
      {
        task(rings, numbers.first + i);
      }
      solves_ += rings.equal.solves() + rings.actual.solves();
    };
    runTasks(count, threads_, with_rings,
             [&](std::size_t done)
             {
               if (progress_ && count > 0)
               {
                 progress_(from + (to - from) * static_cast<double>(done) / static_cast<double>(count));
               }
             });
  }

  const SurfaceParameters parameters_;
  const JointModel& equal_;
  const JointModel& model_;
  std::function<void(double)> progress_;
  std::size_t max_points_;
  unsigned threads_;
  const SurfaceRing ring_;  // gives limits and tolerances; no equilibrium of this ring is solved
  const DeviationCheck check_;
  std::size_t pitches_;
  std::vector<int> columns_;    // number of columns of each pitch
  std::vector<double> coarse_;  // v of the coarse lines, ascending
  Lines lines_;
  std::optional<DeviationMirror> mirror_;  // if set, only lines of v >= 0 are measured
  const Torques share_{ 5e-3, 7e-3 };      // tolerance as a share of the largest deviation on a line: output, motor [-]
  Torques largest_{ Torques::Zero() };     // largest deviations on the coarse lines [N.m]
  double longest_way_{};                   // largest change of v between two solves [rad]
  std::atomic<std::size_t> points_{ 0 };   // number of points of all lines
  std::atomic<int> solves_{ 0 };
  std::atomic<bool> failed_{ false };
  std::atomic<bool> too_many_{ false };
  std::mutex mutex_;  // protects checks_
  GridChecks checks_;
};
}  // namespace

DeviationBuild buildDeviations(const Parameters& parameters, const JointModel& equal, const JointModel& actual,
                               int repetition, double lowest, double highest,
                               const std::function<void(double)>& progress, std::size_t max_points, unsigned threads)
{
  return DeviationBuilder(parameters, equal, actual, repetition, progress, max_points, threads).build(lowest, highest);
}
}  // namespace hjt
