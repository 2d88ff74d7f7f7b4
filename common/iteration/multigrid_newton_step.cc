#include <common/iteration/multigrid_newton_step.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/vector_memory.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace Friction
{
  namespace
  {
    // What GMRES asks of a matrix and of a preconditioner.
    struct Operator
    {
      std::function<void(VectorType &, const VectorType &)> apply;

      void
      vmult(VectorType &result, const VectorType &argument) const
      {
        apply(result, argument);
      }
    };



    // Vectors that GMRES keeps before it starts anew.
    constexpr unsigned int basis_size = 50;



    void
    copy_owned(VectorType &to, const VectorType &from)
    {
      std::copy_n(from.begin(), from.locally_owned_size(), to.begin());
    }
  } // namespace



  template <int dim>
  MultigridNewtonStep<dim>::MultigridNewtonStep(
    const DiscreteProblem<dim>  &problem,
    const MonotoneSmoother<dim> &smoother,
    Levels<dim>                 &levels,
    TruncatedCorrection<dim>    &correction,
    const unsigned int           smoothing_steps)
    : problem(problem)
    , levels(levels)
    , correction(correction)
    , smoothing_steps(smoothing_steps)
    , relaxation(problem, smoother)
    , strip(problem)
    , defect(problem.constraints.partitioner())
    , smoothed(defect)
    , correction_part(defect)
  {}



  template <int dim>
  void
  MultigridNewtonStep<dim>::update(const NewtonEquations<dim> &the_equations)
  {
    equations = &the_equations;
    levels.update(equations->truncation());
    relaxation.update(equations->truncation(), equations->slopes());
    strip.update(equations->truncation(),
                 equations->slopes(),
                 problem.effective_coefficient() > 1. ? n_layers : 0);
  }



  template <int dim>
  void
  MultigridNewtonStep<dim>::find_defect(const VectorType &r,
                                        const VectorType &v)
  {
    equations->vmult(defect, v);
    scale_owned(defect, -1.);
    add_owned(defect, 1., r);
  }



  template <int dim>
  void
  MultigridNewtonStep<dim>::precondition(VectorType &v, const VectorType &r)
  {
    smoothed = 0.;
    relaxation.run(smoothed, r, smoothing_steps, &defect);
    if (!strip.is_empty())
      {
        strip.add_solution(smoothed, defect);
        find_defect(r, smoothed);
      }
    correction.apply(correction_part, defect);
    add_owned(smoothed, 1., correction_part);
    if (!strip.is_empty())
      {
        find_defect(r, smoothed);
        strip.add_solution(smoothed, defect);
      }
    relaxation.run(smoothed, r, smoothing_steps);
    v = smoothed;
  }



  template <int dim>
  typename NewtonStep<dim>::Outcome
  MultigridNewtonStep<dim>::solve(VectorType        &v,
                                  const VectorType  &r,
                                  const double       accuracy,
                                  const unsigned int maximum_iterations)
  {
    // Ghosts are our own business.
    const MPI_Comm  comm = problem.communicator();
    const IndexSet &owned =
      problem.constraints.partitioner()->locally_owned_range();
    VectorType b(owned, comm), x(b);
    copy_owned(b, r);

    VectorType     argument(defect), result_of(defect);
    const Operator matrix = {[&](VectorType &result, const VectorType &of) {
      copy_owned(argument, of);
      equations->vmult(result_of, argument);
      copy_owned(result, result_of);
    }};
    const Operator preconditioner = {
      [&](VectorType &result, const VectorType &of) {
        copy_owned(argument, of);
        precondition(result_of, argument);
        copy_owned(result, result_of);
      }};

    typename NewtonStep<dim>::Outcome outcome;
    outcome.accuracy   = accuracy;
    const double  size = std::sqrt(sum_over_processes(dot_owned(r, r), comm));
    SolverControl control(maximum_iterations, accuracy * size, false, false);
    GrowingVectorMemory<VectorType> memory;
    try
      {
        SolverFGMRES<VectorType>(
          control, SolverFGMRES<VectorType>::AdditionalData(basis_size))
          .solve(matrix, x, b, preconditioner);
      }
    catch (const SolverControl::NoConvergence &)
      {
        // What there is of a step may do.
        outcome.accuracy = control.last_value() / size;
      }
    memory.release_unused_memory();
    copy_owned(v, x);
    outcome.iterations = control.last_step();
    return outcome;
  }



  template <int dim>
  std::size_t
  MultigridNewtonStep<dim>::memory_consumption() const
  {
    return correction.memory_consumption() + relaxation.memory_consumption() +
      strip.memory_consumption() + 3 * defect.memory_consumption();
  }



  template class MultigridNewtonStep<2>;
  template class MultigridNewtonStep<3>;
} // namespace Friction
