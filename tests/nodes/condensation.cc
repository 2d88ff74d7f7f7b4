// Static condensation on meshes with hanging nodes and with prescribed
// components, against dense linear algebra: the matrix that is left on contact
// nodes is the Schur complement, and eliminating from a right hand side,
// solving there and expanding gives what solving all at once gives. The cost
// that is foretold is that of a dense factorisation where there is but one
// front. A body that nothing holds is noticed.

#include <common/nodes/condensation.h>

#include <iostream>
#include <set>

#include <tests/support/check.h>
#include <tests/support/dense.h>
#include <tests/support/discretized.h>
#include <tests/support/random_problem.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_condensation
{
  template <int dim>
  struct Body
  {
    explicit Body(const RandomProblem<dim> &problem, const bool is_free = false)
      : is_held(dim * problem.matrix().n_rows(), 0)
      , is_kept(problem.matrix().n_rows(), 0)
      , is_absent(is_kept)
      , positions(is_kept.size())
    {
      const auto points = node_points(problem.discretization);
      for (unsigned int i = 0; i < is_kept.size(); ++i)
        {
          positions[i].fill(0.);
          bool all_held = true;
          for (unsigned int d = 0; d < dim; ++d)
            {
              positions[i][d] = points[i][d];
              is_held[dim * i + d] =
                !is_free && problem.constraints().is_prescribed(i, d);
              all_held = all_held && is_held[dim * i + d];
            }
          is_absent[i] = all_held || problem.constraints().is_hanging(i);
        }
      if (!is_free)
        for (const ContactNode<dim> &p : problem.contact())
          is_kept[p.node] = 1;
    }

    std::vector<char> is_held, is_kept, is_absent;
    Places            positions;
  };



  // Every node is in one front, and borders are made of later ones.
  void
  check_order(const EliminationTree &tree, const std::vector<char> &is_absent)
  {
    std::vector<unsigned int> front_of(is_absent.size(), 0);
    std::set<unsigned int>    seen;
    bool                      once = true, later = true, once_a_child = true;
    const auto               &fronts = tree.fronts();
    std::vector<unsigned int> n_parents(fronts.size(), 0);
    for (unsigned int f = 0; f < fronts.size(); ++f)
      {
        for (const unsigned int i : fronts[f].nodes)
          {
            once        = once && seen.insert(i).second && !is_absent[i];
            front_of[i] = f;
          }
        for (const unsigned int child : fronts[f].children)
          {
            once_a_child = once_a_child && child < f;
            ++n_parents[child];
          }
      }
    for (unsigned int f = 0; f < fronts.size(); ++f)
      {
        once_a_child =
          once_a_child && n_parents[f] == (f + 1 < fronts.size() ? 1 : 0);
        for (const unsigned int i : fronts[f].border)
          later = later && front_of[i] > f;
      }
    const auto n_absent =
      std::count(is_absent.begin(), is_absent.end(), char(1));
    check(once && seen.size() + n_absent == is_absent.size(),
          "  each node that takes part is in one front");
    check(later && once_a_child,
          "  borders are eliminated later, and each front has one parent");
  }



  template <int dim>
  void
  test(const RandomProblem<dim> &problem, Random &random)
  {
    std::cout << dim << "D" << std::endl;
    check(problem.n_hanging() > 0, "  nodes hang");
    Body<dim>                   body(problem);
    const NodeBlockMatrix<dim> &A = problem.matrix();
    // A kept node that is held in one direction, and one that is not kept.
    unsigned int inner = 0;
    while (body.is_kept[inner] || body.is_absent[inner])
      ++inner;
    body.is_held[dim * problem.contact()[2].node + 1] = 1;
    body.is_held[dim * inner]                         = 1;

    const EliminationTree tree(
      A.sparsity(), body.positions, body.is_kept, body.is_absent);
    check_order(tree, body.is_absent);
    Condensation<dim> condensation(tree, body.is_held);
    check(condensation.factorize(A), "  the matrix can be factorised");

    // The same with all unknowns at once.
    const std::vector<unsigned int> &kept = tree.fronts().back().nodes;
    std::vector<unsigned int>        c, i;
    for (const unsigned int node : kept)
      for (unsigned int d = 0; d < dim; ++d)
        if (!body.is_held[dim * node + d])
          c.push_back(dim * node + d);
    for (unsigned int node = 0; node < A.n_rows(); ++node)
      for (unsigned int d = 0; d < dim; ++d)
        if (!body.is_kept[node] && !body.is_absent[node] &&
            !body.is_held[dim * node + d])
          i.push_back(dim * node + d);
    const Eigen::MatrixXd all  = to_dense(A);
    const auto            part = [&](const std::vector<unsigned int> &rows,
                          const std::vector<unsigned int> &columns) {
      Eigen::MatrixXd result(rows.size(), columns.size());
      for (unsigned int r = 0; r < rows.size(); ++r)
        for (unsigned int s = 0; s < columns.size(); ++s)
          result(r, s) = all(rows[r], columns[s]);
      return result;
    };
    const Eigen::MatrixXd A_ii = part(i, i);
    const Eigen::MatrixXd A_ci = part(c, i), A_ic = part(i, c);
    const Eigen::MatrixXd S = part(c, c) - A_ci * solve_singular(A_ii, A_ic);

    std::vector<int> place(dim * A.n_rows(), -1);
    for (unsigned int k = 0; k < c.size(); ++k)
      place[c[k]] = k;
    double largest = 0;
    for (unsigned int p = 0; p < kept.size(); ++p)
      for (unsigned int q = 0; q < kept.size(); ++q)
        {
          const NodeBlock<dim> block = condensation.block(p, q);
          for (unsigned int r = 0; r < dim; ++r)
            for (unsigned int s = 0; s < dim; ++s)
              {
                const int a = place[dim * kept[p] + r],
                          b = place[dim * kept[q] + s];
                if (a >= 0 && b >= 0)
                  largest =
                    std::max(largest, std::abs(block[s * dim + r] - S(a, b)));
                else if (!(p == q && r == s))
                  largest = std::max(largest, std::abs(block[s * dim + r]));
              }
        }
    check_below(largest / S.cwiseAbs().maxCoeff(),
                1e-12,
                "  the matrix of kept nodes is the Schur complement");

    std::vector<double> f(dim * A.n_rows());
    for (double &value : f)
      value = random(-1., 1.);
    Eigen::VectorXd f_c(c.size()), f_i(i.size());
    for (unsigned int k = 0; k < c.size(); ++k)
      f_c[k] = f[c[k]];
    for (unsigned int k = 0; k < i.size(); ++k)
      f_i[k] = f[i[k]];
    const Eigen::VectorXd reduced = f_c - A_ci * solve_singular(A_ii, f_i);
    condensation.reduce(f);
    Eigen::VectorXd found(c.size());
    for (unsigned int k = 0; k < c.size(); ++k)
      found[k] = f[c[k]];
    check_below((found - reduced).norm() / reduced.norm(),
                1e-11,
                "  right hand sides are reduced");

    // Values that are as good as any other, zero where nothing moves.
    const Eigen::VectorXd u_c = Eigen::VectorXd::Random(c.size());
    for (const unsigned int node : kept)
      for (unsigned int d = 0; d < dim; ++d)
        f[dim * node + d] = 0;
    for (unsigned int k = 0; k < c.size(); ++k)
      f[c[k]] = u_c[k];
    condensation.expand(f);
    const Eigen::VectorXd u_i = solve_singular(A_ii, f_i - A_ic * u_c);
    found.resize(i.size());
    for (unsigned int k = 0; k < i.size(); ++k)
      found[k] = f[i[k]];
    check_below(
      (found - u_i).norm() / u_i.norm(), 1e-11, "  and solutions expanded");

    // One node that is kept, so that all others are in the way of no other.
    std::vector<char> but_one(A.n_rows(), 1);
    but_one[inner] = 0;
    const EliminationTree single(
      A.sparsity(), body.positions, but_one, body.is_absent);
    std::set<unsigned int> neighbours;
    for (std::size_t e = A.row_begin(inner); e < A.row_end(inner); ++e)
      if (A.column(e) != inner && !body.is_absent[A.column(e)])
        neighbours.insert(A.column(e));
    const double n = dim, m = dim * neighbours.size();
    check_below(
      std::abs(single.cost(dim) - n * (n * n / 6 + n * m / 2 + m * m / 2)),
      1e-9,
      "  the cost of a single node is that of its neighbours");

    const Body<dim>       free(problem, true);
    const EliminationTree no_contact(
      A.sparsity(), free.positions, free.is_kept, free.is_absent);
    check(!Condensation<dim>(no_contact, free.is_held).factorize(A),
          "  a body that nothing holds is noticed");
  }



  // So thin that a front is two nodes: what its rigid motions have left of the
  // diagonal there is rounding errors.
  void
  test_thin_bodies(Random &random)
  {
    unsigned int n_factorised = 0;
    for (unsigned int n_cells = 8; n_cells < 200; ++n_cells)
      {
        Parameters p         = block_parameters<2>(FrictionLaw::coulomb, .4);
        p.scene.size         = {random(.5, 1.5) * n_cells, 1.};
        p.scene.subdivisions = {n_cells, 1};
        const Scene<2>   scene(p);
        Triangulation<2> mesh(
          Triangulation<2>::limit_level_difference_at_vertices);
        scene.make_coarse_mesh(mesh);
        const Discretized<2>      d(scene, mesh);
        const NodeBlockMatrix<2> &A = d.stiffness().blocks();
        const std::vector<char>   no_node(A.n_rows(), 0),
          no_value(2 * A.n_rows(), 0);
        Places positions;
        for (const Point<2> &point : node_points<2>(d))
          positions.push_back(place_of(point));
        const EliminationTree tree(A.sparsity(), positions, no_node, no_node);
        n_factorised += Condensation<2>(tree, no_value).factorize(A);
      }
    check(n_factorised == 0, "thin bodies that nothing holds are noticed");
  }
} // namespace test_condensation



TEST(condensation)
{
  Random random(1);
  test(RandomProblem<2>(
         block_parameters<2>(FrictionLaw::coulomb, .4), 3, .7, random),
       random);
  test(RandomProblem<3>(
         block_parameters<3>(FrictionLaw::coulomb, .4), 2, .5, random),
       random);
  test_thin_bodies(random);
}
