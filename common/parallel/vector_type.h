#ifndef friction_parallel_vector_type_h
#define friction_parallel_vector_type_h

#include <deal.II/lac/la_parallel_vector.h>

namespace Friction
{
  /** The vectors of the leaf mesh and of all levels. */
  using VectorType = dealii::LinearAlgebra::distributed::Vector<double>;
} // namespace Friction

#endif
