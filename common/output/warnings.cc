#include <common/output/warnings.h>
#include <common/parallel/reductions.h>
#include <common/printable.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>

namespace Friction
{
  namespace
  {
    // Edges of a boundary that is meant to be smooth are flatter than the
    // first, and do not matter if they are flatter than the second; degrees.
    constexpr double smallest_corner = 40., smallest_edge = 3.;

    // Where a round body touches a flat obstacle, the normals of nodes at the
    // rim of the contact zone differ by some degrees, to both sides. Beyond
    // this it is a slope, or a corner: ten degrees change a ratio of forces by
    // 0.18.
    constexpr double large_angle = 10.; // degrees

    // Relative to the largest displacement at the contact boundary, and to the
    // body.
    constexpr double large_distance     = .1;
    constexpr double large_displacement = .1;



    template <int dim>
    std::string
    describe(const Point<dim> &p)
    {
      std::ostringstream text;
      text.precision(4);
      for (unsigned int d = 0; d < dim; ++d)
        text << (d == 0 ? "(" : ", ") << p[d];
      text << ')';
      return text.str();
    }



    std::string
    number(const double x)
    {
      std::ostringstream text;
      text.precision(3);
      text << x;
      return text.str();
    }



    double
    degrees(const double cosine)
    {
      return std::acos(std::max(-1., std::min(1., cosine))) * 180. /
        numbers::PI;
    }



    // The largest value of all processes, and its place.
    template <int dim>
    std::pair<double, Point<dim>>
    largest(const MPI_Comm    communicator,
            const double      value,
            const Point<dim> &point)
    {
      std::array<double, dim + 1> own;
      own[0] = value;
      for (unsigned int d = 0; d < dim; ++d)
        own[d + 1] = point[d];
      std::pair<double, Point<dim>> result(value, point);
      for (const auto &other : Utilities::MPI::all_gather(communicator, own))
        if (other[0] > result.first)
          {
            result.first = other[0];
            for (unsigned int d = 0; d < dim; ++d)
              result.second[d] = other[d + 1];
          }
      return result;
    }



    // The coarse mesh is known to all processes.
    template <int dim>
    void
    warn_of_cracks(const parallel::distributed::Triangulation<dim> &mesh,
                   std::vector<std::string>                        &warnings)
    {
      double shortest = std::numeric_limits<double>::max();
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (unsigned int line = 0; line < cell->n_lines(); ++line)
          shortest = std::min(shortest, cell->line(line)->diameter());
      const double unit = 1e-3 * shortest;

      std::map<std::array<std::int64_t, dim>, unsigned int> faces;
      unsigned int                                          n_pairs = 0;
      Point<dim>                                            where;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              const Point<dim>              center = cell->face(f)->center();
              std::array<std::int64_t, dim> key;
              for (unsigned int d = 0; d < dim; ++d)
                key[d] = std::llround(center[d] / unit);
              if (++faces[key] == 2)
                {
                  ++n_pairs;
                  where = center;
                }
            }
      if (n_pairs > 0)
        warnings.push_back(
          "Warning: " + counted(n_pairs, "pair", "pairs") + " of boundary " +
          (dim == 2 ? "edges" : "faces") +
          (n_pairs == 1 ? " lies on each other, at "
                        : " lie on each other, one of them at ") +
          describe(where) +
          ", so that the body is cut there; if it should not be, merge the "
          "nodes "
          "of the mesh.");
    }



    template <int dim>
    void
    warn_of_polygons(const parallel::distributed::Triangulation<dim> &mesh,
                     const Scene<dim>                                &scene,
                     std::vector<std::string>                        &warnings)
    {
      const FE_Q<dim>   element(1);
      FEFaceValues<dim> values(
        element, QMidpoint<dim - 1>(), update_normal_vectors);
      std::map<unsigned int, std::vector<Tensor<1, dim>>> normals;
      std::map<unsigned int, Point<dim>>                  points;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) &&
              scene.contact_on(cell->face(f)->boundary_id()) != nullptr)
            {
              values.reinit(cell, f);
              for (const unsigned int v : cell->face(f)->vertex_indices())
                {
                  const unsigned int vertex = cell->face(f)->vertex_index(v);
                  normals[vertex].push_back(values.normal_vector(0));
                  points[vertex] = cell->face(f)->vertex(v);
                }
            }
      double     angle = 0;
      Point<dim> where;
      for (const auto &[vertex, list] : normals)
        for (const auto &a : list)
          {
            const double here = degrees(a * list.front());
            if (here < smallest_corner && here > angle)
              {
                angle = here;
                where = points[vertex];
              }
          }
      if (angle > smallest_edge)
        warnings.push_back("Warning: the contact boundary is that of the mesh "
                           "file, with edges of "
                           "up to " +
                           number(angle) + " degrees, one of them at " +
                           describe(where) +
                           ", which stay however fine the mesh, and where the "
                           "contact stress has "
                           "peaks; a finer mesh file has flatter ones.");
    }



    // Whether there is an obstacle and a boundary to touch it.
    template <int dim>
    bool
    can_touch(const ContactCondition<dim> &condition)
    {
      return condition.has_boundary() && !condition.obstacle.empty();
    }



    // " of 'Contact 2'", where there are several contact boundaries.
    template <int dim>
    std::string
    of_section(const Scene<dim> &scene, const ContactCondition<dim> &condition)
    {
      return scene.contact_conditions().size() == 1
        ? std::string()
        : " of '" + condition.section() + "'";
    }



    // What they add to is the reaction of what holds the boundary. A platen
    // gives way.
    template <int dim>
    void
    warn_of_useless_tractions(const Scene<dim>         &scene,
                              std::vector<std::string> &warnings)
    {
      for (const auto &traction : scene.traction_conditions())
        for (const auto &condition : scene.dirichlet_conditions())
          if (condition.boundary_id == traction.boundary_id &&
              condition.platen == nullptr &&
              condition.components.n_selected_components(dim) == dim)
            warnings.push_back(
              "Warning: 'Boundary conditions/Traction' does not move "
              "boundary " +
              std::to_string(traction.boundary_id) +
              ", since all of its displacements are prescribed; leave a "
              "component 'free', or the traction out.");
    }
  } // namespace



  // Physical ids have been looked for in the mesh file; what a condition holds
  // for is known of a mesh only.
  template <int dim>
  std::vector<std::string>
  warnings_about_regions(const Discretization<dim> &discretization,
                         const std::string         &which_mesh)
  {
    std::vector<std::string> warnings;
    const Materials<dim>    &materials = discretization.scene().materials();
    if (materials.is_homogeneous())
      return warnings;
    std::vector<unsigned int> n_cells(materials.of_regions().size(), 0);
    for (const auto &cell : discretization.dof_handler()
                              .get_triangulation()
                              .active_cell_iterators())
      if (cell->is_locally_owned())
        ++n_cells[materials.region(cell)];
    for (unsigned int i = 1; i < n_cells.size(); ++i)
      if (Utilities::MPI::sum(n_cells[i],
                              discretization.constraints().communicator()) == 0)
        warnings.push_back(
          "Warning: no cell of the " + which_mesh +
          " mesh has the material of region " + std::to_string(i) +
          " in 'Material/Regions'; is its condition the right one, or does a "
          "later region cover it?");
    return warnings;
  }



  template <int dim>
  std::vector<std::string>
  warnings_at_start(const Discretization<dim> &discretization,
                    const Parameters          &parameters)
  {
    const Scene<dim> &scene = discretization.scene();
    const auto       &mesh =
      dynamic_cast<const parallel::distributed::Triangulation<dim> &>(
        discretization.dof_handler().get_triangulation());
    const MPI_Comm communicator = discretization.constraints().communicator();

    std::vector<std::string> warnings = parameters.warnings;
    const std::string        about_scene =
      scene.warning(discretization.contact().largest_coefficient());
    if (!about_scene.empty())
      warnings.push_back(about_scene);
    warn_of_useless_tractions(scene, warnings);
    warn_of_cracks(mesh, warnings);
    const bool is_refined = parameters.refinement.initial_refinements > 0 ||
      parameters.refinement.levels > 0;
    if (parameters.scene.geometry == GeometryKind::mesh_file && is_refined)
      warn_of_polygons(mesh, scene, warnings);

    const auto               &conditions = scene.contact_conditions();
    std::vector<unsigned int> n_nodes(conditions.size(), 0);
    for (const ContactNode<dim> &p : discretization.contact())
      ++n_nodes[p.condition];
    for (unsigned int i = 0; i < conditions.size(); ++i)
      if (can_touch(conditions[i]) &&
          Utilities::MPI::sum(n_nodes[i], communicator) == 0)
        warnings.push_back(
          "Warning: no node of the contact boundary" +
          of_section(scene, conditions[i]) +
          " faces the obstacle, so there will be no contact" +
          (conditions.size() == 1 ? "" : " there") +
          "; does the normal of the obstacle point into it, and is '" +
          conditions[i].section() + "/Boundary id' the right one?");

    double     depth = 0;
    Point<dim> where;
    for (const ContactNode<dim> &p : discretization.contact())
      {
        if (can_touch(conditions[p.condition]) && -p.gap > depth)
          {
            depth = -p.gap;
            where = p.point;
          }
      }
    const auto deepest = largest<dim>(communicator, depth, where);
    if (deepest.first > 1e-10 * discretization.body_size())
      warnings.push_back("Warning: the body lies inside the obstacle before it "
                         "is loaded, at " +
                         describe(deepest.second) + " by " +
                         number(deepest.first) +
                         ", and will be pushed out of it; if this is no press "
                         "fit, move one of them.");
    return warnings;
  }



  template <int dim>
  ContactGeometry
  contact_geometry(const Discretization<dim> &discretization,
                   const VectorType          &displacement,
                   const ContactState        &state)
  {
    const Scene<dim> &scene     = discretization.scene();
    const MPI_Comm communicator = discretization.constraints().communicator();

    ContactGeometry result;
    result.boundaries.resize(scene.contact_conditions().size());
    const auto &contact = discretization.contact();
    for (unsigned int p = 0; p < contact.size(); ++p)
      {
        auto          &boundary = result.boundaries[contact[p].condition];
        Tensor<1, dim> u;
        for (unsigned int d = 0; d < dim; ++d)
          u[d] = displacement.local_element(dim * contact[p].node + d);
        boundary.displacement = std::max(boundary.displacement, u.norm());
        if (!state.in_contact(p))
          continue;
        ++boundary.n_contact;
        const ContactCondition<dim> &condition =
          scene.contact_conditions()[contact[p].condition];
        const Obstacle<dim> &obstacle = condition.obstacle;
        if (obstacle.empty())
          continue;
        if (condition.normal == ContactNormal::body)
          boundary.angle = std::max(
            boundary.angle,
            degrees(contact[p].normal() *
                    obstacle.normal(contact[p].point, contact[p].normal())));
        const Point<dim> moved = contact[p].point + u;
        const double     distance =
          obstacle.gap(moved, obstacle.normal(moved, contact[p].normal()));
        boundary.distance = std::max(boundary.distance, std::abs(distance));
      }

    result.size         = discretization.body_size();
    result.displacement = displacement.linfty_norm();
    for (auto &boundary : result.boundaries)
      {
        boundary.n_contact =
          Utilities::MPI::sum(boundary.n_contact, communicator);
        boundary.angle = Utilities::MPI::max(boundary.angle, communicator);
        boundary.distance =
          Utilities::MPI::max(boundary.distance, communicator);
        boundary.displacement =
          Utilities::MPI::max(boundary.displacement, communicator);
      }
    return result;
  }



  template <int dim>
  std::vector<std::string>
  warnings_at_end(const Discretization<dim> &discretization,
                  const VectorType          &displacement,
                  const ContactState        &state)
  {
    const Scene<dim>     &scene = discretization.scene();
    const ContactGeometry g =
      contact_geometry(discretization, displacement, state);

    std::vector<std::string> warnings =
      warnings_about_regions(discretization, "last");
    // A scene with a known solution is one for mathematicians.
    if (g.displacement > large_displacement * g.size &&
        scene.exact_displacement() == nullptr)
      warnings.push_back(
        "Warning: the largest displacement is " + number(g.displacement) +
        " in a body of size " + number(g.size) +
        "; strains and displacements are supposed to be small here.");
    const auto &conditions = scene.contact_conditions();
    for (unsigned int i = 0; i < conditions.size(); ++i)
      if (can_touch(conditions[i]))
        {
          const auto       &boundary = g.boundaries[i];
          const std::string whose    = of_section(scene, conditions[i]);
          if (boundary.n_contact == 0)
            warnings.push_back(
              "Warning: in the end no node" + whose +
              " is in contact with the obstacle; do the loads push the body "
              "towards it, and does '" +
              conditions[i].obstacle_section() +
              "/Normal' point into the obstacle?");
          if (boundary.angle > large_angle)
            warnings.push_back(
              "Warning: nodes" + whose +
              " are in contact whose normal is up to " +
              number(boundary.angle) +
              " degrees off that of the obstacle, so that forces do not obey "
              "the law of friction; set '" +
              conditions[i].section() + "/Contact normal = obstacle'.");
          if (boundary.distance >
              large_distance * boundary.displacement + 1e-12 * g.size)
            warnings.push_back(
              "Warning: displaced as they are, nodes" + whose +
              " in contact are up to " + number(boundary.distance) +
              " away from the obstacle, or inside it, at displacements of " +
              number(boundary.displacement) +
              "; gaps are those of the undeformed body, and displacements too "
              "large for that.");
        }
    return warnings;
  }



  template std::vector<std::string>
  warnings_about_regions(const Discretization<2> &, const std::string &);
  template std::vector<std::string>
  warnings_about_regions(const Discretization<3> &, const std::string &);
  template std::vector<std::string> warnings_at_start(const Discretization<2> &,
                                                      const Parameters &);
  template std::vector<std::string> warnings_at_start(const Discretization<3> &,
                                                      const Parameters &);
  template ContactGeometry          contact_geometry(const Discretization<2> &,
                                                     const VectorType &,
                                                     const ContactState &);
  template ContactGeometry          contact_geometry(const Discretization<3> &,
                                                     const VectorType &,
                                                     const ContactState &);
  template std::vector<std::string> warnings_at_end(const Discretization<2> &,
                                                    const VectorType &,
                                                    const ContactState &);
  template std::vector<std::string> warnings_at_end(const Discretization<3> &,
                                                    const VectorType &,
                                                    const ContactState &);
} // namespace Friction
