// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cyclic_solver.hpp"

#include <limits>

#include <Eigen/LU>

#include "random_ring.hpp"
#include "test_parameters.hpp"

namespace hjt
{
namespace
{
using TwoColumns = Eigen::Matrix<double, Eigen::Dynamic, 2>;

Eigen::MatrixXd randomMatrix(Eigen::Index rows, Eigen::Index columns, SeededRandom& random)
{
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index, Eigen::Index) { return random.uniform(); });
}

/// Symmetric, cyclic, five blocks a row, positive definite by dominance; with a cup.
RingTangent randomTangent(int teeth, SeededRandom& random)
{
  RingTangent tangent(teeth);
  tangent.setZero();
  for (int i = 0; i < teeth; ++i)
  {
    const Block2 block = randomMatrix(2, 2, random);
    tangent.addDiagonal(i, block * block.transpose() + 9.0 * Block2::Identity());
    tangent.next.add(i, randomMatrix(2, 2, random));
    tangent.second.add(i, randomMatrix(2, 2, random));
  }
  tangent.cup_direction = randomMatrix(2 * teeth, 1, random);
  tangent.cup_stiffness = 3.0;
  return tangent;
}

/// Against a dense solver with pivoting, within what the condition of the matrix lets any solver know.
void expectSolution(const RingTangent& tangent, const arcs::Kernels& kernels, SeededRandom& random)
{
  constexpr double ROUNDINGS = 200.0;  // that may add up; the elimination pivots within blocks only
  const int teeth = tangent.teeth();
  const Eigen::MatrixXd dense = denseTangent(tangent);
  CyclicSolver solver(teeth, kernels);
  ASSERT_TRUE(solver.factor(tangent));
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(dense);
  const Eigen::MatrixXd inverse = lu.inverse();
  const double condition = inverse.cwiseAbs().rowwise().sum().maxCoeff() * dense.cwiseAbs().rowwise().sum().maxCoeff();
  const double tolerance = ROUNDINGS * std::numeric_limits<double>::epsilon() * condition;
  ASSERT_LT(tolerance, 1e-3) << "the test says nothing: condition " << condition;

  const Eigen::MatrixXd loads = randomMatrix(2 * teeth, 3, random);
  const Eigen::MatrixXd expected = lu.solve(loads);
  const auto expect_solved = [&](const Eigen::MatrixXd& found, const Eigen::MatrixXd& wanted)
  { EXPECT_LT((found - wanted).lpNorm<Eigen::Infinity>(), tolerance * wanted.lpNorm<Eigen::Infinity>()) << teeth; };
  Eigen::VectorXd x = loads.col(0);
  solver.solve<1>(x);
  expect_solved(x, expected.col(0));
  TwoColumns y = loads.leftCols<2>();
  solver.solve<2>(y);
  expect_solved(y, expected.leftCols<2>());
  Eigen::VectorXd a = loads.col(0);
  Eigen::VectorXd b = loads.col(1);
  Eigen::VectorXd c = loads.col(2);
  solver.solve(a, b, c);
  expect_solved(a, expected.col(0));
  expect_solved(b, expected.col(1));
  expect_solved(c, expected.col(2));
}

/// The same for the code of every kind of processor.
void expectSolution(const RingTangent& tangent, SeededRandom& random)
{
  expectSolution(tangent, arcs::BASELINE, random);
#ifdef HJT_AVX2
  if (__builtin_cpu_supports("avx2") != 0)
  {
    expectSolution(tangent, arcs::AVX2, random);
  }
#endif
  expectSolution(tangent, arcs::fastest(), random);
}

using CyclicSolverOfSize = testing::TestWithParam<int>;
INSTANTIATE_TEST_SUITE_P(Teeth, CyclicSolverOfSize, testing::Values(8, 10, 12, 14, 16, 50, 102, 200, 400));

TEST_P(CyclicSolverOfSize, AgreesWithADenseSolverOnRandomTangents)
{
  SeededRandom random(41);
  expectSolution(randomTangent(GetParam(), random), random);
}

TEST_P(CyclicSolverOfSize, AgreesWithADenseSolverOnTangentsThatAreNotPositive)
{
  SeededRandom random(45);
  RingTangent tangent = randomTangent(GetParam(), random);
  for (const int tooth : { 0, GetParam() / 3, GetParam() / 2 })
  {
    tangent.addDiagonal(tooth, -40.0 * Block2::Identity());
  }
  expectSolution(tangent, random);
  tangent = randomTangent(GetParam(), random);
  tangent.diagonal.xx *= -1.0;
  tangent.diagonal.yy *= -1.0;
  tangent.diagonal.xy *= -1.0;
  expectSolution(tangent, random);
}

TEST_P(CyclicSolverOfSize, AgreesWithADenseSolverOnRingTangents)
{
  SeededRandom random(42);
  const RingModel model(shippedParameters({ "gear.teeth_flexspline=" + std::to_string(GetParam()),
                                            "gear.teeth_circular_spline=" + std::to_string(GetParam() + 2) }));
  // Pressed well into a wave generator of larger mean radius than the ring: every tooth in contact, K regular.
  const DrivePosition position{ 0.3, 0.003, model.gear.wave_amplitude };
  RingShape shape = model.restShape(position);
  pressOnWaveGenerator(model.rest, position, 1e-3, shape);
  shape.points *= 1.0 - 2e-5;
  shape.updateGeometry();
  RingForces forces(shape.teeth());
  RingTangent tangent(shape.teeth());
  model.forces(shape, position, forces);
  model.tangent(shape, forces, tangent);
  expectSolution(tangent, random);
}

TEST(CyclicSolver, AgreesWithADenseSolverAtEquilibriumUnderLoad)
{
  SeededRandom random(43);
  const Parameters parameters = shippedParameters();
  const RingModel model(parameters);
  RingEquilibrium ring(model, parameters.solver);
  ASSERT_TRUE(ring.insert({ 0.2, 0.0, parameters.gear.wave_amplitude }).ok());
  ASSERT_TRUE(ring.moveTo({ 0.2, -2e-3, parameters.gear.wave_amplitude }).ok());
  RingTangent tangent = wholeTangent(ring);
  expectSolution(tangent, random);
  // With next to no cup only the wave generator and a few teeth keep the ring from turning.
  tangent.cup_stiffness *= 1e-6;
  expectSolution(tangent, random);
}

#ifdef HJT_AVX2
/// What is kept beyond the process, and what two machines make, must not depend on the kind.
TEST(CyclicSolver, GivesTheSameBitsOnEveryKindOfProcessor)
{
  if (__builtin_cpu_supports("avx2") == 0)
  {
    GTEST_SKIP() << "this processor runs one kind";
  }
  SeededRandom random(46);
  const RingTangent tangent = randomTangent(200, random);
  const Eigen::VectorXd load = randomMatrix(400, 1, random);
  std::vector<Eigen::VectorXd> solutions;
  for (const arcs::Kernels* kernels : { &arcs::BASELINE, &arcs::AVX2, &arcs::fastest() })
  {
    CyclicSolver solver(200, *kernels);
    ASSERT_TRUE(solver.factor(tangent));
    solutions.push_back(load);
    solver.solve<1>(solutions.back());
  }
  EXPECT_EQ(solutions[0], solutions[1]);
  EXPECT_EQ(solutions[0], solutions[2]);
}
#endif

TEST(CyclicSolver, SaysWhenThereIsNoSolution)
{
  SeededRandom random(44);
  CyclicSolver solver(20);
  const RingTangent good = randomTangent(20, random);
  EXPECT_TRUE(solver.factor(good));

  RingTangent zero(20);
  zero.setZero();
  EXPECT_FALSE(solver.factor(zero));
  for (const int tooth : { 0, 1, 3, 9, 18, 19 })
  {
    // A tooth nothing holds.
    RingTangent loose = good;
    loose.diagonal.add(tooth, -loose.diagonal.at(tooth));
    for (const int before : { 0, 1, 2 })
    {
      const int i = (tooth + 20 - before) % 20;
      loose.next.add(i, before < 2 ? Block2(-loose.next.at(i)) : Block2::Zero());
      loose.second.add(i, before != 1 ? Block2(-loose.second.at(i)) : Block2::Zero());
    }
    loose.cup_direction.segment<2>(2 * tooth).setZero();
    EXPECT_FALSE(solver.factor(loose)) << tooth;
    for (const double bad : { std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity() })
    {
      RingTangent spoilt = good;
      spoilt.diagonal.xy[tooth] = bad;
      EXPECT_FALSE(solver.factor(spoilt)) << tooth;
      spoilt = good;
      spoilt.second.yx[tooth] = bad;
      EXPECT_FALSE(solver.factor(spoilt)) << tooth;
    }
  }
  // The failures have left nothing behind.
  EXPECT_TRUE(solver.factor(good));
}
}  // namespace
}  // namespace hjt
