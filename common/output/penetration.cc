#include <common/input_error.h>
#include <common/output/penetration.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace Friction
{
  template <int dim>
  double
  depth_in(const Obstacle<dim>  &obstacle,
           const Point<dim>     &p,
           const Tensor<1, dim> &outward)
  {
    try
      {
        const double gap = obstacle.gap(p, obstacle.normal(p, outward));
        return std::isfinite(gap) ? -gap : 0.;
      }
    catch (const InputError &)
      {
        return 0.;
      }
  }



  template <int dim>
  Depth<dim>
  depth_of_other_nodes(const Discretization<dim> &discretization,
                       const VectorType          *displacement)
  {
    const Scene<dim>            &scene = discretization.scene();
    const NodalConstraints<dim> &nodes = discretization.constraints();
    const double                 size  = discretization.body_size();
    struct BoundaryNode
    {
      Point<dim>                              point;
      std::set<const ContactCondition<dim> *> conditions;
    };
    std::map<unsigned int, BoundaryNode> boundary;
    std::vector<char>                    is_contact(nodes.n_nodes(), 0);
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              const ContactCondition<dim> *condition =
                scene.contact_on(cell->face(f)->boundary_id());
              if (displacement == nullptr && condition == nullptr)
                continue;
              for (const unsigned int v : cell->face(f)->vertex_indices())
                {
                  BoundaryNode &node = boundary[nodes.node_of_dof(
                    cell->face(f)->vertex_dof_index(v, 0))];
                  node.point         = cell->face(f)->vertex(v);
                  node.conditions.insert(condition);
                }
            }
    // Where none of the nodes can touch, other warnings say so.
    std::vector<unsigned int> n_nodes(scene.contact_conditions().size(), 0);
    for (const ContactNode<dim> &p : discretization.contact())
      {
        is_contact[p.node] = 1;
        ++n_nodes[p.condition];
      }
    for (unsigned int &n : n_nodes)
      n = Utilities::MPI::sum(n, nodes.communicator());

    // Nodes of the contact boundary that are prescribed have been looked at
    // when the mesh was set up, but a platen may have moved them since.
    const auto is_prescribed_on_contact_boundary =
      [&](const unsigned int node, const ContactCondition<dim> &condition) {
        return displacement != nullptr && nodes.is_fixed(node) &&
          !nodes.is_hanging(node) && !condition.ignores_prescribed_penetration;
      };
    Depth<dim> deepest(0., Point<dim>());
    for (const auto &[node, at] : boundary)
      if (!is_contact[node] && node < nodes.n_owned_nodes())
        for (unsigned int i = 0; i < n_nodes.size(); ++i)
          {
            const ContactCondition<dim> &condition =
              scene.contact_conditions()[i];
            const bool is_on_it = at.conditions.count(&condition) > 0;
            if (n_nodes[i] == 0 || !can_touch(condition) ||
                (displacement == nullptr && !is_on_it) ||
                !(nodes.is_free(node) ||
                  (is_on_it &&
                   is_prescribed_on_contact_boundary(node, condition))))
              continue;
            Point<dim> moved = at.point;
            if (displacement != nullptr)
              for (unsigned int d = 0; d < dim; ++d)
                moved[d] += displacement->local_element(dim * node + d);
            const double depth = depth_in(condition.obstacle, moved);
            if (depth > deepest.first &&
                (displacement == nullptr ||
                 depth_in(condition.obstacle, at.point) <= 1e-10 * size))
              deepest = {depth, at.point};
          }
    return largest<dim>(nodes.communicator(), deepest.first, deepest.second);
  }


  // Faces whose nodes are all farther from the obstacle than the face is large
  // are left out.
  template <int dim>
  Depth<dim>
  depth_between_nodes(const Discretization<dim> &discretization,
                      const unsigned int         condition,
                      const VectorType          &displacement,
                      const ContactState        &state)
  {
    const Scene<dim>            &scene = discretization.scene();
    const NodalConstraints<dim> &nodes = discretization.constraints();
    const Obstacle<dim>         &obstacle =
      scene.contact_conditions()[condition].obstacle;

    // One in the first component where a node is in contact; at hanging nodes
    // something else than zero if a node that they hang from is.
    VectorType u = discretization.vector(), is_in_contact(u);
    u.copy_locally_owned_data_from(displacement);
    for (unsigned int p = 0; p < state.size(); ++p)
      if (state.in_contact(p))
        is_in_contact.local_element(dim * discretization.contact()[p].node) =
          1.;
    discretization.interpolate_hanging_nodes(u);
    discretization.interpolate_hanging_nodes(is_in_contact);

    constexpr unsigned int             n          = dim == 2 ? 8 : 4;
    constexpr unsigned int             n_vertices = 1 << (dim - 1);
    std::array<Point<dim>, n_vertices> corner, moved;
    std::pair<double, Point<dim>>      deepest(0., Point<dim>());
    const auto at = [&](const std::array<Point<dim>, n_vertices> &points,
                        const double                              s,
                        const double                              t) {
      Point<dim> p;
      for (unsigned int v = 0; v < n_vertices; ++v)
        p += (v % 2 == 0 ? 1. - s : s) * (v / 2 == 0 ? 1. - t : t) * points[v];
      return p;
    };
    for (const auto &cell :
         discretization.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          {
            const auto face = cell->face(f);
            if (!cell->at_boundary(f) ||
                scene.contact_on(face->boundary_id()) !=
                  &scene.contact_conditions()[condition])
              continue;
            bool   is_open = true;
            double nearest = 0.;
            for (unsigned int v = 0; v < n_vertices; ++v)
              {
                corner[v] = moved[v] = face->vertex(v);
                for (unsigned int d = 0; d < dim; ++d)
                  moved[v][d] += u(face->vertex_dof_index(v, d));
                is_open =
                  is_open && is_in_contact(face->vertex_dof_index(v, 0)) == 0.;
                const double depth = depth_in(obstacle, moved[v]);
                nearest            = v == 0 ? depth : std::max(nearest, depth);
              }
            if (!is_open || nearest < -face->diameter())
              continue;
            for (unsigned int j = 1; j < (dim == 2 ? 2 : n); ++j)
              for (unsigned int i = 1; i < n; ++i)
                {
                  const double s = double(i) / n,
                               t = dim == 2 ? 0. : double(j) / n;
                  const double depth =
                    depth_in(obstacle, at(moved, s, t)) - std::max(0., nearest);
                  if (depth > deepest.first)
                    deepest = {depth, at(corner, s, t)};
                }
          }
    return largest<dim>(nodes.communicator(), deepest.first, deepest.second);
  }



  template double
  depth_in(const Obstacle<2> &, const Point<2> &, const Tensor<1, 2> &);
  template double
  depth_in(const Obstacle<3> &, const Point<3> &, const Tensor<1, 3> &);
  template Depth<2> depth_of_other_nodes(const Discretization<2> &,
                                         const VectorType *);
  template Depth<3> depth_of_other_nodes(const Discretization<3> &,
                                         const VectorType *);
  template Depth<2> depth_between_nodes(const Discretization<2> &,
                                        const unsigned int,
                                        const VectorType &,
                                        const ContactState &);
  template Depth<3> depth_between_nodes(const Discretization<3> &,
                                        const unsigned int,
                                        const VectorType &,
                                        const ContactState &);
} // namespace Friction
