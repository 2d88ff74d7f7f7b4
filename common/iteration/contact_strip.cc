#include <common/iteration/contact_strip.h>
#include <common/parallel/reductions.h>
#include <common/parallel/run_clock.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <cmath>

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
    , control(1, 0.)
  {}



  template <int dim>
  void
  ContactStrip<dim>::update(const Truncation<dim>             &truncation,
                            const std::vector<NodeValue<dim>> &slopes,
                            const unsigned int                 n_layers)
  {
    const PhaseScope phase(problem.communicator(), SolverPhase::matrix_updates);
    current = &truncation;
    factors.reset();
    std::vector<unsigned int> position = find_nodes(slopes, n_layers);
    if (dim == 3 && dim * nodes.size() > largest_in_space)
      position = find_nodes(slopes, 0);
    if (!nodes.empty())
      {
        fill(slopes, position);
        factorize();
      }

    const MPI_Comm comm = problem.communicator();
    empty_everywhere    = !true_on_any_process(factors != nullptr, comm);
    everything          = n_layers == whole_body && !empty_everywhere &&
      Utilities::MPI::n_mpi_processes(comm) == 1;
  }



  template <int dim>
  std::vector<unsigned int>
  ContactStrip<dim>::find_nodes(const std::vector<NodeValue<dim>> &slopes,
                                const unsigned int                 n_layers)
  {
    const NodeBlockMatrix<dim> &A = problem.stiffness.blocks();
    std::vector<unsigned int>   position(A.n_rows(), outside);
    nodes.clear();
    const auto add = [&](const unsigned int node) {
      if (position[node] == outside && A.row_begin(node) < A.row_end(node))
        {
          position[node] = nodes.size();
          nodes.push_back(node);
        }
    };
    if (n_layers == whole_body)
      for (unsigned int i = 0; i < A.n_rows(); ++i)
        add(i);
    else
      {
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
    return position;
  }



  // Held directions get a stiffness of their own, so that none is missing.
  template <int dim>
  void
  ContactStrip<dim>::fill(const std::vector<NodeValue<dim>> &slopes,
                          const std::vector<unsigned int>   &position)
  {
    const NodeBlockMatrix<dim> &A   = problem.stiffness.blocks();
    const unsigned int          n   = nodes.size();
    const IndexSet              all = complete_index_set(dim * n);
    DynamicSparsityPattern      pattern(dim * n, dim * n);
    for (unsigned int i = 0; i < n; ++i)
      for (std::size_t e = A.row_begin(nodes[i]); e < A.row_end(nodes[i]); ++e)
        if (A.column(e) < A.n_rows() && position[A.column(e)] != outside)
          for (unsigned int r = 0; r < dim; ++r)
            for (unsigned int c = 0; c < dim; ++c)
              pattern.add(dim * i + r, dim * position[A.column(e)] + c);
    matrix.clear();
    matrix.reinit(all, all, pattern, MPI_COMM_SELF);
    rhs.reinit(all, MPI_COMM_SELF);
    solution.reinit(rhs);

    std::vector<unsigned int> contact_node(A.n_rows(), outside);
    for (unsigned int p = 0; p < slopes.size(); ++p)
      contact_node[problem.contact[p].node] = p;
    for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int node  = nodes[i];
        const double       scale = trace<dim>(A.block(A.row_begin(node))) / dim;
        for (std::size_t e = A.row_begin(node); e < A.row_end(node); ++e)
          {
            const unsigned int other = A.column(e);
            if (other >= A.n_rows() || position[other] == outside)
              continue;
            NodeBlock<dim> block =
              current->truncated_block(node, A.block(e), other);
            if (contact_node[node] != outside)
              {
                const ContactNode<dim> &p = problem.contact[contact_node[node]];
                const NodeValue<dim>   &slope = slopes[contact_node[node]];
                NodeBlock<dim>          full;
                std::copy_n(A.block(e), dim * dim, full.begin());
                full = times<dim>(full, current->projector(other));
                for (unsigned int c = 0; c < dim; ++c)
                  {
                    double normal = 0;
                    for (unsigned int d = 0; d < dim; ++d)
                      normal += p.normal()[d] * full[c * dim + d];
                    for (unsigned int r = 0; r < dim; ++r)
                      block[c * dim + r] -= slope[r] * normal;
                  }
              }
            if (other == node)
              for (unsigned int c = 0; c < dim; ++c)
                for (unsigned int r = 0; r < dim; ++r)
                  block[c * dim + r] += current->curvature(node)[c * dim + r] +
                    scale *
                      ((r == c ? 1. : 0.) -
                       current->projector(node)[c * dim + r]);
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int r = 0; r < dim; ++r)
                matrix.set(
                  dim * i + r, dim * position[other] + c, block[c * dim + r]);
          }
      }
    matrix.compress(VectorOperation::insert);
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
        factors->initialize(matrix);
      }
    catch (const ExceptionBase &)
      {
        double largest = 0.;
        for (unsigned int i = 0; i < matrix.m(); ++i)
          largest = std::max(largest, std::abs(matrix.diag_element(i)));
        for (unsigned int i = 0; i < matrix.m(); ++i)
          matrix.add(i, i, 1e-10 * largest);
        matrix.compress(VectorOperation::add);
        factors = std::make_unique<TrilinosWrappers::SolverDirect>(control);
        try
          {
            factors->initialize(matrix);
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
    return matrix.memory_consumption() +
      nodes.capacity() * sizeof(unsigned int) + rhs.memory_consumption() +
      solution.memory_consumption();
  }



  template class ContactStrip<2>;
  template class ContactStrip<3>;
} // namespace Friction
