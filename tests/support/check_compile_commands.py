"""The flags that win, as the compiler sees them.

In a debug tree everything has deal.II's assertions and is optimised all the same. In
release mode nothing is left of assertions, and there is no debug information, unless it
was asked for.

Deprecated functions are warned of. With sanitizers everything is compiled with
them. Each target of the list that CMake gives has to be among what is compiled.

Usage: check_compile_commands.py compile_commands.json Debug|Release SANITIZERS
         DEBUG_INFO TARGET ...

  DEBUG_INFO  1 or 0, whether debug information is asked for
"""
import json
import re
import shlex
import sys


DEBUG_INFO = (r"-g([0-3]|gdb[0-3]?|dwarf(-[0-9])?|mlt|stabs\+?"
              "|line-(tables|directives)-only)?")


def flags_of(command):
    """The last levels of optimisation and of debug information, what is defined, and
    the object file."""
    optimisation, debug_info, defined = "-O0", "-g0", set()
    words = shlex.split(command)
    for word in words:
        if word.startswith("-O"):
            optimisation = word
        elif re.fullmatch(DEBUG_INFO, word):
            debug_info = "-g0" if word.endswith("0") else word
        elif word.startswith("-D"):
            defined.add(word[2:].split("=")[0])
    return optimisation, debug_info, defined, words[words.index("-o") + 1]


def main():
    path, build_type, sanitizers, wants_debug_info, *targets = sys.argv[1:]
    with open(path) as file:
        entries = json.load(file)
    wrong, missing = [], set(targets)
    for entry in entries:
        optimisation, debug_info, defined, output = flags_of(entry["command"])
        missing -= {output.split(".dir/")[0].split("/")[-1]}
        if build_type == "Release":
            good = (optimisation == "-O2" and "DEBUG" not in defined
                    and (debug_info == "-g0") == (wants_debug_info != "1"
                                                  and not sanitizers))
        else:
            good = optimisation in ("-O1", "-Og") and "DEBUG" in defined \
                and "NDEBUG" not in defined
        if "-Wno-deprecated-declarations" in entry["command"]:
            good = False
        if sanitizers and f"-fsanitize={sanitizers}" not in entry["command"]:
            good = False
        if not good:
            wrong.append(f"{output}: {optimisation}, {debug_info}, "
                         + ("" if "DEBUG" in defined else "no ") + "assertions")
    print(f"{len(entries)} files")
    # A list of nothing is right in every respect.
    if not targets:
        wrong.append("CMake has given no targets")
    wrong += [f"{target}: not compiled" for target in sorted(missing)]
    if wrong:
        print("FAILED:", *wrong, sep="\n  ")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
