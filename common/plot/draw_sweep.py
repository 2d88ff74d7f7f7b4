"""The chart of a sweep over one entry, the map of one over two."""

import textwrap

import numpy as np
from matplotlib.colors import Normalize

from drawing import BLUE, RED, STRESS, plt
from history import quantity


def title_of(example, name):
    if "/" in name:
        return name.replace("_", " ")
    column = "levels/" + name.strip().replace(" ", "_")
    return example.axis(example.label(column), column)


def numbers(values):
    """As numbers, or None if some are none."""
    try:
        return [float(value) for value in values]
    except ValueError:
        return None


def draw_sweep(sweep, table, example, shown):
    """A figure with a panel per quantity, and below the messages of the holes."""
    values = {name: {point: np.nan if row is None else quantity(row, name)
                     for point, row in table.items()} for name in shown}
    holes = [point for point, row in table.items() if row is None]
    width = max(5.4 * min(len(shown), 3), 6.4)
    notes = []
    for i, point in enumerate(holes):
        text = f"{i + 1}: {', '.join(point)}: {sweep.results[point]['message']}"
        notes.append(textwrap.fill(textwrap.shorten(text, 300), int(15 * width)))
    lines = sum(note.count("\n") + 1 for note in notes[:8]) + (len(notes) > 8)
    n_rows = -(-len(shown) // 3)
    heights = [3.9 * n_rows] + ([0.16 * lines + 0.2] if notes else [])
    figure = plt.figure(figsize=(width, sum(heights)), layout="constrained")
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)
    panels = parts[0, 0].subplots(n_rows, min(len(shown), 3), squeeze=False).ravel()
    for axes in panels[len(shown):]:
        axes.axis("off")
    parts[0, 0].suptitle(f"{example.scene}" + "".join(
        f", {entry}" for entry in sweep.entries), fontsize=10)
    for axes, name in zip(panels, shown):
        draw = draw_chart if len(sweep.axes) == 1 else draw_map
        draw(axes, sweep, values[name], holes)
        axes.set_title(title_of(example, name))
    if notes:
        more = [f"and {len(notes) - 8} more, in sweep.csv"] if len(notes) > 8 else []
        parts[1, 0].text(0.02, 0.95, "\n".join(notes[:8] + more), va="top", fontsize=8,
                         color=RED)
    return figure


def draw_chart(axes, sweep, values, holes):
    entry, texts = sweep.axes[0]
    places = numbers(texts)
    if places is None:
        places = list(range(len(texts)))
        axes.set_xticks(places, texts)
    y = np.array([values[(text,)] for text in texts])
    order = np.argsort(places, kind="stable")
    x = np.array(places)[order]
    axes.plot(x, y[order], marker="o", color=BLUE)
    gap = np.min(np.diff(np.sort(places))) if len(places) > 1 else 1.
    for i, point in enumerate(holes):
        at = places[texts.index(point[0])]
        axes.axvspan(at - 0.2 * gap, at + 0.2 * gap, facecolor="none", edgecolor=RED,
                     hatch="///", linewidth=0, alpha=0.5)
        axes.text(at, 0.5, str(i + 1), transform=axes.get_xaxis_transform(),
                  ha="center", va="center", color=RED,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
    axes.set_xlabel(entry)


def draw_map(axes, sweep, values, holes):
    """A field per run, in the order in which values were given."""
    (entry_x, texts_x), (entry_y, texts_y) = sweep.axes
    table = np.array([[values[(x, y)] for x in texts_x] for y in texts_y])
    known = table[np.isfinite(table)]
    norm = Normalize(known.min(), known.max() if np.ptp(known) > 0
                     else known.min() + max(abs(known.min()), 1e-300))
    axes.imshow(np.ma.masked_invalid(table), origin="lower", cmap=STRESS, norm=norm,
                aspect="auto")
    axes.set_xticks(range(len(texts_x)), texts_x)
    axes.set_yticks(range(len(texts_y)), texts_y)
    axes.set_xlabel(entry_x)
    axes.set_ylabel(entry_y)
    axes.tick_params(length=0)
    if table.size <= 100:
        for (j, i), value in np.ndenumerate(table):
            if np.isfinite(value):
                axes.text(i, j, f"{value:.3g}", ha="center", va="center", fontsize=8,
                          color="white" if norm(value) > 0.5 else "black")
    else:
        bar = axes.figure.colorbar(axes.images[0], ax=axes)
        bar.outline.set_visible(False)
    for number, (x, y) in enumerate(holes):
        i, j = texts_x.index(x), texts_y.index(y)
        axes.add_patch(plt.Rectangle((i - 0.5, j - 0.5), 1, 1, facecolor="none",
                                     edgecolor=RED, hatch="///", linewidth=0))
        axes.text(i, j, str(number + 1), ha="center", va="center", color=RED,
                  bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
