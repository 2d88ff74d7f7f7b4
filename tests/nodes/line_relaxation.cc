// Relaxation by lines, on the matrix of a block whose cells are ten times as
// long as wide, with a truncation picked at random:
//
// - on squares and cubes there are no lines; on stretched cells each line is a
//   column of vertices in the short direction, and they cover the mesh;
// - the sweep over a single line solves its problem: afterwards its residual
//   vanishes;
// - values and residual stay truncated, and the residual is that of
//   $T(A+\omega'')T$;
// - each sweep lowers the energy, on several processes as well;
// - components that are held keep their values, and the energy falls;
// - a line is cut where more than neighbours couple.

#include <common/nodes/line_relaxation.h>

#include <deal.II/grid/grid_generator.h>

#include <iostream>
#include <set>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/random.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>
#include <tests/support/truncated_values.h>

using namespace Tests;

namespace test_line_relaxation
{
  template <int dim>
  Parameters
  stretched_block(const unsigned int stretched_direction)
  {
    Parameters p       = block_parameters<dim>(FrictionLaw::none, 0.);
    p.scene.distortion = 0.;
    p.scene.size.assign(dim, 1.);
    p.scene.subdivisions.assign(dim, 2);
    if (stretched_direction < dim)
      p.scene.subdivisions[stretched_direction] = 20;
    return p;
  }



  // On all processes.
  unsigned int
  size_of(const NodeRanges &nodes)
  {
    unsigned int n = 0;
    for (const RowRange &range : nodes)
      n += range.second - range.first;
    return Utilities::MPI::sum(n, MPI_COMM_WORLD);
  }



  // Sticking and sliding nodes anywhere, some with a second derivative.
  template <int dim>
  Truncation<dim>
  random_truncation(const Discretization<dim> &d, Random &random)
  {
    Truncation<dim> truncation(d.constraints());
    for (unsigned int i = 0; i < d.constraints().n_owned_nodes(); ++i)
      if (d.constraints().is_free(i) && random.chance(.1))
        {
          NodeBlock<dim> projector = identity_block<dim>(),
                         curvature = zero_block<dim>();
          projector[0]             = 0.;
          if (random.chance(.5))
            projector = zero_block<dim>();
          else
            curvature[dim * dim - 1] = 3.;
          truncation.set(i, projector, curvature);
        }
    return truncation;
  }



  template <int dim>
  void
  test(const unsigned int direction)
  {
    const Scene<dim> scene(stretched_block<dim>(direction));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    Discretized<dim>            d(scene, *mesh);
    const NodeBlockMatrix<dim> &A = d.stiffness().blocks();
    const auto is_prescribed = [&](const unsigned int i, const unsigned int c) {
      return d.constraints().is_prescribed(i, c);
    };
    LineRelaxation<dim> relaxation(
      A, movable_nodes(d), is_prescribed, MPI_COMM_WORLD);
    const bool is_stretched = direction < dim;
    check_everywhere(relaxation.has_lines() == is_stretched,
                     is_stretched ? "there are lines" : "there are none");
    if (!is_stretched)
      return;

    const auto             points   = node_points(d);
    bool                   straight = true;
    std::set<unsigned int> covered;
    for (const std::vector<unsigned int> &line : relaxation.lines())
      for (unsigned int k = 0; k < line.size(); ++k)
        {
          covered.insert(line[k]);
          Tensor<1, dim> step = points[line[k]] - points[line[0]];
          step[direction]     = 0.;
          straight            = straight && step.norm() < 1e-12;
        }
    check_everywhere(straight, "they go in the short direction");
    const auto n_covered =
      Utilities::MPI::sum((unsigned int)covered.size(), MPI_COMM_WORLD);
    const unsigned int n_movable = size_of(movable_nodes(d));
    check_everywhere(n_covered > .7 * n_movable, "and cover the mesh");
    check_everywhere(n_covered +
                         size_of(relaxation.other_nodes(movable_nodes(d))) ==
                       n_movable,
                     "what is in no line are the other nodes");

    Random                random(3);
    const Truncation<dim> truncation = random_truncation(d, random);
    relaxation.factorise(&truncation);
    const auto random_vector = [&]() {
      return random_truncated(d, truncation, random);
    };
    // What the matrix is: T (A + w) x for truncated x.
    const auto apply = [&](const VectorType &x) {
      return truncated_product(d, truncation, x);
    };
    const VectorType b      = random_vector();
    const auto       energy = [&](const VectorType &x) {
      return .5 * (x * apply(x)) - b * x;
    };
    GhostExchange &ghosts = d.stiffness().ghosts();

    VectorType x = random_vector(), residual = d.vector();
    double     last  = energy(x);
    bool       falls = true, residual_is_right = true, stays = true;
    for (unsigned int sweep = 0; sweep < 6; ++sweep)
      {
        d.stiffness().update_ghosts(x);
        relaxation.run(1, b.begin(), x.begin(), ghosts, residual.begin());
        const double now      = energy(x);
        falls                 = falls && now < last;
        last                  = now;
        VectorType difference = apply(x);
        difference -= b;
        // Rows that are not relaxed have residuals, too.
        difference += residual;
        for (unsigned int i = 0; i < A.n_rows(); ++i)
          if (d.constraints().is_fixed(i))
            for (unsigned int c = 0; c < dim; ++c)
              difference.local_element(dim * i + c) = 0.;
        residual_is_right =
          residual_is_right && difference.linfty_norm() < 1e-12;
        difference = x;
        truncation.apply(difference.begin());
        difference -= x;
        stays = stays && difference.linfty_norm() < 1e-14;
      }
    check_everywhere(falls, "each sweep lowers the energy");
    check_everywhere(residual_is_right, "the residual is the truncated one");
    check_everywhere(stays, "values stay truncated");

    // The line that a sweep comes to last has no neighbours that
    // change after it; on one process.
    if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
      {
        const std::vector<unsigned int> relaxed_last =
          relaxation.lines().back();
        double left = 0;
        for (const unsigned int node : relaxed_last)
          for (unsigned int c = 0; c < dim; ++c)
            left =
              std::max(left, std::abs(residual.local_element(dim * node + c)));
        check_below(left / residual.linfty_norm(),
                    1e-10,
                    "what is left on the line relaxed last");
      }

    // Without truncation, but with components that are held: on levels.
    const auto is_held = [](const unsigned int i, const unsigned int c) {
      return i % 3 == c;
    };
    LineRelaxation<dim> holding(A, movable_nodes(d), is_held, MPI_COMM_WORLD);
    holding.factorise();
    const Truncation<dim> none(d.constraints());
    VectorType            y = random_vector();
    none.apply(y.begin());
    d.stiffness().update_ghosts(y);
    const VectorType start          = y;
    const auto       energy_without = [&](const VectorType &v) {
      VectorType Av = d.vector();
      d.stiffness().update_ghosts(v);
      A.vmult(Av.begin(), v.begin());
      return .5 * (v * Av) - b * v;
    };
    holding.run(3, b.begin(), y.begin(), ghosts);
    bool holds = true, moves = false;
    for (unsigned int i = 0; i < A.n_rows(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const double change =
            y.local_element(dim * i + c) - start.local_element(dim * i + c);
          if (is_held(i, c))
            holds = holds && change == 0.;
          else
            moves = moves || change != 0.;
        }
    check_everywhere(holds && moves, "held components keep their values");
    check_everywhere(energy_without(y) < energy_without(start),
                     "and the energy falls");
  }



  // A ring of strongly coupled nodes, for which a matrix is made by hand, with
  // chords in some places as a bend has them: the lines are pieces of it,
  // inside of which nothing couples but neighbours, so that a sweep over one
  // line solves its problem. On one process.
  void
  test_ring()
  {
    constexpr unsigned int n = 40;
    const auto chord         = [](const unsigned int i, const unsigned int j) {
      return i + 2 == j && i % 10 == 0;
    };
    const auto strength = [&](const unsigned int i, const unsigned int j) {
      const unsigned int low = std::min(i, j), high = std::max(i, j);
      if (high == low + 1 || (low == 0 && high == n - 1))
        return 1.;
      return chord(low, high) ? .1 : 0.;
    };
    auto pattern = std::make_shared<NodePattern>();
    for (unsigned int i = 0; i < n; ++i)
      {
        std::vector<unsigned int> columns = {i};
        for (unsigned int j = 0; j < n; ++j)
          if (j != i && strength(i, j) > 0)
            columns.push_back(j);
        pattern->append_row(columns);
      }
    NodeBlockMatrix<2> A(pattern);
    for (unsigned int i = 0; i < n; ++i)
      {
        double sum = .1;
        for (std::size_t e = A.row_begin(i) + 1; e < A.row_end(i); ++e)
          {
            const double s = strength(i, A.column(e));
            A.set(i, e, {{-s, 0., 0., -s}});
            sum += s;
          }
        A.set(i, A.row_begin(i), {{sum, 0., 0., sum}});
      }
    LineRelaxation<2> relaxation(
      A,
      {{0, n}},
      [](const unsigned int, const unsigned int) { return false; },
      MPI_COMM_SELF);
    unsigned int n_in_lines     = 0;
    bool         is_tridiagonal = true;
    for (const std::vector<unsigned int> &line : relaxation.lines())
      {
        n_in_lines += line.size();
        for (unsigned int k = 0; k < line.size(); ++k)
          for (unsigned int l = k + 2; l < line.size(); ++l)
            is_tridiagonal = is_tridiagonal && strength(line[k], line[l]) == 0.;
      }
    check(relaxation.lines().size() > 1 && n_in_lines > .8 * n,
          "a ring with chords is cut into lines");
    check(is_tridiagonal, "inside of which only neighbours couple");
  }
} // namespace test_line_relaxation



TEST(line_relaxation)
{
  const auto name = [](const unsigned int dim, const std::string &what) {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << dim << "D, " << what << std::endl;
  };
  name(2, "squares");
  test<2>(2);
  name(2, "short in x");
  test<2>(0);
  name(2, "short in y");
  test<2>(1);
  name(3, "cubes");
  test<3>(3);
  name(3, "short in z");
  test<3>(2);
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
    test_ring();
}
