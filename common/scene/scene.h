#ifndef friction_scene_scene_h
#define friction_scene_scene_h

#include <common/parameters/parameters.h>
#include <common/scene/materials.h>
#include <common/scene/mesh_file.h>
#include <common/scene/obstacle.h>

#include <deal.II/base/function.h>
#include <deal.II/base/types.h>

#include <deal.II/fe/component_mask.h>

#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * A part of the boundary that is moved as a rigid body, without being turned,
   * until the total force on it is a given one.
   */
  template <int dim>
  struct Platen
  {
    /// Of which components the force is given, not the displacement.
    std::array<bool, dim> is_controlled;

    /// What holds the boundary exerts on the body, dim components, the same
    /// everywhere; of no meaning where the displacement is given.
    std::shared_ptr<const Function<dim>> force;

    /// How far it is from where 'Displacement' has it, a length.
    std::shared_ptr<const Tensor<1, dim>> position;
  };

  /**
   * A part of the boundary where (some components of) the displacement are
   * prescribed.
   */
  template <int dim>
  struct DirichletCondition
  {
    types::boundary_id boundary_id;

    /// The components that are prescribed.
    ComponentMask components;

    /// The displacement, dim components, a length. That of a platen is where it
    /// has been moved to.
    std::shared_ptr<const Function<dim>> displacement;

    /// Null if all displacements are given.
    std::shared_ptr<const Platen<dim>> platen;
  };

  /**
   * A part of the boundary with given traction.
   */
  template <int dim>
  struct TractionCondition
  {
    types::boundary_id boundary_id;

    /// The boundary stress, dim components.
    std::shared_ptr<const Function<dim>> traction;
  };

  /**
   * A part of the boundary that may touch an obstacle, and by which law.
   */
  template <int dim>
  struct ContactCondition
  {
    /// 1 for the section 'Contact', 2 for 'Contact 2', ...
    unsigned int number = 1;

    /// Invalid if there is no such part of the boundary.
    types::boundary_id boundary_id = numbers::invalid_boundary_id;

    Obstacle<dim> obstacle;

    /// Without an obstacle that of the body.
    ContactNormal normal = ContactNormal::body;

    /// Whether nodes may be prescribed to lie inside the obstacle.
    bool ignores_prescribed_penetration = false;

    /// Coulomb's law with a coefficient of zero is no friction, so that nothing
    /// is computed for it.
    FrictionLaw friction_law = FrictionLaw::none;

    /// Coulomb's law: the coefficient, if it is the same everywhere; zero if
    /// not, and with the other laws.
    double friction_coefficient = 0.;

    /// Coulomb's law, where it is not the same everywhere: a function of one
    /// component on the body as it is before it is deformed; null if it is.
    std::shared_ptr<const Function<dim>> varying_coefficient;

    /// Tresca's law: the largest tangential stress, one component; null for the
    /// other laws.
    std::shared_ptr<const Function<dim>> friction_bound;

    bool
    has_boundary() const
    {
      return boundary_id != numbers::invalid_boundary_id;
    }

    /// The names of its sections.
    std::string
    section() const
    {
      return section_of("Contact");
    }

    std::string
    obstacle_section() const
    {
      return section_of("Obstacle");
    }

  private:
    std::string
    section_of(const std::string &base) const
    {
      return number == 1 ? base : base + ' ' + std::to_string(number);
    }
  };

  /**
   * One component of the displacement prescribed in one vertex of the mesh,
   * to rule out a rigid-body motion.
   */
  template <int dim>
  struct PinnedPoint
  {
    Point<dim>   point;
    unsigned int component;
    double       value; ///< a length
  };



  /**
   * What is modelled: the body and its mesh, its material, how it is held and
   * loaded, what it may touch, and by which law of friction.
   *
   * Boundary ids of the meshes made here: half disc 0 the arc, 1 the flat top;
   * rectangle 0 left, 1 right, 2 bottom, 3 top (in three dimensions 0 and 1 in
   * x direction, 2 and 3 in y, 4 bottom and 5 top); cylinder 0 the mantle, 1
   * and 2 its ends; half cylinder 0 the mantle, 1 the flat top, 2 and 3 its
   * ends; half ball 0 the sphere, 1 the flat top. Those of a mesh file are its
   * physical ids.
   *
   * A rotation angle turns the whole scene around the origin (in three
   * dimensions around the z axis), so that every function here is that of the
   * turned scene.
   */
  template <int dim>
  class Scene
  {
  public:
    /**
     * Reads the mesh file, if there is one. Throws InputError if that cannot be
     * read, or if the parameters do not describe a scene in dim dimensions.
     */
    explicit Scene(const Parameters &parameters);

    /**
     * Fill a given empty triangulation, which may be a distributed one, with
     * the coarse mesh and set its boundary ids and manifolds. Throws
     * InputError if the mesh lacks a boundary id or a pinned point that the
     * scene mentions, or if a part of the body can move as a rigid one, see
     * check_that_body_can_be_held(). A mesh file is then forgotten, since it is
     * as large as the mesh, and read again if another mesh is wanted.
     */
    void make_coarse_mesh(Triangulation<dim> &triangulation) const;

    /**
     * Goes to the time of a load step: from now on all functions of the scene
     * are those at this time. A new scene is at the first one.
     */
    void begin_load_step(const unsigned int step);

    /// The present step, counted from 0, and how many there are.
    unsigned int
    load_step() const
    {
      return present_step;
    }

    unsigned int
    n_load_steps() const
    {
      return std::max<std::size_t>(1, parameters.load_steps.times.size());
    }

    /// Its time, zero if the scene says nothing of times.
    double
    time() const
    {
      return time(present_step);
    }

    /// The same of any step.
    double
    time(const unsigned int step) const
    {
      return parameters.load_steps.times.empty()
        ? 0.
        : parameters.load_steps.times[step];
    }

    /// As sentences about it begin.
    std::string
    subject() const
    {
      return "scene '" + parameters.name + "': ";
    }

    /// " at the time t = 2" of a step, or nothing if there is no history.
    std::string at_time(const unsigned int step) const;

    /// The same of the present step.
    std::string
    at_time() const
    {
      return at_time(present_step);
    }

    /// As sentences begin about what may be otherwise at other times.
    std::string
    subject_at_time() const
    {
      return "scene '" + parameters.name + "'" + at_time() + ": ";
    }

    /// What the body is made of.
    const Materials<dim> &
    materials() const
    {
      return the_materials;
    }

    const std::vector<DirichletCondition<dim>> &
    dirichlet_conditions() const
    {
      return dirichlet;
    }

    /**
     * Moves the platen of a condition: from now on the prescribed displacement
     * is that of 'Displacement' and this vector. A discretisation has to be
     * told, see Discretization::update_prescribed_values().
     */
    void move_platen(const unsigned int    condition,
                     const Tensor<1, dim> &position);

    /// Sorted by x.
    const std::vector<PinnedPoint<dim>> &
    pinned_points() const
    {
      return pinned;
    }

    /**
     * Calls a function with each component that is pinned in a vertex of a
     * cell, and the number of that vertex in the cell. How near they have to be
     * is a matter of the coarse mesh, so that what is pinned there is on any
     * finer one.
     */
    template <typename Cell, typename Action>
    void for_each_pin(const Cell &cell, const Action &action) const;

    const std::vector<TractionCondition<dim>> &
    traction_conditions() const
    {
      return tractions;
    }

    /// Force per volume, dim components; null if there is none.
    std::shared_ptr<const Function<dim>>
    body_force() const
    {
      return force;
    }

    /// Displacement that solves the problem, dim components; null if unknown.
    std::shared_ptr<const Function<dim>>
    exact_displacement() const
    {
      return exact;
    }

    /**
     * What the body may touch, and where: sections 'Contact' and 'Obstacle',
     * then 'Contact 2' and 'Obstacle 2', and so on. The first is always there;
     * one that has no boundary is of no effect.
     */
    const std::vector<ContactCondition<dim>> &
    contact_conditions() const
    {
      return contacts;
    }

    /// The number of conditions that have a boundary.
    unsigned int n_contact_boundaries() const;

    /// The boundary ids of all conditions, in their order; an invalid one of a
    /// contact condition that has no boundary.
    std::vector<types::boundary_id> boundary_ids() const;

    /// The condition of a part of the boundary; null if it may touch nothing.
    const ContactCondition<dim> *contact_on(const types::boundary_id id) const;

    /**
     * What a user should know before believing a solution, or nothing: that
     * there is an obstacle but no boundary that may touch it, or the other way
     * round, or that the coefficient of friction is above Eck's bound.
     *
     * @param largest_coefficient  of friction, on all contact boundaries.
     */
    std::string warning(const double largest_coefficient) const;

  private:
    /// The largest distance of two points of the body, or a little more.
    double body_size() const;

    void read_regions();

    /// Both, of a section that has this number.
    Obstacle<dim> make_obstacle(const Parameters::Obstacle &text,
                                const std::string          &section) const;

    ContactCondition<dim>
    read_contact(const unsigned int          number,
                 const Parameters::Contact  &contact,
                 const Parameters::Obstacle &obstacle) const;

    /// What is asked for along the boundary, once names can be understood.
    void read_friction(ContactCondition<dim>     &condition,
                       const Parameters::Contact &text) const;

    /// The coarse mesh on one process, checked.
    void make_serial_mesh(Triangulation<dim> &mesh) const;

    /// Has all functions take the time of a step.
    void set_times(const unsigned int step) const;

    void check_pinned_points(const Triangulation<dim> &mesh,
                             const std::string        &here) const;

    void check_regions(const Triangulation<dim> &mesh,
                       const std::string        &here) const;

    types::boundary_id read_boundary_id(const std::string &text,
                                        const std::string &where) const;

    types::material_id read_material_id(const std::string &text,
                                        const std::string &where) const;

    /// The mesh file, or null if the body comes from elsewhere.
    std::shared_ptr<const MeshFile<dim>> read_mesh_file() const;

    Parameters   parameters;
    unsigned int present_step = 0;

    /// Those that depend on the time.
    mutable std::vector<std::shared_ptr<Function<dim>>> functions_of_time;

    /// What read_mesh_file() gave us, until there is a mesh.
    mutable std::shared_ptr<const MeshFile<dim>> mesh_file;

    Materials<dim> the_materials;
    Tensor<2, dim> rotation;

    std::vector<ContactCondition<dim>>   contacts;
    std::vector<DirichletCondition<dim>> dirichlet;
    std::vector<TractionCondition<dim>>  tractions;

    /// Of each Dirichlet condition, for those that have a platen.
    std::vector<std::shared_ptr<Tensor<1, dim>>> platen_positions;
    std::vector<PinnedPoint<dim>>                pinned;
    std::shared_ptr<const Function<dim>>         force;
    std::shared_ptr<const Function<dim>>         exact;

    /// Makes platens of the conditions that are in 'Force'.
    void read_forces();

    std::shared_ptr<const Function<dim>>
    make_function(const std::vector<std::string> &components,
                  const std::string              &where,
                  const double                    smallest  = -largest_number,
                  const bool                      with_time = true) const;
  };



  template <int dim>
  template <typename Cell, typename Action>
  void
  Scene<dim>::for_each_pin(const Cell &cell, const Action &action) const
  {
    if (pinned.empty())
      return;
    const double tolerance = std::ldexp(1e-8 * cell->diameter(), cell->level());
    for (const unsigned int v : cell->vertex_indices())
      {
        const Point<dim> vertex = cell->vertex(v);
        for (auto pin =
               std::lower_bound(pinned.begin(),
                                pinned.end(),
                                vertex[0] - tolerance,
                                [](const PinnedPoint<dim> &p, const double x) {
                                  return p.point[0] < x;
                                });
             pin != pinned.end() && pin->point[0] <= vertex[0] + tolerance;
             ++pin)
          if (vertex.distance(pin->point) < tolerance)
            action(*pin, v);
      }
  }
} // namespace Friction

#endif
