#include <common/algorithms/newton_solver.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Linear problems are solved by two digits at least; with less than that
    // phases are told wrongly.
    constexpr double largest_forcing = 1e-2;

    // What is short for a step, and how many such steps lead nowhere, in a row
    // and altogether: where phases go round, short steps alternate with others.
    constexpr double       shortest         = 1. / 64;
    constexpr unsigned int most_short_steps = 3, most_short_in_all = 12,
                           most_steps = 60;

    // What is left of the largest violation may be rounding.
    constexpr double rounding_of_violations = 1e-12;
  } // namespace



  template <int dim>
  NewtonSolver<dim>::NewtonSolver(const TrescaFunctional<dim> &functional,
                                  NewtonStep<dim>             &linear_solver)
    : functional(functional)
    , problem(functional.discrete_problem())
    , linear_solver(linear_solver)
    , equations(problem)
    , laws(problem.contact.size())
    , residual(problem.constraints.partitioner())
    , image(residual)
  {}



  template <int dim>
  double
  NewtonSolver<dim>::violation(const VectorType &r) const
  {
    const NodalConstraints<dim> &constraints = problem.constraints;
    VectorType                   wrong(r);
    for (unsigned int i = 0; i < constraints.n_owned_nodes(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        if (constraints.is_prescribed(i, d) || constraints.is_hanging(i))
          wrong.local_element(dim * i + d) = 0.;
    for (unsigned int p = 0; p < laws.size(); ++p)
      for (unsigned int d = 0; d < dim; ++d)
        wrong.local_element(dim * problem.contact[p].node + d) =
          laws[p].violation[d];
    return std::sqrt(
      sum_over_processes(dot_owned(wrong, wrong), problem.communicator()));
  }



  template <int dim>
  bool
  NewtonSolver<dim>::same_phases(
    const std::vector<SemismoothLaw<dim>> &others) const
  {
    bool change = false;
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        change = change || laws[p].in_contact != others[p].in_contact ||
          laws[p].tangent != others[p].tangent;
        // Where there are but two directions to slip in, they are phases.
        if (problem.contact[p].n_free_tangents == 1)
          change = change || laws[p].direction[0] * others[p].direction[0] < 0;
      }
    return !true_on_any_process(change, problem.communicator());
  }



  template <int dim>
  void
  NewtonSolver<dim>::set_state(ContactState &state, const VectorType &r) const
  {
    using Tangent = typename SemismoothLaw<dim>::Tangent;
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim> &node = problem.contact[p];
        state.set(p, laws[p].in_contact, laws[p].tangent == Tangent::sticks);
        if (problem.has_coulomb_friction(node))
          state.set_normal_force(
            p,
            laws[p].in_contact ? std::max(0., normal_component(node, r)) : 0.);
      }
  }



  template <int dim>
  MultigridResult
  NewtonSolver<dim>::solve(VectorType            &u,
                           ContactState          &state,
                           const MultigridLimits &limits,
                           const Progress        &progress)
  {
    const MPI_Comm            comm      = problem.communicator();
    const std::vector<double> stiffness = stiffnesses_of_zone(problem, state);
    std::vector<double>       given(state.size());
    for (unsigned int p = 0; p < given.size(); ++p)
      given[p] = state.normal_force(p);

    problem.stiffness.residual(residual, problem.forces, u);
    for (unsigned int p = 0; p < laws.size(); ++p)
      laws[p] = linearize_law_of_guess(problem, p, state, u, residual);

    MultigridResult result;
    VectorType      rhs(residual), step(residual), unknown(residual),
      start(residual), start_residual(residual);
    double       forcing = largest_forcing, before = 0., largest = 0.;
    unsigned int n_short = 0, n_short_in_all = 0;
    for (steps = 0; steps < most_steps && n_short < most_short_steps &&
         n_short_in_all < most_short_in_all;)
      {
        equations.update(laws);
        linear_solver.update(equations);
        equations.eliminate_known(laws, residual, step, rhs);
        unsigned int most = limits.maximum_cycles -
          static_cast<unsigned int>(result.cycles.size());
        if (limits.budget)
          most = std::min(most, limits.budget->cycles_left());
        typename NewtonStep<dim>::Outcome linear;
        if (limits.iterations_per_problem > 0)
          most = std::min(most, limits.iterations_per_problem);
        if (sum_over_processes(dot_owned(rhs, rhs), comm) > 0.)
          {
            linear = linear_solver.solve(unknown, rhs, forcing, most);
            add_owned(step, 1., unknown);
          }

        // Halve the step until the law is violated less. A guess violates it in
        // ways that mean nothing.
        problem.stiffness.vmult(image, step);
        const std::vector<SemismoothLaw<dim>> old_laws = laws;
        start                                          = u;
        start_residual                                 = residual;
        double length = 1., wrong = 0.;
        while (true)
          {
            u        = start;
            residual = start_residual;
            add_owned(u, length, step);
            add_owned(residual, -length, image);
            for (unsigned int p = 0; p < laws.size(); ++p)
              laws[p] = linearize_law(problem,
                                      problem.contact[p],
                                      {stiffness[p], given[p]},
                                      u,
                                      residual);
            wrong   = violation(residual);
            largest = std::max(largest, wrong);
            if (steps == 0 || wrong <= (1 - 1e-4 * length) * before ||
                wrong <= rounding_of_violations * largest ||
                length <= shortest || !std::isfinite(wrong))
              break;
            length /= 2;
          }
        ++steps;
        n_short = length <= shortest ? n_short + 1 : 0;
        n_short_in_all += length <= shortest;
        problem.stiffness.residual(residual, problem.forces, u);
        set_state(state, residual);

        const auto sums = sum_over_processes(
          std::array<double, 4>{
            {dot_owned(step, image),
             dot_owned(u, problem.forces) - dot_owned(u, residual),
             functional.energy_share(u, residual, state),
             1. * equations.truncation().n_truncated_components()}},
          comm);
        const double norm =
          std::sqrt(std::max(sums[1], smallest_squared_norm(problem, u)));
        const double increment =
          length * std::sqrt(std::max(0., sums[0])) / norm;
        for (unsigned int i = 0; i < std::max(1u, linear.iterations); ++i)
          {
            result.cycles.push_back(
              {increment, sums[2], length, sums[3], wrong});
            if (limits.budget)
              limits.budget->take_cycle();
            if (progress)
              progress(result.cycles.size(), increment);
          }
        if (!std::isfinite(increment) || !std::isfinite(wrong))
          break;

        // With the right phases a step is wrong by what is left of the linear
        // problem, and in three dimensions by its square.
        const double left =
          std::max(linear.accuracy, dim == 3 ? increment : 0.) * increment;
        const bool settled = length == 1. &&
          linear.accuracy <= largest_forcing && same_phases(old_laws);
        result.algebraic_error = norm * left;
        if (settled &&
            (left <= limits.inner_tolerance ||
             norm * left <= limits.energy_tolerance))
          {
            result.converged = true;
            break;
          }
        if (result.cycles.size() >= limits.maximum_cycles ||
            (limits.budget && limits.budget->is_spent()) ||
            (limits.iterations_per_problem > 0 &&
             (linear.accuracy > largest_forcing || length < .5)))
          break;
        const double ratio = before > 0 ? wrong / before : 1.;
        forcing            = std::min(largest_forcing, .9 * ratio * ratio);
        if (settled && left > 0)
          forcing = std::max(forcing, .5 * limits.inner_tolerance / left);
        forcing = std::min(largest_forcing, std::max(forcing, 1e-10));
        before  = wrong;
      }
    return result;
  }



  template <int dim>
  std::size_t
  NewtonSolver<dim>::memory_consumption() const
  {
    return linear_solver.memory_consumption() +
      2 * residual.memory_consumption() +
      laws.capacity() * sizeof(SemismoothLaw<dim>) +
      equations.slopes().capacity() * sizeof(NodeValue<dim>);
  }



  template <int dim>
  SolverReport
  solve_by_newton(NewtonSolver<dim>     &newton,
                  VectorType            &u,
                  ContactState          &state,
                  const CoulombSettings &limits,
                  const Progress        &progress)
  {
    const TrescaFunctional<dim> &functional = newton.tresca_functional();
    SolverReport                 report;
    report.set_result(newton.solve(u, state, limits.limits, progress));
    report.pace = 0.;
    certify(report, functional, u, state);
    if (!(report.certificate.largest() <= limits.certificate_tolerance))
      report.converged = false;
    report.solver_memory = newton.memory_consumption();
    return report;
  }



  template class NewtonSolver<2>;
  template class NewtonSolver<3>;

  template SolverReport solve_by_newton(NewtonSolver<2> &,
                                        VectorType &,
                                        ContactState &,
                                        const CoulombSettings &,
                                        const Progress &);
  template SolverReport solve_by_newton(NewtonSolver<3> &,
                                        VectorType &,
                                        ContactState &,
                                        const CoulombSettings &,
                                        const Progress &);
} // namespace Friction
