#include <common/algorithms/newton_solver.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/vector_memory.h>

#include <algorithm>
#include <array>
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



    // Linear problems are solved by two digits at least; with less than that
    // phases are told wrongly.
    constexpr double largest_forcing = 1e-2;

    // What is short for a step, and how many such steps in a row lead nowhere.
    constexpr double       shortest         = 1. / 64;
    constexpr unsigned int most_short_steps = 3, most_steps = 60;

    // What is left of the largest violation may be rounding.
    constexpr double rounding_of_violations = 1e-12;

    // Vectors that GMRES keeps before it starts anew.
    constexpr unsigned int basis_size = 50;



    void
    copy_owned(VectorType &to, const VectorType &from)
    {
      std::copy_n(from.begin(), from.locally_owned_size(), to.begin());
    }
  } // namespace



  template <int dim>
  NewtonSolver<dim>::NewtonSolver(const TrescaFunctional<dim> &functional,
                                  const MonotoneSmoother<dim> &smoother,
                                  Levels<dim>                 &levels,
                                  TruncatedCorrection<dim>    &correction,
                                  const unsigned int           smoothing_steps)
    : functional(functional)
    , problem(functional.discrete_problem())
    , levels(levels)
    , correction(correction)
    , smoothing_steps(smoothing_steps)
    , truncation(problem)
    , relaxation(problem, smoother)
    , strip(problem)
    , laws(problem.contact.size())
    , slopes(problem.contact.size())
    , residual(problem.constraints.partitioner())
    , image(residual)
    , defect(residual)
    , smoothed(residual)
    , correction_part(residual)
  {}



  template <int dim>
  void
  NewtonSolver<dim>::follow_phases()
  {
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const SemismoothLaw<dim> &law     = laws[p];
        const ContactNode<dim>   &node    = problem.contact[p];
        NodeBlock<dim>            turning = zero_block<dim>();
        slopes[p]                         = {};
        if (law.tangent == SemismoothLaw<dim>::Tangent::slides)
          for (unsigned int s = 0; s < node.n_free_tangents; ++s)
            {
              for (unsigned int d = 0; d < dim; ++d)
                slopes[p][d] += law.slope[s] * node.frame[s + 1][d];
              for (unsigned int t = 0; t < node.n_free_tangents; ++t)
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int r = 0; r < dim; ++r)
                    turning[c * dim + r] += law.curvature[t * (dim - 1) + s] *
                      node.frame[s + 1][r] * node.frame[t + 1][c];
            }
        truncation.set(p,
                       truncation.projector(
                         p,
                         !law.in_contact,
                         law.tangent != SemismoothLaw<dim>::Tangent::sticks),
                       turning);
      }
    truncation.exchange();
    levels.update(truncation.truncation());
    relaxation.update(truncation.truncation(), slopes);
    strip.update(truncation.truncation(), slopes, n_layers);
  }



  template <int dim>
  void
  NewtonSolver<dim>::apply_laws(VectorType &Av, const VectorType &v) const
  {
    for (unsigned int p = 0; p < laws.size(); ++p)
      if (laws[p].tangent == SemismoothLaw<dim>::Tangent::slides)
        {
          const ContactNode<dim> &node   = problem.contact[p];
          const double            normal = normal_component(node, Av);
          const NodeValue<dim>    turning =
            times<dim>(truncation.truncation().curvature(node.node).data(),
                       v.begin() + dim * node.node);
          for (unsigned int d = 0; d < dim; ++d)
            Av.local_element(dim * node.node + d) +=
              turning[d] - slopes[p][d] * normal;
        }
    truncation.truncation().apply(Av.begin());
  }



  template <int dim>
  void
  NewtonSolver<dim>::find_defect(const VectorType &r, const VectorType &v)
  {
    problem.stiffness.vmult(defect, v);
    apply_laws(defect, v);
    scale_owned(defect, -1.);
    add_owned(defect, 1., r);
  }



  template <int dim>
  void
  NewtonSolver<dim>::precondition(VectorType &v, const VectorType &r)
  {
    smoothed = 0.;
    relaxation.run(smoothed, r, {smoothing_steps, false}, &defect);
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
    relaxation.run(smoothed, r, {smoothing_steps, true});
    v = smoothed;
  }



  template <int dim>
  typename NewtonSolver<dim>::LinearSolution
  NewtonSolver<dim>::solve_linear(VectorType        &v,
                                  const VectorType  &rhs,
                                  const double       tolerance,
                                  const unsigned int maximum_iterations)
  {
    // Ghosts are our own business.
    const IndexSet &owned =
      problem.constraints.partitioner()->locally_owned_range();
    VectorType b(owned, problem.communicator()), x(b);
    copy_owned(b, rhs);

    VectorType     argument(residual), result_of(residual);
    const Operator matrix = {[&](VectorType &result, const VectorType &of) {
      copy_owned(argument, of);
      problem.stiffness.vmult(result_of, argument);
      apply_laws(result_of, argument);
      copy_owned(result, result_of);
    }};
    const Operator preconditioner = {
      [&](VectorType &result, const VectorType &of) {
        copy_owned(argument, of);
        precondition(result_of, argument);
        copy_owned(result, result_of);
      }};

    LinearSolution result;
    SolverControl  control(maximum_iterations, tolerance, false, false);
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
        result.converged = false;
      }
    memory.release_unused_memory();
    copy_owned(v, x);
    result.iterations = control.last_step();
    return result;
  }



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
  void
  NewtonSolver<dim>::eliminate_known(VectorType &step, VectorType &rhs)
  {
    step = 0.;
    rhs  = residual;
    for (unsigned int p = 0; p < laws.size(); ++p)
      {
        const ContactNode<dim>   &node = problem.contact[p];
        const SemismoothLaw<dim> &law  = laws[p];
        const unsigned int        dof  = dim * node.node;
        const bool slides = law.tangent == SemismoothLaw<dim>::Tangent::slides;
        const double normal = normal_component(node, residual);
        for (unsigned int d = 0; d < dim; ++d)
          {
            double known = 0, value = normal * node.normal()[d];
            for (unsigned int e = 0; e < dim; ++e)
              known += law.known_step[e] * node.frame[e][d];
            for (unsigned int t = 0; t < node.n_free_tangents; ++t)
              value += law.rhs[t] * node.frame[t + 1][d];
            step.local_element(dof + d) = known;
            if (slides)
              rhs.local_element(dof + d) = value;
          }
      }
    truncation.truncation().apply(rhs.begin());
    problem.stiffness.vmult(image, step);
    apply_laws(image, step);
    add_owned(rhs, -1., image);
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
    unsigned int n_short = 0;
    for (steps = 0; steps < most_steps && n_short < most_short_steps;)
      {
        follow_phases();
        eliminate_known(step, rhs);
        const double size =
          std::sqrt(sum_over_processes(dot_owned(rhs, rhs), comm));
        unsigned int most = limits.maximum_cycles -
          static_cast<unsigned int>(result.cycles.size());
        if (limits.budget)
          most = std::min(most, limits.budget->cycles_left());
        LinearSolution linear;
        if (size > 0)
          {
            linear = solve_linear(unknown, rhs, forcing * size, most);
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
        problem.stiffness.residual(residual, problem.forces, u);
        set_state(state, residual);

        const auto sums = sum_over_processes(
          std::array<double, 4>{
            {dot_owned(step, image),
             dot_owned(u, problem.forces) - dot_owned(u, residual),
             functional.energy_share(u, residual, state),
             1. * truncation.truncation().n_truncated_components()}},
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
          std::max(forcing, dim == 3 ? increment : 0.) * increment;
        const bool settled =
          length == 1. && linear.converged && same_phases(old_laws);
        result.algebraic_error = norm * left;
        if (settled &&
            (left <= limits.inner_tolerance ||
             norm * left <= limits.energy_tolerance))
          {
            result.converged = true;
            break;
          }
        if (result.cycles.size() >= limits.maximum_cycles ||
            (limits.budget && limits.budget->is_spent()))
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
    std::size_t bytes = correction.memory_consumption() +
      relaxation.memory_consumption() + strip.memory_consumption();
    for (const VectorType *vector :
         {&residual, &image, &defect, &smoothed, &correction_part})
      bytes += vector->memory_consumption();
    return bytes + laws.capacity() * sizeof(SemismoothLaw<dim>) +
      slopes.capacity() * sizeof(NodeValue<dim>);
  }



  template class NewtonSolver<2>;
  template class NewtonSolver<3>;
} // namespace Friction
