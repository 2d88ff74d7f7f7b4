"""Hat functions of a hierarchy of levels, truncated at nodes in contact, whose
phases are those of a small block."""

import numpy as np

from chart import BLUE, GREY, plt
from drawing_of_ideas import mark_phases
from small_block import SmallBlock, hats


def draw(workshop):
    block = SmallBlock()
    u = block.iterate(12)[0][-1]
    cells = block.cells[0]
    x = np.linspace(0, 1, cells + 1)
    free = block.free(u)[2 * block.contact + 1]

    figure, axes = plt.subplots(4, 1, figsize=(5.6, 4.8), sharex=True)
    figure.subplots_adjust(left=0.14, right=0.99, top=0.98, bottom=0.11,
                           hspace=0.25)
    # Between the nodes of the leaf mesh truncated functions are linear, too.
    for row, level in enumerate((3, 2, 1, 0)):
        ax = axes[row]
        basis = hats(cells, cells >> level)
        for function in basis.T:
            truncated = function * free if level > 0 else function
            ax.plot(x, function, color=GREY, linewidth=0.6, linestyle="--"
                    if not truncated.any() else "-")
            if level > 0:
                ax.fill_between(x, 0, truncated, color=BLUE, alpha=0.35,
                                linewidth=0)
        ax.set(yticks=[], ylim=(0, 1.08), xlim=(-0.01, 1.01))
        ax.set_ylabel("leaf" if level == 0 else f"level {3 - level}",
                      rotation=0, ha="right", va="center", fontsize=10)
        ax.tick_params(bottom=False, labelbottom=False)
        for name in ("left", "top", "right"):
            ax.spines[name].set_visible(False)
    mark_phases(axes[-1], block.phases(u), x, np.zeros_like(x), markersize=5,
                clip_on=False, zorder=3)
    axes[-1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncol=3,
                    fontsize=10, handletextpad=0.1)
    workshop.save(figure, "hierarchy")
