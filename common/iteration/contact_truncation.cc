#include <common/iteration/contact_truncation.h>

#include <algorithm>

namespace Friction
{
  template <int dim>
  ContactTruncation<dim>::ContactTruncation(const DiscreteProblem<dim> &problem)
    : problem(problem)
    , current(problem.constraints)
  {
    find_ghosts();
  }



  template <int dim>
  void
  ContactTruncation<dim>::find_ghosts()
  {
    const ContactBoundary<dim> &contact = problem.contact;
    const NodeNumbering        &leaf    = problem.constraints.numbering();
    if (leaf.distribution().n_processes() == 1)
      return;

    // Contact nodes have numbers of their own. Which of our ghosts is which of
    // them their owners tell; zero means that it is none.
    NodeNumbering       numbering(NodeDistribution(
      contact.size(), leaf.distribution().shared_communicator()));
    std::vector<double> number(leaf.size(), 0.);
    for (unsigned int p = 0; p < contact.size(); ++p)
      number[contact[p].node] = 1. + numbering.distribution().global(p);
    const std::vector<unsigned int> all_ghosts = leaf.all_ghosts();
    GhostExchange(leaf, all_ghosts).update(number.data(), 1);

    std::vector<unsigned int> contact_ghosts;
    for (const unsigned int node : all_ghosts)
      if (number[node] > 0)
        {
          ghost_nodes.push_back(node);
          contact_ghosts.push_back(
            numbering.add(static_cast<GlobalNode>(number[node]) - 1));
        }
    ghosts = GhostExchange(numbering, contact_ghosts);
    exchanged.resize(2 * dim * dim * numbering.size());
  }



  template <int dim>
  void
  ContactTruncation<dim>::set(const unsigned int    p,
                              const NodeBlock<dim> &projector,
                              const NodeBlock<dim> &curvature)
  {
    current.set(problem.contact[p].node, projector, curvature);
  }



  template <int dim>
  NodeBlock<dim>
  ContactTruncation<dim>::projector(const unsigned int p,
                                    const bool         normal_is_free,
                                    const bool         tangents_are_free) const
  {
    const ContactNode<dim> &node = problem.contact[p];

    // Everything free must be the identity to the last bit, so that the block
    // is the leaf matrix's own.
    if (normal_is_free && tangents_are_free && node.n_free_tangents == dim - 1)
      return identity_block<dim>();

    NodeBlock<dim> sum = zero_block<dim>();
    const auto     add = [&](const Tensor<1, dim> &direction) {
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int r = 0; r < dim; ++r)
          sum[c * dim + r] += direction[r] * direction[c];
    };
    if (normal_is_free)
      add(node.normal());
    if (tangents_are_free)
      for (unsigned int t = 1; t <= node.n_free_tangents; ++t)
        add(node.frame[t]);
    return sum;
  }



  template <int dim>
  void
  ContactTruncation<dim>::exchange()
  {
    const ContactBoundary<dim> &contact = problem.contact;
    if (ghosts.is_empty())
      return;
    constexpr unsigned int n = dim * dim;
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        std::copy_n(
          current.projector(contact[p].node).begin(), n, &exchanged[2 * n * p]);
        std::copy_n(current.curvature(contact[p].node).begin(),
                    n,
                    &exchanged[2 * n * p + n]);
      }
    ghosts.update(exchanged.data(), 2 * n);
    for (unsigned int g = 0; g < ghost_nodes.size(); ++g)
      {
        NodeBlock<dim> projector, curvature;
        const double  *values = &exchanged[2 * n * (contact.size() + g)];
        std::copy_n(values, n, projector.begin());
        std::copy_n(values + n, n, curvature.begin());
        current.set(ghost_nodes[g], projector, curvature);
      }
  }



  template class ContactTruncation<2>;
  template class ContactTruncation<3>;
} // namespace Friction
