"""What must hold of a level, one function after the other. Each gets a Verdict, what
has been recomputed, and the tolerance; reported are the numbers of the level in
history.h5 by name, under 'contact' those of the contact nodes."""

import numpy as np

from expressions import NotUnderstood
from nodal_forces import nodal_loads
from recomputed import Recomputed
from scene_check import compare_with_scene
from verdict import ROUNDING, Verdict, relative


def verify_level(level, reported, scene, tolerance, before=None):
    """level: a Level; scene: a SceneText; before: the Level before it, if there is one.
    Returns a Verdict, and a list of what could not be compared with the scene."""
    verdict, found = Verdict(), Recomputed(level, displacement_before(level, before))
    exact = min(tolerance, ROUNDING)
    check_hanging_nodes(verdict, found, exact)
    check_prescribed_values(verdict, found, exact)
    check_normals(verdict, found, exact)
    check_load_step(verdict, found, reported, scene, exact)
    check_equilibrium(verdict, found, tolerance)
    check_contact(verdict, found, tolerance)
    check_friction(verdict, found, tolerance)
    check_states(verdict, found, tolerance)
    check_certificate(verdict, found, reported, tolerance)
    check_reported_numbers(verdict, found, reported, tolerance)
    check_reported_nodes(verdict, found, reported, tolerance)
    least = least_force(found, scene)
    check_reported_forces(verdict, found, reported, least, tolerance)
    unknown = check_given_forces(verdict, found, reported, scene, least, tolerance)
    return verdict, unknown + compare_with_scene(verdict, level, scene, found.hanging,
                                                 exact)


# What is given.


def check_hanging_nodes(verdict, found, exact):
    """They are those of the mesh, and where their masters have them."""
    level, u, written = found.level, found.u, {}
    for (node, master), weight in zip(level.hanging_nodes.tolist(),
                                      level.hanging_weights):
        masters = written.setdefault(node, {})
        masters[master] = masters.get(master, 0.) + weight
    same = written.keys() == found.hanging.keys() and all(
        written[node].keys() == masters.keys()
        and all(abs(written[node][m] - w) < ROUNDING for m, w in masters.items())
        for node, masters in found.hanging.items())
    verdict.demand(same, "hanging nodes are not those of the mesh, or their masters")
    distances = np.array([
        np.abs(sum(w * u[m] for m, w in masters.items()) - u[node]).max()
        for node, masters in found.hanging.items()])
    verdict.check("given", distances / found.largest_u, exact,
                  "a hanging node is not where its masters have it",
                  level.vertices[list(found.hanging)])


def check_prescribed_values(verdict, found, exact):
    level = found.level
    held = level.is_prescribed.any(axis=1)
    verdict.demand(not np.any(held & found.is_hanging),
                   "the displacement of a hanging node is prescribed")
    differences = np.where(level.is_prescribed, np.abs(found.u - level.values), 0)
    verdict.check("given", differences[held] / found.largest_u, exact,
                  "a displacement is not the prescribed one", level.vertices[held])
    prescribed = level.is_prescribed[level.contact_nodes]
    verdict.check("given", np.abs(level.contact_normals)[prescribed], exact,
                  "the normal displacement of a contact node is prescribed")


def left_out(found):
    """Which nodes of the contact boundary neither hang, nor are held, nor are contact
    nodes."""
    result = np.zeros(found.level.n_nodes, bool)
    result[found.boundary.nodes] = True
    result &= ~found.is_hanging & ~found.level.is_prescribed.all(axis=1)
    result[found.level.contact_nodes] = False
    return result


def check_normals(verdict, found, exact):
    """Contact nodes are on the contact boundary, and their normals are unit vectors
    straight to the obstacle, or not far from those of the faces around the node: no
    farther than the boundary turns there, and a degree. More the mesh does not know of
    a boundary that is round."""
    level, boundary = found.level, found.boundary
    nodes, normals = level.contact_nodes, level.contact_normals
    verdict.demand(boundary.problem is None, boundary.problem)
    verdict.demand(set(nodes) <= set(boundary.nodes) and len(set(nodes)) == len(nodes)
                   and not np.any(found.is_hanging[nodes]),
                   "a contact node is none of the contact boundary")
    verdict.demand(np.array_equal(boundary.section[nodes], level.contact_sections),
                   "a contact node is said to be on another boundary")
    verdict.demand(np.all(np.isfinite(found.gap)),
                   "a contact node cannot meet the obstacle")
    verdict.check("given", np.abs(np.linalg.norm(normals, axis=1) - 1), exact,
                  "a normal is no unit vector", found.x)
    for contact in level.contacts:
        own = level.of_contact(contact)
        if contact.contact_normal == "obstacle":
            x, outward = found.x[own], boundary.normal[nodes[own]]
            _, towards = contact.obstacle.nearest(x, outward)
            # Normals of faces are not quite those of the body, which may face the
            # obstacle only just.
            unclear = np.linalg.norm(towards, axis=1) == 0
            _, towards[unclear] = contact.obstacle.nearest(x[unclear], outward[unclear],
                                                           0.)
            # Where a node is held in some directions, in those that are left.
            towards = np.where(level.is_prescribed[nodes[own]], 0, towards)
            towards /= np.maximum(np.linalg.norm(towards, axis=1), 1e-300)[:, None]
            verdict.check("given", np.abs(normals[own] - towards).max(axis=1, initial=0),
                          exact, "a normal does not point straight to the obstacle",
                          found.x[own])
        else:
            cosines = np.clip(np.sum(normals * boundary.normal[nodes], axis=1), -1, 1)
            turns = np.array([boundary.turn.get(node, 0) for node in nodes])
            verdict.demand(
                np.all((np.degrees(np.arccos(cosines)) <= turns + 1)[own]),
                "a normal points away from those of the faces around its node")


def displacement_before(level, before):
    """The displacement at the end of the load step before at the nodes of this level, if
    that is on the same mesh; else None."""
    if (not level.has_slip_origins or before is None
            or level.load_step - before.load_step != 1
            or before.vertices.shape != level.vertices.shape):
        return None
    here, there = np.lexsort(level.vertices.T), np.lexsort(before.vertices.T)
    if relative(level.vertices[here], before.vertices[there]) > ROUNDING:
        return None
    u = np.empty(level.vertices.shape)
    u[here] = before.displacement[there]
    return u


def check_load_step(verdict, found, reported, scene, exact):
    """The time is that of the scene, and slip counts from the tangential displacement
    at the end of the step before, on the same mesh; in the first step from zero."""
    level, several = found.level, len(scene.times) > 1
    verdict.demand((level.time is not None) == several
                   and (not several or scene.times[level.load_step - 1] == level.time
                        == reported["time"]),
                   "the time is not that of the scene")
    verdict.demand(level.has_slip_origins == (level.load_step > 1)
                   or len(level.contact_nodes) == 0,
                   "slip counts from another step")
    if not level.has_slip_origins:
        return
    verdict.demand(found.previous is not None,
                   "the load step before is missing, or has another mesh")
    if found.previous is None:
        return
    u, n = found.previous[level.contact_nodes], level.contact_normals
    tangential = u - np.sum(u * n, axis=1)[:, None] * n
    verdict.check("given", np.abs(tangential - level.slip_origins).max(axis=1, initial=0)
                  / found.largest_u, exact,
                  "slip does not count from the load step before", found.x)


# The law.


def unbalanced(found):
    """Forces at nodes and in directions that nothing holds (nodes x dim), relative."""
    level = found.level
    free = ~level.is_prescribed & ~found.is_hanging[:, None]
    free[level.contact_nodes] = False
    return np.abs(np.where(free, found.r, 0)) / found.unit[:, None]


def depth(found):
    return (np.maximum(-found.room, 0) * found.stiffness_n * found.zone
            / found.contact_unit)


def pulling(found):
    return np.maximum(-found.pressing, 0) / found.contact_unit


def at_distance(found):
    """Of the force, and of that which would close the distance, the smaller one."""
    closing = found.stiffness_n * found.room
    return np.maximum(np.minimum(found.pressing, closing), 0) / found.contact_unit


def beyond_cone(found):
    return np.maximum(found.drag - found.bound, 0) / found.contact_unit


def wrong_slip(found):
    """A node has not moved, or friction acts against its slip with full strength: of
    the two violations the smaller one."""
    full = found.bound[:, None] * found.direction
    deviation = np.linalg.norm(found.r_T - full, axis=1)
    wrong = np.minimum(deviation, found.stiffness_T * found.slip) / found.contact_unit
    return np.where(found.can_slide, wrong, 0)


def wrong_states(found):
    """What is not as nodes are said to be, by name. Given friction (Tresca's) may hold a
    node that is open: whether it slides, its state does not say, and wrong_slip() asks."""
    state, unit = found.level.contact_states, found.contact_unit
    rubs = found.can_slide & (found.law != "none")
    # A prescribed component of the slip leaves but a share of the bound to the others.
    share = np.where(found.slip > 0, np.linalg.norm(found.direction, axis=1), 1)
    missing = np.maximum(found.bound * share - found.drag, 0)
    apart = found.stiffness_n * np.abs(found.room) * found.zone
    slip = found.stiffness_T * found.slip * found.zone
    return {"open": np.where(state == 0, np.abs(found.pressing), 0) / unit,
            "touches": np.where(state > 0, apart, 0) / unit,
            "sticks": np.where(rubs & (state == 2), slip, 0) / unit,
            "slides": np.where(rubs & (state == 1), missing, 0) / unit}


def check_equilibrium(verdict, found, tolerance):
    verdict.check("equilibrium", unbalanced(found), tolerance,
                  "there is a force where nothing holds the body",
                  found.level.vertices)


def check_contact(verdict, found, tolerance):
    """No penetration, no tension, no force at a distance. Nodes that are left out,
    since they cannot meet the obstacle along their normals, must not be in it."""
    level, x = found.level, found.x
    verdict.check("penetration", depth(found), tolerance,
                  "a node is inside of the obstacle", x)
    per_length = np.max(found.stiffness_n * found.zone / found.contact_unit, initial=0)
    for contact in level.contacts:
        others = left_out(found) & (found.boundary.section == contact.number)
        places = level.vertices[others]
        depths = contact.obstacle.depth(places + found.u[others])
        verdict.check("penetration", depths * per_length, tolerance,
                      "a node that is left out is inside of the obstacle", places)
    verdict.check("tension", pulling(found), tolerance, "the obstacle pulls", x)
    verdict.check("tension", at_distance(found), tolerance,
                  "the obstacle pushes from a distance", x)


def check_friction(verdict, found, tolerance):
    verdict.check("cone", beyond_cone(found), tolerance, "friction is beyond its bound",
                  found.x)
    verdict.check("slip", wrong_slip(found), tolerance,
                  "friction does not oppose the slip as it should", found.x)


def check_states(verdict, found, tolerance):
    """Nodes do what they are said to do. The law alone does not tell: a node that has
    not moved may stick, or be about to slide."""
    x, state = found.x, found.level.contact_states
    verdict.demand(np.all(np.isin(state, (0, 1, 2))), "a contact node has no known state",
                   "states")
    verdict.demand(any(contact.friction_law != "none" for contact in
                       found.level.contacts) or not np.any(state == 2),
                   "a node is said to stick, and there is no friction", "states")
    wrong = wrong_states(found)
    for name, sentence in (
            ("open", "there is a force at a node that is said to be open"),
            ("touches", "a node that is said to touch does not"),
            ("sticks", "a node that is said to stick has moved"),
            ("slides", "a node that is said to slide bears less friction than it can")):
        verdict.check("states", wrong[name], tolerance, sentence, x)


# What is reported.


def check_certificate(verdict, found, reported, tolerance):
    """By its own definition."""
    said = reported["certificate"]
    verdict.certificate = max(np.max(part, initial=0) for part in (
        unbalanced(found), depth(found), pulling(found), at_distance(found),
        beyond_cone(found), wrong_slip(found), *wrong_states(found).values()))
    verdict.check(None, max(verdict.certificate - said, 0), .1 * tolerance,
                  f"the certificate is reported to be {said:.1e} and is "
                  f"{verdict.certificate:.1e}, which is more by")


def check_reported_numbers(verdict, found, reported, tolerance):
    """Of the level. Forces and stresses are compared with no less than those of
    rounding, and the energy with the work of such forces at all nodes, with signs that
    are random."""
    level, measure = found.level, found.measure
    touches, sticks = level.contact_states > 0, level.contact_states == 2
    friction = np.sum(found.bound * found.slip)
    energy = found.strain_energy - found.work + friction
    parts = max(found.strain_energy + abs(found.work) + friction,
                found.rounding * found.largest_u * np.sqrt(level.n_nodes)) or 1.
    verdict.check("energy", abs(energy - reported["energy"]) / parts, tolerance,
                  "the reported energy is wrong")
    for name, number in (("cells", len(level.cells)),
                         ("dofs", level.dim * level.n_nodes),
                         ("contact_nodes", touches.sum()),
                         ("sticky_nodes", sticks.sum())):
        verdict.demand(reported[name] == number, f"{name} is reported to be "
                       f"{reported[name]:.0f} and is {number}", "states")

    def half_width(nodes):
        area = measure[nodes].sum()
        return area / 2 if level.dim == 2 else np.sqrt(area / np.pi)

    total = found.pressing[touches].sum()
    pressure = np.max((found.pressing / measure)[touches], initial=0)
    tangential = np.linalg.norm(found.r_T.sum(axis=0))
    for name, number, least in (
            ("normal_force", total, found.rounding),
            ("tangential_force", tangential,
             max(np.sum(found.drag), total, found.rounding)),
            ("max_pressure", pressure, found.rounding / measure.min(initial=np.inf)),
            ("contact_half_width", half_width(touches), 0),
            ("stick_half_width", half_width(sticks), 0)):
        verdict.check(None, relative(number, reported[name], least), tolerance,
                      f"{name} is reported to be {reported[name]:.6g} and is "
                      f"{number:.6g}")


def reactions_at_nodes(found):
    """What prescribed displacements exert on the body (nodes x dim): -r, without the
    forces of obstacles."""
    level, reactions = found.level, -found.r.copy()
    reactions[level.contact_nodes] += (found.pressing[:, None] * level.contact_normals
                                       + found.r_T)
    reactions[~level.is_prescribed] = 0
    return reactions


def least_force(found, scene):
    """What sums of forces are compared with at least, since less is rounding: that which
    the displacements leave, and where forces are given, the displacements with which the
    search for them begins, which are a million times as large or more where a force is
    to be zero."""
    level, largest = found.level, 0.
    try:
        platens = dict(scene.boundary_conditions("Boundary conditions/Force"))
        for boundary, components in scene.boundary_conditions(
                "Boundary conditions/Displacement"):
            if boundary in platens:
                nodes = level.nodes_of_boundary(boundary)
                texts = ["0" if c == "free" else c for c in components]
                field = scene.vector_field(texts, level.vertices[nodes])
                largest = max(largest, np.abs(field).max(initial=0))
    except NotUnderstood:
        pass  # Which check_given_forces() tells.
    return max(found.rounding, 1e-6 * found.largest_stiffness * largest)


def check_given_forces(verdict, found, reported, scene, least, tolerance):
    """What holds a platen exerts the force that the scene gives, up to a part of the
    largest force on the body that there has been, and is where it is said to be.
    Returns entries that are beyond this program."""
    level, is_taken = found.level, np.zeros(found.u.shape, bool)
    reactions = reactions_at_nodes(found)
    unit = max(found.pressing.sum(), np.abs(nodal_loads(
        level, level.body_force, level.traction_faces, level.tractions)).sum())
    unit = max([unit, least, *reported["normal_forces_before"]])
    try:
        platens = dict(scene.boundary_conditions("Boundary conditions/Force"))
        if not platens:
            return []
        for boundary, components in scene.boundary_conditions(
                "Boundary conditions/Displacement"):
            nodes = level.nodes_of_boundary(boundary)
            own = np.zeros(found.u.shape, bool)
            own[nodes] = [c != "free" for c in components]
            own &= ~is_taken
            is_taken |= own
            own &= level.is_prescribed
            given = platens.pop(boundary, [])
            texts = ["0" if c == "free" else c for c in components]
            moved = found.u - scene.vector_field(texts, level.vertices)
            for d in [d for d, force in enumerate(given) if force != "free"]:
                wanted = scene.vector_field(["0" if c == "free" else c for c in given],
                                            np.zeros((1, level.dim)))[0][d]
                force = reactions[own[:, d], d].sum()
                unit = max(unit, abs(wanted), abs(force))
                verdict.check(None, abs(force - wanted) / (unit or 1.), tolerance,
                              f"the force on boundary {boundary} is not that of "
                              "'Boundary conditions/Force'")
                said = reported.get("forces", {}).get(f"platen_{boundary}")
                verdict.demand(said is not None, f"history.h5 has no 'platen_{boundary}'")
                if said is not None:
                    verdict.check(None, np.abs(moved[own[:, d], d] - said[d])
                                  / found.largest_u, tolerance,
                                  f"boundary {boundary} is not where history.h5 says")
        for boundary in platens:
            verdict.demand(False, f"boundary {boundary} has a force and no displacement")
    except NotUnderstood as error:
        return [f"'Boundary conditions/Force' ({error})"]
    return []


def check_reported_forces(verdict, found, reported, least, tolerance):
    """The forces on the body, if they are there: those of the obstacle, reactions as
    far as a boundary does not share nodes with another one that is held, loads, and
    their sum, which the residual alone must give."""
    level, forces = found.level, reported.get("forces", {})
    if not forces:
        return
    normals = level.contact_normals
    contact, mine = -found.pressing[:, None] * normals - found.r_T, {}
    for part in level.contacts:
        own, name = level.of_contact(part), "contact"
        name += "" if part.number == 1 else f"_{part.number}"
        if part.contact_boundary >= 0:
            mine.update({name: contact[own].sum(axis=0),
                         name + "_normal": found.pressing[own].sum(),
                         name + "_tangential": -found.r_T[own].sum(axis=0)})
    others = reactions_at_nodes(found)
    held = [int(name[len("held_"):]) for name in forces if name.startswith("held_")]
    held = {boundary: level.nodes_of_boundary(boundary) for boundary in held}
    reactions = sum((forces[name] for name in forces
                     if name.startswith("held_") or name == "pinned"),
                    np.zeros(level.dim))
    mine["all reactions"] = others.sum(axis=0)
    forces = dict(forces, **{"all reactions": reactions})
    for boundary, nodes in held.items():
        shared = [n for b, n in held.items() if b != boundary] + [np.zeros(0, int)]
        if "pinned" not in forces and not np.intersect1d(nodes,
                                                         np.hstack(shared)).size:
            mine[f"held_{boundary}"] = others[nodes].sum(axis=0)
    if level.body_force is not None:
        mine["body_force"] = nodal_loads(level, level.body_force,
                                         level.traction_faces[:0], None).sum(axis=0)
    tractions = sum((forces[name] for name in forces if name.startswith("traction_")),
                    np.zeros(level.dim))
    forces["all tractions"] = tractions
    mine["all tractions"] = nodal_loads(level, None, level.traction_faces,
                                        level.tractions).sum(axis=0)
    largest = max([least, *(np.abs(value).max() for value in mine.values())])
    for name, value in mine.items():
        theirs = forces.get(name)
        verdict.demand(theirs is not None, f"history.h5 has no force '{name}'")
        if theirs is not None:
            verdict.check(None, np.abs(theirs - value).max() / (largest or 1.), tolerance,
                          f"the force '{name}' is reported to be {theirs} and is {value}")
    total = contact.sum(axis=0) + sum(
        (mine[name] for name in ("all reactions", "all tractions", "body_force")
         if name in mine), np.zeros(level.dim))
    verdict.check(None, np.linalg.norm(total) / (largest or 1.), tolerance,
                  "the forces on the body do not balance")


def check_reported_nodes(verdict, found, reported, tolerance):
    """The contact nodes in history.h5, which have an order of their own. A force on the
    body is -r, without what prescribed displacements take."""
    level, records = found.level, reported.get("contact", {})
    n = len(records.get("point", []))
    verdict.demand(n == len(level.contact_nodes),
                   f"history.h5 has {n} contact nodes of {len(level.contact_nodes)}")
    if n != len(level.contact_nodes) or n == 0:
        return
    order = np.lexsort(found.x.T[::-1])
    size = np.ptp(level.vertices, axis=0).max()
    theirs = np.lexsort(records["point"].T[::-1])
    force = -found.pressing[:, None] * level.contact_normals - found.r_T
    for name, values in (
            ("point", found.x), ("normal", level.contact_normals),
            ("displacement", found.u_c), ("gap", found.gap),
            ("measure", found.measure), ("state", level.contact_states)):
        # Gaps may be all rounding.
        smallest = 1e-6 * size if name == "gap" else 0.
        verdict.check("given", relative(values[order], records[name][theirs], smallest),
                      ROUNDING, f"'{name}' of contact nodes in history.h5 is wrong")
    difference = relative(force[order], records["force"][theirs], found.rounding)
    verdict.check(None, difference, tolerance,
                  "'force' of contact nodes in history.h5 is wrong")
