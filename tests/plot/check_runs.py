"""What friction-plot reads of a run is what the program has printed, whatever the format
of its fields and the number of processes; and the pictures come out."""

import re

from workshop import Workshop, is_picture

import numpy as np

import body
import boundary
from fields import field_names, joined, read_fields, select_field
from history import Run
import vtu

workshop = Workshop()
check = workshop.check
SMALL = ("Refinement/Levels=5", "Output/Units=length: mm, force: N",
         "Output/Principal stresses=true")


def compare_with_console(run, printed, what):
    rows = [line.split() for line in printed.splitlines() if re.match(r" *\d+ ", line)]
    columns = ("level", "cells", "dofs", "contact_nodes", "sticky_nodes",
               "outer_iterations", "cycles")
    own = [[int(run.levels[name][i]) for name in columns]
           for i in range(len(run.levels["level"]))]
    check([list(map(int, row[:7])) for row in rows] == own,
          f"{what}: the table is the one that was printed")
    check(np.allclose([float(row[8]) for row in rows], run.levels["energy"], rtol=1e-5),
          f"{what}: with its energies")
    peak = re.search(r"Peak pressure p = ([\d.e+-]+[\d])", printed)
    check(peak and abs(float(peak[1]) - run.levels["max_pressure"][-1])
          < 0.02 * run.levels["max_pressure"][-1], f"{what}: and its peak pressure")
    check("Time of the run: " in printed, f"{what}: the run says how long it was")


def compare_with_csv(run, what):
    lines = (run.directory / "levels.csv").read_text().splitlines()
    names = [name.split(" [")[0] for name in lines[0].split(",")]
    table = np.array([[float(value) for value in line.split(",")] for line in lines[1:]])
    check(sorted(names) == sorted(run.levels) and all(
        np.allclose(table[:, i], run.levels[name], rtol=1e-10, atol=0)
        for i, name in enumerate(names)), f"{what}: levels.csv is the table")
    units = dict(re.findall(r"(\w+) \[([^]]*)\]", lines[0]))
    check(all(units.get(name, "") == run.unit(f"levels/{name}") for name in names)
          and units["max_pressure"] == "N/mm^2"
          and units["energy"] == ("N" if run.dim == 2 else "N mm"),
          f"{what}: with units", units)


def check_nodes(run, what, with_errors=1e-6):
    """The records of contact nodes say what the table says."""
    nodes, row = run.contact[run.last], run.row(run.last)
    pressure, tangential = boundary.tractions(nodes)
    touching = nodes["state"] > 0
    peak = row["max_pressure"]
    check(touching.sum() == row["contact_nodes"]
          and (nodes["state"] == 2).sum() == row["sticky_nodes"], f"{what}: states")
    check(abs(pressure[touching].max() - peak) < 1e-12 * peak,
          f"{what}: the largest pressure")
    force = np.sum((pressure * nodes["measure"])[touching])
    check(abs(force - row["normal_force"]) < 1e-10 * force, f"{what}: the normal force")
    vector = np.sum(tangential * nodes["measure"][:, None], axis=0)
    check(abs(np.linalg.norm(vector) - row["tangential_force"])
          < 1e-10 * row["normal_force"], f"{what}: the tangential force")
    size = np.linalg.norm(tangential, axis=1)
    bound = nodes["friction_bound"]
    check((size <= bound + with_errors * peak).all(), f"{what}: within what friction allows")
    slides = nodes["state"] == 1
    check(np.allclose(size[slides], bound[slides], rtol=0, atol=with_errors * peak),
          f"{what}: and equal to it where nodes slide")
    slip = nodes["slip"]
    length = np.abs(nodes["displacement"]).max()
    check(np.abs(np.sum(slip * nodes["normal"], axis=1)).max() < 1e-14 * length
          and np.abs(slip[nodes["state"] != 1]).max(initial=0) < 1e-9 * length
          and np.linalg.norm(slip[slides], axis=1).max(initial=0) > 0,
          f"{what}: only nodes that slide have a slip, along the boundary")
    # Against the direction of the slip.
    product = np.sum(slip[slides] * tangential[slides], axis=1)
    check((product <= 1e-9 * length * peak).all(), f"{what}: friction opposes it")
    return nodes, pressure


def check_body(run, what):
    mesh = read_fields(run.directory, "body", run.last)
    row = run.row(run.last)
    check(len(mesh.cells) == row["cells"], f"{what}: the body has all cells")
    stress = mesh.of_cells["stress"]
    xx, yy, zz, xy, yz, xz = stress.T.astype(float)
    mises = np.sqrt(0.5 * ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2)
                    + 3 * (xy**2 + yz**2 + xz**2))
    largest = mises.max()
    check(np.allclose(mises, mesh.of_cells["von_Mises_stress"], atol=1e-5 * largest,
                      rtol=0), f"{what}: von Mises stress is that of the tensor")
    tensors = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
    principal = np.stack([mesh.of_cells[f"principal_stress_{i}"] for i in (1, 2, 3)],
                         axis=1)
    check(np.allclose(np.linalg.eigvalsh(tensors)[:, ::-1], principal,
                      atol=1e-5 * np.abs(principal).max(), rtol=0),
          f"{what}: principal stresses are its eigenvalues")
    check({"stress_xy", "displacement_y", "principal_stress_1"} <= set(field_names(mesh))
          and np.allclose(select_field(mesh, "displacement"),
                          np.linalg.norm(mesh.of_points["displacement"], axis=1)),
          f"{what}: fields by name")
    return mesh


def check_contact_fields(run, nodes, pressure, what):
    """The boundary for ParaView has what the records have."""
    mesh = read_fields(run.directory, "contact", run.last)
    places = np.round(mesh.points[:, :run.dim], 9)
    index = {tuple(place): i for i, place in enumerate(places + 0.)}
    at = np.array([index[tuple(place)] for place in
                   np.round(nodes["point"], 9) + 0.])
    peak = pressure.max()

    def same(name, values, unit):
        found = mesh.of_points[name][at]
        if found.ndim > 1:
            found = found[:, :run.dim]
        return np.allclose(found, values, rtol=0, atol=1e-6 * unit)

    length = np.abs(nodes["displacement"]).max()
    check(same("pressure", pressure, peak)
          and same("friction_bound", nodes["friction_bound"], peak)
          and same("displacement", nodes["displacement"], length)
          and same("slip", nodes["slip"], length)
          and same("state", nodes["state"], 1), f"{what}: contact fields are the records")


def check_picture(name, *arguments):
    path = workshop.folder / name
    status, out, error = workshop.plot(*arguments, "-o", path)
    check(status == 0 and out.strip() == str(path), f"draws {name}", error)
    if path.suffix == ".png":
        check(status == 0 and is_picture(path), f"  {name} is a picture")
    else:
        head = path.read_bytes()[:300] if status == 0 else b""
        check(b"<svg" in path.read_bytes() if path.suffix == ".svg"
              else head.startswith(b"%PDF"), f"  {name} is one")
    return path


# Two dimensions: alone, on two processes, in the other format.
whole, printed = workshop.run(2, "hertz", "hertz", *SMALL)
run = Run(whole)
compare_with_console(run, printed, "hertz")
compare_with_csv(run, "hertz")
nodes, pressure = check_nodes(run, "hertz")
mesh = check_body(run, "hertz")
check_contact_fields(run, nodes, pressure, "hertz")
line = boundary.Line(nodes, nodes["state"] > 0)
check(line.name == "x" and len(line.pieces) == 1, "hertz: the boundary is one line over x")

pair, _ = workshop.run(2, "hertz", "hertz-2", *SMALL, processes=2)
other = Run(pair)
nodes_2, pressure_2 = check_nodes(other, "hertz on two")
mesh_2 = check_body(other, "hertz on two")
check_contact_fields(other, nodes_2, pressure_2, "hertz on two")
check(len(list(pair.glob("body-05.*.vtu"))) == 2 and
      len(mesh_2.points) == len(mesh.points), "hertz on two: pieces are one mesh")
check(np.array_equal(nodes["point"], nodes_2["point"])
      and np.allclose(nodes["slip"], nodes_2["slip"], atol=1e-10)
      and np.allclose(nodes["friction_bound"], nodes_2["friction_bound"], atol=1e-9),
      "hertz on two: the same nodes, slips and bounds")
single, _ = workshop.run(2, "hertz", "hertz-h5", "Output/Format=hdf5", *SMALL)
mesh_h5 = check_body(Run(single), "hertz in HDF5")
check(len(mesh_h5.points) == len(mesh.points)
      and abs(mesh_h5.in_points("von_Mises_stress").max()
              - mesh.in_points("von_Mises_stress").max())
      < 1e-5 * mesh.in_points("von_Mises_stress").max(), "hertz in HDF5: the same stresses")

# Without principal stresses, units and friction.
plain, _ = workshop.run(2, "hertz", "plain", "Refinement/Levels=3",
                        "Contact/Friction coefficient=0")
run_plain = Run(plain)
check(run_plain.unit("levels/energy") == "" and run_plain.axis("p", "levels/energy") == "p"
      and run_plain.unit("levels/solve_seconds") == "s", "without names there are no units")
check(run_plain.contact[run_plain.last]["friction_bound"].max() == 0,
      "without friction it allows nothing")
check(not any(name.startswith("principal") for name in
              vtu.fields_of(plain / "body-03.0000.vtu", "CellData")),
      "principal stresses only if they are wanted")

# Tresca's bound is what the scene says.
tresca, _ = workshop.run(2, "tresca", "tresca", "Refinement/Levels=1",
                         "Refinement/Initial refinements=4")
run_tresca = Run(tresca)
nodes_tresca = run_tresca.contact[run_tresca.last]
check(np.allclose(nodes_tresca["friction_bound"],
                  float(run_tresca.entries["Contact/Friction bound"])),
      "Tresca's bound")

# A run that is continued has the same table, but for times.
entries = ("Output/Checkpoint=true", "Output/Units=length: mm, force: N")
workshop.run(2, "hertz", "continued", "Refinement/Levels=3", *entries)
continued, _ = workshop.run(2, "hertz", "continued", "Refinement/Levels=5", "--restart",
                            *entries)
run_continued = Run(continued)
loose = {"cycles", "contraction", "certificate", "algebraic_error"}


def scale(name):
    """An error is a difference of values; total forces have the size of the normal
    one."""
    if name.endswith("_error") and name != "estimated_error":
        name = name[:-len("_error")].replace("tangential", "normal")
    return np.abs(run.levels[name]).max()


check(all(np.abs(run_continued.levels[name] - run.levels[name]).max() <= 1e-6 * scale(name)
          for name in run.levels if not name.endswith("seconds") and name not in loose),
      "a run that is continued has the same table")
compare_with_csv(run_continued, "continued")
check(all(np.allclose(run_continued.contact[level][name], nodes_of[name], atol=1e-9)
          for level, nodes_of in run.contact.items() for name in nodes_of),
      "and the same contact nodes")

# Three dimensions.
rods, printed = workshop.run(3, "cylinder", "cylinder", *SMALL, "Refinement/Levels=1",
                             processes=2)
run_3 = Run(rods)
compare_with_console(run_3, printed, "cylinder")
compare_with_csv(run_3, "cylinder")
nodes_3, pressure_3 = check_nodes(run_3, "cylinder")
mesh_3 = check_body(run_3, "cylinder")
check_contact_fields(run_3, nodes_3, pressure_3, "cylinder")
faces, _ = body.surface(mesh_3.cells)
corners = mesh_3.points[faces]
radius = np.hypot(corners[..., 0], corners[..., 1])
ends = (np.abs(corners[..., 2] - 1) > 1 - 1e-9).all(axis=1)
check(((np.abs(radius - 1) < 1e-6).all(axis=1) | ends).all(),
      "cylinder: its surface is outside, with hanging nodes and two processes")
chart = boundary.Chart(nodes_3["point"], nodes_3["normal"], np.array([0., 1, 0]))
place = chart.place(nodes_3["point"])
angle = np.arctan2(nodes_3["point"][:, 0], -nodes_3["point"][:, 1])
check(np.allclose(place[:, 0], nodes_3["point"][:, 2])
      and np.allclose(np.abs(place[:, 1]), np.abs(angle), atol=1e-6),
      "cylinder: unrolled, it is as long as its arc")

# Pictures.
first = check_picture("hertz.png", whole)
again = check_picture("again.png", whole)
check(first.read_bytes() == again.read_bytes(), "equal pictures are equal files")
check_picture("pair.png", pair)
check_picture("hdf5.png", single, "--field", "stress_xy", "--warp", "5")
check_picture("level.png", whole, "--level", "2", "--range", "0", "0.02")
check_picture("plain.png", plain, "--show", "contact,convergence")
check_picture("hertz.svg", whole)
check_picture("hertz.pdf", whole, "--field", "principal_stress_1")
check_picture("tresca.png", tresca)
check_picture("cylinder.png", rods)
check_picture("compared.png", whole, plain, pair)
check_picture("compared-3d.png", rods, whole)
status, out, _ = workshop.plot(whole, "--field", "?")
check(status == 0 and "von_Mises_stress" in out.split(), "lists fields")
check(joined([whole / "body-05.0000.vtu"]).cells.shape[1] == 4, "one piece alone")
workshop.end()
