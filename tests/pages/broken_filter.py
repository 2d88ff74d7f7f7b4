#!/usr/bin/env python3
"""Checks that a page which cannot be made is an error, although Doxygen does not
look at the status of its filter: the filter says why, and the pages are not
complete without it. The only argument is the repository."""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PAGE = "# A page\n\n```sh\na block without an end\n"


def run(*command):
    return subprocess.run([sys.executable, "-B", *map(str, command)],
                          capture_output=True, text=True)


def main():
    repository = Path(sys.argv[1])
    wrong = []
    with tempfile.TemporaryDirectory() as scratch:
        root, html = Path(scratch) / "root", Path(scratch) / "html"
        shutil.copytree(repository / "doc" / "pages", root / "doc" / "pages")
        (root / "README.md").write_text("# The first page\n")
        (root / "doc" / "broken.md").write_text(PAGE)
        for step in ("step-friction-2d", "step-friction-3d"):
            (root / step).mkdir()
        html.mkdir()
        (root / "CONTRIBUTING.md").write_text("# How to\n")
        for name in ("readme", "contributing", "step_friction_2d", "step_friction_3d"):
            (html / f"{name}.html").write_text('<div class="title">A page</div>')

        done = run(root / "doc/pages/filter.py", root / "README.md")
        if done.returncode != 0 or "{#readme}" not in done.stdout:
            wrong.append(f"a sound page: {done.stderr}")
        done = run(root / "doc/pages/filter.py", root / "doc/broken.md")
        if done.returncode == 0 or "doc/broken.md" not in done.stderr:
            wrong.append("a broken page passes the filter")
        done = run(root / "doc/pages/mend.py", html)
        if done.returncode == 0 or "doc/broken.md" not in done.stderr:
            wrong.append(f"nobody misses the broken page: {done.stderr}")
        (html / "broken.html").write_text('<div class="title">A page</div>')
        done = run(root / "doc/pages/mend.py", html)
        if done.returncode != 0:
            wrong.append(f"nothing is missing any more, but: {done.stderr}")
    print("\n".join(wrong) or "A page that cannot be made is an error.")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
