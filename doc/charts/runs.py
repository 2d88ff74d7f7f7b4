"""What is measured for the charts, and how large. Sizes are chosen such that all
of it takes about forty minutes; the quick variant takes a minute and
shows no more than that everything works.

Everything that belongs to a chart is in one place here: the name of the chart,
the subject that is written below its title, the scene, and the sizes.
"""


# All parts that can be asked for, and those of them for which nothing is measured.
PARTS = ("precision", "cycles", "solvers", "stopping", "stability", "bounds",
         "runs")
DRAWN_ONLY = ("bounds", "runs")

UNIFORM = ["Refinement/Strategy=uniform"]


class Precision:
    """Chart 1. The adaptive run comes first: its reference knows the half-widths
    best, and they are used for the uniform run as well."""

    def __init__(self, name, dim, scene, subject, uniform, adaptive, common=(),
                 half_widths=None):
        self.name, self.dim, self.scene = name, dim, scene
        self.subject, self.half_widths = subject, half_widths
        self.common = list(common)
        self.adaptive, self.uniform = adaptive, uniform


def dofs(number):
    return [f"Refinement/Maximum dofs={number}", "Refinement/Levels=25"]


def precision(quick):
    """Pairs (reference, overrides) of the uniform and of the adaptive run."""
    ends = ["Obstacle/Length=1.5", "Contact/Friction coefficient=1"]
    coarse = "Refinement/Initial refinements="
    return [
        Precision(
            "manufactured", 2, "manufactured",
            "Scene manufactured (2D): lift-off, slip and stick with a known "
            "smooth solution; errors against this solution.",
            (None, dofs(500 if quick else 500000)),
            (None, dofs(500 if quick else 100000)),
            half_widths="1,0.5"),
        Precision(
            "hertz", 2, "hertz",
            "Scene hertz (2D): a half disc on a plane, F = 0.4; errors against "
            "the last mesh refined globally twice more.",
            ("uniform:2", dofs(1000 if quick else 60000)),
            ("uniform:2", dofs(600 if quick else 65000))),
        Precision(
            "cylinder", 3, "cylinder",
            "Scene cylinder (3D), F = 0.4: its displacements jump at the ends of "
            "the contact zones, so that they have no finite energy.",
            (("uniform:1", [coarse + "0"] + dofs(100)) if quick else
             ("uniform:2", [coarse + "0"] + dofs(5000))),
            (("adaptive:1", [coarse + "0"] + dofs(100)) if quick else
             ("adaptive:2", [coarse + "1"] + dofs(50000)))),
        Precision(
            "cylinder-ends", 3, "cylinder",
            "Scene cylinder (3D) on rods that end before it does "
            "(Obstacle/Length = 1.5), F = 1.",
            (("uniform:1", [coarse + "0"] + dofs(100)) if quick else
             ("uniform:2", [coarse + "0"] + dofs(20000))),
            (("adaptive:1", [coarse + "0"] + dofs(100)) if quick else
             ("adaptive:3", [coarse + "1"] + dofs(20000))), common=ends),
    ]


class Cycles:
    """Chart 4."""

    def __init__(self, name, dim, scene, subject, frictions, overrides,
                 first_level):
        self.name, self.dim, self.scene = name, dim, scene
        self.subject, self.overrides = subject, overrides
        self.frictions, self.first_level = frictions, first_level


TRUNCATIONS = ("phases", "contact", "phases without second order")
CORRECTIONS = ("truncated", "monotone")
MOST_CYCLES = 100


def cycles(quick):
    frictions = ("0.4",) if quick else ("0.05", "0.4", "1")
    return [
        Cycles("2d", 2, "hertz",
               "Scene hertz (2D), adaptive; cycles to 1e-9, V, 3+3 sweeps on the "
               "leaf mesh and 6+6 on the levels. In two dimensions the second "
               "order vanishes, so that two of the lines agree. A level fails "
               f"that takes more than {MOST_CYCLES} cycles.",
               frictions, dofs(250 if quick else 65000), 1 if quick else 3),
        Cycles("3d", 3, "cylinder",
               "Scene cylinder (3D), adaptive; cycles to 1e-9, V, 3+3 sweeps on "
               "the leaf mesh and 6+6 on the levels. "
               f"A level fails that takes more than {MOST_CYCLES} cycles.",
               frictions, dofs(500 if quick else 50000) +
               [f"Refinement/Initial refinements={0 if quick else 1}"],
               0 if quick else 2)]


class Solvers:
    """Charts 2 and 3: all solvers on all levels of a scene, with their histories
    on the last one."""

    def __init__(self, name, dim, scene, subject, overrides, larger=None,
                 history_of_larger=False):
        """`larger` are the overrides for one more mesh, for those solvers that
        get so far. The histories are those of the first run, or of this one."""
        self.name, self.dim, self.scene = name, dim, scene
        self.subject, self.overrides = subject, overrides
        self.larger, self.history_of_larger = larger, history_of_larger


# All but those that factorise.
WITHOUT_FACTORS = ("algorithm 3", "algorithm 3 W", "algorithm 3 monotone",
                   "algorithm 3 monotone W", "algorithm 2", "newton gmres",
                   "gauss-seidel", "linear multigrid", "linear cg+ml")


def levels(initial, number):
    return [f"Refinement/Initial refinements={initial}",
            f"Refinement/Levels={number}", "Refinement/Maximum dofs=100000000"]


def patience(quick):
    """After this many seconds on a level Gauss-Seidel is stopped."""
    return 2 if quick else 10


def solvers(quick):
    adaptive = ["Refinement/Strategy=adaptive",
                f"Refinement/Initial refinements={0 if quick else 1}"]
    return [
        Solvers("hertz", 2, "hertz",
                "Scene hertz (2D): half disc on a plane, uniform meshes, F = 0.4, "
                "Poisson ratio 0.325.",
                UNIFORM + (levels(1, 2) if quick else levels(2, 5))),
        Solvers("block-2d", 2, "block",
                "Scene block (2D): square, uniform meshes, F = 0.05, Poisson "
                "ratio 0.45.",
                UNIFORM + ["Material/Poisson ratio=0.45",
                           "Contact/Friction coefficient=0.05"] +
                (levels(2, 2) if quick else levels(4, 5))),
        Solvers("block-3d", 3, "block",
                "Scene block (3D): cube, uniform meshes, F = 0.4, Poisson ratio "
                "0.3.",
                UNIFORM + (levels(1, 1) if quick else levels(3, 2)),
                larger=UNIFORM + (levels(1, 2) if quick else levels(3, 3))),
        Solvers("cylinder", 3, "cylinder",
                "Scene cylinder (3D): on two rods, adaptive meshes, F = 0.4, "
                "Poisson ratio 0.325. On the last one not all solvers finish in "
                "time.",
                adaptive + dofs(100 if quick else 50000),
                larger=adaptive + dofs(400 if quick else 100000),
                history_of_larger=True)]


STOPPING_SUBJECT = ("Cycles per level of the scenes hertz (2D) and cylinder (3D), "
                    "adaptive, F = 0.4. The first level has no error to stop at.")


def stopping(quick):
    """Rows (dimension, scene, overrides)."""
    return [(2, "hertz", dofs(400 if quick else 65000)),
            (3, "cylinder", dofs(400 if quick else 60000) +
             [f"Refinement/Initial refinements={0 if quick else 2}"])]


class Case:
    """A row of a map of chart 5. `sizes` says for each size by its name what
    leads there: a level of one nested iteration, or, if the guess is given,
    overrides for the first mesh. `easy` is the problem of the same map whose time
    per unknown is what this one's is compared with."""

    def __init__(self, problem, dim, scene, overrides, sizes, options=(), *, easy):
        self.problem, self.dim, self.scene = problem, dim, scene
        self.overrides, self.sizes = list(overrides), sizes
        self.options, self.easy = list(options), easy


class Map:
    """Chart 5: one map."""

    def __init__(self, name, subject, problem_axis, size_axis, cases,
                 solvers=None):
        self.name, self.subject = name, subject
        self.problem_axis, self.size_axis = problem_axis, size_axis
        self.cases, self.solvers = cases, solvers or MAPPED


# The first one is what a user gets; the others that are the product are variants
# without safeguards.
MAPPED = ("default", "algorithm 3", "algorithm 2", "algorithm 3 monotone",
          "newton direct", "newton gmres")

# A solver is well if it needs at most so many cycles, or steps of Newton's
# method, and for each unknown at most so many times the time that it needs for an
# easy problem on the same mesh. It has failed after so many seconds on one mesh
# (and all of a case after so many times that). Gauss-Seidel, which has no notion of
# failure, is stopped earlier.
GOOD_CYCLES, GOOD_STEPS, GOOD_RATIO = 25, 20, 3
LIMIT, LIMIT_OF_CASE = 30, 10
LIMIT_OF_RELAXATION = 2

# Solutions that take less than so many seconds are repeated, and the shortest time
# counts.
REPEAT = 0.2


def refined(initial, *meshes):
    """Uniform meshes by their number of refinements, and how to get there."""
    last = meshes[-1] - initial
    return (UNIFORM + levels(initial, last),
            {str(mesh): mesh - initial for mesh in meshes})


def adapted(initial, *wanted):
    return (["Refinement/Strategy=adaptive"] + levels(initial, wanted[-1]),
            {str(level): level for level in wanted})


def friction_map(scene, dim, subject, frictions, size_axis, meshes):
    overrides, sizes = meshes
    return Map(f"friction-{scene}", f"coefficient of friction, {subject}",
               "friction", size_axis,
               [Case(friction, dim, scene, overrides +
                     [f"Contact/Friction coefficient={friction}"], sizes,
                     easy="0.4")
                for friction in frictions])


def poisson_map(dim, meshes):
    overrides, sizes = meshes
    return Map("poisson" + ("-3d" if dim == 3 else ""),
               f"nearly incompressible, scene block ({dim}D), F = 0.4",
               "Poisson ratio", "refinements",
               [Case(f"{ratio} {strain}", dim, "block", overrides +
                     [f"Material/Poisson ratio={ratio}",
                      f"Material/Volumetric strain={strain}"], sizes,
                     easy="0.3 pointwise")
                for strain in ("pointwise", "mean")
                for ratio in ("0.3", "0.45", "0.49", "0.499", "0.4999")])


def aspect_map():
    cases = []
    for where in ("across", "along"):
        for ratio, first, n in ((1, 3, 3), (10, 1, 3), (100, 0, 3),
                                (1000, 0, 2)):
            cells = f"{ratio},1" if where == "across" else f"1,{ratio}"
            cases.append(Case(
                f"{ratio} {where}", 2, "block",
                UNIFORM + levels(first, n - 1) + [f"Scene/Subdivisions={cells}"],
                dict(zip(("coarse", "medium", "fine"), range(n))),
                easy=f"1 {where}"))
    return Map("aspect",
               "cells longer across or along the contact boundary, scene block "
               "(2D), F = 0.4", "aspect ratio", "mesh", cases)


def aspect_map_3d():
    """Plates lie on the contact boundary, sheets stand on it, and needles do,
    which are short in two directions."""
    cases = [Case("1", 3, "block", UNIFORM + levels(2, 1),
                  {"coarse": 0, "fine": 1}, easy="1")]
    for shape, cells, sizes in (
            ("plates", "1,1,{0}", ((10, 1, 1), (100, 0, 1), (1000, 0, 0))),
            ("sheets", "{0},1,1", ((10, 1, 1), (100, 0, 1))),
            ("needles", "{0},{0},1", ((3, 1, 1), (10, 0, 1), (30, 0, 0)))):
        for ratio, first, last in sizes:
            cases.append(Case(
                f"{ratio} {shape}", 3, "block", UNIFORM + levels(first, last) +
                [f"Scene/Subdivisions={cells.format(ratio)}"],
                dict(zip(("coarse", "fine"), range(last + 1))), easy="1"))
    return Map("aspect-3d",
               "cells longer in two directions, as plates that lie on the contact "
               "boundary or sheets that stand on it, or in one, as needles that "
               "stand on it; scene block (3D), F = 0.4", "aspect ratio", "mesh",
               cases)


def inclusion_map():
    overrides, sizes = refined(2, 3, 4, 5)
    return Map("inclusion",
               "a part at the contact boundary that is stiffer or softer, along "
               "faces of coarse cells, scene block (2D), F = 0.4",
               "Young's modulus times", "refinements",
               [Case(factor, 2, "block", overrides +
                     ["Material/Regions=where abs(x - 0.5) < 0.25 && y < 0.25: "
                      f"{factor}*E, nu"], sizes, easy="1")
                for factor in ("1e-6", "1e-4", "1e-2", "1", "1e2", "1e4",
                               "1e6")])


def jump_map(dim, meshes):
    """Materials whose borders are nowhere faces of coarse cells: a cell belongs to
    the one in which its middle lies, so that borders get finer with the mesh."""
    z = "xyz"[dim - 1]
    axes = "xyz"[:dim]
    board = "*".join(f"sin({{n}}*pi*{axis})" for axis in axes)
    ball = " + ".join(f"({axis} - {middle})^2" for axis, middle in
                      zip(axes, (0.55, 0.3) if dim == 2 else (0.55, 0.45, 0.3)))
    # A number between 0 and 1 for each of 11^dim parts, the same on all meshes.
    digits = " + ".join(f"{factor}*floor(11*{axis})" for factor, axis in
                        zip((12.9898, 78.233, 37.719), axes))
    chance = [f"Scene/Definitions=h = 43758.5453*sin({digits}); q = h - floor(h)"]
    random = "; ".join(f"where q > {quantile}: {factor}*E, nu" for quantile, factor
                       in ((0.25, "1e2"), (0.5, "1e4"), (0.75, "1e6")))
    problems = [("no jumps", None, ())]
    for n in (3, 5, 7):
        problems.append((f"{n} x {n} board" if dim == 2 else f"{n} x {n} x {n} board",
                         f"where {board.format(n=n)} > 0: 1e6*E, nu", ()))
    problems += [
        ("thin layer", f"where abs({z} - 0.33) < 0.06: 1e6*E, nu", ()),
        ("thin layer, slanted",
         f"where abs({z} - 0.3 - 0.2*x) < 0.06: 1e6*E, nu", ()),
        ("round part, stiff", f"where {ball} < 0.04: 1e6*E, nu", ()),
        ("round part, soft", f"where {ball} < 0.04: 1e-6*E, nu", ()),
        ("at random, 1 to 1e6", random, chance)]
    overrides, sizes = meshes
    return Map(f"jumps-{dim}d",
               "Young's modulus that jumps by a factor of a million, nowhere along "
               f"faces of coarse cells, scene block ({dim}D), F = 0.4",
               "jumps", "refinements",
               [Case(name, dim, "block", overrides + list(more) +
                     ([f"Material/Regions={regions}"] if regions else []), sizes,
                     easy="no jumps")
                for name, regions, more in problems])


def sliding_map(name, dim, scene, subject, top, limit, meshes, common=()):
    """The body is dragged along by multiples of what makes the last of its nodes
    slide, on a mesh of medium size; on others it is a little more or less."""
    overrides, sizes = meshes
    return Map(f"sliding-{name}", subject, "dragged by", "level",
               [Case(part, dim, scene, overrides + list(common) +
                     ["Boundary conditions/Displacement=" +
                      top.format(f"{float(part) * limit:.9g}")], sizes, easy="0")
                for part in ("0", "0.5", "0.9", "0.99", "0.999", "1", "1.001",
                             "1.01", "1.1")])


def touching_map(name, dim, scene, subject, top, meshes, common=()):
    overrides, sizes = meshes

    # A body that nothing deforms has no errors to refine by. Its meshes are
    # uniform, and so are those of an easy problem beside it. In three dimensions the
    # last one would be a hundred times as large as the adaptive ones.
    uniform = ["Refinement/Strategy=uniform"]
    fewer = dict(list(sizes.items())[:2 if dim == 3 else len(sizes)])

    def case(problem, depth, more, its_sizes, easy):
        return Case(problem, dim, scene, overrides + list(common) + more +
                    [f"Boundary conditions/Displacement={top}{-float(depth)}"],
                    its_sizes, easy=easy)

    return Map(f"touching-{name}", subject, "pressed by", "level",
               [case(depth, depth, [], sizes, "1e-3")
                for depth in ("1e-3", "1e-4", "1e-5", "1e-6", "1e-7", "1e-9")] +
               [case("1e-3, uniform", "1e-3", uniform, fewer, "1e-3, uniform"),
                case("lifted, uniform", "-1e-3", uniform, fewer, "1e-3, uniform")],
               MAPPED + ("gauss-seidel",))


def guess_map():
    scenes = ((2, "block", "block 2D", {"coarse": 3, "fine": 5}, UNIFORM),
              (3, "block", "block 3D", {"coarse": 1, "fine": 3}, UNIFORM),
              (2, "hertz", "hertz", {"coarse": 2, "fine": 4}, UNIFORM))
    return Map("guesses",
               "bad and infeasible initial guesses, made admissible; no nested "
               "iteration, F = 0.4", "initial guess", "mesh",
               [Case(f"{label}, {guess}", dim, scene, overrides,
                     {size: [f"Refinement/Initial refinements={n}"]
                      for size, n in sizes.items()}, [f"--guess={guess}"],
                     easy=f"{label}, zero")
                for dim, scene, label, sizes, overrides in scenes
                for guess in ("zero", "random", "inside", "lifted")],
               MAPPED + ("gauss-seidel",))


def stick_limit_map(dim):
    # Interpolated from the level before the solution would be exact.
    sizes = {str(n): [f"Refinement/Initial refinements={n}"]
             for n in ((2, 3, 4) if dim == 2 else (1, 2))}
    rest = "L = 2" if dim == 2 else "L = 1.5; W = 1; alpha = pi/6"
    threshold = 0.028
    cases = []
    for sign, name in ((1, "+"), (-1, "-")):
        for amplitude in ("1e-1", "1e-2", "1e-4", "1e-6", "1e-8", "1e-10",
                          "1e-12"):
            U = threshold * (1 + sign * float(amplitude))
            cases.append(Case(
                name + amplitude, dim, "stick-slip", UNIFORM +
                [f"Scene/Constants={rest}; H = 1; U = {U:.17g}; d = 0.02; "
                 "gap = 0"], sizes, ["--guess=zero"], easy="+1e-1"))
    return Map(f"stick-limit-{dim}d",
               f"slip at the stick limit, scene stick-slip ({dim}D): the top "
               "moves by U*(1+a), where beyond U* all slips; initial guess "
               "zero", "a",
               "refinements", cases)


FRICTIONS = ("1e-12", "1e-6", "0.05", "0.4", "1", "2", "5", "10", "100")


def stability(quick):
    if quick:
        return [friction_map("raous", 2, "scene raous (2D)", ("0.4", "100"),
                             "refinements", refined(2, 2, 3))]
    return [
        friction_map("raous", 2, "scene raous (2D)", FRICTIONS, "refinements",
                     refined(3, 4, 5, 6)),
        friction_map("hertz", 2, "scene hertz (2D)", FRICTIONS, "level",
                     adapted(0, 3, 6, 9)),
        friction_map("cylinder", 3, "scene cylinder (3D)", FRICTIONS, "level",
                     adapted(0, 1, 3, 5)),
        poisson_map(2, refined(3, 4, 5, 6)), poisson_map(3, refined(1, 2, 3, 4)),
        aspect_map(), aspect_map_3d(), inclusion_map(),
        jump_map(2, refined(3, 4, 5, 6)), jump_map(3, refined(1, 2, 3, 4)),
        touching_map("hertz", 2, "hertz",
                     "few contact nodes or none, scene hertz (2D), F = 0.4",
                     "1: 0, ", adapted(0, 0, 3, 6)),
        touching_map("half-ball", 3, "half-ball",
                     "few contact nodes or none, scene half-ball (3D) with F = "
                     "0.4", "1: 0, 0, ", adapted(0, 0, 2, 4),
                     ["Contact/Friction law=Coulomb",
                      "Contact/Friction coefficient=0.4"]),
        sliding_map("hertz", 2, "hertz",
                    "near gross sliding, scene hertz (2D), F = 0.4", "1: {}, -0.0062",
                    0.00475, adapted(0, 3, 6, 9)),
        sliding_map("half-ball", 3, "half-ball",
                    "near gross sliding, scene half-ball (3D) with F = 0.4",
                    "1: {}, 0, -0.01", 0.0067, adapted(0, 0, 2, 4),
                    ["Contact/Friction law=Coulomb",
                     "Contact/Friction coefficient=0.4"]),
        guess_map(), stick_limit_map(2), stick_limit_map(3)]
