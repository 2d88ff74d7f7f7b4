"""Whatever is wrong is one sentence, and no trace of Python."""

import os

from workshop import Workshop

workshop = Workshop()
run, _ = workshop.run(2, "block", "run", "Refinement/Levels=0",
                      "Refinement/Initial refinements=2")
bare, _ = workshop.run(2, "block", "bare", "Refinement/Levels=0", "Output/Fields=false",
                       "Refinement/Initial refinements=2")


def refused(what, *arguments, words, environment=None):
    status, out, error = workshop.plot(*arguments, environment=environment)
    lines = error.strip().splitlines()
    workshop.check(
        status == 2 and len(lines) == 1 and not out and words in error
        and lines[0].startswith("friction-plot: ") and lines[0].endswith("."),
        what, f"{status}: {out} {error}")


refused("no such directory", "nowhere", words="there is no directory 'nowhere'")
empty = workshop.folder / "empty"
empty.mkdir()
refused("a directory without a run", empty, words="no run has finished a level")
damaged = workshop.folder / "damaged"
damaged.mkdir()
contents = (run / "history.h5").read_bytes()
for name, data in (("an empty history", b""), ("a text", b"hello\n" * 100),
                   ("half a history", contents[:len(contents) // 2])):
    (damaged / "history.h5").write_bytes(data)
    refused(name, damaged, words="damaged, or of another version")
(damaged / "history.h5").write_bytes(contents)
(damaged / "body-00.pvtu").write_bytes((run / "body-00.pvtu").read_bytes())
refused("fields that are gone", damaged, words="cannot be read")
(damaged / "body-00.0000.vtu").write_bytes(b"<VTKFile")
refused("fields that are damaged", damaged, words="cannot be read")
refused("no such level", run, "--level", "7", words="its last one is 0")
refused("no such panel", run, "--show", "body,soul", words="there are body, contact")
refused("no such field", run, "--field", "joy", words="there is no field 'joy'")
refused("the body without fields", bare, "--show", "body", words="no fields of level 0")
refused("a picture of no kind", run, "-o", "picture.txt", words="ends in none of")
refused("a picture nowhere", run, "-o", "nowhere/picture.png", words="no directory")
refused("an empty range", run, "--range", "1", "1", words="range")
refused("a level of several runs", run, bare, "--level", "0", words="of one run")
scene = workshop.scene(2, "block")
refused("no scene", "sweep", "none.prm", "--set", "A/b", "1", words="no scene file")
refused("an entry without values", "sweep", scene, "--set", "A/b", words="no values")
refused("no entry", "sweep", scene, "--set", "A", "1", words="is no entry")
refused("a value twice", "sweep", scene, "--set", "A/b", "1", "1", words="twice")
refused("three entries", "sweep", scene, "--set", "A/b", "1", "--set", "A/c", "1",
        "--set", "A/d", "1", words="one entry or two")
refused("an entry of a sweep", "sweep", scene, "A/b=2", "--set", "A/b", "1",
        words="set by the sweep")
refused("no program", "sweep", scene, "--program", "none", "--set", "A/b", "1",
        words="was not found")

# Modules that are not there.
for module, package in (("h5py", "python3-h5py"), ("matplotlib", "python3-matplotlib")):
    fake = workshop.folder / f"without-{module}"
    fake.mkdir()
    (fake / f"{module}.py").write_text(f"raise ImportError(name='{module}')\n")
    refused(f"no {module}", run, words=f"install {package}",
            environment=dict(os.environ, PYTHONPATH=str(fake)))

for arguments in ([], ["--frobnicate", run], ["sweep", scene]):
    status, _, error = workshop.plot(*arguments)
    workshop.check(status == 2 and "usage: friction-plot" in error
                   and "Traceback" not in error, f"usage after {len(arguments)} words",
                   error)
for arguments in (["--help"], ["sweep", "--help"]):
    status, out, _ = workshop.plot(*arguments)
    workshop.check(status == 0 and "Exit status" in out, f"{' '.join(arguments)}")

# What there is can be drawn without fields.
status, out, error = workshop.plot(bare)
workshop.check(status == 0 and (bare / "picture.png").is_file(), "a run without fields",
               error)
workshop.end()
