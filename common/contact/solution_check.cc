#include <common/contact/contact_forces.h>
#include <common/contact/force_balance.h>
#include <common/contact/solution_check.h>
#include <common/parallel/reductions.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace Friction
{
  namespace
  {
    // Loads of a history that have been taken away leave this part of the
    // largest stiffness times the displacements before, and loads that are zero
    // but for rounding may be this part of what holds the body.
    constexpr double rounding_of_loads = 1e-12, least_load = 1e-10;

    // At each node in contact a force may be this part of the largest stiffness
    // times the largest displacement, and nothing but rounding.
    constexpr double rounding_of_contact = 1e-14;

    // Parts of what holds the body that forces count as at least, if there are
    // loads, and if there are none: a contact that is lighter barely touches.
    constexpr double barely_loaded = 1e-5, barely_touching = 1e-3;

    // Forces that balance no better than this are none.
    constexpr double poorest = 1. / 3;

    // The sum of the rounding errors of all nodes is this many times what it is
    // if they are independent, at most.
    constexpr double worst_rounding = 1e3;



    // Sums over nodes of the norms of forces, and how many nodes there are.
    struct Sizes
    {
      double loads = 0., contact = 0., reactions = 0., n_contact = 0.,
             n_nodes = 0.;
    };



    template <int dim>
    Sizes
    sizes_of_forces(const Discretization<dim> &discretization,
                    const VectorType          &residual,
                    const ContactState        &state)
    {
      const NodalConstraints<dim> &constraints = discretization.constraints();
      const auto                  &contact     = discretization.contact();
      std::array<double, 5>        sums{};
      for (unsigned int p = 0; p < contact.size(); ++p)
        if (state.in_contact(p))
          {
            sums[1] += contact_force(contact[p], residual).norm();
            sums[3] += 1.;
          }
      for (unsigned int node = 0; node < constraints.n_owned_nodes(); ++node)
        if (!constraints.is_hanging(node))
          {
            double load = 0., reaction = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const unsigned int i = dim * node + d;
                const double       f = discretization.loads().local_element(i);
                const double       r = residual.local_element(i);
                load += f * f;
                if (constraints.is_prescribed(node, d))
                  reaction += r * r;
              }
            sums[0] += std::sqrt(load);
            sums[2] += std::sqrt(reaction);
            sums[4] += 1.;
          }
      sums = sum_over_processes(sums, constraints.communicator());
      return {sums[0], sums[1], sums[2], sums[3], sums[4]};
    }



    // What is wanted of platens at the present time.
    template <int dim>
    double
    forces_of_platens(const Scene<dim> &scene)
    {
      double sum = 0.;
      for (const auto &condition : scene.dirichlet_conditions())
        if (condition.platen != nullptr)
          for (unsigned int d = 0; d < dim; ++d)
            if (condition.platen->is_controlled[d])
              sum += std::abs(condition.platen->force->value(Point<dim>(), d));
      return sum;
    }



    // The size of what acts on the body; zero if nothing does.
    double
    size_of_causes(const Sizes &sizes,
                   const double platens,
                   const double negligible_load,
                   const double negligible_contact)
    {
      const double loads =
        sizes.loads > std::max(negligible_load, least_load * sizes.reactions)
        ? sizes.loads
        : 0.;
      if (loads > 0. || platens > 0.)
        return std::max(
          {loads, platens, sizes.contact, barely_loaded * sizes.reactions});
      return sizes.contact > std::max(negligible_load, negligible_contact)
        ? std::max(sizes.contact, barely_touching * sizes.reactions)
        : 0.;
    }
  } // namespace



  template <int dim>
  SolutionCheck
  check_solution(const Discretization<dim> &discretization,
                 const VectorType          &displacement,
                 const ContactState        &state,
                 const double               tolerance)
  {
    const double length = displacement.linfty_norm();
    if (!(length <= 1e3 * discretization.body_size()))
      return {false,
              "the body would move by more than a thousand times its size; are "
              "the loads in the units of the stiffness, and is it held well "
              "enough?"};

    VectorType residual = discretization.vector();
    discretization.stiffness().residual(
      residual, discretization.loads(), displacement);
    const double missing = force_balance(discretization, residual).sum().norm();
    const Sizes  sizes   = sizes_of_forces(discretization, residual, state);
    const double stiffness = discretization.largest_stiffness();
    const double before    = discretization.slip_origin() == nullptr
         ? 0.
         : discretization.slip_origin()->linfty_norm();
    const double size      = size_of_causes(
      sizes,
      forces_of_platens(discretization.scene()),
      rounding_of_loads * stiffness * before,
      rounding_of_contact * stiffness * length * sizes.n_contact);
    if (size == 0. || missing <= std::min(10. * tolerance, poorest) * size)
      return {};

    // What rounding explains, no iteration can make less.
    const double rounding =
      worst_rounding * 1e-16 * std::sqrt(sizes.n_nodes) * stiffness * length;
    const bool is_lost = missing <= rounding &&
      missing > std::min(100. * tolerance, poorest) * size;
    std::ostringstream text;
    text.precision(1);
    text << std::scientific << "forces on the body balance to "
         << missing / size << " of their size only"
         << (missing <= rounding
               ? ": they are as small as rounding errors of the forces between "
                 "cells, as in bodies much longer than thick, or with "
                 "materials that are too far apart."
               : "; a smaller 'Solver/Inner tolerance' makes them more exact.");
    return {!is_lost, text.str()};
  }



  template SolutionCheck check_solution(const Discretization<2> &,
                                        const VectorType &,
                                        const ContactState &,
                                        const double);
  template SolutionCheck check_solution(const Discretization<3> &,
                                        const VectorType &,
                                        const ContactState &,
                                        const double);
} // namespace Friction
