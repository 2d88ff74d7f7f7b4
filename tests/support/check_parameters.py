"""No function of the library has more than five parameters, except for those below.

Usage: check_parameters.py FOLDER

Looks at the declarations in the headers of FOLDER and at the definitions in its
sources, and first at one of its own, which has one parameter too many.
"""

import re
import sys
from pathlib import Path

MOST = 5

# With the reason.
EXCEPTIONS = {
    # The five parts, and how often the second one is used.
    "MonotoneMultigrid": 6,
    # As MPI wants it.
    "copy_place": 6,
}


def functions(text):
    """Names of the functions declared in a file, with numbers of parameters."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", text, flags=re.S)
    # Commas of sentences are none.
    text = re.sub(r'"(?:[^"\\\n]|\\.)*"', '""', text)
    for name in re.finditer(r"([A-Za-z_~]\w*)\s*\(", text):
        if text[name.end() : name.end() + 1] == '"':
            continue
        depth, angles, commas, i = 1, 0, 0, name.end()
        while i < len(text) and depth:
            c = text[i]
            depth += (c in "([{") - (c in ")]}")
            angles += (c == "<") - (c == ">" and text[i - 1] != "-")
            commas += c == "," and depth == 1 and angles == 0
            i += 1
        declares = re.match(r"\s*(const)?\s*(override)?\s*(;|:|\{|=)", text[i:])
        typed = re.search(r"\w\s*[&*]?\s*\b\w+\s*(,|$|=)", text[name.end() : i - 1])
        if declares and typed:
            yield name[1], commas + 1


def too_long(text):
    return [
        (name, n)
        for name, n in functions(text)
        if n > EXCEPTIONS.get(name, MOST)
    ]


def main(folder):
    bad = "void f(const A<int, 3> &a, B b, C *c, D d = {1, 2},\n double e, int f);"
    assert too_long(bad) == [("f", 6)], "the check does not work"
    assert not too_long(bad.replace(", int f", "")), "the check does not work"
    files = sorted([*Path(folder).rglob("*.h"), *Path(folder).rglob("*.cc")])
    assert files, f"there are no sources in {folder}"
    found = 0
    for file in files:
        for name, n in too_long(file.read_text()):
            print(f"{file}: {name}() has {n} parameters, {MOST} are enough")
            found += 1
    sys.exit(found > 0)


main(sys.argv[1])
