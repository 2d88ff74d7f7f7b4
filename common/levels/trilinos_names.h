#ifndef friction_levels_trilinos_names_h
#define friction_levels_trilinos_names_h

// Classes that other headers name only, so that a file which includes them need
// not know Trilinos. In a deal.II whose Trilinos is without Epetra these are no
// classes; it could not solve what is solved with them here either.
namespace dealii
{
  namespace TrilinosWrappers
  {
    class PreconditionAMG;
    class SolverDirect;
    class SparseMatrix;
  } // namespace TrilinosWrappers
} // namespace dealii

#endif
