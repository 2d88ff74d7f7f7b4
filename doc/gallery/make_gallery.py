"""The pictures of the page gallery.md: runs each shipped scene as it is, and draws its
body and its contact boundary.

Usage: make_gallery.py PROGRAM_2D PROGRAM_3D ROOT TARGET [NAME ... [--first-mesh]]
  ROOT    of the sources
  TARGET  folder for the pictures, NAME-2d.png or NAME-3d.png
  NAME    of single scenes; with --first-mesh on their first mesh only, for a test
"""
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

WIDTH, COLOURS = 760, 200


def scenes(root):
    for dim in (2, 3):
        for scene in sorted((root / f"step-friction-{dim}d" / "scenes").glob("*.prm")):
            yield dim, scene


def draw(root, directory, picture):
    subprocess.run([sys.executable, "-B",
                    str(root / "common" / "plot" / "friction_plot.py"), str(directory),
                    "--show", "body,contact", "-o", str(picture)],
                   check=True, stdout=subprocess.DEVNULL)
    # For a page that shows many of them.
    with Image.open(picture) as image:
        height = round(image.height * WIDTH / image.width)
        small = image.convert("RGB").resize((WIDTH, height), Image.LANCZOS)
    small.quantize(COLOURS, dither=Image.Dither.NONE).save(picture, optimize=True)


def main():
    arguments = [word for word in sys.argv[1:] if word != "--first-mesh"]
    programs = [pathlib.Path(word).resolve() for word in arguments[:2]]
    root, target = (pathlib.Path(word).resolve() for word in arguments[2:4])
    shorter = ["Refinement/Levels=0"] if "--first-mesh" in sys.argv else []
    chosen = arguments[4:]
    target.mkdir(parents=True, exist_ok=True)

    page = (root / "doc" / "gallery.md").read_text()
    names = [f"{scene.stem}-{dim}d" for dim, scene in scenes(root)]
    missing = [name for name in names if f"gallery/{name}.png" not in page]
    if missing:
        print("doc/gallery.md does not show", ", ".join(missing), file=sys.stderr)
        return 1
    for (dim, scene), name in zip(scenes(root), names):
        if chosen and name not in chosen:
            continue
        with tempfile.TemporaryDirectory() as directory:
            subprocess.run([str(programs[dim - 2]), str(scene), *shorter,
                            f"Output/Directory={directory}/{scene.stem}"],
                           check=True, stdout=subprocess.DEVNULL)
            draw(root, f"{directory}/{scene.stem}", target / f"{name}.png")
        print(name, flush=True)
    return 0


sys.exit(main())
