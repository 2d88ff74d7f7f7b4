"""The picture of one run: the body, its contact boundary, and how the solution was
found."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize, PowerNorm
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator

import body
import boundary
from drawing import (BLUE, GREEN, GREY, PHASE_NAMES, PHASES, RED, STRESS, plt)
from failure import Failure
from fields import Mesh, read_fields, select_field


def draw_run(run, choice):
    """A figure. Raises Failure."""
    level = run.last if choice.level is None else choice.level
    row = run.row(level)
    nodes = run.contact.get(level)
    mesh = (read_fields(run.directory, "body", level) if "body" in choice.panels
            else None)
    if mesh is None and list(choice.panels) == ["body"]:
        raise Failure(f"the run in '{run.directory}' has written no fields of level "
                      f"{level}; do without the panel 'body', or set "
                      "'Output/Fields = true'.")
    in_space = run.dim == 3
    faces = (read_fields(run.directory, "contact", level)
             if in_space and "contact" in choice.panels else None)

    rows = []
    window = None
    if mesh is not None:
        seen = points_seen(mesh, nodes, in_space, choice)
        window = zoom_window(seen, nodes, in_space, choice)
        size = np.ptp(seen, axis=0)
        width = 4.3 if window is not None else 8.5
        rows.append(("body", np.clip(width * 1.08 * size[1] / size[0], 2.2, 4.0)
                     + 0.6))
    if nodes is not None and "contact" in choice.panels:
        if not in_space:
            rows.append(("line", 3.2))
        elif faces is not None:
            rows.append(("maps", 3.6))
    if "convergence" in choice.panels:
        rows.append(("convergence", 2.7))
    if not rows:
        raise Failure(f"the run in '{run.directory}' has nothing of what is to be "
                      f"drawn on level {level}.")

    height = sum(h for _, h in rows) + 0.55
    figure = plt.figure(figsize=(10, height), layout="constrained")
    figure.get_layout_engine().set(h_pad=0.1, w_pad=0.08)
    figure.suptitle(title_of(run, row), fontsize=10)
    parts = figure.subfigures(len(rows), 1, height_ratios=[h for _, h in rows],
                              squeeze=False)[:, 0]
    for part, (name, _) in zip(parts, rows):
        if name == "body" and in_space:
            draw_body_in_space(part, run, (mesh, nodes, row), choice, window)
        elif name == "body":
            draw_body_in_plane(part, run, (mesh, nodes, row), choice, window)
        elif name == "line":
            draw_line(part, run, nodes)
        elif name == "maps":
            draw_maps(part, run, nodes, faces)
        else:
            draw_convergence(part, run)
    return figure


def counted(n, one, several):
    return f"{n} {one if n == 1 else several}"


def title_of(run, row):
    touching = counted(row["contact_nodes"], "node", "nodes")
    return (f"{run.scene}, level {row['level']}: {row['dofs']} degrees of freedom, "
            f"{touching} in contact, {row['sticky_nodes']} of them "
            f"{'sticks' if row['sticky_nodes'] == 1 else 'stick'}")


# The body.

def scale_of(values, mesh, row, choice):
    """Of stresses: roots spread what is small, and neither a corner where the body is
    held nor a single node decides where the scale ends."""
    if choice.scale is not None:
        return Normalize(*choice.scale, clip=True), "neither"
    # Of the area or volume, not of the points, which are where the mesh is fine.
    cells = mesh.points[mesh.cells]
    sizes = np.prod(np.ptp(cells, axis=1)[:, :2 if cells.shape[1] == 4 else 3], axis=1)
    means = values[mesh.cells].mean(axis=1)
    order = np.argsort(means)
    share = np.cumsum(sizes[order]) / max(sizes.sum(), 1e-300)
    most = means[order][min(np.searchsorted(share, 0.995), len(order) - 1)]
    lowest, highest = values.min(), values.max()
    if choice.field.endswith("stress") or choice.field.startswith(("stress",
                                                                    "principal")):
        most = max(most, 0.7 * row["max_pressure"])
    top = min(most, highest)
    if top <= lowest:
        top = lowest + (abs(lowest) if lowest != 0 else 1.)
    extend = "max" if highest > top * (1 + 1e-9) else "neither"
    if lowest >= 0:
        return PowerNorm(0.5, 0, top, clip=True), extend
    bottom = max(lowest, -2 * abs(top)) if top > 0 else lowest
    if lowest < bottom:
        extend = {"max": "both", "neither": "min"}[extend]
    return Normalize(bottom, top, clip=True), extend


def name_of_field(run, name):
    text = name.replace("_", " ")
    if "stress" in name:
        return run.axis(text, "levels/max_pressure")
    if "displacement" in name:
        return run.axis(text, "levels/contact_half_width")
    return text


def ticks_of(norm):
    """Round numbers, which are about equally far from each other on the scale."""
    if not isinstance(norm, PowerNorm):
        return MaxNLocator(5)
    ticks = [0.]
    for part in (1 / 16, 1 / 4, 9 / 16, 0.95):
        unit = 10**np.floor(np.log10(part * norm.vmax))
        ticks.append(np.floor(part * norm.vmax / unit + 1e-9) * unit)
    return ticks


def add_scale(part, axes, run, norm, extend, field):
    bar = part.colorbar(ScalarMappable(norm, STRESS), ax=axes, extend=extend,
                        shrink=0.85, pad=0.02, aspect=28, panchor=False,
                        ticks=ticks_of(norm))
    bar.outline.set_visible(False)
    bar.set_label(name_of_field(run, field))
    bar.ax.tick_params(labelsize=8)


def view_of(nodes):
    """In space, from the side of the obstacle."""
    normal = np.array([0., 0., -1.])
    if nodes is not None:
        touching = nodes["state"] > 0
        normal = nodes["normal"][touching if touching.any() else slice(None)].mean(axis=0)
        if np.linalg.norm(normal) < 0.1:
            normal = nodes["normal"][0]
    return body.View.onto(normal)


def points_seen(mesh, nodes, in_space, choice):
    """Two coordinates of each point of the body as it is drawn."""
    points = body.displaced(mesh, choice.warp)
    return view_of(nodes)(points) if in_space else points[:, :2]


def zoom_window(seen, nodes, in_space, choice):
    """Around the nodes in contact, in the coordinates of points_seen(); None if that
    is nothing, or nearly everything."""
    if nodes is None or not (nodes["state"] > 0).any():
        return None
    at = nodes["point"] + choice.warp * nodes["displacement"]
    normal = nodes["normal"][nodes["state"] > 0].mean(axis=0)
    if in_space:
        view = view_of(nodes)
        at, normal = view(at), view(normal)
    lower, upper = boundary.zone(at, nodes["state"], 0.4)
    # Neither much wider than high nor the contrary, as far as the body reaches.
    half = (upper - lower) / 2
    half = np.maximum(half, 0.4 * half.max())
    if half.max() == 0:
        half = half + 0.02 * np.ptp(seen, axis=0).max()
    middle = (lower + upper) / 2
    if not in_space:
        middle = middle - 0.75 * normal * half
    window = np.stack([middle - half, middle + half])
    if (np.ptp(window, axis=0) > 0.6 * np.ptp(seen, axis=0)).any():
        return None
    return window


def draw_body_in_plane(part, run, data, choice, window):
    mesh, nodes, row = data
    points = body.displaced(mesh, choice.warp)
    values = select_field(mesh, choice.field)
    norm, extend = scale_of(values, mesh, row, choice)
    lower, upper = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    margin = 0.04 * (upper - lower).max()
    panels = part.subplots(1, 1 if window is None else 2, squeeze=False)[0]
    for axes, view in zip(panels, (np.stack([lower - margin, upper + margin]), window)):
        body.draw_plane(axes, points, body.cells_inside(points, mesh.cells, view),
                        values, norm)
        if nodes is not None:
            draw_obstacle(axes, nodes, view)
        frame(axes, view)
        axes.tick_params(labelsize=8, color="0.7")
        axes.xaxis.set_major_locator(MaxNLocator(5))
        axes.yaxis.set_major_locator(MaxNLocator(5))
        axes.set_xlabel(run.axis("x", "levels/contact_half_width"))
        axes.set_ylabel(run.axis("y", "levels/contact_half_width"))
    set_titles(panels, "body", choice, window)
    add_scale(part, list(panels), run, norm, extend, choice.field)


def frame(axes, view):
    axes.set_xlim(*view[:, 0])
    axes.set_ylim(*view[:, 1])
    for spine in axes.spines.values():
        spine.set_visible(True)
        spine.set_color("0.7")


def set_titles(panels, name, choice, window):
    warp = ("" if choice.warp == 1 else ", undeformed" if choice.warp == 0 else
            f", displacements times {choice.warp:g}")
    panels[0].set_title(name + warp)
    if window is not None:
        panels[1].set_title("contact zone (the small frame)")
        panels[0].add_patch(Rectangle(window[0], *np.ptp(window, axis=0), clip_on=False,
                                      facecolor="none", edgecolor="k", linewidth=0.9))


def draw_obstacle(axes, nodes, window):
    """Where the gaps end: all that a run knows of the obstacle."""
    surface = nodes["point"] + nodes["gap"][:, None] * nodes["normal"]
    depth = 0.025 * (window[1] - window[0]).max()
    near = ((surface > window[0] - (window[1] - window[0]))
            & (surface < window[1] + (window[1] - window[0]))).all(axis=1)
    for piece in boundary.chains(nodes["point"], nodes["measure"]):
        piece = piece[near[piece]]
        if len(piece) < 2:
            continue
        away = surface[piece] + depth * nodes["normal"][piece]
        axes.fill(*np.concatenate([surface[piece], away[::-1]]).T, color="0.8",
                  linewidth=0, zorder=0)
        axes.plot(*surface[piece].T, color="0.3", linewidth=0.8, zorder=0)


def draw_body_in_space(part, run, data, choice, window):
    mesh, nodes, row = data
    values = select_field(mesh, choice.field)
    norm, extend = scale_of(values, mesh, row, choice)
    view = view_of(nodes)
    panels = part.subplots(1, 1 if window is None else 2, squeeze=False)[0]
    body.draw_space(panels, mesh, values, view, norm, choice.warp)
    draw_directions(panels[0], view)
    if window is not None:
        panels[1].axis("on")
        panels[1].set_xticks([])
        panels[1].set_yticks([])
        frame(panels[1], window)
    set_titles(panels, "body, seen from the side of the obstacle", choice, window)
    add_scale(part, list(panels), run, norm, extend, choice.field)


def draw_directions(axes, view):
    """Where x, y and z point to."""
    inset = axes.inset_axes([0.0, 0.0, 0.16, 0.16])
    for name, arrow in zip("xyz", view(np.eye(3))):
        inset.annotate("", arrow, (0, 0), arrowprops={
            "arrowstyle": "-|>", "color": "0.3", "linewidth": 0.9,
            "shrinkA": 0, "shrinkB": 0})
        inset.text(*(1.28 * arrow), name, ha="center", va="center", fontsize=9,
                   color="0.3")
    inset.set_xlim(-1.4, 1.4)
    inset.set_ylim(-1.4, 1.4)
    inset.set_aspect("equal")
    inset.axis("off")


# The contact boundary in the plane.

def phase_legend(states=(0, 1, 2)):
    return [Patch(facecolor=PHASES[s], edgecolor="0.7", linewidth=0.5,
                  label=PHASE_NAMES[s]) for s in states]


def draw_line(part, run, nodes):
    """Pressure and tangential stress, with what friction allows, and states."""
    window = boundary.zone(nodes["point"], nodes["state"], 0.35)
    shown = ((nodes["point"] >= window[0] - 1e-12)
             & (nodes["point"] <= window[1] + 1e-12)).all(axis=1)
    line = boundary.Line(nodes, shown)
    touching = line.place[nodes["state"] > 0]
    if len(touching) == 0:
        touching = line.place
    margin = 0.3 * max(np.ptp(touching), 3 * nodes["measure"].max() if len(
        touching) < 3 else 0.)
    limits = (max(touching.min() - margin, line.place.min()),
              min(touching.max() + margin, line.place.max()))

    pressure, tangential = boundary.tractions(nodes)
    along = np.sum(tangential * line.tangent, axis=1)
    bound = nodes["friction_bound"]
    with_friction = bound.max() > 0
    axes = part.subplots()
    axes.axhline(0, color="0.8", linewidth=0.8)
    for i, piece in enumerate(line.pieces):
        marker = "." if len(piece) < 120 else None
        s = line.place[piece]
        first = i == 0
        axes.plot(s, pressure[piece], color=BLUE, marker=marker,
                  label="pressure" if first else None)
        axes.plot(s, along[piece], color=RED, marker=marker,
                  label="tangential stress" if first else None)
        if with_friction:
            for sign in (1, -1):
                axes.plot(s, sign * bound[piece], color="k", linestyle="--",
                          linewidth=0.9, label="what friction allows"
                          if first and sign > 0 else None)
    axes.set_xlim(*limits)
    axes.set_ylim(*range_of([pressure, along], (line.place >= limits[0])
                            & (line.place <= limits[1])))
    axes.set_xlabel(run.axis(line.name, "contact/gap"))
    axes.set_ylabel(run.axis("stress", "levels/max_pressure"))
    strip(axes, line, nodes)
    handles, _ = axes.get_legend_handles_labels()
    present = sorted(set(nodes["state"][(line.place >= limits[0])
                                        & (line.place <= limits[1])]))
    axes.legend(handles=handles + phase_legend(present), loc="center left",
                bbox_to_anchor=(1.0, 0.5))


def range_of(curves, shown):
    """Of an axis, for what is shown of some curves."""
    values = np.concatenate([curve[shown] for curve in curves] + [[0.]])
    margin = 0.07 * max(np.ptp(values), 1e-300)
    return values.min() - margin, values.max() + margin


def strip(axes, line, nodes):
    """States of the nodes at the bottom, each to half of the way to its neighbours; one
    that is alone as wide as its measure."""
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.08 * (high - low), high)
    for piece in line.pieces:
        piece = piece[np.argsort(line.place[piece], kind="stable")]
        s, alone = line.place[piece], nodes["measure"][piece[0]] / 2
        edges = (np.array([s[0] - alone, s[0] + alone]) if len(piece) == 1 else
                 np.concatenate([s[:1], (s[1:] + s[:-1]) / 2, s[-1:]]))
        for state in range(3):
            here = nodes["state"][piece] == state
            axes.broken_barh(list(zip(edges[:-1][here], np.diff(edges)[here])),
                             (0, 0.05), transform=axes.get_xaxis_transform(),
                             facecolors=PHASES[state], edgecolors="none",
                             rasterized=True)


# The contact boundary in space.

def of_one_section(nodes, faces):
    """Of several contact boundaries the one with the most nodes in contact: its nodes,
    its faces, and its section. A map shows one surface; if there is but one, there is
    nothing to choose."""
    if "section" not in nodes:
        return nodes, faces, None
    sections, counts = np.unique(
        np.concatenate([nodes["section"], nodes["section"][nodes["state"] > 0]]),
        return_counts=True)
    section = int(sections[np.argmax(counts)])
    unit = 1e-9 * max(np.ptp(faces.points), 1e-300)

    def keys(points):
        return [tuple(key) for key in np.round(points / unit).astype(np.int64)]

    of_place = dict(zip(keys(nodes["point"]), nodes["section"]))
    # Hanging nodes are no contact nodes, but not all corners of a face hang.
    at = np.array([of_place.get(key, 0) for key in keys(faces.points)])
    own = (at[faces.cells] == section).any(axis=1)
    kept, cells = np.unique(faces.cells[own], return_inverse=True)
    faces = Mesh(faces.points[kept], cells.reshape(-1, faces.cells.shape[1]),
                 {name: values[kept] for name, values in faces.of_points.items()},
                 {name: values[own] for name, values in faces.of_cells.items()})
    inside = nodes["section"] == section
    return {name: values[inside] for name, values in nodes.items()}, faces, section


def draw_maps(part, run, nodes, faces):
    """Unrolled: pressure, tangential stress, states."""
    nodes, faces, section = of_one_section(nodes, faces)
    if section is not None:
        name = "Contact" if section == 1 else f"Contact {section}"
        part.suptitle(f"'{name}', one of several contact boundaries", fontsize=9)
    chart = boundary.Chart(nodes["point"], nodes["normal"], up=np.array([0., 1., 0.]))
    place = chart.place(nodes["point"])
    window = boundary.zone(place, nodes["state"], 0.12)
    everything = np.stack([place.min(axis=0), place.max(axis=0)])
    window = np.stack([np.maximum(window[0], everything[0]),
                       np.minimum(window[1], everything[1])])
    points = chart.place(faces.points)
    corners = points[faces.cells]
    inside = ((corners.max(axis=1) >= window[0])
              & (corners.min(axis=1) <= window[1])).all(axis=1)
    # Unrolled, nothing reaches from one end to the other.
    inside &= (np.ptp(corners, axis=1) < 0.5 * np.ptp(points, axis=0) + 1e-300).all(
        axis=1) | (len(corners) < 16)
    cells = faces.cells[inside]

    size = window[1] - window[0]
    # Long and narrow zones lie side by side, wide ones are drawn to scale.
    swap = size[1] < size[0]
    order = [0, 1] if swap or size[0] == size[1] else [1, 0]
    turned = points[:, [1, 0]] if order == [1, 0] else points
    window = window[:, order]
    names = [chart.names[i] for i in order]
    size = window[1] - window[0]
    equal = 0.2 < size[1] / max(size[0], 1e-300) < 5
    tangential = np.linalg.norm(faces.of_points["tangential_traction"], axis=1)
    pressure = np.maximum(faces.of_points["pressure"], 0)

    panels = part.subplots(1, 3, sharex=True, sharey=True, squeeze=False)[0]
    triangles = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    stress = run.unit("levels/max_pressure")
    unit = f" [{stress}]" if stress else ""
    for axes, values, name in ((panels[0], pressure, "pressure"),
                               (panels[1], tangential, "tangential stress")):
        here = values[np.unique(cells)] if len(cells) else np.zeros(1)
        # What is but rounding is nothing.
        norm = Normalize(0, max(here.max(), 1e-6 * pressure.max(), 1e-300))
        picture = axes.tripcolor(turned[:, 0], turned[:, 1], triangles, values,
                                 shading="gouraud", norm=norm, cmap=STRESS,
                                 rasterized=True)
        bar = part.colorbar(picture, ax=axes, location="bottom", shrink=0.9,
                            aspect=30, ticks=MaxNLocator(4))
        bar.outline.set_visible(False)
        bar.ax.tick_params(labelsize=8)
        axes.set_title(name + unit)
    draw_arrows(panels[1], chart, nodes, order, window)

    states = np.round(faces.of_points["state"][cells]).max(axis=1)
    phases = panels[2].tripcolor(
        turned[:, 0], turned[:, 1], triangles, np.concatenate([states, states]),
        cmap=ListedColormap(list(PHASES)), norm=Normalize(-0.5, 2.5), rasterized=True)
    bar = part.colorbar(phases, ax=panels[2], location="bottom", shrink=0.9, aspect=30,
                        ticks=[0, 1, 2])
    bar.ax.set_xticklabels(PHASE_NAMES)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=8, length=0)
    panels[2].set_title("states")
    for axes in panels:
        body.draw_edges(axes, turned, cells)
        axes.set_xlim(*window[:, 0])
        axes.set_ylim(*window[:, 1])
        if equal:
            axes.set_aspect("equal")
        axes.tick_params(labelsize=8)
        axes.xaxis.set_major_locator(MaxNLocator(4))
        axes.set_xlabel(run.axis(names[0], "contact/gap"), fontsize=9)
    panels[0].set_ylabel(run.axis(names[1], "contact/gap"), fontsize=9)


def draw_arrows(axes, chart, nodes, order, window):
    """Directions of the tangential stress of some nodes in contact, spread over the
    map."""
    place = chart.place(nodes["point"])[:, order]
    pressure, tangential = boundary.tractions(nodes)
    arrows = chart.components(nodes["normal"], tangential)[:, order]
    size = np.linalg.norm(arrows, axis=1)
    useful = ((nodes["state"] > 0)
              & (size > max(1e-3 * size.max(), 1e-6 * pressure.max()))
              & ((place >= window[0]) & (place <= window[1])).all(axis=1))
    where = np.flatnonzero(useful)
    if len(where) == 0:
        return
    # One per field of a grid.
    grid = np.floor((place[where] - window[0]) / (window[1] - window[0])
                    * 14).astype(int)
    _, chosen = np.unique(grid, axis=0, return_index=True)
    where = where[chosen]
    axes.quiver(place[where, 0], place[where, 1], *(arrows[where] / size[where, None]).T,
                angles="uv", pivot="mid", scale=22, width=0.006, color="k")


# How the solution was found.

def draw_convergence(part, run):
    residuals, cycles, counts = part.subplots(1, 3)
    colours = plt.get_cmap("viridis_r")
    levels = run.levels["level"]
    numbers = run.cycles["level"]
    for i, level in enumerate(levels):
        values = run.cycles["residual"][numbers == level]
        shade = colours(0.1 + 0.9 * i / max(len(levels) - 1, 1))
        label = (f"level {level}" if i in (0, len(levels) - 1) else None)
        positive = values > 0
        residuals.semilogy(np.arange(1, len(values) + 1)[positive], values[positive],
                           color=shade, linewidth=1, marker=".", markersize=3,
                           label=label)
    residuals.set_xlabel("cycle")
    residuals.set_title(run.axis("residual", "cycles/residual"))
    residuals.legend(fontsize=8, handlelength=1)
    cycles.bar(levels, run.levels["cycles"], color=BLUE, width=0.7)
    several = run.levels["outer_iterations"].max() > 1
    cycles.set_title("cycles" + (" of all outer iterations" if several else ""))
    cycles.set_xlabel("level")
    for name, label, colour, marker in (("dofs", "degrees of freedom", GREY, "o"),
                                        ("contact_nodes", "nodes in contact", GREEN, "s"),
                                        ("sticky_nodes", "sticking", BLUE, "^")):
        values = run.levels[name]
        counts.semilogy(levels[values > 0], values[values > 0], color=colour,
                        marker=marker, markersize=4, label=label, linewidth=1.2)
    counts.set_xlabel("level")
    counts.set_title("how many")
    counts.legend(fontsize=8, handlelength=1.4)
    for axes in (cycles, counts, residuals):
        axes.xaxis.set_major_locator(MaxNLocator(nbins=6, integer=True))
        axes.tick_params(labelsize=8)
