"""Runs all shipped scenes, as they are or with the same entries changed in all of them,
and writes what the program that verifies runs says: for each scene a row with the
largest violation on any level.

Usage: all_scenes.py PROGRAM_2D PROGRAM_3D ROOT TABLE [SECTION/ENTRY=VALUE ... | --short]

--short makes each of them as short as its test does.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from checks import verify_level
from friction_verify import read_level, tolerance_of
from run_data import read_history
from verdict import COLUMNS


def row_of(name, directory):
    """A row of the table, and whether all levels are confirmed."""
    text, rows = read_history(directory)
    largest, confirmed, before = dict.fromkeys(COLUMNS, 0.), True, None
    for row in rows:
        level, scene = read_level(text, directory / f"verify-{row['level']:02d}.h5")
        verdict, unknown = verify_level(level, row, scene, tolerance_of(scene, row),
                                        before)
        before = level
        confirmed = confirmed and not verdict.complaints and not unknown
        for column in COLUMNS:
            largest[column] = max(largest[column], verdict.largest[column])
    numbers = " ".join(f"{largest[column]:11.0e}" for column in COLUMNS)
    return (f"{name:<20} {len(rows):6} {rows[-1]['dofs']:7} {numbers}"
            + ("" if confirmed else "  refuted"), confirmed)


def entries_of_test(root, dim, name):
    """What shortens a scene in its test: a line each, and comments."""
    text = (root / f"tests/step-friction-{dim}d/{name}.overrides").read_text()
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def main():
    programs, root, table = sys.argv[1:3], Path(sys.argv[3]), Path(sys.argv[4])
    lines, failures = [f"{'scene':<20} levels {'dofs':>7} "
                       + " ".join(f"{column:>11}" for column in COLUMNS)], 0
    for dim, program in zip((2, 3), programs):
        for scene in sorted((root / f"step-friction-{dim}d/scenes").glob("*.prm")):
            entries = (entries_of_test(root, dim, scene.stem)
                       if sys.argv[5:] == ["--short"] else sys.argv[5:])
            with tempfile.TemporaryDirectory() as folder:
                subprocess.run([program, str(scene), f"Output/Directory={folder}",
                                "Output/Verification=true", "Output/Fields=false",
                                *entries], check=True, stdout=subprocess.DEVNULL)
                line, confirmed = row_of(f"{scene.stem} ({dim}D)", Path(folder))
            failures += not confirmed
            lines.append(line)
            print(line, flush=True)
    table.write_text("\n".join(lines) + "\n")
    sys.exit(failures > 0)


main()
