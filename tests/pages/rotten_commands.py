#!/usr/bin/env python3
"""Checks that the check of commands can fail: a page in a small repository, whose
commands do not do what it says in one way each. Arguments are those of
check_commands.py but for root, table and page."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SCENE = "step-friction-2d/scenes/hertz.prm"
RUN = f"build/release/bin/step-friction-2d {SCENE}"
HEAD = ("level     cells      dofs  contact   sticky  outer  cycles   rate"
        "        energy   seconds")
ROWS = ["    0        40       102        1        1      1       2  0.000"
        "   1.10625e-05      0.00",
        "    1        58       150        1        1      1       8  0.059"
        "   9.17089e-06      0.00",
        "    2        88       222        3        1      1      10  0.124"
        "   8.46208e-06      0.00"]

FAILING = f"{RUN} 'Solver/Maximum cycles=1' Solver/Safeguards=false"

# Name, comment or none, command, what the page shows, and the words with which an
# offence must begin, or None.
CASES = [
    ("all as printed", "", f"{RUN} Refinement/Levels=2", [HEAD] + ROWS, None),
    ("seconds", "", f"{RUN} Refinement/Levels=1",
     [HEAD, ROWS[0], ROWS[1].replace("0.00", "9.99")], None),
    ("rate within 0.02", "", f"{RUN} Refinement/Levels=1",
     [HEAD, ROWS[0], ROWS[1].replace("0.059", "0.070")], None),
    ("with dots", "", f"{RUN} Refinement/Levels=2", [HEAD, "...", ROWS[2]], None),
    ("seconds without names of columns", "", f"{RUN} Refinement/Levels=1",
     ["...", ROWS[1].replace("0.00", "9.99")], None),
    ("status that is wanted", "exit status: 2", f"{RUN} Refinement/Bevels=2", [], None),
    ("status that is not wanted", "exit status: 2", RUN + " Refinement/Levels=1", [],
     "the command ends with status 0"),
    ("a file that the page writes", "", f"cat > own.prm <<'END'\nnothing\nEND\n"
     f"{RUN} Refinement/Levels=1", [HEAD] + ROWS[:2], None),
    ("shortened", "shortened: Refinement/Levels=1", f"{RUN} Refinement/Levels=2",
     [HEAD] + ROWS, None),
    ("error that is shown", "", FAILING, ["...", "No convergence on level 0 within "
     "1 cycle. Certificate: equilibrium 1.00e-16, penetration 0.00e+00, tension "
     "1.00e-16, complementarity 1.00e-16, friction cone 1.00e-16, slip direction "
     "1.00e-16, state of a node 1.00e-16."], None),
    ("error that is not shown", "", FAILING,
     [HEAD, ROWS[0].replace("   2  0.000", "   1  0.000"), "..."],
     "the command ends with"),
    ("nothing but dots", "", f"{RUN} Refinement/Levels=1", [HEAD, "..."],
     "nothing is shown"),
    ("integer", "", f"{RUN} Refinement/Levels=1",
     [HEAD, ROWS[0], ROWS[1].replace(" 150 ", " 151 ")], "the page shows"),
    ("integer after dots", "", f"{RUN} Refinement/Levels=2",
     [HEAD, "...", ROWS[2].replace(" 10 ", " 11 ")], "the page shows"),
    ("rate", "", f"{RUN} Refinement/Levels=1",
     [HEAD, ROWS[0], ROWS[1].replace("0.059", "0.159")], "the page shows"),
    ("energy", "", f"{RUN} Refinement/Levels=1",
     [HEAD, ROWS[0], ROWS[1].replace("9.17089", "9.17189")], "the page shows"),
    ("words", "", f"{RUN} Refinement/Levels=1",
     [HEAD.replace("sticky", "sticks"), "..."], "the page shows"),
    ("a row is missing", "", f"{RUN} Refinement/Levels=2",
     [HEAD, ROWS[0], ROWS[2]], "the page shows"),
    ("the end is missing", "", f"{RUN} Refinement/Levels=2",
     [HEAD, ROWS[0]], "the page does not show"),
    ("shortened too much", "shortened: Refinement/Levels=0",
     f"{RUN} Refinement/Levels=2", [HEAD, "...", ROWS[2]], "the run has been"),
    ("wrong entry", "", f"{RUN} Refinement/Bevels=2", [], "the command ends"),
    ("unknown command", "", "levitate now", [], "the test does not know"),
    ("without a path", "", f"step-friction-2d {SCENE}", [], "'step-friction-2d'"),
    ("target without test", "", "cmake --build . --target levitate", [],
     "no test builds"),
]


def main():
    page, sections = "# Rotten\n", []
    for name, note, command, shown, _ in CASES:
        page += f"\n## {name}\n\n" + (f"<!-- {note} -->\n" if note else "")
        page += f"```sh\n{command}\n```\n\nprints\n\n"
        if shown:
            page += "```text\n" + "\n".join(shown) + "\n```\n"
        sections.append(page.count("\n"))
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch) / "root"
        (root / SCENE).parent.mkdir(parents=True)
        (root / SCENE).write_text((ROOT / SCENE).read_text())
        (root / "README.md").write_text(page)
        table = Path(scratch) / "shortened.txt"
        table.write_text("README.md | levitate far | Refinement/Levels=1\n")
        run = subprocess.run(
            [sys.executable, "-B", str(HERE / "check_commands.py"), "--root",
             str(root), "--shortened", str(table)] + sys.argv[1:] + ["README.md"],
            capture_output=True, text=True)
    print(run.stdout + run.stderr)
    found = [(int(line), text) for line, text in
             re.findall(r"^README\.md:(\d+): (.*)$", run.stdout, re.M)
             if " seconds, " not in text]
    wrong = [] if "has the words 'levitate far'" in run.stdout else [
        "a row of the table that shortens nothing was not found"]
    begin = 0
    for (name, _, _, _, expected), end in zip(CASES, sections):
        texts = [text for line, text in found if begin < line <= end]
        begin = end
        if (expected is None and texts) or (expected is not None and not (
                len(texts) == 1 and texts[0].startswith(expected))):
            wrong.append(f"{name}: expected {expected or 'nothing'}, found {texts}")
    if run.returncode != 1:
        wrong.append(f"the status is {run.returncode} instead of 1")
    print("\n".join(wrong) or "All offences were found, and no others.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
