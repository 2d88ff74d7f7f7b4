#include <common/compatibility.h>
#include <common/discretization/mesh_refinement.h>
#include <common/discretization/multilinear_cell.h>
#include <common/parallel/run_clock.h>
#include <common/scene/mesh_size.h>

#include <deal.II/base/geometry_info.h>

#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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



    // Takes vectors to the next mesh where p4est makes it: processes get other
    // cells then.
    template <int dim>
    class DistributedTransfer
    {
    public:
      DistributedTransfer(const DoFHandler<dim>           &dofs,
                          const std::vector<VectorType *> &vectors)
        : transfer(dofs)
      {
        for (VectorType *v : vectors)
          lifts.push_back(lift_above_rounding(*v));
        transfer.prepare_for_coarsening_and_refinement(
          std::vector<const VectorType *>(vectors.begin(), vectors.end()));
      }

      void
      interpolate(const std::vector<VectorType *> &vectors)
      {
        std::vector<VectorType *> interpolated = vectors;
        transfer.interpolate(interpolated);
        for (unsigned int i = 0; i < vectors.size(); ++i)
          vectors[i]->add(-lifts[i]);
      }

    private:
      Compatibility::SolutionTransfer<dim, VectorType> transfer;
      std::vector<double>                              lifts;
    };



    // Takes vectors to the next mesh without p4est. Each cell of the old mesh
    // is still there, refined or not, and is given the values that it had.
    // Degree of freedom dim*v+d of a cell is component d at vertex v.
    template <int dim>
    class UndividedTransfer
    {
    public:
      UndividedTransfer(const DoFHandler<dim>           &dofs,
                        const std::vector<VectorType *> &vectors)
      {
        const Triangulation<dim> &mesh = dofs.get_triangulation();
        AssertDimension(Utilities::MPI::n_mpi_processes(
                          Compatibility::mpi_communicator(mesh)),
                        1);
        AssertDimension(dofs.get_fe().n_dofs_per_cell(), n_values);
        for (unsigned int c = 0; c < n_vertices; ++c)
          for (unsigned int v = 0; v < n_vertices; ++v)
            weights[c][v] = Multilinear::hat_values<dim>(
              GeometryInfo<dim>::child_to_cell_coordinates(
                GeometryInfo<dim>::unit_cell_vertex(v), c));

        cells.reserve(mesh.n_active_cells());
        values.reserve(std::size_t(mesh.n_active_cells()) * vectors.size() *
                       n_values);
        for (const auto &cell : dofs.active_cell_iterators())
          {
            Assert(!cell->coarsen_flag_set(), ExcNotImplemented());
            cells.push_back(cell);
            cell->get_dof_indices(indices);
            for (const VectorType *v : vectors)
              for (const auto i : indices)
                values.push_back(v->local_element(i));
          }
      }

      void
      interpolate(const std::vector<VectorType *> &vectors)
      {
        const double *on_cell = values.data();
        for (const auto &cell : cells)
          {
            if (cell->is_active())
              {
                cell->get_dof_indices(indices);
                for (unsigned int k = 0; k < vectors.size(); ++k)
                  for (unsigned int i = 0; i < n_values; ++i)
                    vectors[k]->local_element(indices[i]) =
                      on_cell[k * n_values + i];
              }
            else
              for (unsigned int c = 0; c < n_vertices; ++c)
                interpolate_to_child(*cell->child(c), c, on_cell, vectors);
            on_cell += vectors.size() * n_values;
          }
      }

    private:
      static constexpr unsigned int n_vertices = 1u << dim;
      static constexpr unsigned int n_values   = n_vertices * dim;

      // Of child c, at its vertex v: what it takes from each vertex of the
      // parent.
      std::array<std::array<std::array<double, n_vertices>, n_vertices>,
                 n_vertices>
        weights;

      // The cells of the old mesh, and the values of each: those of the first
      // vector, then those of the next.
      std::vector<typename DoFHandler<dim>::cell_iterator> cells;
      std::vector<double>                                  values;

      std::vector<types::global_dof_index> indices =
        std::vector<types::global_dof_index>(n_values);

      void
      interpolate_to_child(
        const typename DoFHandler<dim>::cell_iterator::AccessorType &child,
        const unsigned int                                           c,
        const double                                                *on_parent,
        const std::vector<VectorType *>                             &vectors)
      {
        child.get_dof_indices(indices);
        for (VectorType *vector : vectors)
          {
            for (unsigned int v = 0; v < n_vertices; ++v)
              for (unsigned int d = 0; d < dim; ++d)
                {
                  double sum = 0;
                  for (unsigned int parent = 0; parent < n_vertices; ++parent)
                    sum += weights[c][v][parent] * on_parent[parent * dim + d];
                  vector->local_element(indices[v * dim + d]) = sum;
                }
            on_parent += n_values;
          }
      }
    };
  } // namespace



  template <int dim>
  void
  refine_uniformly(Triangulation<dim> &mesh, const unsigned int times)
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
  refine_mesh(Triangulation<dim>              &mesh,
              Discretization<dim>             &discretization,
              const std::vector<VectorType *> &vectors)
  {
    const MPI_Comm communicator = Compatibility::mpi_communicator(mesh);
    const RunScope part(communicator, RunPart::transfer);
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

    const auto refine = [&](auto transfer) {
      {
        const RunScope part_of_mesh(communicator, RunPart::mesh);
        mesh.execute_coarsening_and_refinement();
      }
      discretization.set_up();
      for (VectorType *v : vectors)
        *v = discretization.vector();
      transfer.interpolate(vectors);
    };
    const DoFHandler<dim> &dofs = discretization.dof_handler();
    if (dynamic_cast<parallel::distributed::Triangulation<dim> *>(&mesh) !=
        nullptr)
      refine(DistributedTransfer<dim>(dofs, vectors));
    else
      refine(UndividedTransfer<dim>(dofs, vectors));
  }



  template void refine_uniformly(Triangulation<2> &, const unsigned int);
  template void refine_uniformly(Triangulation<3> &, const unsigned int);
  template void refine_mesh(Triangulation<2> &,
                            Discretization<2> &,
                            const std::vector<VectorType *> &);
  template void refine_mesh(Triangulation<3> &,
                            Discretization<3> &,
                            const std::vector<VectorType *> &);
} // namespace Friction
