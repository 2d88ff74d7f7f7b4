"""The compiler's syntax check of all sources in lists of compile commands, one for
each core at a time, in each of the ways in which they are compiled, with deal.II's
assertions and without, where both lists have them. Prints how many of how many pass,
and to stderr, as it goes on, what the compiler says and what has been checked. Sources
that are in no list are compiled as the first one in a list is. Precompiled headers
of the commands have to be there.

Usage: check_syntax.py compile_commands.json ... [SOURCE ...]
"""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys


def check(entry):
    words = shlex.split(entry["command"])
    if "-o" in words:
        at = words.index("-o")
        del words[at:at + 2]
    return subprocess.run(words + ["-fsyntax-only"], cwd=entry["directory"],
                          capture_output=True, text=True)


def main():
    entries = {}
    for path in [name for name in sys.argv[1:] if name.endswith(".json")]:
        with open(path) as file:
            entries.update({(entry["file"], " -DDEBUG" in entry["command"]): entry
                            for entry in json.load(file)
                            if entry["file"].endswith(".cc")})
    first = next(iter(entries.values()))
    sources = [name for name in sys.argv[1:] if not name.endswith(".json")]
    for source in map(os.path.abspath, sources):
        entries[source, False] = dict(first, file=source, command=first[
            "command"].replace(first["file"], source))
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        failed = set()
        results = pool.map(check, entries.values())
        for i, ((file, _), result) in enumerate(zip(entries, results), 1):
            sys.stderr.write(result.stderr)
            print(f"{i} of {len(entries)}: {file}", file=sys.stderr, flush=True)
            if result.returncode != 0:
                failed.add(file)
    files = {file for file, _ in entries}
    print(f"{len(files - failed)} of {len(files)}")
    return 0 if files and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
