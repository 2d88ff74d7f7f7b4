"""Compares what a page shows with what a command printed."""

import re

# Of the columns of a table of levels; all others are compared as they are.
TOLERANCES = {"rate": (0.02, 0.0), "energy": (0.0, 2e-5)}
NOT_COMPARED = {"seconds"}
# Of numbers in other lines, among them residuals that are but rounding errors.
RELATIVE, ABSOLUTE = 2e-5, 1e-9
GAP = "..."
# Printed in between where something takes long, as on a busy machine.
PROGRESS = re.compile(r" *level \d+: cycle \d+, increment ")
# What a run ends with; a page need not show it.
QUANTITIES = re.compile(r"Peak pressure p = ")
# Nor can it show how long the run took.
TIME = re.compile(r"Time of the run: ")


class Comparison:
    """Lines '...' stand for any lines. A shortened run has fewer levels: rows of
    others are not compared, but one row at least has to be."""

    def __init__(self, shown, printed, shortened):
        self.shown = [(number, line) for number, line in shown if line.strip()]
        self.printed = [line for line in printed.splitlines()
                        if line.strip() and not PROGRESS.match(line)
                        and not TIME.match(line)]
        if not any(QUANTITIES.match(line) for _, line in self.shown):
            self.printed = [line for line in self.printed
                            if not QUANTITIES.match(line)]
        self.shortened = shortened
        self.offences = []       # (line of the page, sentence)
        self.last_shown = False  # whether the last line printed has been shown
        levels = [int(line.split()[0]) for line in self.printed if is_row(line)]
        self.last_level = max(levels, default=-1)
        self._compare()

    def _compare(self):
        position, gap, rows, compared = 0, False, 0, 0
        # The page need not show the names of columns.
        columns = next((line.split() for line in self.printed
                        if line.split()[0] == "level"), [])
        for number, line in self.shown:
            if line.strip() == GAP:
                gap = True
                continue
            row = is_row(line)
            rows += row
            if row and self.shortened and int(line.split()[0]) > self.last_level:
                gap = True
                continue
            found = self._find(line, position, gap, columns)
            if found is None:
                here = (self.printed[position] if position < len(self.printed)
                        else "nothing")
                if gap and row:
                    here = next((one for one in self.printed[position:]
                                 if is_row(one)
                                 and one.split()[0] == line.split()[0]), here)
                self.offences.append((number, "the page shows\n  " + line
                                      + "\nand printed was\n  " + here))
                # One difference is one offence.
                found = position if not gap else position - 1
                if gap and row and here in self.printed:
                    found = self.printed.index(here)
            compared += row
            position, gap = found + 1, False
        if rows and not compared:
            self.offences.append((self.shown[0][0], "the run has been shortened "
                                  "so much that no row can be compared"))
        if position < len(self.printed) and not gap and not self.shortened:
            if not self.offences:
                self.offences.append((
                    self.shown[-1][0], "the page does not show what comes next "
                    f"(a line '{GAP}' would do):\n  " + self.printed[position]))
        if not self.offences and not any(
                line.strip() != GAP and line.split()[0] != "level"
                for _, line in self.shown):
            self.offences.append((self.shown[0][0] if self.shown else 0,
                                  "nothing is shown that could be compared"))
        self.last_shown = position >= len(self.printed) and not gap

    def _find(self, line, position, gap, columns):
        last = len(self.printed) if gap else min(position + 1, len(self.printed))
        for i in range(position, last):
            if same(line, self.printed[i], columns):
                return i
        return None


def is_row(line):
    words = line.split()
    return len(words) >= 8 and all(
        re.fullmatch(r"\d+" if i < 7 else r"-?[\d.]+(e[+-]\d+)?", word)
        for i, word in enumerate(words))


def same(shown, printed, columns):
    a, b = shown.split(), printed.split()
    if len(a) != len(b):
        return False
    if is_row(shown) and is_row(printed) and len(columns) == len(a):
        return all(column in NOT_COMPARED
                   or (one == other if column not in TOLERANCES else
                       close(one, other, *TOLERANCES[column]))
                   for column, one, other in zip(columns, a, b))
    if a[0] == "level" or is_row(shown):
        return a == b
    return all(one == other or close(one, other, ABSOLUTE, RELATIVE)
               for one, other in zip(a, b))


def close(one, other, absolute, relative):
    """Of numbers with a fraction; others are words, equal or not."""
    number = r"-?\d*\.\d+(e[+-]\d+)?|-?\d+e[+-]\d+"
    one, other = one.strip(",;:()").rstrip("."), other.strip(",;:()").rstrip(".")
    if not re.fullmatch(number, one) or not re.fullmatch(number, other):
        return False
    one, other = float(one), float(other)
    # Half a unit of the last digit shown is not more than this allows.
    return abs(one - other) <= absolute + relative * max(abs(one), abs(other))
