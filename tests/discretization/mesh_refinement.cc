// One process has a mesh without p4est, if it needs no checkpoints. Refined by
// refine_mesh() with the same flags, it has the same cells and levels as one
// with p4est, and vectors have the same values on it, up to rounding.

#include <common/discretization/mesh_refinement.h>
#include <common/parameters/scene_file.h>

#include <deal.II/distributed/tria.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_mesh_refinement
{
  // A scene on a mesh with p4est or without.
  template <int dim>
  struct Refined
  {
    Refined(const Scene<dim> &scene, const bool for_checkpoints)
      : mesh(make_triangulation<dim>(MPI_COMM_WORLD, for_checkpoints))
      , discretization(scene, *mesh)
    {
      scene.make_coarse_mesh(*mesh);
      refine_uniformly(*mesh, 1);
      discretization.set_up();
      u = v = discretization.vector();
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        {
          const double x     = points()[i / dim][i % dim];
          u.local_element(i) = std::sin(3. * x) + 1e-6 * i;
          v.local_element(i) = std::exp(x);
        }
      u.update_ghost_values();
      v.update_ghost_values();
    }

    std::vector<Point<dim>>
    points() const
    {
      return node_points(discretization);
    }

    // Flags cells here and there.
    void
    refine()
    {
      for (const auto &cell : mesh->active_cell_iterators())
        {
          double place = 0;
          for (unsigned int d = 0; d < dim; ++d)
            place += (1. + d) * cell->center()[d];
          if (std::sin(1e3 * place) > .3)
            cell->set_refine_flag();
        }
      refine_mesh(*mesh, discretization, {&u, &v});
      discretization.interpolate_hanging_nodes(u);
      discretization.interpolate_hanging_nodes(v);
    }

    std::unique_ptr<Triangulation<dim>> mesh;
    Discretization<dim>                 discretization;
    VectorType                          u, v;
  };



  template <int dim>
  void
  test(const std::string &scene_file)
  {
    std::cout << dim << "D" << std::endl;
    const Scene<dim> scene(read_parameters(scene_file, {}));
    Refined<dim>     one(scene, false), other(scene, true);
    const auto       has_p4est = [](const Refined<dim> &refined) {
      return dynamic_cast<parallel::distributed::Triangulation<dim> *>(
               refined.mesh.get()) != nullptr;
    };
    check(!has_p4est(one) && has_p4est(other),
          "p4est is there for checkpoints only");

    bool         same = true, same_numbers = true, same_nodes = true;
    double       distance  = 0;
    unsigned int n_hanging = 0;
    for (unsigned int round = 0; round < (dim == 2 ? 3 : 2); ++round)
      {
        one.refine();
        other.refine();
        auto its = other.mesh->begin();
        for (const auto &cell : one.mesh->cell_iterators())
          {
            same = same && its != other.mesh->end() &&
              cell->level() == its->level() &&
              cell->is_active() == its->is_active() &&
              cell->center().distance(its->center()) < 1e-13;
            if (!same)
              break;
            ++its;
          }
        same_numbers = same_numbers &&
          one.mesh->n_global_active_cells() ==
            other.mesh->n_global_active_cells() &&
          one.mesh->n_global_levels() == other.mesh->n_global_levels();
        for (unsigned int level = 0; level < one.mesh->n_levels(); ++level)
          same_numbers = same_numbers &&
            one.discretization.dof_handler().n_dofs(level) ==
              other.discretization.dof_handler().n_dofs(level);
        const auto points = one.points(), others = other.points();
        same_nodes = same_nodes && points.size() == others.size();
        if (same_nodes)
          for (unsigned int i = 0; i < one.u.locally_owned_size(); ++i)
            {
              distance = std::max(
                {distance,
                 points[i / dim].distance(others[i / dim]),
                 std::abs(one.u.local_element(i) - other.u.local_element(i)),
                 std::abs(one.v.local_element(i) - other.v.local_element(i))});
            }
        for (unsigned int node = 0;
             node < one.discretization.constraints().n_owned_nodes();
             ++node)
          n_hanging += one.discretization.constraints().is_hanging(node);
      }
    check(n_hanging > 10, "there are hanging nodes");
    check(same, "the same cells in the same order");
    check(same_numbers, "as many cells, levels and degrees of freedom");
    check(same_nodes, "as many nodes");
    check_below(distance, 1e-13, "in the same order, with the same values");
  }
} // namespace test_mesh_refinement



TEST(mesh_refinement)
{
  test<2>(SCENES_DIR "/hertz.prm");
  test<3>(SCENES_3D_DIR "/cylinder.prm");
}
