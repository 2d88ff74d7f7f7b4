"""The compiler's syntax check of all sources in a list of compile commands, one for
each core at a time; prints how many of how many pass, and to stderr what the compiler says.

Usage: check_syntax.py compile_commands.json
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
    with open(sys.argv[1]) as file:
        entries = {entry["file"]: entry for entry in json.load(file)
                   if entry["file"].endswith(".cc")}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(check, entries.values()))
    for result in results:
        sys.stderr.write(result.stderr)
    passed = sum(result.returncode == 0 for result in results)
    print(f"{passed} of {len(results)}")
    return 0 if passed == len(results) > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
