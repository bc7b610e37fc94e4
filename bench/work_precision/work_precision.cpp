// SPDX-License-Identifier: BSD-3-Clause
// Run time against error of solvers on the dynamic ring: one JSON line per solver and setting.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/work_precision/solvers.hpp"

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

/// Runs both references and keeps the first; prints how far they are apart.
void makeReference(const Problem& problem, const std::string& file)
{
  constexpr double NO_LIMIT = 1e9;
  std::vector<Series> series;
  nlohmann::json line{ { "problem", problem.name }, { "title", problem.title } };
  for (const Contender& contender : hjt::references(problem))
  {
    const Run run = contender.run(problem, NO_LIMIT);
    if (!run.failure.empty())
    {
      throw std::runtime_error(problem.name + ": reference " + contender.solver + " " + run.failure);
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
                       { "jacobians", run.jacobians },
                       { "factorisations", run.factorisations },
                       { "rejections", run.rejections } };
  if (run.failure.empty())
  {
    std::sort(times.begin(), times.end());
    line["processor_time"] = times[times.size() / 2];
    line["runs"] = times.size();
    line["series_error"] = toJson(hjt::seriesError(run.series, reference));
    line["end_error"] = toJson(hjt::endError(run.series, reference));
  }
  return line;
}

/// Every contender in turn, and that several times over: what slows the machine down meets all alike.
void compete(const Problem& problem, const std::string& file, int runs, double limit, const std::string& only)
{
  constexpr double WORTH_REPEATING = 0.5;  // [s]; longer runs are timed once
  const Series reference = hjt::readSeries(file);
  std::vector<Contender> contenders = hjt::ownContenders();
  for (const auto& more : { hjt::odeintContenders(problem), hjt::sundialsContenders() })
  {
    contenders.insert(contenders.end(), more.begin(), more.end());
  }
  contenders.erase(
      std::remove_if(contenders.begin(), contenders.end(),
                     [&](const Contender& contender) { return contender.solver.find(only) == std::string::npos; }),
      contenders.end());
  std::vector<Run> results;
  std::vector<std::vector<double>> times;
  for (const Contender& contender : contenders)
  {
    std::cerr << problem.name << ": " << contender.solver << ", " << contender.setting << std::endl;
    // Twice given up at looser tolerances: it takes longer still at those that follow.
    const std::size_t i = results.size();
    const auto lost = [&](std::size_t k)
    { return contenders[k].solver == contender.solver && results[k].failure.rfind("gave up", 0) == 0; };
    const bool hopeless = i >= 2 && lost(i - 1) && lost(i - 2);
    results.push_back(hopeless ? results.back() : contender.run(problem, limit));
    times.push_back({ results.back().time });
  }
  for (int pass = 1; pass < runs; ++pass)
  {
    for (std::size_t i = 0; i < contenders.size(); ++i)
    {
      if (results[i].failure.empty() && results[i].time < WORTH_REPEATING)
      {
        times[i].push_back(contenders[i].run(problem, limit).time);
      }
    }
  }
  for (std::size_t i = 0; i < contenders.size(); ++i)
  {
    nlohmann::json line = toJson(contenders[i], results[i], times[i], reference);
    line["problem"] = problem.name;
    std::cout << line.dump() << std::endl;
  }
}
}  // namespace

int main(int argc, char** argv)
{
  CLI::App app(
      "Run time against error of solvers on the dynamic ring; one JSON line per solver and setting on stdout.");
  std::string name;
  std::string file;
  std::string only;
  bool reference = false;
  int runs = 3;
  double limit = 5.0;
  app.add_option("problem", name, "problem to solve")->required()->check(CLI::IsMember(hjt::problemNames()));
  app.add_option("--reference", file, "file of the reference solution")->required();
  app.add_flag("--make-reference", reference, "write that file, by two methods, instead of reading it");
  app.add_option("--runs", runs, "timed runs, of which the median counts")->check(CLI::Range(1, 1000));
  app.add_option("--limit", limit, "processor time after which a run is given up [s]")->check(CLI::Range(1e-3, 1e6));
  app.add_option("--only", only, "only solvers with this in their names");
  CLI11_PARSE(app, argc, argv);
  try
  {
    const Problem problem = hjt::makeProblem(name);
    reference ? makeReference(problem, file) : compete(problem, file, runs, limit, only);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
