#include <common/nodes/plane_relaxation.h>
#include <common/nodes/relaxed_together.h>
#include <common/nodes/strong_planes.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int smallest_plane = 9;

    // Multiplications per unknown of a plane to factorise, in each cycle, what
    // is left on nodes that may be truncated: about a cycle's worth. Along a
    // border of a square there may be four thousand of them.
    constexpr double dearest_truncation = 6000;

    // Couplings per node of a plane: a chain of nodes has two, a plane of three
    // by three has more than four.
    constexpr unsigned int fewest_couplings = 4;

    // Multiplications per unknown to factorise a plane: a cycle has some
    // thousand, and planes of a million unknowns have a hundred thousand. On
    // the leaf mesh it is done once, and on levels, whose planes have a quarter
    // of the nodes, whenever phases change.
    constexpr double dearest = 3e5;
  } // namespace



  template <int dim>
  PlaneRelaxation<dim>::PlaneRelaxation(const NodeBlockMatrix<dim> &A,
                                        const RelaxedNodes         &nodes,
                                        const MPI_Comm communicator)
    : A(&A)
  {
    if (dim < 3)
      return;
    // Positions are asked for, and all nodes looked at, only where it may be
    // worth it.
    const auto are_there = [&](const auto &may_be) {
      return RelaxedTogether::are_there(
        A.n_rows(), nodes.nodes, may_be, communicator);
    };
    if (!are_there([&](const unsigned int i) { return may_be_in_plane(A, i); }))
      return;
    const auto positions = nodes.positions();
    AssertDimension(positions.size(), A.n_rows());
    if (!are_there([&](const unsigned int i) {
          return may_be_in_plane(A, i, positions);
        }))
      return;

    const std::vector<char> is_relaxed =
      RelaxedTogether::flags(A.n_rows(), nodes.nodes);
    find_planes(nodes, is_relaxed, positions);
    std::size_t n_found = 0;
    for (const auto &problem : problems)
      n_found += problem->nodes().size();
    share = RelaxedTogether::share_of(n_found, is_relaxed, communicator);
    if (share == 0.)
      problems.clear();
  }



  template <int dim>
  void
  PlaneRelaxation<dim>::find_planes(const RelaxedNodes      &nodes,
                                    const std::vector<char> &is_relaxed,
                                    const Places            &positions)
  {
    std::vector<char> is_truncated(A->n_rows());
    for (const unsigned int i : nodes.truncated)
      is_truncated[i] = true;
    for (const std::vector<unsigned int> &plane :
         strong_planes(*A, is_relaxed, positions))
      {
        const auto members =
          nodes_of_problem(nodes, positions, is_truncated, plane);
        if (members.size() < smallest_plane)
          continue;
        auto problem = std::make_unique<Problem>(*A, members);
        if (problem->n_couplings() >= fewest_couplings * members.size() &&
            problem->cost() <= dearest * dim * members.size())
          problems.push_back(std::move(problem));
      }
  }



  template <int dim>
  std::vector<typename PlaneProblem<dim>::Node>
  PlaneRelaxation<dim>::nodes_of_problem(
    const RelaxedNodes              &nodes,
    const Places                    &positions,
    const std::vector<char>         &is_truncated,
    const std::vector<unsigned int> &plane) const
  {
    const std::size_t n_truncated =
      std::count_if(plane.begin(), plane.end(), [&](const unsigned int i) {
        return is_truncated[i];
      });
    const double n_dense = dim * n_truncated;
    const bool   has_all = n_dense * n_dense * n_dense / 6 <=
      dearest_truncation * dim * plane.size();
    std::vector<typename Problem::Node> result;
    for (const unsigned int i : plane)
      if (has_all || !is_truncated[i])
        {
          typename Problem::Node node;
          node.number           = i;
          node.position         = positions[i];
          node.may_be_truncated = is_truncated[i];
          for (unsigned int c = 0; c < dim; ++c)
            node.is_held[c] = nodes.is_held(i, c);
          result.push_back(node);
        }
    return result;
  }



  template <int dim>
  std::vector<std::vector<unsigned int>>
  PlaneRelaxation<dim>::planes() const
  {
    std::vector<std::vector<unsigned int>> result;
    for (const auto &problem : problems)
      result.push_back(problem->nodes());
    return result;
  }



  template <int dim>
  NodeRanges
  PlaneRelaxation<dim>::other_nodes(const NodeRanges &all) const
  {
    if (problems.empty())
      return all;
    std::vector<char> is_in_plane(A->n_rows());
    for (const auto &problem : problems)
      for (const unsigned int i : problem->nodes())
        is_in_plane[i] = true;
    return RelaxedTogether::others(all, is_in_plane);
  }



  template <int dim>
  void
  PlaneRelaxation<dim>::factorise(const Truncation<dim> *the_truncation)
  {
    truncation = the_truncation;
    for (const auto &problem : problems)
      {
        if (truncation == nullptr || !is_factorised)
          problem->factorise(*A, truncation == nullptr);
        if (truncation != nullptr)
          problem->truncate(*truncation);
      }
    is_factorised = true;
  }



  template <int dim>
  void
  PlaneRelaxation<dim>::run(const unsigned int n_sweeps,
                            const double      *b,
                            double            *x,
                            GhostExchange     &ghosts,
                            double            *residual) const
  {
    Assert(is_factorised || problems.empty(), ExcInvalidState());
    for (unsigned int s = 0; s < n_sweeps; ++s)
      {
        for (const auto &problem : problems)
          {
            const std::vector<unsigned int> &nodes = problem->nodes();
            values.resize(dim * nodes.size());
            for (unsigned int i = 0; i < nodes.size(); ++i)
              {
                const NodeValue<dim> r = RelaxedTogether::residual<dim>(
                  *A, truncation, nodes[i], b, x);
                std::copy(r.begin(), r.end(), values.begin() + dim * i);
              }
            problem->solve(values);
            for (unsigned int i = 0; i < nodes.size(); ++i)
              for (unsigned int d = 0; d < dim; ++d)
                x[dim * nodes[i] + d] += values[dim * i + d];
          }
        ghosts.update(x, dim);
      }
    if (residual != nullptr)
      RelaxedTogether::residuals<dim>(*A, truncation, b, x, residual);
  }



  template <int dim>
  std::size_t
  PlaneRelaxation<dim>::memory_consumption() const
  {
    std::size_t bytes = 0;
    for (const auto &problem : problems)
      bytes += problem->memory_consumption();
    return bytes;
  }



  template class PlaneRelaxation<2>;
  template class PlaneRelaxation<3>;
} // namespace Friction
