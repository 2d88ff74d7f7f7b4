#!/usr/bin/env python3
"""Mends what Doxygen has made of our pages:

    mend.py FOLDER

Fails if the page of some prose is missing. Pages on files that have nothing but
prose lead to the prose, titles become headings, and links that are wrong or lead
nowhere are taken out, as is MathJax where there are no formulas."""

import re
import sys
from pathlib import Path

import sites

REDIRECTION = """<!DOCTYPE html>
<html lang="en"><head><meta charset="UTF-8">
<meta http-equiv="refresh" content="0; url={page}.html">
<link rel="icon" href="data:,"><title>{page}</title></head>
<body><h1><a href="{page}.html">{page}</a></h1></body></html>
"""


def without_pages(folder):
    """The files of prose that have no page: their filter has failed, which
    Doxygen does not notice."""
    prose = [sites.ROOT / "README.md", sites.ROOT / "CONTRIBUTING.md",
             *(sites.ROOT / "doc").rglob("*.md"),
             *(sites.ROOT / step / f"{step}.cc" for step in sites.STEPS)]
    names = [path.relative_to(sites.ROOT).as_posix() for path in prose]
    return [name for name in names
            if '<div class="title"' not in text_of(folder, sites.page(name))]


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
    """Where all classes within a class are private, Doxygen links to a list of them
    that it does not write."""
    for page in folder.glob("*.html"):
        text = page.read_text()
        for anchor in set(re.findall(r'<a href="#([\w-]+)">[^<]*</a> &#124;', text)):
            if f'name="{anchor}"' not in text and f'id="{anchor}"' not in text:
                text = re.sub(rf'<a href="#{anchor}">[^<]*</a> &#124;\s*', "", text)
                page.write_text(text)


def without_idle_mathjax(folder):
    """Pages without formulas need not wait for MathJax."""
    for page in folder.glob("*.html"):
        text = page.read_text()
        mended = re.sub(r'<script type="text/x-mathjax-config">.*?</script>\s*|'
                        r'<script [^>]*src="[^"]*MathJax\.js"[^>]*></script>\s*', "", text,
                        flags=re.S)
        if mended != text and r"\(" not in mended and r"\[" not in mended:
            page.write_text(mended)


def main():
    folder = Path(sys.argv[1])
    missing = without_pages(folder)
    if missing:
        sys.exit("There is no page of " + ", ".join(missing) + "; try filter.py on "
                 "them, which says why.")
    lead_to_pages(folder)
    with_heading(folder)
    without_dead_links(folder)
    without_wrong_links(folder)
    without_idle_mathjax(folder)


if __name__ == "__main__":
    main()
