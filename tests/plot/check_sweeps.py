"""A sweep has the runs that it should have, goes on where it was interrupted, and shows
what has failed."""

import csv
import os
import re
import signal
import subprocess
import sys
import time

from workshop import PLOT, Workshop, is_picture

from history import Run

workshop = Workshop()
check = workshop.check
environment = dict(os.environ, FRICTION_PROGRAMS=os.path.dirname(workshop.programs[2]))
FRICTION = "Contact/Friction coefficient"
QUICK = ["Refinement/Levels=3", "Output/Fields=false"]


def sweep(*arguments):
    return workshop.plot("sweep", *arguments, environment=environment)


def table(directory):
    """Rows by column, without units."""
    with open(directory / "sweep.csv", encoding="utf-8") as file:
        return [{name.split(" [")[0]: value for name, value in row.items()}
                for row in csv.DictReader(file)]


# One entry, one value of which is impossible.
scene = workshop.scene(2, "hertz")
one = workshop.folder / "one"
command = [scene, *QUICK, "--set", FRICTION, "0", "0.2", "-1", "0.4",
           "--show", "max pressure", "--show", "stick_half_width / contact_half_width",
           "-d", one]
status, out, error = sweep(*command)
check(status == 1 and is_picture(one / "sweep.png"), "a sweep with a hole", f"{out} {error}")
rows = table(one)
check([row[FRICTION] for row in rows] == ["0", "0.2", "-1", "0.4"], "its rows")
check("-1" in rows[2]["message"] and rows[2]["max_pressure"] == ""
      and not any(row["message"] for i, row in enumerate(rows) if i != 2),
      "the hole has a message, and no number", rows[2])
for row in (rows[0], rows[1], rows[3]):
    run = Run(one / row[FRICTION])
    own = run.row(run.last)
    check(all(abs(float(row[name]) - own[name]) <= 1e-11 * abs(own[name])
              for name in own), f"the row of F = {row[FRICTION]} is that of its run")
alone, _ = workshop.run(2, "hertz", "alone", *QUICK, f"{FRICTION}=0.2")
check(abs(float(rows[1]["energy"]) - Run(alone).levels["energy"][-1]) < 1e-15,
      "and that of the program by itself")


def times(directory):
    return {path.parent.name: path.stat().st_mtime_ns
            for path in directory.glob("*/history.h5")}


before = times(one)
status, out, _ = sweep(*command)
check(status == 1 and times(one) == before, "a second time nothing is run")
more = [word if word != "0.4" else "0.8" for word in command[:-2]] + ["-d", one]
sweep(*more)
after = times(one)
check(set(after) == set(before) | {"0.8"} and all(after[name] == before[name]
                                                  for name in before),
      "with another value only that is run")
copy = workshop.folder / "changed.prm"
copy.write_text(re.sub(r"(set Poisson ratio *=).*", r"\1 0.3", scene.read_text()))
sweep(copy, *command[1:])
check(all(times(one)[name] > before[name] for name in before),
      "with another scene everything is run again")
status, out, error = sweep(*command, "--show", "joy")
check(status == 2 and "there is no quantity 'joy'" in error
      and "max_pressure" in error, "no such quantity", error)

# Two entries, two at a time.
two = workshop.folder / "two"
status, out, error = sweep(scene, *QUICK, "--set", FRICTION, "0.1", "0.4", "--set",
                           "Boundary conditions/Displacement", "1: 0, -0.003",
                           "1: 0, -0.006", "--jobs", "2", "-d", two,
                           "-o", workshop.folder / "map.svg")
rows = table(two)
check(status == 0 and len(rows) == 4 and b"<svg" in
      (workshop.folder / "map.svg").read_bytes(), "a map", error)
check(len({row["max_pressure"] for row in rows}) == 4
      and len([path for path in two.iterdir() if path.is_dir()]) == 4,
      "with a run for each pair")
check(float(rows[1]["normal_force"]) > 1.5 * float(rows[0]["normal_force"]),
      "whose numbers follow the entries")
status, _, error = sweep(scene, *QUICK, "--set", FRICTION, "-1", "-2", "-d",
                         workshop.folder / "bad")
check(status == 2 and "all 2 runs have failed" in error, "when all fail", error)

# Three dimensions, on two processes, and a quotient of nothing.
status, _, error = sweep(workshop.scene(3, "block"), "Refinement/Levels=0", "--set",
                         FRICTION, "0.2", "0.6", "--processes", "2", "-d",
                         workshop.folder / "three")
check(status == 0, "a sweep in space, on two processes", error)

# Interrupted, and continued.
slow = workshop.folder / "slow"
arguments = [scene, "Refinement/Levels=5", "Output/Fields=false", "--set", FRICTION,
             "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "-d", slow]
for how in (signal.SIGINT, signal.SIGTERM):
    finished = len(list(slow.glob("*/sweep.json")))
    with subprocess.Popen([sys.executable, "-B", str(PLOT / "friction_plot.py"), "sweep",
                           *map(str, arguments)], cwd=workshop.folder, env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as process:
        deadline = time.time() + 120
        while (len(list(slow.glob("*/sweep.json"))) < finished + 1
               and time.time() < deadline):
            time.sleep(0.01)
        process.send_signal(how)
        _, error = process.communicate()
    done = len(list(slow.glob("*/sweep.json")))
    check(process.returncode == 130 and "the same command goes on" in error
          and "Traceback" not in error and finished < done < 6,
          f"interrupted after {'some' if done else 'no'} runs", f"{done}: {error}")
    check(not list(slow.glob("*/.lock")), "no run is left behind")
before = times(slow)
records = {path.parent.name for path in slow.glob("*/sweep.json")}
status, out, error = sweep(*arguments)
check(status == 0 and len(table(slow)) == 6, "and finished", error)
check(all(times(slow)[name] == before[name] for name in records),
      "without what had been done")
status, out, _ = sweep(*arguments, "--draw")
check(status == 0 and "done" not in out, "only drawn")
workshop.end()
