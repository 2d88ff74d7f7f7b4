#include <common/compatibility.h>
#include <common/discretization/mesh_refinement.h>

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
  refine_mesh(parallel::distributed::Triangulation<dim> &mesh,
              Discretization<dim>                       &discretization,
              const std::vector<VectorType *>           &vectors)
  {
    Compatibility::SolutionTransfer<dim, VectorType> transfer(
      discretization.dof_handler());
    std::vector<double> lifts;
    for (VectorType *v : vectors)
      lifts.push_back(lift_above_rounding(*v));
    mesh.prepare_coarsening_and_refinement();
    transfer.prepare_for_coarsening_and_refinement(
      std::vector<const VectorType *>(vectors.begin(), vectors.end()));
    mesh.execute_coarsening_and_refinement();
    discretization.set_up();
    for (VectorType *v : vectors)
      *v = discretization.vector();
    std::vector<VectorType *> interpolated = vectors;
    transfer.interpolate(interpolated);
    for (unsigned int i = 0; i < vectors.size(); ++i)
      vectors[i]->add(-lifts[i]);
  }



  template void refine_mesh(parallel::distributed::Triangulation<2> &,
                            Discretization<2> &,
                            const std::vector<VectorType *> &);
  template void refine_mesh(parallel::distributed::Triangulation<3> &,
                            Discretization<3> &,
                            const std::vector<VectorType *> &);
} // namespace Friction
