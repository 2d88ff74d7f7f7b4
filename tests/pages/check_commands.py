#!/usr/bin/env python3
"""Runs every command of a page, shortened where the page or shortened.txt says so,
and compares what is printed with what the page shows. Prints every offence as
FILE:LINE: SENTENCE, and ends with status 1 if there is any.

    check_commands.py --root ROOT --build TREE PROGRAM PROGRAM PAGE"""

import argparse
import sys
import time
from pathlib import Path

import shell
from check_prose import commands_of
from console import Comparison
from prose_page import Page
from repository import BuildTree, Repository, add_arguments


class Shortened:
    """The table of entries that shorten a command: page | words | entries."""

    def __init__(self, path, repository):
        self.path, self.rows = path, []
        for number, line in enumerate(Path(path).read_text().splitlines(), 1):
            if not line.strip() or line.startswith("#"):
                continue
            page, words, entries = (part.strip() for part in line.split("|"))
            if page not in repository.files:
                raise SystemExit(f"{path}:{number}: there is no page '{page}'.")
            self.rows.append([number, page, words, split_entries(entries), False])

    def entries(self, page, block):
        found = []
        for row in self.rows:
            if row[1] == page and row[2] in block.text:
                row[4] = True
                found += row[3]
        return found

    def unused(self, page):
        return [(number, words) for number, file, words, _, used in self.rows
                if file == page and not used]


def split_entries(text):
    return [entry.strip() for entry in text.split(";") if entry.strip()]


class Commands:
    def __init__(self, name, page, build, scratch, shortened):
        self.name, self.page, self.build = name, page, build
        self.scratch, self.shortened = scratch, shortened
        self.offences, self.skipped, self.n_run = [], [], 0

    def report(self, line, problem):
        self.offences.append((line, problem))

    def check(self):
        blocks = sorted(self.page.blocks, key=lambda block: block.line)
        for i, block in enumerate(blocks):
            if block.language not in ("sh", "bash"):
                continue
            shown = []
            for other in blocks[i + 1:]:
                if other.language in ("sh", "bash") and shell.is_run(other):
                    break
                if any(block.line < heading < other.line
                       for heading in self.page.headings):
                    break
                if other.language in ("text", ""):
                    shown.append(other)
            self.check_block(block, shown)

    def check_block(self, block, shown):
        known = True
        for line, command in commands_of(block):
            problem = shell.problem_of_command(command, self.build)
            if problem:
                known = False
                self.report(line, problem)
        if not known or not shell.is_run(block):
            return
        missing = shell.missing_tools(block) or self.missing_files(block)
        if missing:
            self.skipped.append(block.line)
            print(f"{self.name}:{block.line}: skipped, because "
                  f"{' and '.join(missing)} is missing.")
            return
        entries = self.shortened.entries(self.name, block)
        for note in block.notes:
            if note.startswith("shortened:"):
                entries += split_entries(note[len("shortened:"):])
        self.scratch.install_programs(entries)
        begin = time.time()
        status, output = self.scratch.run(block)
        self.n_run += 1
        print(f"{self.name}:{block.line}: {time.time() - begin:.1f} seconds, "
              f"{'shortened by ' + '; '.join(entries) if entries else 'in full'}.",
              flush=True)
        self.compare(block, shown, status, output, entries)

    def missing_files(self, block):
        """What an earlier block would have made, had it not been skipped."""
        if not self.skipped:
            return []
        words = [word for _, command in commands_of(block)
                 for word in command.replace("'", " ").split()
                 if "/" in word and "=" not in word]
        return [word for word in words if Path(word).suffix in (".msh", ".h5", ".pvd")
                and not (self.scratch.root / word).exists()]

    def compare(self, block, shown, status, output, entries):
        end_is_shown = False
        for text in shown:
            lines = list(enumerate(text.text.split("\n"), text.line))
            comparison = Comparison(lines, output, bool(entries))
            end_is_shown = end_is_shown or comparison.last_shown
            for line, problem in comparison.offences:
                self.report(line, problem)
        # A run that finds no solution ends with an error. A page that tells of it
        # shows the message, or has the comment '<!-- exit status: 1 -->'.
        wanted = {note[len("exit status:"):].strip() for note in block.notes
                  if note.startswith("exit status:")}
        as_wanted = (str(status) in wanted if wanted else
                     status == 0 or (status == 1 and end_is_shown))
        if not as_wanted:
            self.report(block.line, f"the command ends with status {status}, and "
                        "prints\n  " + "\n  ".join(output.splitlines()[-20:]))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add_arguments(parser)
    parser.add_argument("--shortened", type=Path,
                        default=Path(__file__).with_name("shortened.txt"))
    parser.add_argument("programs", nargs=2, help="the step programs")
    parser.add_argument("page")
    options = parser.parse_args()
    repository = Repository(options.root)
    build = BuildTree(options.build, options.cmake, options.ctest)
    shortened = Shortened(options.shortened, repository)
    with shell.Scratch(repository, options.programs, sys.executable) as scratch:
        commands = Commands(options.page, Page(repository.root / options.page),
                            build, scratch, shortened)
        commands.check()
    for line, problem in commands.offences:
        print(f"{options.page}:{line}: {problem}")
    unused = shortened.unused(options.page)
    for number, words in unused:
        print(f"{options.shortened.name}:{number}: no command of {options.page} "
              f"has the words '{words}'.")
    print(f"{commands.n_run} blocks have been run, {len(commands.skipped)} have "
          f"been skipped; {len(commands.offences) + len(unused)} offences.")
    return 1 if commands.offences or unused else 0


if __name__ == "__main__":
    sys.exit(main())
