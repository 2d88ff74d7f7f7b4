// The matrices of the levels are the Galerkin products
//
//   B_k = M_k^T T (A + omega'') T M_k,
//
// whatever T and omega'' are: orthogonal projectors of random rank and random
// direction at the contact nodes, with random positive semidefinite curvatures
// on their ranges, at nodes on the edge of a refined region among others. M_k
// is written down here independently of any prolongation from level to level. A
// coarse function is known at a free leaf node p through the level f(p), the
// finest that has it. If f(p) >= k, any active cell at p lies in a cell of
// level k, and in the coordinates of the reference cell of that ancestor the
// function is d-linear. If f(p) < k, the functions of level k do not reach p.
// The value at hanging nodes then follows from their masters, *after*
// truncation; the mesh must have hanging nodes with truncated masters, because
// that is where one goes wrong.
//
// A local update must give, to the last bit, what a fresh assembly gives, and
// must be local.

#include <common/levels/level_matrices.h>

#include <Eigen/Sparse>

#include <iostream>

#include <tests/support/check.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_level_matrices
{
  using Sparse = Eigen::SparseMatrix<double>;

  // The dense matrix M_k. Also checks that all paths to a node agree.
  template <int dim>
  Eigen::MatrixXd
  prolongation_to_leaf(const RandomProblem<dim> &problem, const unsigned int k)
  {
    const auto        &constraints = problem.constraints();
    const unsigned int n_leaf      = constraints.n_nodes();
    const unsigned int n_level = problem.discretization.dof_handler().n_dofs(k);
    Eigen::MatrixXd    M       = Eigen::MatrixXd::Zero(dim * n_leaf, n_level);
    std::vector<char>  seen(n_leaf, 0);
    double             disagreement = 0;

    for (const auto &active :
         problem.discretization.dof_handler().active_cell_iterators())
      {
        if (active->level() < static_cast<int>(k))
          continue;
        for (const unsigned int v : active->vertex_indices())
          {
            const unsigned int node =
              constraints.node_of_dof(active->vertex_dof_index(v, 0));
            if (constraints.is_hanging(node))
              continue;

            // Climb up to level k, halving the coordinates.
            Point<dim> x = GeometryInfo<dim>::unit_cell_vertex(v);
            typename DoFHandler<dim>::level_cell_iterator cell = active;
            while (cell->level() > static_cast<int>(k))
              {
                const auto   parent = cell->parent();
                unsigned int child  = 0;
                while (parent->child_index(child) != cell->index())
                  ++child;
                x    = GeometryInfo<dim>::child_to_cell_coordinates(x, child);
                cell = parent;
              }

            Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_level);
            for (const unsigned int w : cell->vertex_indices())
              row(cell->mg_vertex_dof_index(k, w, 0)) =
                GeometryInfo<dim>::d_linear_shape_function(x, w);
            if (seen[node])
              disagreement = std::max(
                disagreement, (row - M.row(dim * node)).cwiseAbs().maxCoeff());
            seen[node]        = 1;
            M.row(dim * node) = row;
          }
      }
    // The other components have the weights of the first.
    for (unsigned int i = 0; i < n_leaf; ++i)
      for (unsigned int j = 0; j < n_level; j += dim)
        for (unsigned int d = 1; d < dim; ++d)
          M(dim * i + d, j + d) = M(dim * i, j);
    AssertThrow(disagreement < 1e-14, ExcInternalError());
    return M;
  }



  template <int dim>
  double
  largest_difference(const LevelMatrices<dim> &a, const LevelMatrices<dim> &b)
  {
    double difference = 0;
    for (unsigned int k = 0; k < a.n_levels(); ++k)
      {
        difference = std::max(difference,
                              (to_dense(a.matrix(k)) - to_dense(b.matrix(k)))
                                .cwiseAbs()
                                .maxCoeff());
        for (unsigned int i = 0; i < a.inverse_diagonals(k).size(); ++i)
          for (unsigned int e = 0; e < dim * dim; ++e)
            difference = std::max(difference,
                                  std::abs(a.inverse_diagonals(k)[i][e] -
                                           b.inverse_diagonals(k)[i][e]));
      }
    for (unsigned int i = 0; i < a.coarsest_null_spaces().size(); ++i)
      for (unsigned int e = 0; e < dim * dim; ++e)
        difference = std::max(difference,
                              std::abs(a.coarsest_null_spaces()[i][e] -
                                       b.coarsest_null_spaces()[i][e]));
    return difference;
  }



  template <int dim>
  void
  test_galerkin(const unsigned int seed)
  {
    Random                   random(seed);
    const RandomProblem<dim> problem(
      block_parameters<dim>(FrictionLaw::coulomb, .4),
      dim == 2 ? 4 : 3,
      dim == 2 ? .5 : .3,
      random);
    const auto     &constraints = problem.constraints();
    Truncation<dim> truncation =
      random_truncation<dim>(constraints, problem.contact(), 1., random);
    const unsigned int n_at_curvature =
      problem.n_hanging_at_contact([&](const unsigned int p) {
        const unsigned int node = problem.contact()[p].node;
        return trace<dim>(truncation.curvature(node).data()) > 0;
      });

    std::cout << dim << "D, " << problem.hierarchy().n_levels() << " levels, "
              << constraints.n_nodes() << " nodes, " << problem.contact().size()
              << " of them may touch, " << problem.n_hanging() << " hang, "
              << problem.n_hanging_with_truncated_master(truncation)
              << " have a truncated master, " << n_at_curvature
              << " on the contact boundary one with a second derivative"
              << std::endl;
    check((n_at_curvature > 0) == (dim == 3),
          "in 3D there are nodes where one goes wrong most easily");

    const Eigen::MatrixXd A = to_dense(problem.matrix());
    check_below((A - A.transpose()).cwiseAbs().maxCoeff() /
                  A.cwiseAbs().maxCoeff(),
                1e-14,
                "the leaf matrix is symmetric");

    const auto deviation = [&](const LevelMatrices<dim> &matrices,
                               const Truncation<dim>    &truncation) {
      const auto [T, omega] = to_dense(truncation, constraints.n_nodes());
      const Sparse T_sparse = T.sparseView();
      const Sparse sum      = (A + omega).sparseView();
      const Sparse TAT      = T_sparse * sum * T_sparse;
      double       largest  = 0;
      for (unsigned int k = 0; k < matrices.n_levels(); ++k)
        {
          const Sparse M = prolongation_to_leaf(problem, k).sparseView();
          const Eigen::MatrixXd B = Sparse(Sparse(M.transpose()) * TAT * M);
          largest =
            std::max(largest,
                     (B - to_dense(matrices.matrix(k))).cwiseAbs().maxCoeff() /
                       B.cwiseAbs().maxCoeff());
        }
      return largest;
    };

    LevelMatrices<dim> matrices(
      problem.matrix(), problem.hierarchy(), constraints);
    check(matrices.n_levels() == problem.hierarchy().n_levels() - 1,
          "there is a matrix on all levels but the finest");
    check_below(deviation(matrices, Truncation<dim>(constraints)),
                1e-13,
                "Galerkin product where only components are prescribed");
    check(matrices.update(truncation) > 0, "truncation changes rows");
    check_below(deviation(matrices, truncation),
                1e-13,
                "Galerkin product with random projectors and curvatures");

    // Truncation anywhere else is as good.
    for (unsigned int i = 0; i < constraints.n_nodes(); ++i)
      if (constraints.is_free(i) && random.chance(.3))
        truncate_at_random<dim>(
          truncation, i, random.below(dim + 1), 10., random);
    matrices.update(truncation);
    check_below(deviation(matrices, truncation),
                1e-13,
                "the same with projectors away from contact");
    check(matrices.update(truncation) == 0,
          "nothing is computed where nothing changes");

    // From one state to the next, by an update and afresh. In the last step
    // only second derivatives change, as they do while the slip turns.
    double      difference = 0;
    std::size_t n_rows     = 0;
    for (unsigned int step = 0; step < 4; ++step)
      {
        for (const ContactNode<dim> &p : problem.contact())
          if (random.chance(.3))
            {
              if (step < 3)
                truncate_at_random<dim>(
                  truncation, p.node, random.below(dim + 1), 1., random);
              else
                {
                  NodeBlock<dim> curvature = truncation.curvature(p.node);
                  for (double &entry : curvature)
                    entry *= 1.2;
                  truncation.set(
                    p.node, truncation.projector(p.node), curvature);
                }
            }
        n_rows = matrices.update(truncation);
        LevelMatrices<dim> fresh(
          problem.matrix(), problem.hierarchy(), constraints);
        fresh.update(truncation);
        difference = std::max(difference, largest_difference(matrices, fresh));
      }
    check_below(difference, 0., "updates are fresh assemblies to the last bit");
    check(n_rows > 0, "so are those of second derivatives alone");
    check_below(deviation(matrices, truncation),
                1e-13,
                "Galerkin product after all updates");
  }



  // A change at one node of a larger mesh touches that node, its neighbours,
  // and on each coarser level the few nodes whose functions they are in: at
  // most the nodes of a patch of five cells per direction.
  template <int dim>
  void
  test_locality()
  {
    Random     random(1);
    Parameters parameters = block_parameters<dim>(FrictionLaw::coulomb, .4);
    RandomProblem<dim> problem(parameters, 0, 0., random);
    problem.refine_global(dim == 2 ? 5 : 3);

    LevelMatrices<dim> matrices(
      problem.matrix(), problem.hierarchy(), problem.constraints());
    std::size_t n_rows = 0;
    for (unsigned int k = 0; k < matrices.n_levels(); ++k)
      n_rows += matrices.matrix(k).n_rows();

    std::size_t largest = 0;
    for (unsigned int step = 0; step < 20; ++step)
      {
        Truncation<dim> truncation(problem.constraints());
        for (const ContactNode<dim> &p : problem.contact())
          truncation.set(p.node, identity_block<dim>(), zero_block<dim>());
        const auto &p =
          problem.contact()[random.below(problem.contact().size())];
        truncation.set(p.node, zero_block<dim>(), zero_block<dim>());
        LevelMatrices<dim> fresh(
          problem.matrix(), problem.hierarchy(), problem.constraints());
        largest = std::max(largest, fresh.update(truncation));
      }
    std::cout << dim << "D, " << n_rows << " rows on " << matrices.n_levels()
              << " levels" << std::endl;
    check(largest > 0 &&
            largest <= matrices.n_levels() * Utilities::pow(5, dim) / 2,
          "a change at one contact node is confined to half a patch per level");
    check(largest < n_rows / (dim == 2 ? 20 : 3),
          "that is a small part of all rows");
  }
} // namespace test_level_matrices

TEST(level_matrices)
{
  for (unsigned int seed = 1; seed <= 2; ++seed)
    test_galerkin<2>(seed);
  for (const unsigned int seed : {3, 5})
    test_galerkin<3>(seed);
  test_locality<2>();
  test_locality<3>();
}
