"""What all charts have in common: how data are read, lines labelled, slopes
marked, and files written. Palette and style are those of the figures."""

import csv
import sys
import textwrap
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "common" / "plot"))
from drawing import (BLUE, GREEN, GREY, ORANGE, PINK, RED, SKY,  # noqa: E402
                     plt)

# Letters become paths, which look the same everywhere, and nothing in a file
# depends on when it was written: equal data give equal files.
plt.rcParams.update({"svg.hashsalt": "charts", "svg.fonttype": "path",
                     "font.size": 9, "axes.titlesize": 9, "axes.labelsize": 9,
                     "xtick.labelsize": 8, "ytick.labelsize": 8,
                     "lines.linewidth": 1.4, "lines.markersize": 4.5})

# Colour, marker and line of each solver. Marker and line alone tell them apart.
SOLVERS = {"algorithm 3": (BLUE, "o", "-"),
           "algorithm 3 W": (SKY, "^", "-"),
           "algorithm 3 monotone": (GREEN, "s", "-"),
           "algorithm 3 monotone W": (GREEN, "D", "--"),
           "algorithm 2": (PINK, "v", "-"),
           "newton direct": (RED, "X", "-"),
           "newton gmres": (ORANGE, "P", "-"),
           "gauss-seidel": ("k", "*", ":"),
           "linear multigrid": (GREY, "o", "--"),
           "linear cg+ml": (GREY, "s", ":"),
           "linear direct": (GREY, "X", "-.")}


def solver_style(name):
    """Of solvers that have none, by their family."""
    if name in SOLVERS:
        return SOLVERS[name]
    family = next((style for known, style in SOLVERS.items()
                   if known.split()[0] == name.split()[0]), ("k", "o", "-"))
    return (family[0], "h", ":")


class DataError(Exception):
    """Data that cannot be drawn: said in one sentence, and no picture is made."""


class Table:
    """A file of comma separated values: `columns` by name, as numbers where all
    values are numbers, and what the lines that begin with # say."""

    def __init__(self, path, needed):
        self.path = Path(path)
        if not self.path.is_file():
            raise DataError(f"{self.path}: there is no such file.")
        lines = self.path.read_text().splitlines()
        self.remarks = {}
        for line in lines:
            if line.startswith("#"):
                for word in line[1:].split():
                    name, equals, value = word.partition("=")
                    if equals:
                        self.remarks[name] = value
        rows = list(csv.reader(line for line in lines
                               if line and not line.startswith("#")))
        if len(rows) < 2:
            raise DataError(f"{self.path}: there are no data.")
        header, rows = rows[0], rows[1:]
        missing = [name for name in needed if name not in header]
        if missing:
            raise DataError(f"{self.path}: no column {missing[0]}.")
        if any(len(row) != len(header) for row in rows):
            raise DataError(f"{self.path}: a row is incomplete.")
        self.columns = {}
        for name, values in zip(header, zip(*rows)):
            try:
                self.columns[name] = np.array([float(value) for value in values])
            except ValueError:
                self.columns[name] = np.array(values)
                continue
            if not np.all(np.isfinite(self.columns[name])):
                raise DataError(f"{self.path}: the column {name} has a value "
                                "that is not a number.")

    def __getitem__(self, name):
        return self.columns[name]

    def remark(self, name):
        if name not in self.remarks:
            raise DataError(f"{self.path}: no line says {name}=...")
        value = float(self.remarks[name])
        if not np.isfinite(value):
            raise DataError(f"{self.path}: {name} is not a number.")
        return value


def exponent(x, y):
    """The slope of log y over log x, fitted to the upper half of the x, to three
    points at least."""
    order = np.argsort(x)
    half = order[-max(3, (len(order) + 1) // 2):]
    if len(half) < 2:
        return None
    return np.polyfit(np.log(x[half]), np.log(y[half]), 1)[0]


def crossing(x, y, value):
    """Where the line through the points comes down to the value for the first
    time, between points on double logarithmic paper; None if it does not."""
    order = np.argsort(x)
    x, y = np.log(x[order]), np.log(y[order])
    value = np.log(value)
    for i in range(len(x)):
        if y[i] <= value:
            if i == 0:
                return np.exp(x[0])
            part = (y[i - 1] - value) / (y[i - 1] - y[i])
            return np.exp(x[i - 1] + part * (x[i] - x[i - 1]))
    return None


def slope_triangle(axes, x, y, color, above):
    """A small triangle at a falling line, above or below the middle of its upper
    half, whose long side has the fitted slope; the slope is written beside it."""
    slope = exponent(x, y)
    if slope is None or slope >= 0:
        return
    order = np.argsort(x)
    x, y = x[order], y[order]
    span = np.log10(x[-1] / x[0])
    middle = np.log10(x[-1]) - 0.25 * span
    width = 0.13 * span
    height = np.interp(middle, np.log10(x), np.log10(y))
    left, right = 10 ** (middle - width / 2), 10 ** (middle + width / 2)
    shift = 0.09 * np.log10(axes.get_ylim()[1] / axes.get_ylim()[0])
    top = 10 ** (height - slope * width / 2 + (shift if above else -shift))
    bottom = 10 ** (height + slope * width / 2 + (shift if above else -shift))
    corner = (right, top) if above else (left, bottom)
    axes.fill(*zip((left, top), (right, bottom), corner), facecolor="none",
              edgecolor=color, linewidth=0.8)
    axes.annotate(f"{-slope:.2f}", (corner[0], np.sqrt(top * bottom)),
                  xytext=(3 if above else -3, 0), textcoords="offset points",
                  ha="left" if above else "right", va="center", color=color,
                  fontsize=7)


def labels_at_right(axes, ends, size=8, header=False):
    """Names at the right of the axes at the heights of the ends of lines, moved
    apart where they would collide, and away from a header at the top if there is
    one. `ends` has rows (value, name, colour)."""
    box = axes.get_window_extent()
    pixels = axes.figure.dpi / 72
    step = 1.3 * size * pixels
    rows = sorted((axes.transData.transform((axes.get_xlim()[0], value))[1],
                   name, color) for value, name, color in ends)
    if not rows:
        return
    places = [row[0] for row in rows]
    # Push up from below, then down again from the top, so that all stay inside.
    for i in range(1, len(places)):
        places[i] = max(places[i], places[i - 1] + step)
    top = box.y1 - (1.3 * step if header else 0)
    places[-1] = min(places[-1], max(top, box.y0 + (len(rows) - 1) * step))
    for i in range(len(places) - 2, -1, -1):
        places[i] = min(places[i], places[i + 1] - step)
    for place, (end, name, color) in zip(places, rows):
        axes.annotate(name, (1, (end - box.y0) / box.height),
                      xycoords="axes fraction",
                      xytext=(16, (place - end) / pixels),
                      textcoords="offset points", color=color, fontsize=size,
                      va="center", annotation_clip=False,
                      arrowprops={"arrowstyle": "-", "color": color,
                                  "linewidth": 0.5, "shrinkA": 1, "shrinkB": 3,
                                  "relpos": (0, 0.5)})


def headline(figure, text, subject, width=None):
    """The message of a chart, at its top left, and below it what is shown. Returns
    how much of the height is left for the axes, in inches from below."""
    width = width or int(figure.get_figwidth() * 11)
    height = figure.get_figheight()
    place = height - 0.07
    for words, size, weight, color, step, columns in (
            (text, 10.5, "bold", "k", 0.185, width),
            (subject, 8.5, "normal", "0.3", 0.15, int(1.45 * width))):
        lines = textwrap.wrap(words, columns)
        figure.text(0.012, place / height, "\n".join(lines), va="top",
                    fontsize=size, fontweight=weight, color=color,
                    linespacing=1.2)
        place -= step * len(lines) + 0.06
    return place


def axes_below(figure, top, titles=0.0):
    """Leaves the axes what a headline has left, but for titles of their own."""
    figure.subplots_adjust(top=(top - titles) / figure.get_figheight())


def times(ratio):
    """A factor as a reader would say it."""
    return f"{ratio:.1f}" if ratio < 9.95 else f"{ratio:.0f}"


def save(figure, output, name):
    path = Path(output) / name
    figure.savefig(path, format="svg", metadata={"Date": None, "Creator": None})
    plt.close(figure)
    print(f"  {path}", flush=True)


def grid(axes):
    axes.grid(True, which="major", color="0.92", linewidth=0.7)
    axes.set_axisbelow(True)
