"""Links of HTML pages on the disk: what they lead to exists, with its anchor, and
nothing has to be fetched from elsewhere."""

import gzip
import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

# What a browser fetches by itself, and what a reader follows.
FETCHED = {"img": "src", "script": "src", "link": "href", "iframe": "src",
           "object": "data", "source": "src", "embed": "src"}
FOLLOWED = {"a": "href", "area": "href"}
NOT_FILES = {"javascript", "data", "mailto", "about"}


class _Reader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("id", "name"):
            if attributes.get(name):
                self.anchors.add(attributes[name])
        for kinds, fetched in ((FETCHED, True), (FOLLOWED, False)):
            target = attributes.get(kinds.get(tag, ""))
            if target:
                self.links.append((self.getpos()[0], target, fetched))


class Links:
    def __init__(self, folder):
        self.folder = Path(folder).resolve()
        self._anchors = {}

    def pages(self):
        return sorted(self.folder.glob("*.html"))

    def problems(self, page):
        """Pairs of line and sentence."""
        reader = _Reader()
        reader.feed(page.read_text(encoding="utf-8", errors="replace"))
        self._anchors[page] = reader.anchors
        for line, target, fetched in reader.links:
            problem = self._problem(page, target, fetched)
            if problem:
                yield line, problem

    def _problem(self, page, target, fetched):
        parts = urlsplit(target)
        if parts.scheme in NOT_FILES:
            return None
        if parts.scheme in ("http", "https") or (not parts.scheme and parts.netloc):
            return f"fetches '{target}' from the network" if fetched else None
        if parts.scheme not in ("", "file"):
            return f"'{target}' is no link to a file"
        file = page
        if parts.path:
            path = unquote(parts.path)
            if parts.scheme == "" and path.startswith("/"):
                return f"'{target}' works on one machine only"
            file = Path(path) if parts.scheme else page.parent / path
        if not file.exists():
            return f"'{target}' leads nowhere"
        anchor = unquote(parts.fragment)
        if anchor and file.is_file() and anchor not in self.anchors(file.resolve()):
            return f"'{target}': there is no anchor '{anchor}'"
        return None

    def anchors(self, file):
        if file not in self._anchors:
            text = (gzip.open(file, "rt", errors="replace").read()
                    if file.suffix == ".gz" else
                    file.read_text(encoding="utf-8", errors="replace"))
            self._anchors[file] = set(re.findall(
                r"\b(?:id|name)=[\"']([^\"']+)[\"']", text))
        return self._anchors[file]
