// SPDX-License-Identifier: BSD-3-Clause
#include <petscts.h>

#include "bench/work_precision/follow.hpp"
#include "bench/work_precision/linear_system.hpp"
#include "bench/work_precision/solvers.hpp"

namespace hjt
{
namespace
{
/// PETSc is started once and ended with the program.
class Session
{
public:
  Session()
  {
    PetscInitializeNoArguments();
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
  }
  ~Session() { PetscFinalize(); }
};

struct Choice
{
  const char* name;
  TSType type;
  const char* variant;  // of rosw and arkimex
  int order;            // of bdf
};

/// A time stepper of PETSc; its linear systems go to KLU as those of the other peers do, the cup's rank one apart.
class Petsc : public Integrator
{
public:
  Petsc(const Choice& choice, double tolerance, const Problem& problem)
    : ring_(problem.ring()), linear_(makeLinearSystem(LinearKind::KLU, ring_)), rates_(ring_.states())
  {
    static Session session;
    const PetscInt n = ring_.states();
    VecCreateSeq(PETSC_COMM_SELF, n, &y_);
    VecDuplicate(y_, &between_);
    VecDuplicate(y_, &weights_);
    write(y_, [&](auto values) { values << problem.q, problem.v; });
    write(weights_, [&](auto values) { values = tolerance * problem.scale(); });
    MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, &matrix_);
    TSCreate(PETSC_COMM_SELF, &stepper_);
    TSSetProblemType(stepper_, TS_NONLINEAR);
    TSSetType(stepper_, choice.type);
    TSSetEquationType(stepper_, TS_EQ_IMPLICIT);
    TSSetIFunction(stepper_, nullptr, residual, this);
    TSSetIJacobian(stepper_, matrix_, matrix_, linearise, this);
    TSSetTolerances(stepper_, 0.0, weights_, 0.0, nullptr);
    TSSetSolution(stepper_, y_);
    TSSetMaxSteps(stepper_, 100000000);
    TSSetMaxSNESFailures(stepper_, -1);
    TSSetExactFinalTime(stepper_, TS_EXACTFINALTIME_MATCHSTEP);
    TSSetTimeStep(stepper_, FIRST_STEP);
    if (choice.order > 0)
    {
      TSBDFSetOrder(stepper_, choice.order);
    }
    else if (std::string(choice.type) == TSROSW)
    {
      TSRosWSetType(stepper_, choice.variant);
    }
    else
    {
      TSARKIMEXSetType(stepper_, choice.variant);
      TSARKIMEXSetFullyImplicit(stepper_, PETSC_TRUE);
    }
    SNES newton = nullptr;
    TSGetSNES(stepper_, &newton);
    SNESSetTolerances(newton, PETSC_DEFAULT, NEWTON_TOLERANCE, PETSC_DEFAULT, 20, 10000);
    SNESLineSearch search = nullptr;
    SNESGetLineSearch(newton, &search);
    SNESLineSearchSetType(search, SNESLINESEARCHBASIC);  // the others ask for products with the matrix
    KSP krylov = nullptr;
    SNESGetKSP(newton, &krylov);
    KSPSetType(krylov, KSPPREONLY);
    PC direct = nullptr;
    KSPGetPC(krylov, &direct);
    PCSetType(direct, PCSHELL);
    PCShellSetContext(direct, this);
    PCShellSetApply(direct, solve);
  }

  ~Petsc() override
  {
    TSDestroy(&stepper_);
    MatDestroy(&matrix_);
    for (Vec* vector : { &y_, &between_, &weights_ })
    {
      VecDestroy(vector);
    }
  }

  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;

  void enter(const Phase& phase, double time) override
  {
    ring_.setWave(phase.wave);
    TSSetTime(stepper_, time);
    TSSetMaxTime(stepper_, phase.end);
    TSSetConvergedReason(stepper_, TS_CONVERGED_ITERATING);
    TSSetTimeStep(stepper_, FIRST_STEP);
    TSRestartStep(stepper_);
  }

  bool advance(double /*due*/, double /*end*/, double& time) override
  {
    if (TSStep(stepper_) != 0)
    {
      return false;
    }
    TSConvergedReason reason = TS_CONVERGED_ITERATING;
    TSGetConvergedReason(stepper_, &reason);
    TSGetTime(stepper_, &time);
    ++steps_;
    const double* values = nullptr;
    VecGetArrayRead(y_, &values);
    ring_.pairTeeth(Eigen::Map<const Eigen::VectorXd>(values, ring_.coordinates()), time);
    VecRestoreArrayRead(y_, &values);
    return reason >= 0;
  }

  const double* at(double time) override
  {
    double now = 0.0;
    TSGetTime(stepper_, &now);
    if (time < now)
    {
      TSInterpolate(stepper_, time, between_);
    }
    else
    {
      VecCopy(y_, between_);
    }
    state_.resize(ring_.states());
    const double* values = nullptr;
    VecGetArrayRead(between_, &values);
    state_ = Eigen::Map<const Eigen::VectorXd>(values, state_.size());
    VecRestoreArrayRead(between_, &values);
    return state_.data();
  }

  void count(Run& run) override
  {
    PetscInt by_error = 0;
    PetscInt by_newton = 0;
    TSGetStepRejections(stepper_, &by_error);
    TSGetSNESFailures(stepper_, &by_newton);
    run.steps = steps_;
    run.force_evaluations = evaluations_;
    run.factorisations = factorisations_;
    run.rejections = by_error + by_newton;
  }

private:
  static constexpr double FIRST_STEP = 1e-8;  // [s]
  static constexpr double NEWTON_TOLERANCE =
      1e-4;  // of the residual; PETSc's own 1e-8 costs twice the time for nothing

  template <class Writer>
  static void write(Vec vector, Writer&& writer)
  {
    PetscInt size = 0;
    VecGetSize(vector, &size);
    double* values = nullptr;
    VecGetArray(vector, &values);
    writer(Eigen::Map<Eigen::VectorXd>(values, size));
    VecRestoreArray(vector, &values);
  }

  static PetscErrorCode residual(TS /*stepper*/, PetscReal time, Vec y, Vec derivative, Vec result, void* data)
  {
    auto& own = *static_cast<Petsc*>(data);
    const double* state = nullptr;
    const double* speed = nullptr;
    VecGetArrayRead(y, &state);
    VecGetArrayRead(derivative, &speed);
    own.ring_.rates(state, time, own.rates_.data());
    ++own.evaluations_;
    const Eigen::Map<const Eigen::VectorXd> left(speed, own.rates_.size());
    write(result, [&](auto values) { values = left - own.rates_; });
    VecRestoreArrayRead(y, &state);
    VecRestoreArrayRead(derivative, &speed);
    return 0;
  }

  /// shift I - J, that is shift times the system's I - J / shift.
  static PetscErrorCode linearise(TS /*stepper*/, PetscReal time, Vec y, Vec /*derivative*/, PetscReal shift,
                                  Mat /*matrix*/, Mat /*preconditioner*/, void* data)
  {
    auto& own = *static_cast<Petsc*>(data);
    const double* state = nullptr;
    VecGetArrayRead(y, &state);
    own.linear_->linearise(state, time);
    VecRestoreArrayRead(y, &state);
    own.gamma_ = 1.0 / shift;
    ++own.evaluations_;
    ++own.factorisations_;
    own.linear_->factor(own.gamma_);
    return 0;
  }

  static PetscErrorCode solve(PC direct, Vec right, Vec solution)
  {
    void* data = nullptr;
    PCShellGetContext(direct, &data);
    auto& own = *static_cast<Petsc*>(data);
    VecCopy(right, solution);
    write(solution,
          [&](auto values)
          {
            values *= own.gamma_;
            own.linear_->solve(values.data());
          });
    return 0;
  }

  DynamicRing ring_;
  std::unique_ptr<LinearSystem> linear_;
  Eigen::VectorXd rates_;
  Eigen::VectorXd state_;
  double gamma_{};
  long steps_{};
  long evaluations_{};
  long factorisations_{};
  Vec y_{};
  Vec between_{};
  Vec weights_{};
  Mat matrix_{};
  TS stepper_{};
};
}  // namespace

std::vector<Contender> petscContenders(const Problem& problem)
{
  const Choice choices[] = { { "PETSc bdf 2, KLU", TSBDF, "", 2 },
                             { "PETSc rosw ra34pw2, KLU", TSROSW, TSROSWRA34PW2, 0 },
                             { "PETSc arkimex 3, KLU", TSARKIMEX, TSARKIMEX3, 0 } };
  std::vector<Contender> contenders;
  for (const Choice& choice : choices)
  {
    for (const double tolerance : { 1e0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5 })
    {
      contenders.push_back({ choice.name, "tol = " + text("%.0e", tolerance),
                             [=, &problem](double limit)
                             {
                               Petsc integrator(choice, tolerance, problem);
                               return follow(problem, integrator, limit);
                             } });
    }
  }
  return contenders;
}
}  // namespace hjt
