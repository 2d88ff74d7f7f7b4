#ifndef friction_levels_elimination_cost_h
#define friction_levels_elimination_cost_h

#include <common/levels/trilinos_names.h>

namespace Friction
{
  /**
   * About how many multiplications it takes to factorise a sparse symmetric
   * matrix, if its nodes are eliminated layer by layer: a layer is what is as
   * many couplings away from a node at one end of the body. A layer of $w_l$
   * unknowns is coupled to the $w_{l+1}$ of the next one only, so that it takes
   * $w_l(w_l+w_{l+1})^2$. For long and thin bodies this is next to nothing,
   * however many unknowns there are; for bodies that are as wide as long no
   * more than an upper bound, which other orders of elimination stay below.
   *
   * The layers are those of Cuthill and McKee (1969), from a node that is as
   * far from all others as George and Liu's search finds one (1979).
   *
   * @param matrix        its rows may be owned by any of the processes, in the
   *                      order of their ranks; all components of a node by the
   *                      same one
   * @param n_components  of a node: component c of node i has the number
   *                      n_components * i + c
   * @return the same number on all processes. Collective: each process gets the
   * graph of all nodes.
   */
  double elimination_cost(const dealii::TrilinosWrappers::SparseMatrix &matrix,
                          const unsigned int n_components);
} // namespace Friction

#endif
