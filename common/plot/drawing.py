"""What all pictures have in common."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from PIL import Image

from fields import nodal_average  # noqa: F401

# The palette of Okabe and Ito, which colour-blind readers can tell apart.
BLUE, RED, GREEN, ORANGE, SKY, PINK = ("#0072B2", "#D55E00", "#009E73",
                                       "#E69F00", "#56B4E9", "#CC79A7")
GREY = "0.45"

# Nodes of the contact boundary by state: open, sliding, sticking.
PHASES = np.array(["#ededed", ORANGE, BLUE])
PHASE_NAMES = ("open", "slides", "sticks")

# Light where nothing happens, and never so dark that the mesh cannot be seen.
STRESS = LinearSegmentedColormap.from_list(
    "stress", plt.get_cmap("magma_r")(np.linspace(0, 0.8, 256)))

plt.rcParams.update({
    "font.size": 10, "axes.titlesize": 10, "axes.spines.top": False,
    "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.6,
    "figure.dpi": 140, "savefig.facecolor": "white",
})


def save(figure, output, name):
    """PNG without an alpha channel and with a quarter of the shades, which the eye
    cannot tell but which makes the files much smaller; and without the version of the
    library, so that equal pictures are equal files."""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].astype(int)
    pixels = np.minimum((pixels + 2) // 4 * 4, 255).astype(np.uint8)
    Image.fromarray(pixels).save(output / name, optimize=True)
    plt.close(figure)
