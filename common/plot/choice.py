"""What is to be drawn of a run."""

PANELS = ("body", "contact", "convergence")


class Choice:
    """The level (or None for the last one), panels (some of PANELS), the field that
    colours the body, the range of its scale (or None), and the factor of
    displacements."""

    def __init__(self, level=None, panels=PANELS, field="von_Mises_stress",
                 scale=None, warp=1.):
        self.level, self.panels, self.field = level, panels, field
        self.scale, self.warp = scale, warp
