"""What is measured for the charts, and how large. Sizes are chosen such that all
of it takes about a quarter of an hour; the quick variant takes a minute and
shows no more than that everything works.

Everything that belongs to a chart is in one place here: the name of the chart,
the subject that is written below its title, the scene, and the sizes.
"""


# All parts that can be asked for, and those of them for which nothing is measured
# here.
PARTS = ("precision", "cycles", "solvers", "stopping", "stability", "bounds")
DRAWN_ONLY = ("stability", "bounds")

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
