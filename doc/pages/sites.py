"""Where each file of the repository is found among the pages.

Paths are those of the repository, relative to its root, with '/'. Sites are
relative to the folder of the pages, in which all pages lie side by side."""

import posixpath
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# The page that a reader sees first.
START = "doc/start.md"
# The page that tells what the folders of the library have.
LIBRARY = "doc/library.md"
STEPS = ("step-friction-2d", "step-friction-3d")
# Files that browsers show as they are. To the names of all others '.txt' is
# added, because they would be downloaded and not shown.
SHOWN = (".png", ".svg", ".txt")


def page_of_step(step):
    return step.replace("-", "_")


def page(path):
    """The name of the page that is made of a file, or None. Names of pages are
    those of their files, so no two may have the same."""
    if path == START:
        return "index"
    for step in STEPS:
        if path in (f"{step}/{step}.cc", step):
            return page_of_step(step)
    if path == "common":
        return page(LIBRARY)
    if path.endswith(".md"):
        return posixpath.basename(path)[:-3].lower().replace("-", "_")
    return None


def slug(heading):
    """What GitHub makes of a heading, to be used as an anchor."""
    words = re.sub(r"<[^>]*>|`", "", heading).strip().lower()
    return re.sub(r"[^\w\- ]", "", words).replace(" ", "-")


def anchor(page_name, heading_slug):
    """Anchors are unique among all pages."""
    return f"{page_name}_{heading_slug.replace('-', '_')}"


def resolve(target, source):
    """The path that a link of the file `source` leads to."""
    if target.startswith("/"):
        return target.strip("/")
    return posixpath.normpath(posixpath.join(posixpath.dirname(source), target))


def is_library(path):
    """Whether Doxygen makes pages of its own of a file."""
    return path.startswith("common/") and path.endswith((".h", ".cc"))


def section_of_step(path):
    """Introduction and results are parts of the page of their step."""
    for step in STEPS:
        for part in ("intro", "results"):
            if path == f"{step}/doc/{part}.dox":
                return (page_of_step(step), part)
    return None


def asset(path):
    """The site of a file that is copied."""
    if (ROOT / path).is_dir():
        return f"files/{path}/index.html"
    if path.endswith(SHOWN):
        return f"files/{path}"
    return f"files/{path}.txt"


def site(path, heading_slug=""):
    """The site of a file, other than those of the library."""
    part = section_of_step(path)
    if part is not None:
        return f"{part[0]}.html#{part[0]}_{part[1]}"
    name = page(path)
    if name is None:
        return asset(path)
    if heading_slug:
        return f"{name}.html#{anchor(name, heading_slug)}"
    return f"{name}.html"
