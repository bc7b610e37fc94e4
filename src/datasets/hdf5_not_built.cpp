// SPDX-License-Identifier: BSD-3-Clause
// This file replaces hdf5_files.cpp in builds without HDF5.
#include "datasets/run_file.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
[[noreturn]] void refuse(const std::string& path)
{
  throw InputError(path + " cannot be used, because this build has no HDF5");
}
}  // namespace

bool hasHdf5()
{
  return false;
}

std::unique_ptr<RunFile> makeHdf5RunFile(const Recording&, const RunSpec&, const Twin*, const std::string& path)
{
  refuse(path);
}

std::string readHdf5Text(const std::string& path, const char*)
{
  refuse(path);
}

Columns readHdf5Columns(const std::string& path, const std::vector<std::string>&)
{
  refuse(path);
}
}  // namespace hjt
