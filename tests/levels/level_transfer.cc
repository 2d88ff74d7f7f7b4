// What deal.II's transfer does between levels is what the weights of the level
// hierarchy say, from which the Galerkin products are made: its interpolation
// gives the same values at all nodes, on any number of processes, and its
// restriction is the transpose of that. So it is between the finest level and
// the leaf mesh, and between any other level and the leaf nodes that are its
// own. The meshes have hanging nodes, on curved boundaries as well. On others
// the finest level and the leaf mesh are the same.

#include <common/levels/level_hierarchy.h>
#include <common/levels/level_transfer.h>
#include <common/parallel/ghost_exchange.h>
#include <common/scene/scene.h>

#include <cmath>
#include <iostream>

#include <tests/support/check.h>
#include <tests/support/discretized.h>
#include <tests/support/test.h>

using namespace Tests;

namespace test_level_transfer
{
  // The same on any number of processes.
  void
  fill(VectorType &v, const double frequency)
  {
    for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
      v.local_element(i) =
        std::sin(frequency * (1. + v.get_partitioner()->local_to_global(i)));
  }



  // <a, b> as a part of |a| |b|, minus the same of c and d.
  double
  difference(const VectorType &a,
             const VectorType &b,
             const VectorType &c,
             const VectorType &d)
  {
    return std::abs(a * b - c * d) / (a.l2_norm() * b.l2_norm());
  }



  template <int dim>
  void
  test(const std::string &scene_name)
  {
    const Scene<dim> scene(read_parameters(
      (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") + scene_name, {}));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(1);
    for (unsigned int i = 0; i < 5 - dim; ++i)
      {
        for (const auto &cell : mesh->active_cell_iterators())
          if (cell->is_locally_owned() &&
              (cell->center()[0] > .2 ||
               cell->center()[dim - 1] < -.8 + .1 * i))
            cell->set_refine_flag();
        mesh->execute_coarsening_and_refinement();
      }
    const Discretized<dim>    d(scene, *mesh);
    const LevelHierarchy<dim> hierarchy(
      d.dof_handler(), d.constraints(), d.stiffness().blocks());
    const LevelTransfer<dim> transfer(
      d.dof_handler(), hierarchy, d.constraints());

    const unsigned int n = hierarchy.n_levels();
    double interpolation = 0, transposed = 0, leaf_interpolation = 0,
           leaf_transposed = 0, own_transposed = 0, n_ghosts = 0;
    for (unsigned int k = 1; k < n; ++k)
      {
        const auto &fine = hierarchy.level(k), &coarse = hierarchy.level(k - 1);
        VectorType  from(coarse.partitioner()), restricted(from), ghosted(from);
        fill(from, 1.3);
        ghosted.copy_locally_owned_data_from(from);
        GhostExchange(coarse.numbering(), coarse.transfer_ghosts())
          .update(ghosted.begin(), dim);
        n_ghosts += coarse.transfer_ghosts().size();
        const auto interpolated = [&](const unsigned int node,
                                      const unsigned int c) {
          double value = 0;
          for (auto p = fine.parents().begin(node);
               p != fine.parents().end(node);
               ++p)
            value += p->weight * ghosted.begin()[dim * p->node + c];
          return value;
        };

        if (k + 1 < n)
          {
            VectorType to(fine.partitioner()), prolonged(to);
            fill(to, .7);
            prolonged = 0.;
            transfer.prolongate_and_add(k, prolonged, from);
            for (unsigned int i = 0; i < fine.n_nodes(); ++i)
              for (unsigned int c = 0; c < dim; ++c)
                interpolation =
                  std::max(interpolation,
                           std::abs(interpolated(i, c) -
                                    prolonged.local_element(dim * i + c)));
            restricted = 0.;
            transfer.restrict_and_add(k, restricted, to);
            transposed =
              std::max(transposed, difference(from, restricted, prolonged, to));

            VectorType leaf = d.vector(), back(leaf), level(to);
            leaf            = 0.;
            back            = 0.;
            level           = 0.;
            for (const auto &own : fine.own_nodes())
              for (unsigned int c = 0; c < dim; ++c)
                leaf.local_element(dim * own.leaf.number() + c) =
                  std::cos(own.leaf.number() + c);
            transfer.add_from_leaf(k, level, leaf);
            transfer.copy_to_leaf(k, back, to);
            if (leaf.l2_norm() > 0)
              own_transposed =
                std::max(own_transposed, difference(leaf, back, level, to));
          }
        else
          {
            VectorType prolonged = d.vector(), leaf(prolonged);
            prolonged            = 0.;
            leaf                 = 0.;
            transfer.prolongate_to_leaf(prolonged, from);
            for (const auto &own : fine.own_nodes())
              for (unsigned int c = 0; c < dim; ++c)
                {
                  const unsigned int i  = dim * own.leaf.number() + c;
                  leaf.local_element(i) = std::cos(i);
                  leaf_interpolation =
                    std::max(leaf_interpolation,
                             own.node < fine.n_nodes()
                               ? std::abs(interpolated(own.node, c) -
                                          prolonged.local_element(i))
                               : 0.);
                }
            restricted = 0.;
            transfer.restrict_from_leaf(restricted, leaf);
            leaf_transposed = difference(from, restricted, prolonged, leaf);
          }
      }
    const double largest = Utilities::MPI::max(
      std::max(interpolation, leaf_interpolation), MPI_COMM_WORLD);
    n_ghosts = Utilities::MPI::sum(n_ghosts, MPI_COMM_WORLD);
    check_everywhere(n > 3 &&
                       (n_ghosts > 0) ==
                         (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1),
                     scene_name + ": several levels, of all processes");
    check_everywhere(largest < 1e-14, "interpolation is that of the weights");
    check_everywhere(transposed < 1e-14, "restriction is its transpose");
    check_everywhere(leaf_transposed < 1e-14, "and from the leaf mesh, too");
    check_everywhere(own_transposed < 1e-14,
                     "corrections of own nodes come back the way of residuals");
  }



  // Without local refinement the nodes of the finest level have the numbers of
  // those of the leaf mesh, in contact or not. Then nothing needs to be copied.
  template <int dim>
  void
  test_uniform(const std::string &scene_name)
  {
    const Scene<dim> scene(read_parameters(
      (dim == 2 ? SCENES_DIR "/" : SCENES_3D_DIR "/") + scene_name, {}));
    const auto       mesh = make_triangulation<dim>();
    scene.make_coarse_mesh(*mesh);
    mesh->refine_global(5 - dim);
    const Discretized<dim>    d(scene, *mesh);
    const LevelHierarchy<dim> hierarchy(
      d.dof_handler(), d.constraints(), d.stiffness().blocks());
    const auto  &finest      = hierarchy.level(hierarchy.n_levels() - 1);
    unsigned int n_different = 0;
    for (const auto &own : finest.own_nodes())
      n_different += own.node != own.leaf.number();
    check_everywhere(Utilities::MPI::sum(d.contact().size(), MPI_COMM_WORLD) >
                       0,
                     "contact on the uniform mesh of " + scene_name);
    check_everywhere(n_different == 0 &&
                       finest.own_nodes().size() == finest.n_nodes() &&
                       finest.n_nodes() == d.constraints().n_owned_nodes(),
                     "its finest level is the leaf mesh, node by node");
  }
} // namespace test_level_transfer



TEST(level_transfer)
{
  test<2>("hertz.prm");
  test<3>("half-ball.prm");
  test_uniform<2>("hertz.prm");
  test_uniform<3>("block.prm");
}
