#include <common/compatibility.h>
#include <common/discretization/mesh_refinement.h>
#include <common/parallel/run_clock.h>
#include <common/scene/mesh_size.h>

#include <algorithm>
#include <cmath>

namespace Friction
{
  namespace
  {
    // Adds a constant of at least twice the largest value and returns it. In
    // debug mode SolutionTransfer demands that neighbouring cells interpolate
    // the same values, relative to these; where values are nothing but
    // rounding, as those that vanish by symmetry are, they do not. The constant
    // is a power of two, so that it can be taken off again without leaving a
    // trace: zeros stay zeros.
    double
    lift_above_rounding(VectorType &v)
    {
      const double largest = v.linfty_norm();
      const double lift =
        largest > 0 ? std::exp2(std::ceil(std::log2(largest)) + 1.) : 0.;
      v.add(lift);
      v.update_ghost_values();
      return lift;
    }
  } // namespace



  template <int dim>
  void
  refine_uniformly(parallel::distributed::Triangulation<dim> &mesh,
                   const unsigned int                         times)
  {
    if (times == 0)
      return;
    const RunScope part(Compatibility::mpi_communicator(mesh), RunPart::mesh);
    check_that_mesh_fits(dim,
                         mesh.n_global_active_cells() *
                           std::pow(2., dim * times),
                         mesh.n_global_levels() - 1 + times,
                         Compatibility::mpi_communicator(mesh));
    mesh.refine_global(times);
  }



  template <int dim>
  void
  refine_mesh(parallel::distributed::Triangulation<dim> &mesh,
              Discretization<dim>                       &discretization,
              const std::vector<VectorType *>           &vectors)
  {
    const MPI_Comm communicator = Compatibility::mpi_communicator(mesh);
    const RunScope transfer_part(communicator, RunPart::transfer);
    Compatibility::SolutionTransfer<dim, VectorType> transfer(
      discretization.dof_handler());
    std::vector<double> lifts;
    for (VectorType *v : vectors)
      lifts.push_back(lift_above_rounding(*v));
    mesh.prepare_coarsening_and_refinement();

    // Now it is known what the next mesh will be.
    unsigned int n_refined = 0, deepest = 0;
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && cell->refine_flag_set())
        {
          ++n_refined;
          deepest = std::max<unsigned int>(deepest, cell->level() + 1);
        }
    check_that_mesh_fits(
      dim,
      mesh.n_global_active_cells() +
        (std::pow(2., dim) - 1.) *
          Utilities::MPI::sum(double(n_refined), communicator),
      Utilities::MPI::max(deepest, communicator),
      communicator);

    transfer.prepare_for_coarsening_and_refinement(
      std::vector<const VectorType *>(vectors.begin(), vectors.end()));
    {
      const RunScope mesh_part(communicator, RunPart::mesh);
      mesh.execute_coarsening_and_refinement();
    }
    discretization.set_up();
    for (VectorType *v : vectors)
      *v = discretization.vector();
    std::vector<VectorType *> interpolated = vectors;
    transfer.interpolate(interpolated);
    for (unsigned int i = 0; i < vectors.size(); ++i)
      vectors[i]->add(-lifts[i]);
  }



  template void refine_uniformly(parallel::distributed::Triangulation<2> &,
                                 const unsigned int);
  template void refine_uniformly(parallel::distributed::Triangulation<3> &,
                                 const unsigned int);
  template void refine_mesh(parallel::distributed::Triangulation<2> &,
                            Discretization<2> &,
                            const std::vector<VectorType *> &);
  template void refine_mesh(parallel::distributed::Triangulation<3> &,
                            Discretization<3> &,
                            const std::vector<VectorType *> &);
} // namespace Friction
