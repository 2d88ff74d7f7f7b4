#include <common/iteration/contact_strip.h>
#include <common/iteration/newton_equations.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>

#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Friction
{
  namespace
  {
    constexpr unsigned int outside = std::numeric_limits<unsigned int>::max();

    // Unknowns of one process in three dimensions, where the factors of more
    // take longer than what they save, and gigabytes.
    constexpr unsigned int largest_in_space = 15000;
  } // namespace



  template <int dim>
  ContactStrip<dim>::ContactStrip(const DiscreteProblem<dim> &problem)
    : problem(problem)
    , position(problem.stiffness.blocks().n_rows(), outside)
    , contact_node(position)
    , control(1, 0.)
  {
    for (unsigned int p = 0; p < problem.contact.size(); ++p)
      contact_node[problem.contact[p].node] = p;
  }



  template <int dim>
  ContactStrip<dim>::~ContactStrip() = default;



  template <int dim>
  void
  ContactStrip<dim>::update(const Truncation<dim>             &truncation,
                            const std::vector<NodeValue<dim>> &slopes,
                            const unsigned int                 n_layers)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    current = &truncation;
    factors.reset();
    const std::vector<unsigned int> before = nodes;
    find_nodes(slopes, n_layers);
    if (dim == 3 && dim * nodes.size() > largest_in_space)
      find_nodes(slopes, 0);
    if (!nodes.empty())
      {
        fill(slopes, nodes != before);
        factorize();
      }

    const MPI_Comm comm = problem.communicator();
    empty_everywhere    = !true_on_any_process(factors != nullptr, comm);
  }



  template <int dim>
  void
  ContactStrip<dim>::find_nodes(const std::vector<NodeValue<dim>> &slopes,
                                const unsigned int                 n_layers)
  {
    const NodeBlockMatrix<dim> &A = problem.stiffness.blocks();
    for (const unsigned int node : nodes)
      position[node] = outside;
    nodes.clear();
    const auto add = [&](const unsigned int node) {
      if (position[node] == outside && !A.is_empty(node))
        {
          position[node] = nodes.size();
          nodes.push_back(node);
        }
    };
    for (unsigned int p = 0; p < slopes.size(); ++p)
      if (slopes[p] != NodeValue<dim>{})
        add(problem.contact[p].node);
    unsigned int done = 0;
    for (unsigned int layer = 0; layer < n_layers; ++layer)
      for (const unsigned int end = nodes.size(); done < end; ++done)
        for (std::size_t e = A.row_begin(nodes[done]);
             e < A.row_end(nodes[done]);
             ++e)
          if (A.column(e) < A.n_rows())
            add(A.column(e));
  }



  // Held directions get a stiffness of their own, so that none is missing.
  template <int dim>
  void
  ContactStrip<dim>::fill(const std::vector<NodeValue<dim>> &slopes,
                          const bool                         is_new)
  {
    const NodeBlockMatrix<dim> &A         = problem.stiffness.blocks();
    const auto                  is_inside = [&](const unsigned int node) {
      return node < A.n_rows() && position[node] != outside;
    };
    if (is_new)
      {
        const IndexSet            all = complete_index_set(dim * nodes.size());
        std::vector<unsigned int> n_entries;
        for (const unsigned int node : nodes)
          {
            unsigned int n = 0;
            for (std::size_t e = A.row_begin(node); e < A.row_end(node); ++e)
              n += is_inside(A.column(e)) ? dim : 0;
            n_entries.insert(n_entries.end(), dim, n);
          }
        matrix = std::make_unique<TrilinosWrappers::SparseMatrix>(
          all, MPI_COMM_SELF, n_entries);
        rhs.reinit(all, MPI_COMM_SELF);
        solution.reinit(rhs);
      }

    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const unsigned int      node   = nodes[i];
        const ContactNode<dim> *slider = nullptr;
        NodeValue<dim>          slope{};
        if (contact_node[node] != outside)
          {
            slider = &problem.contact[contact_node[node]];
            slope  = slopes[contact_node[node]];
          }
        columns.clear();
        for (std::vector<double> &row : rows)
          row.clear();
        for (std::size_t e = A.row_begin(node); e < A.row_end(node); ++e)
          {
            const unsigned int other = A.column(e);
            if (!is_inside(other))
              continue;
            const NodeBlock<dim> stiffness = A.value(node, e);
            NodeBlock<dim>       block =
              current->truncated_block(node, stiffness.data(), other);
            if (slider != nullptr)
              {
                const NodeBlock<dim> full =
                  times<dim>(stiffness, current->projector(other));
                subtract_change_of_bound<dim>(block, slope, *slider, full);
              }
            if (other == node)
              {
                const double scale = trace<dim>(stiffness.data()) / dim;
                for (unsigned int c = 0; c < dim; ++c)
                  for (unsigned int r = 0; r < dim; ++r)
                    block[c * dim + r] +=
                      current->curvature(node)[c * dim + r] +
                      scale *
                        ((r == c ? 1. : 0.) -
                         current->projector(node)[c * dim + r]);
              }
            for (unsigned int c = 0; c < dim; ++c)
              {
                columns.push_back(dim * position[other] + c);
                for (unsigned int r = 0; r < dim; ++r)
                  rows[r].push_back(block[c * dim + r]);
              }
          }
        for (unsigned int r = 0; r < dim; ++r)
          matrix->set(
            dim * i + r, columns.size(), columns.data(), rows[r].data());
      }
    matrix->compress(VectorOperation::insert);
  }



  // The matrix may be singular, as that of a body which slides and is held by
  // nothing else: the direction that is lost then gets a little stiffness. If
  // that is not enough, the strip is left out.
  template <int dim>
  void
  ContactStrip<dim>::factorize()
  {
    factors = std::make_unique<TrilinosWrappers::SolverDirect>(control);
    try
      {
        factors->initialize(*matrix);
      }
    catch (const ExceptionBase &)
      {
        double largest = 0.;
        for (unsigned int i = 0; i < matrix->m(); ++i)
          largest = std::max(largest, std::abs(matrix->diag_element(i)));
        for (unsigned int i = 0; i < matrix->m(); ++i)
          matrix->add(i, i, 1e-10 * largest);
        matrix->compress(VectorOperation::add);
        factors = std::make_unique<TrilinosWrappers::SolverDirect>(control);
        try
          {
            factors->initialize(*matrix);
          }
        catch (const ExceptionBase &)
          {
            factors.reset();
          }
      }
  }



  template <int dim>
  void
  ContactStrip<dim>::add_solution(VectorType &v, const VectorType &defect)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::leading_sweeps);
    if (!factors)
      return;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        rhs.local_element(dim * i + d) =
          defect.local_element(dim * nodes[i] + d);
    factors->solve(solution, rhs);
    for (unsigned int i = 0; i < nodes.size(); ++i)
      {
        const NodeValue<dim> value = times<dim>(
          current->projector(nodes[i]).data(), solution.begin() + dim * i);
        for (unsigned int d = 0; d < dim; ++d)
          v.local_element(dim * nodes[i] + d) += value[d];
      }
  }



  template <int dim>
  std::size_t
  ContactStrip<dim>::memory_consumption() const
  {
    return (matrix ? matrix->memory_consumption() : 0) +
      (nodes.capacity() + position.capacity() + contact_node.capacity()) *
      sizeof(unsigned int) +
      rhs.memory_consumption() + solution.memory_consumption();
  }



  template class ContactStrip<2>;
  template class ContactStrip<3>;
} // namespace Friction
