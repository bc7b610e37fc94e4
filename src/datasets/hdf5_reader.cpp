// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "datasets/hdf5_files.hpp"
#include "datasets/hdf5_tools.hpp"
#include "harmonic_joint_twin/base/errors.hpp"

namespace hjt
{
namespace
{
std::vector<std::string> namesIn(hid_t group)
{
  std::vector<std::string> found;
  const auto collect = [](hid_t, const char* name, const H5L_info_t*, void* into) -> herr_t
  {
    static_cast<std::vector<std::string>*>(into)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &found);
  return found;
}

/// Those with one number a row. `place`: for errors.
Columns columnsOf(hid_t group, const std::string& place)
{
  Columns columns;
  for (const std::string& column : namesIn(group))
  {
    const Hdf5Handle dataset(H5Dopen2(group, column.c_str(), H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
    if (H5Sget_simple_extent_ndims(space.get()) != 1)
    {
      continue;  // a number for each tooth
    }
    std::vector<double> rows(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get())));
    if (H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0)
    {
      throw InputError(place + "/" + column + " cannot be read");
    }
    columns[column] = std::move(rows);
  }
  return columns;
}
}  // namespace

bool hasHdf5()
{
  return true;
}

std::string readHdf5Text(const std::string& path, const char* name)
{
  const auto lock = lockLibrary();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
  {
    return {};
  }
  const Hdf5Handle dataset(H5Dopen2(file.get(), name, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid())
  {
    return {};
  }
  const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
  std::string text(H5Tget_size(type.get()), '\0');
  const bool read = H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) >= 0;
  return read ? text : std::string();
}

Columns readHdf5Columns(const std::string& path, const std::vector<std::string>& holding)
{
  const auto lock = lockLibrary();
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.valid())
  {
    throw InputError(path + " cannot be read as HDF5");
  }
  for (const std::string& name : namesIn(file.get()))
  {
    const Hdf5Handle group(H5Gopen2(file.get(), name.c_str(), H5P_DEFAULT), H5Gclose);
    const auto holds = [&](const std::string& wanted)
    { return H5Lexists(group.get(), wanted.c_str(), H5P_DEFAULT) > 0; };
    if (group.valid() && std::any_of(holding.begin(), holding.end(), holds))
    {
      return columnsOf(group.get(), path + ": " + name);
    }
  }
  return {};
}
}  // namespace hjt
