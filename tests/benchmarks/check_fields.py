#!/usr/bin/env python3
"""That the fields of stability maps are judged as their page says: iterations, help
and seconds each make amber of green, a problem that is not solved is red, and a map
whose data have no seconds is judged without them.

    check_fields.py CHARTS

CHARTS is the folder doc/charts."""

import csv
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, sys.argv[1])
import map_fields  # noqa: E402

# Solver, problem, solved, iterations, attempts, unknowns, seconds; and what has to
# come of it with the time and without.
ROWS = (
    (("default", "easy", "yes", 10, 1, 100, 1e-3), "green", "green"),
    (("default", "at the limits", "yes", 25, 1, 200, 5.9e-3), "green", "green"),
    (("default", "slow", "yes", 26, 1, 100, 1e-3), "amber", "amber"),
    (("default", "helped", "yes", 20, 2, 100, 1e-3), "amber", "amber"),
    (("default", "late", "yes", 20, 1, 100, 3.1e-3), "amber", "green"),
    (("default", "failed", "no", 10, 1, 100, 1e-3), "red", "red"),
    (("default", "without a number", "yes", "", 1, 100, 1e-3), "amber", "amber"),
    # Steps of Newton's method are fewer, and its own easy problem is the measure.
    (("newton direct", "easy", "yes", 3, 1, 100, 1e-2), "green", "green"),
    (("newton direct", "at the limits", "yes", 21, 1, 200, 1e-2), "amber", "amber"),
    (("newton direct", "slow", "yes", 20, 1, 100, 2.9e-2), "green", "green"),
    (("newton direct", "late", "yes", 20, 1, 100, 1e-4), "green", "green"),
    # Its own easy problem is easier than that of the default.
    (("algorithm 2", "easy", "yes", 3, 1, 100, 1e-4), "green", "green"),
    (("algorithm 2", "helped", "yes", 20, 1, 100, 1e-3), "amber", "green"),
    # Without a solution of the easy problem, that of the default is.
    (("newton gmres", "easy", "no", 60, 1, 100, 1e-4), "red", "red"),
    (("newton gmres", "slow", "yes", 3, 1, 100, 3.1e-3), "amber", "green"),
    (("newton gmres", "failed", "yes", 3, 1, 100, 2.9e-3), "green", "green"))


def write(path, with_seconds):
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(map_fields.COLUMNS)
        for row, _, _ in ROWS:
            solver, problem, solved, iterations, attempts, dofs, seconds = row
            writer.writerow(["a map", "problem", problem, "size", "small", solver,
                             "easy", solved, iterations, attempts,
                             *((dofs, seconds) if with_seconds else ("", "")), ""])


def main():
    errors = []
    with tempfile.TemporaryDirectory() as folder:
        for with_seconds in (True, False):
            path = Path(folder) / "stability-test.csv"
            write(path, with_seconds)
            fields = map_fields.Fields(path)
            for row, timed, untimed in ROWS:
                wanted = timed if with_seconds else untimed
                found = fields.fields[row[0], row[1], "small"].status
                if found != wanted:
                    errors.append(f"{row[0]}, {row[1]}: {found} and not {wanted}, "
                                  f"{'with' if with_seconds else 'without'} seconds")
            behind = {(field.problem, tuple(other.solver for other in others))
                      for field, others in fields.behind()}
            wanted = ({("slow", ("newton direct",)), ("late", ("newton direct",)),
                       ("failed", ("newton gmres",))} if with_seconds else
                      {("slow", ("newton direct", "newton gmres")),
                       ("helped", ("algorithm 2",)),
                       ("failed", ("newton gmres",))})
            if behind != wanted:
                errors.append(f"the default is behind in {behind}, not in {wanted}")
            # Only on 'late' is the solver that is green quicker as well.
            slower = [field.problem for field, others in fields.behind()
                      if map_fields.is_slower(field, others)]
            if slower != (["late"] if with_seconds else []):
                errors.append(f"the default is slower in {slower}")
            # Measured by the easy problem of the default, newton direct is late
            # on 'slow', too, and algorithm 2 is not late on 'helped'.
            one_clock = [field.problem
                         for field, _ in fields.behind(one_clock=True)]
            if one_clock != (["helped", "late", "failed"] if with_seconds
                             else ["slow", "helped", "failed"]):
                errors.append(f"by one clock it is behind in {one_clock}")
    print("\n".join(errors) or "OK")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
