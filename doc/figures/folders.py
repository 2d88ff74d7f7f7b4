#!/usr/bin/env python3
"""Draws which folders of the library use which, from their #include lines:

    folders.py COMMON PICTURE.svg
    folders.py COMMON --check PICTURE.svg

Folders that others build on are at the bottom. Each folder with those it uses is
printed, and is the description in the picture's own data; --check draws nothing, and
compares with that. A circle among folders is an error, and so is a header that does
not exist."""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#include <common/(\w+)/(\w+\.h)>', re.MULTILINE)


def dependencies(common):
    """Folders, and for each of them how many includes go to which others."""
    used = {folder.name: {} for folder in common.iterdir()
            if any(folder.glob("*.h"))}
    problems = []
    for folder in used:
        for file in sorted((common / folder).glob("*.[hc]*")):
            for other, header in INCLUDE.findall(file.read_text()):
                if not (common / other / header).is_file():
                    problems.append(f"{file.name} includes common/{other}/"
                                    f"{header}, which does not exist")
                elif other != folder:
                    used[folder][other] = used[folder].get(other, 0) + 1
    return used, problems


def layers(used):
    """Lists of folders, each of which only uses those of the lists before; None
    if there is a circle."""
    left, result = dict(used), []
    while left:
        layer = sorted(name for name in left
                       if not any(other in left for other in used[name]))
        if not layer:
            return None, sorted(left)
        result.append(layer)
        for name in layer:
            del left[name]
    return result, []


def essential(used):
    """Without the arrows that others imply."""
    def reach(name):
        found = set()
        for other in used[name]:
            found |= {other} | reach(other)
        return found
    return {name: [other for other in used[name]
                   if not any(other in reach(between)
                              for between in used[name] if between != other)]
            for name in used}


def draw(order, arrows, description, picture):
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    matplotlib.rcParams["svg.hashsalt"] = "folders"
    width, height = 1.5, .45
    places = {}
    for row, layer in enumerate(order):
        for column, name in enumerate(layer):
            places[name] = (2. * (column - (len(layer) - 1) / 2), row)
    figure, axes = plt.subplots(figsize=(6.4, .62 * len(order) + .3))
    for name, (x, y) in places.items():
        axes.add_patch(plt.Rectangle((x - width / 2, y - height / 2), width, height,
                                     facecolor="#eef3f8", edgecolor="#30506e"))
        axes.text(x, y, name, ha="center", va="center", fontsize=9)
        for other in arrows[name]:
            to_x, to_y = places[other]
            axes.annotate("", (to_x, to_y + height / 2), (x, y - height / 2),
                          arrowprops={"arrowstyle": "->", "color": "#30506e",
                                      "linewidth": .9})
    axes.set_xlim(-3, 3)
    axes.set_ylim(-.5, len(order) - .5)
    axes.axis("off")
    figure.savefig(picture, bbox_inches="tight", metadata={"Date": None, "Description": description})


def main():
    checks = sys.argv[2:3] == ["--check"]
    if len(sys.argv) != (4 if checks else 3):
        sys.exit(__doc__)
    picture = Path(sys.argv[-1])
    used, problems = dependencies(Path(sys.argv[1]))
    order, circle = layers(used)
    if circle:
        problems.append("a circle among the folders " + ", ".join(circle))
    if problems:
        sys.exit("\n".join(problems))
    description = "; ".join(f"{name}: {', '.join(sorted(used[name])) or 'none'}"
                            for layer in order for name in layer)
    print(description.replace("; ", "\n"))
    if not checks:
        draw(order, essential(used), description, picture)
    elif description not in " ".join(picture.read_text().split()):
        sys.exit(f"{picture} shows an earlier state: make the target folders")


if __name__ == "__main__":
    main()
