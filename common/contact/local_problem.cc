#include <common/contact/local_problem.h>

namespace Friction
{
  namespace
  {
    // The tangential part of a block.
    template <int dim>
    std::array<double, (dim - 1) * (dim - 1)>
    tangential_block(const std::array<double, dim * dim> &a)
    {
      std::array<double, (dim - 1) * (dim - 1)> result;
      for (unsigned int c = 1; c < dim; ++c)
        for (unsigned int r = 1; r < dim; ++r)
          result[(c - 1) * (dim - 1) + r - 1] = a[c * dim + r];
      return result;
    }



    // The same for a normal displacement that follows without any force, the
    // Schur complement.
    template <int dim>
    std::array<double, (dim - 1) * (dim - 1)>
    schur_complement(const std::array<double, dim * dim> &a)
    {
      std::array<double, (dim - 1) * (dim - 1)> result =
        tangential_block<dim>(a);
      for (unsigned int c = 1; c < dim; ++c)
        for (unsigned int r = 1; r < dim; ++r)
          result[(c - 1) * (dim - 1) + r - 1] -= a[r] * a[c] / a[0];
      return result;
    }
  } // namespace



  template <int dim>
  LocalProblem<dim>::LocalProblem(const std::array<double, dim * dim> &block,
                                  const double                         gap,
                                  const unsigned int n_free_tangents,
                                  const LocalSolver  solver)
    : a_nn(block[0])
    , gap(gap)
    , n_free_tangents(n_free_tangents)
    , open(schur_complement<dim>(block), n_free_tangents, solver)
    , contact(tangential_block<dim>(block), n_free_tangents, solver)
  {
    for (unsigned int i = 0; i < dim - 1; ++i)
      a_tn[i] = block[i + 1];
  }



  // Being strictly convex, the problem has one solution, so that whichever of
  // the two cases fits is the right one; the likelier one is tried first.
  template <int dim>
  LocalSolution<dim>
  LocalProblem<dim>::solve(const std::array<double, dim>     &b,
                           const double                       bound,
                           const std::array<double, dim - 1> &before,
                           const bool contact_is_likely) const
  {
    LocalSolution<dim>          z;
    std::array<double, dim - 1> force;
    const auto                  normal_force = [&](const double z_n) {
      double r = b[0] - a_nn * z_n;
      for (unsigned int i = 0; i < dim - 1; ++i)
        r -= a_tn[i] * z.tangential[i];
      return r;
    };
    const auto solve_in_contact = [&]() {
      z.normal = gap;
      for (unsigned int i = 0; i < dim - 1; ++i)
        force[i] = b[i + 1] - a_tn[i] * gap;
      z.tangential = contact.solve(force, bound, before);
    };

    // At the obstacle, if it pushes and does not pull.
    z.in_contact = false;
    if (contact_is_likely)
      {
        solve_in_contact();
        z.in_contact = (normal_force(gap) > 0);
      }

    // Without the obstacle, and, if that penetrates, with it.
    if (!z.in_contact)
      {
        for (unsigned int i = 0; i < dim - 1; ++i)
          force[i] = b[i + 1] - a_tn[i] * b[0] / a_nn;
        z.tangential = open.solve(force, bound, before);
        z.normal     = normal_force(0.) / a_nn;
        z.in_contact = !(z.normal < gap);
        if (z.in_contact)
          solve_in_contact();
      }

    z.sticks = n_free_tangents > 0 && bound > 0;
    for (unsigned int i = 0; i < dim - 1; ++i)
      z.sticks = z.sticks && z.tangential[i] == 0.;
    return z;
  }



  template class LocalProblem<2>;
  template class LocalProblem<3>;
} // namespace Friction
