#include <common/contact/force_balance.h>
#include <common/discretization/multilinear_cell.h>
#include <common/output/mesh_warnings.h>
#include <common/output/penetration.h>
#include <common/output/warnings.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/reductions.h>
#include <common/printable.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/symmetric_tensor.h>

#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>

#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace Friction
{
  namespace
  {
    // Where a round body touches a flat obstacle, the normals of nodes at the
    // rim of the contact zone differ by some degrees, to both sides. Beyond
    // this it is a slope, or a corner: ten degrees change a ratio of forces by
    // 0.18.
    constexpr double large_angle = 10.; // degrees

    // How far nodes in contact are from the obstacle, relative to how far
    // others have moved against them; how deep the body is in it between nodes,
    // relative to the largest displacement; the largest displacement, relative
    // to the body; and strains.
    constexpr double large_distance     = .1;
    constexpr double large_displacement = .1;
    constexpr double large_strain       = .1;

    // Of all forces, what a single point may bear.
    constexpr double large_share = .1;

    // Of a boundary that is not to touch the obstacle, relative to the body.
    constexpr double visible_depth = 1e-3;



    // " of 'Contact 2'", where there are several contact boundaries.
    template <int dim>
    std::string
    of_section(const Scene<dim> &scene, const ContactCondition<dim> &condition)
    {
      return scene.contact_conditions().size() == 1
        ? std::string()
        : " of '" + condition.section() + "'";
    }



    // Of each region, with what is in none as the first one, all processes'.
    template <int dim>
    std::vector<unsigned int>
    n_cells_of_regions(const Discretization<dim> &discretization)
    {
      const Materials<dim>     &materials = discretization.scene().materials();
      const Triangulation<dim> &mesh =
        discretization.dof_handler().get_triangulation();
      if (materials.is_homogeneous())
        return {static_cast<unsigned int>(mesh.n_global_active_cells())};
      const MPI_Comm communicator = discretization.constraints().communicator();
      std::vector<unsigned int> n_cells(materials.of_regions().size(), 0);
      on_all_processes(communicator, [&]() {
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            ++n_cells[materials.region(cell)];
      });
      for (unsigned int &n : n_cells)
        n = Utilities::MPI::sum(n, communicator);
      return n_cells;
    }



    // Of the materials that cells have. Up to a ratio of 0.49 bilinear elements
    // are too stiff, but not by far. A stiffness has some fifteen digits: those
    // of a soft part get lost where it is added to that of a stiff one.
    template <int dim>
    void
    warn_of_materials(const Discretization<dim> &discretization,
                      std::vector<std::string>  &warnings)
    {
      constexpr double      locking = .49 + 1e-10, far_apart = 1e10;
      const Materials<dim> &materials = discretization.scene().materials();
      double                largest = 0, stiffest = 0, softness = 0;
      const std::vector<unsigned int> n_cells =
        n_cells_of_regions(discretization);
      for (unsigned int i = 0; i < n_cells.size(); ++i)
        if (n_cells[i] > 0)
          {
            const Material &material = materials.of_regions()[i];
            stiffest                 = std::max(stiffest, material.mu());
            softness                 = std::max(softness, 1. / material.mu());
            if (material.volumetric_strain() == VolumetricStrain::pointwise)
              largest = std::max(largest,
                                 material.lambda() /
                                   (2. * (material.lambda() + material.mu())));
          }
      if (largest > locking)
        warnings.push_back(
          "Warning: with a Poisson ratio of " + number(largest, 6) +
          " and pointwise volumetric strains the body is too stiff by far, but "
          "for very fine meshes; set 'Material/Volumetric strain = mean'" +
          (materials.is_homogeneous()
             ? "."
             : ", or 'E, nu, mean' where it is that of a region."));
      if (stiffest * softness > far_apart)
        warnings.push_back(
          "Warning: a part of the body is " + number(stiffest * softness) +
          " times as stiff as another one, of which rounding leaves hardly a "
          "digit, and the certificate does not see it; beyond a factor of 1e6 "
          "or so a part is as good as rigid.");
    }



    // Boundaries with a node in common, of which each wants it somewhere else.
    // A platen gives way.
    template <int dim>
    void
    warn_of_contradictions(const Triangulation<dim> &mesh,
                           const Scene<dim>         &scene,
                           const double              size,
                           std::vector<std::string> &warnings)
    {
      using Prescribed = std::pair<types::boundary_id, double>;
      std::map<std::pair<unsigned int, unsigned int>, Prescribed> prescribed;
      for (const auto &cell : mesh.cell_iterators_on_level(0))
        for (const unsigned int f : cell->face_indices())
          for (const auto &condition : scene.dirichlet_conditions())
            if (cell->at_boundary(f) && condition.platen == nullptr &&
                cell->face(f)->boundary_id() == condition.boundary_id)
              for (const unsigned int v : cell->face(f)->vertex_indices())
                for (unsigned int c = 0; c < dim; ++c)
                  if (condition.components[c])
                    {
                      // A value that is no number is an error only where it
                      // is the one that holds.
                      const Point<dim> p     = cell->face(f)->vertex(v);
                      double           value = 0;
                      try
                        {
                          value = condition.displacement->value(p, c);
                        }
                      catch (const InputError &)
                        {
                          continue;
                        }
                      const auto [entry, is_new] =
                        prescribed.insert({{cell->face(f)->vertex_index(v), c},
                                           {condition.boundary_id, value}});
                      const Prescribed &other = entry->second;
                      if (std::abs(value - other.second) <=
                          1e-8 * (std::abs(value) + std::abs(other.second)) +
                            1e-12 * size)
                        continue;
                      warnings.push_back(
                        "Warning: 'Boundary conditions/Displacement' moves " +
                        coordinates(p) + " by " + number(other.second) +
                        " in " + "xyz"[c] + " direction with boundary " +
                        std::to_string(other.first) + " and by " +
                        number(value) + " with boundary " +
                        std::to_string(condition.boundary_id) +
                        ", of which one only can be; leave a component "
                        "'free', or let them agree where they meet.");
                      return;
                    }
    }



    // The directions in which a traction on a boundary is not zero, where it is
    // integrated.
    template <int dim>
    std::array<unsigned int, dim>
    directions_of(const TractionCondition<dim> &condition,
                  const Discretization<dim>    &discretization)
    {
      const MPI_Comm communicator = discretization.constraints().communicator();
      const FE_Q<dim>               element(1);
      FEFaceValues<dim>             values(discretization.mapping(),
                               element,
                               QGauss<dim - 1>(4),
                               update_quadrature_points);
      std::array<unsigned int, dim> has_part;
      has_part.fill(0);
      on_all_processes(communicator, [&]() {
        Vector<double> traction(dim);
        for (const auto &cell :
             discretization.dof_handler().active_cell_iterators())
          if (cell->is_locally_owned())
            for (const unsigned int f : cell->face_indices())
              if (cell->at_boundary(f) &&
                  cell->face(f)->boundary_id() == condition.boundary_id)
                {
                  values.reinit(
                    typename Triangulation<dim>::cell_iterator(cell), f);
                  for (const Point<dim> &point : values.get_quadrature_points())
                    {
                      condition.traction->vector_value(point, traction);
                      for (unsigned int d = 0; d < dim; ++d)
                        if (traction[d] != 0.)
                          has_part[d] = 1;
                    }
                }
      });
      for (unsigned int &direction : has_part)
        direction = Utilities::MPI::max(direction, communicator);
      return has_part;
    }



    // What they add to is the reaction of what holds the boundary. A platen
    // gives way.
    template <int dim>
    void
    warn_of_useless_tractions(const Discretization<dim> &discretization,
                              std::vector<std::string>  &warnings)
    {
      const Scene<dim> &scene = discretization.scene();
      for (const auto &traction : scene.traction_conditions())
        for (const auto &condition : scene.dirichlet_conditions())
          if (condition.boundary_id == traction.boundary_id)
            {
              std::vector<unsigned int> held;
              for (unsigned int d = 0; d < dim; ++d)
                if (condition.components[d] &&
                    !(condition.platen != nullptr &&
                      condition.platen->is_controlled[d]))
                  held.push_back(d);
              const std::string sentence =
                "Warning: 'Boundary conditions/Traction' does not move "
                "boundary " +
                std::to_string(traction.boundary_id);
              if (held.size() == dim)
                {
                  warnings.push_back(
                    sentence +
                    ", since all of its displacements are prescribed; leave a "
                    "component 'free', or the traction out.");
                  continue;
                }
              const auto has_part = directions_of(traction, discretization);
              for (const unsigned int d : held)
                if (has_part[d] > 0)
                  warnings.push_back(
                    sentence + " in " + "xyz"[d] +
                    " direction, in which its displacement is prescribed; "
                    "leave that component 'free', or set that of the "
                    "traction to zero.");
            }
    }



    // The root of the mean square of strains, by the middles of cells; peaks at
    // corners, which grow with refinement, hardly matter to it.
    template <int dim>
    double
    mean_strain(const Discretization<dim> &discretization,
                const VectorType          &displacement)
    {
      VectorType u = discretization.vector();
      u.copy_locally_owned_data_from(displacement);
      discretization.interpolate_hanging_nodes(u);
      std::array<double, 2> sums{};
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const Multilinear::PointOfCell<dim> middle(
              Multilinear::cell_values(discretization.mapping(), cell, u),
              Multilinear::middle_of_cell<dim>());
            const SymmetricTensor<2, dim> strain = symmetrize(middle.gradient);
            sums[0] += strain * strain * middle.determinant;
            sums[1] += middle.determinant;
          }
      sums =
        sum_over_processes(sums, discretization.constraints().communicator());
      return std::sqrt(sums[0] / sums[1]);
    }



    // Coordinates have sixteen digits. What is left of them for the shape of a
    // cell is less the farther it is from the origin.
    template <int dim>
    void
    warn_of_digits(const Triangulation<dim> &mesh,
                   const MPI_Comm            communicator,
                   std::vector<std::string> &warnings)
    {
      double     farthest = 0., shortest = std::numeric_limits<double>::max();
      Point<dim> where;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            for (const unsigned int v : cell->vertex_indices())
              farthest = std::max(farthest, cell->vertex(v).norm());
            for (const unsigned int l : cell->line_indices())
              if (cell->line(l)->diameter() < shortest)
                {
                  shortest = cell->line(l)->diameter();
                  where    = cell->line(l)->center();
                }
          }
      farthest           = Utilities::MPI::max(farthest, communicator);
      const auto inverse = largest<dim>(communicator, 1. / shortest, where);
      if (farthest * inverse.first > 1e9)
        warnings.push_back(
          "Warning: the edge of a cell at " + coordinates(inverse.second) +
          " has a length of " + number(1. / inverse.first) +
          ", while coordinates are as large as " + number(farthest) +
          ", so that few of their digits are left for it; move the mesh closer "
          "to the origin, or make its edges more equal.");
    }



    // A body that is loaded in a single point gives way without limit the finer
    // the mesh is, since its stresses are those of a force on a needle's point.
    template <int dim>
    void
    warn_of_loaded_pins(const Discretization<dim> &discretization,
                        const VectorType          &displacement,
                        std::vector<std::string>  &warnings)
    {
      const Scene<dim> &scene = discretization.scene();
      if (scene.pinned_points().empty())
        return;
      const NodalConstraints<dim> &constraints = discretization.constraints();
      VectorType                   force       = discretization.vector();
      discretization.stiffness().residual(
        force, discretization.loads(), displacement);
      double largest_force = 0, all_forces = 0;
      for (unsigned int i = 0; i < force.locally_owned_size(); ++i)
        all_forces += std::abs(force.local_element(i));

      // Not those of the boundary that a point is on as well: of the obstacle,
      // and of what is prescribed there.
      const unsigned int        nobody  = scene.dirichlet_conditions().size();
      std::vector<unsigned int> holders = find_holders(discretization);
      for (const ContactNode<dim> &p : discretization.contact())
        std::fill_n(holders.begin() + dim * p.node, dim, nobody + 1);

      Point<dim> where;
      for (const auto &cell :
           discretization.dof_handler().active_cell_iterators())
        if (cell->is_locally_owned())
          scene.for_each_pin(
            cell, [&](const PinnedPoint<dim> &pin, const unsigned int v) {
              const unsigned int i =
                dim * constraints.node_of_dof(cell->vertex_dof_index(v, 0)) +
                pin.component;
              if (i < holders.size() && holders[i] == nobody &&
                  std::abs(force.local_element(i)) > largest_force)
                {
                  largest_force = std::abs(force.local_element(i));
                  where         = pin.point;
                }
            });
      all_forces = Utilities::MPI::sum(all_forces, constraints.communicator());
      const auto most =
        largest<dim>(constraints.communicator(), largest_force, where);
      if (most.first > large_share * all_forces)
        warnings.push_back(
          "Warning: the point that is pinned at " + coordinates(most.second) +
          " bears a force of " + number(most.first) +
          ", under which the body gives way the more the finer the mesh is; "
          "points can keep a body from drifting away, what bears a load has to "
          "be a part of the boundary with a displacement.");
    }
  } // namespace



  // Physical ids have been looked for in the mesh file; what a condition holds
  // for is known of a mesh only.
  template <int dim>
  std::vector<std::string>
  warnings_about_regions(const Discretization<dim> &discretization,
                         const std::string         &which_mesh)
  {
    std::vector<std::string>        warnings;
    const std::vector<unsigned int> n_cells =
      n_cells_of_regions(discretization);
    for (unsigned int i = 1; i < n_cells.size(); ++i)
      if (n_cells[i] == 0)
        warnings.push_back(
          "Warning: no cell of the " + which_mesh +
          " mesh has the material of region " + std::to_string(i) +
          " in 'Material/Regions'; is its condition the right one, or does a "
          "later region cover it?");
    return warnings;
  }



  template <int dim>
  std::vector<LoadWarning>
  warnings_about_loads(const Discretization<dim> &discretization)
  {
    const Scene<dim>        &scene = discretization.scene();
    std::vector<LoadWarning> warnings;
    const std::string        about_scene =
      scene.warning(discretization.contact().largest_coefficient());
    if (!about_scene.empty())
      warnings.push_back({"scene", about_scene});
    std::vector<std::string> sentences;
    warn_of_useless_tractions(discretization, sentences);
    for (const std::string &sentence : sentences)
      warnings.push_back({sentence, sentence});
    sentences.clear();
    warn_of_contradictions(discretization.dof_handler().get_triangulation(),
                           scene,
                           discretization.body_size(),
                           sentences);
    for (const std::string &sentence : sentences)
      warnings.push_back({"contradiction", sentence});
    return warnings;
  }



  template <int dim>
  std::vector<std::string>
  warnings_at_start(const Discretization<dim>      &discretization,
                    const Parameters               &parameters,
                    const std::vector<LoadWarning> &about_loads)
  {
    const Scene<dim> &scene = discretization.scene();
    const auto       &mesh  = discretization.dof_handler().get_triangulation();
    const MPI_Comm communicator = discretization.constraints().communicator();

    // What is not a number in a vertex of this mesh is to be known before
    // anything is solved.
    if (const auto exact = scene.exact_displacement())
      on_all_processes(communicator, [&]() {
        Vector<double> value(dim);
        for (const auto &cell : mesh.active_cell_iterators())
          if (cell->is_locally_owned())
            for (const unsigned int v : cell->vertex_indices())
              exact->vector_value(cell->vertex(v), value);
      });

    std::vector<std::string> warnings = parameters.warnings;
    if (dim == 2)
      warnings.insert(warnings.end(),
                      parameters.warnings_in_two_dimensions.begin(),
                      parameters.warnings_in_two_dimensions.end());
    for (const LoadWarning &warning : about_loads)
      warnings.push_back(warning.sentence);
    warn_of_materials(discretization, warnings);
    warn_of_digits<dim>(mesh, communicator, warnings);
    for (const std::string &sentence : warnings_about_cuts(mesh))
      warnings.push_back(sentence);
    const bool is_refined = parameters.refinement.initial_refinements > 0 ||
      parameters.refinement.levels > 0;
    if (parameters.scene.geometry == GeometryKind::mesh_file && is_refined)
      for (const std::string &sentence : warnings_about_edges(mesh, scene))
        warnings.push_back(sentence);

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
          "; does the normal of the obstacle point into it, is '" +
          conditions[i].section() +
          "/Boundary id' the right one, and are its displacements free?");

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
                         coordinates(deepest.second) + " by " +
                         number(deepest.first) +
                         ", and will be pushed out of it; if this is no press "
                         "fit, move one of them.");
    const auto other = depth_of_other_nodes(discretization);
    if (other.first > visible_depth * discretization.body_size())
      warnings.push_back("Warning: a node on the contact boundary lies inside "
                         "the obstacle, at " +
                         coordinates(other.second) + " by " +
                         number(other.first) +
                         ", and cannot get into contact, since the way out of "
                         "it leads nowhere the boundary faces; move one of "
                         "them.");
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

    // Of each boundary the node that is farthest from its obstacle: distance,
    // displacement along its normal, and that normal.
    struct Farthest
    {
      double         distance = 0, normal_displacement = 0;
      Tensor<1, dim> normal;

      std::array<double, dim + 2>
      numbers() const
      {
        std::array<double, dim + 2> result{{distance, normal_displacement}};
        for (unsigned int d = 0; d < dim; ++d)
          result[2 + d] = normal[d];
        return result;
      }
    };
    std::vector<Farthest> farthest(scene.contact_conditions().size());

    ContactGeometry result;
    result.boundaries.resize(farthest.size());
    const auto &contact = discretization.contact();
    for (unsigned int p = 0; p < contact.size(); ++p)
      if (state.in_contact(p))
        {
          auto &boundary = result.boundaries[contact[p].condition];
          ++boundary.n_contact;
          const ContactCondition<dim> &condition =
            scene.contact_conditions()[contact[p].condition];
          const Obstacle<dim> &obstacle = condition.obstacle;
          if (obstacle.empty())
            continue;
          Tensor<1, dim> u;
          for (unsigned int d = 0; d < dim; ++d)
            u[d] = displacement.local_element(dim * contact[p].node + d);
          if (condition.normal == ContactNormal::body)
            boundary.angle =
              std::max(boundary.angle,
                       angle_between(contact[p].normal(),
                                     obstacle.normal(contact[p].point,
                                                     contact[p].normal())));
          const double distance = std::abs(
            depth_in(obstacle, contact[p].point + u, contact[p].normal()));
          Farthest &so_far = farthest[contact[p].condition];
          if (distance > so_far.distance)
            {
              so_far.distance            = distance;
              so_far.normal_displacement = u * contact[p].normal();
              so_far.normal              = contact[p].normal();
            }
        }

    for (unsigned int i = 0; i < farthest.size(); ++i)
      {
        auto &boundary = result.boundaries[i];
        boundary.n_contact =
          Utilities::MPI::sum(boundary.n_contact, communicator);
        boundary.angle = Utilities::MPI::max(boundary.angle, communicator);
        std::array<double, dim + 2> numbers{};
        for (const auto &other :
             Utilities::MPI::all_gather(communicator, farthest[i].numbers()))
          if (other[0] > numbers[0])
            numbers = other;
        boundary.distance = numbers[0];
        for (unsigned int node = 0;
             node < discretization.constraints().n_owned_nodes();
             ++node)
          {
            double difference = -numbers[1];
            for (unsigned int d = 0; d < dim; ++d)
              difference +=
                displacement.local_element(dim * node + d) * numbers[2 + d];
            boundary.indentation =
              std::max(boundary.indentation, std::abs(difference));
          }
        boundary.indentation =
          Utilities::MPI::max(boundary.indentation, communicator);
      }

    result.size         = discretization.body_size();
    result.displacement = displacement.linfty_norm();
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
    if (scene.exact_displacement() == nullptr)
      {
        const double strain = mean_strain(discretization, displacement);
        if (g.displacement > large_displacement * g.size)
          warnings.push_back(
            "Warning: the largest displacement is " + number(g.displacement) +
            " in a body of size " + number(g.size) +
            "; strains and displacements are supposed to be small here.");
        else if (strain > large_strain)
          warnings.push_back(
            "Warning: strains are " + number(strain) +
            " in the mean of the body; strains and displacements are supposed "
            "to be small here.");
      }
    const auto other = depth_of_other_nodes(discretization, &displacement);
    if (other.first > visible_depth * g.size)
      warnings.push_back(
        "Warning: a node of the boundary that is no contact node has gone "
        "through the surface of the obstacle, by " +
        number(other.first) + " at " + coordinates(other.second) +
        "; is 'Boundary id' of its contact section the right one, or does a "
        "displacement or a platen push it there?");
    warn_of_loaded_pins(discretization, displacement, warnings);
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
          const auto between =
            depth_between_nodes(discretization, i, displacement, state);
          if (between.first > large_distance * g.displacement + 1e-12 * g.size)
            warnings.push_back(
              "Warning: between nodes" + whose +
              " the body goes through the obstacle, by " +
              number(between.first) + " at " + coordinates(between.second) +
              ", where none of them touches it; the mesh is too coarse for "
              "this obstacle, refine it there.");
          if (boundary.angle > large_angle)
            warnings.push_back(
              "Warning: nodes" + whose +
              " are in contact whose normal is up to " +
              number(boundary.angle) +
              " degrees off that of the obstacle, so that forces do not obey "
              "the law of friction; set '" +
              conditions[i].section() + "/Contact normal = obstacle'.");
          // Nodes with such normals are not where the obstacle is, either.
          else if (boundary.distance >
                   large_distance * boundary.indentation + 1e-12 * g.size)
            warnings.push_back(
              "Warning: displaced as they are, nodes" + whose +
              " in contact are up to " + number(boundary.distance) +
              " away from the obstacle, or inside it, where the rest of the "
              "body has moved by no more than " +
              number(boundary.indentation) +
              " against them in that direction; gaps are those of the "
              "undeformed body, and displacements too large for that. Let the "
              "body lie where it touches from the beginning, and prescribe "
              "less.");
        }
    return warnings;
  }



  template std::vector<std::string>
  warnings_about_regions(const Discretization<2> &, const std::string &);
  template std::vector<std::string>
  warnings_about_regions(const Discretization<3> &, const std::string &);
  template std::vector<LoadWarning>
  warnings_about_loads(const Discretization<2> &);
  template std::vector<LoadWarning>
  warnings_about_loads(const Discretization<3> &);
  template std::vector<std::string>
  warnings_at_start(const Discretization<2> &,
                    const Parameters &,
                    const std::vector<LoadWarning> &);
  template std::vector<std::string>
                                    warnings_at_start(const Discretization<3> &,
                                                      const Parameters &,
                                                      const std::vector<LoadWarning> &);
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
