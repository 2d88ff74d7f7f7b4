#!/usr/bin/env python3
"""Checks that prose does not rot: every file, entry, command and identifier that
README.md, doc/**/*.md and the steps' .dox pages name exists, links and pictures
lead somewhere, every shipped scene is run by a test or by a command of a page, and
the steps are as long and as commented as they should be. Prints every offence as
FILE:LINE: SENTENCE, and ends with status 1 if there is any."""

import argparse
import re
import sys
from pathlib import Path

from prose_page import Page
from names import COMMANDS, ForeignWords, Names
from repository import BuildTree, Entries, Repository, add_arguments

# A step is read from its beginning to its end.
MOST_CODE_LINES = 700
COMMENTS_PER_CODE = (0.5, 0.9)


# Of blocks: these are checked, or show what is printed. Others would be overlooked.
KNOWN_LANGUAGES = ("sh", "bash", "indented", "prm", "cpp", "c++", "cc", "text", "txt",
                   "table", "")


class Prose:
    def __init__(self, repository, names):
        self.repository, self.names = repository, names
        self.offences, self._pages = [], {}

    def page_of(self, file):
        file = Path(file)
        if file not in self._pages:
            self._pages[file] = Page(file)
        return self._pages[file]

    def report(self, file, line, problem):
        if problem:
            self.offences.append((file, line, problem))

    def check_page(self, file):
        page = self.page_of(self.repository.root / file)
        for problem in page.problems:
            self.report(file, problem.line, problem.text)
        for code in page.code:
            problem = self.names.problem_of_code(code.text, page)
            self.report(file, code.line, problem and f"`{code.text}`: {problem}")
        for link in page.links + page.pictures:
            self.report(file, link.line, self.names.problem_of_link(
                link.text, page, self.page_of))
        for block in page.blocks:
            self.check_block(file, page, block)

    def check_block(self, file, page, block):
        if block.language in ("sh", "bash", "indented"):
            for line, command in commands_of(block):
                first = re.sub(r"^([A-Z_]+=\S*\s+)*", "", command).split(" ")[0]
                if block.language == "indented" and first not in COMMANDS:
                    continue
                self.report(file, line,
                            self.names.problem_of_command(command, page))
        elif block.language not in KNOWN_LANGUAGES:
            self.report(file, block.line, "nothing checks a block of "
                        f"'{block.language}'; take one of "
                        f"{', '.join(filter(None, KNOWN_LANGUAGES))}")
        elif block.language == "prm":
            self.check_scene_lines(file, block)
        elif block.language in ("cpp", "c++", "cc"):
            self.check_quotation(file, block)
            for number, line in enumerate(block.text.split("\n")):
                line = re.sub(r"//.*", "", line)
                for word in re.findall(r"\b[^\W\d]\w*", line):
                    if (word not in self.repository.words
                            and word not in self.names.foreign):
                        self.report(file, block.line + number,
                                    f"no source has the word '{word}'")

    def check_quotation(self, file, block):
        """A block after a comment 'from FILE' stands there, but for spaces."""
        for note in block.notes:
            match = re.fullmatch(r"from (\S+)", note)
            if not match:
                continue
            source = self.repository.sources.get(match.group(1))
            if source is None:
                self.report(file, block.line, f"there is no '{match.group(1)}' to "
                            "quote from")
            elif " ".join(block.text.split()) not in " ".join(source.split()):
                self.report(file, block.line, f"{match.group(1)} does not have these "
                            "lines (any more)")

    def check_scene_lines(self, file, block):
        section = None
        for number, line in enumerate(block.text.split("\n")):
            line = line.split("#")[0].strip()
            match = re.match(r"set\s+([^=]+?)\s*=\s*(.*)", line)
            if line.startswith("subsection "):
                section = line[len("subsection "):].strip()
                if section not in self.names.entries.sections:
                    self.report(file, block.line + number,
                                f"there is no section '{section}'")
            elif line == "end":
                section = None
            elif match and section:
                self.report(file, block.line + number, self.names.entries.problem(
                    section, match.group(1), match.group(2)))
            elif match:
                problems = [self.names.entries.problem(one, *match.groups())
                            for one in self.names.entries.names.get(
                                match.group(1), [])]
                if None not in problems:
                    self.report(file, block.line + number, problems[0] if problems
                                else f"there is no entry '{match.group(1)}'")

    def check_scenes(self, build):
        commands = [command for file in self.repository.pages()
                    for block in self.page_of(self.repository.root / file).blocks
                    if block.language == "sh"
                    for _, command in commands_of(block)]
        for scene in self.repository.scenes():
            step = scene.split("/")[0]
            if not (build.has_test(f"{step}/{Path(scene).stem}")
                    or build.has_test(f"pages/scenes/{Path(scene).stem}")
                    or any(scene in command for command in commands)):
                self.report(scene, 1, "no test and no command of a page runs "
                            "this scene")

    def check_steps(self):
        for step in self.repository.steps():
            code, comments = count_lines(self.repository.sources[step])
            if code >= MOST_CODE_LINES:
                self.report(step, 1, f"{code} lines of code, and a step has less "
                            f"than {MOST_CODE_LINES}")
            ratio, (least, most) = comments / max(code, 1), COMMENTS_PER_CODE
            if not least <= ratio <= most:
                self.report(step, 1, f"{ratio:.2f} lines of comment per line of "
                            f"code, and a step has {least} to {most}")

    def check_foreign_words(self):
        for number, word in self.names.foreign.unused():
            self.report(Path(self.names.foreign.path).name, number,
                        f"no page uses '{word}', so it should not be here")


def commands_of(block):
    """The commands of a block with their lines: a command goes on after '&&', '|'
    and a backslash, but it is looked at piece by piece."""
    commands, pending, start, end_of_input = [], "", None, None
    for number, line in enumerate(block.text.split("\n"), block.line):
        if end_of_input is not None:
            if line.strip() == end_of_input:
                end_of_input = None
            continue
        here_document = re.search(r"<<-?\s*(['\"]?)(\w+)\1", line)
        if here_document:
            end_of_input = here_document.group(2)
            line = line.replace(here_document.group(0), "")
        if not line.strip() or (not pending and line.strip().startswith("#")):
            continue
        start = number if not pending else start
        pending += line.strip()
        if pending.endswith("\\"):
            pending = pending[:-1]
            continue
        for piece in re.split(r"\s*(?:&&|\|\|?|;(?!;))\s*(?=[^']*(?:'[^']*'[^']*)*$)",
                              pending):
            if piece.strip():
                commands.append((start, piece.strip()))
        pending = ""
    return commands


def count_lines(source):
    """Lines with code, and lines with nothing but a comment."""
    code = comments = 0
    inside = False
    for line in source.splitlines():
        line = line.strip()
        if inside or line.startswith(("//", "/*")):
            comments += 1
            inside = (inside or line.startswith("/*")) and "*/" not in line
        elif line:
            code += 1
    return code, comments


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    add_arguments(parser)
    parser.add_argument("--foreign", type=Path,
                        default=Path(__file__).with_name("foreign_words.txt"))
    parser.add_argument("programs", nargs="+", help="the step programs")
    return parser.parse_args()


def main():
    options = parse_arguments()
    repository = Repository(options.root)
    build = BuildTree(options.build, options.cmake, options.ctest)
    names = Names(repository, build, Entries(options.programs),
                  ForeignWords(options.foreign))
    for is_rehearsal in (True, False):
        prose = Prose(repository, names)
        for file in repository.pages():
            prose.check_page(file)
        if is_rehearsal:
            names.entries.end_rehearsal()
    prose.check_scenes(build)
    prose.check_steps()
    prose.check_foreign_words()
    for file, line, problem in prose.offences:
        print(f"{file}:{line}: {problem}.")
    print(f"{len(repository.pages())} pages, {len(prose.offences)} offences.")
    return 1 if prose.offences else 0


if __name__ == "__main__":
    sys.exit(main())
