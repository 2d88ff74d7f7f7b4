#ifndef friction_estimate_exact_error_h
#define friction_estimate_exact_error_h

#include <common/parallel/vector_type.h>
#include <common/scene/materials.h>

#include <deal.II/base/function.h>

#include <deal.II/dofs/dof_handler.h>

#include <deal.II/fe/mapping.h>

#include <string>

namespace Friction
{
  /** By how much a solution differs from the exact one. */
  struct ExactError
  {
    double energy;    ///< energy norm of the difference
    double node;      ///< largest error of a component at a node
    double node_size; ///< largest component at a node

    /** Exact at the nodes up to rounding and the tolerance of the solver, as
     * in a patch test. */
    bool is_exact() const;

    /**
     * A line for the console.
     * @param last_energy  the energy error on a mesh of twice the width, for
     *                     the order of convergence; zero if there is none.
     */
    std::string describe(const double last_energy) const;
  };

  /**
   * Measures the error against the exact displacement. The energy norm, which
   * the method minimises, is integrated by a quadrature formula that is good
   * enough for solutions that are only piecewise smooth.
   *
   * @param displacement  with ghost values and hanging nodes interpolated.
   */
  template <int dim>
  ExactError compute_exact_error(const dealii::Mapping<dim>    &mapping,
                                 const dealii::DoFHandler<dim> &dof_handler,
                                 const Materials<dim>          &materials,
                                 const dealii::Function<dim>   &exact,
                                 const VectorType              &displacement);
} // namespace Friction

#endif
