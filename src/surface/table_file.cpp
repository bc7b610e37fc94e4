// SPDX-License-Identifier: BSD-3-Clause
#include "surface/table_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/hash.hpp"
#include "base/whole_file.hpp"
#include "gear/angle.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
/// File mapped into memory, read-only and shared by all processes. The mapping stays valid if the file is removed or
/// replaced by another file.
class MappedFile
{
public:
  /// Maps a regular file of this user that other users cannot write. Returns null for any other file, and for a file
  /// that is empty or larger than `most` bytes. Does not block, even for a FIFO. Sets the times of the file to now,
  /// which marks the file as used.
  static std::shared_ptr<const MappedFile> ofOwn(const std::string& path, std::size_t most);

  ~MappedFile();

  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  /// Bytes of the file, which begin at the start of a memory page.
  std::string_view bytes() const noexcept { return { static_cast<const char*>(start_), size_ }; }

private:
  MappedFile(void* start, std::size_t size) noexcept : start_(start), size_(size) {}

  void* start_;
  std::size_t size_;
};

std::shared_ptr<const MappedFile> MappedFile::ofOwn(const std::string& path, std::size_t most)
{
  const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (descriptor < 0)
  {
    return nullptr;
  }
  struct stat status = {};
  void* start = MAP_FAILED;
  std::size_t size = 0;
  if (fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
      (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && status.st_size > 0 &&
      static_cast<std::size_t>(status.st_size) <= most)
  {
    size = static_cast<std::size_t>(status.st_size);
    start = mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    futimens(descriptor, nullptr);  // has no effect on a read-only file system
  }
  close(descriptor);
  return start == MAP_FAILED ? nullptr : std::shared_ptr<const MappedFile>(new MappedFile(start, size));
}

MappedFile::~MappedFile()
{
  munmap(start_, size_);
}

/// Largest size of a table's file [bytes]. The file of the shipped gear has 8 MB.
constexpr std::size_t MAX_FILE = std::size_t{ 1 } << 30;

template <class T>
void append(std::string& bytes, const T* values, std::size_t count)
{
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

void append(std::string& bytes, const GridChecks& checks)
{
  const std::array<double, 3> numbers{ static_cast<double>(checks.made), static_cast<double>(checks.missed),
                                       checks.worst };
  append(bytes, numbers.data(), numbers.size());
}

/// Numbers of the table in the number format of this machine, because only this machine uses the cache.
std::string body(const SurfaceTable& table)
{
  std::string bytes;
  append(bytes, table.checks);
  append(bytes, table.teeth.checks);
  const std::array<double, 4> sizes{ table.pitch, table.ratio, static_cast<double>(table.columns),
                                     static_cast<double>(table.lines.size()) };
  append(bytes, sizes.data(), sizes.size());
  append(bytes, table.lines.data(), table.lines.size());
  append(bytes, table.nodes.data(), table.nodes.size());
  const ToothResponse& teeth = table.teeth;
  const std::array<double, 4> counts{ static_cast<double>(teeth.teeth), static_cast<double>(teeth.stored),
                                      static_cast<double>(teeth.columns), static_cast<double>(teeth.lines.size()) };
  append(bytes, counts.data(), counts.size());
  append(bytes, teeth.lines.data(), teeth.lines.size());
  append(bytes, teeth.values.data(), teeth.values.size());
  return bytes;
}

std::string body(const DeviationTable& table)
{
  std::string bytes;
  append(bytes, table.checks);
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

/// Reader of the numbers in a table's file. After the last number, `complete` is true if all numbers were valid.
class BodyReader
{
public:
  /// `bytes`: part of the file that begins at a multiple of the size of a number.
  BodyReader(std::shared_ptr<const MappedFile> file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  /// Reads a whole number, which must be at least `least`.
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

  void checks(GridChecks& checks)
  {
    checks.made = static_cast<int>(size(0.0));
    checks.missed = static_cast<int>(size(0.0));
    number(checks.worst);
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

  /// Next `count` values, which stay in the memory of the file; `count` < 1e12.
  template <class T>
  SharedValues<T> shared(std::size_t count)
  {
    static_assert(alignof(T) <= sizeof(double) && std::is_trivially_copyable_v<T>);
    const char* start = take(count * sizeof(T));
    return start != nullptr ? SharedValues<T>(file_, reinterpret_cast<const T*>(start), count) : SharedValues<T>();
  }

  bool complete() const { return good_ && bytes_.empty(); }

private:
  /// Next `size` bytes; null if the file has fewer bytes.
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

/// Whether the lines are finite and ascending.
bool ascending(const std::vector<double>& lines)
{
  return std::all_of(lines.begin(), lines.end(), [](double line) { return std::isfinite(line); }) &&
         std::adjacent_find(lines.begin(), lines.end(), std::greater_equal<>()) == lines.end();
}

bool parseBody(BodyReader& reader, SurfaceTable& table)
{
  reader.checks(table.checks);
  reader.checks(table.teeth.checks);
  reader.number(table.pitch);
  reader.number(table.ratio);
  const std::size_t columns = reader.size(1.0);
  const std::size_t lines = reader.size(2.0);
  table.columns = static_cast<int>(columns);
  reader.numbers(table.lines, lines);
  table.nodes = reader.shared<SurfaceNode>(lines * (columns + 1));
  ToothResponse& teeth = table.teeth;
  teeth.pitch = table.pitch;
  teeth.ratio = table.ratio;
  teeth.teeth = static_cast<int>(reader.size(0.0));
  teeth.stored = static_cast<int>(reader.size(0.0));
  teeth.columns = static_cast<int>(reader.size(0.0));
  const std::size_t tooth_lines = reader.size(0.0);
  reader.numbers(teeth.lines, tooth_lines);
  teeth.values = reader.shared<float>(tooth_lines * (static_cast<std::size_t>(teeth.columns) + 1) * teeth.nodeSize());
  const bool teeth_fit = tooth_lines == 0 || (tooth_lines > 1 && teeth.columns > 0 && teeth.stored > 0 &&
                                              teeth.teeth % teeth.stored == 0 && teeth.teeth <= 2 * teeth.stored);
  // This form of the comparison rejects NaN.
  return reader.complete() && teeth_fit && ascending(teeth.lines) &&
         std::all_of(teeth.values.begin(), teeth.values.end(), [](float x) { return std::isfinite(x); }) &&
         table.pitch > 0.0 && table.pitch < TWO_PI && std::abs(table.ratio) >= 1.0 && std::isfinite(table.ratio) &&
         ascending(table.lines) && finite(table.nodes);
}

bool parseBody(BodyReader& reader, DeviationTable& table)
{
  reader.checks(table.checks);
  table.pitches.resize(reader.size(2.0));
  table.swaps_lobes = reader.size(0.0) != 0;
  bool good = true;
  for (DeviationTable::Pitch& pitch : table.pitches)
  {
    const std::size_t columns = reader.size(0.0);
    const std::size_t lines = reader.size(0.0);
    pitch.columns = static_cast<int>(columns);
    reader.numbers(pitch.lines, lines);
    pitch.nodes = reader.shared<SurfaceNode>(lines > 0 ? lines * (columns + 1) : 0);
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

template <class Table>
bool read(const std::string& path, const std::string& header, Table& table)
{
  const std::shared_ptr<const MappedFile> file = MappedFile::ofOwn(path, MAX_FILE);
  std::uint64_t sum = 0;
  if (!file || file->bytes().size() < header.size() + sizeof(sum) ||
      file->bytes().compare(0, header.size(), header) != 0)
  {
    return false;
  }
  const std::string_view summed = file->bytes().substr(0, file->bytes().size() - sizeof(sum));
  std::memcpy(&sum, summed.data() + summed.size(), sizeof(sum));
  BodyReader reader(file, summed.substr(header.size()));
  return sum == tableChecksum(summed) && parseBody(reader, table);
}

template <class Table>
std::string write(const std::string& path, const std::string& header, const Table& table)
{
  std::string bytes = header + body(table);
  const std::uint64_t sum = tableChecksum(bytes);
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
}  // namespace

std::uint64_t tableChecksum(std::string_view bytes)
{
  constexpr std::uint64_t PRIME = 1099511628211ull;
  constexpr int TURN = 29;  // rotation [bits]; without it a change of the highest bit would change no other bit
  std::array<std::uint64_t, 4> rows{ 1, 2, 3, 4 };
  std::array<std::uint64_t, 4> words{};
  while (bytes.size() >= sizeof(words))
  {
    std::memcpy(words.data(), bytes.data(), sizeof(words));
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const std::uint64_t mixed = (rows[i] ^ words[i]) * PRIME;
      rows[i] = mixed << TURN | mixed >> (64 - TURN);
    }
    bytes.remove_prefix(sizeof(words));
  }
  return textHash(bytes, textHash({ reinterpret_cast<const char*>(rows.data()), sizeof(rows) }));
}

bool readTable(const std::string& path, const std::string& header, SurfaceTable& table)
{
  return read(path, header, table);
}

bool readTable(const std::string& path, const std::string& header, DeviationTable& table)
{
  return read(path, header, table);
}

bool readTable(const std::string& path, const std::string& header, BallTable& table)
{
  return read(path, header, table);
}

std::string writeTable(const std::string& path, const std::string& header, const SurfaceTable& table)
{
  return write(path, header, table);
}

std::string writeTable(const std::string& path, const std::string& header, const DeviationTable& table)
{
  return write(path, header, table);
}

std::string writeTable(const std::string& path, const std::string& header, const BallTable& table)
{
  return write(path, header, table);
}
}  // namespace hjt
