// SPDX-License-Identifier: BSD-3-Clause
#include "surface/surface_cache.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/number_text.hpp"
#include "base/source_hash.hpp"
#include "base/text_hash.hpp"
#include "base/text_stream.hpp"
#include "base/whole_file.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"
#include "params/field_table.hpp"
#include "params/variants.hpp"
#include "solver/arc_elimination.hpp"
#include "surface/ball_builder.hpp"
#include "surface/cache_folder.hpp"
#include "surface/deviation_builder.hpp"
#include "surface/mapped_file.hpp"
#include "surface/parallel_tasks.hpp"
#include "surface/surface_builder.hpp"
#include "surface/surface_ring.hpp"

namespace hjt
{
namespace
{
/// First line of a file, before the hash of the code that made it.
constexpr const char* FORMAT = "harmonic_joint_twin response surface ";
/// No table is larger; the shipped gear's has 8 MB [bytes].
constexpr std::size_t MAX_FILE = std::size_t{ 1 } << 30;
const std::string NO_SURFACE = "no response surface: ";
const std::string FULL_RING_INSTEAD = "; the twin solves the full ring at every step";

/// What a file must begin with: all that its table depends on. Code, the kind of processor, whose vectors round in
/// their own way, parameters, faults, and what stands in files that the parameters name.
std::string header(const Parameters& parameters, const std::string& faults)
{
  std::string text = FORMAT + std::string(surfaceSourceHash()) + ' ' + arcs::fastest().name + '\n' +
                     describeSurfaceParameters(parameters, !faults.empty());
  text += faults + '\n';
  for (const std::string& path :
       { parameters.manufacture.flexspline_pitch.table, parameters.manufacture.circular_spline_pitch.table })
  {
    if (path != NO_FILE)
    {
      std::ifstream file(path, std::ios::binary);
      text.append(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
    text += '\n';
  }
  // The numbers that follow lie as they do in memory.
  text.append((sizeof(double) - text.size() % sizeof(double)) % sizeof(double), '\n');
  return text;
}

template <class T>
void append(std::string& bytes, const T* values, std::size_t count)
{
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// The table's numbers as they lie in memory: the cache is for this machine.
std::string body(const SurfaceTable& table)
{
  std::string bytes;
  const std::array<double, 4> sizes{ table.pitch, table.ratio, static_cast<double>(table.columns),
                                     static_cast<double>(table.lines.size()) };
  append(bytes, sizes.data(), sizes.size());
  append(bytes, table.lines.data(), table.lines.size());
  append(bytes, table.nodes.data(), table.nodes.size());
  return bytes;
}

std::string body(const DeviationTable& table)
{
  std::string bytes;
  const std::array<double, 2> sizes{ static_cast<double>(table.pitches.size()), table.swaps_lobes ? 1.0 : 0.0 };
  append(bytes, sizes.data(), sizes.size());
  for (const DeviationTable::Pitch& pitch : table.pitches)
  {
    const std::array<double, 2> counts{ static_cast<double>(pitch.columns), static_cast<double>(pitch.lines.size()) };
    append(bytes, counts.data(), counts.size());
    append(bytes, pitch.lines.data(), pitch.lines.size());
    append(bytes, pitch.nodes.data(), pitch.nodes.size());
  }
  return bytes;
}

std::string body(const BallTable& table)
{
  std::string bytes;
  const std::array<double, 10> numbers{ table.pitch,
                                        table.ratio,
                                        table.deepest,
                                        table.turn,
                                        table.scale,
                                        table.lowest,
                                        table.step,
                                        static_cast<double>(table.lines),
                                        static_cast<double>(table.columns),
                                        static_cast<double>(table.places) };
  append(bytes, numbers.data(), numbers.size());
  append(bytes, table.coefficients.data(), table.coefficients.size());
  return bytes;
}

/// Takes a body to pieces; whether there were enough bytes and numbers is known in the end.
class BodyReader
{
public:
  /// `bytes` of the file, behind a multiple of the size of a number.
  BodyReader(std::shared_ptr<const MappedFile> file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  /// A whole number not below `least`.
  std::size_t size(double least)
  {
    constexpr double MAX_VALUE = 1e6;
    double value = 0.0;
    number(value);
    good_ = good_ && value >= least && value < MAX_VALUE;
    return good_ ? static_cast<std::size_t>(value) : 0;
  }

  void number(double& value)
  {
    if (const char* start = take(sizeof(value)))
    {
      std::memcpy(&value, start, sizeof(value));
    }
  }

  void numbers(std::vector<double>& values, std::size_t count)
  {
    const char* start = take(count * sizeof(double));
    values.resize(start != nullptr ? count : 0);
    if (!values.empty())
    {
      std::memcpy(values.data(), start, count * sizeof(double));
    }
  }

  /// Where they lie. `count` below 1e12.
  SurfaceNodes nodes(std::size_t count)
  {
    static_assert(alignof(SurfaceNode) == sizeof(double) && std::is_trivially_copyable_v<SurfaceNode>);
    const char* start = take(count * sizeof(SurfaceNode));
    return start != nullptr ? SurfaceNodes(file_, reinterpret_cast<const SurfaceNode*>(start), count) : SurfaceNodes();
  }

  bool complete() const { return good_ && bytes_.empty(); }

private:
  /// The next bytes; null if there are not enough.
  const char* take(std::size_t size)
  {
    good_ = good_ && bytes_.size() >= size;
    const char* start = good_ ? bytes_.data() : nullptr;
    bytes_.remove_prefix(good_ ? size : 0);
    return start;
  }

  std::shared_ptr<const MappedFile> file_;
  std::string_view bytes_;
  bool good_{ true };
};

bool finite(const SurfaceNodes& nodes)
{
  return std::all_of(nodes.begin(), nodes.end(),
                     [](const SurfaceNode& node)
                     {
                       const auto is_finite = [](auto x) { return std::isfinite(x); };
                       return std::all_of(node.energies().begin(), node.energies().end(), is_finite) &&
                              std::all_of(node.bilinear().begin(), node.bilinear().end(), is_finite);
                     });
}

/// Each above the one before, all finite.
bool ascending(const std::vector<double>& lines)
{
  return std::all_of(lines.begin(), lines.end(), [](double line) { return std::isfinite(line); }) &&
         std::adjacent_find(lines.begin(), lines.end(), std::greater_equal<>()) == lines.end();
}

bool parseBody(BodyReader& reader, SurfaceTable& table)
{
  reader.number(table.pitch);
  reader.number(table.ratio);
  const std::size_t columns = reader.size(1.0);
  const std::size_t lines = reader.size(2.0);
  table.columns = static_cast<int>(columns);
  reader.numbers(table.lines, lines);
  table.nodes = reader.nodes(lines * (columns + 1));
  // Written so that NaN fails.
  return reader.complete() && table.pitch > 0.0 && table.pitch < TWO_PI && std::abs(table.ratio) >= 1.0 &&
         std::isfinite(table.ratio) && ascending(table.lines) && finite(table.nodes);
}

bool parseBody(BodyReader& reader, DeviationTable& table)
{
  table.pitches.resize(reader.size(2.0));
  table.swaps_lobes = reader.size(0.0) != 0;
  bool good = true;
  for (DeviationTable::Pitch& pitch : table.pitches)
  {
    const std::size_t columns = reader.size(0.0);
    const std::size_t lines = reader.size(0.0);
    pitch.columns = static_cast<int>(columns);
    reader.numbers(pitch.lines, lines);
    pitch.nodes = reader.nodes(lines > 0 ? lines * (columns + 1) : 0);
    good = good && lines != 1 && ascending(pitch.lines) && finite(pitch.nodes);
  }
  return good && reader.complete();
}

bool parseBody(BodyReader& reader, BallTable& table)
{
  for (double* number :
       { &table.pitch, &table.ratio, &table.deepest, &table.turn, &table.scale, &table.lowest, &table.step })
  {
    reader.number(*number);
  }
  const std::size_t lines = reader.size(1.0);
  const std::size_t columns = reader.size(1.0);
  const std::size_t places = reader.size(1.0);
  std::vector<double> numbers;
  reader.numbers(numbers, (lines + 3) * columns * places * BallTable::VALUES);
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const auto is_positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!reader.complete() || !std::all_of(numbers.begin(), numbers.end(), is_finite) || !is_finite(table.lowest) ||
      !is_positive(table.pitch) || !is_finite(table.ratio) || !is_positive(table.turn) || !is_positive(table.scale) ||
      !is_positive(table.step))
  {
    return false;
  }
  table.lines = static_cast<int>(lines);
  table.columns = static_cast<int>(columns);
  table.places = static_cast<int>(places);
  for (std::size_t i = 0; i < numbers.size(); i += BallTable::VALUES)
  {
    table.coefficients.emplace_back(Eigen::Map<const BallTable::Coefficients>(&numbers[i]));
  }
  return true;
}

/// A file holds the header, the body and the hash of both. The table's nodes stay in it.
template <class Table>
bool readFile(const std::string& path, const std::string& wanted, Table& table)
{
  const std::shared_ptr<const MappedFile> file = MappedFile::ofOwn(path, MAX_FILE);
  std::uint64_t sum = 0;
  if (!file || file->bytes().size() < wanted.size() + sizeof(sum) ||
      file->bytes().compare(0, wanted.size(), wanted) != 0)
  {
    return false;
  }
  const std::string_view summed = file->bytes().substr(0, file->bytes().size() - sizeof(sum));
  std::memcpy(&sum, summed.data() + summed.size(), sizeof(sum));
  BodyReader reader(file, summed.substr(wanted.size()));
  return sum == textHash(summed) && parseBody(reader, table);
}

/// @returns what went wrong, or nothing.
std::string writeFile(const std::string& path, std::string bytes)
{
  const std::uint64_t sum = textHash(bytes);
  append(bytes, &sum, 1);
  try
  {
    writePrivateFile(path, bytes);
  }
  catch (const InputError& error)
  {
    return error.what();
  }
  return {};
}

std::string fileOf(const std::string& kind, const std::string& key, const std::string& directory)
{
  TextStream name;
  name << directory << '/' << kind << '_' << std::hex << textHash(key) << ".bin";
  return name.str();
}

void tell(const SurfaceSource& source, const std::string& what)
{
  if (source.notice)
  {
    source.notice(what);
  }
}

/// A table from the cache, or built and stored there. Empty: it could not be built, and the reason was reported.
template <class Table, class Build>
std::optional<Table> obtain(const std::string& kind, const std::string& key, const SurfaceSource& source, Build build)
{
  const std::string& directory = source.cache_directory;
  const std::uintmax_t limit = cacheLimit();
  const std::string unfit = directory.empty() ? "" : makeCacheFolder(directory);
  if (!unfit.empty())
  {
    tell(source, "response surface not kept: " + unfit);
  }
  const bool kept = !directory.empty() && unfit.empty();
  const std::string path = fileOf(kind, key, directory);
  Table table;
  if (kept && readFile(path, key, table))
  {
    return table;
  }
  auto built = build();
  if (!built.failure_reason.empty())
  {
    tell(source, NO_SURFACE + built.failure_reason + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  if (kept)
  {
    const std::string problem = writeFile(path, key + body(built.table));
    if (!problem.empty())
    {
      tell(source, "response surface not kept: " + problem);
    }
    else
    {
      const std::string removed = tidyCache(directory, path, limit);
      if (!removed.empty())
      {
        tell(source, removed);
      }
      // Out of the file, where all processes have it in common.
      Table shared;
      if (readFile(path, key, shared))
      {
        return shared;
      }
    }
  }
  return std::move(built.table);
}

/// Beside a twin that runs, one processor is left to it.
unsigned threadsFor(const SurfaceSource& source)
{
  return std::max(1u, processors() - (source.background ? 1u : 0u));
}

/// That a fault of the bearing can bring about at severity 1 [m].
double deepestDrop(const Parameters& parameters)
{
  RaceDeflection spalled(parameters.bearing);
  spalled.addOuterSpall(0.0, parameters.fault_scale.spall_depth, parameters.fault_scale.spall_length);
  return std::max(spalled.deepest(), parameters.fault_scale.cage_deflection);
}

/// Of a table of balls, which the scales of their faults shape.
std::string ballHeader(const Parameters& parameters, const std::string& faults)
{
  return header(parameters, faults + "a ball that drops by " + numberText(deepestDrop(parameters)));
}

/// From the cache, or built and put there.
std::optional<BallTable> obtainBallTable(const Parameters& parameters, const JointModel& model,
                                         const std::string& faults, const SurfaceTable& surface,
                                         const SurfaceSource& source)
{
  return obtain<BallTable>("balls", ballHeader(parameters, faults), source,
                           [&]
                           {
                             return buildBallTable(parameters, model, deepestDrop(parameters), surface.lines.front(),
                                                   surface.lines.back(), source.progress, threadsFor(source));
                           });
}

/// See SurfaceRing. Solved for only where it is not known beforehand.
int repetition(const Parameters& parameters, const JointModel& model, const std::string& faults)
{
  const bool alike = faults.empty() && teethAreAlike(parameters) && !model.ring.of<WaveGeneratorContact>().hasKinks();
  return alike ? 1 : SurfaceRing(parameters, model).repetition();
}

/// See obtainSurface. `teeth_alike`: it is wanted without deviations only.
std::optional<SurfaceTables> obtainTables(const Parameters& parameters, const JointModel& model,
                                          const std::string& faults, const SurfaceSource& source, bool teeth_alike)
{
  // The cache is asked only for gears that repeat: what stops others is not in its keys.
  const int pitches = repetition(parameters, model, faults);
  const Parameters equal_parameters = pitches == 1 ? parameters : withEqualTeeth(parameters);
  const JointModel equal = pitches == 1 ? model : JointModel(equal_parameters);
  if (pitches == 0 || (pitches > 1 && repetition(equal_parameters, equal, {}) != 1))
  {
    tell(source, NO_SURFACE + "the gear is not the same again after a turn of the motor" + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  if (pitches > 1 && teeth_alike)
  {
    tell(source, NO_SURFACE + "the bearing is faulty and teeth differ" + FULL_RING_INSTEAD);
    return std::nullopt;
  }
  const std::string key = pitches == 1 ? header(parameters, faults) : header(equal_parameters, {});
  const unsigned threads = threadsFor(source);
  std::optional<SurfaceTable> table = obtain<SurfaceTable>(
      "surface", key, source,
      [&] { return buildSurface(equal_parameters, equal, source.progress, MAX_SURFACE_POINTS, threads); });
  if (!table)
  {
    return std::nullopt;
  }
  SurfaceTables tables{ std::move(*table), {} };
  if (pitches > 1)
  {
    std::optional<DeviationTable> deviations = obtain<DeviationTable>(
        "deviations", header(parameters, faults), source,
        [&]
        {
          return buildDeviations(parameters, equal, model, pitches, tables.table.lines.front(),
                                 tables.table.lines.back(), source.progress, MAX_DEVIATION_POINTS, threads);
        });
    if (!deviations)
    {
      return std::nullopt;
    }
    tables.deviations = std::move(*deviations);
  }
  return tables;
}
}  // namespace

std::string surfaceCacheDirectory()
{
  const auto variable = [](const char* name)
  {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  const std::string cache = variable("XDG_CACHE_HOME");
  const std::string home = variable("HOME");
  const std::string base = !cache.empty() ? cache : !home.empty() ? home + "/.cache" : "";
  return base.empty() ? "" : base + "/harmonic_joint_twin";
}

std::string surfaceCacheFile(const Parameters& parameters, const std::string& directory)
{
  return fileOf("surface", header(parameters, {}), directory);
}

std::optional<SurfaceTables> obtainSurface(const Parameters& parameters, const JointModel& model,
                                           const std::string& faults, const SurfaceSource& source)
{
  return obtainTables(parameters, model, faults, source, false);
}

SurfacePool::Surface sharedSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                   const SurfaceSource& source)
{
  const auto make = [&]() -> SurfacePool::Surface
  {
    std::optional<SurfaceTables> tables = obtainSurface(parameters, model, faults, source);
    return tables ? std::make_shared<const ResponseSurface>(std::move(tables->table), std::move(tables->deviations)) :
                    nullptr;
  };
  return source.pool ? source.pool->obtain(header(parameters, faults), make) : make();
}

SurfacePool::Surface sharedBallSurface(const Parameters& parameters, const JointModel& model, const std::string& faults,
                                       const SurfaceSource& source)
{
  const auto make = [&]() -> SurfacePool::Surface
  {
    std::optional<SurfaceTables> tables = obtainTables(parameters, model, faults, source, true);
    std::optional<BallTable> balls =
        tables ? obtainBallTable(parameters, model, faults, tables->table, source) : std::nullopt;
    return balls ?
               std::make_shared<const ResponseSurface>(std::move(tables->table), DeviationTable{},
                                                       BallDrops(std::make_shared<const BallTable>(std::move(*balls)),
                                                                 RaceDeflection(parameters.bearing))) :
               nullptr;
  };
  return source.pool ? source.pool->obtain(ballHeader(parameters, faults), make) : make();
}
}  // namespace hjt
