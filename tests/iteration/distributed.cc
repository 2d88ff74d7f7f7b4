// Several processes compute what one computes. Each process also solves the
// whole problem on its own, on the same mesh, with hanging nodes on the contact
// boundary, and the two are compared vertex by vertex:
//
// - contact nodes with normals, gaps and measures, and the rows of the
//   stiffness matrix;
// - the matrices of all levels, with random projectors and second derivatives
//   at contact nodes, after a fresh assembly and after updates; updates must
//   agree with fresh assemblies to the last bit on several processes, too;
// - the solution, with the same phases, certificate and energy.
//
// Sweeps and cycles are not the same, since each process relaxes its own nodes
// while the others relax theirs. What they have to be instead: a cycle makes no
// error larger, a sweep keeps the iterate admissible and does not raise the
// energy for given normal forces, neither that of several processes nor that
// evaluated by one alone.

#include <common/algorithms/contact_solver.h>
#include <common/iteration/monotone_smoother.h>
#include <common/iteration/truncated_correction.h>
#include <common/levels/level_matrices.h>
#include <common/nodes/interface_damping.h>
#include <common/parallel/phase_costs.h>
#include <common/parallel/reductions.h>

#include <iostream>
#include <map>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>
#include <tests/support/truncated_values.h>

using namespace Tests;

namespace test_distributed
{
  template <std::size_t n>
  double
  largest_difference(const std::array<double, n> &a,
                     const std::array<double, n> &b)
  {
    double result = 0.;
    for (unsigned int i = 0; i < n; ++i)
      result = std::max(result, std::abs(a[i] - b[i]));
    return result;
  }



  template <int dim>
  using Key = std::array<long, dim>;

  template <int dim>
  Key<dim>
  key_of(const Point<dim> &point)
  {
    Key<dim> key;
    for (unsigned int d = 0; d < dim; ++d)
      key[d] = std::lround(point[d] * 1e8);
    return key;
  }



  // Random numbers that belong to a point, not to an order.
  template <int dim>
  Random
  random_at(const Point<dim> &point, const unsigned int salt)
  {
    unsigned int seed = salt;
    for (const long k : key_of(point))
      seed = seed * 1000003u + static_cast<unsigned int>(k);
    return Random(seed);
  }



  // A problem on a communicator; its mesh depends on the seed only.
  template <int dim>
  struct Problem
  {
    Problem(const Parameters  &parameters,
            const MPI_Comm     communicator,
            const unsigned int seed)
      : scene(parameters)
      , mesh(make_triangulation<dim>(communicator))
      , discretization(scene, *mesh)
    {
      scene.make_coarse_mesh(*mesh);
      for (unsigned int round = 0; round < (dim == 2 ? 4 : 3); ++round)
        {
          for (const auto &cell : mesh->active_cell_iterators())
            if (cell->is_locally_owned())
              {
                const bool at_bottom =
                  cell->center()[dim - 1] < .6 * cell->diameter();
                if (random_at(cell->center(), seed)
                      .chance(at_bottom ? .6 : (dim == 2 ? .3 : .4)))
                  cell->set_refine_flag();
              }
          mesh->execute_coarsening_and_refinement();
        }
      discretization.set_up();
      discretization.assemble(elasticity<dim>(scene.materials()));
      level_hierarchy = std::make_unique<LevelHierarchy<dim>>(
        discretization.dof_handler(),
        discretization.constraints(),
        discretization.stiffness().blocks());

      // Where nodes are: on the leaf mesh those that are known, on the levels
      // all there are.
      const auto &d = discretization;
      points.resize(d.constraints().n_nodes());
      for (const auto &cell : d.dof_handler().active_cell_iterators())
        if (!cell->is_artificial())
          for (const unsigned int v : cell->vertex_indices())
            {
              const unsigned int node =
                d.constraints().node_of_dof(cell->vertex_dof_index(v, 0));
              points[node] = cell->vertex(v);
            }
      for (unsigned int node = 0; node < d.constraints().n_owned_nodes();
           ++node)
        leaf_nodes[key_of(points[node])] = node;
      for (unsigned int k = 0; k < mesh->n_global_levels(); ++k)
        {
          std::vector<double> here;
          for (const auto &cell : d.dof_handler().mg_cell_iterators_on_level(k))
            if (cell->is_locally_owned_on_level())
              for (const unsigned int v : cell->vertex_indices())
                {
                  here.push_back(cell->mg_vertex_dof_index(k, v, 0) / dim);
                  for (unsigned int c = 0; c < dim; ++c)
                    here.push_back(cell->vertex(v)[c]);
                }
          level_points.emplace_back(d.dof_handler().n_dofs(k) / dim);
          for (const auto &list :
               Utilities::MPI::all_gather(communicator, here))
            for (auto entry = list.begin(); entry != list.end();)
              {
                Point<dim> &point =
                  level_points[k][static_cast<std::size_t>(*entry++)];
                for (unsigned int c = 0; c < dim; ++c)
                  point[c] = *entry++;
              }
          level_nodes.emplace_back();
          for (unsigned int node = 0; node < level_points[k].size(); ++node)
            level_nodes[k][key_of(level_points[k][node])] = node;
        }
    }

    // Projectors and second derivatives at contact nodes, ghosts included.
    Truncation<dim>
    truncation(const unsigned int seed, const double scale) const
    {
      Truncation<dim>   result(discretization.constraints());
      const auto       &constraints = discretization.constraints();
      std::vector<char> is_contact(constraints.n_nodes(), 0);
      VectorType        flags(constraints.partitioner());
      for (const ContactNode<dim> &p : discretization.contact())
        if (p.n_free_tangents == dim - 1)
          flags.local_element(dim * p.node) = 1.;
      VectorType where(constraints.partitioner());
      for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
        for (unsigned int d = 0; d < dim; ++d)
          where.local_element(dim * node + d) = points[node][d];
      flags.update_ghost_values();
      where.update_ghost_values();
      for (unsigned int node = 0; node < constraints.n_nodes(); ++node)
        if (flags.local_element(dim * node) > 0)
          {
            Point<dim> point;
            for (unsigned int d = 0; d < dim; ++d)
              point[d] = where.local_element(dim * node + d);
            Random random = random_at(point, seed);
            truncate_at_random<dim>(
              result, node, random.below(dim + 1), scale, random);
          }
      return result;
    }

    const LevelHierarchy<dim> &
    hierarchy() const
    {
      return *level_hierarchy;
    }

    const Scene<dim>                              scene;
    std::unique_ptr<Triangulation<dim>>           mesh;
    Discretization<dim>                           discretization;
    std::unique_ptr<LevelHierarchy<dim>>          level_hierarchy;
    std::vector<Point<dim>>                       points;
    std::map<Key<dim>, unsigned int>              leaf_nodes;
    std::vector<std::vector<Point<dim>>>          level_points;
    std::vector<std::map<Key<dim>, unsigned int>> level_nodes;
  };



  void
  report(const double value, const double bound, const std::string &what)
  {
    const double largest = max_over_processes(value, MPI_COMM_WORLD);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      check_below(largest, bound, what);
  }



  template <int dim>
  void
  compare_discretizations(const Problem<dim> &all, const Problem<dim> &alone)
  {
    const auto &d = all.discretization, &e = alone.discretization;
    const auto &constraints = d.constraints();

    const double n_contact =
      sum_over_processes(d.contact().size(), MPI_COMM_WORLD);
    report(std::abs(n_contact - e.contact().size()),
           0.,
           "the contact nodes are those of one process");
    std::map<Key<dim>, const ContactNode<dim> *> nodes;
    for (const ContactNode<dim> &p : e.contact())
      nodes[key_of(p.point)] = &p;
    double difference = 0;
    for (const ContactNode<dim> &p : d.contact())
      {
        const ContactNode<dim> &q = *nodes.at(key_of(p.point));
        difference                = std::max({difference,
                                              std::abs(p.gap - q.gap),
                                              std::abs(p.measure - q.measure) / q.measure,
                                              (p.normal() - q.normal()).norm()});
      }
    report(difference, 1e-13, "so are their normals, gaps and measures");

    // Ghost columns may be nodes of cells that are not known here; their
    // owners know where they are.
    VectorType where(constraints.partitioner());
    for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
      for (unsigned int c = 0; c < dim; ++c)
        where.local_element(dim * node + c) = all.points[node][c];
    where.update_ghost_values();
    difference     = 0;
    double missing = 0;
    for (unsigned int i = 0; i < d.stiffness().blocks().n_rows(); ++i)
      {
        const unsigned int row = alone.leaf_nodes.at(key_of(all.points[i]));
        missing +=
          std::abs(static_cast<double>(d.stiffness().blocks().row_end(i) -
                                       d.stiffness().blocks().row_begin(i)) -
                   (e.stiffness().blocks().row_end(row) -
                    e.stiffness().blocks().row_begin(row)));
        for (std::size_t k = d.stiffness().blocks().row_begin(i);
             k < d.stiffness().blocks().row_end(i);
             ++k)
          {
            const unsigned int j = d.stiffness().blocks().column(k);
            Point<dim>         point;
            for (unsigned int c = 0; c < dim; ++c)
              point[c] = where.local_element(dim * j + c);
            const std::size_t l = e.stiffness().blocks().find(
              row, alone.leaf_nodes.at(key_of(point)));
            if (l == e.stiffness().blocks().row_end(row))
              ++missing;
            else
              difference = std::max(
                difference,
                largest_difference(d.stiffness().blocks().value(i, k),
                                   e.stiffness().blocks().value(row, l)));
          }
      }
    report(missing, 0., "rows of the stiffness matrix have the same pattern");
    report(difference, 1e-13, "and the same values");

    VectorType v(d.constraints().partitioner()), Av(v);
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        v.local_element(dim * i + c) =
          random_at(all.points[i], 17 + c).operator()(-1., 1.);
    d.stiffness().vmult(Av, v);
    const double product =
      sum_over_processes(d.stiffness().energy_product(v), MPI_COMM_WORLD);
    report(std::abs(product / (v * Av) - 1.),
           1e-12,
           "half of the matrix is enough for an energy product");
  }



  template <int dim>
  double
  largest_difference(const LevelMatrices<dim> &all_matrices,
                     const Problem<dim>       &all,
                     const LevelMatrices<dim> &alone_matrices,
                     const Problem<dim>       &alone)
  {
    double difference = 0;
    for (unsigned int k = 0; k < all_matrices.n_levels(); ++k)
      {
        const auto &numbering = all.hierarchy().level(k).numbering();
        const auto &A = all_matrices.matrix(k), &B = alone_matrices.matrix(k);
        double      scale = 0;
        for (unsigned int i = 0; i < B.n_rows(); ++i)
          if (B.row_begin(i) < B.row_end(i))
            scale = std::max(scale, trace<dim>(B.diagonal(i)));
        const auto other = [&](const unsigned int node) {
          return alone.level_nodes[k].at(
            key_of(all.level_points[k][numbering.global(node)]));
        };
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          {
            const unsigned int row = other(i);
            if (A.row_end(i) - A.row_begin(i) !=
                B.row_end(row) - B.row_begin(row))
              return 1.;
            for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
              {
                const std::size_t f = B.find(row, other(A.column(e)));
                if (f == B.row_end(row))
                  return 1.;
                difference = std::max(
                  difference,
                  largest_difference(A.value(i, e), B.value(row, f)) / scale);
              }
          }
      }
    return difference;
  }



  template <int dim>
  void
  compare_level_matrices(const Problem<dim> &all,
                         const Problem<dim> &alone,
                         const unsigned int  seed)
  {
    const auto        &d = all.discretization, &e = alone.discretization;
    LevelMatrices<dim> matrices(
      d.stiffness().blocks(), all.hierarchy(), d.constraints()),
      alone_matrices(
        e.stiffness().blocks(), alone.hierarchy(), e.constraints());
    report(largest_difference(matrices, all, alone_matrices, alone),
           1e-13,
           "level matrices are those of one process");

    double difference = 0, from_fresh = 0;
    for (unsigned int step = 0; step < 3; ++step)
      {
        const Truncation<dim> truncation =
          all.truncation(seed + step, step == 0 ? 0. : 1.);
        matrices.update(truncation);
        alone_matrices.update(
          alone.truncation(seed + step, step == 0 ? 0. : 1.));
        difference = std::max(
          difference, largest_difference(matrices, all, alone_matrices, alone));

        LevelMatrices<dim> fresh(
          d.stiffness().blocks(), all.hierarchy(), d.constraints());
        fresh.update(truncation);
        for (unsigned int k = 0; k < matrices.n_levels(); ++k)
          {
            const NodeBlockMatrix<dim> &A = matrices.matrix(k),
                                       &B = fresh.matrix(k);
            for (unsigned int i = 0; i < A.n_rows(); ++i)
              for (std::size_t e = A.row_begin(i); e < A.row_end(i); ++e)
                from_fresh = std::max(
                  from_fresh, largest_difference(A.value(i, e), B.value(i, e)));
          }
      }
    report(difference, 1e-13, "also after updates with random truncations");
    report(from_fresh, 0., "which are fresh assemblies to the last bit");
  }



  template <int dim>
  void
  check_cycle(const Problem<dim> &all, const unsigned int seed)
  {
    const auto              &d = all.discretization;
    Levels<dim>              levels(d.dof_handler(), d.problem());
    TruncatedCorrection<dim> cycle(levels, Cycle::V, 2);
    const Truncation<dim>    truncation = all.truncation(seed, 1.);
    levels.update(truncation);

    const auto random_values = [&](const unsigned int salt) {
      VectorType v(d.constraints().partitioner());
      for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
        if (!d.constraints().is_fixed(i))
          {
            Random random = random_at(all.points[i], salt);
            for (unsigned int c = 0; c < dim; ++c)
              v.local_element(dim * i + c) = random(-1., 1.);
          }
      truncation.apply(v.begin());
      return v;
    };
    // Ghosts that are not up to date, or belong to the cycle before, make it
    // something else.
    VectorType r = random_values(seed + 1), s = random_values(seed + 2);
    VectorType Cr(r), Cs(s), difference(r);
    cycle.apply(Cr, r);
    cycle.apply(Cs, s);
    r += s;
    cycle.apply(difference, r);
    const double size = difference.linfty_norm();
    difference -= Cr;
    difference -= Cs;
    report(difference.linfty_norm() / size, 1e-12, "a coarse cycle is linear");

    // An error, the residual that belongs to it, and what cycles make of it.
    double growth = 0., least_gain = 1e300;
    for (const Cycle type : {Cycle::V, Cycle::W})
      {
        TruncatedCorrection<dim> cycles(levels, type, 2);
        VectorType               error = random_values(seed + 3);
        r                    = truncated_product(d, truncation, error);
        double size_of_error = error * r;
        for (unsigned int step = 0; step < 20; ++step)
          {
            cycles.apply(Cr, r);
            least_gain = std::min(least_gain, (Cr * r) / size_of_error);
            error -= Cr;
            r                 = truncated_product(d, truncation, error);
            const double next = error * r;
            growth            = std::max(growth, next / size_of_error);
            size_of_error     = next;
          }
      }
    report(growth, 1. + 1e-12, "it makes no error larger");
    report(least_gain >= 0. ? 0. : 1., 0., "and leads downhill");
  }



  // Sweeps from a random admissible start, with random normal forces that are
  // kept.
  template <int dim>
  void
  check_sweeps(const Problem<dim> &all,
               const Problem<dim> &alone,
               const unsigned int  seed)
  {
    const auto &d = all.discretization, &e = alone.discretization;
    const TrescaFunctional<dim> functional(d.problem()),
      alone_functional(e.problem());
    MonotoneSmoother<dim> smoother(d.problem());

    VectorType u = admissible_start(d);
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      {
        Random random = random_at(all.points[i], seed);
        for (unsigned int c = 0; c < dim; ++c)
          if (!d.constraints().is_prescribed(i, c) &&
              !d.constraints().is_hanging(i))
            u.local_element(dim * i + c) = random(-.01, .01);
      }
    ContactState state(d.contact().size(), true),
      alone_state(e.contact().size(), true);
    const auto bound_at = [&](const ContactNode<dim> &p) {
      Random random = random_at(p.point, seed + 1);
      return random.chance(.2) ? 0. : random(0., .01);
    };
    for (unsigned int p = 0; p < d.contact().size(); ++p)
      {
        const ContactNode<dim> &node = d.contact()[p];
        move_out_of_obstacle(node, u);
        state.set_normal_force(p, bound_at(node));
      }
    for (unsigned int p = 0; p < e.contact().size(); ++p)
      alone_state.set_normal_force(p, bound_at(e.contact()[p]));

    // The displacement as one process knows it.
    const auto gathered = [&]() {
      std::vector<double> here;
      for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
        {
          for (unsigned int c = 0; c < dim; ++c)
            here.push_back(all.points[i][c]);
          for (unsigned int c = 0; c < dim; ++c)
            here.push_back(u.local_element(dim * i + c));
        }
      VectorType result(e.constraints().partitioner());
      for (const auto &list : Utilities::MPI::all_gather(MPI_COMM_WORLD, here))
        for (std::size_t k = 0; k < list.size(); k += 2 * dim)
          {
            Point<dim> point;
            for (unsigned int c = 0; c < dim; ++c)
              point[c] = list[k + c];
            const unsigned int node = alone.leaf_nodes.at(key_of(point));
            for (unsigned int c = 0; c < dim; ++c)
              result.local_element(dim * node + c) = list[k + dim + c];
          }
      return result;
    };

    // With many processes there must be nodes that need damping, or nothing is
    // tested.
    double n_damped = 0;
    for (unsigned int i = 0; i < d.stiffness().blocks().n_rows(); ++i)
      n_damped +=
        interface_damping(d.stiffness().blocks(), i) != zero_block<dim>();
    n_damped = sum_over_processes(n_damped, MPI_COMM_WORLD);
    if (dim == 3)
      report(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) >= 4 &&
                 n_damped == 0
               ? 1.
               : 0.,
             0.,
             "there are nodes that are damped, if there are many processes");

    double energy = functional.energy(u, state), rise = 0, disagreement = 0,
           penetration = functional.largest_penetration(u), fall = 0;
    for (unsigned int step = 0; step < 20; ++step)
      {
        sweep(smoother, u, state, false);
        const double next = functional.energy(u, state);
        disagreement      = std::max(
          disagreement,
          std::abs(next - alone_functional.energy(gathered(), alone_state)));
        rise        = std::max(rise, (next - energy) / std::abs(next));
        fall        = std::max(fall, energy - next);
        penetration = std::max(penetration, functional.largest_penetration(u));
        energy      = next;
      }
    report(rise, 1e-14, "no sweep raises the energy");
    report(fall > 0 ? 0. : 1., 0., "and the first ones lower it");
    report(disagreement / std::abs(energy),
           1e-12,
           "energies are those that one process finds");
    report(penetration, 1e-15, "iterates are admissible");

    // Several sweeps in a row are the same as one after the other, with one
    // exchange each, and so as many messages as there are in an exchange.
    VectorType   v(u);
    ContactState w(state);
    const auto   n_messages = [&]() {
      std::size_t sum = 0;
      for (const PhaseCost &cost : phase_costs(d.constraints().communicator()))
        sum += cost.messages;
      return sum;
    };
    const std::size_t before = n_messages();
    d.stiffness().update_ghosts(v);
    const std::size_t in_an_exchange = n_messages() - before;
    Iterate           x(v, w);
    smoother.relax(x, 8);
    report(n_messages() - before == 10 * in_an_exchange ? 0. : 1.,
           0.,
           "there is one exchange of ghosts per sweep, and one before them");
    for (unsigned int step = 0; step < 8; ++step)
      sweep(smoother, u, state, false);
    double difference = 0;
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      difference =
        std::max(difference, std::abs(u.local_element(i) - v.local_element(i)));
    report(difference, 0., "eight sweeps in a row are eight sweeps");
  }



  // The whole iteration with given normal forces, corrections included.
  template <int dim>
  void
  check_monotonicity(const Problem<dim> &all, const unsigned int seed)
  {
    const auto          &d       = all.discretization;
    DiscreteProblem<dim> problem = d.problem();
    problem.friction_law         = FrictionLaw::tresca;
    for (const auto correction :
         {CoarseCorrection::truncated, CoarseCorrection::monotone})
      {
        SolverSettings settings;
        settings.coarse_correction = correction;
        ContactSolver<dim> solver(
          d.dof_handler(), problem, without_safeguards(settings));
        VectorType   u = admissible_start(d);
        ContactState state(d.contact().size(), true);
        for (unsigned int p = 0; p < d.contact().size(); ++p)
          {
            Random random = random_at(d.contact()[p].point, seed + 1);
            state.set_normal_force(p, random(0., .01));
          }
        const SolverReport result = solver.solve(u, state);
        double             rise   = 0;
        for (unsigned int i = 1; i < result.cycles.size(); ++i)
          rise = std::max(
            rise, result.cycles[i].energy - result.cycles[i - 1].energy);
        const std::string name =
          correction == CoarseCorrection::truncated ? "truncated" : "monotone";
        report(rise / std::abs(result.energy),
               1e-13,
               "with given friction no cycle raises the energy, " + name);
      }
  }



  template <int dim>
  void
  check_solution(const Problem<dim> &all, const Problem<dim> &alone)
  {
    const auto &d = all.discretization, &e = alone.discretization;
    for (const auto correction :
         {CoarseCorrection::truncated, CoarseCorrection::monotone})
      {
        SolverSettings settings;
        settings.coarse_correction = correction;
        if (correction == CoarseCorrection::monotone)
          settings.cycle = Cycle::W;
        const auto solve = [&](const Discretization<dim> &disc,
                               ContactState              &state) {
          ContactSolver<dim> solver(disc, without_safeguards(settings));
          VectorType         u = admissible_start(disc);
          return solver.solve(u, state);
        };
        ContactState state(d.contact().size(), true),
          alone_state(e.contact().size(), true);
        const SolverReport found    = solve(d, state);
        const SolverReport expected = solve(e, alone_state);
        const std::string  name     = correction == CoarseCorrection::truncated
               ? "V truncated: "
               : "W monotone: ";
        report(found.converged && expected.converged ? 0. : 1.,
               0.,
               name + "converged with a certificate");
        report(std::abs(found.energy - expected.energy) /
                 std::abs(expected.energy),
               1e-10,
               name + "the energy is that of one process");
        std::map<Key<dim>, unsigned int> number;
        for (unsigned int p = 0; p < e.contact().size(); ++p)
          number[key_of(e.contact()[p].point)] = p;
        double n_different = 0;
        for (unsigned int p = 0; p < d.contact().size(); ++p)
          {
            const unsigned int q = number.at(key_of(d.contact()[p].point));
            n_different += state.in_contact(p) != alone_state.in_contact(q) ||
              (state.in_contact(p) && state.sticks(p) != alone_state.sticks(q));
          }
        report(n_different, 0., name + "so are all phases");
        // A process has but ten of the nodes of the smallest mesh.
        report(std::max(0.,
                        static_cast<double>(found.cycles.size()) -
                          static_cast<double>(expected.cycles.size())),
               3.,
               name + "at most three cycles more");
      }
  }



  template <int dim>
  void
  test(const Parameters &parameters, const unsigned int seed)
  {
    const Problem<dim> alone(parameters, MPI_COMM_SELF, seed);
    const Problem<dim> all(parameters, MPI_COMM_WORLD, seed);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        unsigned int n_hanging = 0;
        const auto  &e         = alone.discretization;
        for (unsigned int i = 0; i < e.constraints().n_nodes(); ++i)
          n_hanging += e.constraints().is_hanging(i);
        std::cout << dim << "D, " << alone.hierarchy().n_levels() << " levels, "
                  << e.constraints().n_nodes() << " nodes, " << n_hanging
                  << " hang, " << e.contact().size() << " may touch"
                  << std::endl;
      }
    compare_discretizations(all, alone);
    compare_level_matrices(all, alone, seed);
    check_cycle(all, seed);
    check_sweeps(all, alone, seed);
    check_monotonicity(all, seed);
    check_solution(all, alone);
  }
} // namespace test_distributed

TEST(distributed)
{
  test<2>(block_parameters<2>(FrictionLaw::coulomb, .4), 1);
  test<2>(curved_parameters<2>(FrictionLaw::coulomb, .4), 2);
  test<3>(block_parameters<3>(FrictionLaw::coulomb, .4), 3);
  test<3>(curved_parameters<3>(FrictionLaw::coulomb, .4), 4);
}
