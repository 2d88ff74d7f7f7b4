#include <common/algorithms/condensed_solver.h>
#include <common/algorithms/newton_finish.h>
#include <common/algorithms/pivoting_solver.h>
#include <common/iteration/dense_correction.h>
#include <common/iteration/dense_newton_step.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Friction
{
  namespace
  {
    // Multiplications that take about as long as a multigrid cycle of an easy
    // material: so many per unknown, and as many as it takes to go through the
    // levels, however small they are.
    template <int dim>
    constexpr double per_unknown = (dim == 2 ? 700. : 5000.);

    constexpr double at_least = 3e5;

    // Newton's method, of which a step takes as long as a cycle, takes over
    // once phases have settled if Algorithm 3 would go on for more cycles than
    // this.
    constexpr unsigned int longest_dense_end = 4;

    // The certificate of a solution, as a part of the tolerance, with which
    // nothing remains to be done; and how often to correct rounding errors of
    // the factors.
    constexpr double       certain = 1e-3;
    constexpr unsigned int passes  = 3;



    bool
    is_alone(const MPI_Comm communicator)
    {
      return Utilities::MPI::n_mpi_processes(communicator) == 1;
    }



    // Unknowns up to which it is worth while to count multiplications. For each
    // of so many the factors have a kilobyte in two dimensions and twelve in
    // three, and as much on each of several processes.
    template <int dim>
    types::global_dof_index
    largest(const MPI_Comm communicator)
    {
      if (is_alone(communicator))
        return dim == 2 ? 600000 : 120000;
      return dim == 2 ? 60000 : 40000;
    }
  } // namespace



  // The contact problem that is left when all other nodes are condensed.
  template <int dim>
  struct CondensedSolver<dim>::Small
  {
    NodalConstraints<dim> constraints;
    LeafOperator<dim>     stiffness;
    VectorType            forces, u;
    ContactBoundary<dim>  contact;
    std::vector<double>   face_measures;
    DiscreteProblem<dim>  problem;

    Small(const std::vector<char>             &is_prescribed,
          const std::vector<double>           &values,
          NodeBlockMatrix<dim>               &&matrix,
          const std::vector<ContactNode<dim>> &nodes,
          const DiscreteProblem<dim>          &whole)
      : constraints(is_prescribed, values)
      , stiffness(std::move(matrix), constraints)
      , forces(constraints.partitioner())
      , u(constraints.partitioner())
      , contact(nodes, whole.contact)
      , face_measures(values.size() / dim, 0.)
      , problem{stiffness,
                forces,
                constraints,
                contact,
                face_measures,
                whole.friction_law,
                whole.friction_coefficient}
    {
      std::copy(values.begin(), values.end(), u.begin());
    }
  };



  // What solves it, by any method.
  template <int dim>
  struct CondensedSolver<dim>::SmallSolver
  {
    const TrescaFunctional<dim> energy;
    const MonotoneSmoother<dim> smoother;
    Linearization<dim>          linearization;
    DenseCorrection<dim>        correction;
    LineSearch<dim>             line_search;
    MonotoneMultigrid<dim>      iteration;
    DenseNewtonStep<dim>        newton_step;
    NewtonSolver<dim>           newton;
    const bool                  may_finish;

    SmallSolver(const DiscreteProblem<dim> &problem,
                const SolverSettings       &settings)
      : energy(problem)
      , smoother(problem, settings.local_solver)
      , linearization(problem, settings.truncation)
      , correction(problem)
      , line_search(energy, 1., 0)
      , iteration(energy,
                  smoother,
                  linearization,
                  correction,
                  line_search,
                  settings.smoothing_steps)
      , newton(energy, newton_step)
      , may_finish(settings.has_default_corrections())
    {}

    SolverReport
    solve(const By               method,
          VectorType            &u,
          ContactState          &state,
          const CoulombSettings &limits,
          const Progress        &progress)
    {
      Assert(dim == 2 || method != By::pivoting,
             ExcMessage("Pivoting is for two dimensions."));
      if constexpr (dim == 2)
        if (method == By::pivoting)
          return solve_by_pivoting(newton, u, state, limits, progress);
      if (method == By::newton_solver)
        return solve_by_newton(newton, u, state, limits, progress);
      if (!may_finish)
        return CoulombSolver<dim>(iteration, limits).solve(u, state, progress);
      return NewtonFinish<dim>(
               iteration,
               [this]() -> NewtonSolver<dim> & { return newton; },
               longest_dense_end)
        .solve(u, state, limits, progress);
    }

    std::size_t
    memory_consumption() const
    {
      return smoother.memory_consumption() + correction.memory_consumption() +
        newton.memory_consumption();
    }
  };



  template <int dim>
  CondensedSolver<dim>::CondensedSolver(
    const DiscreteProblem<dim>    &problem,
    const std::vector<Point<dim>> &own_positions,
    const SolverSettings          &settings,
    const Iterate                 &guess)
    : problem(problem)
    , settings(settings)
    , matrix(&problem.stiffness.blocks())
  {
    if (problem.constraints.partitioner()->size() >
        largest<dim>(problem.communicator()))
      return;
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    gather_nodes(own_positions);
    if (!is_alone(problem.communicator()))
      gather_matrix();
    is_absent.resize(matrix->n_rows());
    for (unsigned int i = 0; i < is_absent.size(); ++i)
      is_absent[i] = (matrix->is_empty(i) ||
                      std::all_of(is_held.begin() + dim * i,
                                  is_held.begin() + dim * (i + 1),
                                  [](const char held) { return held; }));
    zone = std::make_unique<ContactZone<dim>>(problem, matrix->sparsity());
    zone->grow(guess.u, guess.state);
    keep_zone();
  }



  template <int dim>
  CondensedSolver<dim>::~CondensedSolver() = default;



  template <int dim>
  void
  CondensedSolver<dim>::gather_nodes(
    const std::vector<Point<dim>> &own_positions)
  {
    const MPI_Comm               comm        = problem.communicator();
    const NodalConstraints<dim> &constraints = problem.constraints;
    const unsigned int           n           = constraints.n_owned_nodes();
    Places                       places(n);
    std::vector<char>            held(dim * n);
    for (unsigned int i = 0; i < n; ++i)
      {
        places[i] = place_of(own_positions[i]);
        for (unsigned int d = 0; d < dim; ++d)
          held[dim * i + d] = constraints.is_prescribed(i, d);
      }
    positions = gather_from_all(places, comm);
    is_held   = gather_from_all(held, comm);
  }



  template <int dim>
  void
  CondensedSolver<dim>::gather_matrix()
  {
    const MPI_Comm              comm  = problem.communicator();
    const NodeBlockMatrix<dim> &own   = problem.stiffness.blocks();
    const NodeNumbering        &nodes = problem.constraints.numbering();
    std::vector<unsigned int>   lengths, columns;
    std::vector<double>         values;
    for (unsigned int i = 0; i < own.n_rows(); ++i)
      {
        lengths.push_back(own.row_end(i) - own.row_begin(i));
        for (std::size_t e = own.row_begin(i); e < own.row_end(i); ++e)
          {
            columns.push_back(nodes.global(own.column(e)));
            const NodeBlock<dim> block = own.value(i, e);
            values.insert(values.end(), block.begin(), block.end());
          }
      }
    lengths = gather_from_all(lengths, comm);
    columns = gather_from_all(columns, comm);
    values  = gather_from_all(values, comm);

    auto                      pattern = std::make_shared<NodePattern>();
    std::vector<unsigned int> row;
    std::size_t               first = 0;
    for (const unsigned int length : lengths)
      {
        row.assign(columns.begin() + first, columns.begin() + first + length);
        pattern->append_row(row);
        first += length;
      }
    gathered       = NodeBlockMatrix<dim>(pattern);
    std::size_t at = 0;
    for (unsigned int i = 0; i < lengths.size(); ++i)
      for (unsigned int k = 0; k < lengths[i]; ++k, ++at)
        {
          NodeBlock<dim> block;
          std::copy_n(
            values.begin() + dim * dim * at, dim * dim, block.begin());
          gathered.set(i, gathered.find(i, columns[at]), block);
        }
    matrix = &gathered;
  }



  // Nothing is left if that is not worth while. It never will be, since zones
  // only grow.
  template <int dim>
  void
  CondensedSolver<dim>::keep_zone()
  {
    condensation.reset();
    tree = std::make_unique<EliminationTree>(
      matrix->sparsity(), positions, zone->nodes(), is_absent);
    if (!is_worthwhile(most_cycles))
      {
        tree.reset();
        zone.reset();
        gathered = NodeBlockMatrix<dim>();
      }
  }



  // Returns whether what touches had not been kept.
  template <int dim>
  bool
  CondensedSolver<dim>::grow_zone(const Iterate &x)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    if (!zone || !zone->grow(x.u, x.state))
      return false;
    keep_zone();
    return true;
  }



  // Nodes outside the zone may be what holds the body. Returns whether it has
  // not grown too large.
  template <int dim>
  bool
  CondensedSolver<dim>::factorize()
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    while (!has_given_up() && !condensation)
      {
        condensation = std::make_unique<Condensation<dim>>(*tree, is_held);
        if (true_on_any_process(!condensation->factorize(*matrix),
                                problem.communicator()))
          {
            has_failed = !zone->grow_to_all();
            keep_zone();
          }
      }
    return !has_given_up();
  }



  template <int dim>
  unsigned int
  CondensedSolver<dim>::n_unknowns() const
  {
    return tree ? dim * tree->fronts().back().nodes.size() : 0;
  }



  template <int dim>
  bool
  CondensedSolver<dim>::is_worthwhile(const double n_cycles) const
  {
    if (!tree || has_failed)
      return false;
    const double n = n_unknowns();
    // Some cycles of the condensed problem, sweeps and factors: these are
    // dense, and take a quarter of the time per multiplication.
    const double cycles = 3 * n * n * (10 + n / 6);
    return n > 0 &&
      tree->cost(dim) + cycles <=
      n_cycles * (at_least + per_unknown<dim> * dim * matrix->n_rows());
  }



  // In the frames of contact nodes nothing changes: these are numbered anew.
  template <int dim>
  std::unique_ptr<typename CondensedSolver<dim>::Small>
  CondensedSolver<dim>::make_small_problem(const VectorType &u) const
  {
    const MPI_Comm                   comm = problem.communicator();
    const std::vector<unsigned int> &kept = tree->fronts().back().nodes;
    const NodeNumbering &numbering        = problem.constraints.numbering();

    std::vector<ContactNode<dim>> nodes;
    std::vector<double>           own_values, own_measures;
    for (const ContactNode<dim> &p : problem.contact)
      if (zone->contains(p))
        {
          for (unsigned int d = 0; d < dim; ++d)
            own_values.push_back(u.local_element(dim * p.node + d));
          own_measures.push_back(problem.face_measures[p.node]);
          nodes.push_back(p);
          // In the zone all nodes are kept, in ascending order.
          nodes.back().node = std::lower_bound(kept.begin(),
                                               kept.end(),
                                               numbering.global(p.node)) -
            kept.begin();
        }
    nodes                              = gather_from_all(nodes, comm);
    const std::vector<double> at_nodes = gather_from_all(own_values, comm),
                              measures = gather_from_all(own_measures, comm);

    std::vector<char>   is_prescribed;
    std::vector<double> values(dim * kept.size());
    for (const unsigned int i : kept)
      is_prescribed.insert(is_prescribed.end(),
                           is_held.begin() + dim * i,
                           is_held.begin() + dim * (i + 1));
    for (unsigned int p = 0; p < nodes.size(); ++p)
      std::copy_n(
        at_nodes.begin() + dim * p, dim, values.begin() + dim * nodes[p].node);

    auto                      pattern = std::make_shared<NodePattern>();
    std::vector<unsigned int> row(kept.size());
    for (unsigned int i = 0; i < kept.size(); ++i)
      {
        for (unsigned int j = 0; j < kept.size(); ++j)
          row[j] = j;
        pattern->append_row(row);
      }
    pattern->template complete<dim>();
    NodeBlockMatrix<dim> S(pattern);
    for (unsigned int i = 0; i < kept.size(); ++i)
      for (std::size_t e = S.row_begin(i); e < S.stored_end(i); ++e)
        S.set(i, e, condensation->block(i, S.column(e)));

    auto small = std::make_unique<Small>(
      is_prescribed, values, std::move(S), nodes, problem);
    for (unsigned int p = 0; p < nodes.size(); ++p)
      small->face_measures[nodes[p].node] = measures[p];
    return small;
  }



  template <int dim>
  SolverReport
  CondensedSolver<dim>::solve(const TrescaFunctional<dim> &functional,
                              Iterate                      x,
                              const By                     method,
                              const CoulombSettings       &limits,
                              const Progress              &progress)
  {
    Assert(is_worthwhile(most_cycles),
           ExcMessage("Ask is_worthwhile() first."));
    const VectorType       start       = x.u;
    const ContactState     start_state = x.state;
    std::vector<CycleInfo> cycles;
    SolverReport           report;
    grow_zone(x);
    while (true)
      {
        // A body that the zone did not hold has run away.
        if (!cycles.empty())
          {
            x.u     = start;
            x.state = start_state;
          }
        if (!factorize())
          {
            report = SolverReport();
            break;
          }
        const bool by_newton = report.finished_by_newton;
        report = solve_in_zone(functional, x, method, limits, progress);
        report.finished_by_newton = report.finished_by_newton || by_newton;
        cycles.insert(cycles.end(), report.cycles.begin(), report.cycles.end());
        if (!grow_zone(x))
          break;
        report.converged = false;
        if (limits.limits.budget && limits.limits.budget->is_spent())
          break;
      }

    if (!report.converged)
      {
        for (const ContactNode<dim> &p : problem.contact)
          move_out_of_obstacle(p, x.u);
        certify(report, functional, x.u, x.state);
      }
    // Cycles over levels contract otherwise, and these are no outer iterations
    // of the whole body.
    report.pace = 0.;
    report.outer_changes.clear();
    report.cycles = cycles;
    return report;
  }



  template <int dim>
  SolverReport
  CondensedSolver<dim>::solve_in_zone(const TrescaFunctional<dim> &functional,
                                      Iterate                     &x,
                                      const By                     method,
                                      const CoulombSettings       &limits,
                                      const Progress              &progress)
  {
    const MPI_Comm                   comm  = problem.communicator();
    const std::unique_ptr<Small>     small = make_small_problem(x.u);
    const std::vector<unsigned int> &kept  = tree->fronts().back().nodes;
    ContactState                     state = gather_state(x.state);
    SolverReport                     report;

    const bool      is_first = Utilities::MPI::this_mpi_process(comm) == 0;
    const auto      solver   = is_first
             ? std::make_unique<SmallSolver>(small->problem, settings)
             : nullptr;
    CoulombSettings its_limits(limits);
    its_limits.certificate_tolerance = std::numeric_limits<double>::infinity();

    bool       has_converged = false;
    VectorType residual(x.u), image(small->u), start(small->u);
    for (unsigned int pass = 0; pass < passes; ++pass)
      {
        // A path does not know where it has come to, and may lead elsewhere.
        const By its_method =
          method == By::pivoting && pass > 0 ? By::newton_solver : method;
        // What is left over at all nodes, condensed: S (u_c - start) is to be
        // this and the contact forces.
        problem.stiffness.residual(residual, problem.forces, x.u);
        std::vector<double> values = gather_from_all(
          std::vector<double>(residual.begin(),
                              residual.begin() + residual.locally_owned_size()),
          comm);
        condensation->reduce(values);
        start = small->u;
        small->stiffness.vmult(image, start);
        for (unsigned int k = 0; k < kept.size(); ++k)
          for (unsigned int d = 0; d < dim; ++d)
            small->forces.local_element(dim * k + d) =
              image.local_element(dim * k + d) + values[dim * kept[k] + d];

        // One process solves for all of them, so that they cannot disagree, and
        // all pay for it.
        const std::vector<CycleInfo> earlier   = report.cycles;
        const bool                   by_newton = report.finished_by_newton;
        {
          const PhaseScope phase(comm, SolverPhase::coarsest);
          if (is_first)
            report =
              solver->solve(its_method, small->u, state, its_limits, progress);
          share(report, small->u, state);
        }
        for (unsigned int k = 0; !is_first && k < report.cycles.size(); ++k)
          if (limits.limits.budget)
            limits.limits.budget->take_cycle();

        for (unsigned int k = 0; k < kept.size(); ++k)
          for (unsigned int d = 0; d < dim; ++d)
            values[dim * kept[k] + d] = small->u.local_element(dim * k + d) -
              start.local_element(dim * k + d);
        condensation->expand(values);
        const unsigned int first = dim * first_own_node();
        for (unsigned int i = 0; i < x.u.locally_owned_size(); ++i)
          if (!is_absent[(first + i) / dim] && !is_held[first + i])
            x.u.local_element(i) += values[first + i];
        scatter_state(state, x.state);

        // The energy of the whole body is another one by that of what has been
        // eliminated.
        const double energy_on_contact_nodes = report.energy;
        certify(report, functional, x.u, x.state);
        for (CycleInfo &cycle : report.cycles)
          cycle.energy += report.energy - energy_on_contact_nodes;
        report.cycles.insert(
          report.cycles.begin(), earlier.begin(), earlier.end());
        report.finished_by_newton = report.finished_by_newton || by_newton;
        // What is in the obstacle outside the zone is no matter of passes.
        if (report.converged && zone->misses(x.u, x.state))
          return report;
        // What a later pass did not get to is there already.
        has_converged = (report.converged || has_converged) &&
          report.certificate.largest() <= limits.certificate_tolerance;
        if (!report.converged ||
            report.certificate.largest() <=
              certain * limits.certificate_tolerance)
          break;
      }
    report.converged     = has_converged;
    report.solver_memory = memory_consumption() +
      small->stiffness.memory_consumption() +
      (solver ? solver->memory_consumption() : 0);
    return report;
  }



  // Of the nodes in the zone, of all processes.
  template <int dim>
  ContactState
  CondensedSolver<dim>::gather_state(const ContactState &own) const
  {
    std::vector<char>   flags;
    std::vector<double> normal_forces;
    for (unsigned int p = 0; p < own.size(); ++p)
      if (zone->contains(problem.contact[p]))
        {
          flags.push_back(own.in_contact(p) + 2 * own.sticks(p));
          normal_forces.push_back(own.normal_force(p));
        }
    flags         = gather_from_all(flags, problem.communicator());
    normal_forces = gather_from_all(normal_forces, problem.communicator());
    ContactState result(flags.size(), own.has_friction());
    for (unsigned int p = 0; p < result.size(); ++p)
      {
        result.set(p, flags[p] & 1, flags[p] & 2);
        result.set_normal_force(p, normal_forces[p]);
      }
    return result;
  }



  // All others are free. Kept nodes are numbered process by process.
  template <int dim>
  void
  CondensedSolver<dim>::scatter_state(const ContactState &of_zone,
                                      ContactState       &own) const
  {
    const auto   begin = zone->nodes().begin();
    unsigned int q     = std::count(begin, begin + first_own_node(), 1);
    for (unsigned int p = 0; p < own.size(); ++p)
      {
        const bool is_kept = zone->contains(problem.contact[p]);
        own.set(
          p, is_kept && of_zone.in_contact(q), is_kept && of_zone.sticks(q));
        own.set_normal_force(p, is_kept ? of_zone.normal_force(q) : 0.);
        q += is_kept;
      }
  }



  template <int dim>
  unsigned int
  CondensedSolver<dim>::first_own_node() const
  {
    return problem.constraints.numbering().distribution().global(0);
  }



  // What the first process has found, on all of them.
  template <int dim>
  void
  CondensedSolver<dim>::share(SolverReport &report,
                              VectorType   &u,
                              ContactState &state) const
  {
    if (is_alone(problem.communicator()))
      return;
    std::vector<double> values = {double(report.converged),
                                  double(report.inner_converged),
                                  double(report.finished_by_newton),
                                  double(report.outer_iterations),
                                  report.contraction,
                                  report.algebraic_error,
                                  report.energy,
                                  double(report.cycles.size())};
    for (const CycleInfo &cycle : report.cycles)
      values.insert(values.end(),
                    {cycle.increment,
                     cycle.energy,
                     cycle.step_length,
                     cycle.truncated,
                     cycle.residual});
    values.insert(values.end(), u.begin(), u.end());
    for (unsigned int p = 0; p < state.size(); ++p)
      values.insert(values.end(),
                    {double(state.in_contact(p)),
                     double(state.sticks(p)),
                     state.normal_force(p)});
    values = Utilities::MPI::broadcast(problem.communicator(), values, 0);

    auto next                 = values.begin();
    report.converged          = *next++;
    report.inner_converged    = *next++;
    report.finished_by_newton = *next++;
    report.outer_iterations   = *next++;
    report.contraction        = *next++;
    report.algebraic_error    = *next++;
    report.energy             = *next++;
    report.cycles.resize(*next++);
    for (CycleInfo &cycle : report.cycles)
      for (double *value : {&cycle.increment,
                            &cycle.energy,
                            &cycle.step_length,
                            &cycle.truncated,
                            &cycle.residual})
        *value = *next++;
    std::copy_n(next, u.locally_owned_size(), u.begin());
    next += u.locally_owned_size();
    for (unsigned int p = 0; p < state.size(); ++p, next += 3)
      {
        state.set(p, next[0] != 0., next[1] != 0.);
        state.set_normal_force(p, next[2]);
      }
  }



  template <int dim>
  std::size_t
  CondensedSolver<dim>::memory_consumption() const
  {
    return gathered.memory_consumption() +
      (condensation ? condensation->memory_consumption() : 0);
  }



  template class CondensedSolver<2>;
  template class CondensedSolver<3>;
} // namespace Friction
