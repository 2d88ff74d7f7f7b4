#!/usr/bin/env python3
"""What the fields of the stability maps say: green where a solver solved the
problem in few iterations, at the first attempt, and in about the time that an easy problem
takes; amber where it took more; red where it did not.

    map_fields.py DATA [--list] [MAP ...]

counts them in all maps, and in how many fields the default is not green while
another solver is ('behind'), in how many of these one that is green took less time
('slower'), and in how many fields the default is not green while another solver would
be if the easy problem's time that the default takes were the measure for all ('one
clock'); with --list also says which those behind are. The data of a map have what was measured and no
judgement, which is made here, with the limits of runs.py."""

import argparse
import csv
import sys
from pathlib import Path

import runs

COLUMNS = ("map", "problem_axis", "problem", "size_axis", "size", "solver",
           "easy", "solved", "iterations", "attempts", "dofs", "seconds", "note")


class FieldError(Exception):
    """Data that are not those of a map."""


class Field:
    """One solver, one problem, one mesh. `slow`, `helped` and `late` are the
    reasons why it is not green although it was solved: iterations, safeguards,
    seconds."""

    def __init__(self, row):
        self.solver, self.problem, self.size = (
            row["solver"], row["problem"], row["size"])
        self.easy, self.note = row["easy"], row["note"]
        self.solved = row["solved"] == "yes"
        self.iterations = int(row["iterations"]) if row["iterations"] else None
        self.dofs = int(row["dofs"]) if row["dofs"] else None
        self.seconds = float(row["seconds"]) if row["seconds"] else None
        good = (runs.GOOD_STEPS if self.solver.startswith("newton") else
                runs.GOOD_CYCLES)
        self.helped = int(row["attempts"] or 1) > 1
        self.slow = self.iterations is None or self.iterations > good
        self.late = False

    @property
    def pace(self):
        """Seconds per unknown."""
        return None if self.seconds is None else self.seconds / self.dofs

    @property
    def status(self):
        return self.status_if(self.late)

    def status_if(self, late):
        if not self.solved:
            return "red"
        return "amber" if self.helped or self.slow or late else "green"

    def is_late(self, easy_pace):
        return (None not in (easy_pace, self.pace) and
                self.pace > runs.GOOD_RATIO * easy_pace)


class Fields:
    """A map, from its file."""

    def __init__(self, path):
        with open(path, newline="") as file:
            rows = list(csv.DictReader(line for line in file
                                       if not line.startswith("#")))
        if not rows:
            raise FieldError(f"{path}: there are no data.")
        missing = [name for name in COLUMNS if name not in rows[0]]
        if missing:
            raise FieldError(f"{path}: no column {missing[0]}.")
        for name in ("map", "problem_axis", "size_axis"):
            if len({row[name] for row in rows}) != 1:
                raise FieldError(f"{path}: more than one {name}.")
        self.subject = rows[0]["map"]
        self.problem_axis = rows[0]["problem_axis"]
        self.size_axis = rows[0]["size_axis"]
        # Names keep the order in which they come, even if they look like numbers.
        self.problems, self.sizes, self.solvers = (
            list(dict.fromkeys(row[name] for row in rows))
            for name in ("problem", "size", "solver"))
        self.fields = {}
        for row in rows:
            key = row["solver"], row["problem"], row["size"]
            if key in self.fields:
                raise FieldError(f"{path}: {key} is there twice.")
            self.fields[key] = Field(row)
        for field in self.fields.values():
            field.late = field.is_late(self.easy_pace(field))

    def easy_pace(self, field):
        """That of the same solver on the easy problem, of the default if it does
        not solve it, and None if nothing is known."""
        for solver in (field.solver, self.solvers[0]):
            easy = self.fields.get((solver, field.easy, field.size))
            if easy and easy.solved and easy.pace is not None:
                return easy.pace
        return None

    @property
    def has_seconds(self):
        return any(field.seconds is not None for field in self.fields.values())

    def easy_names(self):
        """The easy problems, for a sentence."""
        names = list(dict.fromkeys(field.easy for field in self.fields.values()))
        return " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))

    def count(self, solver, *statuses):
        return sum(field.status in statuses for field in self.fields.values()
                   if field.solver == solver)

    def behind(self, one_clock=False):
        """Fields of the first solver that are not green while those of others
        are, and these. With one clock others are in time if they are compared
        with the easy problem of the first solver, and not with their own."""
        result = []
        for field in self.fields.values():
            if field.solver == self.solvers[0] and field.status != "green":
                easy = self.easy_pace(field)
                others = [self.fields.get((solver, field.problem, field.size))
                          for solver in self.solvers[1:]]
                better = [other for other in others
                          if other and other.status_if(
                              other.is_late(easy) if one_clock else other.late)
                          == "green"]
                if better:
                    result.append((field, better))
        return result


def seconds_as_text(seconds):
    if seconds >= 0.995:
        return f"{seconds:.0f} s" if seconds >= 9.95 else f"{seconds:.1f} s"
    milliseconds = 1e3 * seconds
    return (f"{milliseconds:.0f} ms" if milliseconds >= 9.95
            else f"{milliseconds:.1f} ms")


def name_and_time(field):
    return field.solver + ("" if field.seconds is None else
                           f" ({seconds_as_text(field.seconds)})")


def is_slower(field, others):
    return any(None not in (field.seconds, other.seconds) and
               other.seconds < field.seconds for other in others)


def describe(field):
    """Why a field is not green, in some words."""
    if not field.solved:
        return field.note or "not solved"
    words = ([] if field.iterations is None else
             [f"{field.iterations} iterations"])
    if field.seconds is not None:
        words.append(seconds_as_text(field.seconds) +
                     (", too long for its unknowns" if field.late else ""))
    if field.helped:
        words.append(field.note)
    return ", ".join(words)


def line_of_those_behind(counts):
    behind, slower, one_clock = counts[4:]
    return f"{behind:8}{slower:8}{one_clock:11}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("data", type=Path)
    parser.add_argument("maps", nargs="*")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    files = ([options.data / f"stability-{name}.csv" for name in options.maps] or
             sorted(options.data.glob("stability-*.csv")))
    print(f"{'default in the map':20} {'fields':>6} {'green':>6} {'amber':>6} "
          f"{'red':>6}  behind  slower  one clock  seconds")
    total = [0] * 7
    try:
        for path in files:
            fields = Fields(path)
            first, behind = fields.solvers[0], fields.behind()
            counts = [fields.count(first, "green", "amber", "red"),
                      *(fields.count(first, status)
                        for status in ("green", "amber", "red")),
                      len(behind), sum(is_slower(*pair) for pair in behind),
                      len(fields.behind(one_clock=True))]
            total = [a + b for a, b in zip(total, counts)]
            print(f"{path.stem[len('stability-'):]:20} " +
                  " ".join(f"{n:6}" for n in counts[:4]) +
                  line_of_those_behind(counts) + "  " +
                  ("known" if fields.has_seconds else "not known"))
            if options.list:
                for field, better in behind:
                    print(f"    {field.problem}, {fields.size_axis} "
                          f"{field.size}: {describe(field)}; green: "
                          f"{', '.join(map(name_and_time, better))}")
    except (FieldError, OSError) as error:
        sys.exit(str(error))
    print(f"{'all':20} " + " ".join(f"{n:6}" for n in total[:4]) +
          line_of_those_behind(total))


if __name__ == "__main__":
    main()
