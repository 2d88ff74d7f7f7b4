#include <common/discretization/contact_boundary.h>
#include <common/input_error.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/reductions.h>
#include <common/printable.h>

#include <deal.II/base/quadrature_lib.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Friction
{
  namespace
  {
    // An orthonormal frame whose first vector is the normal. Directions along a
    // coordinate axis in which the displacement is prescribed come last.
    template <int dim>
    std::array<Tensor<1, dim>, dim>
    make_frame(const Tensor<1, dim>              &normal,
               const std::vector<Tensor<1, dim>> &prescribed_tangents)
    {
      std::array<Tensor<1, dim>, dim> frame;
      frame[0] = normal;
      if (dim == 2)
        {
          frame[1][0] = -normal[1];
          frame[1][1] = normal[0];
        }
      else
        {
          // Gram-Schmidt, starting from what must be in the frame, and from the
          // coordinate axis least aligned with the normal otherwise.
          std::vector<Tensor<1, dim>> candidates = prescribed_tangents;
          unsigned int                axis       = 0;
          for (unsigned int d = 1; d < dim; ++d)
            if (std::abs(normal[d]) < std::abs(normal[axis]))
              axis = d;
          for (unsigned int d = 0; d < dim; ++d)
            {
              Tensor<1, dim> e;
              e[(axis + d) % dim] = 1.;
              candidates.push_back(e);
            }
          unsigned int slot = dim - 1;
          for (auto candidate : candidates)
            {
              candidate -= (candidate * normal) * normal;
              for (unsigned int s = slot + 1; s < dim; ++s)
                candidate -= (candidate * frame[s]) * frame[s];
              if (candidate.norm() < 0.1)
                continue;
              frame[slot] = candidate / candidate.norm();
              if (--slot == 0)
                break;
            }
        }
      return frame;
    }
  } // namespace



  template <int dim>
  ContactBoundary<dim>::ContactBoundary(
    const Mapping<dim>              &mapping,
    const DoFHandler<dim>           &dof_handler,
    const AffineConstraints<double> &hanging,
    const NodalConstraints<dim>     &constraints,
    const Scene<dim>                &scene)
  {
    // First sum up, per vertex on Gamma_S, the normals of the adjacent faces
    // and the node's share of the boundary measure. Each process takes the
    // faces of its own cells. Hanging nodes hand their measure on to their
    // masters.
    VectorType normals(constraints.partitioner());
    VectorType measures(constraints.partitioner());

    // Where the vertices are, also those of faces of other processes, and to
    // which condition they belong. It is an error if there are several, unless
    // the node cannot move; then it may touch nothing.
    struct Vertex
    {
      Point<dim>   point;
      unsigned int condition;
      unsigned int other; // if there is one
    };
    std::map<unsigned int, Vertex> vertices;
    const auto                    &conditions = scene.contact_conditions();

    const FE_Q<dim>       scalar_element(1);
    const QGauss<dim - 1> quadrature(2);
    FEFaceValues<dim>     face_values(mapping,
                                  scalar_element,
                                  quadrature,
                                  update_values | update_normal_vectors |
                                    update_JxW_values);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (const ContactCondition<dim> *const condition =
                cell->at_boundary(f)
                ? scene.contact_on(cell->face(f)->boundary_id())
                : nullptr)
            {
              const auto         face   = cell->face(f);
              const unsigned int number = condition - conditions.data();
              if (cell->is_locally_owned())
                face_values.reinit(
                  typename Triangulation<dim>::cell_iterator(cell), f);
              for (unsigned int v = 0; v < face->n_vertices(); ++v)
                {
                  const unsigned int cell_vertex =
                    GeometryInfo<dim>::face_to_cell_vertices(f, v);
                  const types::global_dof_index dof =
                    cell->vertex_dof_index(cell_vertex, 0);
                  const unsigned int node = constraints.node_of_dof(dof);
                  const auto         vertex =
                    vertices.insert({node, {face->vertex(v), number, number}})
                      .first;
                  if (vertex->second.condition != number)
                    vertex->second.other = number;
                  if (!cell->is_locally_owned())
                    continue;

                  double measure = 0;
                  for (const unsigned int q :
                       face_values.quadrature_point_indices())
                    measure += face_values.shape_value(cell_vertex, q) *
                      face_values.JxW(q);
                  if (constraints.is_hanging(node))
                    {
                      for (const auto &master :
                           *hanging.get_constraint_entries(dof))
                        measures.local_element(
                          dim * constraints.node_of_dof(master.first)) +=
                          master.second * measure;
                      continue;
                    }

                  // The manifold knows the normal of the true boundary, of
                  // which the mesh is but a polygon.
                  Tensor<1, dim> normal =
                    face->get_manifold().normal_vector(face, face->vertex(v));
                  if (normal * face_values.normal_vector(0) < 0)
                    normal *= -1.;
                  for (unsigned int d = 0; d < dim; ++d)
                    normals.local_element(dim * node + d) +=
                      measure * normal[d] / normal.norm();
                  measures.local_element(dim * node) += measure;
                }
            }
    normals.compress(VectorOperation::add);
    measures.compress(VectorOperation::add);

    on_all_processes(constraints.communicator(), [&]() {
      for (const auto &[number, vertex] : vertices)
        if (!constraints.is_hanging(number) &&
            number < constraints.n_owned_nodes())
          {
            const ContactCondition<dim> &condition =
              conditions[vertex.condition];
            if (vertex.other != vertex.condition)
              {
                if (constraints.is_fixed(number))
                  continue;
                throw InputError(
                  scene.subject() + "the node at " + coordinates(vertex.point) +
                  " lies on two contact boundaries, those of '" +
                  conditions[std::min(vertex.condition, vertex.other)]
                    .section() +
                  "' and '" +
                  conditions[std::max(vertex.condition, vertex.other)]
                    .section() +
                  "', and can have one normal only; end one of them before "
                  "that node, by faces with another boundary id, or "
                  "prescribe its displacement.");
              }
            Tensor<1, dim> normal;
            for (unsigned int d = 0; d < dim; ++d)
              normal[d] = normals.local_element(dim * number + d);
            ContactNode<dim> node;
            node.node                    = number;
            node.point                   = vertex.point;
            node.condition               = vertex.condition;
            node.measure                 = measures.local_element(dim * number);
            const Tensor<1, dim> outward = normal / normal.norm();
            node.frame[0] = condition.normal == ContactNormal::body
              ? outward
              : condition.obstacle.normal(vertex.point, outward);
            add_node(node, constraints, scene);
          }
    });
    nodes.shrink_to_fit();
    find_friction(constraints, scene);
  }



  template <int dim>
  void
  ContactBoundary<dim>::set_slip_origin(const VectorType &u)
  {
    for (ContactNode<dim> &node : nodes)
      {
        const auto components = tangential_components<dim>(node, u);
        node.slip_origin      = Tensor<1, dim>();
        for (unsigned int t = 1; t < dim; ++t)
          node.slip_origin += components[t - 1] * node.frame[t];
      }
  }



  // The law of friction holds at nodes, and so a node has the coefficient of
  // its point. What nodes keep of it is a fraction, so that all of them follow
  // when the coefficient is made smaller for a while, see SafeguardedSolver.
  // Where Tresca's bound is given, the fraction makes a coefficient of one.
  template <int dim>
  void
  ContactBoundary<dim>::find_friction(const NodalConstraints<dim> &constraints,
                                      const Scene<dim>            &scene)
  {
    const auto &conditions = scene.contact_conditions();
    bool        any_tresca = false, any_varies = false;
    for (const ContactCondition<dim> &condition : conditions)
      {
        if (conditions.size() > 1 && !condition.has_boundary())
          continue;
        coefficient = std::max(coefficient, condition.friction_coefficient);
        any_tresca |= condition.friction_law == FrictionLaw::tresca;
        any_varies |= condition.varying_coefficient != nullptr;
        if (condition.friction_law == FrictionLaw::coulomb)
          law = FrictionLaw::coulomb;
      }
    on_all_processes(constraints.communicator(), [&]() {
      for (ContactNode<dim> &node : nodes)
        {
          const ContactCondition<dim> &condition = conditions[node.condition];
          node.bound_is_given = condition.friction_law == FrictionLaw::tresca;
          node.friction_share = condition.varying_coefficient == nullptr
            ? condition.friction_coefficient
            : condition.varying_coefficient->value(node.point);
          coefficient         = std::max(coefficient, node.friction_share);
        }
    });
    if (any_varies)
      coefficient = max_over_processes(coefficient, constraints.communicator());
    if (any_tresca && !(coefficient > 0.))
      law = FrictionLaw::tresca;
    if (conditions.size() == 1 && !any_varies)
      {
        for (ContactNode<dim> &node : nodes)
          node.friction_share = 1.;
        return;
      }
    const double unit = coefficient > 0. ? coefficient : 1.;
    for (ContactNode<dim> &node : nodes)
      node.friction_share =
        (node.bound_is_given ? 1. : node.friction_share) / unit;
  }



  // The node has its number, point, measure and normal; here it gets the rest,
  // or is left out.
  template <int dim>
  void
  ContactBoundary<dim>::add_node(ContactNode<dim>             node,
                                 const NodalConstraints<dim> &constraints,
                                 const Scene<dim>            &scene)
  {
    const ContactCondition<dim> &condition =
      scene.contact_conditions()[node.condition];
    Tensor<1, dim> normal = node.normal();
    // What rounding adds to the normal in a direction in which the node is
    // held would keep the prescribed value from being read back exactly,
    // and a node that is held at zero there from sticking.
    for (unsigned int d = 0; d < dim; ++d)
      if (constraints.is_prescribed(node.node, d) && std::abs(normal[d]) < 1e-8)
        normal[d] = 0.;
    Tensor<1, dim>              prescribed_value;
    std::vector<Tensor<1, dim>> prescribed_tangents;
    for (unsigned int d = 0; d < dim; ++d)
      if (constraints.is_prescribed(node.node, d))
        {
          prescribed_value[d] =
            constraints.prescribed_values().local_element(dim * node.node + d);
          Tensor<1, dim> e;
          e[d] = 1.;
          prescribed_tangents.push_back(e);
        }

    // A node that is held in some directions moves in the others: where it is
    // that it meets the obstacle, it does so in these. If there are none to
    // meet it in, it competes with contact, see below.
    if (condition.normal == ContactNormal::obstacle &&
        !constraints.is_fixed(node.node))
      {
        Tensor<1, dim> in_others = normal;
        for (const auto &e : prescribed_tangents)
          in_others -= (in_others * e) * e;
        if (in_others.norm() > Obstacle<dim>::flattest_cosine)
          normal = in_others / in_others.norm();
      }
    const double gap = normal.norm() > 0.
      ? condition.obstacle.gap(node.point, normal)
      : std::numeric_limits<double>::infinity();
    if (!std::isfinite(gap))
      {
        // Outside it will never touch the obstacle, but inside it would stay. A
        // node that looks along the surface, like those at the side of a body
        // which overlaps the obstacle, has a way out, if not along its normal.
        const Tensor<1, dim> way =
          condition.obstacle.normal(node.point, node.normal());
        if (condition.obstacle.surfaces_contain(node.point) &&
            !(way.norm() > 0. &&
              std::isfinite(condition.obstacle.gap(node.point, way))) &&
            !(constraints.is_fixed(node.node) &&
              condition.ignores_prescribed_penetration))
          throw InputError(
            scene.subject_at_time() + "the node at " + coordinates(node.point) +
            " on the contact boundary lies inside the obstacle, and there is "
            "no way out of it within the size of the body; '" +
            condition.obstacle_section() +
            "/Function' is to be negative in the obstacle and positive where "
            "the body may be.");
        return;
      }

    if (constraints.is_fixed(node.node))
      {
        if (!condition.ignores_prescribed_penetration &&
            prescribed_value * normal - gap >
              1e-8 * (std::abs(gap) + prescribed_value.norm()))
          throw InputError(
            scene.subject_at_time() +
            "the prescribed displacement of the node at " +
            coordinates(node.point) +
            ", which also lies on the contact boundary, pushes it into the "
            "obstacle by " +
            number(prescribed_value * normal - gap) +
            ": prescribe a smaller displacement there (a platen with a given "
            "force prescribes one as well) or end the contact boundary before "
            "that node, or set '" +
            condition.section() + "/Ignore prescribed penetration'.");
        return;
      }
    for (const auto &e : prescribed_tangents)
      if (std::abs(e * normal) > 1e-8)
        throw InputError(
          scene.subject() + "at " + coordinates(node.point) +
          " on the contact boundary a displacement component is prescribed "
          "that has a part in normal direction, so that it competes with "
          "contact: prescribe all components there, or only tangential "
          "ones.");

    node.frame           = make_frame<dim>(normal, prescribed_tangents);
    node.gap             = gap;
    node.n_free_tangents = dim - 1 - prescribed_tangents.size();
    nodes.push_back(node);
  }



  template class ContactBoundary<2>;
  template class ContactBoundary<3>;
} // namespace Friction
