#!/usr/bin/env python3
"""What Doxygen reads instead of a file of the repository:

    filter.py [--dealii] FILE

Step programs become pages, with introduction and results; pages in Markdown
and the library's files get their formulas and links. --dealii: there is a tag
file of deal.II, to whose steps prose may link."""

import re
import sys
from pathlib import Path

import markup
import sites
import step_page


def classes():
    """Classes and structures of the library that have a page of their own: those
    at the outermost level of the namespace."""
    return {name for path in sites.ROOT.glob("common/**/*.h")
            for name in re.findall(
                r"^  (?:class|struct) (\w+)(?: final)?(?:$| : )",
                path.read_text(), flags=re.MULTILINE)}


def main():
    arguments = sys.argv[1:]
    dealii = "--dealii" in arguments
    path = Path(arguments[-1]).resolve()
    source = path.relative_to(sites.ROOT).as_posix()
    try:
        if source.startswith("common/"):
            text = markup.library(path.read_text())
        elif source.endswith(".md"):
            text = markup.markdown(path.read_text(), source,
                                   markup.Names(classes(), dealii))
        else:
            text = step_page.page(source, markup.Names(classes(), dealii))
    except (ValueError, OSError) as error:
        sys.exit(f"{source}: {error}")
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
