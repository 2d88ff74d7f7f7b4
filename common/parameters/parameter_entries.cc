#include <common/parameters/parameter_entries.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace Friction
{
  using namespace dealii;

  namespace
  {
    template <typename Pattern>
    std::shared_ptr<Patterns::PatternBase>
    make(const Pattern &pattern)
    {
      return pattern.clone();
    }



    /** A number of steps, or the word that leaves it to the program. */
    class StepsOrAutomatic : public Patterns::PatternBase
    {
    public:
      StepsOrAutomatic(const int smallest,
                       const int largest = std::numeric_limits<int>::max())
        : steps(smallest, largest)
      {}

      bool
      match(const std::string &text) const override
      {
        return text == "automatic" || steps.match(text);
      }

      std::string
      description(const OutputStyle style) const override
      {
        return steps.description(style) + ", or 'automatic'";
      }

      std::unique_ptr<PatternBase>
      clone() const override
      {
        return std::make_unique<StepsOrAutomatic>(*this);
      }

    private:
      const Patterns::Integer steps;
    };
  } // namespace



  const std::vector<ParameterEntry> &
  parameter_entries()
  {
    const auto text     = make(Patterns::Anything());
    const auto number   = make(Patterns::Double());
    const auto positive = make(Patterns::Double(1e-300));
    const auto steps    = make(Patterns::Integer(1));
    const auto sweeps   = make(StepsOrAutomatic(1));
    const auto flag     = make(Patterns::Bool());
    const auto choice   = [](const std::string &choices) {
      return make(Patterns::Selection(choices));
    };

    static const std::vector<ParameterEntry> table = {
      {"Scene",
       "Geometry",
       "rectangle",
       choice("half disc|rectangle|cylinder|half cylinder|half ball|"
              "mesh file"),
       "The body. 'half disc' (2D): centre at the origin, flat top y=0, "
       "boundary ids 0 (arc) and 1 (flat top). 'rectangle': [0,L]x[0,H], "
       "boundary ids 0 (left), 1 (right), 2 (bottom), 3 (top); a box in 3D, "
       "with 2, 3 in y direction and 4 (bottom), 5 (top) in z direction. "
       "'cylinder' (3D): around the z axis, boundary ids 0 (mantle), 1 (end "
       "z=0), 2 (end z=L). 'half cylinder' (3D): the half disc along 0<z<L, "
       "boundary ids 0 (mantle), 1 (flat top), 2 (end z=0), 3 (end z=L). "
       "'half ball' (3D): centre at the origin, flat top z=0, boundary ids 0 "
       "(sphere) and 1 (flat top). 'mesh file': physical ids are the boundary "
       "ids, and names of physical groups stand for them."},
      {"Scene",
       "Size",
       "",
       text,
       "Edge lengths of the rectangle, one per dimension; constant "
       "expressions, all 1 if empty [length]."},
      {"Scene",
       "Subdivisions",
       "",
       text,
       "Number of coarse cells of the rectangle, one per dimension; all 1 if "
       "empty."},
      {"Scene",
       "Radius",
       "1",
       positive,
       "Radius of the half disc, the cylinders, the half ball [length]."},
      {"Scene",
       "Length",
       "2",
       positive,
       "Length of the cylinders in z direction [length]."},
      {"Scene",
       "Coarse grid",
       "O-grid",
       choice("O-grid|one cell"),
       "Of the cylinder. 'O-grid': good cells however fine the mesh. 'one "
       "cell': a single one, whose refinements degenerate at the mantle."},
      {"Scene",
       "Layers",
       "0",
       make(Patterns::Integer(0, 100000)),
       "Number of layers of coarse cells along the cylinders, unless there is "
       "but one cell; 0 for as many as make cells about as long as wide."},
      {"Scene",
       "Mesh file",
       "",
       text,
       "Mesh in Gmsh's .msh format, version 2.2 or 4.1, text or binary, "
       "quadrilaterals or hexahedra; a relative path starts at the folder of "
       "the scene file."},
      {"Scene",
       "Distortion",
       "0",
       make(Patterns::Double(0., .4)),
       "Move interior vertices of the coarse rectangle by up to this "
       "fraction "
       "of a coarse cell in a random, reproducible direction."},
      {"Scene",
       "Rotation angle",
       "0",
       number,
       "Turn everything, mesh, obstacle, loads and prescribed displacements, "
       "by this angle around the origin, in 3D around the z axis [degrees]."},
      {"Scene",
       "Constants",
       "",
       text,
       "Numbers with a name, for use in expressions: 'a = 1; b = 2*a'. E, "
       "nu, "
       "lambda, mu (material), F (friction coefficient, if it is a number) and "
       "pi are there already."},
      {"Scene",
       "Definitions",
       "",
       text,
       "Expressions with a name, which may use the coordinates, the "
       "constants and the definitions before them: 'r = sqrt(x^2+y^2)'. F is "
       "one of them if the friction coefficient is an expression."},
      {"Scene",
       "Exact displacement",
       "",
       text,
       "The solution if it is known, to report errors: one expression per "
       "component, separated by commas [length]."},

      {"Material",
       "Young's modulus",
       "1",
       number,
       "Positive [stress]. The body is isotropic; in 2D plane strain."},
      {"Material",
       "Poisson ratio",
       "0.3",
       number,
       "Between -1 and 1/2, and farther from both than 5e-11."},
      {"Material",
       "Volumetric strain",
       "pointwise",
       choice("pointwise|mean"),
       "Of the discrete body. 'mean': its mean over each cell, for nearly "
       "incompressible materials, from a Poisson ratio of about 0.45 on, where "
       "'pointwise' makes the body too stiff."},
      {"Material",
       "Regions",
       "",
       text,
       "Other materials in parts of the body, 'region: E, nu', separated by "
       "';', with Young's modulus and the Poisson ratio as constant "
       "expressions, and ', mean' or ', pointwise' behind them if the "
       "volumetric strain is another one there. A region is a physical id or a "
       "name of the mesh file, or 'where' and a condition in x, y (and z) that "
       "is asked in the middle of each cell, as in 'where y > 0.9: 100*E, nu'. "
       "If a cell is in several, the last counts."},

      {"Obstacle",
       "Kind",
       "none",
       choice("none|plane|rods|balls|surface"),
       "The rigid obstacle: a half space, circular rods (discs in 2D), balls "
       "(3D), or what a function says."},
      {"Obstacle",
       "Point",
       "",
       text,
       "A point of the plane; constant expressions, the origin if empty "
       "[length]."},
      {"Obstacle",
       "Normal",
       "",
       text,
       "Normal of the plane, into the obstacle, of any length from 1e-30 on; "
       "straight down, "
       "against the last coordinate, if empty."},
      {"Obstacle",
       "Centers",
       "",
       text,
       "A point on the axis of each rod, or the centre of each ball, separated "
       "by ';' [length]."},
      {"Obstacle",
       "Axes",
       "",
       text,
       "3D: direction of the axis of each rod, of any length from 1e-30 on, "
       "separated by ';'."},
      {"Obstacle",
       "Radius",
       "1",
       text,
       "Of all rods or balls, or of each, separated by ';'; constant "
       "expressions [length]."},
      {"Obstacle",
       "Side",
       "outside",
       choice("outside|inside"),
       "Of rods and balls: where the body is. 'inside': they are holes in the "
       "obstacle, and the body is in one of them."},
      {"Obstacle",
       "Function",
       "",
       text,
       "Of a surface: an expression in x, y (and z) that is positive where the "
       "body may be and negative in the obstacle, its distance or anything "
       "else with a slope at the surface, as in 'y + 1 - 0.01*cos(20*x)'. Down "
       "that slope is straight to the obstacle."},
      {"Obstacle",
       "Length",
       "",
       text,
       "3D: length of the rods, the given points being their middles; a "
       "constant expression, infinite if empty. Only their round surface may "
       "be touched, and not their ends [length]."},

      {"Boundary conditions",
       "Displacement",
       "",
       text,
       "Prescribed displacements, 'id: u_x, u_y', in 3D 'id: u_x, u_y, u_z', "
       "separated by ';'. Each component is an expression in x, y (and z), or "
       "'free' [length]."},
      {"Boundary conditions",
       "Force",
       "",
       text,
       "Total forces on the body, 'id: F_x, F_y', in 3D 'id: F_x, F_y, F_z', "
       "separated by ';'. Each component is an expression without "
       "coordinates, or 'free' [force]. That part of the boundary is then a "
       "rigid platen: it is moved in this direction, without turning, until "
       "what holds it exerts this force. 'Displacement' prescribes where it "
       "begins, which should be in contact. Forces are then printed as with "
       "'Output/Forces'."},
      {"Boundary conditions",
       "Traction",
       "",
       text,
       "Boundary stresses, 'id: t_x, t_y', in 3D 'id: t_x, t_y, t_z', "
       "separated by ';' [stress]."},
      {"Boundary conditions",
       "Pinned points",
       "",
       text,
       "Displacements prescribed in single vertices, '(x, y): u_x, u_y', in "
       "3D '(x, y, z): u_x, u_y, u_z', separated by ';', a component being "
       "constant or 'free' [length]."},
      {"Boundary conditions",
       "Body force",
       "",
       text,
       "Force per volume, one expression per component, separated by commas "
       "[stress/length]."},

      {"Load steps",
       "Times",
       "",
       text,
       "Increasing times at which the scene is solved, one after the other, "
       "separated by commas; constant expressions. Expressions may then use "
       "the time t: displacements, tractions, body forces, a surface, "
       "friction. "
       "Between two times friction acts against the increment of slip. The "
       "mesh "
       "is refined at the first time, and kept then. Empty: one step, without "
       "t."},

      {"Contact",
       "Boundary id",
       "-1",
       text,
       "The part of the boundary that may touch the obstacle, an id or the "
       "name "
       "of a group of the mesh file; -1 for none. Where another part may touch "
       "something else, or by another law, sections 'Contact 2' and 'Obstacle "
       "2' say so, with the entries of 'Contact' and 'Obstacle'; and so on."},
      {"Contact",
       "Friction law",
       "Coulomb",
       choice("none|Tresca|Coulomb"),
       "'Tresca': the bound of the tangential stress is given. 'Coulomb': it "
       "is the friction coefficient times the normal stress."},
      {"Contact",
       "Friction coefficient",
       "0",
       text,
       "Of Coulomb's law; with 0 nothing of friction is computed. Where it "
       "varies an expression, which is nowhere negative, and which may use "
       "definitions that do not use F. It is evaluated at the nodes of the "
       "body before that is deformed."},
      {"Contact",
       "Friction bound",
       "0",
       text,
       "Of Tresca's law: the largest tangential stress, an expression "
       "[stress]."},
      {"Contact",
       "Contact normal",
       "obstacle",
       choice("body|obstacle"),
       "Direction in which the gap is measured, and across which friction "
       "acts. "
       "'obstacle': straight towards the obstacle. 'body': the outward normal "
       "of the body, as in the thesis; only where the two are nearly the same "
       "do forces obey the law of friction, on a slope or at corners they do "
       "not. Without an obstacle it is that of the body."},

      {"Contact",
       "Ignore prescribed penetration",
       "false",
       flag,
       "Whether a node of the contact boundary may be prescribed to lie inside "
       "the obstacle, and is then no contact node. Otherwise this is an error: "
       "where such a node meets others that must not penetrate, the stress has "
       "a singularity without finite energy."},

      {"Refinement",
       "Strategy",
       "uniform",
       choice("uniform|adaptive"),
       "How the mesh is refined from level to level."},
      {"Refinement",
       "Initial refinements",
       "0",
       make(Patterns::Integer(0, 15)),
       "Uniform refinements of the coarse mesh before the first solution."},
      {"Refinement",
       "Levels",
       "0",
       make(Patterns::Integer(0, 25)),
       "Number of refinements after that, with a solution on each mesh."},
      {"Refinement",
       "Maximum dofs",
       "10000000",
       steps,
       "Stop refining when a mesh has this many degrees of freedom."},
      {"Refinement",
       "Marking",
       "0.5",
       make(Patterns::Double(1e-300, 1.)),
       "Adaptive: refine cells with at least this fraction of the largest "
       "error indicator."},
      {"Refinement",
       "Contact zone",
       "false",
       flag,
       "Adaptive: besides what the estimator marks, refine every cell whose "
       "boundary is in contact, so that the contact stresses are resolved "
       "equally well everywhere."},
      {"Refinement",
       "Estimate error",
       "true",
       flag,
       "Whether to estimate the error also where refinement does not need "
       "it."},

      {"Solver",
       "Algorithm",
       "Gauss-Seidel like",
       choice("fixed point|Gauss-Seidel like"),
       "How the normal stress in Coulomb's law is found: in an outer "
       "iteration (Algorithm 2), or within the relaxation (Algorithm 3)."},
      {"Solver",
       "Coarse correction",
       "truncated",
       choice("truncated|monotone|aggregates|algebraic"),
       "'truncated': unconstrained, with a line search. 'monotone': within "
       "coarse obstacles. 'aggregates': as 'truncated', and once more on "
       "levels "
       "that are made of the matrix; good where materials jump within coarse "
       "cells. 'algebraic': not by coarse levels, but by solving "
       "the linearised problem on the leaf mesh, with Trilinos; dear, and "
       "good where coarse levels are of no help, as with very long cells."},
      {"Solver", "Cycle", "V", choice("V|W"), "Kind of the multigrid cycle."},
      {"Solver",
       "Smoothing steps",
       "automatic",
       sweeps,
       "Relaxation sweeps on the leaf mesh, before and after the "
       "coarse correction. 'automatic': 3, and more the less compressible the "
       "material is, beyond a Poisson ratio of 0.477, or of 0.456 with mean "
       "strains."},
      {"Solver",
       "Coarse smoothing steps",
       "automatic",
       sweeps,
       "The same on the correction levels. 'automatic': 6, or more likewise."},
      {"Solver",
       "Coarsest solver",
       "automatic",
       choice("automatic|direct|algebraic multigrid"),
       "How the coarsest mesh is solved: by a sparse factorisation, by "
       "conjugate gradients with algebraic multigrid, or by whichever is "
       "quicker for its size and shape."},
      {"Solver",
       "Truncation",
       "phases",
       choice("phases|contact|phases without second order"),
       "What coarse functions lose at a node in contact: what its phase "
       "fixes, everything, or the former without the second derivative "
       "of friction."},
      {"Solver",
       "Local solver",
       "secular equation",
       choice("secular equation|Uzawa"),
       "3D: how the slip of a single node is found. 'secular equation': one "
       "scalar equation for its direction. 'Uzawa': an iteration for the "
       "tangential force. In 2D there are but two directions to choose from."},
      {"Solver",
       "Inner tolerance",
       "1e-9",
       text,
       "Relative increment that stops the multigrid iteration. "
       "'discretisation': "
       "stop when its error is a tenth of the estimated one of the mesh, on "
       "all "
       "meshes but the first."},
      {"Solver",
       "Outer tolerance",
       "2e-7",
       positive,
       "Relative change of the normal forces that stops the outer "
       "iteration; divided by the coefficient of friction if that is larger "
       "than one."},
      {"Solver",
       "Certificate tolerance",
       "1e-6",
       make(Patterns::Double(1e-300, .1)),
       "By how much, relative to the peak contact pressure, a valid solution "
       "may violate the discrete law at any node, 0.1 at most; at least 0.01 "
       "with the inner "
       "tolerance 'discretisation'."},
      {"Solver",
       "Maximum cycles",
       "200",
       steps,
       "Give up after this many multigrid cycles of one iteration."},
      {"Solver",
       "Total cycles",
       "5000",
       steps,
       "Give up after this many multigrid cycles of all attempts that "
       "safeguards make on a level, for all positions of platens that are "
       "tried "
       "there. Each attempt gets half of those that are left."},
      {"Solver",
       "Maximum outer iterations",
       "50",
       steps,
       "Give up after this many outer iterations on a level."},
      {"Solver",
       "Maximum step length",
       "2",
       positive,
       "Largest step length of the line search."},
      {"Solver",
       "Recombined steps",
       "automatic",
       make(StepsOrAutomatic(0, 20)),
       "Number of previous steps that a truncated coarse correction is "
       "recombined with; 0 for none. 'automatic': 1, or 5 from a Poisson "
       "ratio of 0.498 on."},
      {"Solver",
       "Outer damping",
       "1",
       make(Patterns::Double(1e-3, 1.)),
       "Damping of the outer iteration; 1 is undamped."},
      {"Solver",
       "Mixed outer iterations",
       "0",
       make(Patterns::Integer(0, 100)),
       "Number of previous outer iterations that the normal forces of the next "
       "one are mixed from (Anderson mixing); 0 for none."},
      {"Solver",
       "Safeguards",
       "true",
       flag,
       "Whether to give up an iteration that is getting nowhere, and to try "
       "others: shorter steps, levels made of the matrix, algebraic "
       "corrections, Algorithm 2 with mixed "
       "normal forces, or with small steps of them, less friction first."},
      {"Solver",
       "Condensation",
       "where quicker",
       choice("never|where cycles are many|where quicker"),
       "Where the safeguards solve the problem on contact nodes alone: all "
       "other nodes are eliminated first, once and for all. 'where cycles are "
       "many': where materials jump or are nearly incompressible, where most "
       "cells are stretched in 3D, or where others have failed, if it takes no "
       "longer than these would. 'where quicker': also on meshes of some "
       "hundreds of "
       "unknowns, up to a few thousand, where that takes no longer than the "
       "cycles to a given tolerance, as the inner tolerance or on the first "
       "mesh."},

      {"Output",
       "Directory",
       "output",
       text,
       "Where results go; it is created."},
      {"Output", "Fields", "true", flag, "Whether to write fields."},
      {"Output",
       "Format",
       "vtu",
       choice("vtu|hdf5"),
       "Files of the fields. 'vtu': one per process and level, and records "
       "(.pvtu, .pvd) that list them. 'hdf5': for the body one .h5 per level, "
       "written by all processes together, and body.xdmf; the contact boundary "
       "is small and stays in .vtu files."},
      {"Output",
       "Principal stresses",
       "false",
       flag,
       "Whether the fields have the principal stresses, the largest first, "
       "besides the tensor of which they are the eigenvalues."},
      {"Output",
       "Units",
       "",
       text,
       "What the units of the scene are called, 'length: mm, force: N' for "
       "example: labels of the numbers in history.h5, of levels.csv and of "
       "pictures, from which those of stresses and energies follow. Nothing is "
       "converted."},
      {"Output",
       "Forces",
       "false",
       flag,
       "Whether the run prints in the end, and records for each level in "
       "history.h5, the forces on the body: those of the obstacle, those of "
       "what holds the body where displacements are prescribed, and the loads; "
       "and how well they balance."},
      {"Output",
       "Checkpoint",
       "false",
       flag,
       "Whether to write a checkpoint after each level and each load step but "
       "the last one, from which --restart continues. The last two are kept, "
       "also at the end of the run: continued with more levels, a run of a "
       "single load step solves its last level once more and goes on."},
      {"Output",
       "Verification",
       "false",
       flag,
       "Whether to write for each level what friction-verify, a program that "
       "shares no code with this one, needs to recompute its residual and the "
       "discrete law: verify-NN.h5."},
      {"Output",
       "Times",
       "true",
       flag,
       "Whether the console shows what depends on the clock: seconds and "
       "progress."},
      {"Output",
       "Profile",
       "false",
       flag,
       "Whether the console shows for each level what the parts of the solver "
       "have cost: messages, bytes and reductions per cycle and process, and "
       "seconds if 'Times' are wanted; then also the parts of the whole run at "
       "its end, on the first process."},
      {"Output",
       "Verbosity",
       "cycles",
       choice("quiet|levels|cycles"),
       "What the console shows: only warnings, a row per level, and progress "
       "inside the levels."}};
    return table;
  }



  NumberedSection
  numbered_section(const std::string &section)
  {
    for (const std::string base : {"Contact", "Obstacle"})
      if (section.compare(0, base.size() + 1, base + " ") == 0)
        {
          const std::string digits    = section.substr(base.size() + 1);
          const bool        is_number = !digits.empty() && digits.size() <= 2 &&
            digits[0] != '0' &&
            std::all_of(digits.begin(),
                        digits.end(),
                        [](const unsigned char c) { return std::isdigit(c); });
          if (is_number && digits != "1")
            return {base, static_cast<unsigned int>(std::stoi(digits))};
        }
    return {section, 1};
  }



  std::string
  section_name(const std::string &base, const unsigned int number)
  {
    return number == 1 ? base : base + ' ' + std::to_string(number);
  }
} // namespace Friction
