"""What is found, and whether it is too much."""

import numpy as np

# Relative difference of what should be the same but for rounding.
ROUNDING = 1e-9

# What is looked at, in the order of the table.
COLUMNS = ("equilibrium", "penetration", "tension", "cone", "slip", "states", "given",
           "energy")


class Verdict:
    """The largest violation per column, and sentences about those above their limit."""

    def __init__(self):
        self.largest = dict.fromkeys(COLUMNS, 0.)
        self.complaints = []

        # The certificate, as the run would have had to report it.
        self.certificate = 0.

    def check(self, column, violations, limit, sentence, places=None):
        """violations: relative ones, nonnegative, one or many; NaN counts as too large.
        places: where they are, as points."""
        violations = np.atleast_1d(np.asarray(violations, float))
        if violations.size == 0:
            return
        violations = np.where(np.isfinite(violations), violations, np.inf)
        worst = int(np.argmax(violations))
        value = violations.flat[worst]
        if column in self.largest:
            self.largest[column] = max(self.largest[column], value)
        if value > limit:
            where = ""
            if places is not None:
                place = places[worst // (violations.size // len(places))]
                where = " at (" + ", ".join(f"{x:.6g}" for x in place) + ")"
            self.complaints.append(
                f"{sentence}{where}: {value:.1e}, and may be {limit:.0e}")

    def demand(self, is_true, sentence, column="given"):
        if not is_true:
            self.largest[column] = np.inf
            self.complaints.append(sentence)


def relative(a, b, least=0.):
    """The largest difference of two arrays, relative to their largest number, which
    counts as no less than least."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.shape != b.shape:
        return np.inf
    size = max(np.abs(a).max(initial=least), np.abs(b).max(initial=least))
    return np.abs(a - b).max(initial=0) / size if size > 0 else 0.
