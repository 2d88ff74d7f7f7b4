#include <common/iteration/best_combination.h>
#include <common/iteration/recombination.h>
#include <common/parallel/owned_values.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // How many times what is left may be what has been added and subtracted.
    constexpr double largest_cancellation = 1e4;
  } // namespace



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
    older_steps.clear();
    older_images.clear();
  }



  template <int dim>
  unsigned int
  Recombination<dim>::improve(VectorType            &v,
                              double                &vAv,
                              const Iterate         &x,
                              const VectorType      &r,
                              const Truncation<dim> &truncation)
  {
    if (n_steps == 0 || !x.has_step())
      return 0;
    const unsigned int n_used = combine(v, vAv, x, r, truncation);
    if (n_steps > 1)
      {
        older_steps.push_front(x.step);
        older_images.push_front(x.step_image);
        if (older_steps.size() == n_steps)
          {
            older_steps.pop_back();
            older_images.pop_back();
          }
      }
    return n_used;
  }



  template <int dim>
  unsigned int
  Recombination<dim>::combine(VectorType            &v,
                              double                &vAv,
                              const Iterate         &x,
                              const VectorType      &r,
                              const Truncation<dim> &truncation) const
  {
    std::vector<const VectorType *> steps    = {&x.step},
                                    products = {&x.step_image};
    for (unsigned int i = 0; i < older_steps.size(); ++i)
      {
        steps.push_back(&older_steps[i]);
        products.push_back(&older_images[i]);
      }
    // The image of v itself is not known.
    std::vector<const VectorType *> basis = {&v}, images = {nullptr};

    // Which steps are in the free subspace, up to the rounding of the iterates
    // themselves?
    const MPI_Comm      comm   = problem.communicator();
    const unsigned int  n_dofs = v.locally_owned_size();
    std::vector<double> deviations(1 + steps.size(), 0.);
    deviations[0] = 1e-13 * largest_owned(x.u);
    for (unsigned int i = 0; i < steps.size(); ++i)
      for (const unsigned int node : truncation.changed_nodes())
        if (dim * node < n_dofs)
          {
            const double        *s = steps[i]->begin() + dim * node;
            const NodeValue<dim> Ts =
              times<dim>(truncation.projector(node).data(), s);
            for (unsigned int d = 0; d < dim; ++d)
              deviations[1 + i] =
                std::max(deviations[1 + i], std::abs(Ts[d] - s[d]));
          }
    max_over_processes(deviations, comm);
    std::deque<VectorType> projected, their_images;
    for (unsigned int i = 0; i < steps.size(); ++i)
      if (deviations[1 + i] <= deviations[0])
        {
          basis.push_back(steps[i]);
          images.push_back(products[i]);
        }
      else if (problem.previous_displacement != nullptr)
        {
          projected.push_back(*steps[i]);
          truncation.apply(projected.back().begin());
          their_images.emplace_back();
          their_images.back().reinit(v, true);
          problem.stiffness.vmult(their_images.back(), projected.back());
          basis.push_back(&projected.back());
          images.push_back(&their_images.back());
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

    // All scalar products in one reduction, and in one pass over the vectors:
    // what has come from memory for one product is there for the others.
    std::vector<double>    products_of_all(n + n * (n + 1) / 2, 0.);
    constexpr unsigned int chunk = 512;
    for (unsigned int begin = 0; begin < n_dofs; begin += chunk)
      {
        double    *sum   = products_of_all.data();
        const auto share = [&](const VectorType &a, const VectorType &b) {
          const double *a_here = a.begin() + begin, *b_here = b.begin() + begin;
          return sum_of_terms(
            std::min(chunk, n_dofs - begin),
            [=](const unsigned int i) { return a_here[i] * b_here[i]; });
        };
        for (unsigned int i = 0; i < n; ++i)
          {
            *sum++ += share(r, *basis[i]);
            for (unsigned int j = 0; j <= i; ++j, ++sum)
              if (i > 0)
                *sum += share(*images[i], *basis[j]);
          }
      }
    products_of_all[1] = vAv;
    // With the matrix alone they will be needed once more.
    const std::vector<double> shares = products_of_all;
    for (unsigned int i = 0, entry = 0; i < n; ++i)
      {
        ++entry;
        for (unsigned int j = 0; j <= i; ++j)
          products_of_all[entry++] += friction(*basis[i], *basis[j]);
      }
    products_of_all.insert(products_of_all.end(), shares.begin(), shares.end());
    sum_over_processes(products_of_all, comm);
    const std::vector<double> with_matrix(
      products_of_all.begin() + shares.size(), products_of_all.end());
    products_of_all.resize(shares.size());
    // A direction without energy, like a correction from coarse levels on which
    // nothing can move, is left out.
    const std::vector<double> coefficients =
      best_combination(products_of_all, n);
    if (coefficients.empty())
      return 0;

    combine_owned(v, coefficients[0], coefficients[1], *basis[1]);
    for (unsigned int i = 2; i < n; ++i)
      add_owned(v, coefficients[i], *basis[i]);
    truncation.apply(v.begin());

    // The product of the sum by those of its terms, unless most of these cancel
    // out: if steps are nearly the same, coefficients are large.
    const auto product_of_sum = [&](const std::vector<double> &products,
                                    const bool                 of_sizes) {
      double sum = 0.;
      for (unsigned int i = 0, entry = 0; i < n; ++i)
        {
          ++entry;
          for (unsigned int j = 0; j <= i; ++j)
            {
              const double term = (i == j ? 1. : 2.) * coefficients[i] *
                coefficients[j] * products[entry++];
              sum += of_sizes ? std::abs(term) : term;
            }
        }
      return sum;
    };
    const bool cancels =
      !(product_of_sum(with_matrix, true) <=
        largest_cancellation * product_of_sum(with_matrix, false));
    vAv = cancels ? problem.stiffness.energy_product(v)
                  : product_of_sum(shares, false);
    return n - 1;
  }



  template class Recombination<2>;
  template class Recombination<3>;
} // namespace Friction
