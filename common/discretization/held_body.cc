#include <common/discretization/held_body.h>
#include <common/input_error.h>
#include <common/scene/rigid_motions.h>

#include <deal.II/base/mpi.h>

#include <string>
#include <vector>

namespace Friction
{
  namespace
  {
    // For each node that the process owns a part that it belongs to, and where
    // it is. In a vertex in which parts meet it is one of them.
    template <int dim>
    void
    find_nodes(const Discretization<dim>       &discretization,
               const std::vector<unsigned int> &part_of_cell,
               std::vector<unsigned int>       &part_of_node,
               std::vector<Point<dim>>         &points)
    {
      const NodalConstraints<dim> &constraints = discretization.constraints();
      part_of_node.assign(constraints.n_owned_nodes(),
                          numbers::invalid_unsigned_int);
      points.resize(constraints.n_owned_nodes());
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            typename Triangulation<dim>::cell_iterator ancestor = cell;
            while (ancestor->level() > 0)
              ancestor = ancestor->parent();
            for (const unsigned int v : cell->vertex_indices())
              {
                const unsigned int node =
                  constraints.node_of_dof(cell->vertex_dof_index(v, 0));
                if (node < constraints.n_owned_nodes())
                  {
                    part_of_node[node] = part_of_cell[ancestor->index()];
                    points[node]       = cell->vertex(v);
                  }
              }
          }
    }
  } // namespace



  template <int dim>
  void
  check_that_body_is_held(const Discretization<dim> &discretization)
  {
    const Scene<dim>                &scene = discretization.scene();
    std::vector<unsigned int>        part_of_cell;
    const std::vector<FreePart<dim>> parts = free_parts(
      scene, discretization.dof_handler().get_triangulation(), part_of_cell);
    if (parts.empty())
      return;

    const NodalConstraints<dim> &constraints  = discretization.constraints();
    const MPI_Comm               communicator = constraints.communicator();
    const VectorType            &forces       = discretization.loads();
    std::vector<unsigned int>    part_of_node;
    std::vector<Point<dim>>      points;
    find_nodes(discretization, part_of_cell, part_of_node, points);

    for (const FreePart<dim> &part : parts)
      {
        const unsigned int  k = part.motions.cols();
        std::vector<double> work(k, 0.), normals;
        for (unsigned int node = 0; node < part_of_node.size(); ++node)
          if (part_of_node[node] == part.number)
            {
              const Eigen::MatrixXd motions =
                part.displacements_at(points[node]);
              for (unsigned int i = 0; i < k; ++i)
                for (unsigned int d = 0; d < dim; ++d)
                  work[i] +=
                    motions(d, i) * forces.local_element(dim * node + d);
            }
        for (const ContactNode<dim> &p : discretization.contact())
          if (part_of_node[p.node] == part.number)
            {
              const Eigen::MatrixXd motions = part.displacements_at(p.point);
              for (unsigned int i = 0; i < k; ++i)
                {
                  double normal = 0;
                  for (unsigned int d = 0; d < dim; ++d)
                    normal += motions(d, i) * p.normal()[d];
                  normals.push_back(normal);
                }
            }

        // All processes come to the same conclusion.
        work = [&]() {
          std::vector<double> sums(k);
          Utilities::MPI::sum(work, communicator, sums);
          return sums;
        }();
        std::vector<double> all_normals;
        for (const auto &some :
             Utilities::MPI::all_gather(communicator, normals))
          all_normals.insert(all_normals.end(), some.begin(), some.end());
        const Eigen::VectorXd loads =
          Eigen::Map<const Eigen::VectorXd>(work.data(), k);
        const Eigen::MatrixXd contact = Eigen::Map<const Eigen::MatrixXd>(
          all_normals.data(), k, all_normals.size() / k);

        const Holding holding = held_by_contact(loads, contact);
        if (holding.motion.size() == 0)
          continue;
        const auto is_stopped = [&](const Eigen::VectorXd &motion) {
          return held_by_contact(motion.transpose() * loads,
                                 motion.transpose() * contact)
                   .motion.size() == 0;
        };
        throw InputError(not_held<dim>(scene, part, holding, is_stopped));
      }
  }



  template void check_that_body_is_held(const Discretization<2> &);
  template void check_that_body_is_held(const Discretization<3> &);
} // namespace Friction
