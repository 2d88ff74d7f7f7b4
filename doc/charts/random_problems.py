"""Contact problems drawn at random, each from its seed: what the study of
robustness asks all solvers to solve.

A problem has a body (a block or, in the plane, half a disc), a mesh (stretched,
distorted, refined everywhere or where the error is), a material (compressible,
auxetic or nearly incompressible, perhaps with a stiff or soft part), a
coefficient of friction, an obstacle (a plane that may be inclined, round bumps, a
wavy surface), loads that press and shear, and a guess to start from. Each of
these is drawn by itself, so that bad things happen together."""

import math
import random

GUESSES = ("zero", "random", "inside", "lifted")


class Problem:
    """`entries` of a scene file, as Section/Entry=value; `guess`: interpolated, or
    that of the first mesh; `inclusion`: the factor of Young's modulus in a part of
    the body; `text`: what it is, in a line."""

    def __init__(self, dim, seed):
        self.dim, self.seed = dim, seed
        self.random = random.Random(f"{dim} {seed}")
        self.entries, words = {}, []
        for part in (self.material, self.friction, self.body, self.obstacle,
                     self.loads, self.start):
            words.append(part())
        self.text = "; ".join(word for word in words if word)

    def set(self, **sections):
        for section, entries in sections.items():
            for name, value in entries.items():
                self.entries[f"{section.replace('_', ' ')}/{name}"] = str(value)

    def chance(self, probability):
        return self.random.random() < probability

    def between(self, low, high):
        return self.random.uniform(low, high)

    def log_between(self, low, high):
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def material(self):
        nu = (0.5 - self.log_between(1e-4, 5e-2) if self.chance(0.2)
              else self.between(-0.3, 0.45))
        mean = nu > 0.45 and self.chance(0.7)
        self.set(Material={"Poisson ratio": f"{nu:.5g}",
                           "Volumetric strain": "mean" if mean else "pointwise"})
        self.inclusion = (self.log_between(1e-6, 1e6) if self.chance(0.25) else 1.)
        return (f"nu {nu:.4g}{' mean' if mean else ''}" +
                (f", inclusion {self.inclusion:.0e}" if self.inclusion != 1 else ""))

    def friction(self):
        F = 0. if self.chance(0.05) else self.log_between(0.02, 2.)
        if self.chance(0.1):
            F = self.log_between(2., 100.)
        self.set(Contact={"Friction coefficient": f"{F:.4g}",
                          "Friction law": "Coulomb"})
        return f"F {F:.3g}"

    def body(self):
        self.is_disc = self.dim == 2 and self.chance(0.35)
        self.width, self.height = 1., 1.
        if self.is_disc:
            self.set(Scene={"Geometry": "half disc", "Radius": 1},
                     Contact={"Boundary id": 0})
            self.bottom, self.top = -1., 1
            return "half disc"
        self.height = self.log_between(0.3, 2.)
        aspect = 1. if self.chance(0.5) else self.log_between(0.03, 30.)
        size, cells = [1.] * (self.dim - 1) + [self.height], [1] * self.dim
        # As many coarse cells as the aspect ratio of cells wants, some dozens at
        # most.
        ratio = aspect * size[0] / size[-1]
        cells[0 if ratio > 1 else -1] = max(1, round(max(ratio, 1 / ratio)))
        self.cells = math.prod(cells)
        distortion = self.between(0., 0.3) if self.chance(0.4) else 0.
        self.set(Scene={"Geometry": "rectangle",
                        "Size": ", ".join(f"{s:.4g}" for s in size),
                        "Subdivisions": ", ".join(map(str, cells)),
                        "Distortion": f"{distortion:.3g}"},
                 Contact={"Boundary id": 2 * (self.dim - 1)})
        self.bottom, self.top = 0., 2 * self.dim - 1
        return (f"block {' x '.join(map(str, cells))}" +
                (f", distorted {distortion:.2g}" if distortion else ""))

    def obstacle(self):
        below = f"{self.bottom:g}"
        kind = self.random.choice(("plane", "plane", "bumps", "waves"))
        self.is_simple = False
        # How far the body comes down: some percent of its height.
        self.depth = self.log_between(1e-3, 0.05) * self.height
        if kind == "plane":
            angle = self.between(-20., 20.) if self.chance(0.3) else 0.
            normal = [0.] * self.dim
            normal[0] = math.sin(math.radians(angle))
            normal[-1] = -math.cos(math.radians(angle))
            point = [0.] * (self.dim - 1) + [self.bottom]
            if angle > 0 and not self.is_disc:
                point[0] = 1.  # the corner that touches first
            if self.is_disc:
                point = [-n * self.bottom for n in normal]
                point[0], point[-1] = normal[0], normal[-1]
            self.set(Obstacle={"Kind": "plane",
                               "Point": ", ".join(f"{p:.6g}" for p in point),
                               "Normal": ", ".join(f"{n:.6g}" for n in normal)})
            self.is_simple = not (self.is_disc and angle)
            # A slope needs more than that to be touched at more than an edge.
            if angle and not self.is_disc:
                self.depth += 0.3 * math.tan(math.radians(abs(angle))) * \
                    self.between(0., 0.2)
            return "plane" + (f", {angle:.0f} degrees" if angle else "")
        if kind == "bumps":
            n, radius = self.random.randint(1, 5), self.log_between(0.3, 3.)
            centers = []
            for _ in range(n):
                x = [self.between(-0.3, 0.3) if self.is_disc else
                     self.between(0., 1.) for _ in range(self.dim - 1)]
                depth = math.sqrt(1 - x[0] ** 2) if self.is_disc else 0.
                centers.append(x + [-depth - radius if self.is_disc
                                    else -radius])
            round_ = "rods" if self.dim == 2 else "balls"
            self.set(Obstacle={
                "Kind": round_, "Radius": f"{radius:.4g}",
                "Centers": "; ".join(", ".join(f"{c:.6g}" for c in center)
                                     for center in centers)})
            return f"{n} bumps of radius {radius:.2g}"
        length, height = self.log_between(0.1, 1.), self.log_between(1e-4, 1e-2)
        coordinate = "yz"[self.dim - 2]
        waves = " + ".join(f"cos({6.2832 / length * (1 + 0.3 * d):.4g}*{axis})"
                           for d, axis in enumerate("xy"[:self.dim - 1]))
        self.set(Obstacle={
            "Kind": "surface",
            "Function": f"{coordinate} - ({below}) + "
                        f"{height * (self.dim - 1):.3g} - "
                        f"{height:.3g}*({waves})"})
        return f"waves of length {length:.2g} and height {height:.1g}"

    def loads(self):
        shear = [(0. if self.chance(0.2) else
                  self.depth * self.log_between(0.03, 3.) *
                  self.random.choice((-1, 1))) for _ in range(self.dim - 1)]
        values = [f"{s:.4g}" for s in shear] + [f"{-self.depth:.4g}"]
        self.set(Boundary_conditions={
            "Displacement": f"{self.top}: " + ", ".join(values)})
        return "moved by " + ", ".join(values)

    def start(self):
        """The mesh and what the iteration begins with."""
        self.guess = (self.random.choice(GUESSES) if self.chance(0.3)
                      else "interpolated")
        most = self.log_between(500, 10000) if self.dim == 2 else \
            self.log_between(300, 6000)
        # The first mesh has to see an obstacle that is not flat, or a disc's side,
        # or it touches nothing, and nothing says where to refine.
        needed = 0 if self.is_simple else 5 - self.dim
        if self.is_disc:
            first = needed if self.guess == "interpolated" else 3
        else:
            n = self.dim * self.cells
            levels = math.floor(math.log(most / n, 2 ** self.dim))
            first = max(0, levels) if self.guess != "interpolated" else \
                min(max(1, needed), max(0, levels))
            if self.cells == 1:
                first = max(first, needed)
        adaptive = self.guess == "interpolated" and self.chance(0.6)
        levels = 0 if self.guess != "interpolated" else 25 if adaptive else \
            (3 if self.is_disc else
             max(0, math.floor(math.log(most / (self.dim * self.cells),
                                        2 ** self.dim)) - first))
        self.set(Refinement={
            "Strategy": "adaptive" if adaptive else "uniform",
            "Contact zone": "true" if adaptive and self.chance(0.5) else "false",
            "Initial refinements": first, "Levels": levels,
            "Maximum dofs": round(most)})
        return (("adaptive" if adaptive else "uniform") +
                (f", guess {self.guess}" if self.guess != "interpolated" else ""))

    def scene(self):
        """As a scene file, to try it by itself."""
        sections = {}
        for name, value in self.entries.items():
            section, entry = name.split("/", 1)
            sections.setdefault(section, []).append(f"  set {entry} = {value}\n")
        return f"# {self.dim}D, seed {self.seed}: {self.text}\n" + "".join(
            f"subsection {section}\n{''.join(lines)}end\n"
            for section, lines in sections.items())
