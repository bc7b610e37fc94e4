// SPDX-License-Identifier: BSD-3-Clause
#include "surface/deviation_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <vector>

#include "surface/surface_ring.hpp"

namespace hjt
{
namespace
{
using Node = SurfaceNode;
/// Nodes of one tooth pitch on one line, with both its ends.
using Strip = std::vector<Node>;
using Torques = Eigen::Array2d;  // on output and motor [N.m]

constexpr double SHARE = 1e-2;    // of the largest deviation on a line, that the table may be off by [-]
constexpr double SMALLEST = 0.1;  // a line's largest deviation counts as at least this part of the largest of all [-]
constexpr int COARSE_LINES = 12;  // a side, before refinement; denser towards no load
constexpr int MAX_HALVINGS = 5;   // of an interval between two lines
constexpr int MIN_COLUMNS = 4;
constexpr int MAX_COLUMNS = 16;

struct Line
{
  std::vector<Strip> strips;  ///< one a pitch; none where the line is not needed
  Torques tolerance{ Torques::Zero() };
};

class DeviationBuilder
{
public:
  DeviationBuilder(const Parameters& parameters, const JointModel& equal, const JointModel& actual, int repetition,
                   const std::function<void(double)>& progress, std::size_t max_points)
    : parameters_(parameters)
    , progress_(progress)
    , max_points_(max_points)
    , equal_(parameters, equal)
    , actual_(parameters, actual)
    , pitches_(static_cast<std::size_t>(repetition))
    , columns_(pitches_, 2 * MAX_COLUMNS)
  {
  }

  DeviationBuild build(double lowest, double highest)
  {
    DeviationBuild result;
    longest_way_ = (highest - lowest) / (4.0 * COARSE_LINES);
    if (equal_.insert() && actual_.insert() && chooseColumns(lowest, highest) && coverRange(lowest, highest) &&
        refine())
    {
      result.table = table();
    }
    else
    {
      result.failure_reason = too_many_ ? tooManyPoints(parameters_, max_points_) :
                                          "the ring finds no equilibrium at some angles within a turn";
    }
    result.solves = equal_.solves() + actual_.solves();
    return result;
  }

private:
  using Set = std::vector<char>;  // which pitches

  std::size_t next(std::size_t pitch) const { return pitch + 1 < pitches_ ? pitch + 1 : 0; }
  std::size_t last(std::size_t pitch) const { return pitch > 0 ? pitch - 1 : pitches_ - 1; }

  /// Both rings to another line at the angles where they are, the way in short pieces.
  bool leadTo(double v)
  {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(v - v_) / longest_way_)));
    bool good = true;
    for (int i = 1; i <= pieces && good; ++i)
    {
      const double between = v_ + (v - v_) * i / pieces;
      good = equal_.moveTo(equal_.motorAngle(), between) && actual_.moveTo(actual_.motorAngle(), between);
    }
    v_ = v;
    return good;
  }

  /// The gear of equal teeth at the columns of the finest pitch. Empty: no equilibrium.
  std::vector<Node> measureEqual()
  {
    const int columns = *std::max_element(columns_.begin(), columns_.end());
    std::vector<Node> nodes;
    for (int column = 0; column < columns; ++column)
    {
      if (!equal_.moveTo(equal_.pitch() * column / columns, v_))
      {
        return {};
      }
      nodes.push_back(equal_.measure());
    }
    return nodes;
  }

  /// Of a line's strips.
  std::size_t pointsOf(const Set& wanted) const
  {
    std::size_t points = 0;
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      points += wanted[pitch] ? static_cast<std::size_t>(columns_[pitch]) + 1 : 0;
    }
    return points;
  }

  /// SurfaceDeviations on a line for some of the pitches: first at their edges, then, on the way back, within those
  /// where, or beside which, there are any. False: no equilibrium, or too many points.
  bool measureLine(double v, const Set& wanted, Line& line)
  {
    too_many_ = points_ + pointsOf(wanted) > max_points_;
    if (too_many_ || !leadTo(v))
    {
      return false;
    }
    const std::vector<Node> equal = measureEqual();
    if (equal.empty())
    {
      return false;
    }
    bool good = true;
    const auto deviation = [&](std::size_t pitch, double part)
    {
      good = good && actual_.moveTo(actual_.pitch() * (static_cast<double>(pitch) + part), v);
      Node node = good ? actual_.measure() : Node{};
      const Node& reference = equal[static_cast<std::size_t>(std::llround(part * static_cast<double>(equal.size())))];
      for (int i = 0; i < SurfaceNode::VALUES; ++i)
      {
        node.set(i, node[i] - reference[i]);
      }
      return node;
    };
    std::vector<Node> edges(pitches_);  // at the start of each pitch
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
        if (departs(edges[last(pitch)]) || departs(strip.front()) || departs(strip.back()) ||
            departs(edges[next(next(pitch))]))
        {
          for (int column = columns - 1; column > 0; --column)
          {
            strip[static_cast<std::size_t>(column)] = deviation(pitch, static_cast<double>(column) / columns);
          }
        }
      }
    }
    setTolerance(line, equal.front());
    return good;
  }

  /// The same for a line of the table.
  bool addLine(double v, const Set& wanted)
  {
    const bool good = measureLine(v, wanted, lines_[v]);
    points_ += pointsOf(wanted);
    return good;
  }

  void setTolerance(Line& line, const Node& equal)
  {
    Torques largest = Torques::Zero();
    for (const Strip& strip : line.strips)
    {
      for (const Node& node : strip)
      {
        largest = largest.max(torques(node).abs());
      }
    }
    largest_ = largest_.max(largest);
    line.tolerance = SHARE * actual_.overload(equal) * largest.max(SMALLEST * largest_);
  }

  Torques torques(const Node& deviation) const
  {
    return torques(deviation[SurfaceNode::ENERGY_BY_U], deviation[SurfaceNode::ENERGY_BY_V]);
  }

  Torques torques(double by_u, double by_v) const { return { -by_v, by_v / actual_.ratio() - by_u / actual_.pitch() }; }

  bool departs(const Node& node) const
  {
    constexpr double ROUNDING = 1e-8;  // of the torque limit; the rings are solved to a tenth of that
    const Torques torque = torques(node).abs();
    return std::max(torque[0], torque[1] * actual_.ratio()) > ROUNDING * actual_.torqueLimit();
  }

  /// Whether what lies in a cell is close enough to the deviation measured there.
  bool agrees(const SurfaceCell& cell, const Node& measured, const Torques& tolerance) const
  {
    const SurfaceCell::Energy energy = cell.energy();
    return ((torques(energy.by_u, energy.by_v) - torques(measured)).abs() <= tolerance).all();
  }

  /// For each pitch the fewest columns that give the deviations half way between them.
  bool chooseColumns(double lowest, double highest)
  {
    std::vector<int> enough(pitches_, MIN_COLUMNS);
    const Set all(pitches_, 1);
    for (const double v : { 0.02 * lowest, 0.1 * lowest, 0.3 * lowest, 0.3 * highest, 0.1 * highest, 0.02 * highest })
    {
      Line line;
      if (!measureLine(v, all, line))
      {
        return false;
      }
      for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
      {
        int& columns = enough[pitch];
        while (columns < MAX_COLUMNS && !columnsSuffice(line.strips[pitch], columns, line.tolerance))
        {
          columns *= 2;
        }
      }
    }
    // What moves with the load may move to the next pitch.
    for (std::size_t pitch = 0; pitch < pitches_; ++pitch)
    {
      columns_[pitch] = std::max({ enough[last(pitch)], enough[pitch], enough[next(pitch)] });
    }
    return true;
  }

  /// Whether every so manyth node of a strip gives those between.
  bool columnsSuffice(const Strip& strip, int columns, const Torques& tolerance) const
  {
    const std::size_t stride = (strip.size() - 1) / static_cast<std::size_t>(columns);
    for (std::size_t first = 0; first + 1 < strip.size(); first += stride)
    {
      const std::array<Node, 2> ends{ strip[first], strip[first + stride] };
      for (std::size_t i = 1; i < stride; ++i)
      {
        const double part = static_cast<double>(i) / static_cast<double>(stride);
        if (!agrees({ ends.data(), ends.data(), part, 0.0, static_cast<double>(columns), 1.0 }, strip[first + i],
                    tolerance))
        {
          return false;
        }
      }
    }
    return true;
  }

  /// Coarse lines from no load outwards, both ways.
  bool coverRange(double lowest, double highest)
  {
    const Set all(pitches_, 1);
    for (const double end : { lowest, highest })
    {
      for (int i = 0; i <= COARSE_LINES; ++i)
      {
        const double part = static_cast<double>(i) / COARSE_LINES;
        const double v = end * part * part;
        if (lines_.count(v) == 0 && !addLine(v, all))
        {
          return false;
        }
        report(0.1 + 0.1 * part + (end == highest ? 0.1 : 0.0));
      }
    }
    return true;
  }

  bool refine()
  {
    std::vector<double> coarse;
    for (const auto& [v, line] : lines_)
    {
      coarse.push_back(v);
    }
    const Set all(pitches_, 1);
    for (std::size_t i = coarse.size() - 1; i > 0; --i)
    {
      if (!refine(coarse[i - 1], coarse[i], all, 0))
      {
        return false;
      }
      report(1.0 - 0.7 * static_cast<double>(i - 1) / static_cast<double>(coarse.size() - 1));
    }
    return true;
  }

  /// A line between two for the pitches `wanted`, and further lines for those that it shows to be too coarse.
  bool refine(double below, double above, const Set& wanted, int halvings)
  {
    const double middle = 0.5 * (below + above);
    if (!addLine(middle, wanted))
    {
      return false;
    }
    const Line& line = lines_[middle];
    Set coarse(pitches_, 0);
    for (std::size_t pitch = 0; pitch < pitches_ && halvings < MAX_HALVINGS; ++pitch)
    {
      coarse[pitch] =
          wanted[pitch] && !gives(lines_[below].strips[pitch], lines_[above].strips[pitch], above - below, line, pitch);
    }
    return std::find(coarse.begin(), coarse.end(), 1) == coarse.end() ||
           (refine(middle, above, coarse, halvings + 1) && refine(below, middle, coarse, halvings + 1));
  }

  /// Whether two lines' strips of a pitch give that of the line half way between them.
  bool gives(const Strip& below, const Strip& above, double height, const Line& line, std::size_t pitch) const
  {
    const auto columns = static_cast<std::size_t>(columns_[pitch]);
    for (std::size_t i = 0; i < columns; ++i)
    {
      if (!agrees({ &below[i], &above[i], 0.0, 0.5, static_cast<double>(columns), 1.0 / height }, line.strips[pitch][i],
                  line.tolerance))
      {
        return false;
      }
    }
    return true;
  }

  /// A pitch whose edges are yet to be joined.
  struct OpenPitch
  {
    int columns{};
    std::vector<double> lines;
    std::vector<Node> nodes;
  };

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
      if (std::none_of(pitch.nodes.begin(), pitch.nodes.end(), [&](const Node& node) { return departs(node); }))
      {
        pitch = {};
      }
    }
    for (std::size_t number = 0; number < pitches_; ++number)
    {
      join(pitches[number], pitches[next(number)]);
    }
    DeviationTable table;
    table.swaps_lobes = static_cast<int>(pitches_) <= actual_.model().ring.rest.teeth() / 2 + 1;
    for (OpenPitch& pitch : pitches)
    {
      table.pitches.push_back({ pitch.columns, std::move(pitch.lines), SurfaceNodes(std::move(pitch.nodes)) });
    }
    return table;
  }

  /// Makes the end of a pitch and the start of the next one the same function of v: on lines that only one of them has,
  /// what lies between those that both have.
  static void join(OpenPitch& before, OpenPitch& after)
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

  static void levelEdge(OpenPitch& pitch, std::size_t column, const std::vector<double>& common)
  {
    const std::size_t stride = static_cast<std::size_t>(pitch.columns) + 1;
    std::size_t kept = 0;  // the last line in common
    for (std::size_t i = 0, in_common = 0; i < pitch.lines.size(); ++i)
    {
      if (in_common == common.size() || pitch.lines[i] != common[in_common])
      {
        continue;
      }
      const std::array<Node, 2> low{ pitch.nodes[kept * stride + column], {} };
      const std::array<Node, 2> high{ pitch.nodes[i * stride + column], {} };
      const double height = pitch.lines[i] - pitch.lines[kept];
      for (std::size_t between = kept + 1; between < i; ++between)
      {
        const SurfaceCell cell(low.data(), high.data(), 0.0, (pitch.lines[between] - pitch.lines[kept]) / height,
                               static_cast<double>(pitch.columns), 1.0 / height);
        const SurfaceCell::Energy energy = cell.energy();
        Node& node = pitch.nodes[between * stride + column];
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

  void report(double done) const
  {
    if (progress_)
    {
      progress_(done);
    }
  }

  const Parameters& parameters_;
  std::function<void(double)> progress_;
  std::size_t max_points_;
  SurfaceRing equal_;
  SurfaceRing actual_;
  std::size_t pitches_;
  std::vector<int> columns_;  // of each pitch
  std::map<double, Line> lines_;
  std::size_t points_{};  // of all lines
  bool too_many_{};
  Torques largest_{ Torques::Zero() };  // deviations of all lines so far
  double longest_way_{};                // between two solves, in v [rad]
  double v_{};                          // where the rings are [rad]
};
}  // namespace

DeviationBuild buildDeviations(const Parameters& parameters, const JointModel& equal, const JointModel& actual,
                               int repetition, double lowest, double highest,
                               const std::function<void(double)>& progress, std::size_t max_points)
{
  return DeviationBuilder(parameters, equal, actual, repetition, progress, max_points).build(lowest, highest);
}
}  // namespace hjt
