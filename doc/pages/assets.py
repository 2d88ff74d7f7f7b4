#!/usr/bin/env python3
"""Completes the folder of pages, so that it can be moved and read offline:

    assets.py FOLDER MATHJAX

copies the pictures and files that pages link to, under files/, and what is
needed of MathJax (version 2), under mathjax/; and takes out links of
Doxygen's that are wrong or lead nowhere: where all classes within a class are
private, it links to a list of them that it does not write."""

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


REDIRECTION = """<!DOCTYPE html>
<html lang="en"><head><meta charset="UTF-8">
<meta http-equiv="refresh" content="0; url={page}.html">
<link rel="icon" href="data:,"><title>{page}</title></head>
<body><h1><a href="{page}.html">{page}</a></h1></body></html>
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


def without_pages(folder):
    """The files of prose that have no page: their filter has failed, which
    Doxygen does not notice."""
    prose = [sites.ROOT / "README.md", *(sites.ROOT / "doc").rglob("*.md"),
             *(sites.ROOT / step / f"{step}.cc" for step in sites.STEPS)]
    names = [path.relative_to(sites.ROOT).as_posix() for path in prose]
    return [name for name in names
            if '<div class="title">' not in text_of(folder, sites.page(name))]


def text_of(folder, page):
    path = folder / f"{page}.html"
    return path.read_text() if path.is_file() else ""


def lead_to_pages(folder):
    """For each file Doxygen writes a page on what is defined in it. For prose that
    is nothing, and the page of the prose itself is shown instead."""
    for path in folder.glob("*_8md.html"):
        name = path.name[:-len("_8md.html")].replace("__", "_") + ".md"
        page = "index" if sites.START.endswith("/" + name) else sites.page(name)
        if (folder / f"{page}.html").is_file():
            path.write_text(REDIRECTION.format(page=page))


def with_heading(folder):
    """The title of a page is its heading, for readers of the screen, too."""
    for path in folder.glob("*.html"):
        text = path.read_text()
        if '<div class="title">' in text:
            path.write_text(text.replace(
                '<div class="title">',
                '<div class="title" role="heading" aria-level="1">'))


def without_wrong_links(folder):
    """In the programs of the steps Doxygen takes variables for members and values
    of the library that have the same name."""
    for step in sites.STEPS:
        page = folder / f"{sites.page_of_step(step)}.html"
        page.write_text(re.sub(
            r'<a class="code hl_(?:enumvalue|variable)"[^>]*>([^<]*)</a>', r"\1",
            page.read_text()))


def without_dead_links(folder):
    for page in folder.glob("*.html"):
        text = page.read_text()
        for anchor in set(re.findall(r'<a href="#([\w-]+)">[^<]*</a> &#124;', text)):
            if f'name="{anchor}"' not in text and f'id="{anchor}"' not in text:
                page.write_text(re.sub(
                    rf'<a href="#{anchor}">[^<]*</a> &#124;\s*', "", text))


def main():
    folder, mathjax = Path(sys.argv[1]), Path(sys.argv[2])
    shutil.rmtree(folder / "files", ignore_errors=True)
    missing = without_pages(folder)
    if missing:
        sys.exit("There is no page of " + ", ".join(missing) + "; try filter.py on "
                 "them, which says why.")
    try:
        lead_to_pages(folder)
        with_heading(folder)
        without_dead_links(folder)
        without_wrong_links(folder)
        for link in wanted(folder):
            copy(folder, link)
        for part in MATHJAX:
            source, target = mathjax / part, folder / "mathjax" / part
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, dirs_exist_ok=True)
            elif source.is_file():
                shutil.copyfile(source, target)
    except OSError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
