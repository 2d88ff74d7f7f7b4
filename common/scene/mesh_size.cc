#include <common/input_error.h>
#include <common/parallel/memory.h>
#include <common/scene/mesh_size.h>

#include <deal.II/base/types.h>

#include <limits>
#include <sstream>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    // What a run takes at its peak, as measured with fields and estimates; see
    // doc/benchmark.md.
    constexpr double
    bytes_per_dof(const unsigned int dim)
    {
      return dim == 2 ? 1000. : 2500.;
    }



    // p4est numbers the corners of cells by integers of 32 bits, of which its
    // three dimensions leave fewer.
    constexpr unsigned int
    deepest_level(const unsigned int dim)
    {
      return dim == 2 ? 29 : 18;
    }
  } // namespace



  void
  check_that_mesh_fits(const unsigned int dim,
                       const double       n_cells,
                       const unsigned int n_levels,
                       const MPI_Comm     communicator)
  {
    std::ostringstream text;
    text.precision(2);
    if (n_levels > deepest_level(dim))
      {
        text
          << "a cell cannot be refined more than " << deepest_level(dim)
          << " times in " << dim
          << " dimensions; reduce 'Refinement/Levels' or 'Refinement/Initial "
             "refinements'.";
        throw InputError(text.str());
      }

    // A mesh has about as many vertices as cells.
    const bool   is_coarse = n_levels == 0;
    const double n_dofs    = dim * n_cells;
    const double needed    = bytes_per_dof(dim) * n_dofs;
    const double available = memory_within_reach(communicator);
    text << "the " << (is_coarse ? "coarse" : "next") << " mesh would have "
         << n_dofs << " degrees of freedom";
    if (1.2 * n_dofs >
        double(std::numeric_limits<types::global_dof_index>::max()))
      text << ", more than this build of deal.II can number";
    else if (available > 0. && needed > available)
      text << " and need about " << needed / 1e9
           << " GB of memory, of which there are " << available / 1e9;
    else
      return;
    text << (is_coarse
               ? "; give fewer cells in 'Scene/Subdivisions' or "
                 "'Scene/Layers', or a body that is not so long."
               : "; reduce 'Refinement/Maximum dofs', 'Refinement/Levels' or "
                 "'Refinement/Initial refinements', or take more machines.");
    throw InputError(text.str());
  }
} // namespace Friction
