// SPDX-License-Identifier: BSD-3-Clause
#include "fmu/journal.hpp"

#include <cmath>
#include <utility>

namespace hjt::fmu
{
namespace
{
constexpr char STEP = 'S';
constexpr char READ = 'R';
using InputIndex = std::uint16_t;  // index of a number among the numbers of all inputs

bool sameBits(double a, double b)
{
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void requireJournal(bool condition)
{
  if (!condition)
  {
    throw InputError("a serialised state contains a journal that was not written by this unit");
  }
}

double finite(double number)
{
  requireJournal(std::isfinite(number));
  return number;
}
}  // namespace

Journal::Journal(const std::vector<FmuVariable>& variables)
{
  for (std::size_t i = 0; i < variables.size(); ++i)
  {
    if (variables[i].causality == Causality::INPUT)
    {
      inputs_.push_back(i);
    }
  }
}

template <class Put>
void Journal::forInputs(const Values& values, const Put& put)
{
  std::size_t index = 0;
  for (const std::size_t input : inputs_)
  {
    for (const double number : values[input].numbers)
    {
      put(index++, number);
    }
  }
}

void Journal::make(std::size_t room)
{
  if (last_.size() + room > CHUNK)
  {
    if (full_.size() >= MOST / CHUNK)
    {
      is_too_long_ = true;
      full_.clear();
    }
    full_.push_back(std::make_shared<const std::string>(std::move(last_)));
    last_.clear();
  }
  last_.reserve(CHUNK);
}

void Journal::begin(const Values& values)
{
  given_.clear();
  full_.clear();
  last_.clear();
  is_too_long_ = false;
  forInputs(values, [&](std::size_t, double number) { given_.push_back(number); });
  make(given_.size() * sizeof(double));
  for (const double number : given_)
  {
    putNumber(last_, number);
  }
}

void Journal::step(const Values& values, double end)
{
  if (is_too_long_)
  {
    return;
  }
  InputIndex changes = 0;
  forInputs(values, [&](std::size_t i, double number) { changes += sameBits(number, given_[i]) ? 0 : 1; });
  make(sizeof STEP + sizeof end + sizeof changes + changes * (sizeof(InputIndex) + sizeof(double)));
  putNumber(last_, STEP);
  putNumber(last_, end);
  putNumber(last_, changes);
  forInputs(values,
            [&](std::size_t i, double number)
            {
              if (!sameBits(std::exchange(given_[i], number), number))
              {
                putNumber(last_, static_cast<InputIndex>(i));
                putNumber(last_, number);
              }
            });
}

void Journal::read(std::size_t reference)
{
  if (is_too_long_)
  {
    return;
  }
  make(sizeof READ + sizeof(std::uint32_t));
  putNumber(last_, READ);
  putNumber(last_, static_cast<std::uint32_t>(reference));
}

std::string Journal::bytes() const
{
  if (is_too_long_)
  {
    throw InputError("the inputs since the start exceed " + std::to_string(MOST >> 20) +
                     " MB, so that the state cannot be serialised");
  }
  std::string all;
  for (const auto& chunk : full_)
  {
    all += *chunk;
  }
  return all + last_;
}

std::unique_ptr<Simulation> Journal::replay(std::string_view bytes, const Unit& unit, Values values, double start,
                                            double end, const Notice& notice)
{
  *this = Journal(unit.variables());
  ByteReader reader(bytes);
  std::vector<double*> numbers;
  for (const std::size_t input : inputs_)
  {
    for (double& number : values[input].numbers)
    {
      number = finite(reader.number<double>());
      numbers.push_back(&number);
    }
  }
  begin(values);
  std::unique_ptr<Simulation> simulation = unit.start(values, start, notice);
  double now = start;
  while (!reader.empty())
  {
    const auto kind = reader.number<char>();
    requireJournal(kind == STEP || kind == READ);
    if (kind == READ)
    {
      const auto reference = reader.number<std::uint32_t>();
      requireJournal(reference < values.size() && unit.variables()[reference].causality == Causality::OUTPUT);
      read(reference);
      simulation->read(reference, values);
      continue;
    }
    now = reader.number<double>();
    requireJournal(std::abs(now) <= LARGEST_TIME);
    for (auto changes = reader.number<InputIndex>(); changes > 0; --changes)
    {
      const auto index = reader.number<InputIndex>();
      requireJournal(index < numbers.size());
      *numbers[index] = finite(reader.number<double>());
    }
    step(values, now);
    simulation->step(values, now);
  }
  requireJournal(now == end);
  return simulation;
}
}  // namespace hjt::fmu
