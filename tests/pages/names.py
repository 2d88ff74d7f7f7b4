"""Whether what prose names exists. One function per kind of name; each returns
what is wrong in words, or None."""

import fnmatch
import re
import shlex
from pathlib import Path

from prose_page import Page

ENTRY = re.compile(r"([A-Z][a-z]+(?: [a-z]+)*)/([A-Z][^=/]*?)\s*(?:=\s*(.*))?$")
# Endings of files that runs leave behind; such names must occur in sources.
PRODUCTS = {".h5", ".csv", ".pvd", ".vtu", ".pvtu", ".xdmf", ".html"}
COMMANDS = {"cmake", "ctest", "mpirun", "apt-get", "python3", "gmsh", "pvpython",
            "paraview", "bash", "sh", "step-friction-2d", "step-friction-3d",
            "friction-plot"}
CMAKE_OPTIONS = {"build", "preset", "target", "parallel", "install", "prefix"}
# A symbol of a formula that is written as code: a letter and a short index.
SYMBOL = re.compile(r"(?:[A-Za-z]|phi|sum)_[a-z]{1,2}$")
PLACEHOLDER = re.compile(r"[A-Z]+$|<.*>$|\.\.\.$")


class ForeignWords:
    """Words that prose may use although the repository does not have them: one a
    line, then at least two blanks and the reason."""

    def __init__(self, path):
        self.path, self.reasons, self.used = path, {}, set()
        for number, line in enumerate(Path(path).read_text().splitlines(), 1):
            if not line.strip() or line.startswith("#"):
                continue
            word, _, reason = line.partition("  ")
            if not reason.strip():
                raise SystemExit(f"{path}:{number}: '{word}' has no reason.")
            self.reasons[word.strip()] = (number, reason.strip())

    def __contains__(self, word):
        if word in self.reasons:
            self.used.add(word)
            return True
        return False

    def unused(self):
        return [(number, word) for word, (number, _) in self.reasons.items()
                if word not in self.used]


class Names:
    def __init__(self, repository, build, entries, foreign):
        self.repository, self.build = repository, build
        self.entries, self.foreign = entries, foreign
        readme = repository.root / "README.md"
        cmake = [text for file, text in repository.sources.items()
                 if Path(file).name == "CMakeLists.txt"]
        blocks = Page(readme).blocks if readme.is_file() else []
        self.installs = "\n".join([block.text for block in blocks] + cmake)

    # Inline code.
    def problem_of_code(self, text, page):
        if text in self.foreign:
            return None
        if re.fullmatch(r"'[^']*'", text):
            text = text[1:-1]
        match = ENTRY.match(text)
        if match and (match.group(1) in self.entries.sections
                      or not self.repository.has(text)):
            return self.entries.problem(*match.groups())
        match = re.match(r"([A-Z][^=/]*?)\s*=\s*([^=].*)$", text)
        if match and match.group(1) in self.entries.names:
            return self._problem_of_short_entry(*match.groups())
        if re.match(r"/[a-z_]+(/[a-z_]+)+$", text):
            return self._problem_of_data_set(text)
        first = text.split()[0]
        if " " in text and (first in COMMANDS or first.startswith("$")
                            or Path(first).suffix in (".py", ".sh")
                            or "/bin/" in first):
            return self.problem_of_command(text, page)
        if " " not in text and self._looks_like_path(text):
            return self._problem_of_path(text, page)
        return self._problem_of_words(text, page)

    def _problem_of_short_entry(self, name, value):
        problems = [self.entries.problem(section, name, value)
                    for section in self.entries.names[name]]
        return None if None in problems else problems[0]

    def _problem_of_data_set(self, text):
        written = "\n".join(source for file, source in
                            self.repository.sources.items()
                            if file.startswith("common/output/"))
        for part in text.strip("/").split("/"):
            if f'"{part}"' not in written:
                return f"nothing in common/output writes '{part}'"
        return None

    # Paths.
    def _looks_like_path(self, text):
        if re.search(r"[^\w./*+-]", text) or not re.search(r"[a-z]", text):
            return False
        suffix = Path(text).suffix
        return (suffix in self.repository.suffixes | PRODUCTS
                or text.strip("/") != text or "/" in text
                or text.startswith("."))

    def _problem_of_path(self, text, page):
        repository, bare = self.repository, text.rstrip("/")
        if any(bare == made or bare.startswith(made + "/")
               for made in page.made_folders):
            return None
        folder = Path(page.path).resolve().parent
        if "*" in text:
            pattern = [str(folder.relative_to(repository.root) / text), text,
                       "*/" + text]
            if any(fnmatch.fnmatch(file, one)
                   for file in repository.files for one in pattern):
                return None
        elif (repository.has(normal_path(repository.root, folder / bare))
              or repository.has(bare) or bare in repository.names
              or any(file.endswith("/" + bare) for file in
                     repository.files | repository.folders)):
            return None
        if self.build.has_test(bare):
            return None
        if any(str(Path(file).with_suffix("")) in (bare, "tests/" + bare)
               for file in repository.files):
            return None
        name = Path(bare).name
        if bare.startswith("build/"):
            found = name in self.build.targets or name in repository.words
            return None if found or self._occurs(name) else (
                f"nothing in the sources makes '{text}'")
        if Path(name).suffix in PRODUCTS or name in PRODUCTS:
            parts = [*Path(bare).parts[:-1], name.lstrip("*-")]
            return None if all(map(self._occurs, parts)) else (
                f"there is no file '{text}', and no source speaks of it")
        suffix = Path(name).suffix
        if suffix not in repository.suffixes and self._occurs(text.rstrip("/")):
            return None
        return f"there is no file, folder or test '{text}'"

    def _occurs(self, text):
        return re.search(r"(?<![\w-])" + re.escape(text) + r"(?![\w-])",
                         self.repository.corpus) is not None

    # Words.
    def _problem_of_words(self, text, page):
        for token in text.split():
            bare = re.sub(r"^[\s('\"<\[{]+|[\s)'\",;:>\]}]+$", "", token)
            if bare in self.foreign or token in self.foreign:
                continue
            if re.match(r"--[a-z]", bare):
                option, _, bare = bare.partition("=")
                if not self._occurs(option.lstrip("-")):
                    return f"no source has an option '{option}'"
            if ("/" in bare and Path(bare).suffix in self.repository.suffixes
                    and self._looks_like_path(bare)):
                problem = self._problem_of_path(bare, page)
                if problem:
                    return problem
                continue
            bare = re.sub(r"^-D(?=[A-Z])", "", bare)  # a definition for CMake
            for word in re.findall(r"[^\W\d]\w*", bare):
                if not (word in self.repository.words or SYMBOL.match(word)
                        or word in self.foreign):
                    return f"no source has the word '{word}'"
            problem = self._problem_of_member(bare)
            if problem:
                return problem
        hyphened = re.fullmatch(r"[\w-]+", text) and "-" in text.strip("-")
        if hyphened and not (self._occurs(text) or text in self.build.targets):
            return f"no source has the word '{text}'"
        return None

    def _problem_of_member(self, text):
        """Of 'Class::member', that both occur in one file of sources."""
        words = re.findall(r"\w+", re.sub(r"<.*>|\(.*", "", text))
        if "::" not in text or "std::" in text:
            return None
        for source in self.repository.sources.values():
            if all(re.search(rf"\b{word}\b", source) for word in words):
                return None
        return f"no source file has all words of '{text}'"

    # Commands.
    def problem_of_command(self, text, page):
        try:
            words = shlex.split(text, comments=True)
        except ValueError as error:
            return f"'{text}' is no command of a shell: {error}"
        while words and re.match(r"[A-Z_]+=", words[0]):
            words = words[1:]
        if not words:
            return None
        first = Path(words[0]).name
        if first == "apt-get":
            return self._problem_of_packages(words)
        own = (words[0].startswith("$") or Path(first).suffix in (".py", ".sh")
               or first in self.build.targets or first in ("python3", "mpirun"))
        for before, word in zip([""] + words, words):
            problem = self._problem_of_argument(word, before, own, first, page)
            if problem:
                return problem
        return None

    def _problem_of_packages(self, words):
        for word in words[1:]:
            if (word.startswith("-") or word in ("update", "install", "&&")
                    or word in self.foreign):
                continue
            if not re.search(r"(?<![\w.-])" + re.escape(word) + r"(?![\w.-])",
                             self.installs):
                return (f"no install command of the README and no CMakeLists.txt "
                        f"has the package '{word}'")
        return None

    def _problem_of_argument(self, word, before, own, command, page):
        if PLACEHOLDER.match(word) or word in self.foreign:
            return None
        if before in ("--target", "-t"):
            return None if word in self.build.targets else (
                f"there is no target '{word}'")
        if before == "--preset":
            return None if word in self.repository.presets() else (
                f"there is no preset '{word}'")
        match = ENTRY.match(word)
        if match:
            return self.entries.problem(*match.groups())
        if word.startswith("--"):
            option = word.split("=")[0].lstrip("-")
            if command == "cmake" and option not in CMAKE_OPTIONS:
                return f"cmake has no option '--{option}' that the pages need"
            return None if not own or self._occurs(option) else (
                f"no source has an option '--{option}'")
        if word.startswith("-") or not self._looks_like_path(word):
            return None
        return self._problem_of_path(word, page)

    # Links.
    def problem_of_link(self, target, page, page_of):
        if re.match(r"[a-z]+:", target):
            return None if target.startswith(("http:", "https:", "mailto:")) else (
                f"what kind of link is '{target}'?")
        path, _, anchor = target.partition("#")
        file = Path(page.path).resolve()
        if path:
            file = file.parent / path
            inside = normal_path(self.repository.root, file)
            if inside is None or not self.repository.has(inside):
                return f"the link leads to '{path}', which is not there"
            file = self.repository.root / inside
        if anchor and file.suffix in (".md", ".dox"):
            if anchor not in page_of(file).anchors:
                return f"there is no heading '#{anchor}' in {file.name}"
        return None


def normal_path(root, path):
    """Relative to the root and without '..', or None if it is elsewhere."""
    parts = []
    for part in Path(path).parts:
        if part == ".." and parts:
            parts.pop()
        elif part != ".":
            parts.append(part)
    path = Path(*parts)
    return str(path.relative_to(root)) if path.is_relative_to(root) else None
