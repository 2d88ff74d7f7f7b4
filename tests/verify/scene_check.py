"""Whether a run has solved what its scene says."""

import numpy as np

from expressions import NotUnderstood, split
from nodal_forces import nodal_loads
from unit_cell import corner_functions, gauss_points
from verdict import relative


def compare_with_scene(verdict, level, scene, hanging, limit):
    """Whether the run has solved what its scene says. Returns entries that are beyond
    this program."""
    dim, X, unknown = level.dim, level.vertices, []

    def attempt(entry, compare):
        try:
            compare()
        except NotUnderstood as error:
            unknown.append(f"'{entry}' ({error})")

    def same(entry, mine, theirs):
        verdict.check("given", relative(mine, theirs), limit,
                      f"'{entry}' is not what the scene says")

    def material():
        same("Material", [scene.names["E"], scene.names["nu"]],
             [level.youngs_modulus, level.poisson_ratio])
        verdict.demand(scene["Material/Volumetric strain"] == level.volumetric_strain,
                       "'Material/Volumetric strain' is not what the scene says")

    def regions():
        given, materials = np.zeros(len(level.cells), int), [level.materials[0]]
        middles = X[level.cells].mean(axis=1) @ scene.rotation
        same("Material", level.materials[0][:2], [scene.names["E"], scene.names["nu"]])
        for key, numbers in scene.conditions("Material/Regions"):
            if key.startswith("where"):
                inside = scene.evaluate(key[len("where"):], middles) != 0
            else:
                inside = level.cell_ids == scene.group(key, 0)
            given[inside] = len(materials)
            kind = numbers[2] if len(numbers) > 2 else level.volumetric_strain
            materials.append([scene.evaluate(numbers[0]), scene.evaluate(numbers[1]),
                              kind == "mean"])
        verdict.demand(np.array_equal(given, level.cell_regions),
                       "'Material/Regions' has other cells than the scene says")
        same("Material/Regions", np.array(materials, float), level.materials)

    def friction(contact, section, obstacle):
        law, F = scene[section + "/Friction law"], scene.coefficient(section)
        varies = isinstance(F, str)
        if law == "Coulomb" and not varies and F == 0:
            law = "none"
        # Without an obstacle there is nothing to point to.
        normal = ("body" if scene[obstacle + "/Kind"] == "none"
                  else scene[section + "/Contact normal"])
        verdict.demand(law == contact.friction_law and normal == contact.contact_normal,
                       f"section '{section}' is not what the scene says")
        own = level.of_contact(contact)
        nodes = X[level.contact_nodes[own]] @ scene.rotation
        # An expression has no value where there are no nodes.
        if law == "Coulomb" and (len(nodes) or not varies):
            if varies:
                F = np.broadcast_to(scene.evaluate(F, nodes), len(nodes))
            elif np.ndim(level.friction_coefficient):
                F = np.full(len(nodes), F)
            same(section + "/Friction coefficient", F,
                 level.friction_coefficient[own] if np.ndim(level.friction_coefficient)
                 else contact.friction_coefficient)
        if law == "Tresca" and len(nodes):
            bounds = scene.evaluate(scene[section + "/Friction bound"], nodes)
            same(section + "/Friction bound", np.broadcast_to(bounds, len(nodes)),
                 level.friction_bounds[own])

    def contact_boundary(contact, section):
        verdict.demand(
            scene.group(scene[section + "/Boundary id"], 1) == contact.contact_boundary,
            f"'{section}/Boundary id' is not what the scene says")

    def displacement():
        is_set, values = np.zeros((len(X), dim), bool), np.zeros((len(X), dim))

        def prescribe(nodes, components):
            texts = ["0" if c == "free" else c for c in components]
            wanted = np.array([c != "free" for c in components])
            new = np.zeros(is_set.shape, bool)
            new[nodes] = wanted
            new &= ~is_set
            values[new] = scene.vector_field(texts, X)[new]
            is_set[new] = True
            return new

        hanging_nodes = list(hanging)
        platens = dict(scene.boundary_conditions("Boundary conditions/Force"))
        for boundary, components in scene.boundary_conditions(
                "Boundary conditions/Displacement"):
            new = prescribe(level.nodes_of_boundary(boundary), components)
            # A platen may be anywhere, but moves as a whole.
            new[hanging_nodes] = False
            for d, force in enumerate(platens.get(boundary, [])):
                if force != "free" and new[:, d].any():
                    moved = (level.values - values)[new[:, d], d]
                    values[new[:, d], d] += moved.mean()
        size = np.linalg.norm(X[level.cells[:, 0]] - X[level.cells[:, -1]], axis=1)
        for key, components in scene.conditions("Boundary conditions/Pinned points"):
            point = scene.rotation @ scene.numbers(key.strip()[1:-1])
            nearest = np.argmin(np.linalg.norm(X - point, axis=1))
            if np.linalg.norm(X[nearest] - point) < 1e-8 * size.max():
                prescribe([nearest], components)
        is_set[hanging_nodes], values[hanging_nodes] = False, 0
        verdict.demand(np.array_equal(is_set, level.is_prescribed),
                       "other displacements are prescribed than the scene says")
        same("Boundary conditions/Displacement", values, level.values)

    def loads():
        body, faces, tractions = None, [], []
        components = split(scene["Boundary conditions/Body force"], ",")
        if components:
            values, _ = corner_functions(gauss_points(2, dim)[0])
            points = np.einsum("qv,kvd->kqd", values, X[level.cells]).reshape(-1, dim)
            body = scene.vector_field(components, points)
        values, _ = corner_functions(gauss_points(4, dim - 1)[0])
        for boundary, components in scene.boundary_conditions(
                "Boundary conditions/Traction"):
            part = level.boundary_faces[level.boundary_ids == boundary]
            points = np.einsum("qv,kvd->kqd", values, X[part]).reshape(-1, dim)
            faces.append(part)
            tractions.append(scene.vector_field(components, points))
        empty = np.zeros((0, 2**(dim - 1)), int), np.zeros((0, dim))
        same("Boundary conditions/Body force' or 'Traction",
             nodal_loads(level, body, np.vstack([empty[0], *faces]),
                         np.vstack([empty[1], *tractions])),
             nodal_loads(level, level.body_force, level.traction_faces,
                         level.tractions))

    attempt("Material", material)
    attempt("Material/Regions", regions)
    sections, obstacles = scene.sections("Contact"), scene.sections("Obstacle")
    verdict.demand([*sections] == [contact.number for contact in level.contacts],
                   "there are other sections 'Contact' than the scene has")
    pairs = [(contact, sections[contact.number], obstacles[contact.number])
             for contact in level.contacts if contact.number in sections]
    for contact, section, obstacle in pairs:
        attempt(section + "/Boundary id",
                lambda c=contact, s=section: contact_boundary(c, s))
        attempt(section + "/Friction bound",
                lambda c=contact, s=section, o=obstacle: friction(c, s, o))
    attempt("Boundary conditions/Displacement", displacement)
    attempt("Boundary conditions/Body force' or 'Traction", loads)
    for contact, _, obstacle in pairs:
        attempt(obstacle, lambda c=contact, o=obstacle: same(
            o, scene.obstacle(section=o).numbers(), c.obstacle.numbers()))
    return unknown
