#!/usr/bin/env python3
"""Completes the folder of pages, so that it can be moved and read offline:

    assets.py FOLDER MATHJAX

copies the pictures and files that pages link to, under files/, and what is
needed of MathJax (version 2), under mathjax/."""

import html
import re
import shutil
import sys
from pathlib import Path

import sites

# MathJax reads TeX and draws SVG; the rest of it stays away.
MATHJAX = ("MathJax.js", "config/TeX-AMS_SVG-full.js", "extensions",
           "jax/element", "jax/input/TeX", "jax/output/SVG/autoload",
           "jax/output/SVG/fonts/TeX", "jax/output/SVG/jax.js",
           "jax/output/SVG/config.js")

LISTING = """<!DOCTYPE html>
<html lang="en"><head><meta charset="UTF-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="icon" href="data:,"><title>{name}</title>
<link href="{up}style.css" rel="stylesheet" type="text/css"></head>
<body><div class="contents"><h1>{name}</h1><ul>
{entries}
</ul></div></body></html>
"""


def wanted(folder):
    """All that pages expect under files/."""
    found = set()
    for page in folder.glob("*.html"):
        for link in re.findall(r'(?:href|src)="(files/[^"#]*)', page.read_text()):
            found.add(html.unescape(link))
    return sorted(found)


def original(link):
    """The file of the repository behind a link, a folder for its list."""
    path = link[len("files/"):]
    if path.endswith("/index.html"):
        return sites.ROOT / path[:-len("/index.html")]
    if path.endswith(".txt") and not (sites.ROOT / path).exists():
        path = path[:-len(".txt")]
    return sites.ROOT / path


def copy(folder, link):
    source, target = original(link), folder / link
    if source.is_dir():
        entries = []
        for path in sorted(source.iterdir()):
            if path.is_file() and not path.name.startswith("."):
                name = path.relative_to(sites.ROOT).as_posix()
                copy(folder, sites.asset(name))
                address = Path(sites.asset(name)).name
                entries.append(f'<li><a href="{html.escape(address)}">'
                               f"{html.escape(path.name)}</a></li>")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(LISTING.format(
            name=source.relative_to(sites.ROOT).as_posix(),
            up="../" * link.count("/"), entries="\n".join(entries)))
        return
    if not source.is_file():
        raise FileNotFoundError(f"A page links to {source.name}, which is not in "
                                f"{source.parent}.")
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, target)


def main():
    folder, mathjax = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder / "files", ignore_errors=True)
    try:
        for link in wanted(folder):
            copy(folder, link)
        for part in MATHJAX:
            source, target = mathjax / part, folder / "mathjax" / part
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, dirs_exist_ok=True)
            else:
                shutil.copyfile(source, target)
    except OSError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
