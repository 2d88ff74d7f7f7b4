#include <common/parallel/reductions.h>
#include <common/algorithms/coulomb_solver.h>
#include <common/algorithms/mixed_fixed_point.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Friction
{
  template <int dim>
  double
  force_of_rounding(const DiscreteProblem<dim> &problem, const VectorType &u)
  {
    double largest = 0;
    for (unsigned int i = 0; i < problem.matrix.n_rows(); ++i)
      if (problem.matrix.row_begin(i) < problem.matrix.row_end(i))
        largest = std::max(
          largest,
          trace<dim>(problem.matrix.block(problem.matrix.row_begin(i))) *
            std::sqrt(dot<dim>(u.begin() + dim * i, u.begin() + dim * i)));
    return 1e-8 * max_over_processes(largest, problem.communicator());
  }



  double
  SolverReport::rho_tau_as_printed() const
  {
    double logarithm = 0;
    for (const double change : outer_changes)
      logarithm += std::log(std::max(change, 1e-300));
    return outer_changes.empty() ? 0.
                                 : std::exp(logarithm / outer_changes.size());
  }



  double
  SolverReport::rho_tau_contraction() const
  {
    if (outer_changes.size() < 2 || outer_changes.front() == 0)
      return 0.;
    return std::pow(outer_changes.back() / outer_changes.front(),
                    1. / (outer_changes.size() - 1));
  }



  template <int dim>
  CoulombSolver<dim>::CoulombSolver(const LevelHierarchy<dim>  &hierarchy,
                                    const DiscreteProblem<dim> &problem,
                                    const SolverSettings       &settings)
    : problem(problem)
    , settings(settings)
    , iteration(hierarchy, problem, settings)
  {}



  template <int dim>
  SolverReport
  CoulombSolver<dim>::solve(VectorType     &u,
                            ContactState   &state,
                            const Progress &progress)
  {
    SolverReport     report;
    const PhaseCosts before = phase_costs();
    const bool       coulomb =
      problem.has_friction() && problem.friction_law == FrictionLaw::coulomb;

    if (coulomb && settings.algorithm == Algorithm::fixed_point)
      iterate_normal_forces(report, u, state, progress);
    else
      {
        const MultigridResult result =
          iteration.solve(u, state, coulomb, progress);
        report.converged        = result.converged;
        report.inner_converged  = result.converged;
        report.algebraic_error  = result.algebraic_error;
        report.outer_iterations = 1;
        report.cycles           = result.cycles;
        report.contraction      = result.contraction();
      }

    certify(report, u, state);
    if (!(report.certificate.largest() <= settings.certificate_tolerance))
      report.converged = false;
    report.costs         = phase_costs() - before;
    report.matrix_memory = problem.matrix.memory_consumption();
    report.solver_memory = iteration.memory_consumption();
    return report;
  }



  template <int dim>
  void
  CoulombSolver<dim>::certify(SolverReport       &report,
                              VectorType         &u,
                              const ContactState &state) const
  {
    iteration.leading_smoother().ghosts().update(u.begin(), dim);
    const bool coulomb =
      problem.has_friction() && problem.friction_law == FrictionLaw::coulomb;
    report.residual.reinit(u);
    problem.matrix.residual(
      report.residual.begin(), problem.forces.begin(), u.begin());
    report.energy =
      TrescaFunctional<dim>(problem).energy(u, report.residual, state);
    report.certificate = make_certificate<dim>(u,
                                               report.residual,
                                               problem.constraints,
                                               problem.contact,
                                               state,
                                               problem.effective_coefficient(),
                                               coulomb,
                                               force_of_rounding(problem, u));
  }



  // Algorithm 2. The normal forces are those of nodes in contact, and zero
  // elsewhere: rounding errors left at open nodes would count as friction
  // there, make the nodes stick, and truncate them.
  template <int dim>
  void
  CoulombSolver<dim>::iterate_normal_forces(SolverReport   &report,
                                            VectorType     &u,
                                            ContactState   &state,
                                            const Progress &progress)
  {
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
          iteration.solve(u, state, false, progress);
        report.cycles.insert(
          report.cycles.end(), result.cycles.begin(), result.cycles.end());
        if (report.outer_iterations++ == 0)
          report.contraction = result.contraction();
        report.inner_converged = result.converged;
        report.algebraic_error = result.algebraic_error;
        if (!result.converged)
          return;

        iteration.update_normal_forces(state, u);
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



  template double force_of_rounding(const DiscreteProblem<2> &,
                                    const VectorType &);
  template double force_of_rounding(const DiscreteProblem<3> &,
                                    const VectorType &);

  template class CoulombSolver<2>;
  template class CoulombSolver<3>;
} // namespace Friction
