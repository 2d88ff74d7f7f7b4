"""Chart 5: which solver solves which problem, in maps: green where all is well,
amber where it took more than it should or needed help, red where it failed."""

import csv
import textwrap

import numpy as np
from matplotlib.patches import Rectangle

from chart import DataError, Table, headline, plt, save

COLUMNS = ("map", "problem_axis", "problem", "size_axis", "size", "solver",
           "status", "iterations", "note")
# Light enough for black figures on them; the grey values differ as well, and so
# do hatch and symbol.
STATUS = {"green": ("#9AD9C3", "", "", "solved"),
          "amber": ("#F5D384", "...", "~", "solved, with help or slowly"),
          "red": ("#D9825B", "xxxx", "\u00d7", "not solved")}


def text_columns(path):
    """All columns as text: problems and sizes are names, even if they look like
    numbers, and keep the order in which they come."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file
                                   if not line.startswith("#")))
    return {name: [row[name] for row in rows] for name in COLUMNS}


def message(columns):
    solvers = list(dict.fromkeys(columns["solver"]))
    total = {solver: 0 for solver in solvers}
    good = dict(total)
    for solver, status in zip(columns["solver"], columns["status"]):
        total[solver] += 1
        good[solver] += status != "red"
    first = solvers[0]
    text = f"{first} solves {good[first]} of {total[first]} cases"
    others = [f"{solver}: {good[solver]}" for solver in solvers[1:]]
    if others:
        text += " (" + ", ".join(others) + ")"
    return text[0].upper() + text[1:]


def draw(path, output):
    Table(path, COLUMNS)
    columns = text_columns(path)
    unknown = set(columns["status"]) - set(STATUS)
    if unknown:
        raise DataError(f"{path}: there is no status '{unknown.pop()}'.")
    for name in ("map", "problem_axis", "size_axis"):
        if len(set(columns[name])) != 1:
            raise DataError(f"{path}: more than one {name}.")
    problems, sizes, solvers = (list(dict.fromkeys(columns[name]))
                                for name in ("problem", "size", "solver"))
    cells = {}
    for row in zip(*(columns[name] for name in COLUMNS)):
        key = (row[5], row[2], row[4])
        if key in cells:
            raise DataError(f"{path}: {key} is there twice.")
        cells[key] = (row[6], row[7])

    # Panels side by side, as many as fit into the width of a page.
    longest = max(len(problem) for problem in problems)
    margin = max(0.35 + 0.068 * longest,
                 0.2 + 0.06 * len(columns["problem_axis"][0]))
    # The name of a solver must fit above its panel.
    name_width = 0.066 * max(map(len, solvers))
    cell_width, cell_height = max(0.42, name_width / len(sizes)), 0.26
    panel_width = cell_width * len(sizes) + 0.16
    per_row = int(np.clip((7 - margin) // panel_width, 1, len(solvers)))
    cell_width *= min(1.25, (7 - margin - 0.12) / (panel_width * per_row))
    n_rows = -(-len(solvers) // per_row)
    panel_height = cell_height * len(problems)
    subject = f"Map: {columns['map'][0]}. Numbers are iterations."
    title_lines = (len(textwrap.wrap(message(columns), 77)) +
                   0.8 * (len(textwrap.wrap(subject, 111)) - 1))
    slanted = max(map(len, sizes)) >= 6
    foot = 0.3 + (0.045 * max(map(len, sizes)) if slanted else 0.08)
    top, below, gap = 0.3 + 0.19 * title_lines, foot + 0.4, foot + 0.25
    height = top + n_rows * panel_height + (n_rows - 1) * gap + below + 0.25
    figure = plt.figure(figsize=(7, height))
    for i, solver in enumerate(solvers):
        row, column = divmod(i, per_row)
        x = margin + column * (cell_width * len(sizes) + 0.16)
        y = height - top - 0.25 - (row + 1) * panel_height - row * gap
        axes = figure.add_axes([x / 7, y / height,
                                cell_width * len(sizes) / 7,
                                panel_height / height])
        axes.set_xlim(0, len(sizes))
        axes.set_ylim(len(problems), 0)
        for spine in axes.spines.values():
            spine.set_visible(False)
        axes.tick_params(length=0)
        axes.set_title(solver, fontsize=8.5, pad=3)
        axes.set_xticks(np.arange(len(sizes)) + 0.5, sizes, fontsize=7,
                        rotation=35 if slanted else 0,
                        ha="right" if slanted else "center")
        axes.set_yticks(np.arange(len(problems)) + 0.5,
                        problems if column == 0 else [""] * len(problems),
                        fontsize=7.5)
        axes.set_xlabel(columns["size_axis"][0], fontsize=7.5, labelpad=2)
        if column == 0:
            axes.text(-0.06 / (cell_width * len(sizes)), -0.35,
                      columns["problem_axis"][0],
                      ha="right", va="center", fontsize=7.5, color="0.3")
        for r, problem in enumerate(problems):
            for c, size in enumerate(sizes):
                draw_cell(axes, c, r, cells.get((solver, problem, size)))
    legend(figure, height)
    headline(figure, message(columns), subject)
    name = "stability-" + path.stem.replace("stability-", "") + ".svg"
    save(figure, output, name)


def draw_cell(axes, x, y, cell):
    if cell is None:
        axes.text(x + 0.5, y + 0.5, "-", ha="center", va="center", color="0.6")
        return
    status, iterations = cell
    color, hatch, symbol, _ = STATUS[status]
    axes.add_patch(Rectangle((x + 0.03, y + 0.05), 0.94, 0.9, facecolor=color,
                             edgecolor="0.35" if hatch else "none",
                             linewidth=0, hatch=hatch or None))
    plt.rcParams["hatch.linewidth"] = 0.35
    text = iterations.strip()
    label = symbol + text if status != "red" else symbol + (text and " " + text)
    axes.text(x + 0.5, y + 0.53, label, ha="center", va="center", fontsize=7,
              bbox={"facecolor": color, "edgecolor": "none", "pad": 0.6}
              if hatch else None)


def legend(figure, height):
    axes = figure.add_axes([0.02, 0.06 / height, 0.96, 0.26 / height])
    axes.set_xlim(0, 0.96 * 7 / 0.26)
    axes.set_ylim(1, 0)
    axes.axis("off")
    x = 0.4
    for status, (_, _, _, meaning) in STATUS.items():
        draw_cell(axes, x, 0, (status, ""))
        axes.text(x + 1.25, 0.55, meaning, va="center", fontsize=8)
        x += 2.6 + 0.24 * len(meaning)
