// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <utility>

#include "surface/parallel_tasks.hpp"
#include "surface/surface_lines.hpp"

namespace hjt
{
namespace
{
constexpr int MIN_COLUMNS = 8;
constexpr int MAX_COLUMNS = 32;
constexpr int MAX_HALVINGS = 4;

using Values = std::vector<float>;
using Lines = std::map<double, Values>;  // values of the lines by their v, see SurfaceTable [rad]

class ToothResponseBuilder
{
public:
  ToothResponseBuilder(const SurfaceParameters& parameters, const JointModel& model, double step)
    : parameters_(parameters), model_(model), step_(step)
  {
  }

  ToothResponse build(const std::vector<double>& coarse, bool mirrored, unsigned threads, std::atomic<int>& solves)
  {
    ToothResponse table;
    {
      LineRing ring(parameters_, model_);
      const bool led = ring.leadTo(0.0, step_);
      table.teeth = ring.ring().teeth();
      table.stored = ring.ring().solvedTeeth();
      table.pitch = ring.ring().pitch();
      table.ratio = ring.ring().ratio();
      stored_ = static_cast<std::size_t>(table.stored);
      if (led)
      {
        chooseColumns(ring, mirrored ? coarse.back() : std::max(coarse.back(), -coarse.front()));
      }
      solves += ring.ring().solves();
    }
    table.columns = columns_;
    Lines lines;
    std::vector<Lines> between(coarse.size() - 1);
    runTasks(
        between.size(), threads,
        [&](std::size_t i)
        {
          LineRing own(parameters_, model_);
          const bool outwards = std::abs(coarse[i]) < std::abs(coarse[i + 1]);
          const double inner = coarse[outwards ? i : i + 1];
          const double outer = coarse[outwards ? i + 1 : i];
          Values first = own.leadTo(inner, step_) ? measure(own, inner, columns_) : Values{};
          Values last = measure(own, outer, columns_);
          if (!first.empty() && !last.empty())
          {
            refine(own, inner, first, outer, last, 0, between[i]);
            between[i][inner] = std::move(first);
            between[i][outer] = std::move(last);
          }
          solves += own.ring().solves();
        },
        [](std::size_t) {});
    for (Lines& part : between)
    {
      if (part.empty())
      {
        return {};
      }
      lines.merge(part);
    }
    if (failed_)
    {
      return {};
    }
    if (mirrored)
    {
      addMirrorImages(lines, table);
    }
    table.checks = checks_;
    fill(lines, table);
    return table;
  }

private:
  std::size_t nodeSize() const { return ToothResponse::QUANTITIES * stored_; }

  /// Measures the nodes of the line at `v`. The last node has the values of the first node, shifted by one tooth. Empty
  /// if the ring has no equilibrium or the table would exceed MAX_TOOTH_VALUES.
  Values measure(LineRing& line_ring, double v, int columns)
  {
    SurfaceRing& ring = line_ring.ring();
    const std::size_t size = (static_cast<std::size_t>(columns) + 1) * nodeSize();
    if (values_.fetch_add(size) + size > MAX_TOOTH_VALUES)
    {
      failed_ = true;
      return {};
    }
    Values line(size);
    const bool backwards = ring.motorAngle() > 0.5 * ring.pitch();
    for (int i = 0; i <= columns; ++i)
    {
      const int column = backwards ? columns - i : i;
      if (!ring.moveTo(ring.pitch() * column / columns, v))
      {
        return {};
      }
      ring.measureTeeth(&line[static_cast<std::size_t>(column) * nodeSize()]);
    }
    return line;
  }

  /// Largest difference of the mean of two nodes from the node `middle`, divided by the tolerance [-].
  double miss(const float* below, const float* above, const float* middle) const
  {
    double worst = 0.0;
    for (std::size_t quantity = 0; quantity < ToothResponse::X; ++quantity)
    {
      const std::size_t first = quantity * stored_;
      const float* values = middle + first;
      const auto [least, most] = std::minmax_element(values, values + stored_);
      const double largest = std::max(std::abs(*least), std::abs(*most));
      const double tolerance = std::max(LEAST_TOOTH_FORCE, TOOTH_FORCE_SHARE * largest);
      for (std::size_t i = 0; i < stored_; ++i)
      {
        const double between = 0.5 * (static_cast<double>(below[first + i]) + above[first + i]);
        worst = std::max(worst, std::abs(between - values[i]) / tolerance);
      }
    }
    return worst;
  }

  void chooseColumns(LineRing& ring, double outermost)
  {
    columns_ = MIN_COLUMNS;
    for (const double share : { 0.05, 0.15, 0.5, 0.9 })
    {
      const double v = -share * outermost;
      const Values finest = measure(ring, v, 2 * MAX_COLUMNS);
      const auto worst = [&]
      {
        const int stride = 2 * MAX_COLUMNS / columns_;
        const auto node = [&](int i) { return &finest[static_cast<std::size_t>(i) * nodeSize()]; };
        double largest = 0.0;
        for (int i = 0; i < 2 * MAX_COLUMNS; i += stride)
        {
          largest = std::max(largest, miss(node(i), node(i + stride), node(i + stride / 2)));
        }
        return largest;
      };
      while (!finest.empty() && columns_ < MAX_COLUMNS && worst() > 1.0)
      {
        columns_ *= 2;
      }
      if (!finest.empty())
      {
        checks_.add(worst());
      }
    }
  }

  void refine(LineRing& ring, double v_below, const Values& below, double v_above, const Values& above, int halvings,
              Lines& found)
  {
    const double v = 0.5 * (v_below + v_above);
    Values line = measure(ring, v, columns_);
    if (line.empty())
    {
      failed_ = true;
      return;
    }
    double worst = 0.0;
    for (std::size_t i = 0; i < line.size(); i += nodeSize())
    {
      worst = std::max(worst, miss(&below[i], &above[i], &line[i]));
    }
    if (worst > 1.0 && halvings < MAX_HALVINGS)
    {
      refine(ring, v_below, below, v, line, halvings + 1, found);
      refine(ring, v, line, v_above, above, halvings + 1, found);
    }
    else
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      checks_.add(worst);
    }
    if (worst > 1.0)
    {
      found[v] = std::move(line);
    }
  }

  void addMirrorImages(Lines& lines, const ToothResponse& table) const
  {
    Lines images;
    for (const auto& [v, line] : lines)
    {
      images[-v] = v > 0.0 ? mirrorImage(line, table) : line;
    }
    lines.merge(images);
  }

  static void fill(const Lines& lines, ToothResponse& table)
  {
    Values all;
    for (const auto& [v, line] : lines)
    {
      table.lines.push_back(v);
      all.insert(all.end(), line.begin(), line.end());
    }
    table.values = SharedValues<float>(std::move(all));
  }

  /// Mirror image of a line: the line at -v. Its values at u are those at one pitch - u, and its teeth count backwards.
  Values mirrorImage(const Values& line, const ToothResponse& table) const
  {
    const double cosine = std::cos(table.pitch);
    const double sine = std::sin(table.pitch);
    // A tooth half a turn away from a stored tooth has positions of the opposite sign.
    const auto tooth = [&](int number, double& sign)
    {
      const int whole = (number % table.teeth + table.teeth) % table.teeth;
      sign = whole >= table.stored ? -1.0 : 1.0;
      return static_cast<std::size_t>(whole % table.stored);
    };
    Values image(line.size());
    for (int column = 0; column <= table.columns; ++column)
    {
      const float* from = &line[static_cast<std::size_t>(table.columns - column) * nodeSize()];
      float* to = &image[static_cast<std::size_t>(column) * nodeSize()];
      const auto value = [&](std::size_t quantity, std::size_t i) { return from[quantity * stored_ + i]; };
      for (int i = 0; i < table.stored; ++i)
      {
        double sign = 1.0;
        double unused = 1.0;
        const std::size_t opposite = tooth(1 - i, sign);
        const std::size_t segment = tooth(-i, unused);
        const double x = sign * value(ToothResponse::X, opposite);
        const double y = sign * value(ToothResponse::Y, opposite);
        const std::array<double, ToothResponse::QUANTITIES> values{
          value(ToothResponse::WAVE_GENERATOR_FORCE, opposite),
          value(ToothResponse::RIM_TENSION, segment),
          -value(ToothResponse::BENDING_FORCE, segment),
          -value(ToothResponse::MESH_FORCE, opposite),
          cosine * x + sine * y,
          sine * x - cosine * y,
        };
        for (std::size_t quantity = 0; quantity < values.size(); ++quantity)
        {
          to[quantity * stored_ + static_cast<std::size_t>(i)] = static_cast<float>(values[quantity]);
        }
      }
    }
    return image;
  }

  const SurfaceParameters& parameters_;
  const JointModel& model_;
  double step_;  // difference of v between coarse lines [rad]
  std::size_t stored_{};
  int columns_{ MIN_COLUMNS };
  std::atomic<std::size_t> values_{ 0 };
  std::atomic<bool> failed_{ false };
  std::mutex mutex_;  // protects checks_
  GridChecks checks_;
};
}  // namespace

ToothResponse buildToothResponse(const SurfaceParameters& parameters, const JointModel& model,
                                 const std::vector<double>& coarse, double step, bool mirrored, unsigned threads,
                                 std::atomic<int>& solves)
{
  return ToothResponseBuilder(parameters, model, step).build(coarse, mirrored, threads, solves);
}
}  // namespace hjt
