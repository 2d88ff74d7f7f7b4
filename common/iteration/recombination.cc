#include <common/iteration/best_combination.h>
#include <common/iteration/recombination.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  template <int dim>
  Recombination<dim>::Recombination(const DiscreteProblem<dim> &problem,
                                    const unsigned int          n_steps)
    : problem(problem)
    , n_steps(n_steps)
  {}



  template <int dim>
  void
  Recombination<dim>::clear()
  {
    has_last = false;
    steps.clear();
    products.clear();
  }



  template <int dim>
  void
  Recombination<dim>::add_iterate(const VectorType &u,
                                  const VectorType &residual)
  {
    if (n_steps == 0)
      return;
    if (has_last)
      {
        // The vectors of the oldest step are used again for the new one.
        if (steps.size() == n_steps)
          {
            steps.push_front(std::move(steps.back()));
            products.push_front(std::move(products.back()));
            steps.pop_back();
            products.pop_back();
          }
        else
          {
            steps.emplace_front(u);
            products.emplace_front(u);
          }
        steps.front() = u;
        add_owned(steps.front(), -1., last_iterate);
        products.front() = last_residual;
        add_owned(products.front(), -1., residual);
      }
    has_last      = true;
    last_iterate  = u;
    last_residual = residual;
  }



  template <int dim>
  unsigned int
  Recombination<dim>::improve(VectorType            &v,
                              VectorType            &Av,
                              const VectorType      &r,
                              const Truncation<dim> &truncation) const
  {
    std::vector<const VectorType *> basis = {&v}, images = {&Av};

    if (steps.empty())
      return 0;

    // Steps in the free subspace, up to the rounding of the iterates
    // themselves.
    const MPI_Comm      comm   = problem.communicator();
    const unsigned int  n_dofs = v.locally_owned_size();
    std::vector<double> deviations(1 + steps.size(), 0.);
    deviations[0] = 1e-13 * largest_owned(last_iterate);
    for (unsigned int i = 0; i < steps.size(); ++i)
      for (const unsigned int node : truncation.changed_nodes())
        if (dim * node < n_dofs)
          {
            const double        *s = steps[i].begin() + dim * node;
            const NodeValue<dim> Ts =
              times<dim>(truncation.projector(node).data(), s);
            for (unsigned int d = 0; d < dim; ++d)
              deviations[1 + i] =
                std::max(deviations[1 + i], std::abs(Ts[d] - s[d]));
          }
    max_over_processes(deviations, comm);
    for (unsigned int i = 0; i < steps.size(); ++i)
      if (deviations[1 + i] <= deviations[0])
        {
          basis.push_back(&steps[i]);
          images.push_back(&products[i]);
        }
    const unsigned int n = basis.size();
    if (n == 1)
      return 0;

    // The energy of the linearised problem has a part of friction, too; it is
    // that of contact nodes only.
    const auto friction = [&](const VectorType &a, const VectorType &b) {
      double sum = 0;
      for (const unsigned int node : truncation.changed_nodes())
        if (dim * node < n_dofs)
          {
            const NodeValue<dim> image = times<dim>(
              truncation.curvature(node).data(), b.begin() + dim * node);
            sum += dot<dim>(a.begin() + dim * node, image.data());
          }
      return sum;
    };

    // All scalar products in one reduction.
    std::vector<double> products_of_all;
    for (unsigned int i = 0; i < n; ++i)
      {
        products_of_all.push_back(dot_owned(r, *basis[i]));
        for (unsigned int j = 0; j <= i; ++j)
          products_of_all.push_back(dot_owned(*basis[i], *images[j]) +
                                    friction(*basis[i], *basis[j]));
      }
    sum_over_processes(products_of_all, comm);
    // A direction without energy, like a correction from coarse levels on which
    // nothing can move, is left out.
    const std::vector<double> coefficients =
      best_combination(products_of_all, n, 1e-10);
    if (coefficients.empty())
      return 0;

    scale_owned(v, coefficients[0]);
    scale_owned(Av, coefficients[0]);
    for (unsigned int i = 1; i < n; ++i)
      {
        add_owned(v, coefficients[i], *basis[i]);
        add_owned(Av, coefficients[i], *images[i]);
      }
    truncation.apply(v.begin());
    return n - 1;
  }



  template class Recombination<2>;
  template class Recombination<3>;
} // namespace Friction
