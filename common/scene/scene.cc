#include <common/compatibility.h>
#include <common/parallel/collective_error.h>
#include <common/parallel/run_clock.h>
#include <common/parameters/parse_function.h>
#include <common/printable.h>
#include <common/scene/geometries.h>
#include <common/scene/mesh_size.h>
#include <common/scene/rigid_motions.h>
#include <common/scene/scene.h>
#include <common/scene/scene_functions.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <set>
#include <sstream>

namespace Friction
{
  namespace
  {
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
        throw InputError(where + " " +
                         wrong_number(dim, coordinates.size(), "numbers"));
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = coordinates[d];
      return p;
    }
  } // namespace



  // A number, or the name of a group of the mesh file.
  template <int dim>
  types::boundary_id
  Scene<dim>::read_boundary_id(const std::string &text,
                               const std::string &where) const
  {
    const bool is_number =
      !text.empty() && std::all_of(text.begin(), text.end(), ::isdigit);
    if (is_number && text.size() <= 9)
      return std::stoi(text);
    if (mesh_file != nullptr && !is_number)
      return mesh_file->boundary_id(text, where);
    throw InputError(
      where + ": '" + excerpt(text) +
      "' is no boundary id; give a number from 0 on" +
      (is_number ? "." : ", or the name of a group of a mesh file."));
  }



  template <int dim>
  types::material_id
  Scene<dim>::read_material_id(const std::string &text,
                               const std::string &where) const
  {
    const bool is_number =
      !text.empty() && std::all_of(text.begin(), text.end(), ::isdigit);
    if (is_number && text.size() <= 9)
      return std::stoi(text);
    if (mesh_file != nullptr && !is_number)
      return mesh_file->material_id(text, where);
    throw InputError(where + ": '" + excerpt(text) +
                     "' is no region; give the physical id of cells" +
                     (is_number ? ""
                                : ", the name of a group of a mesh file, or "
                                  "'where' and a condition") +
                     ".");
  }



  template <int dim>
  std::shared_ptr<const Function<dim>>
  Scene<dim>::make_function(const std::vector<std::string> &components,
                            const std::string              &where,
                            const double                    smallest,
                            const bool                      with_time) const
  {
    const std::shared_ptr<Function<dim>> parsed =
      parse_function<dim>(components,
                          parameters.expressions,
                          where,
                          FunctionParser<dim>::default_variable_names(),
                          with_time);
    if (with_time && parameters.expressions.has_time())
      {
        parsed->set_time(time());
        functions_of_time.push_back(parsed);
      }
    std::string text;
    for (const std::string &component : components)
      text += (text.empty() ? "" : ", ") + Utilities::trim(component);
    const std::shared_ptr<const Function<dim>> function =
      checked_function<dim>(parsed, where, text, smallest);
    return parameters.scene.rotation_angle == 0.
      ? function
      : turned_function<dim>(function, rotation);
  }



  template <int dim>
  Scene<dim>::Scene(const Parameters &parameters)
    : parameters(parameters)
    , the_materials(parameters.material)
    , rotation(unit_symmetric_tensor<dim>())
  {
    const std::string here = subject();
    const auto        check_components =
      [&](const std::vector<std::string> &components,
          const std::string              &where) {
        if (components.size() != dim)
          throw InputError(where + " " +
                           wrong_number(dim, components.size(), "components"));
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

    mesh_file = read_mesh_file();
    contacts.push_back(
      read_contact(1, parameters.contact, parameters.obstacle));
    for (const auto &further : parameters.further_contacts)
      contacts.push_back(
        read_contact(further.number, further.contact, further.obstacle));
    read_regions();
    for (unsigned int i = 0; i < contacts.size(); ++i)
      {
        const std::string &boundary = i == 0
          ? parameters.contact.boundary
          : parameters.further_contacts[i - 1].contact.boundary;
        const std::string  where =
          here + '\'' + contacts[i].section() + "/Boundary id'";
        if (!boundary.empty())
          contacts[i].boundary_id = read_boundary_id(boundary, where);
        for (unsigned int j = 0; j < i; ++j)
          if (contacts[i].has_boundary() &&
              contacts[i].boundary_id == contacts[j].boundary_id)
            throw InputError(where + " is " +
                             std::to_string(contacts[i].boundary_id) +
                             ", as is that of '" + contacts[j].section() +
                             "'; a boundary can have one of them only.");
      }

    // What is prescribed twice could be meant in two ways.
    const auto check_once = [](const auto        &conditions,
                               const std::string &where) {
      for (unsigned int i = 0; i < conditions.size(); ++i)
        for (unsigned int j = 0; j < i; ++j)
          if (conditions[i].boundary_id == conditions[j].boundary_id)
            throw InputError(where + " names boundary id " +
                             std::to_string(conditions[i].boundary_id) +
                             " twice; say all about it in one condition.");
    };

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
        if (angle != 0. &&
            std::find(mask.begin(), mask.end(), false) != mask.end())
          throw InputError(where +
                           " leaves a component free, which is not possible "
                           "together with 'Scene/Rotation angle'; set one of "
                           "them otherwise.");
        dirichlet.push_back({read_boundary_id(text.key, where),
                             ComponentMask(mask),
                             make_function(components, where),
                             nullptr});
      }

    for (const ConditionText &text :
         parameters.boundary_conditions.pinned_points)
      {
        const std::string where = here + "'Boundary conditions/Pinned points'";
        check_components(text.components, where);
        if (text.key.size() < 2 || text.key.front() != '(' ||
            text.key.back() != ')')
          throw InputError(where + ": '" + excerpt(text.key) +
                           "' is no point; write it as '" +
                           (dim == 2 ? "(x, y)" : "(x, y, z)") + "'.");
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
            }
        if (n_free == dim)
          throw InputError(where + ": all components of " + excerpt(text.key) +
                           " are free; pin one, or leave this point out.");
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
    check_once(dirichlet, here + "'Boundary conditions/Displacement'");
    read_forces();
    for (unsigned int i = 0; i < pinned.size(); ++i)
      for (unsigned int j = 0; j < i; ++j)
        if (pinned[i].point == pinned[j].point &&
            pinned[i].component == pinned[j].component)
          throw InputError(here +
                           "'Boundary conditions/Pinned points' pins the same "
                           "component of the same point twice; remove one.");
    std::sort(pinned.begin(),
              pinned.end(),
              [](const PinnedPoint<dim> &a, const PinnedPoint<dim> &b) {
                return a.point[0] < b.point[0];
              });

    for (const ConditionText &text : parameters.boundary_conditions.traction)
      {
        const std::string where = here + "'Boundary conditions/Traction'";
        check_components(text.components, where);
        tractions.push_back({read_boundary_id(text.key, where),
                             make_function(text.components, where)});
      }
    check_once(tractions, here + "'Boundary conditions/Traction'");

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

    read_friction(contacts[0], parameters.contact);
    for (unsigned int i = 1; i < contacts.size(); ++i)
      read_friction(contacts[i], parameters.further_contacts[i - 1].contact);
  }



  template <int dim>
  Obstacle<dim>
  Scene<dim>::make_obstacle(const Parameters::Obstacle &text,
                            const std::string          &section) const
  {
    const auto where = [&](const std::string &entry) {
      return subject() + '\'' + section + '/' + entry + '\'';
    };
    Obstacle<dim> obstacle;
    if (text.kind == ObstacleKind::plane)
      {
        Point<dim>     point;
        Tensor<1, dim> normal;
        normal[dim - 1] = -1.;
        if (!text.point.empty())
          point = make_point<dim>(text.point, where("Point"));
        if (!text.normal.empty())
          normal = make_point<dim>(text.normal, where("Normal"));
        obstacle = Obstacle<dim>::half_space(Point<dim>(rotation * point),
                                             rotation * normal);
      }
    else if (text.kind == ObstacleKind::surface)
      obstacle.add(std::make_shared<const LevelSurface<dim>>(
        make_function({text.function}, where("Function")), body_size()));
    else if (text.kind != ObstacleKind::none)
      {
        const bool are_balls = text.kind == ObstacleKind::balls;
        if (dim == 2 && are_balls)
          throw InputError(where("Kind") +
                           " is 'balls', which there are in three dimensions "
                           "only; take 'rods'.");
        const bool have_axes = dim == 3 && !are_balls;
        if (have_axes && text.axes.size() != text.centers.size())
          throw InputError(where("Axes") +
                           " needs one direction per point in '" + section +
                           "/Centers'; correct it.");
        for (unsigned int i = 0; i < text.centers.size(); ++i)
          {
            typename Obstacle<dim>::Rod rod;
            rod.center = Point<dim>(
              rotation * make_point<dim>(text.centers[i], where("Centers")));
            if (have_axes)
              rod.axis =
                rotation * make_point<dim>(text.axes[i], where("Axes"));
            rod.radius  = text.radii[text.radii.size() > 1 ? i : 0];
            rod.length  = text.length;
            rod.is_hole = text.is_hole;
            obstacle.add(rod);
          }
      }
    return obstacle;
  }



  template <int dim>
  ContactCondition<dim>
  Scene<dim>::read_contact(const unsigned int          number,
                           const Parameters::Contact  &contact,
                           const Parameters::Obstacle &obstacle) const
  {
    ContactCondition<dim> result;
    result.number   = number;
    result.obstacle = make_obstacle(obstacle, result.obstacle_section());
    if (!result.obstacle.empty())
      result.normal = contact.normal;
    result.ignores_prescribed_penetration =
      contact.ignore_prescribed_penetration;
    return result;
  }



  template <int dim>
  void
  Scene<dim>::read_friction(ContactCondition<dim>     &condition,
                            const Parameters::Contact &text) const
  {
    const auto where = [&](const std::string &entry) {
      return subject() + '\'' + condition.section() + '/' + entry + '\'';
    };
    condition.friction_law = text.friction_law;
    if (text.friction_law == FrictionLaw::tresca)
      condition.friction_bound =
        make_function({text.friction_bound}, where("Friction bound"), 0.);
    if (text.friction_law != FrictionLaw::coulomb)
      return;
    if (!text.varying_coefficient.empty())
      condition.varying_coefficient = make_function(
        {text.varying_coefficient}, where("Friction coefficient"), 0.);
    else
      {
        condition.friction_coefficient = text.friction_coefficient;
        if (text.friction_coefficient == 0.)
          condition.friction_law = FrictionLaw::none;
      }
  }



  template <int dim>
  void
  Scene<dim>::read_forces()
  {
    const std::string where = subject() + "'Boundary conditions/Force'";
    platen_positions.resize(dirichlet.size());
    for (const ConditionText &text : parameters.boundary_conditions.force)
      {
        if (text.components.size() != dim)
          throw InputError(
            where + " " +
            wrong_number(dim, text.components.size(), "components"));
        const types::boundary_id id = read_boundary_id(text.key, where);
        const std::string there = where + ", boundary " + std::to_string(id);
        const auto        condition =
          std::find_if(dirichlet.begin(), dirichlet.end(), [&](const auto &c) {
            return c.boundary_id == id;
          });
        if (condition == dirichlet.end())
          throw InputError(
            there +
            ": 'Displacement' does not say where it begins; give "
            "a displacement with which it is in contact.");
        if (condition->platen != nullptr)
          throw InputError(there +
                           ", is there twice; say all about it in one "
                           "condition.");

        if (text.components == std::vector<std::string>(dim, "free"))
          throw InputError(there +
                           ": all components are free; give a force, or leave "
                           "this boundary out.");
        Platen<dim>              platen;
        std::vector<std::string> components = text.components;
        for (unsigned int d = 0; d < dim; ++d)
          {
            platen.is_controlled[d] = (components[d] != "free");
            if (!platen.is_controlled[d])
              components[d] = "0";
            else if (!condition->components[d])
              throw InputError(there + ": 'Displacement' leaves component " +
                               std::to_string(d + 1) +
                               " free; give one to begin with, or no force.");
          }
        if (parameters.scene.rotation_angle != 0. &&
            std::find(text.components.begin(), text.components.end(), "free") !=
              text.components.end())
          throw InputError(where +
                           " leaves a component free, which is not possible "
                           "together with 'Scene/Rotation angle'; set one of "
                           "them otherwise.");
        // Names of coordinates that no scene file can have, so that those of
        // its own are none; when all else is known to be right.
        platen.force = make_function(components, where);
        parse_function<dim>(
          components,
          parameters.expressions,
          there +
            ", where a total force cannot depend on the place, for which there "
            "is 'Traction'",
          dim == 2 ? "no_x,no_y" : "no_x,no_y,no_z");
        // What is no number at a later time shall not be found out then.
        for (unsigned int step = 0; step < n_load_steps(); ++step)
          {
            begin_load_step(step);
            for (unsigned int d = 0; d < dim; ++d)
              platen.force->value(Point<dim>(), d);
          }
        begin_load_step(0);

        const unsigned int i = condition - dirichlet.begin();
        platen_positions[i]  = std::make_shared<Tensor<1, dim>>();
        platen.position      = platen_positions[i];
        condition->displacement =
          moved_function<dim>(condition->displacement, platen.position);
        condition->platen = std::make_shared<const Platen<dim>>(platen);
      }
  }



  template <int dim>
  void
  Scene<dim>::move_platen(const unsigned int    condition,
                          const Tensor<1, dim> &position)
  {
    AssertIndexRange(condition, dirichlet.size());
    Assert(dirichlet[condition].platen != nullptr,
           ExcMessage("This part of the boundary is no platen."));
    *platen_positions[condition] = position;
  }



  template <int dim>
  void
  Scene<dim>::begin_load_step(const unsigned int step)
  {
    Assert(step < n_load_steps(), ExcIndexRange(step, 0, n_load_steps()));
    present_step = step;
    set_times(step);
  }



  template <int dim>
  void
  Scene<dim>::set_times(const unsigned int step) const
  {
    for (const auto &function : functions_of_time)
      function->set_time(time(step));
  }



  template <int dim>
  std::string
  Scene<dim>::at_time(const unsigned int step) const
  {
    if (n_load_steps() == 1)
      return "";
    std::ostringstream text;
    text << " at the time t = " << time(step);
    return text.str();
  }



  template <int dim>
  double
  Scene<dim>::body_size() const
  {
    const auto &scene = parameters.scene;
    switch (scene.geometry)
      {
        case GeometryKind::mesh_file:
          return mesh_file->size();
        case GeometryKind::rectangle:
          {
            double sum = scene.size.empty() ? dim : 0.;
            for (const double edge : scene.size)
              sum += edge * edge;
            return std::sqrt(sum);
          }
        case GeometryKind::half_disc:
        case GeometryKind::half_ball:
          return 2. * scene.radius;
        default:
          return 2. * scene.radius + scene.length;
      }
  }



  // A region is 'where' and an expression, or what a mesh file calls it.
  template <int dim>
  void
  Scene<dim>::read_regions()
  {
    const std::string where = subject() + "'Material/Regions'";
    for (const auto &region : parameters.regions)
      if (const auto condition = condition_of_region(region.key))
        the_materials.add_region(make_function({*condition},
                                               where,
                                               -largest_number,
                                               /*with_time =*/false),
                                 region.material);
      else
        the_materials.add_region(read_material_id(region.key, where),
                                 region.material);
  }



  template <int dim>
  std::shared_ptr<const MeshFile<dim>>
  Scene<dim>::read_mesh_file() const
  {
    if (parameters.scene.geometry != GeometryKind::mesh_file)
      return nullptr;
    return std::make_shared<const MeshFile<dim>>(parameters.scene.mesh_file,
                                                 subject());
  }



  template <int dim>
  void
  Scene<dim>::make_coarse_mesh(Triangulation<dim> &triangulation) const
  {
    const RunScope part(Compatibility::mpi_communicator(triangulation),
                        RunPart::mesh);

    // The mesh is made in a triangulation that lives on one processor, since
    // vertices can be moved freely there, and is then copied. Each process
    // makes its own; a mesh file that one of them cannot read is an error of
    // all. The copy at the end takes over this mesh's policy of refinement as
    // well, which therefore has to be the one that the given triangulation has.
    check_that_mesh_fits(dim,
                         n_coarse_cells(parameters.scene),
                         0,
                         Compatibility::mpi_communicator(triangulation));
    Triangulation<dim> mesh(triangulation.get_mesh_smoothing());
    on_all_processes(Compatibility::mpi_communicator(triangulation),
                     [&]() { make_serial_mesh(mesh); });

    triangulation.copy_triangulation(mesh);
    set_manifolds(parameters.scene, triangulation);
  }



  template <int dim>
  void
  Scene<dim>::make_serial_mesh(Triangulation<dim> &mesh) const
  {
    const std::string here = subject();
    if (mesh_file == nullptr)
      mesh_file = read_mesh_file();
    if (mesh_file != nullptr)
      {
        const auto boundaries = boundary_ids();
        const auto regions    = the_materials.ids();
        mesh_file->make({boundaries.begin(), boundaries.end()},
                        {regions.begin(), regions.end()},
                        mesh);
      }
    else
      make_geometry(parameters.scene, here, mesh);

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
      throw InputError(
        here + "'" + entry + "' names boundary id " +
        Utilities::int_to_string(id) +
        (mesh_file != nullptr && mesh_file->lies_inside(id)
                                 ? ", whose faces lie inside the body; its boundary has "
                                   "only "
                                 : ", but the mesh has only ") +
        known + "; correct it.");
    };
    check_regions(mesh, here);
    for (const auto &condition : dirichlet)
      check_id(condition.boundary_id, "Boundary conditions/Displacement");
    for (const auto &condition : tractions)
      check_id(condition.boundary_id, "Boundary conditions/Traction");
    for (const auto &condition : contacts)
      if (condition.has_boundary())
        check_id(condition.boundary_id, condition.section() + "/Boundary id");
    check_pinned_points(mesh, here);
    check_that_body_can_be_held(*this, mesh, here);
    mesh_file.reset();
  }



  // What a condition says may only become true on a finer mesh; an id must be
  // there.
  template <int dim>
  void
  Scene<dim>::check_regions(const Triangulation<dim> &mesh,
                            const std::string        &here) const
  {
    if (the_materials.is_homogeneous())
      return;
    std::set<types::material_id> found;
    for (const auto &cell : mesh.active_cell_iterators())
      found.insert(cell->material_id());
    for (const types::material_id id : the_materials.ids())
      if (found.count(id) == 0)
        {
          std::string known;
          for (const types::material_id other : found)
            known += (known.empty() ? "" : ", ") + std::to_string(other);
          throw InputError(here + "'Material/Regions' names the physical id " +
                           std::to_string(id) +
                           ", but the cells of the mesh have only " +
                           excerpt(known, 100) + "; correct it.");
        }
  }



  // What is pinned is a vertex. It may lie on a boundary with prescribed
  // displacements, but not be prescribed to go somewhere else, at any time.
  template <int dim>
  void
  Scene<dim>::check_pinned_points(const Triangulation<dim> &mesh,
                                  const std::string        &here) const
  {
    if (pinned.empty())
      return;
    const double size = body_size();
    // Also if an exception is thrown.
    const std::shared_ptr<void> restores_times(
      nullptr, [&](void *) { set_times(present_step); });
    const auto check = [&](const PinnedPoint<dim>        &pin,
                           const DirichletCondition<dim> &condition) {
      for (unsigned int step = 0; step < n_load_steps(); ++step)
        {
          set_times(step);
          const double value =
            condition.displacement->value(pin.point, pin.component);
          const double rounding =
            1e-8 * (std::abs(value) + std::abs(pin.value)) + 1e-12 * size;
          const bool is_moved = condition.platen != nullptr &&
            condition.platen->is_controlled[pin.component];
          if (is_moved || std::abs(value - pin.value) > rounding)
            throw InputError(
              here +
              "'Boundary conditions/Pinned points' and 'Boundary "
              "conditions/Displacement' contradict each other in a "
              "vertex of boundary id " +
              std::to_string(condition.boundary_id) + at_time(step) +
              "; remove one of them.");
        }
    };
    std::set<const PinnedPoint<dim> *> found;
    for (const auto &cell : mesh.active_cell_iterators())
      for_each_pin(cell,
                   [&](const PinnedPoint<dim> &pin, const unsigned int v) {
                     found.insert(&pin);
                     for (const auto &face : cell->face_iterators())
                       for (const auto &condition : dirichlet)
                         if (face->at_boundary() &&
                             face->boundary_id() == condition.boundary_id &&
                             condition.components[pin.component])
                           for (const unsigned int w : face->vertex_indices())
                             if (face->vertex_index(w) == cell->vertex_index(v))
                               check(pin, condition);
                   });
    if (found.size() < pinned.size())
      throw InputError(here +
                       "'Boundary conditions/Pinned points' names a point "
                       "that is no vertex of the coarse mesh; correct it.");
  }



  template <int dim>
  unsigned int
  Scene<dim>::n_contact_boundaries() const
  {
    return std::count_if(
      contacts.begin(), contacts.end(), [](const auto &condition) {
        return condition.has_boundary();
      });
  }



  template <int dim>
  std::vector<types::boundary_id>
  Scene<dim>::boundary_ids() const
  {
    std::vector<types::boundary_id> ids;
    const auto                      add = [&](const auto &conditions) {
      for (const auto &condition : conditions)
        ids.push_back(condition.boundary_id);
    };
    add(contacts);
    add(dirichlet);
    add(tractions);
    return ids;
  }



  template <int dim>
  const ContactCondition<dim> *
  Scene<dim>::contact_on(const types::boundary_id id) const
  {
    for (const auto &condition : contacts)
      if (condition.has_boundary() && condition.boundary_id == id)
        return &condition;
    return nullptr;
  }



  template <int dim>
  std::string
  Scene<dim>::warning(const double largest_coefficient) const
  {
    // One without the other is most likely forgotten. Given friction, too,
    // acts only at nodes that may touch an obstacle, and so needs one. What the
    // first section does not have others may.
    for (const auto &condition : contacts)
      {
        const bool is_mentioned =
          condition.has_boundary() || !condition.obstacle.empty();
        if (condition.number > 1 && !condition.has_boundary())
          return "Warning: the sections '" + condition.section() + "' and '" +
            condition.obstacle_section() + "' are of no effect, since '" +
            condition.section() + "/Boundary id' names no boundary; set it.";
        if (!condition.obstacle.empty() && !condition.has_boundary())
          return "Warning: no part of the boundary may touch the obstacle, so "
                 "there "
                 "will be no contact; if there should be, set "
                 "'Contact/Boundary "
                 "id'.";
        if (is_mentioned && condition.obstacle.empty())
          return "Warning: there is no obstacle" +
            (condition.number == 1 ? std::string()
                                   : " for '" + condition.section() + "'") +
            ", so there will be no contact" +
            (contacts.size() == 1 ? "" : " there") +
            "; if there should be, set '" + condition.obstacle_section() +
            "/Kind'.";
      }

    if (n_contact_boundaries() == 0)
      return "Warning: no part of the boundary may touch anything, so that "
             "this is plain elasticity; if there should be contact, set "
             "'Contact/Boundary id' and 'Obstacle/Kind'.";

    double bound = std::numeric_limits<double>::max();
    for (const Material &material : the_materials.of_regions())
      bound = std::min(bound, eck_bound(dim, material.poisson_ratio()));
    if (largest_coefficient <= bound)
      return "";
    std::ostringstream text;
    text << "Warning: the coefficient of friction " << largest_coefficient
         << " is above Eck's bound " << std::setprecision(3) << bound
         << " for this Poisson ratio, below which a solution is known to "
            "exist; there may be none, or several.";
    return text.str();
  }



  template class Scene<2>;
  template class Scene<3>;
} // namespace Friction
