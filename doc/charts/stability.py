"""Chart 5: which solver solves which problem, in maps: green where all is well,
amber where it took more than it should or needed help, red where it failed."""

import textwrap

import numpy as np
from matplotlib.patches import Rectangle

import runs
from chart import DataError, headline, plt, save
from map_fields import FieldError, Fields, seconds_as_text

# Light enough for black figures on them; the grey values differ as well, and so
# do hatch and symbol.
STATUS = {"green": ("#9AD9C3", "", "solved"),
          "amber": ("#F5D384", "...", "solved, slowly (~) or with help (+)"),
          "red": ("#D9825B", "xxxx", "not solved")}
SYMBOLS = {"green": "", "amber": "~", "red": "\u00d7"}


def message(fields):
    def result(solver):
        return (f"{fields.count(solver, 'green')} and "
                f"{fields.count(solver, 'green', 'amber')}")

    first, *others = fields.solvers
    total = fields.count(first, *STATUS)
    text = (f"{first} is green in {fields.count(first, 'green')} of {total} fields "
            f"and solves {fields.count(first, 'green', 'amber')}")
    if others:
        text += " (" + ", ".join(f"{solver}: {result(solver)}"
                                 for solver in others) + ")"
    return text[0].upper() + text[1:]


def below_the_message(fields):
    if not fields.has_seconds:
        return (f"Map: {fields.subject}. Numbers are iterations; slow is what takes "
                f"more than {runs.GOOD_CYCLES} cycles or {runs.GOOD_STEPS} steps of "
                "Newton's method. Seconds were not kept when this was measured.")
    return (f"Map: {fields.subject}. Numbers are iterations and the time with "
            "set-up; slow is what takes more than "
            f"{runs.GOOD_CYCLES} cycles or {runs.GOOD_STEPS} steps of Newton's "
            f"method, or {runs.GOOD_RATIO:g} times the time per unknown that the "
            f"same solver takes in the row {fields.easy_names()}.")


def draw(path, output):
    try:
        fields = Fields(path)
    except (FieldError, OSError) as error:
        raise DataError(str(error)) from error
    problems, sizes, solvers = fields.problems, fields.sizes, fields.solvers

    # Panels side by side, as many as fit into the width of a page.
    longest = max(len(problem) for problem in problems)
    margin = max(0.35 + 0.068 * longest,
                 0.2 + 0.06 * len(fields.problem_axis))
    # The name of a solver must fit above its panel.
    name_width = 0.066 * max(map(len, solvers))
    cell_width = max(0.45, name_width / len(sizes))
    cell_height = 0.33 if fields.has_seconds else 0.26
    panel_width = cell_width * len(sizes) + 0.16
    per_row = int(np.clip((7 - margin) // panel_width, 1, len(solvers)))
    cell_width *= min(1.25, (7 - margin - 0.12) / (panel_width * per_row))
    n_rows = -(-len(solvers) // per_row)
    panel_height = cell_height * len(problems)
    subject = below_the_message(fields)
    title_lines = (len(textwrap.wrap(message(fields), 77)) +
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
        axes.set_xlabel(fields.size_axis, fontsize=7.5, labelpad=2)
        if column == 0:
            axes.text(-0.06 / (cell_width * len(sizes)), -0.35,
                      fields.problem_axis,
                      ha="right", va="center", fontsize=7.5, color="0.3")
        for r, problem in enumerate(problems):
            for c, size in enumerate(sizes):
                draw_cell(axes, c, r, fields.fields.get((solver, problem, size)))
    legend(figure, height)
    headline(figure, message(fields), subject)
    name = "stability-" + path.stem.replace("stability-", "") + ".svg"
    save(figure, output, name)


def draw_cell(axes, x, y, field):
    if field is None:
        axes.text(x + 0.5, y + 0.5, "-", ha="center", va="center", color="0.6")
        return
    # The symbol is at the number that is to blame.
    count = "" if field.iterations is None else str(field.iterations)
    if field.status == "red":
        count = SYMBOLS["red"] + (count and " " + count)
    elif field.helped:
        count = "+" + count
    elif field.slow:
        count = SYMBOLS["amber"] + count
    time = "" if field.seconds is None else seconds_as_text(field.seconds)
    if field.solved and field.late:
        time = SYMBOLS["amber"] + time
    paint(axes, x, y, field.status, count, time)


def paint(axes, x, y, status, count, time=""):
    color, hatch, _ = STATUS[status]
    axes.add_patch(Rectangle((x + 0.03, y + 0.05), 0.94, 0.9, facecolor=color,
                             edgecolor="0.35" if hatch else "none",
                             linewidth=0, hatch=hatch or None))
    plt.rcParams["hatch.linewidth"] = 0.35
    box = {"facecolor": color, "edgecolor": "none", "pad": 0.4} if hatch else None
    axes.text(x + 0.5, y + (0.34 if time else 0.53), count, ha="center",
              va="center", fontsize=7, bbox=box)
    if time:
        axes.text(x + 0.5, y + 0.74, time, ha="center", va="center",
                  fontsize=5.5, bbox=box)


def legend(figure, height):
    axes = figure.add_axes([0.02, 0.06 / height, 0.96, 0.26 / height])
    axes.set_xlim(0, 0.96 * 7 / 0.26)
    axes.set_ylim(1, 0)
    axes.axis("off")
    x = 0.4
    for status, (_, _, meaning) in STATUS.items():
        paint(axes, x, 0, status, SYMBOLS[status])
        axes.text(x + 1.25, 0.55, meaning, va="center", fontsize=8)
        x += 2.6 + 0.24 * len(meaning)
