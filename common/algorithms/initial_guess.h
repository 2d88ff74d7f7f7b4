#ifndef friction_algorithms_initial_guess_h
#define friction_algorithms_initial_guess_h

#include <common/contact/contact_state.h>
#include <common/discretization/discretization.h>

namespace Friction
{
  /**
   * Makes an initial guess out of a displacement and tractions interpolated
   * from a coarser mesh (or of zeros): imposes prescribed values, moves nodes
   * out of the obstacle, and turns normal tractions back into nodal normal
   * forces. Nodes that have come to lie at the obstacle or inside start in
   * contact.
   *
   * Stresses, not forces, are what can be interpolated: forces shrink with the
   * size of the cells.
   *
   * With Tresca's law there is nothing to be guessed: the scene gives the
   * largest tangential stress, and that times the measure of the node is its
   * bound, at open nodes, too.
   */
  template <int dim>
  ContactState make_initial_guess(const Discretization<dim> &discretization,
                                  VectorType                &u,
                                  const VectorType          &tractions);
} // namespace Friction

#endif
