// SPDX-License-Identifier: BSD-3-Clause
#include "arm/residual_statistics.hpp"

#include <complex>

#include <unsupported/Eigen/FFT>

namespace hjt
{
double correlationRows(const Eigen::VectorXd& residuals)
{
  const Eigen::Index rows = residuals.size();
  Eigen::Index size = 2;
  while (size < 2 * rows)
  {
    size *= 2;
  }
  // Padded by zeros, else the end of the rows would meet their begin.
  Eigen::VectorXd padded = Eigen::VectorXd::Zero(size);
  padded.head(rows) = residuals;
  Eigen::FFT<double> transform;
  Eigen::VectorXcd spectrum;
  transform.fwd(spectrum, padded);
  spectrum = spectrum.cwiseAbs2().cast<std::complex<double>>();
  Eigen::VectorXd products;  // of rows that lie so far apart
  transform.inv(products, spectrum, size);
  double length = 1.0;
  for (Eigen::Index lag = 1; lag < rows / 4 && products[lag] > 0.0; ++lag)
  {
    length += 2.0 * products[lag] / products[0];
  }
  return length;
}
}  // namespace hjt
