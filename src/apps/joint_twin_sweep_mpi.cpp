// SPDX-License-Identifier: BSD-3-Clause
// `joint_twin sweep` under mpirun: rank I of N does the shard I/N.
#include <mpi.h>

#include <csignal>
#include <exception>
#include <iostream>
#include <optional>

#include "apps/common/command.hpp"
#include "apps/tool/sweep_runner.hpp"
#include "output/exit_code.hpp"
#include "output/interrupt.hpp"
#include "output/output_file.hpp"

namespace
{
int sweepAs(int rank, int ranks, int argc, char** argv)
{
  hjt::CommandLine line("joint_twin_sweep_mpi", "One rank after the other takes a run of the plan.");
  hjt::SweepArguments arguments;
  hjt::Command root = line.root();
  hjt::addSweepOptions(root, arguments);
  try
  {
    if (const std::optional<int> ended = line.parse(argc, argv, rank == 0))
    {
      return *ended;
    }
    arguments.shard = static_cast<std::uint64_t>(rank);
    arguments.shards = static_cast<std::uint64_t>(ranks);
    arguments.quiet = rank > 0;
    const int code = hjt::sweep(arguments);
    hjt::finishStandardOutput();
    return code;
  }
  catch (const std::exception& error)
  {
    if (rank == 0)
    {
      std::cerr << "joint_twin_sweep_mpi: " << error.what() << '\n';
    }
    return hjt::EXIT_FAILED;
  }
}
}  // namespace

int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  int rank = 0;
  int ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const hjt::InterruptScope interrupts;  // a rank that is done waits for the others
  std::signal(SIGXFSZ, SIG_IGN);         // beyond a limit of size, writing fails as on a full disk
  const int mine = sweepAs(rank, ranks, argc, argv);
  int worst = mine;
  MPI_Allreduce(&mine, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return worst;
}
