"""Runs a scene with many values of an entry or two."""

import csv
import hashlib
import itertools
import json
import os
import re
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from failure import Failure
from history import Run, quantity
from sweep_options import find_program
from write_picture import check_ending, write_picture

RECORD = "sweep.json"
NAME = "friction-plot"


class Sweep:
    """All runs of a sweep. `axes` are pairs of an entry and its values; `scene` and
    `entries` are the same for all; `command` is what a run begins with: the program,
    maybe after mpirun. `directory` has a directory for each run."""

    def __init__(self, options):
        self.directory = options.directory or Path(f"sweep-{options.scene.stem}")
        self.axes = [(axis[0], axis[1:]) for axis in options.axes]
        check(options, self.axes)
        self.scene, self.entries = options.scene, options.entries
        self.command = []
        if not options.draw:
            program = find_program(options)
            if program is None:
                raise Failure("the program that runs the scene was not found; name it "
                              "by --program.")
            self.command = [program]
            if options.processes > 1:
                self.command = ["mpirun", "-np", str(options.processes), program]
        self.results = {}
        self._stopped = threading.Event()
        self._processes = set()
        self._lock = threading.Lock()

    def points(self):
        """All combinations of values."""
        return list(itertools.product(*(values for _, values in self.axes)))

    def place(self, point):
        """The directory of a run. What would not do as its name is replaced, by
        something that no other value is replaced by."""
        parts = []
        for value in point:
            name = re.sub(r"[^\w.+=-]+", "_", value)[:40]
            if name != value or name in ("", ".", ".."):
                name += "-" + hashlib.sha1(value.encode()).hexdigest()[:6]
            parts.append(name)
        return self.directory / ",".join(parts)

    def settings(self, point):
        return self.entries + [f"{entry}={value}"
                               for (entry, _), value in zip(self.axes, point)]

    def question(self, point):
        """What a run has been asked: if this is the same, so is the answer."""
        return {"scene": hashlib.sha1(self.scene.read_bytes()).hexdigest(),
                "entries": self.settings(point)}

    def known(self, point):
        """What has come out of a run, {'status': 0, 'message': ''} for example, or None
        if it has not ended yet, or has been asked something else."""
        try:
            record = json.loads((self.place(point) / RECORD).read_text())
            if record.pop("question") == self.question(point):
                return record
        except (OSError, ValueError, KeyError, AttributeError):
            pass
        return None

    def run(self, point):
        """Runs the scene at a point, unless that has been done."""
        record = self.known(point)
        if record is None and not self._stopped.is_set():
            record = self._run(point)
        if record is None:
            return
        with self._lock:
            self.results[point] = record
            said = record["message"] if record["status"] != 0 else "done"
            print(f"{', '.join(point)}: {said}", flush=True)

    def _run(self, point):
        directory = self.place(point)
        directory.mkdir(parents=True, exist_ok=True)
        (directory / RECORD).unlink(missing_ok=True)
        with open(directory / "console.txt", "w", encoding="utf-8") as console:
            with self._lock:
                if self._stopped.is_set():
                    return None
                # Of a group of its own: what ends friction-plot does not end it half.
                process = subprocess.Popen(
                    self.command + [str(self.scene)] + self.settings(point)
                    + [f"Output/Directory={directory}"],
                    stdin=subprocess.DEVNULL, stdout=console,
                    stderr=subprocess.STDOUT, start_new_session=True)
                self._processes.add(process)
            status = process.wait()
        with self._lock:
            self._processes.discard(process)
        # Who was stopped, by us or by the system, has given no answer.
        if self._stopped.is_set():
            return None
        if status < 0 or status > 128:
            return {"status": status, "message": f"ended by signal {abs(status) % 128}"}
        record = {"status": status, "message": ""}
        if status != 0:
            record["message"] = last_words(directory / "console.txt", status)
        # Left by a friction-plot that was killed, it may be at work still.
        if record["message"].startswith("Another run is writing"):
            return record
        write_then_rename(directory / RECORD, json.dumps(
            {"question": self.question(point), **record}, indent=1))
        return record

    def stop(self):
        with self._lock:
            self._stopped.set()
            for process in self._processes:
                try:
                    os.killpg(process.pid, 15)
                except ProcessLookupError:
                    pass

    def run_all(self, jobs):
        """Returns whether it was not interrupted."""
        self.directory.mkdir(parents=True, exist_ok=True)
        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(self.run, point) for point in self.points()]
            try:
                for future in futures:
                    future.result()
            except KeyboardInterrupt:
                for future in futures:
                    future.cancel()
                self.stop()
                return False
        return True

    def read(self):
        """For each run the columns of its last level; None where there is a hole. A
        pair with the first run that can be read, for units, or None."""
        table, example = {}, None
        for point in self.points():
            record = self.results.setdefault(
                point, self.known(point) or {"status": 2, "message": "not run yet"})
            table[point] = None
            if record["status"] == 0:
                try:
                    run = Run(self.place(point))
                    table[point] = run.row(run.last)
                    example = example or run
                except Failure as failure:
                    record.update(status=2, message=str(failure))
        return table, example

    def write_table(self, table, example):
        """sweep.csv: entries, what became of the run, and all columns of the level."""
        columns = list(example.levels) if example else []
        path = self.directory / "sweep.csv"
        part = path.with_suffix(".part.csv")
        with open(part, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([entry for entry, _ in self.axes] + ["message"] + [
                example.axis(name, f"levels/{name}") for name in columns])
            for point, row in table.items():
                writer.writerow(list(point) + [self.results[point]["message"]] + [
                    "" if row is None else f"{row[name]:.12g}" for name in columns])
        part.replace(path)
        return path


def check(options, axes):
    """Raises Failure."""
    if not options.scene.is_file():
        raise Failure(f"there is no scene file '{options.scene}'.")
    if len(axes) > 2:
        raise Failure("a sweep has one entry or two; draw several of them instead.")
    for entry, values in axes:
        if "/" not in entry or "=" in entry:
            raise Failure(f"'{entry}' is no entry; it is written as "
                          "--set 'Contact/Friction coefficient' 0.1 0.2.")
        if len(values) == 0:
            raise Failure(f"'{entry}' has no values; they follow it, as in "
                          f"--set '{entry}' 0.1 0.2.")
        if len(set(values)) < len(values):
            raise Failure(f"'{entry}' has a value twice.")
    if len(axes) == 2 and axes[0][0] == axes[1][0]:
        raise Failure(f"'{axes[0][0]}' is set twice.")
    for entry in options.entries:
        if "=" not in entry:
            raise Failure(f"'{entry}' is no entry with its value; it is written as "
                          "'Section/Entry=value', before the first --set.")
        if entry.split("=")[0].strip() in [axis for axis, _ in axes] + [
                "Output/Directory"]:
            raise Failure(f"'{entry}' is set by the sweep.")


def last_words(path, status):
    """The line with which a run has said why it failed."""
    lines = [line.strip() for line in
             path.read_text(encoding="utf-8", errors="replace").splitlines()]
    for beginning in (r"step-friction-\dd: ", "No (convergence|solution)"):
        for line in reversed(lines):
            if re.match(beginning, line):
                return re.sub(r"^step-friction-\dd: ", "", line)[:300]
    return f"exit status {status}; see {path}"


def write_then_rename(path, text):
    part = path.with_name(path.name + ".part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


def sweep(options):
    """Runs, writes and draws; returns the exit status. Raises Failure."""
    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))
    runs = Sweep(options)
    shown = options.show or ["max_pressure"]
    output = check_ending(options.output) if options.output else None
    finished = options.draw or runs.run_all(options.jobs)
    table, example = runs.read()
    if not finished:
        done = sum(row is not None for row in table.values())
        print(f"{NAME}: interrupted after {done} of {len(table)} runs; the same command "
              "goes on from here.", file=sys.stderr)
        return 130
    print(runs.write_table(table, example))
    if example is None:
        first = runs.results[runs.points()[0]]["message"]
        raise Failure(f"all {len(table)} runs have failed, the first one with: {first}")
    for name in shown:
        quantity(example.row(example.last), name)
    from draw_sweep import draw_sweep

    output = output or check_ending(runs.directory / "sweep.png")
    write_picture(draw_sweep(runs, table, example, shown), output)
    print(output)
    return 0 if all(row is not None for row in table.values()) else 1
