#!/usr/bin/env python3
"""Checks that the check of prose can fail: a small repository of prose, some lines
of which are rotten in one way each and say so, must give exactly one offence for
each such line and none for the others. Arguments are those of check_prose.py but
for the root."""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent

README = """# A page

Sound: `run_program`, `Solver/Cycle=W`, `Levels = 3`, `history.h5`, `source.cc`,
`/levels/cycles`, `Shape::area()`, `step-friction-2d/scenes/known.prm`, `*.cc`.
[a link](doc/other.md#two-words--three), [a heading](#a-page), $a_b$, `F_i`,
![a picture](picture.png) and `spare`.

An identifier `missing_function()`. <!-- ROTTEN -->
A member of another class: `Shape::run_program`. <!-- ROTTEN -->
A word with a hyphen: `stick-sleep`. <!-- ROTTEN -->
A file `common/missing.cc`. <!-- ROTTEN -->
A bare name of a file: `missing.py`. <!-- ROTTEN -->
Files `missing-*.cc`. <!-- ROTTEN -->
A product `missing.h5`. <!-- ROTTEN -->
A folder of a product `missing/history.h5`. <!-- ROTTEN -->
A test `solvers/missing`. <!-- ROTTEN -->
An option `cmake --missing release`. <!-- ROTTEN -->
A section `Solvers/Cycle`. <!-- ROTTEN -->
An entry `Solver/Bicycle = V`. <!-- ROTTEN -->
A value `Solver/Cycle = Q`. <!-- ROTTEN -->
A value of a short form, `Cycle = Q`. <!-- ROTTEN -->
A set of data `/levels/missing`. <!-- ROTTEN -->
A command `cmake --build . --target missing`. <!-- ROTTEN -->
A package: `apt-get install libmissing-dev`. <!-- ROTTEN -->
A link to [nothing](doc/missing.md). <!-- ROTTEN -->
A link to [no heading](doc/other.md#missing). <!-- ROTTEN -->
A picture ![of nothing](missing.png). <!-- ROTTEN -->
A picture <img src="missing.svg" alt="of nothing">. <!-- ROTTEN -->
Code over two lines belongs to the first: `Refinement/Missing
levels=1`. <!-- ROTTEN ABOVE -->
A single ` is left over. <!-- ROTTEN -->

```sh
build/release/bin/step-friction-2d step-friction-2d/scenes/known.prm Solver/Cycle=W
build/release/bin/step-friction-2d missing.prm # ROTTEN
build/release/bin/step-friction-2d step-friction-2d/scenes/known.prm Solver/Cycle=Q # ROTTEN
cmake --preset missing # ROTTEN
```

```prm
subsection Solver
  set Cycle = W
  set Cycle = Q # ROTTEN
  set Missing = 1 # ROTTEN
end
```

```cpp
Shape area;
missing(area); // ROTTEN
```

<!-- from source.cc -->
```cpp
struct Shape
{double area();};
```

<!-- from source.cc -->
```cpp
struct Shape; // ROTTEN
```

```console
a command that nothing runs, ROTTEN
```
"""

DOX = """<h3>Known</h3>
<code>Shape</code> and
<code>Missing</code> <!-- ROTTEN -->
<img src="../../picture.png"> but <img src="missing.png"> <!-- ROTTEN -->
@code{.sh}
step-friction-2d missing.prm # ROTTEN
@endcode
"""

FILES = {
    "README.md": README,
    "CMakePresets.json": '{"configurePresets": [{"name": "release"}]}',
    "doc/other.md": "# Other\n\n## Two words & three\n",
    "picture.png": "",
    "source.cc": "struct Shape {double area();};\n",
    "other_source.cc": "run_program();\n",
    "common/output/history.cc": '"levels" "cycles" "history.h5"\n',
    "step-friction-2d/doc/intro.dox": DOX,
    "step-friction-2d/scenes/known.prm": "# A page's command runs it.\n",
    "step-friction-2d/scenes/unknown.prm": "# ROTTEN\n",
    "step-friction-2d/step-friction-2d.cc":
        "// ROTTEN\n" + 10 * "int i;\n",
    "step-friction-3d/step-friction-3d.cc":
        "/* A comment\n" + 6 * "that goes on\n" + "*/\n" + 12 * "int i;\n",
}
FOREIGN = "spare  the page above uses it\nunused  no page does ROTTEN\n"


def main():
    with tempfile.TemporaryDirectory() as scratch:
        root = Path(scratch) / "root"
        expected = set()
        for name, text in FILES.items():
            file = root / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            expected |= lines_marked(name, text)
        foreign = Path(scratch) / "foreign_words.txt"
        foreign.write_text(FOREIGN)
        expected |= lines_marked(foreign.name, FOREIGN)
        run = subprocess.run(
            [sys.executable, "-B", str(HERE / "check_prose.py"), "--root",
             str(root), "--foreign", str(foreign)] + sys.argv[1:],
            capture_output=True, text=True)
    print(run.stdout + run.stderr)
    found = re.findall(r"^(\S+?):(\d+): ", run.stdout, re.M)
    wrong = [f"{':'.join(place)}: not found" for place in sorted(expected)
             if found.count(place) == 0]
    wrong += [f"{':'.join(place)}: found, but nothing is wrong"
              for place in sorted(set(found)) if place not in expected]
    wrong += [f"{':'.join(place)}: found more than once" for place in sorted(expected)
              if found.count(place) > 1]
    if run.returncode != 1:
        wrong.append(f"the status is {run.returncode} instead of 1")
    print("\n".join(map(str, wrong)) or f"All {len(expected)} offences were found.")
    return 1 if wrong else 0


def lines_marked(name, text):
    lines = text.splitlines()
    return {(name, str(number - ("ABOVE" in line)))
            for number, line in enumerate(lines, 1) if "ROTTEN" in line}


if __name__ == "__main__":
    sys.exit(main())
