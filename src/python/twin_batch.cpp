// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "base/range.hpp"
#include "python/twin_object.hpp"
#include "surface/parallel_tasks.hpp"

namespace hjt
{
namespace
{
/// Spins until `condition` is true, but at most for about the time that waking a thread takes.
template <class Condition>
void spin(const Condition& condition)
{
  const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(50);
  while (!condition() && std::chrono::steady_clock::now() < end)
  {
  }
}

/// Threads that share the work of a task, and sleep while there is no task.
class ThreadTeam
{
public:
  using Task = std::function<void(std::size_t)>;

  /// `threads`: wanted number of threads, including the caller's thread. The system may allow fewer threads.
  explicit ThreadTeam(std::size_t threads) : work_(std::make_shared<Work>()), process_(::getpid())
  {
    try
    {
      while (others_.size() + 1 < threads)
      {
        others_.emplace_back([work = work_] { work->serve(); });
      }
    }
    catch (const std::system_error&)
    {
      // The system allows no further thread. The existing threads do the work.
    }
  }

  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  ~ThreadTeam()
  {
    if (::getpid() != process_)
    {
      // In a forked process the threads do not exist; they exist only in the parent.
      for (std::thread& other : others_)
      {
        other.detach();
      }
      return;
    }
    {
      const std::lock_guard<std::mutex> lock(work_->mutex);
      work_->ends = true;
    }
    work_->begun.notify_all();
    for (std::thread& other : others_)
    {
      other.join();
    }
  }

  std::size_t size() const noexcept { return others_.size() + 1; }

  /// Calls `task`, which must not throw, with each number of 0 ... count - 1 in no fixed order, and returns after the
  /// last call. A thread takes `portion` numbers at once. Only one thread at a time may call this function. `run` does
  /// not wait for threads without a number, so that it also works in a forked process, which lacks the threads.
  void run(std::size_t count, std::size_t portion, const Task& task)
  {
    {
      const std::lock_guard<std::mutex> lock(work_->mutex);
      work_->task = &task;
      work_->count = count;
      work_->portion = portion;
      work_->next = 0;
      ++work_->number;
    }
    work_->begun.notify_all();
    work_->share(task);
    {
      const std::lock_guard<std::mutex> lock(work_->mutex);
      work_->task = nullptr;
    }
    const auto all_left = [&] { return work_->busy == 0; };
    spin(all_left);
    std::unique_lock<std::mutex> lock(work_->mutex);
    work_->left.wait(lock, all_left);
  }

private:
  struct Work
  {
    std::mutex mutex;
    std::condition_variable begun;
    std::condition_variable left;
    const Task* task{};  // null if no further thread can join the task
    std::size_t count{};
    std::size_t portion{};
    std::atomic<std::uint64_t> number{ 0 };
    std::atomic<std::size_t> busy{ 0 };  // number of threads that work on the task, except the caller's thread
    std::atomic<bool> ends{ false };
    std::atomic<std::size_t> next{ 0 };

    void share(const Task& todo)
    {
      for (std::size_t first = next.fetch_add(portion); first < count; first = next.fetch_add(portion))
      {
        for (std::size_t i = first; i < std::min(first + portion, count); ++i)
        {
          todo(i);
        }
      }
    }

    void serve()
    {
      for (std::uint64_t last = 0;;)
      {
        const auto is_called = [&] { return ends || number != last; };
        spin(is_called);
        std::unique_lock<std::mutex> lock(mutex);
        begun.wait(lock, is_called);
        if (ends)
        {
          return;
        }
        last = number;
        const Task* const todo = task;
        if (todo == nullptr)
        {
          continue;  // the task ended before this thread woke up
        }
        ++busy;
        lock.unlock();
        share(*todo);
        lock.lock();
        if (--busy == 0)
        {
          left.notify_one();
        }
      }
    }
  };

  std::shared_ptr<Work> work_;
  std::vector<std::thread> others_;
  long process_;  // number of the process that has the threads
};

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds BLOCK_TIME{ 25 };  // a shorter block doubles the steps of the next block
constexpr py::ssize_t FIRST_BLOCK = 16384;             // steps of the first block, summed over all twins
constexpr py::ssize_t PORTION = 32;  // least number of steps that a thread takes at once (about 10 us on the surface)

using Twins = std::vector<std::pair<py::object, TwinObject*>>;

class BatchBuilder
{
public:
  /// `given`: Parameters or a Twin for `count` equal twins, or a list of Parameters and Twins. @throws InputError.
  BatchBuilder(const py::object& given, const std::optional<py::ssize_t>& count)
    : alike_(py::isinstance<Configuration>(given) || py::isinstance<TwinObject>(given))
  {
    if (alike_ != count.has_value())
    {
      throw InputError(alike_ ? "n, the number of twins, is missing" :
                                "n is only allowed with one Parameters or one Twin");
    }
    requireAtLeast("n", count.value_or(1), 1);
    for (py::ssize_t i = 0; alike_ && i < *count; ++i)
    {
      items_.push_back(given);
    }
    if (!alike_)
    {
      items_ = py::cast<std::vector<py::object>>(py::list(given));
    }
    if (items_.empty())
    {
      throw InputError("twins has no items, expected: one or more Parameters or Twin");
    }
  }

  /// Makes the twins of the batch. @throws InputError, Python's TypeError.
  Twins build(const std::optional<std::string>& cache, const py::object& progress) const
  {
    SurfaceSourceOf source(cache, progress, items_.size());
    Twins twins;
    for (std::size_t i = 0; i < items_.size(); ++i)
    {
      const py::object object = twinOf(i, twins, source);
      auto* const twin = py::cast<TwinObject*>(object);
      requireFits(i, *twin, twins);
      twins.emplace_back(object, twin);
    }
    source.warn();
    return twins;
  }

private:
  py::object twinOf(std::size_t i, const Twins& before, SurfaceSourceOf& source) const
  {
    const py::object& item = items_[i];
    const bool is_twin = py::isinstance<TwinObject>(item);
    if (is_twin && !alike_)
    {
      return item;
    }
    if (!is_twin && !py::isinstance<Configuration>(item))
    {
      throw py::type_error("twins" + placeText(i) + " is a " +
                           py::cast<std::string>(item.attr("__class__").attr("__name__")) +
                           ", expected: Parameters or Twin");
    }
    TwinObject* const model = is_twin ? py::cast<TwinObject*>(item) : alike_ && i > 0 ? before.front().second : nullptr;
    if (model != nullptr)
    {
      py::object copy = py::cast(std::make_unique<TwinObject>(model->twin(), model->parameters()));
      withoutLock([&] { source.next(); });
      return copy;
    }
    try
    {
      return made(py::cast<Configuration>(item), source);
    }
    catch (const ParameterError& error)
    {
      throw ParameterError((alike_ ? "" : "twins" + placeText(i) + ": ") + error.what());
    }
  }

  static py::object made(const Configuration& parameters, SurfaceSourceOf& source)
  {
    Twin twin = withoutLock(
        [&, values = parameters.values()]
        {
          Twin built(values, source.source());
          source.next();
          return built;
        });
    return py::cast(std::make_unique<TwinObject>(std::move(twin), parameters));
  }

  static void requireFits(std::size_t i, TwinObject& twin, const Twins& before)
  {
    for (std::size_t j = 0; j < before.size(); ++j)
    {
      if (before[j].second == &twin)
      {
        throw InputError("twins" + placeText(i) + " is the same Twin as twins" + placeText(j) +
                         "; copy.copy makes a copy");
      }
    }
    if (!before.empty() && twin.twin().stepLength() != before.front().second->twin().stepLength())
    {
      throw InputError("twins" + placeText(i) + " steps by " + std::to_string(twin.twin().stepLength()) +
                       " ns, twins[0] by " + std::to_string(before.front().second->twin().stepLength()) +
                       " ns (solver.rate); twins of a batch need equal steps");
    }
  }

  static std::string placeText(std::size_t i) { return '[' + std::to_string(i) + ']'; }

  bool alike_;
  std::vector<py::object> items_;
};

std::size_t threadCount(const std::optional<int>& threads, std::size_t twins)
{
  requireAtLeast("threads", threads.value_or(1), 1);
  return std::min<std::size_t>(threads ? static_cast<unsigned>(*threads) : processors(), twins);
}

/// Twins that step together, and the threads that step them.
class TwinBatch
{
public:
  TwinBatch(Twins twins, std::size_t threads) : twins_(std::move(twins)), team_(threads) {}

  py::ssize_t size() const { return static_cast<py::ssize_t>(twins_.size()); }
  std::size_t threads() const { return team_.size(); }

  /// The twin at `place`; a negative place counts from the end. @throws py::index_error.
  py::object at(py::ssize_t place) const
  {
    const py::ssize_t i = place < 0 ? place + size() : place;
    if (i < 0 || i >= size())
    {
      throw py::index_error("twin " + std::to_string(place) + " of a batch of " + std::to_string(size()));
    }
    return twins_[static_cast<std::size_t>(i)].first;
  }

  StepRows step(const GivenInputs& given, py::ssize_t steps, const py::object& out)
  {
    requireAtLeast("steps", steps, 1);
    RunShape shape{ RunShape::Axes::TWINS, loadTorqueLimit(), size(), steps };
    const RunInputs inputs(given, shape);
    StepRows rows = rowsFor({ size() }, out);
    march(inputs, steps, steps, rows.mutable_data(), py::none());
    return rows;
  }

  StepRows run(const std::optional<py::ssize_t>& given_steps, const GivenInputs& given, py::ssize_t every,
               const py::object& out, const py::object& progress)
  {
    RunShape shape{ RunShape::Axes::TWINS_AND_STEPS, loadTorqueLimit(), size(), given_steps };
    const RunInputs inputs(given, shape);
    const py::ssize_t steps = requireSteps(shape.steps, every);
    StepRows rows = rowsFor({ size(), steps / every }, out);
    march(inputs, steps, every, rows.mutable_data(), progress);
    return rows;
  }

  StepRows outputs() const
  {
    StepRows rows(size());
    StepRow* row = rows.mutable_data();
    for (const auto& twin : twins_)
    {
      *row++ = rowOf(twin.second->twin());
    }
    return rows;
  }

  py::dict counters() const
  {
    py::dict named;
    for (py::ssize_t i = 0; i < size(); ++i)
    {
      for (const auto& item : namedCounters(twins_[static_cast<std::size_t>(i)].second->twin().counters()))
      {
        if (i == 0)
        {
          named[item.first] = py::array_t<std::int64_t>(size());
        }
        auto values = py::reinterpret_borrow<py::array_t<std::int64_t>>(named[item.first]);
        values.mutable_at(i) = py::cast<std::int64_t>(item.second);
      }
    }
    return named;
  }

private:
  /// Largest output.load_torque_limit of all twins [N.m].
  double loadTorqueLimit() const
  {
    double limit = 0.0;
    for (const auto& twin : twins_)
    {
      limit = std::max(limit, twin.second->parameters().values().output.load_torque_limit);
    }
    return limit;
  }

  /// Advances all twins by `steps`, in blocks. After each block all twins are at the same step.
  void march(const RunInputs& inputs, py::ssize_t steps, py::ssize_t every, StepRow* rows, const py::object& progress)
  {
    std::vector<Twin*> twins;
    std::vector<InUse::Hold> holds;
    twins.reserve(twins_.size());
    holds.reserve(twins_.size());
    for (const auto& twin : twins_)
    {
      twins.push_back(&twin.second->twin());
      holds.push_back(twin.second->inUse().hold());
    }
    const py::ssize_t columns = steps / every;
    withoutLock(
        [&]
        {
          RunCheck check(progress);
          py::ssize_t block = std::max<py::ssize_t>(FIRST_BLOCK / size(), 1);
          for (py::ssize_t done = 0; done < steps;)
          {
            const py::ssize_t until = std::min(done + block, steps);
            const Clock::time_point begin = Clock::now();
            const auto portion = static_cast<std::size_t>(std::max<py::ssize_t>(PORTION / (until - done), 1));
            team_.run(twins.size(), portion,
                      [&](std::size_t i)
                      {
                        const auto number = static_cast<py::ssize_t>(i);
                        StepRow* row = rows + number * columns + done / every;
                        py::ssize_t until_row = every - done % every;
                        for (py::ssize_t step = done; step < until; ++step)
                        {
                          inputs.step(*twins[i], step, number);
                          if (--until_row == 0)
                          {
                            *row++ = rowOf(*twins[i]);
                            until_row = every;
                          }
                        }
                      });
            block *= Clock::now() - begin < BLOCK_TIME ? 2 : 1;
            done = until;
            check(done, steps);
          }
          check.end();
        });
  }

  Twins twins_;
  ThreadTeam team_;
};
py::arg_v none(const char* name)
{
  return py::arg(name) = py::none();
}

void bindSteps(py::class_<TwinBatch>& batch)
{
  batch
      .def(
          "step",
          [](TwinBatch& self, const py::object& motor_torque, const py::object& load_torque, const py::object& brake,
             const py::object& temperature, py::ssize_t steps, const py::object& out) {
            return self.step({ motor_torque, load_torque, brake, temperature }, steps, out);
          },
          none("motor_torque"), none("load_torque"), none("brake"), none("temperature"), py::arg("steps") = 1,
          none("out"),
          "Advances by steps of 1 / solver.rate with constant inputs, for use in a closed loop.\n\n"
          "motor_torque, load_torque [N.m], brake (0 or 1), temperature [degC]: a number for all, or an array of shape "
          "(n,); None: the value that was commanded before. A given torque does not time out during the steps. out: as "
          "for run.\n\n"
          "Returns a structured array of shape (n,) with dtype STEP_DTYPE: the outputs of all twins after the last "
          "step. Raises InputError.")
      .def(
          "run",
          [](TwinBatch& self, const std::optional<py::ssize_t>& steps, const py::object& motor_torque,
             const py::object& load_torque, const py::object& brake, const py::object& temperature, py::ssize_t every,
             const py::object& out, const py::object& progress) {
            return self.run(steps, { motor_torque, load_torque, brake, temperature }, every, out, progress);
          },
          none("steps"), none("motor_torque"), none("load_torque"), none("brake"), none("temperature"),
          py::arg("every") = 1, none("out"), none("progress"),
          "Advances all twins by a block of steps. Ctrl-C ends the call and leaves all twins at the same step.\n\n"
          "steps, every: as for Twin.run. motor_torque, load_torque [N.m], brake (0 or 1), temperature [degC]: a "
          "number; an array of shape (steps,) for all twins, (n, 1) or (n, steps); None: the value that was commanded "
          "before. A given torque does not time out during the run. out: array of an earlier call that is overwritten; "
          "None: a new array. progress: as for Twin.run.\n\n"
          "Returns a structured array of shape (n, steps // every) with dtype STEP_DTYPE. Raises InputError.");
}
}  // namespace

void bindTwinBatch(py::module& module)
{
  py::class_<TwinBatch> batch(
      module, "TwinBatch",
      "Twins that step together on all cores, without the interpreter's lock.\n\n"
      "TwinBatch(twins, n=None, cache=None, progress=None, threads=None). twins: Parameters or a Twin, of which n "
      "copies are made, with equal noise of their sensors; or a list of them, each with its own parameters and faults. "
      "Parameters make a new twin; a Twin is used itself, not copied. All twins need the same solver.rate. Equal "
      "response surfaces are shared. cache: as for Twin. progress: called with 0 ... 1 while the twins are made. "
      "threads: number of threads with the caller's; None: one for each processor. Raises InputError, "
      "ParameterError.\n\n"
      "batch[i] is the i-th Twin, which may be reset, read or given a fault. Each twin gives the numbers that it would "
      "give alone. A twin without equilibrium keeps its state, with converged = False, and counts this in "
      "counters['solver_failures']; the others continue.");
  batch
      .def(py::init(
               [](const py::object& twins, const std::optional<py::ssize_t>& n, const std::optional<std::string>& cache,
                  const py::object& progress, const std::optional<int>& threads)
               {
                 const BatchBuilder builder(twins, n);
                 threadCount(threads, 1);
                 Twins built = builder.build(cache, progress);
                 const std::size_t count = threadCount(threads, built.size());
                 return std::make_unique<TwinBatch>(std::move(built), count);
               }),
           py::arg("twins"), none("n"), none("cache"), none("progress"), none("threads"))
      .def("__len__", &TwinBatch::size, "Number of twins.")
      .def("__getitem__", &TwinBatch::at, py::arg("twin"), "Returns the Twin of this number. Raises IndexError.")
      .def(
          "__reduce__",
          [](const TwinBatch&) -> py::object
          {
            throw py::type_error(
                "a TwinBatch can be neither copied nor pickled; TwinBatch([copy.copy(twin) for twin in batch]) makes a "
                "second batch at the same instant");
          },
          "Raises TypeError, because a batch cannot be copied. Copy its twins instead.")
      .def("__repr__",
           [](const TwinBatch& self)
           {
             return "<TwinBatch of " + std::to_string(self.size()) + " twins on " + std::to_string(self.threads()) +
                    (self.threads() == 1 ? " thread>" : " threads>");
           })
      .def_property_readonly("outputs", &TwinBatch::outputs,
                             "all outputs and readings of the present instant: array of shape (n,), dtype STEP_DTYPE")
      .def_property_readonly("counters", &TwinBatch::counters,
                             "counts of events since the last reset, by name: dict of str to int array of shape (n,)")
      .def_property_readonly("threads", &TwinBatch::threads,
                             "number of threads that step the twins, with the caller's [-]");
  bindSteps(batch);
}
}  // namespace hjt
