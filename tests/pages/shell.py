"""Runs the commands of a page in a scratch copy of the repository, where
build/release/bin and build/debug/bin have the tested programs."""

import os
import shlex
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

from check_prose import commands_of

# What installs, configures, builds, tests or opens a window: looked at, and not
# run here. In a block it stands for nothing.
NOT_RUN = {"apt-get", "cmake", "ctest", "paraview"}
RUN = {"mpirun", "python3", "gmsh", "pvpython", "cd", "cp", "mkdir", "ls", "cat",
       "sed", "grep", "cut", "head", "tail", "diff", "mv", "rm", "echo", "test"}
# A page goes on without these, as a reader would.
OPTIONAL = {"gmsh", "pvpython", "xvfb-run"}
STEPS = {"step-friction-2d", "step-friction-3d"}
PROGRAMS = STEPS | {"friction-plot"}
# Studies that take long, and the tests that run them in a quick form. Any other
# target must be the '--target' of a test.
LONG_STUDIES = {
    "doc": "pages/build",
    "charts": "charts/quick",
    "charts-draw": "charts/quick",
    "robustness": "robustness/quick",
    "benchmark": "benchmark/quick",
    "figures": "figures/quick",
    "figures-2d": "figures/quick",
    "figures-3d": "figures/quick",
    "figures-ideas": "figures-ideas/quick",
    "gallery": "gallery/quick",
    "folders": "support/folders",
}
# What no test can repeat: studies of other systems and of what the tests notice, and
# the tests themselves.
NO_TESTS = {"portability", "deliberate-errors", "tests-quick", "tests-optimised"}
TIME_LIMIT = 400


class Scratch:
    """Files are copied, not linked: what is run may write beside them."""

    def __init__(self, repository, programs, python):
        self._folder = tempfile.TemporaryDirectory(prefix="pages-")
        self.root = Path(self._folder.name) / "root"
        for file in repository.files:
            target = self.root / file
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(repository.root / file, target)
        self.programs = {Path(program).name: str(Path(program).resolve())
                         for program in programs}
        self._tools = Path(self._folder.name) / "tools"
        self._tools.mkdir()
        self._write_script(self._tools / "python3", [python])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._folder.cleanup()

    @staticmethod
    def _write_script(path, command, last=()):
        path.write_text("#!/bin/sh\nexec " + shlex.join(command) + ' "$@" '
                        + shlex.join(last) + "\n")
        path.chmod(0o755)

    def install_programs(self, entries):
        """The step programs, with entries that shorten whatever they run, and what
        draws their results."""
        for kind in ("release", "debug"):
            folder = self.root / "build" / kind / "bin"
            folder.mkdir(parents=True, exist_ok=True)
            for name, program in self.programs.items():
                self._write_script(folder / name, [program], entries)
            plot = self.root / "common" / "plot" / "friction_plot.py"
            self._write_script(folder / "friction-plot", [
                "env", f"FRICTION_PROGRAMS={folder}", str(self._tools / "python3"), "-B",
                str(plot)])

    def run(self, block):
        """Status and output of a block, as one would see it."""
        nothing = "".join(f"{name}() {{ :; }}\n" for name in sorted(NOT_RUN))
        environment = dict(
            os.environ, PATH=f"{self._tools}:{os.environ['PATH']}",
            PYTHONDONTWRITEBYTECODE="1", MPLBACKEND="Agg",
            OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
            OMPI_MCA_rmaps_base_oversubscribe="1",
            PMIX_MCA_mca_base_suppress_deprecated_warning="1",
            PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe")
        process = subprocess.Popen(
            ["bash", "-euo", "pipefail", "-c", nothing + block.text],
            cwd=self.root, env=environment, text=True, errors="replace",
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, start_new_session=True)
        try:
            output, _ = process.communicate(timeout=TIME_LIMIT)
            return process.returncode, output
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            output, _ = process.communicate()
            return 124, output + f"\nstopped after {TIME_LIMIT} seconds\n"


def program_of(command):
    """What a command runs, as written, without variables and what starts it."""
    words = shlex.split(command, comments=True)
    while words and "=" in words[0].split("/")[0]:
        words = words[1:]
    while words and words[0] in ("mpirun", "xvfb-run"):
        words = words[1:]
        while words and words[0].startswith("-"):
            takes_value = words[0] in ("-np", "-n", "-s")
            words = words[2 if takes_value else 1:]
    return words[0] if words else ""


def programs_of(block):
    return [program_of(command) for _, command in commands_of(block)]


def problem_of_command(command, build):
    """Whether the test knows what to do with a command."""
    program = program_of(command)
    name = Path(program).name
    if name in PROGRAMS:
        folder = str(Path(program).parent)
        return None if folder in ("build/release/bin", "build/debug/bin") else (
            f"'{program}' is not found from the repository's root; write "
            f"build/release/bin/{name}")
    if program == "cmake":
        words = shlex.split(command)
        targets = [words[i + 1] for i, word in enumerate(words[:-1])
                   if word == "--target"]
        for target in targets:
            test = LONG_STUDIES.get(target)
            if test and build.has_test(test) or (
                    target in NO_TESTS and target in build.targets):
                continue
            if not build.test_of_target(target):
                return (f"no test builds the target '{target}'"
                        + (f", for there is no test '{test}'" if test else "")
                        + "; add one, or its quick form to LONG_STUDIES in "
                        "tests/pages/shell.py")
        return None
    if program in NOT_RUN | RUN or program == "":
        return None
    return (f"the test does not know '{program}'; add it to what is run, or to "
            "what is not, in tests/pages/shell.py")


def missing_tools(block):
    words = {word for _, command in commands_of(block) for word in command.split()}
    return sorted(name for name in OPTIONAL & words if not shutil.which(name))


def is_run(block):
    return any(program and program not in NOT_RUN for program in programs_of(block))

