#ifndef friction_parameters_parameters_h
#define friction_parameters_parameters_h

#include <common/parameters/expressions.h>
#include <common/parameters/material.h>
#include <common/parameters/solver_settings.h>
#include <common/parameters/wrong_number.h>

#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace Friction
{
  enum class GeometryKind
  {
    half_disc,     ///< lower half disc, centre at the origin, flat top y = 0
    rectangle,     ///< [0, L] x [0, H] (x [0, W]), a block
    cylinder,      ///< around the z axis, 0 <= z <= length
    half_cylinder, ///< a half disc for each z, 0 <= z <= length
    half_ball,     ///< lower half ball, centre at the origin, flat top z = 0
    mesh_file      ///< a mesh in Gmsh's format
  };

  /**
   * How a cylinder is cut into cells.
   */
  enum class CoarseGrid
  {
    o_grid,  ///< a core in a ring: good cells however fine
    one_cell ///< a cell whose refinements degenerate at the round boundary
  };

  enum class ObstacleKind
  {
    none,   ///< nothing in the way
    plane,  ///< a half space
    rods,   ///< discs in two dimensions, circular rods in three
    balls,  ///< in three dimensions
    surface ///< where a function is zero
  };

  enum class ContactNormal
  {
    body,    ///< the outward normal of the body at the node
    obstacle ///< from the node straight towards the obstacle, if there is one
  };

  enum class RefinementStrategy
  {
    uniform,
    adaptive
  };

  enum class Verbosity
  {
    quiet,  ///< nothing but warnings and errors
    levels, ///< one row per level
    cycles  ///< and progress inside the levels
  };

  enum class FieldFormat
  {
    vtu, ///< one file per process, with records that list them
    hdf5 ///< one file for all, with a description in XDMF
  };

  /**
   * One entry of a list of conditions as written in a scene file: a key
   * (a boundary id, or a point), and one expression per component, where
   * <tt>free</tt> says that nothing is prescribed for it.
   */
  struct ConditionText
  {
    std::string              key;
    std::vector<std::string> components;
  };

  /**
   * All that a scene file says, checked as far as that is possible without a
   * mesh. Lengths, stresses etc. are in whatever consistent units the author of
   * the scene uses; nothing in the program depends on them.
   */
  struct Parameters
  {
    struct Scene
    {
      GeometryKind              geometry = GeometryKind::rectangle;
      std::vector<double>       size;         ///< of the rectangle; empty: ones
      std::vector<unsigned int> subdivisions; ///< of the rectangle, likewise
      double                    radius      = 1.; ///< of a round body
      double                    length      = 2.; ///< of a cylinder
      CoarseGrid                coarse_grid = CoarseGrid::o_grid;
      unsigned int              layers      = 0; ///< along z; 0: as is suitable
      std::string               mesh_file;       ///< path, ready to be opened
      double                    distortion     = 0.; ///< fraction of a cell
      double                    rotation_angle = 0.; ///< degrees, around z
      std::string exact_displacement; ///< components, comma separated, or empty
    };

    struct Obstacle
    {
      ObstacleKind        kind = ObstacleKind::none;
      std::vector<double> point;  ///< on the plane; empty: 0
      std::vector<double> normal; ///< into the obstacle; empty: down
      std::vector<std::vector<double>> centers; ///< of the rods
      std::vector<std::vector<double>> axes;    ///< of the rods, 3D only
      std::vector<double>              radii;   ///< one for each, or for all
      double length  = std::numeric_limits<double>::infinity(); ///< of the rods
      bool   is_hole = false; ///< whether the body is inside of rods or balls
      std::string function;   ///< positive outside of the obstacle
    };

    struct Contact
    {
      std::string   boundary; ///< id or name; empty: no contact boundary
      FrictionLaw   friction_law         = FrictionLaw::coulomb;
      double        friction_coefficient = 0.; ///< if it is a number
      std::string   varying_coefficient;       ///< if not, an expression
      std::string   friction_bound; ///< Tresca: given stress, an expression
      ContactNormal normal                        = ContactNormal::obstacle;
      bool          ignore_prescribed_penetration = false;
    };

    struct BoundaryConditions
    {
      std::vector<ConditionText> displacement;
      std::vector<ConditionText> force;
      std::vector<ConditionText> traction;
      std::vector<ConditionText> pinned_points;
      std::string                body_force; ///< comma separated, or empty
    };

    struct LoadSteps
    {
      std::vector<double> times; ///< increasing; empty: one step, no time
    };

    struct Refinement
    {
      RefinementStrategy strategy            = RefinementStrategy::uniform;
      unsigned int       initial_refinements = 0;
      unsigned int       levels              = 0; ///< refinements after that
      unsigned int       maximum_dofs        = 0;
      double             marking             = .5; ///< of the largest indicator
      bool               contact_zone        = false;
      bool               estimate_error      = true;
    };

    /// What the units of the scene are called; empty if they have no names.
    struct UnitNames
    {
      std::string length;
      std::string force;
    };

    struct Output
    {
      std::string directory;
      bool        fields             = true;
      FieldFormat format             = FieldFormat::vtu;
      bool        principal_stresses = false; ///< among the fields
      UnitNames   units;
      bool        forces       = false; ///< print and record those on the body
      bool        checkpoint   = false; ///< one before each level but the first
      bool        verification = false; ///< write what friction-verify reads
      bool        times        = true;  ///< print what depends on the clock
      bool        profile      = false; ///< print what the solver has cost
      Verbosity   verbosity    = Verbosity::cycles;
    };

    /// A part of the body that has another material: a physical id, a name, or
    /// 'where' and an expression.
    struct RegionText
    {
      std::string key;
      Material    material;
    };

    /// One more part of the boundary that may touch something: sections
    /// 'Contact 2' and 'Obstacle 2', and so on.
    struct FurtherContact
    {
      unsigned int number = 2;
      Obstacle     obstacle;
      Contact      contact;
    };

    /// What is strange about the scene but no error: entries that it does not
    /// use. Each a sentence.
    std::vector<std::string> warnings;

    /// The same of what it would use in three dimensions only.
    std::vector<std::string> warnings_in_two_dimensions;

    std::string name; ///< stem of the scene file's name
    std::string text; ///< all parameters in effect, in the file format

    Scene    scene;
    Material material = Material(1., .3);

    /// In the order of the file; of several that a cell lies in the last
    /// counts.
    std::vector<RegionText> regions;

    Obstacle           obstacle;
    BoundaryConditions boundary_conditions;
    LoadSteps          load_steps;
    Contact            contact;

    /// Sorted by number; none in most scenes.
    std::vector<FurtherContact> further_contacts;

    Refinement     refinement;
    SolverSettings solver;
    Output         output;

    /// The constants and definitions that the expressions above may use.
    Expressions expressions;
  };

  /**
   * Read a scene file and let the overrides, each of the form
   * <tt>Section/Entry=value</tt>, have the last word, of several of an entry
   * the last one. Throws InputError, also if the file sets an entry twice.
   */
  Parameters read_parameters(const std::string              &scene_file,
                             const std::vector<std::string> &overrides = {});
} // namespace Friction

#endif
