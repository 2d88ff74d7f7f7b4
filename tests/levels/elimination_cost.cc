// What it costs to factorise a matrix, told from its graph, for boxes of nodes
// that are coupled to all around them, on one process and on two:
//
// - it is that of the layers of a strip, which begin at a corner,
// - or nearly so, if its nodes are numbered in another way,
// - a symbolic factorisation along the body takes no more, and at least a
//   twelfth,
// - parts that do not hang together add up,
// - so AlgebraicSolver factorises long strips and bars, and not squares and
//   cubes of as many unknowns.

#include <common/levels/algebraic_solver.h>
#include <common/levels/elimination_cost.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <tests/support/check.h>
#include <tests/support/random.h>
#include <tests/support/test.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

using namespace dealii;
using namespace Friction;
using Tests::check_everywhere;

namespace test_elimination_cost
{
  using Size = std::array<unsigned int, 3>;

  // The numbers of the neighbours of all nodes, themselves included.
  std::vector<std::vector<unsigned int>>
  box(const Size &n, const std::vector<unsigned int> &numbers)
  {
    std::vector<std::vector<unsigned int>> graph(numbers.size());
    const auto number = [&](const int i, const int j, const int k) {
      return numbers[(k * n[1] + j) * n[0] + i];
    };
    for (int k = 0; k < int(n[2]); ++k)
      for (int j = 0; j < int(n[1]); ++j)
        for (int i = 0; i < int(n[0]); ++i)
          for (int c = std::max(k - 1, 0); c <= std::min(k + 1, int(n[2]) - 1);
               ++c)
            for (int b = std::max(j - 1, 0);
                 b <= std::min(j + 1, int(n[1]) - 1);
                 ++b)
              for (int a = std::max(i - 1, 0);
                   a <= std::min(i + 1, int(n[0]) - 1);
                   ++a)
                graph[number(i, j, k)].push_back(number(a, b, c));
    return graph;
  }



  std::vector<unsigned int>
  in_order(const Size &n)
  {
    std::vector<unsigned int> numbers(n[0] * n[1] * n[2]);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
  }



  std::vector<unsigned int>
  shuffled(const Size &n)
  {
    std::vector<unsigned int> numbers = in_order(n);
    Tests::Random             random(1);
    for (unsigned int i = numbers.size() - 1; i > 0; --i)
      std::swap(numbers[i], numbers[random.below(i + 1)]);
    return numbers;
  }



  // The Laplacian of the graph, plus one, in each component.
  void
  make_matrix(TrilinosWrappers::SparseMatrix               &matrix,
              const std::vector<std::vector<unsigned int>> &graph,
              const unsigned int                            n_components)
  {
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_processes =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    const unsigned int begin = graph.size() * rank / n_processes;
    const unsigned int end   = graph.size() * (rank + 1) / n_processes;

    IndexSet owned(n_components * graph.size());
    owned.add_range(n_components * begin, n_components * end);
    DynamicSparsityPattern pattern(owned.size(), owned.size(), owned);
    for (unsigned int i = begin; i < end; ++i)
      for (unsigned int r = 0; r < n_components; ++r)
        for (const unsigned int j : graph[i])
          for (unsigned int c = 0; c < n_components; ++c)
            pattern.add(n_components * i + r, n_components * j + c);
    matrix.reinit(owned, owned, pattern, MPI_COMM_WORLD);
    for (unsigned int i = begin; i < end; ++i)
      for (unsigned int r = 0; r < n_components; ++r)
        for (const unsigned int j : graph[i])
          matrix.set(n_components * i + r,
                     n_components * j + r,
                     i == j ? 1. * graph[i].size() : -1.);
    matrix.compress(VectorOperation::insert);
  }



  double
  cost(const Size                      &n,
       const std::vector<unsigned int> &numbers,
       const unsigned int               n_components)
  {
    TrilinosWrappers::SparseMatrix matrix;
    make_matrix(matrix, box(n, numbers), n_components);
    return elimination_cost(matrix, n_components);
  }



  // Layer l has the nodes of a box of l + 1 nodes in each direction, as far as
  // there are so many, without those of the box of l.
  double
  cost_from_a_corner(const Size &n, const unsigned int n_components)
  {
    std::vector<double> layers;
    for (unsigned int l = 0; l < *std::max_element(n.begin(), n.end()); ++l)
      {
        double with = n_components, without = n_components;
        for (const unsigned int most : n)
          {
            with *= std::min(l + 1, most);
            without *= std::min(l, most);
          }
        layers.push_back(with - without);
      }
    layers.push_back(0.);
    double sum = 0.;
    for (std::size_t l = 0; l + 1 < layers.size(); ++l)
      sum += layers[l] * std::pow(layers[l] + layers[l + 1], 2);
    return sum;
  }



  // Elimination along the first direction, with fill: an unknown with d others
  // left beside it takes d^2.
  double
  symbolic_cost(const Size &n, const unsigned int n_components)
  {
    const auto                          graph = box(n, in_order(n));
    std::vector<std::set<unsigned int>> left(graph.size());
    std::vector<unsigned int> order = in_order(n), place(graph.size());
    std::stable_sort(order.begin(),
                     order.end(),
                     [&](const unsigned int a, const unsigned int b) {
                       return a % n[0] < b % n[0];
                     });
    for (unsigned int i = 0; i < order.size(); ++i)
      place[order[i]] = i;
    for (unsigned int i = 0; i < graph.size(); ++i)
      for (const unsigned int j : graph[i])
        if (place[j] > place[i])
          left[place[i]].insert(place[j]);
    double sum = 0;
    for (auto &neighbours : left)
      {
        for (unsigned int c = 0; c < n_components; ++c)
          sum += std::pow(n_components * neighbours.size() + c, 2);
        if (!neighbours.empty())
          {
            auto &first = left[*neighbours.begin()];
            first.insert(std::next(neighbours.begin()), neighbours.end());
          }
      }
    return sum;
  }



  bool
  is_factorised(const Size &n, const unsigned int n_components)
  {
    TrilinosWrappers::SparseMatrix matrix;
    make_matrix(matrix, box(n, in_order(n)), n_components);
    AlgebraicSolver solver(CoarsestMethod::automatic, n_components);
    solver.initialize(matrix);
    return solver.is_direct();
  }
} // namespace test_elimination_cost



TEST(elimination_cost)
{
  for (const Size n : {Size{{20, 2, 1}}, Size{{30, 3, 1}}, Size{{25, 2, 2}}})
    {
      const unsigned int dim         = n[2] > 1 ? 3 : 2;
      const double       closed_form = cost_from_a_corner(n, dim);
      check_everywhere(cost(n, in_order(n), dim) == closed_form,
                       "a strip costs what its layers do");
      const double another = cost(n, shuffled(n), dim);
      check_everywhere(std::abs(another - closed_form) < 0.1 * closed_form,
                       "in whatever way its nodes are numbered");
    }

  for (const Size n : {Size{{40, 3, 1}},
                       Size{{20, 10, 1}},
                       Size{{15, 15, 1}},
                       Size{{12, 3, 3}},
                       Size{{6, 6, 6}}})
    {
      const unsigned int dim     = n[2] > 1 ? 3 : 2;
      const double       exact   = symbolic_cost(n, dim);
      const double       by_them = cost(n, in_order(n), dim);
      check_everywhere(
        exact <= by_them && by_them <= 12 * exact,
        "a symbolic factorisation takes no more, and a twelfth at least");
    }

  {
    // Two strips side by side without couplings.
    const Size n{{20, 2, 1}};
    auto       graph = box(n, in_order(n));
    const auto half  = graph;
    for (const auto &row : half)
      {
        graph.push_back(row);
        for (unsigned int &j : graph.back())
          j += half.size();
      }
    TrilinosWrappers::SparseMatrix matrix;
    make_matrix(matrix, graph, 2);
    check_everywhere(elimination_cost(matrix, 2) == 2 * cost(n, in_order(n), 2),
                     "two parts cost twice as much as one");
  }

  check_everywhere(is_factorised({{2000, 2, 1}}, 2) &&
                     is_factorised({{1000, 2, 2}}, 3),
                   "strips and bars are factorised");
  // By its factors, as preconditioner.
  {
    const Size                     n{{8000, 2, 1}};
    TrilinosWrappers::SparseMatrix matrix;
    make_matrix(matrix, box(n, in_order(n)), 2);
    AlgebraicSolver solver(CoarsestMethod::automatic, 2);
    solver.initialize(matrix);
    VectorType x(matrix.locally_owned_range_indices(), MPI_COMM_WORLD), b(x),
      Ax(x);
    b = 1.;
    solver.solve(x, b);
    matrix.vmult(Ax, x);
    Ax -= b;
    check_everywhere(solver.is_direct() && Ax.l2_norm() < 1e-6 * b.l2_norm(),
                     "a long strip is solved");
  }

  check_everywhere(!is_factorised({{64, 63, 1}}, 2) &&
                     !is_factorised({{16, 16, 16}}, 3),
                   "squares and cubes of as many unknowns are not");
}
