#include <common/algorithms/coulomb_solver.h>
#include <common/algorithms/mixed_fixed_point.h>
#include <common/contact/contact_forces.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Friction
{
  CoulombSettings::CoulombSettings(const SolverSettings &settings)
    : algorithm(settings.algorithm)
    , outer_tolerance(settings.outer_tolerance)
    , maximum_outer_iterations(settings.maximum_outer_iterations)
    , outer_damping(settings.outer_damping)
    , mixed_outer_iterations(settings.mixed_outer_iterations)
    , certificate_tolerance(settings.certificate_tolerance)
  {
    limits.inner_tolerance  = settings.inner_tolerance;
    limits.energy_tolerance = settings.energy_tolerance;
    limits.expected_pace    = settings.expected_pace;
    limits.maximum_cycles   = settings.maximum_cycles;
  }



  template <int dim>
  void
  certify(SolverReport                &report,
          const TrescaFunctional<dim> &functional,
          const VectorType            &u,
          const ContactState          &state)
  {
    const DiscreteProblem<dim> &problem = functional.discrete_problem();
    report.residual.reinit(u);
    problem.stiffness.residual(report.residual, problem.forces, u);
    report.energy      = functional.energy(u, report.residual, state);
    report.certificate = make_certificate(problem, u, report.residual, state);
  }



  template <int dim>
  CoulombSolver<dim>::CoulombSolver(MonotoneMultigrid<dim> &iteration,
                                    const CoulombSettings  &settings)
    : iteration(iteration)
    , settings(settings)
  {}



  template <int dim>
  SolverReport
  CoulombSolver<dim>::solve(VectorType     &u,
                            ContactState   &state,
                            const Progress &progress)
  {
    SolverReport                report;
    const DiscreteProblem<dim> &problem = iteration.problem();
    const bool                  coulomb = problem.has_coulomb_friction();
    const PhaseCosts            before  = phase_costs(problem.communicator());

    // The iterate's residual and step go before the report takes a vector.
    {
      Iterate x(u, state);
      if (coulomb && settings.algorithm == Algorithm::fixed_point)
        iterate_normal_forces(report, x, progress);
      else
        {
          x.updates_normal_forces = coulomb;
          const MultigridResult result =
            run_multigrid(iteration, x, settings.limits, progress);
          report.set_result(result);
        }
    }

    certify(report, iteration.functional(), u, state);
    if (!(report.certificate.largest() <= settings.certificate_tolerance))
      report.converged = false;
    report.costs         = phase_costs(problem.communicator()) - before;
    report.solver_memory = iteration.memory_consumption();
    return report;
  }



  // Algorithm 2. The normal forces are those of nodes in contact, and zero
  // elsewhere: rounding errors left at open nodes would count as friction
  // there, make the nodes stick, and truncate them.
  template <int dim>
  void
  CoulombSolver<dim>::iterate_normal_forces(SolverReport   &report,
                                            Iterate        &x,
                                            const Progress &progress)
  {
    const DiscreteProblem<dim> &problem = iteration.problem();
    ContactState               &state   = x.state;

    // Friction magnifies what is wrong with the normal forces.
    const double tolerance =
      settings.outer_tolerance / std::max(1., problem.effective_coefficient());
    MixedFixedPoint     fixed_point(settings.mixed_outer_iterations,
                                settings.outer_damping,
                                problem.communicator());
    std::vector<double> given(state.size()), found(state.size());
    while (report.outer_iterations < settings.maximum_outer_iterations)
      {
        for (unsigned int p = 0; p < state.size(); ++p)
          given[p] = state.normal_force(p);

        const MultigridResult result =
          run_multigrid(iteration, x, settings.limits, progress);
        report.cycles.insert(
          report.cycles.end(), result.cycles.begin(), result.cycles.end());
        if (report.outer_iterations++ == 0)
          report.contraction = report.pace = result.contraction();
        report.inner_converged = result.converged;
        report.algebraic_error = result.algebraic_error;
        if (!result.converged)
          return;

        set_normal_forces(problem.contact, x.residual, state);
        double change = 0, norm = 0;
        for (unsigned int p = 0; p < state.size(); ++p)
          {
            found[p] = state.normal_force(p);
            change += (found[p] - given[p]) * (found[p] - given[p]);
            norm += found[p] * found[p];
          }
        const auto sums = sum_over_processes(
          std::array<double, 2>{{change, norm}}, problem.communicator());
        report.outer_changes.push_back(
          sums[1] > 0 ? std::sqrt(sums[0] / sums[1]) : std::sqrt(sums[0]));
        if (report.outer_changes.back() <= tolerance)
          {
            report.converged = true;
            return;
          }
        const std::vector<double> next = fixed_point.next(given, found);
        for (unsigned int p = 0; p < state.size(); ++p)
          state.set_normal_force(p, next[p]);
      }
  }



  template void certify(SolverReport &,
                        const TrescaFunctional<2> &,
                        const VectorType &,
                        const ContactState &);
  template void certify(SolverReport &,
                        const TrescaFunctional<3> &,
                        const VectorType &,
                        const ContactState &);

  template class CoulombSolver<2>;
  template class CoulombSolver<3>;
} // namespace Friction
