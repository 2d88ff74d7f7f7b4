#!/usr/bin/env python3
"""Runs that are interrupted, and files that are damaged: in the end there is the
result of a run that was left alone, or a sentence, and never anything else.

Usage: faults.py PROGRAM SCENE SCENARIO ... [--tries N] [--processes N]
         [--mpiexec MPIEXEC] [--numproc-flag=FLAG] [--levels N] [--seed N]
         [--entry SECTION/ENTRY=VALUE] ... [--loaded PROGRAM]

Scenarios:
  damage  bits flipped, ends cut off, files emptied, removed and added in checkpoints
  lock    two runs in one directory; a lock that a killed run has left
  stale   what earlier runs leave in a directory is removed, and nothing else is
  kill    all processes killed at random moments, some of them again and again
  lost    one of several processes killed
  full    a disk that gets full at random moments, in a mount namespace of its own;
          skipped, and said so, where the system does not allow one
  quota   files that may not get longer than a limit, which cannot be known before

SCENE, with the entries of the options in the place of its own, may have load steps, and
platens: each load step but the first is a level more, and has checkpoints like those.

A level is lost if a run that is continued solves it once more although its row had
been printed; at most one may be lost each time. Moments and bits are random but, for
a SEED, always the same, as far as the machine is as fast."""

import argparse
import collections
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

try:
    import h5py
    import numpy
except ImportError:
    h5py = None

CHECKPOINT = re.compile(r"checkpoint-(\d\d)")
Result = collections.namedtuple("Result", "status out err")


class Failure(Exception):
    pass


def demand(condition, what):
    if not condition:
        raise Failure(what)


def rows_of(text):
    """The rows of the table: lists of words."""
    return [line.split() for line in text.splitlines()
            if re.match(r" *\d+ +\d+ ", line)]


def newest_checkpoint(directory):
    """The level of the last one, or 0: then a run begins anew."""
    return max([int(match.group(1)) for match in
                map(CHECKPOINT.fullmatch, os.listdir(directory)) if match],
               default=0)


def contents(directory):
    """Names of all files below a directory, with what is in them."""
    return {str(path.relative_to(directory)): path.read_bytes()
            for path in sorted(Path(directory).rglob("*")) if path.is_file()}


class Faults:
    def __init__(self, options):
        self.options = options
        self.random = random.Random(options.seed)
        self.work = Path(tempfile.mkdtemp(prefix="faults-"))
        self.name = Path(options.program).name
        self.failures = 0
        self.wholes = {}

    # --- runs -----------------------------------------------------------------

    def command(self, directory, *arguments, program=None, n=None, levels=None,
                checkpoint=True, limited=False):
        n = n or self.options.processes
        levels = self.options.levels if levels is None else levels
        ignoring = ["sh", "-c", "trap '' XFSZ; exec \"$0\" \"$@\""] if limited else []
        words = [*ignoring, program or self.options.program, self.options.scene,
                 f"Output/Directory={directory}", f"Refinement/Levels={levels}",
                 "Output/Times=false", *self.options.entry, *arguments]
        if checkpoint:
            words.append("Output/Checkpoint=true")
        if n > 1:
            # mpirun writes files as well; it gives its processes signals of their own.
            words = [*ignoring, self.options.mpiexec, self.options.numproc_flag, str(n), *words]
        return words

    def start(self, *arguments, longest_file=None, **keywords):
        """In a process group of its own, with the output in files."""
        limited, environment = longest_file is not None, dict(os.environ)
        if limited:
            # Processes exchange messages without files, which may be longer, and on
            # this machine only.
            environment.update(OMPI_MCA_btl="self,tcp", PMIX_MCA_gds="hash",
                               OMPI_MCA_btl_tcp_if_include="lo")

        def limit():
            if limited:
                resource.setrlimit(resource.RLIMIT_FSIZE, (longest_file,) * 2)

        out, err = (tempfile.TemporaryFile("w+", dir=self.work) for _ in range(2))
        # Programs of MPI that share a folder for their own purposes may remove it
        # while another one starts.
        own = tempfile.mkdtemp(prefix="mpi-", dir=self.work)
        process = subprocess.Popen(self.command(*arguments, limited=limited,
                                                **keywords), stdout=out,
                                   stderr=err, stdin=subprocess.DEVNULL,
                                   env={**environment, "TMPDIR": own},
                                   start_new_session=True, preexec_fn=limit)
        process.files = out, err
        return process

    def finish(self, process, timeout=300):
        try:
            process.wait(timeout)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            raise Failure(f"it still runs after {timeout} seconds") from None
        texts = []
        for file in process.files:
            file.seek(0)
            texts.append(file.read())
            file.close()
        return Result(process.returncode, *texts)

    def run(self, *arguments, **keywords):
        """To its end, by a program that need not be loaded, if nothing is limited."""
        if "longest_file" not in keywords:
            keywords["program"] = self.options.loaded
        return self.finish(self.start(*arguments, **keywords))

    def processes_in(self, directory):
        """Those of the program, without their launcher."""
        found = []
        for path in Path("/proc").glob("[0-9]*"):
            try:
                if (os.readlink(path / "exe") == os.path.realpath(
                        self.options.program)
                        and f"Output/Directory={directory}".encode()
                        in (path / "cmdline").read_bytes().split(b"\0")):
                    found.append(int(path.name))
            except OSError:
                pass
        return sorted(found)

    # --- what has to hold -----------------------------------------------------

    def whole(self, n=None, levels=None):
        """A run that is left alone: its directory, output, and seconds."""
        key = (n or self.options.processes, levels or self.options.levels)
        if key not in self.wholes:
            directory = self.work / f"whole-{key[0]}-{key[1]}"
            begin = time.monotonic()
            # Always started anew: this is how long runs take that are to be killed.
            result = self.finish(self.start(directory, n=n, levels=levels))
            seconds = time.monotonic() - begin
            demand(result.status == 0, f"left alone it fails: {result}")
            steps = re.findall(r"^Load step \d+ of (\d+),", result.out, re.M)
            demand(len(rows_of(result.out)) == key[1] + int((steps or [1])[0]),
                   "rows are missing")
            self.wholes[key] = directory, result.out, seconds
        return self.wholes[key]

    def demand_whole_result(self, directory, result, n=None, levels=None):
        """Table and history are those of a run that was left alone. After a restart
        nodes have other numbers, so that cycles and last digits may differ."""
        demand(result.status == 0, f"status {result.status}: {result.err}")
        whole, out, _ = self.whole(n, levels)
        rows, wanted = rows_of(result.out), rows_of(out)
        demand(len(rows) == len(wanted), f"{len(rows)} rows")
        for row, other in zip(rows, wanted):
            demand(row[:6] == other[:6], f"row {row} instead of {other}")
            demand(abs(int(row[6]) - int(other[6])) <= 4, f"cycles in {row}")
            demand(abs(float(row[8]) - float(other[8]))
                   <= 1e-5 * abs(float(other[8])), f"energy in {row}")
        left = [name for name in os.listdir(directory)
                if ".part" in name or name == ".lock"]
        demand(not left, f"left over: {left}")
        if h5py:
            with h5py.File(whole / "history.h5") as a, \
                    h5py.File(Path(directory) / "history.h5") as b:
                for key in a["levels"]:
                    if re.search("seconds|cycles|contraction|certificate|algebraic",
                                 key):
                        continue
                    demand(numpy.allclose(a["levels"][key], b["levels"][key],
                                          rtol=1e-5, atol=1e-9), f"history: {key}")
                demand(sorted(a.get("forces", [])) == sorted(b.get("forces", [])),
                       "history: not the same forces")
                forces = [{key: values[()] for key, values in
                           file.get("forces", {}).items() if key != "level"}
                          for file in (a, b)]
                size = max((abs(f).max() for f in forces[0].values()), default=0)
                for key in forces[0]:
                    demand(numpy.allclose(forces[0][key], forces[1][key], rtol=0,
                                          atol=1e-5 * size), f"history: force {key}")
                for level in a["contact"]:
                    demand(numpy.array_equal(a["contact"][level]["state"],
                                             b["contact"][level]["state"]),
                           f"history: states of {level}")

    def demand_sentence(self, result, *patterns):
        demand(result.status == 2, f"status {result.status}")
        ours = [line for line in result.err.splitlines()
                if line.startswith(self.name + ": ")]
        demand(len(ours) == 1 and re.search(r"[.?]$", ours[0]),
               f"no sentence but: {result.err}")
        for pattern in patterns:
            demand(re.search(pattern, ours[0]), f"no '{pattern}' in: {ours[0]}")
        return ours[0]

    def verdict(self, name, function):
        try:
            remark = function()
            print(f"ok      {name}" + (f": {remark}" if remark else ""), flush=True)
        except (Failure, OSError) as failure:
            print(f"FAILED  {name}: {failure}", flush=True)
            self.failures += 1

    # --- damage ---------------------------------------------------------------

    def damages(self, file):
        """Functions that damage a file, with what to call them."""
        data = file.read_bytes()

        def flip(bit):
            damaged = bytearray(data)
            damaged[bit // 8] ^= 1 << bit % 8
            file.write_bytes(damaged)

        for _ in range(self.options.tries):
            bit = self.random.randrange(8 * len(data))
            yield "flipped", f"bit {bit} of {file.name}", lambda b=bit: flip(b)
        for _ in range(self.options.tries):
            length = self.random.randrange(1, len(data))
            yield ("cut", f"{file.name} after {length} bytes",
                   lambda n=length: file.write_bytes(data[:n]))
        yield "longer", file.name, lambda: file.write_bytes(data + b"\0")
        yield "empty", file.name, lambda: file.write_bytes(b"")
        yield "removed", file.name, file.unlink

    def continued(self, original, damage, **keywords):
        """The result of a run that continues from a damaged copy."""
        directory = self.work / "damaged"
        shutil.rmtree(directory, ignore_errors=True)
        shutil.copytree(original, directory)
        damage(directory)
        return directory, self.run(directory, "--restart", **keywords)

    def damage(self):
        whole, _, _ = self.whole()
        last = newest_checkpoint(whole)
        names = [f"checkpoint-{level:02}" for level in (last, last - 1)]
        demand(sorted(names) == sorted(name for name in os.listdir(whole)
                                       if name.startswith("checkpoint")),
               "not the last two checkpoints are kept")
        files = sorted(os.listdir(whole / names[0]))
        demand("manifest" in files and "record" in files, f"only {files}")
        copy = self.work / "copy"
        kinds = collections.Counter()

        def expect_older(directory, result, file):
            demand(f"Warning: the checkpoint '{directory}/{names[0]}' cannot be used"
                   in result.out, f"no warning: {result.out} {result.err}")
            demand(f"'{file}'" in result.out, f"{file} is not named: {result.out}")
            demand(f"continues from '{directory}/{names[1]}'" in result.out,
                   "the older one is not named")
            self.demand_whole_result(directory, result)

        def one_file(name):
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(whole, copy)
            for kind, what, change in self.damages(copy / names[0] / name):
                change()
                directory, result = self.continued(copy, lambda _: None)
                try:
                    expect_older(directory, result, name)
                except Failure as failure:
                    raise Failure(f"{kind}: {what}: {failure}") from None
                kinds[kind] += 1

        for name in files:
            self.verdict(f"damage to {name}: the checkpoint before it is used",
                         lambda name=name: one_file(name))

        def one_more_file():
            directory, result = self.continued(
                whole, lambda directory:
                (directory / names[0] / "more").write_text("more"))
            expect_older(directory, result, "more")

        def no_file_but_its_name():
            def damage(directory):
                shutil.rmtree(directory / names[0])
                (directory / names[0]).mkdir()
            directory, result = self.continued(whole, damage)
            expect_older(directory, result, "manifest")

        def exchanged():
            def damage(directory):
                (directory / names[0]).rename(directory / "between")
                (directory / names[1]).rename(directory / names[0])
                (directory / "between").rename(directory / names[1])
            _, result = self.continued(whole, damage)
            self.demand_sentence(result, "another level")

        def both(file, other):
            def damage(directory):
                for name, victim in zip(names, (file, other)):
                    path = directory / name / victim
                    data = bytearray(path.read_bytes())
                    data[self.random.randrange(len(data))] ^= 16
                    path.write_bytes(data)
            _, result = self.continued(whole, damage)
            sentence = self.demand_sentence(result, names[0], names[1], "begin anew")
            demand(f"'{file}'" in sentence and f"'{other}'" in sentence, sentence)
            demand(not result.out, f"on standard output: {result.out}")

        self.verdict("damage: a file too many", one_more_file)
        self.verdict("damage: an empty directory", no_file_but_its_name)
        self.verdict("damage: checkpoints exchanged", exchanged)
        for file in files:
            other = self.random.choice(files)
            self.verdict(f"damage to {file} and to {other} of the one before",
                         lambda file=file, other=other: both(file, other))
        print("damage: " + ", ".join(f"{n} {kind}" for kind, n in kinds.items()))

    # --- two runs in one directory --------------------------------------------

    def wait_for(self, condition, process):
        while not condition():
            demand(process.poll() is None, "it ended too early")
            time.sleep(.002)

    def lock(self):
        def stopped_run(directory):
            """A run in the middle of its work, with its lock."""
            process = self.start(directory)
            self.wait_for(lambda: (directory / ".lock").exists()
                          and (directory / ".lock").stat().st_size > 0, process)
            victims = self.processes_in(directory)
            for victim in victims:
                os.kill(victim, signal.SIGSTOP)
            return process, victims

        def second_run():
            directory = self.work / "locked"
            process, victims = stopped_run(directory)
            try:
                before = contents(directory)
                text = (directory / ".lock").read_text()
                for more in ([], ["--restart"]):
                    result = self.run(directory, *more, levels=0)
                    self.demand_sentence(
                        result, re.escape(f"directory '{directory}'"),
                        r"process \d+ on \S.*, since \d{4}-\d\d-\d\d \d\d:\d\d:\d\d "
                        "UTC", "Output/Directory")
                    demand(text in result.err, f"not '{text}' but {result.err}")
                    owner = int(re.search(r"process (\d+)", text).group(1))
                    demand(owner in victims, f"{owner} is not one of {victims}")
                    demand(contents(directory) == before, "files have changed")
            finally:
                for victim in victims:
                    os.kill(victim, signal.SIGCONT)
            self.demand_whole_result(directory, self.finish(process))

        def killed_run():
            directory = self.work / "unlocked"
            process, victims = stopped_run(directory)
            for victim in victims:
                os.kill(victim, signal.SIGKILL)
            self.finish(process)
            demand((directory / ".lock").exists(), "no lock is left to try")
            self.demand_whole_result(directory, self.run(directory))

        def after_an_error():
            directory = self.work / "error"
            result = self.run(directory, "--restart")
            self.demand_sentence(result, "no checkpoint")
            demand(os.listdir(directory) == [], f"left: {os.listdir(directory)}")

        self.verdict("lock: a second run", second_run)
        self.verdict("lock: of a run that was killed", killed_run)
        self.verdict("lock: nothing is left by a run that ends with an error",
                     after_an_error)

    # --- files of earlier runs ------------------------------------------------

    def stale(self):
        whole, _, _ = self.whole()
        foreign = {"notes.txt": b"mine", "body-5.vtu": b"mine",
                   "body-05.backup.vtu": b"mine", "contact.pvd.old": b"mine",
                   "my-body-01.pvtu": b"mine", "checkpoint-notes/record": b"mine"}
        left = {"verify-00.h5": b"old", "verify-07.h5": b"old",
                "body-01.h5": b"old", "body.xdmf": b"old",
                "body-123.pvtu": b"old", "body-01.0017.vtu": b"old",
                "contact-02.0001.part.vtu": b"old", "history.part.h5": b"old",
                ".writable-123-0": b"old", "checkpoint.part/record": b"old",
                "checkpoint-07.part/record": b"old", "checkpoint-09/record": b"old"}

        def used_directory(name):
            directory = self.work / name
            shutil.rmtree(directory, ignore_errors=True)
            shutil.copytree(whole, directory)
            for file, data in {**foreign, **left}.items():
                (directory / file).parent.mkdir(exist_ok=True)
                (directory / file).write_bytes(data)
            (directory / "contact-11.pvtu").mkdir()
            return directory

        def failing_at_once():
            directory = used_directory("stale")
            before = contents(directory)
            result = self.run(directory, "Contact/Boundary id=77")
            self.demand_sentence(result, "boundary id 77")
            demand(contents(directory) == before, "files have changed")

        def fewer_levels(*arguments):
            directory = used_directory("stale")
            fresh = self.work / "fresh"
            shutil.rmtree(fresh, ignore_errors=True)
            results = [self.run(where, *arguments, n=1, levels=1, checkpoint=False)
                       for where in (directory, fresh)]
            demand([r.status for r in results] == [0, 0], f"{results}")
            demand(results[0].out == results[1].out, "not the same output")
            found = contents(directory)
            for name, data in foreign.items():
                demand(found.pop(name, None) == data, f"{name} has been touched")
            demand((directory / "contact-11.pvtu").is_dir(), "a folder is gone")
            wanted = contents(fresh)
            demand(sorted(found) == sorted(wanted),
                   f"not the same files: {sorted(set(found) ^ set(wanted))}")
            for name in found:
                # Histories have the time that things took, lists that of the day.
                if not name.endswith((".h5", ".csv", ".pvd", ".pvtu")):
                    demand(found[name] == wanted[name], f"{name} is another one")
            for name in ("body.pvd", "body.xdmf", "contact.pvd"):
                if name in found:
                    listed = re.findall(rb'file="([^"]*)"|(body-\d+\.h5):',
                                        found[name])
                    listed = {(a or b).decode() for a, b in listed}
                    demand(listed and listed <= set(found), f"{name}: {listed}")

        def from_the_one_before():
            directory = used_directory("stale")
            last = newest_checkpoint(whole)
            shutil.rmtree(directory / "checkpoint-09")
            (directory / f"checkpoint-{last:02}" / "record").write_text("damaged")
            (directory / f"verify-{last - 2:02}.h5").write_text("of this run")
            result = self.run(directory, "--restart", levels=last - 1)
            demand(result.status == 0, f"{result}")
            demand("Warning" in result.out, "no warning")
            names = set(os.listdir(directory))
            late = {name for name in names
                    if name not in foreign
                    and re.match(r"(body|contact|verify|checkpoint)-\d\d", name)
                    and int(re.search(r"-(\d+)", name).group(1)) >= last}
            # Of the other format, which this run does not write: a folder, too.
            demand(late == {"contact-11.pvtu"}, f"still there: {late}")
            demand(not [name for name in names if ".part" in name], f"{names}")
            for name, data in foreign.items():
                demand((directory / name).read_bytes() == data, name)
            demand(f"verify-{last - 2:02}.h5" in names, "too much is gone")
            for name in ("body.pvd", "contact.pvd"):
                listed = re.findall(r'file="([^"]*)"',
                                    (directory / name).read_text())
                demand(len(listed) == last, f"{name}: {listed}")
                demand(set(listed) <= names, f"{name}: {listed}")

        self.verdict("stale: a run that fails at once leaves everything",
                     failing_at_once)
        self.verdict("stale: a run with fewer levels", fewer_levels)
        self.verdict("stale: a run in another format",
                     lambda: fewer_levels("Output/Format=hdf5"))
        self.verdict("stale: a run without fields",
                     lambda: fewer_levels("Output/Fields=false"))
        self.verdict("stale: a run from the checkpoint before the last",
                     from_the_one_before)

    # --- killed ---------------------------------------------------------------

    def some_format(self):
        """Of the fields, which may be another one after a restart."""
        return self.random.choice([["Output/Format=vtu"], ["Output/Format=hdf5"]])

    def kill_once(self, directory, restart, choose):
        """Start a run and kill what CHOOSE says at a random moment. Returns its
        result, and whether it was killed at all."""
        _, _, seconds = self.whole()
        process = self.start(directory, *(["--restart"] if restart else []),
                             *self.some_format())
        time.sleep(self.random.uniform(0., seconds))
        victims = choose(self.processes_in(directory))
        for victim in victims:
            try:
                os.kill(victim, signal.SIGKILL)
            except ProcessLookupError:
                pass
        result = self.finish(process, 120)
        # Those that are left end when they notice that their launcher has gone.
        for _ in range(100):
            if not self.processes_in(directory):
                break
            time.sleep(.1)
        else:
            raise Failure("some processes are still there")
        return result, bool(victims) and result.status != 0

    def kill_and_continue(self, directory, choose, again):
        """Returns how often the run was killed, and levels lost."""
        kills, lost, restart, n_rows = 0, 0, False, 0
        while True:
            result, was_killed = self.kill_once(directory, restart, choose)
            if not was_killed:
                break
            kills += 1
            n_rows = len(rows_of(result.out))
            level = (newest_checkpoint(directory) if directory.exists() else 0)
            demand(level >= n_rows - 1, f"{n_rows} rows, but checkpoint {level}")
            lost += max(0, n_rows - level)
            restart = level > 0
            if not restart:
                none = self.run(directory, "--restart")
                self.demand_sentence(none, "no checkpoint")
            if self.random.random() >= again:
                result = self.run(directory, *(["--restart"] if restart else []))
                break
        demand("Warning" not in result.out,
               f"a checkpoint is damaged: {result.out}")
        self.demand_whole_result(directory, result)
        return kills, lost

    def killed(self, name, choose, again=1 / 3):
        kills = lost = runs = 0

        def attempt():
            nonlocal kills, lost
            directory = self.work / "killed"
            shutil.rmtree(directory, ignore_errors=True)
            more = self.kill_and_continue(directory, choose, again)
            kills += more[0]
            lost += more[1]

        def everything():
            nonlocal runs
            while kills < self.options.tries:
                runs += 1
                demand(runs < 10 * self.options.tries, "always too late")
                try:
                    attempt()
                except Failure as failure:
                    raise Failure(f"in run {runs}: {failure}") from None
            return f"{kills} kills in {runs} runs, levels lost: {lost}"
        self.verdict(name, everything)

    def kill(self):
        self.killed(f"kill: {self.options.processes} processes, all of them",
                    lambda victims: victims)

    def lost(self):
        demand(self.options.processes > 1, "lost: needs several processes")
        self.killed(f"lost: one of {self.options.processes} processes",
                    lambda victims: self.random.sample(victims, min(1, len(victims))))

    # --- a full disk ----------------------------------------------------------

    def full(self):
        disk = self.work / "disk"
        disk.mkdir()
        mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=1M", "tmpfs", str(disk)],
            check=False, stderr=subprocess.DEVNULL).returncode == 0
        if not mounted:
            print("skipped full: no small file system can be mounted")
            return
        whole, _, _ = self.whole()
        size = sum(-(-path.stat().st_size // 4096) * 4096
                   for path in whole.rglob("*"))
        statuses = collections.Counter()

        def resize(n_bytes):
            demand(subprocess.run(["mount", "-o", f"remount,size={n_bytes}",
                                   str(disk)], check=False).returncode == 0,
                   "it cannot be mounted anew")

        def attempt():
            directory = disk / "run"
            shutil.rmtree(directory, ignore_errors=True)
            room = self.random.randrange(4096, size)
            resize(room)
            result = self.run(directory, *self.some_format())
            statuses[result.status] += 1
            demand(result.status != 0, f"{room} bytes have been enough")
            demand(re.search(r"cannot be|space|full", result.err),
                   f"{room} bytes: nothing is said of the disk: {result}")
            n_rows = len(rows_of(result.out))
            resize(10 * size)
            level = (newest_checkpoint(directory) if directory.exists() else 0)
            # A row is printed before its files are written.
            demand(level >= n_rows - 1, f"{n_rows} rows, but checkpoint {level}")
            if level > 0:
                result = self.run(directory, "--restart")
                demand("Warning" not in result.out, f"damaged: {result.out}")
            else:
                self.demand_sentence(self.run(directory, "--restart"),
                                     "no checkpoint")
                result = self.run(directory)
            self.demand_whole_result(directory, result)

        def everything():
            for i in range(self.options.tries):
                try:
                    attempt()
                except Failure as failure:
                    raise Failure(f"try {i + 1}: {failure}") from None
            return f"{self.options.tries} disks of up to {size} bytes, " + ", ".join(
                f"status {status}: {n}" for status, n in sorted(statuses.items()))
        try:
            self.verdict(f"full: {self.options.processes} processes", everything)
        finally:
            subprocess.run(["umount", str(disk)], check=False)

    def quota(self):
        whole, _, _ = self.whole()
        longest = max(path.stat().st_size for path in
                      whole.glob("checkpoint-*/mesh_fixed.data"))
        statuses = collections.Counter()

        def attempt():
            directory = self.work / "quota"
            shutil.rmtree(directory, ignore_errors=True)
            # Larger than what anything but checkpoints is, as far as possible.
            limit = self.random.randrange(longest // 16, longest)
            result = self.run(directory, "Output/Fields=false", longest_file=limit)
            statuses[result.status] += 1
            demand(result.status != 0, f"{limit} bytes have been enough")
            demand(result.status == 2 and "cannot be written" in result.err,
                   f"{limit} bytes: {result}")
            n_rows = len(rows_of(result.out))
            level = newest_checkpoint(directory)
            demand(level >= n_rows - 1, f"{n_rows} rows, but checkpoint {level}")
            if level > 0:
                result = self.run(directory, "--restart")
                demand("Warning" not in result.out, f"damaged: {result.out}")
            else:
                result = self.run(directory)
            self.demand_whole_result(directory, result)

        def everything():
            for i in range(self.options.tries):
                try:
                    attempt()
                except Failure as failure:
                    raise Failure(f"try {i + 1}: {failure}") from None
            return f"{self.options.tries} limits, " + ", ".join(
                f"status {status}: {n}" for status, n in sorted(statuses.items()))
        self.verdict(f"quota: {self.options.processes} processes", everything)


def in_namespace():
    """Start this script again where no other process sees its mounts."""
    if "FAULTS_NAMESPACE" in os.environ or not shutil.which("unshare"):
        return
    own = ["--mount"] if os.geteuid() == 0 else ["--map-root-user", "--mount"]
    if subprocess.run(["unshare", *own, "true"], check=False,
                      stderr=subprocess.DEVNULL).returncode == 0:
        os.environ["FAULTS_NAMESPACE"] = "1"
        os.execvp("unshare", ["unshare", *own, sys.executable, "-B", *sys.argv])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("scene")
    parser.add_argument("scenarios", nargs="+",
                        choices=["damage", "lock", "stale", "kill", "lost", "full",
                                 "quota"])
    parser.add_argument("--tries", type=int, default=2)
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--mpiexec")
    parser.add_argument("--numproc-flag", default="-np")
    parser.add_argument("--levels", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--entry", action="append", default=[])
    parser.add_argument("--loaded", metavar="PROGRAM", help="what runs in the place of the "
                        "program where it is left alone")
    options = parser.parse_args()
    if "full" in options.scenarios:
        in_namespace()
        options.loaded = None  # has not seen these mounts

    # Without a daemon for a single process, which would outlive it.
    if options.processes == 1:
        os.environ["OMPI_MCA_ess_singleton_isolated"] = "1"
    if not h5py:
        print("without h5py histories are not compared, but only tables")
    faults = Faults(options)
    try:
        for scenario in options.scenarios:
            try:
                getattr(faults, scenario)()
            except Failure as failure:
                print(f"FAILED  {scenario}: {failure}")
                faults.failures += 1
    finally:
        shutil.rmtree(faults.work, ignore_errors=True)
    return 0 if faults.failures == 0 else 1


sys.exit(main())
