#include <common/scene/parse_function.h>
#include <common/scene/scene.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <set>

namespace Friction
{
  namespace
  {
    constexpr types::manifold_id arc_manifold_id  = 0;
    constexpr types::manifold_id ring_manifold_id = 1;



    // A function given for the scene as written, seen from the turned scene:
    // its argument is turned back, and its value, if a vector, is turned.
    template <int dim>
    class TurnedFunction : public Function<dim>
    {
    public:
      TurnedFunction(const std::shared_ptr<const Function<dim>> &function,
                     const Tensor<2, dim>                       &rotation)
        : Function<dim>(function->n_components)
        , function(function)
        , rotation(rotation)
      {}

      void
      vector_value(const Point<dim> &p, Vector<double> &values) const override
      {
        const Point<dim> original(transpose(rotation) * p);
        if (this->n_components == 1)
          {
            values[0] = function->value(original);
            return;
          }
        Tensor<1, dim> value;
        for (unsigned int c = 0; c < dim; ++c)
          value[c] = function->value(original, c);
        value = rotation * value;
        for (unsigned int c = 0; c < dim; ++c)
          values[c] = value[c];
      }

      double
      value(const Point<dim>  &p,
            const unsigned int component = 0) const override
      {
        Vector<double> values(this->n_components);
        vector_value(p, values);
        return values[component];
      }

      Tensor<1, dim>
      gradient(const Point<dim>  &p,
               const unsigned int component = 0) const override
      {
        const Point<dim> original(transpose(rotation) * p);
        if (this->n_components == 1)
          return rotation * function->gradient(original);
        Tensor<2, dim> gradient;
        for (unsigned int c = 0; c < dim; ++c)
          gradient[c] = function->gradient(original, c);
        return (rotation * gradient * transpose(rotation))[component];
      }

    private:
      std::shared_ptr<const Function<dim>> function;
      Tensor<2, dim>                       rotation;
    };



    std::vector<std::string>
    split_components(const std::string &text)
    {
      std::vector<std::string> parts(1);
      int                      depth = 0;
      for (const char c : text)
        {
          depth += (c == '(') - (c == ')');
          if (c == ',' && depth == 0)
            parts.emplace_back();
          else
            parts.back() += c;
        }
      return parts;
    }



    template <int dim>
    Point<dim>
    make_point(const std::vector<double> &coordinates, const std::string &where)
    {
      if (coordinates.size() != dim)
        throw InputError(where + " needs " + Utilities::int_to_string(dim) +
                         " numbers, but has " +
                         Utilities::int_to_string(coordinates.size()) +
                         "; correct it.");
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = coordinates[d];
      return p;
    }



    types::boundary_id
    read_boundary_id(const std::string &text, const std::string &where)
    {
      const bool is_number =
        !text.empty() && std::all_of(text.begin(), text.end(), ::isdigit);
      if (!is_number || text.size() > 9)
        throw InputError(where + ": '" + text +
                         "' is no boundary id; give a number from 0 on.");
      return std::stoi(text);
    }



    // The lower half disc as an O-grid: a core of 4 x 4 cells and two rings
    // around its left, lower and right sides, 51 vertices and 40 cells
    // altogether, symmetric about x = 0. The positions of the interior vertices
    // minimise the sum over all corners of all cells of the sixth power of the
    // deviation from a square, |J|^2/(2 det J), with the tangent in place of
    // the chord along the arc. However fine the mesh, angles stay between 59
    // and 121 degrees; three cells meet in each lower corner of the core, which
    // leaves nothing below 120, and 60 opposite to it, to be hoped for.
    void
    make_half_disc(const double radius, Triangulation<2> &triangulation)
    {
      // The right half, by rows from below.
      const double core[5][3][2] = {
        {{.000, -.644}, {.164, -.639}, {.290, -.622}},
        {{.000, -.490}, {.173, -.492}, {.336, -.509}},
        {{.000, -.333}, {.189, -.338}, {.382, -.359}},
        {{.000, -.169}, {.202, -.172}, {.416, -.185}},
        {{.000, .000}, {.207, .000}, {.428, .000}}};
      // Between the rings, anticlockwise from the lowest point.
      const double between[7][2] = {{.000, -.808},
                                    {.201, -.789},
                                    {.370, -.723},
                                    {.495, -.589},
                                    {.594, -.415},
                                    {.659, -.214},
                                    {.681, .000}};

      const auto core_vertex = [](const unsigned int i, const unsigned int j) {
        return 5 * j + i;
      };
      // Vertex k of the 13 on the rim of the core (r = 0), between the rings
      // (r = 1) and on the arc (r = 2), all from the left to the right.
      const auto ring_vertex = [&](const unsigned int r, const unsigned int k) {
        if (r > 0)
          return 25 + 13 * (r - 1) + k;
        return (k <= 4     ? core_vertex(0, 4 - k)
                  : k <= 8 ? core_vertex(k - 4, 0)
                           : core_vertex(4, k - 8));
      };

      std::vector<Point<2>> vertices(51);
      for (unsigned int j = 0; j < 5; ++j)
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Point<2> p(radius * core[j][i][0], radius * core[j][i][1]);
            vertices[core_vertex(2 + i, j)] = p;
            vertices[core_vertex(2 - i, j)] = Point<2>(-p[0], p[1]);
          }
      for (unsigned int k = 0; k < 7; ++k)
        {
          const double angle = k * numbers::PI / 12.;
          const double x = radius * between[k][0], y = radius * between[k][1];
          const double arc_x = (k == 0) ? 0. : radius * std::sin(angle);
          const double arc_y = (k == 6) ? 0. : -radius * std::cos(angle);
          vertices[ring_vertex(1, 6 + k)] = Point<2>(x, y);
          vertices[ring_vertex(1, 6 - k)] = Point<2>(-x, y);
          vertices[ring_vertex(2, 6 + k)] = Point<2>(arc_x, arc_y);
          vertices[ring_vertex(2, 6 - k)] = Point<2>(-arc_x, arc_y);
        }

      std::vector<CellData<2>> cells;
      const auto               add_cell = [&](const unsigned int       v0,
                                const unsigned int       v1,
                                const unsigned int       v2,
                                const unsigned int       v3,
                                const types::manifold_id manifold) {
        cells.emplace_back();
        cells.back().vertices    = {v0, v1, v2, v3};
        cells.back().material_id = 0;
        cells.back().manifold_id = manifold;
      };
      for (unsigned int j = 0; j < 4; ++j)
        for (unsigned int i = 0; i < 4; ++i)
          add_cell(core_vertex(i, j),
                   core_vertex(i + 1, j),
                   core_vertex(i, j + 1),
                   core_vertex(i + 1, j + 1),
                   numbers::flat_manifold_id);
      for (unsigned int r = 0; r < 2; ++r)
        for (unsigned int k = 0; k < 12; ++k)
          add_cell(ring_vertex(r + 1, k),
                   ring_vertex(r + 1, k + 1),
                   ring_vertex(r, k),
                   ring_vertex(r, k + 1),
                   ring_manifold_id);
      GridTools::consistently_order_cells(cells);
      triangulation.create_triangulation(vertices, cells, SubCellData());

      // The rings follow the arc, the core is left straight.
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->manifold_id() == ring_manifold_id)
          cell->set_all_manifold_ids(ring_manifold_id);
      for (const auto &cell : triangulation.active_cell_iterators())
        {
          if (cell->manifold_id() == numbers::flat_manifold_id)
            cell->set_all_manifold_ids(numbers::flat_manifold_id);
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              {
                const bool on_arc = (face->center()[1] < -1e-10 * radius);
                face->set_boundary_id(on_arc ? 0 : 1);
                face->set_manifold_id(on_arc ? arc_manifold_id
                                             : numbers::flat_manifold_id);
              }
        }
    }



    void
    make_half_disc(const double, Triangulation<3> &)
    {
      throw InputError("'Scene/Geometry' is 'half disc', which there is in two "
                       "dimensions only; choose another geometry.");
    }



    // Random numbers by a generator that is the same everywhere, unlike the
    // distributions of the standard library.
    template <int dim>
    void
    distort(const double         fraction,
            const Tensor<1, dim> cell_size,
            Triangulation<dim>  &triangulation)
    {
      std::vector<bool> at_boundary(triangulation.n_vertices(), false);
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            for (const unsigned int v : cell->face(f)->vertex_indices())
              at_boundary[cell->face(f)->vertex_index(v)] = true;

      std::mt19937      generator(1);
      std::vector<bool> moved(triangulation.n_vertices(), false);
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int index = cell->vertex_index(v);
            if (at_boundary[index] || moved[index])
              continue;
            moved[index] = true;
            Tensor<1, dim> shift;
            for (unsigned int d = 0; d < dim; ++d)
              shift[d] = 2. * generator() / generator.max() - 1.;
            if (shift.norm() > 1.)
              shift /= shift.norm();
            for (unsigned int d = 0; d < dim; ++d)
              cell->vertex(v)[d] += fraction * cell_size[d] * shift[d];
          }
    }
  } // namespace



  template <int dim>
  std::shared_ptr<const Function<dim>>
  Scene<dim>::make_function(const std::vector<std::string> &components,
                            const std::string              &where) const
  {
    const std::shared_ptr<const Function<dim>> function =
      parse_function<dim>(components, parameters.expressions, where);
    if (parameters.scene.rotation_angle == 0.)
      return function;
    return std::make_shared<TurnedFunction<dim>>(function, rotation);
  }



  template <int dim>
  Scene<dim>::Scene(const Parameters &parameters)
    : parameters(parameters)
    , rotation(unit_symmetric_tensor<dim>())
  {
    const std::string here = "scene '" + parameters.name + "': ";
    const auto        check_components =
      [&](const std::vector<std::string> &components,
          const std::string              &where) {
        if (components.size() != dim)
          throw InputError(where + " needs " + Utilities::int_to_string(dim) +
                           " components, but has " +
                           Utilities::int_to_string(components.size()) +
                           "; correct it.");
      };

    // Cosines of right angles shall be exact.
    const double angle   = parameters.scene.rotation_angle;
    const double radians = angle * numbers::PI / 180.;
    const bool   right   = (std::fmod(angle, 90.) == 0.);
    const double c = right ? std::round(std::cos(radians)) : std::cos(radians);
    const double s = right ? std::round(std::sin(radians)) : std::sin(radians);
    rotation[0][0] = rotation[1][1] = c;
    rotation[0][1]                  = -s;
    rotation[1][0]                  = s;

    {
      const auto &text = parameters.obstacle;
      if (text.kind == ObstacleKind::plane)
        the_obstacle = Obstacle<dim>::half_space(
          Point<dim>(rotation *
                     make_point<dim>(text.point, here + "'Obstacle/Point'")),
          rotation * make_point<dim>(text.normal, here + "'Obstacle/Normal'"));
      else if (text.kind == ObstacleKind::rods)
        {
          std::vector<Point<dim>>     centers;
          std::vector<Tensor<1, dim>> axes;
          for (const auto &center : text.centers)
            centers.emplace_back(
              rotation * make_point<dim>(center, here + "'Obstacle/Centers'"));
          if (dim == 3)
            {
              if (text.axes.size() != centers.size())
                throw InputError(here +
                                 "'Obstacle/Axes' needs one direction per "
                                 "point in 'Obstacle/Centers'; correct it.");
              for (const auto &axis : text.axes)
                axes.push_back(rotation *
                               make_point<dim>(axis, here + "'Obstacle/Axes'"));
            }
          the_obstacle = Obstacle<dim>::make_rods(centers, axes, text.radius);
        }
    }

    std::vector<bool> is_held(dim, false);
    for (const ConditionText &text :
         parameters.boundary_conditions.displacement)
      {
        const std::string where = here + "'Boundary conditions/Displacement'";
        check_components(text.components, where);
        std::vector<std::string> components = text.components;
        std::vector<bool>        mask(dim, true);
        for (unsigned int d = 0; d < dim; ++d)
          if (components[d] == "free")
            {
              mask[d]       = false;
              components[d] = "0";
            }
          else
            is_held[d] = true;
        if (angle != 0. &&
            std::find(mask.begin(), mask.end(), false) != mask.end())
          throw InputError(where +
                           " leaves a component free, which is not possible "
                           "together with 'Scene/Rotation angle'; set one of "
                           "them otherwise.");
        dirichlet.push_back({read_boundary_id(text.key, where),
                             ComponentMask(mask),
                             make_function(components, where)});
      }

    for (const ConditionText &text :
         parameters.boundary_conditions.pinned_points)
      {
        const std::string where = here + "'Boundary conditions/Pinned points'";
        check_components(text.components, where);
        if (text.key.size() < 2 || text.key.front() != '(' ||
            text.key.back() != ')')
          throw InputError(where + ": '" + text.key +
                           "' is no point; write it as '(x, y)'.");
        std::vector<double> coordinates;
        for (const std::string &coordinate :
             split_components(text.key.substr(1, text.key.size() - 2)))
          coordinates.push_back(
            parameters.expressions.evaluate(coordinate, where));
        const Point<dim> point(rotation * make_point<dim>(coordinates, where));

        Tensor<1, dim> value;
        unsigned int   n_free = 0;
        for (unsigned int d = 0; d < dim; ++d)
          if (text.components[d] == "free")
            ++n_free;
          else
            {
              value[d] =
                parameters.expressions.evaluate(text.components[d], where);
              is_held[d] = true;
            }
        if (angle != 0. && n_free > 0)
          throw InputError(where +
                           " leaves a component free, which is not possible "
                           "together with 'Scene/Rotation angle'; set one of "
                           "them otherwise.");
        value = rotation * value;
        for (unsigned int d = 0; d < dim; ++d)
          if (text.components[d] != "free")
            pinned.push_back({point, d, value[d]});
      }

    // Contact holds a body only where it is pressed, and nobody knows that in
    // advance, so the displacement conditions have to do it alone. A part of
    // the boundary and every component: that leaves out only oddities.
    if (dirichlet.empty())
      throw InputError(here +
                       "the displacement is prescribed nowhere on the "
                       "boundary, so the body can move as a rigid one; set "
                       "'Boundary conditions/Displacement'.");
    for (unsigned int d = 0; d < dim; ++d)
      if (!is_held[d])
        throw InputError(
          here + "nothing holds the body in " + std::string(1, "xyz"[d]) +
          " direction; prescribe that component in 'Boundary "
          "conditions/Displacement' or 'Boundary conditions/Pinned points'.");

    for (const ConditionText &text : parameters.boundary_conditions.traction)
      {
        const std::string where = here + "'Boundary conditions/Traction'";
        check_components(text.components, where);
        tractions.push_back({read_boundary_id(text.key, where),
                             make_function(text.components, where)});
      }

    if (!parameters.boundary_conditions.body_force.empty())
      {
        const std::string where = here + "'Boundary conditions/Body force'";
        const auto        components =
          split_components(parameters.boundary_conditions.body_force);
        check_components(components, where);
        force = make_function(components, where);
      }

    if (!parameters.scene.exact_displacement.empty())
      {
        const std::string where = here + "'Scene/Exact displacement'";
        const auto        components =
          split_components(parameters.scene.exact_displacement);
        check_components(components, where);
        exact = make_function(components, where);
      }

    if (parameters.contact.friction_law == FrictionLaw::tresca)
      bound = make_function({parameters.contact.friction_bound},
                            here + "'Contact/Friction bound'");
  }



  template <int dim>
  void
  Scene<dim>::make_coarse_mesh(Triangulation<dim> &triangulation) const
  {
    const std::string here = "scene '" + parameters.name + "': ";

    // The mesh is made in a triangulation that lives on one processor, since
    // vertices can be moved freely there, and is then copied.
    // The copy at the end takes over this mesh's policy of refinement as well,
    // which therefore has to be the one that the given triangulation has.
    Triangulation<dim> mesh(triangulation.get_mesh_smoothing());
    switch (parameters.scene.geometry)
      {
        case GeometryKind::half_disc:
          make_half_disc(parameters.scene.radius, mesh);
          break;

        case GeometryKind::rectangle:
          {
            const Point<dim> corner =
              make_point<dim>(parameters.scene.size, here + "'Scene/Size'");
            const auto &subdivisions = parameters.scene.subdivisions;
            if (subdivisions.size() != dim)
              throw InputError(here + "'Scene/Subdivisions' needs " +
                               Utilities::int_to_string(dim) +
                               " numbers, but has " +
                               Utilities::int_to_string(subdivisions.size()) +
                               "; correct it.");
            GridGenerator::subdivided_hyper_rectangle(
              mesh, subdivisions, Point<dim>(), corner, true);
            if (parameters.scene.distortion > 0.)
              {
                Tensor<1, dim> cell_size = corner;
                for (unsigned int d = 0; d < dim; ++d)
                  cell_size[d] /= subdivisions[d];
                distort(parameters.scene.distortion, cell_size, mesh);
              }
            break;
          }

        case GeometryKind::mesh_file:
          {
            std::ifstream file(parameters.scene.mesh_file);
            if (!file)
              throw InputError(here + "cannot open the mesh file '" +
                               parameters.scene.mesh_file +
                               "'; correct 'Scene/Mesh file'.");
            // A mesh of triangles may be read without complaint.
            bool is_good = true;
            try
              {
                GridIn<dim> reader;
                reader.attach_triangulation(mesh);
                reader.read_msh(file);
                is_good = mesh.all_reference_cells_are_hyper_cube();
              }
            catch (const std::exception &)
              {
                is_good = false;
              }
            if (!is_good)
              throw InputError(here + "the mesh file '" +
                               parameters.scene.mesh_file + "' is not a " +
                               Utilities::int_to_string(dim) + "D mesh of " +
                               (dim == 2 ? "quadrilaterals" : "hexahedra") +
                               " in Gmsh's .msh format; export it as such.");
            break;
          }
      }

    if (parameters.scene.rotation_angle != 0.)
      GridTools::transform(
        [&](const Point<dim> &p) { return Point<dim>(rotation * p); }, mesh);

    // Everything that the scene says about the boundary must exist.
    const std::vector<types::boundary_id> ids = mesh.get_boundary_ids();
    const auto check_id                       = [&](const types::boundary_id id,
                              const std::string       &entry) {
      if (std::find(ids.begin(), ids.end(), id) != ids.end())
        return;
      std::string known;
      for (const types::boundary_id known_id : ids)
        known +=
          (known.empty() ? "" : ", ") + Utilities::int_to_string(known_id);
      throw InputError(here + "'" + entry + "' names boundary id " +
                       Utilities::int_to_string(id) +
                       ", but the mesh has only " + known + "; correct it.");
    };
    for (const auto &condition : dirichlet)
      check_id(condition.boundary_id, "Boundary conditions/Displacement");
    for (const auto &condition : tractions)
      check_id(condition.boundary_id, "Boundary conditions/Traction");
    if (contact_boundary_id() != numbers::invalid_boundary_id)
      check_id(contact_boundary_id(), "Contact/Boundary id");
    for (const auto &pin : pinned)
      {
        const double tolerance = 1e-8 * GridTools::diameter(mesh);
        bool         found     = false;
        for (const Point<dim> &vertex : mesh.get_vertices())
          found = found || vertex.distance(pin.point) < tolerance;
        if (!found)
          throw InputError(here +
                           "'Boundary conditions/Pinned points' names a point "
                           "that is no vertex of the coarse mesh; correct it.");
      }

    triangulation.copy_triangulation(mesh);
    if (parameters.scene.geometry == GeometryKind::half_disc)
      {
        triangulation.set_manifold(arc_manifold_id, SphericalManifold<dim>());
        TransfiniteInterpolationManifold<dim> rings;
        rings.initialize(triangulation);
        triangulation.set_manifold(ring_manifold_id, rings);
      }
  }



  template <int dim>
  types::boundary_id
  Scene<dim>::contact_boundary_id() const
  {
    return parameters.contact.boundary_id < 0
      ? numbers::invalid_boundary_id
      : static_cast<types::boundary_id>(parameters.contact.boundary_id);
  }



  template <int dim>
  FrictionLaw
  Scene<dim>::friction_law() const
  {
    const auto &contact = parameters.contact;
    return (contact.friction_law == FrictionLaw::coulomb &&
            contact.friction_coefficient == 0.)
      ? FrictionLaw::none
      : contact.friction_law;
  }



  template <int dim>
  double
  Scene<dim>::friction_coefficient() const
  {
    return friction_law() == FrictionLaw::coulomb
      ? parameters.contact.friction_coefficient
      : 0.;
  }



  template class Scene<2>;
  template class Scene<3>;
} // namespace Friction
