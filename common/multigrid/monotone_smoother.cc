#include <common/multigrid/monotone_smoother.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  MonotoneSmoother<dim>::MonotoneSmoother(
    const NodeBlockMatrix<dim>  &matrix,
    const NodalConstraints<dim> &constraints,
    const ContactBoundary<dim>  &contact,
    const double                 friction_coefficient)
    : matrix(matrix)
    , contact(contact)
    , friction_coefficient(friction_coefficient)
    , inverses(constraints.n_owned_nodes(), zero_block<dim>())
  {
    std::vector<char> is_ordinary(constraints.n_owned_nodes());
    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      is_ordinary[node] = !constraints.is_fixed(node);

    for (const ContactNode<dim> &p : contact)
      {
        is_ordinary[p.node] = false;

        // The diagonal block in the frame of the node.
        const double *A = matrix.block(matrix.row_begin(p.node));
        std::array<double, dim * dim> block;
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int r = 0; r < dim; ++r)
            {
              double sum = 0;
              for (unsigned int k = 0; k < dim; ++k)
                for (unsigned int l = 0; l < dim; ++l)
                  sum += p.frame[r][k] * A[l * dim + k] * p.frame[c][l];
              block[c * dim + r] = sum;
            }
        local_problems.emplace_back(block, p.gap, p.n_free_tangents);
      }

    for (unsigned int node = 0; node < is_ordinary.size(); ++node)
      if (is_ordinary[node])
        {
          if (!ordinary.empty() && ordinary.back().second == node)
            ++ordinary.back().second;
          else
            ordinary.emplace_back(node, node + 1);

          NodeBlock<dim> block;
          std::copy_n(
            matrix.block(matrix.row_begin(node)), dim * dim, block.begin());
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int r = 0; r < dim; ++r)
              if (constraints.is_prescribed(node, c) ||
                  constraints.is_prescribed(node, r))
                block[c * dim + r] = 0.;
          inverses[node] =
            pseudo_inverse<dim>(block, 1e-10 * trace<dim>(block.data()));
        }
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::sweep(VectorType       &u,
                               const VectorType &f,
                               ContactState     &state,
                               const bool        update_normal_forces,
                               const bool        backwards) const
  {
    const auto relax_ordinary_nodes = [&]() {
      gauss_seidel_sweep<dim>(
        matrix, inverses, ordinary, f.begin(), u.begin(), backwards);
    };

    if (!backwards)
      {
        relax_ordinary_nodes();
        for (unsigned int p = 0; p < contact.size(); ++p)
          relax_contact_node(p, u, f, state, update_normal_forces);
      }
    else
      {
        for (unsigned int p = contact.size(); p-- > 0;)
          relax_contact_node(p, u, f, state, update_normal_forces);
        relax_ordinary_nodes();
      }
  }



  template <int dim>
  void
  MonotoneSmoother<dim>::relax_contact_node(
    const unsigned int p,
    VectorType        &u,
    const VectorType  &f,
    ContactState      &state,
    const bool         update_normal_forces) const
  {
    const ContactNode<dim> &node  = contact[p];
    double                 *value = u.begin() + dim * node.node;

    // The force that the other nodes leave, r~ = r + A_pp u_p in (6.18).
    const NodeValue<dim> product = matrix.row_times(node.node, u.begin());
    const NodeValue<dim> diagonal =
      times<dim>(matrix.block(matrix.row_begin(node.node)), value);
    Tensor<1, dim> residual, force, old_value;
    for (unsigned int d = 0; d < dim; ++d)
      {
        old_value[d] = value[d];
        residual[d]  = f.local_element(dim * node.node + d) - product[d];
        force[d]     = residual[d] + diagonal[d];
      }

    double bound = 0;
    if (friction_coefficient > 0)
      {
        if (update_normal_forces)
          state.set_normal_force(
            p,
            state.in_contact(p) ? std::max(0., residual * node.normal()) : 0.);
        bound = friction_coefficient * state.normal_force(p);
      }

    std::array<double, dim>     b;
    std::array<double, dim - 1> tangential;
    for (unsigned int e = 0; e < dim; ++e)
      {
        b[e] = node.frame[e] * force;
        if (e > 0)
          tangential[e - 1] = node.frame[e] * old_value;
      }

    const LocalSolution<dim> z = local_problems[p].solve(b, bound, tangential);
    Tensor<1, dim>           new_value = z.normal * node.normal();
    for (unsigned int t = 1; t < dim; ++t)
      new_value += z.tangential[t - 1] * node.frame[t];
    for (unsigned int d = 0; d < dim; ++d)
      value[d] = new_value[d];
    state.set(p, z.in_contact, z.sticks);
  }



  template class MonotoneSmoother<2>;
} // namespace Friction
