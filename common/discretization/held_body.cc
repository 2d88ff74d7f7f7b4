#include <common/discretization/held_body.h>
#include <common/input_error.h>
#include <common/parallel/reductions.h>
#include <common/scene/rigid_motions.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <map>
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

    // For each contact node the normals of the faces around it, whatever their
    // boundary id. Faces are straight here: where they are to be round, the
    // body could roll on them.
    template <int dim>
    std::map<unsigned int, std::vector<Tensor<1, dim>>>
    normals_of_faces(const Discretization<dim> &discretization)
    {
      std::map<unsigned int, std::vector<Tensor<1, dim>>> normals;
      for (const ContactNode<dim> &p : discretization.contact())
        normals[p.node];
      const FE_Q<dim>   element(1);
      FEFaceValues<dim> values(
        element, QMidpoint<dim - 1>(), update_normal_vectors);
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (!cell->is_artificial() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            if (cell->at_boundary(f))
              {
                bool is_known = false;
                for (unsigned int v = 0; v < cell->face(f)->n_vertices(); ++v)
                  {
                    const auto found =
                      normals.find(discretization.constraints().node_of_dof(
                        cell->vertex_dof_index(
                          GeometryInfo<dim>::face_to_cell_vertices(f, v), 0)));
                    if (found == normals.end())
                      continue;
                    if (!is_known)
                      values.reinit(
                        typename Triangulation<dim>::cell_iterator(cell), f);
                    is_known = true;
                    found->second.push_back(values.normal_vector(0));
                  }
              }
      return normals;
    }



    // For each contact node the direction in which the other one of the two
    // surfaces can take up a pressure, if the normals of the problem are those
    // of the one: that of the obstacle straight towards it, or of the body, in
    // a corner or at an edge of it, that which is nearest to the normal.
    template <int dim>
    std::vector<Tensor<1, dim>>
    normals_of_other_surface(const Discretization<dim> &discretization)
    {
      std::vector<Tensor<1, dim>> result;
      const Scene<dim>           &scene      = discretization.scene();
      const auto                 &conditions = scene.contact_conditions();
      std::map<unsigned int, std::vector<Tensor<1, dim>>> normals;
      if (std::any_of(conditions.begin(), conditions.end(), [](const auto &c) {
            return c.normal == ContactNormal::obstacle;
          }))
        normals = normals_of_faces(discretization);
      for (const ContactNode<dim> &p : discretization.contact())
        {
          const ContactCondition<dim> &condition = conditions[p.condition];
          if (condition.normal == ContactNormal::body)
            {
              result.push_back(
                condition.obstacle.empty()
                  ? p.normal()
                  : condition.obstacle.normal(p.point, p.normal()));
              continue;
            }
          const auto &around = normals.at(p.node);
          if (std::any_of(
                around.begin(), around.end(), [&](const Tensor<1, dim> &n) {
                  return (n - p.normal()).norm() < 1e-12;
                }))
            {
              result.push_back(p.normal());
              continue;
            }
          Eigen::VectorXd v(dim);
          Eigen::MatrixXd rays(dim, around.size());
          for (unsigned int d = 0; d < dim; ++d)
            {
              v[d] = p.normal()[d];
              for (unsigned int i = 0; i < around.size(); ++i)
                rays(d, i) = around[i][d];
            }
          const Eigen::VectorXd nearest = nearest_in_cone(v, rays);
          Tensor<1, dim>        normal;
          for (unsigned int d = 0; d < dim; ++d)
            normal[d] = nearest[d];
          result.push_back(normal);
        }
      return result;
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
    const std::vector<Tensor<1, dim>> other_normals =
      normals_of_other_surface(discretization);
    double difference = 0;
    for (unsigned int p = 0; p < discretization.contact().size(); ++p)
      difference = std::max(
        difference,
        (discretization.contact()[p].normal() - other_normals[p]).norm());
    const bool other_normals_differ =
      max_over_processes(difference, communicator) > 1e-12;

    for (const FreePart<dim> &part : parts)
      {
        const unsigned int  k = part.motions.cols();
        std::vector<double> work(k, 0.);
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
        // All processes come to the same conclusion.
        sum_over_processes(work, communicator);
        const Eigen::VectorXd loads =
          Eigen::Map<const Eigen::VectorXd>(work.data(), k);

        for (const bool of_problem : {true, false})
          {
            if (!of_problem && !other_normals_differ)
              continue;
            std::vector<double> displacements;
            for (unsigned int p = 0; p < discretization.contact().size(); ++p)
              {
                const ContactNode<dim> &node = discretization.contact()[p];
                if (part_of_node[node.node] != part.number)
                  continue;
                const Eigen::MatrixXd motions =
                  part.displacements_at(node.point);
                const Tensor<1, dim> &normal =
                  of_problem ? node.normal() : other_normals[p];
                for (unsigned int i = 0; i < k; ++i)
                  {
                    double sum = 0;
                    for (unsigned int d = 0; d < dim; ++d)
                      sum += motions(d, i) * normal[d];
                    displacements.push_back(sum);
                  }
              }
            const std::vector<double> of_all =
              gather_from_all(displacements, communicator);
            const Eigen::MatrixXd contact = Eigen::Map<const Eigen::MatrixXd>(
              of_all.data(), k, of_all.size() / k);

            const Holding holding = held_by_contact(loads, contact);
            if (holding.motion.size() == 0)
              continue;
            const auto is_stopped = [&](const Eigen::VectorXd &motion) {
              return held_by_contact(motion.transpose() * loads,
                                     motion.transpose() * contact)
                       .motion.size() == 0;
            };
            throw InputError(scene.subject_at_time() +
                             not_held<dim>(scene, part, holding, is_stopped));
          }
      }
  }



  template void check_that_body_is_held(const Discretization<2> &);
  template void check_that_body_is_held(const Discretization<3> &);
} // namespace Friction
