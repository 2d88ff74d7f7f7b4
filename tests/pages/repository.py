"""What there is for prose to name: files, words of the sources, targets of the
build tree, tests, presets, and entries of scene files."""

import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

# Prose, pictures and results do not vouch for a name.
NO_SOURCES = {".md", ".dox", ".png", ".svg", ".csv", ".output", ".msh", ".txt"}
# The tests of prose name what must not exist.
NOT_FOR_WORDS = "tests/pages/"


def add_arguments(parser):
    """What a check has to know of the repository, a build tree and its tools."""
    parser.add_argument("--root", type=Path, required=True)
    parser.add_argument("--build", required=True, help="the build tree")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--ctest", default="ctest")


class Repository:
    def __init__(self, root):
        self.root = Path(root).resolve()
        self.files = set(self._list_files())
        self.folders = {str(parent) for file in self.files
                        for parent in Path(file).parents} - {"."}
        self.names = {Path(file).name for file in self.files}
        self.suffixes = {Path(file).suffix for file in self.files} - {""} | {
            ".cc", ".h", ".py", ".sh", ".md", ".prm", ".svg", ".png"}
        self.sources = {}
        for file in sorted(self.files):
            if self._is_source(file):
                text = (self.root / file).read_text(encoding="utf-8",
                                                    errors="replace")
                self.sources[file] = text
        # Names of files are words, too: scenes are spoken of without '.prm'.
        corpus = list(self.sources.values()) + sorted(
            file for file in self.files if not file.startswith(NOT_FOR_WORDS))
        self.corpus = "\n".join(corpus)
        self.words = set(re.findall(r"\w+", self.corpus))

    def _list_files(self):
        if (self.root / ".git").exists() and shutil.which("git"):
            listing = subprocess.run(
                ["git", "-c", f"safe.directory={self.root}", "ls-files",
                 "--cached", "--others", "--exclude-standard"],
                cwd=self.root, capture_output=True, text=True)
            if listing.returncode == 0:
                return [file for file in listing.stdout.splitlines()
                        if (self.root / file).is_file()]
        return [str(path.relative_to(self.root))
                for path in sorted(self.root.rglob("*"))
                if path.is_file() and not re.match(
                    r"build($|-|/)|\.git/", str(path.relative_to(self.root)))]

    def _is_source(self, file):
        path = Path(file)
        return not file.startswith(NOT_FOR_WORDS) and (
            path.name == "CMakeLists.txt" or path.suffix not in NO_SOURCES)

    def has(self, path):
        path = str(path).rstrip("/")
        return path in self.files or path in self.folders

    def pages(self):
        """All prose, in the order in which it is read."""
        def order(file):
            return (file != "README.md", file != "doc/start.md",
                    not file.endswith(".md"), file)
        return sorted((file for file in self.files
                       if file in ("README.md", "CONTRIBUTING.md")
                       or re.fullmatch(r"doc/.*\.md", file)
                       or re.fullmatch(r"step-friction-\w+/doc/.*\.dox", file)),
                      key=order)

    def scenes(self):
        return sorted(file for file in self.files if re.fullmatch(
            r"step-friction-\w+/scenes/.*\.prm|doc/own-scene/.*\.prm", file))

    def steps(self):
        return sorted(file for file in self.files if re.fullmatch(
            r"(step-friction-\w+)/\1\.cc", file))

    def presets(self):
        presets = json.loads((self.root / "CMakePresets.json").read_text())
        return {preset["name"] for kind in presets.values()
                if isinstance(kind, list) for preset in kind}


class BuildTree:
    def __init__(self, tree, cmake, ctest):
        listing = subprocess.run([cmake, "--build", tree, "--target", "help"],
                                 capture_output=True, text=True, check=True)
        self.targets = set(re.findall(r"^(?:\.\.\. )?([\w.+-]+)(?:: phony| \(.*\)|)$",
                                      listing.stdout, re.M))
        tests = json.loads(subprocess.run(
            [ctest, "--show-only=json-v1"], cwd=tree, capture_output=True,
            text=True, check=True).stdout)["tests"]
        self.tests = {test["name"]: test.get("command", []) for test in tests}

    def has_test(self, name):
        """Tests of deal.II's kind have '.debug' or '.mpirun=2.release' behind."""
        return any(test == name or test.startswith(name + ".")
                   for test in self.tests)

    def test_of_target(self, target):
        for name, command in self.tests.items():
            if "--target" in command and target in command[command.index("--target"):]:
                return name
        return None


class Entries:
    """What a scene file may say, according to the step programs themselves."""

    def __init__(self, programs):
        self.programs = programs
        self.sections = {}
        for program in programs:
            self._read(subprocess.run([program, "--parameters"], check=True,
                                      capture_output=True, text=True).stdout)
        self.names = {}
        for section, names in self.sections.items():
            for name in names:
                self.names.setdefault(name, []).append(section)
        # Of these there may be several.
        for section in ("Contact", "Obstacle"):
            for number in range(2, 100):
                self.sections[f"{section} {number}"] = self.sections[section]
        self._answers, self.is_rehearsal = {}, True
        self._scene = tempfile.NamedTemporaryFile("w", suffix=".prm")
        self._scene.write("# Nothing: entries are on the command line.\n")
        self._scene.flush()

    def _read(self, parameters):
        section = None
        for line in parameters.splitlines():
            if line.startswith("subsection "):
                section = line[len("subsection "):].strip()
                self.sections.setdefault(section, set())
            match = re.match(r"\s+set ([^=]+?)\s*=", line)
            if match:
                self.sections[section].add(match.group(1))

    def problem(self, section, name, value):
        """What is wrong with an entry, or None."""
        if name not in self.sections.get(section, ()):
            return f"there is no entry '{section}/{name}'"
        if value is None or "..." in value:
            return None
        key = f"{section}/{name}={value}"
        if self.is_rehearsal:
            self._answers.setdefault(key, None)
            return None
        if key not in self._answers:
            self._judge([key])
        return self._answers[key]

    def end_rehearsal(self):
        """Judges all entries that have been asked for until now, which is much
        quicker than one by one."""
        self._judge(list(self._answers))
        self.is_rehearsal = False

    def _judge(self, keys):
        """The programs judge values: they read entries in their order and stop at
        the first that is wrong, and the last one here always is."""
        last = "No section/No entry"
        run = subprocess.run(
            [self.programs[0], self._scene.name] + keys + [last + "=1"],
            capture_output=True, text=True)
        if run.returncode != 2:
            raise RuntimeError(f"{self.programs[0]} does not refuse {last}:\n"
                               + run.stdout + run.stderr)
        if last in run.stderr:
            self._answers.update(dict.fromkeys(keys))
        elif len(keys) == 1:
            entry, _, value = keys[0].partition("=")
            self._answers[keys[0]] = f"'{value}' is no value of '{entry}'"
        else:
            self._judge(keys[:len(keys) // 2])
            self._judge(keys[len(keys) // 2:])
