// SPDX-License-Identifier: BSD-3-Clause
// The tool's commands within Python: the module _tool, behind python/harmonic_joint_twin/_commands.py.
#include <exception>
#include <iostream>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "apps/common/command.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"

namespace hjt
{
namespace
{
namespace py = pybind11;

/// Captures what is written to a stream during its lifetime.
class Captured
{
public:
  explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(&text_)) {}
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;
  ~Captured() { stream_.rdbuf(before_); }

  std::string text() const { return text_.str(); }

private:
  std::stringbuf text_;
  std::ostream& stream_;
  std::streambuf* before_;
};

struct Ended
{
  int code{ EXIT_FAILED };
  std::string document;  // of stdout
  std::string messages;  // of stderr
  std::exception_ptr error;
  bool interrupted{};
};

/// Runs a command. Streams and signals belong to the process: one command at a time.
Ended runAlone(std::vector<std::string> arguments)
{
  static std::mutex running;
  const std::lock_guard<std::mutex> lock(running);
  std::vector<char*> argv;
  for (std::string& argument : arguments)
  {
    argv.push_back(argument.data());
  }
  argv.push_back(nullptr);
  Ended ended;
  const Captured document(std::cout);
  const Captured messages(std::cerr);
  const InterruptScope scope{ InterruptScope::Guest() };
  try
  {
    CommandLine line("joint_twin", "");
    line.addSubcommands();
    const std::optional<int> refused = line.parse(static_cast<int>(arguments.size()), argv.data());
    ended.code = refused ? *refused : line.run();
  }
  catch (...)
  {
    ended.error = std::current_exception();
  }
  ended.document = document.text();
  ended.messages = messages.text();
  ended.interrupted = interruptSignal() != 0;
  return ended;
}

std::tuple<int, std::string, std::string> run(const std::vector<std::string>& arguments)
{
  Ended ended;
  {
    const py::gil_scoped_release release;
    ended = runAlone(arguments);
  }
  if (ended.interrupted)
  {
    PyErr_SetInterrupt();  // the handler of the caller's own, in the main thread
    if (PyErr_CheckSignals() == 0)
    {
      PyErr_SetNone(PyExc_KeyboardInterrupt);
    }
    throw py::error_already_set();
  }
  if (ended.error)
  {
    std::rethrow_exception(ended.error);
  }
  return { ended.code, ended.document, ended.messages };
}
}  // namespace
}  // namespace hjt

PYBIND11_MODULE(_tool, module)
{
  module.doc() = "The tool's commands, in this process.";
  module.def(
      "run", &hjt::run, pybind11::arg("arguments"),
      "Runs a command line, the program's name first, without the interpreter's lock. Gives exit code, stdout and "
      "stderr. Errors as of harmonic_joint_twin.");
}
