// SPDX-License-Identifier: BSD-3-Clause
// Run time against error of solvers on the ring: one JSON line per solver and setting.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/common/command.hpp"
#include "bench/work_precision/operating.hpp"

namespace
{
using hjt::Contender;
using hjt::Problem;
using hjt::Run;
using hjt::Series;

nlohmann::json toJson(const hjt::Errors& errors)
{
  return { { "angle", errors.angle }, { "position", errors.position }, { "force", errors.force } };
}

/// Who runs on a problem, and by whom they are judged.
struct Field
{
  std::string name;
  std::string title;
  double duration;  ///< [s]
  std::vector<Contender> contenders;
  std::vector<Contender> references;
};

/// Runs both references and keeps the first; prints how far they are apart.
void makeReference(const Field& field, const std::string& file)
{
  constexpr double NO_LIMIT = 1e9;
  std::vector<Series> series;
  nlohmann::json line{ { "problem", field.name }, { "title", field.title } };
  for (const Contender& contender : field.references)
  {
    std::cerr << field.name << ": reference, " << contender.solver << ", " << contender.setting << std::endl;
    const Run run = contender.run(NO_LIMIT);
    if (!run.failure.empty())
    {
      throw std::runtime_error(field.name + ": reference " + contender.solver + " " + run.failure);
    }
    line["methods"].push_back(contender.solver + ", " + contender.setting);
    line["processor_times"].push_back(run.time);
    series.push_back(run.series);
  }
  line["apart"] = toJson(hjt::seriesError(series[1], series[0]));
  hjt::writeSeries(series[0], file);
  std::cout << line.dump() << std::endl;
}

nlohmann::json toJson(const Contender& contender, const Run& run, std::vector<double>& times, const Series& reference)
{
  nlohmann::json line{ { "solver", contender.solver },
                       { "setting", contender.setting },
                       { "failure", run.failure },
                       { "steps", run.steps },
                       { "force_evaluations", run.force_evaluations },
                       { "factorisations", run.factorisations },
                       { "rejections", run.rejections } };
  if (run.failure.empty())
  {
    std::sort(times.begin(), times.end());
    line["processor_time"] = times[times.size() / 2];
    line["least"] = times.front();
    line["most"] = times.back();
    line["runs"] = times.size();
    line["series_error"] = toJson(hjt::seriesError(run.series, reference));
    line["end_error"] = toJson(hjt::endError(run.series, reference));
  }
  return line;
}

/// Every contender in turn, and that several times over: what slows the machine down meets all alike.
void compete(const Field& field, const std::string& file, int runs, double limit)
{
  constexpr double ENOUGH = 1.5;  // processor time of all runs of one contender after which it is not timed again [s]
  const Series reference = hjt::readSeries(file);
  const std::vector<Contender>& contenders = field.contenders;
  std::vector<Run> results;
  std::vector<std::vector<double>> times;
  for (const Contender& contender : contenders)
  {
    std::cerr << field.name << ": " << results.size() + 1 << " of " << contenders.size() << ", " << contender.solver
              << ", " << contender.setting << std::endl;
    // Given up twice at looser tolerances, or early: it takes longer still at those that follow.
    constexpr double EARLY = 0.3;  // of the duration
    const std::size_t i = results.size();
    const auto lost = [&](std::size_t k)
    { return contenders[k].solver == contender.solver && results[k].failure.rfind("gave up", 0) == 0; };
    const bool hopeless =
        i >= 1 && lost(i - 1) && (results[i - 1].reached < EARLY * field.duration || (i >= 2 && lost(i - 2)));
    results.push_back(hopeless ? results.back() : contender.run(limit));
    times.push_back({ results.back().time });
  }
  for (int pass = 1; pass < runs; ++pass)
  {
    std::cerr << field.name << ": run " << pass + 1 << " of " << runs << std::endl;
    for (std::size_t i = 0; i < contenders.size(); ++i)
    {
      if (results[i].failure.empty() && pass * results[i].time < ENOUGH)
      {
        times[i].push_back(contenders[i].run(limit).time);
      }
    }
  }
  for (std::size_t i = 0; i < contenders.size(); ++i)
  {
    nlohmann::json line = toJson(contenders[i], results[i], times[i], reference);
    line["problem"] = field.name;
    std::cout << line.dump() << std::endl;
  }
}

/// Those of the dynamic ring.
Field ringField(const Problem& problem)
{
  Field field{ problem.name, problem.title, problem.duration(), hjt::ownContenders(problem), hjt::references(problem) };
  for (const auto& more :
       { hjt::odeintContenders(problem), hjt::sundialsContenders(problem), hjt::radauContenders(problem) })
  {
    field.contenders.insert(field.contenders.end(), more.begin(), more.end());
  }
  return field;
}

void runField(Field field, bool make_reference, const std::string& file, int runs, double limit,
              const std::string& only)
{
  const auto other = [&](const Contender& contender) { return contender.solver.find(only) == std::string::npos; };
  field.contenders.erase(std::remove_if(field.contenders.begin(), field.contenders.end(), other),
                         field.contenders.end());
  make_reference ? makeReference(field, file) : compete(field, file, runs, limit);
}
}  // namespace

int main(int argc, char** argv)
{
  static const std::string OPERATING = "operating";
  static const std::string LEVELS = "levels";
  std::vector<std::string> names = hjt::problemNames();
  names.insert(names.end(), { OPERATING, LEVELS });
  std::string name;
  std::string file;
  std::string only;
  bool reference = false;
  int runs = 3;
  double limit = 5.0;
  hjt::CommandLine line(
      "work_precision",
      "Run time against error of solvers on the ring; one JSON line per solver and setting on stdout.");
  hjt::OptionTable& root = line.root();
  root.add("problem", name, "problem to solve").required().choice(names);
  root.add("--reference", file, "file of the reference solution").required();
  root.flag("--make-reference", reference, "write that file, by two methods, instead of reading it");
  root.add("--runs", runs, "timed runs, of which the median counts").range(1, 1000);
  root.add("--limit", limit, "processor time after which a run is given up [s]").range(1e-3, 1e6);
  root.add("--only", only, "only solvers with this in their names");
  if (const std::optional<int> ended = line.parse(argc, argv))
  {
    return *ended;
  }
  try
  {
    if (name == OPERATING)
    {
      const hjt::OperatingProblem problem(hjt::OperatingProblem::Friction::FOR_PEERS);
      runField({ name, "Operating model, ring in equilibrium, reversal, 1 s", 1.0, hjt::operatingContenders(problem),
                 hjt::operatingReferences(problem) },
               reference, file, runs, limit, only);
      return 0;
    }
    if (name == LEVELS)
    {
      const hjt::OperatingProblem problem(hjt::OperatingProblem::Friction::AS_SHIPPED);
      runField({ name, "Levels of detail: shipped gear, all friction, reversal, 1 s", 1.0,
                 hjt::levelContenders(problem), hjt::levelReferences(problem) },
               reference, file, runs, limit, only);
      return 0;
    }
    const Problem problem = hjt::makeProblem(name);
    runField(ringField(problem), reference, file, runs, limit, only);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
