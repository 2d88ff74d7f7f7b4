"""The program that verifies runs confirms those that are as they should be, and
refutes each deliberate change of one of them, for the right reason.

Usage: refute.py PROGRAM_2D PROGRAM_3D ROOT
"""

import copy
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from checks import verify_level  # noqa: E402
from expressions import Expression, NotUnderstood  # noqa: E402
from friction_verify import tolerance_of  # noqa: E402
from run_data import Level, read_history  # noqa: E402
from scene_text import SceneText  # noqa: E402

PROGRAMS, ROOT = [Path(p).resolve() for p in sys.argv[1:3]], Path(sys.argv[3]).resolve()
VERIFY = Path(__file__).with_name("friction_verify.py").resolve()

# Scenes, each with what shortens it.
RUNS = {
    "hertz": (2, ["Refinement/Maximum dofs=600"]),
    "tresca": (2, ["Refinement/Levels=1"]),
    "ice": (2, ["Refinement/Levels=1"]),
    "stick-slip": (2, ["Refinement/Levels=1"]),
    "incompressible": (2, ["Refinement/Levels=1"]),
    "wheel": (2, ["Refinement/Levels=3"]),
    "pin": (2, ["Refinement/Levels=2"]),
    "rough": (2, ["Refinement/Levels=1"]),
    "wall": (2, ["Refinement/Levels=3"]),
    "mindlin": (2, ["Refinement/Maximum dofs=1000", "Load steps/Times=0, 4, 8"]),
    "crossing-rods": (3, ["Refinement/Maximum dofs=1500"]),
    "half-ball": (3, ["Refinement/Maximum dofs=300"]),
    "inclined": (2, ["Refinement/Levels=1", "Load steps/Times=0.5"]),
}

failures = 0


def report(is_good, name, text=""):
    global failures
    failures += not is_good
    print(f"{'ok     ' if is_good else 'FAILED '} {name}"
          + ("" if is_good else f": {text}"), flush=True)


def run(name, directory, more=()):
    dim, entries = RUNS[name]
    scene = ROOT / f"step-friction-{dim}d" / "scenes" / f"{name}.prm"
    subprocess.run([str(PROGRAMS[dim - 2]), str(scene), f"Output/Directory={directory}",
                    "Output/Verification=true", "Output/Fields=false",
                    "Output/Times=false", "Solver/Inner tolerance=1e-9", *entries,
                    *more],
                   check=True, stdout=subprocess.DEVNULL)


def verify(directory, *options):
    """The status, and what is printed on standard output and error."""
    result = subprocess.run([sys.executable, "-B", str(VERIFY), str(directory),
                             *options], capture_output=True, text=True)
    return result.returncode, result.stdout, result.stderr


def last_file(directory):
    return sorted(directory.glob("verify-*.h5"))[-1]


class Case:
    """A level of a run, and what the program makes of it with something changed."""

    def __init__(self, name, directory, which=-1):
        self.name = name
        text, levels = read_history(directory)
        self.row = levels[which]
        path = directory / f"verify-{self.row['level']:02d}.h5"
        self.level = Level(path)
        before = directory / f"verify-{self.row['level'] - 1:02d}.h5"
        self.before = Level(before) if before.is_file() else None
        self.scene = SceneText(text, self.level.dim, self.level.time)
        self.tolerance = tolerance_of(self.scene, self.row)

    def verdict(self, change):
        level, row = copy.deepcopy(self.level), dict(self.row)
        change(level, row)
        return verify_level(level, row, self.scene, self.tolerance, self.before)[0]

    def expect(self, what, change, columns=()):
        """That the change is refuted, in one of these columns at least."""
        verdict = self.verdict(change)
        seen = [c for c in columns if verdict.largest[c] > self.tolerance]
        report(verdict.complaints and (seen or not columns), f"{self.name}: {what}",
               f"columns are {verdict.largest}")


def check_displacements(case):
    """Each single value of the displacement, moved by 1e-4 of the largest one; of many
    values, some that are spread over the mesh."""
    u = case.level.displacement
    step = 1e-4 * np.abs(u).max()
    tried = range(0, u.size, 1 + u.size // 150)
    missed = []
    for i in tried:
        def change(level, _, i=i):
            level.displacement.flat[i] += step
        if not case.verdict(change).complaints:
            missed.append(i)
    report(not missed, f"{case.name}: {len(tried)} of {u.size} displacements",
           f"missed {missed}")


def set_state(old, new, tight=False):
    """Says of one node that was 'old' that it is 'new'; tight: one that bears clearly
    less friction than it can."""
    def change(level, row):
        candidates = np.flatnonzero(level.contact_states == old)
        if tight:
            middle = level.vertices[level.contact_nodes[candidates]].mean(axis=0)
            distance = np.linalg.norm(
                level.vertices[level.contact_nodes[candidates]] - middle, axis=1)
            candidates = candidates[np.argsort(distance)]
        level.contact_states[candidates[0]] = new
        # The reported numbers are made to fit: it is the law that has to refute it.
        records = row["contact"]
        place = level.vertices[level.contact_nodes[candidates[0]]]
        at = np.flatnonzero((records["point"] == place).all(axis=1))
        records = dict(records, state=records["state"].copy())
        records["state"][at] = new
        row["contact"] = records
        row["contact_nodes"] += int(new > 0) - int(old > 0)
        row["sticky_nodes"] += int(new == 2) - int(old == 2)
    return change


def move_obstacle(distance):
    def change(level, _):
        for contact in level.contacts:
            obstacle = contact.obstacle
            obstacle.planes = [(p + distance * n, n) for p, n in obstacle.planes]
            obstacle.rods = [(c, a, r - side * distance, length, side)
                             for c, a, r, length, side in obstacle.rods]
    return change


def scale(name, factor):
    def change(level, _):
        setattr(level, name, getattr(level, name) * factor)
    return change


def scale_materials(column, factor):
    def change(level, _):
        level.materials[:, column] *= factor
    return change


def change_region(level, _):
    level.cell_regions[0] = 1 - level.cell_regions[0]


def change_coefficient(level, _):
    level.friction_coefficient[-1] *= 1.001


def remove_contact_node(level, _):
    """One that touches."""
    keep = np.ones(len(level.contact_nodes), bool)
    keep[np.flatnonzero(level.contact_states > 0)[0]] = False
    for name in ("contact_nodes", "contact_normals", "contact_states", "contact_sections",
                 "friction_bounds", "friction_coefficient", "slip_origins"):
        # One that does not vary is a number.
        if np.ndim(getattr(level, name)) > 0:
            setattr(level, name, getattr(level, name)[keep])


def change_further(name, factor):
    """Of the second contact boundary."""
    def change(level, _):
        contact = level.contacts[1]
        setattr(contact, name, getattr(contact, name) * factor)
    return change


def move_further(distance):
    def change(level, _):
        obstacle = level.contacts[1].obstacle
        obstacle.planes = [(p + distance * n, n) for p, n in obstacle.planes]
    return change


def swap_sections(level, _):
    level.contact_sections[:] = 3 - level.contact_sections


def swap_one_section(level, _):
    level.contact_sections[0] = 3 - level.contact_sections[0]


def report_force(name, factor):
    def change(_, row):
        row["forces"] = dict(row["forces"])
        row["forces"][name] = row["forces"][name] * factor
    return change


def turn_normal(state, degrees):
    """Towards the coordinate axis after the one that it is nearest to."""
    def change(level, _):
        i = np.flatnonzero(level.contact_states == state)[0]
        normal = level.contact_normals[i]
        axes = (np.argmax(np.abs(normal)) + np.array([0, 1])) % level.dim
        c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        normal[axes] = np.array([[c, -s], [s, c]]) @ normal[axes]
    return change


def report_wrong(name, factor):
    def change(_, row):
        row[name] = row[name] * factor
    return change


def change_weight(level, _):
    level.hanging_weights[0] += .01


def move_slip_origin(level, _):
    """Of all nodes, along the contact boundary."""
    t = np.flip(level.contact_normals, axis=1) * [-1, 1]
    level.slip_origins += 1e-4 * np.abs(level.displacement).max() * t


def change_traction(level, _):
    level.tractions[0, 0] += 1e-3 * np.abs(level.tractions).max()


def change_body_force(level, _):
    level.body_force[0, 0] += 1e-2 * np.abs(level.body_force).max()


def no_number(level, _):
    level.displacement[5, 0] = np.nan


def change_mesh(level, _):
    """An interior node that hangs nowhere, moved by a thousandth of a cell."""
    interior = np.ones(level.n_nodes, bool)
    interior[level.boundary_faces] = False
    interior[level.hanging_nodes] = False
    node = np.flatnonzero(interior)[0]
    cell = level.cells[(level.cells == node).any(axis=1)][0]
    level.vertices[node] += 1e-3 * (level.vertices[cell].mean(axis=0)
                                    - level.vertices[node])


def move_held_node(level, _):
    node = np.flatnonzero(level.is_prescribed.any(axis=1))[1]
    step = 1e-4 * np.abs(level.displacement).max()
    level.displacement[node] += step
    level.values[node] += step


def check_changes(cases):
    hertz, rods, tresca, ice, patch, mean, wheel, wall, mindlin, inclined = (
        cases[name] for name in ("hertz", "crossing-rods", "tresca", "ice", "stick-slip",
                                 "incompressible", "wheel", "wall", "mindlin",
                                 "inclined"))
    deep = {case.name: 1e-4 * np.abs(case.level.displacement).max()
            for case in cases.values()}
    for case in (hertz, rods, tresca):
        case.expect("a sticking node is said to slide", set_state(2, 1, True),
                    ["states"])
        case.expect("a sliding node is said to stick", set_state(1, 2), ["states"])
        case.expect("a touching node is said to be open", set_state(1, 0), ["states"])
    for case in cases.values():
        where = ["penetration", "tension", "states"]
        case.expect("the obstacle is nearer", move_obstacle(-deep[case.name]), where)
        case.expect("the obstacle is farther", move_obstacle(deep[case.name]), where)
        case.expect("Poisson ratio", scale_materials(1, 1.001), ["equilibrium"])
        case.expect("Young's modulus", scale_materials(0, 1.001), ["energy"])
        case.expect("a contact node is missing", remove_contact_node, ["equilibrium"])
        case.expect("a vertex is moved", change_mesh, ["equilibrium"])
        case.expect("a displacement is no number", no_number, ["equilibrium"])
        case.expect("reported energy", report_wrong("energy", 1.0001), ["energy"])
        case.expect("reported normal force", report_wrong("normal_force", 1.0001))
        case.expect("reported pressure", report_wrong("max_pressure", 1.0001))
        case.expect("reported half-width", report_wrong("contact_half_width", 1.0001))
        case.expect("reported contact nodes", report_wrong("contact_nodes", 2),
                    ["states"])
        case.expect("normal of a node that slides", turn_normal(1, 1.),
                    ["tension", "cone", "slip", "states"])
    for factor in (.999, 1.001):
        wall.expect("friction of the wall", change_further("friction_coefficient",
                                                           factor), ["cone", "states"])
    wall.expect("the wall is nearer", move_further(-deep["wall"]), ["penetration"])
    wall.expect("the wall is farther", move_further(deep["wall"]), ["states"])
    wall.expect("floor and wall are mistaken for each other", swap_sections, ["given"])
    wall.expect("a node is said to be on the other one", swap_one_section, ["given"])
    wall.expect("the law of the wall is another one",
                lambda level, _: setattr(level.contacts[1], "friction_law", "none"),
                ["given"])
    for name in ("contact", "contact_2", "contact_2_normal", "contact_tangential",
                 "traction_4"):
        wall.expect(f"reported force {name}", report_force(name, 1.0001))
    for case in (hertz, rods, ice, patch, mean):
        case.expect("less friction", scale("friction_coefficient", .999), ["cone"])
        case.expect("more friction", scale("friction_coefficient", 1.001),
                    ["slip", "states"])
    for case in (hertz, rods):
        case.expect("normal of an open node", turn_normal(0, 60.), ["given"])
        case.expect("weight of a hanging node", change_weight, ["given"])
        case.expect("the law that uses the obstacle's normals",
                    lambda level, _: setattr(level, "contact_normal", "obstacle"),
                    ["given"])
    ice.expect("a coefficient of one node", change_coefficient, ["given"])
    ice.expect("ice elsewhere", lambda level, _: level.friction_coefficient.sort(),
               ["cone"])
    tresca.expect("less friction", scale("friction_bounds", .999), ["cone"])
    tresca.expect("more friction", scale("friction_bounds", 1.001), ["slip", "states"])
    patch.expect("a traction", change_traction, ["equilibrium"])
    wheel.expect("a cell of another region", change_region, ["equilibrium"])
    wheel.expect("a cell of another region, given", change_region, ["given"])
    mindlin.expect("slip from elsewhere", move_slip_origin, ["slip", "states"])
    mindlin.expect("slip from elsewhere, given", move_slip_origin, ["given"])
    mindlin.expect("another time", scale("time", 1.5), ["given"])
    entry = "Boundary conditions/Force"
    inclined.scene.entries[entry] = inclined.scene.entries[entry].replace(
        "G*cos", "1.0001*G*cos")
    inclined.expect("the platen's force is another one", lambda *_: None)
    inclined.expect("a node of the platen is elsewhere", move_held_node, ["given"])
    inclined.expect("where the platen is said to be", report_force("platen_3", 1.001))
    mean.expect("a body force", change_body_force, ["equilibrium"])
    mean.expect("pointwise volumetric strain",
                scale_materials(2, 0.),
                ["equilibrium"])


def check_files(directory, work):
    """The same with files, as a user would see it."""
    def changed(change):
        target = work / "changed"
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(directory, target)
        change(target)
        return verify(target)

    def change_displacement(target):
        with h5py.File(last_file(target), "r+") as file:
            u = file["displacement"]
            u[7, 1] += 1e-4 * np.abs(u[()]).max()

    def change_coefficient(target):
        with h5py.File(last_file(target), "r+") as file:
            file.attrs["friction_coefficient"] = .5

    def change_scene(target):
        """What the run has solved, and the scene, now agree on another obstacle."""
        for path in target.glob("verify-*.h5"):
            with h5py.File(path, "r+") as file:
                file["plane_points"][0] += [0., -1e-4]
        with h5py.File(target / "history.h5", "r+") as file:
            text = file.attrs["parameters"].replace("0, -1\n", "0, -1.0001\n", 1)
            assert "-1.0001" in text
            file.attrs["parameters"] = text

    for name, change, words in (
            ("displacement", change_displacement, "refuted on 1 of"),
            ("coefficient", change_coefficient, "refuted on 1 of"),
            ("scene", change_scene, "said to touch does not")):
        status, out, _ = changed(change)
        report(status == 1 and words in out
               and (name == "coefficient") == ("not what the scene says" in out),
               f"files: {name}", out)

    def damage(target):
        path = last_file(target)
        path.write_bytes(path.read_bytes()[:3000])

    def remove_all(target):
        for path in target.glob("verify-*.h5"):
            path.unlink()

    for name, change, words in (
            ("damaged", damage, "cannot be read"),
            ("none", remove_all, "Output/Verification=true"),
            ("no history", lambda target: (target / "history.h5").unlink(),
             "name the output directory")):
        status, _, err = changed(change)
        report(status == 2 and err.count("\n") == 1 and words in err, f"files: {name}",
               f"status {status}, {err}")

    # One file less is no reason to refute the others.
    status, out, _ = changed(lambda target: last_file(target).unlink())
    report(status == 0 and "Not looked at" in out, "files: one is missing", out)


def check_sloppy(work):
    """A run that has stopped early says so, and by how much is the same number."""
    directory = work / "sloppy"
    run("hertz", directory, ["Solver/Inner tolerance=1e-2",
                             "Solver/Certificate tolerance=0.1"])
    status, out, _ = verify(directory)
    report(status == 0, "sloppy: by its own standard", out)
    status, out, _ = verify(directory, "--tolerance", "1e-6")
    report(status == 1, "sloppy: by ours", out)
    _, levels = read_history(directory)
    for i, row in enumerate(levels):
        verdict = Case("sloppy", directory, i).verdict(lambda *_: None)
        report(abs(verdict.certificate - row["certificate"])
               < 1e-6 * row["certificate"] + 1e-13,
               f"sloppy: the certificate of level {row['level']}",
               f"{row['certificate']} and {verdict.certificate}")
    report(max(row["certificate"] for row in levels) > 1e-4, "sloppy: it is")


def check_stale(work):
    """Files of an earlier run do not stay."""
    directory = work / "stale"
    run("stick-slip", directory)
    run("stick-slip", directory, ["Refinement/Levels=0", "Output/Verification=false"])
    report(not list(directory.glob("verify-*")), "stale: files are removed")
    status, _, _ = verify(directory)
    report(status == 2, "stale: nothing to read")


def check_unknown(work):
    """What the program does not understand in a scene, it says."""
    directory = work / "unknown"
    run("tresca", directory, ["Contact/Friction bound=0.006*erfc(0)"])
    status, out, err = verify(directory)
    report(status == 0 and "does not understand" in out and "erfc" in out,
           "unknown: an expression", out + err)


def check_names(work):
    """Names of groups are those of the mesh file, if that is given."""
    directory, mesh = work / "names", work / "swapped.msh"
    run("wall", directory, [
        "Boundary conditions/Traction=top: 0, -load; left: push, 0",
        "Contact/Boundary id=floor", "Contact 2/Boundary id=wall",
        "Material/Regions=block: 1, 0.3"])
    original = ROOT / "step-friction-2d/scenes/wall.msh"
    status, out, err = verify(directory)
    report(status == 0 and out.count("--mesh gives") == 4, "names: without the mesh file",
           out + err)
    status, out, err = verify(directory, "--mesh", original)
    report(status == 0 and "does not understand" not in out, "names: confirmed",
           out + err)
    for old, new, reason in (("top", "left", "Traction' is not"),
                             ("floor", "wall", "Boundary id' is not"),
                             ("block", "stone", "'block', which is no name")):
        text = original.read_text()
        mesh.write_text(text.replace(f'"{new}"', '"?"').replace(
            f'"{old}"', f'"{new}"').replace('"?"', f'"{old}"'))
        status, out, err = verify(directory, "--mesh", mesh)
        report(status == (new != "stone") and reason in out,
               f"names: {old} and {new} exchanged", out + err)
    mesh.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n")
    status, _, err = verify(directory, "--mesh", mesh)
    report(status == 2 and "has no section $PhysicalNames" in err, "names: there are none",
           err)


def check_expressions():
    """Of our own parser, against Python's."""
    x = np.array([[.5, 2.], [-1., .3]])
    names = {"a": 3., "d": "a*x + 1", "x": x[:, 0], "y": x[:, 1]}
    for text, value in (
            ("-x^2", -x[:, 0]**2), ("2^3^2 - 1", 511.), ("2e-3*a", .006),
            ("if(x > 0, d, -d^2)", [2.5, -4.]), ("max(x, y, 0)*2/4", [1., .15]),
            ("x < y && x > 0 ? 1 : a", [1., 3.]), ("1 - 2 - 3", -4.),
            ("(x <= 0.5) + (y == 2)", [2., 1.]), ("2^-1", .5)):
        got = Expression(text, names).value()
        report(np.allclose(got, value), f"expression {text}", f"{got}")
    for text in ("1 +", "f(x)", "2 2", "(x", "x $ y", ""):
        try:
            Expression(text, names).value()
            report(False, f"expression {text}", "is no expression")
        except NotUnderstood:
            report(True, f"expression '{text}' is none")


def check_tolerance(directory):
    """What is no tolerance does not confirm anything."""
    for tolerance in "nan", "inf", "0", "-1", "0.2":
        status, out, err = verify(directory, "--tolerance", tolerance)
        report(status == 2 and not out and "must be above 0 and at most 0.1" in err,
               f"tolerance {tolerance}", out + err)


def check_glue(directory):
    """A bound of friction that is given and beyond all stresses is no unit of theirs."""
    run("tresca", directory, ["Contact/Friction bound=1e6"])
    status, out, err = verify(directory)
    report(status == 0, "glue: unchanged", out + err)
    path = last_file(directory)
    nodes = Level(path).contact_nodes
    with h5py.File(path, "r+") as file:
        u = file["displacement"][()]
        u[nodes[len(nodes) // 2]][0] += 1e-4 * np.abs(u).max()
        file["displacement"][...] = u
    status, out, err = verify(directory)
    report(status == 1, "glue: a displacement moved", out + err)


def main():
    check_expressions()
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        cases = {}
        for name in RUNS:
            run(name, work / name)
            status, out, err = verify(work / name)
            report(status == 0 and "is confirmed on all" in out, f"{name}: unchanged",
                   out + err)
            cases[name] = Case(name, work / name)
            check_displacements(Case(name, work / name, 0))
        check_changes(cases)
        check_files(work / "hertz", work)
        check_sloppy(work)
        check_stale(work)
        check_unknown(work)
        check_names(work)
        check_tolerance(work / "hertz")
        check_glue(work / "glue")
    sys.exit(failures > 0)


main()
