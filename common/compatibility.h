#ifndef friction_compatibility_h
#define friction_compatibility_h

// Everything that differs between deal.II 9.4.1 and later releases is gathered
// in this one header, so that no other file needs a version check.

#include <deal.II/base/config.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <deal.II/grid/tria.h>

#if DEAL_II_VERSION_GTE(9, 7, 0)
#  include <deal.II/numerics/solution_transfer.h>
#else
#  include <deal.II/distributed/solution_transfer.h>
#endif

#include <deal.II/lac/affine_constraints.h>

#include <deal.II/multigrid/mg_transfer_matrix_free.h>

namespace Friction
{
  namespace Compatibility
  {
    /**
     * The communicator of a triangulation, DoFHandler or vector. The member
     * function was renamed in deal.II 9.7.
     */
    template <typename Object>
    MPI_Comm
    mpi_communicator(const Object &object)
    {
#if DEAL_II_VERSION_GTE(9, 7, 0)
      return object.get_mpi_communicator();
#else
      return object.get_communicator();
#endif
    }

    /**
     * A triangulation of one process, which all cells belong to, with the
     * communicator of that process in place of MPI_COMM_SELF.
     */
    template <int dim>
    class UndividedTriangulation : public dealii::Triangulation<dim>
    {
    public:
      using MeshSmoothing = typename dealii::Triangulation<dim>::MeshSmoothing;

      UndividedTriangulation(const MPI_Comm      communicator,
                             const MeshSmoothing smoothing)
        : dealii::Triangulation<dim>(smoothing)
        , communicator(communicator)
      {
        AssertDimension(dealii::Utilities::MPI::n_mpi_processes(communicator),
                        1);
      }

      MPI_Comm
#if DEAL_II_VERSION_GTE(9, 7, 0)
      get_mpi_communicator() const override
#else
      get_communicator() const override
#endif
      {
        return communicator;
      }

    private:
      const MPI_Comm communicator;
    };

    /**
     * What functions of deal.II's Trilinos matrices take: a reference before
     * deal.II 9.5.
     */
#if DEAL_II_VERSION_GTE(9, 5, 0)
    using CommunicatorOfTrilinos = const MPI_Comm;
#else
    using CommunicatorOfTrilinos = const MPI_Comm &;
#endif

    /**
     * What carries nodal vectors from a mesh to its refinement, also if both
     * are distributed over processes. In deal.II 9.7 there is one class for
     * all meshes; the one for distributed ones is on its way out.
     */
#if DEAL_II_VERSION_GTE(9, 7, 0)
    template <int dim, typename VectorType>
    using SolutionTransfer = dealii::SolutionTransfer<dim, VectorType>;
#else
    template <int dim, typename VectorType>
    using SolutionTransfer =
      dealii::parallel::distributed::SolutionTransfer<dim, VectorType>;
#endif

    /**
     * deal.II's transfer between levels, without what it prepares for copies
     * between the mesh and all levels, copy_to_mg() and copy_from_mg(): twice a
     * vector of the mesh and where each of its numbers is on the levels, and
     * before deal.II 9.6 vectors of all levels. What prolongates and restricts
     * does not need them.
     */
    template <int dim>
    class TransferWithoutCopies
      : public dealii::MGTransferMatrixFree<dim, double>
    {
    public:
      /** To be called after build(). There can be no copies after that. */
      void
      release_copies()
      {
        this->copy_indices.clear();
        this->solution_copy_indices.clear();
        this->ghosted_global_vector.reinit(0);
        this->solution_ghosted_global_vector.reinit(0);
#if !DEAL_II_VERSION_GTE(9, 6, 0)
        this->solution_ghosted_level_vector.resize(0, 0);
#endif
      }
    };

    /**
     * An empty set of constraints for the locally relevant degrees of freedom.
     * Since deal.II 9.6 the locally owned ones are wanted as well.
     */
    inline dealii::AffineConstraints<double>
    make_constraints(const dealii::IndexSet &locally_owned,
                     const dealii::IndexSet &locally_relevant)
    {
#if DEAL_II_VERSION_GTE(9, 6, 0)
      return dealii::AffineConstraints<double>(locally_owned, locally_relevant);
#else
      (void)locally_owned;
      return dealii::AffineConstraints<double>(locally_relevant);
#endif
    }
  } // namespace Compatibility
} // namespace Friction

#endif
