"""Nodes in contact and sticking nodes of the cylinder scene beside table 6.2 of the
thesis, for other data of the scene: chapter 6 does not repeat those of the thesis.

Usage: stick_share.py PROGRAM_3D SCENE [SAMPLES]

First one datum at a time is changed, on uniform meshes of n^3 cells made from one
hexahedron, then depth and friction on adaptive ones like those of the thesis. At last
data are drawn at random (always the same ones), to see whether any give the nodes of the
thesis for n = 4 and 8."""

import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

PROGRAM, SCENE = sys.argv[1:3]
SAMPLES = int(sys.argv[3]) if len(sys.argv) > 3 else 100

# By the number of cells along the cylinder; levels 1 to 6.
THESIS = {4: (6, 2), 8: (14, 4), 16: (46, 18), 32: (180, 56), 64: (684, 188),
          128: (2728, 747)}
SHIPPED = {"angle": 30., "radius": .5, "depth": .01, "F": .4, "nu": .325, "length": 2.,
           "sideways": 0., "along": 0., "squeeze": 0., "normal": "body"}
DEEPER = dict(SHIPPED, depth=.0295)


def levels(data, n, *more):
    """Nodes in contact and sticking nodes on each level, the first one having n^3
    cells, or None without a solution."""
    half, d = data["length"] / 2, data["depth"]
    end = f"{data['sideways'] * d}, {-d}, "
    entries = {
        "Scene/Coarse grid": "one cell", "Scene/Length": data["length"],
        "Scene/Constants": f"R = 1 + {data['radius']}; a = {data['angle']}*pi/180; "
                           "c = R*sin(a); b = R*cos(a)",
        "Material/Poisson ratio": data["nu"],
        "Obstacle/Radius": data["radius"],
        "Obstacle/Centers": f"-c, -b, {half}; c, -b, {half}",
        "Contact/Friction coefficient": data["F"],
        "Contact/Contact normal": data["normal"],
        "Boundary conditions/Displacement":
            f"1: {end}{(data['along'] + data['squeeze']) * d}; "
            f"2: {end}{(data['along'] - data['squeeze']) * d}",
        "Refinement/Initial refinements": n.bit_length() - 1, "Output/Fields": "false"}
    with tempfile.TemporaryDirectory() as folder:
        status = subprocess.run(
            [PROGRAM, SCENE, f"Output/Directory={folder}",
             *(f"{name}={value}" for name, value in entries.items()), *more],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
        if status != 0:
            return None
        with h5py.File(Path(folder) / "history.h5") as file:
            return list(zip(file["levels/contact_nodes"][:],
                            file["levels/sticky_nodes"][:]))


def counts(data, n):
    found = levels(data, n, "Refinement/Levels=0", "Refinement/Estimate error=false")
    return None if found is None else tuple(map(int, found[0]))


def show(pair):
    return f"{'-' if pair is None else '%d/%d' % tuple(pair):>10}"


def row(title, data, sizes=(4, 8, 16)):
    print(f" {title:<34}" + "".join(show(counts(data, n)) for n in sizes), flush=True)


def head(title):
    print(f" {title:<34}" + "".join(f"{f'n = {n}':>10}" for n in THESIS))
    print(f" {'thesis':<34}" + "".join(map(show, THESIS.values())))


def one_at_a_time():
    head("uniform meshes")
    row("shipped scene", SHIPPED)
    row("depth 0.0295", DEEPER)
    print(" depth 0.0295, and")
    for name, values in (("F", (.3, .44, .5, .6)), ("nu", (.2, .3, .4, .45)),
                         ("angle", (15., 20., 25., 28., 32., 35., 40., 45.)),
                         ("radius", (.25, 1., 2., 100.)),
                         ("depth", (.02, .025, .035, .04)),
                         ("length", (1., 3., 4., 6.)),
                         ("sideways", (.05, .1, .3)), ("along", (.1, .3)),
                         ("squeeze", (-.3, -.1, .1, .3)), ("normal", ("obstacle",))):
        for value in values:
            row(f"  {name} {value}", dict(DEEPER, **{name: value}))


def at_random():
    generator = random.Random(6)
    contact, both = 0, 0
    for _ in range(SAMPLES):
        data = dict(SHIPPED, angle=round(generator.uniform(15, 45), 1),
                    radius=generator.choice((.25, .5, .75, 1., 2.)),
                    depth=round(generator.uniform(.005, .05), 4),
                    nu=generator.choice((.2, .25, .3, .325, .4)),
                    F=generator.choice((.3, .4, .4, .5)),
                    length=generator.choice((1., 2., 3., 4.)),
                    along=generator.choice((0., 0., .1)),
                    squeeze=generator.choice((0., 0., .1)))
        found = []
        for n in (4, 8):
            found.append(counts(data, n))
            if found[-1] is None or found[-1][0] != THESIS[n][0]:
                break
        else:
            contact += 1
            both += found == [THESIS[4], THESIS[8]]
    print(f"\n of {SAMPLES} scenes with random data {contact} have 6 and 14 nodes in "
          f"contact for n = 4 and 8;\n {both} of these have 2 and 4 that stick")


def adaptive():
    print()
    head("adaptive meshes")
    for title, name, values in (("depth 0.0295", "F", (.4, .42, .43, .44, .45, .5)),
                                ("F 0.44", "depth", (.01, .02, .028, .04))):
        print(f" {title}, and")
        for value in values:
            data = dict(DEEPER, F=.44)
            data[name] = value
            found = levels(data, 4 if data["depth"] > .029 else 8,
                           "Refinement/Maximum dofs=60000")
            blank = " " * (10 if data["depth"] <= .029 else 0)
            print(f" {f'  {name} {value}':<34}" + blank + "".join(map(show, found)),
                  flush=True)


os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "1")
one_at_a_time()
adaptive()
at_random()
