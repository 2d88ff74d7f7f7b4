"""What a page of prose contains: inline code, links, pictures, headings and
fenced code, each with the line where it begins. Pages are Markdown (.md) or
Doxygen's comments with HTML (.dox)."""

import html
import re
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Fragment:
    line: int
    text: str


@dataclass
class Block:
    """Fenced or indented code. The notes are the comments right before it."""
    line: int
    language: str
    text: str
    notes: list = field(default_factory=list)


class Page:
    def __init__(self, path, text=None):
        self.path = Path(path)
        text = self.path.read_text(encoding="utf-8") if text is None else text
        self.code, self.links, self.pictures = [], [], []
        self.anchors, self.blocks, self.problems = set(), [], []
        self.headings = []  # their lines
        self._slugs = {}
        if self.path.suffix == ".dox":
            text = self._take_doxygen_blocks(text)
        else:
            text = self._take_fences(text)
            text = self._take_indented(text)
        text = self._take_html_code(text)
        text = self._take_backquotes(text)
        self._read_headings(text)
        self._read_links(text)
        self.code.sort(key=lambda fragment: fragment.line)
        # Folders that commands of the page make, and fill.
        self.made_folders = {
            folder.strip("'/") for block in self.blocks for folder in re.findall(
                r"\bmkdir (?:-p )?(\S+)|Output/Directory=(\S+)", block.text)
            for folder in folder if folder}

    # Blocks are replaced by as many empty lines, so that line numbers stay.
    @staticmethod
    def _blank(match):
        return "\n" * match.group(0).count("\n")

    @staticmethod
    def _line(text, position):
        return text.count("\n", 0, position) + 1

    def _notes_before(self, lines, index):
        """Comments on lines of their own that end right before a block."""
        notes = []
        while index > 0:
            previous = lines[index - 1].strip()
            if previous.startswith("<!--") and previous.endswith("-->"):
                notes.insert(0, previous[4:-3].strip())
            elif previous:
                break
            index -= 1
        return notes

    def _take_fences(self, text):
        lines = text.split("\n")
        kept, index = [], 0
        while index < len(lines):
            opening = re.match(r"\s*(```+|~~~+)\s*([\w.-]*)\s*$", lines[index])
            if not opening:
                kept.append(lines[index])
                index += 1
                continue
            end = index + 1
            while (end < len(lines)
                   and not lines[end].strip().startswith(opening.group(1))):
                end += 1
            if end == len(lines):
                self.problems.append(Fragment(
                    index + 1, "a fenced block that is not closed"))
            self.blocks.append(Block(
                index + 2, opening.group(2), "\n".join(lines[index + 1:end]),
                self._notes_before(lines, index)))
            kept += [""] * (min(end, len(lines) - 1) - index + 1)
            index = end + 1
        # A comment may show a fence; only now it can be told from one.
        return re.sub(r"<!--.*?-->", self._blank, "\n".join(kept), flags=re.S)

    def _take_indented(self, text):
        kept, block, in_list, blank = [], None, False, True
        for number, line in enumerate(text.split("\n"), 1):
            indented = line.startswith("    ") and not in_list
            if line.strip() and indented and (blank or block):
                if not block:
                    block = Block(number, "indented", "")
                    self.blocks.append(block)
                block.text += line[4:] + "\n"
                kept.append("")
            else:
                if line.strip():
                    block = None
                    if re.match(r"\s*([-*+]|\d+\.)\s", line):
                        in_list = True
                    elif not line.startswith(" "):
                        in_list = False
                kept.append(line)
            blank = not line.strip()
        return "\n".join(kept)

    def _take_doxygen_blocks(self, text):
        lines = text.split("\n")
        for match in re.finditer(
                r"@code(?:\{\.?(\w+)\})?[ \t]*\n(.*?)@endcode", text, re.S):
            first = self._line(text, match.start())
            self.blocks.append(Block(
                first + 1, {"txt": "table"}.get(match.group(1),
                                                match.group(1) or "sh"),
                match.group(2).rstrip("\n"),
                self._notes_before(lines, first - 1)))
        text = re.sub(r"@code.*?@endcode", self._blank, text, flags=re.S)
        text = re.sub(r"@f\[.*?@f\]|@f\{.*?@f\}", self._blank, text, flags=re.S)
        return re.sub(r"<!--.*?-->", self._blank, text, flags=re.S)

    def _take_html_code(self, text):
        for match in re.finditer(r"<code>(.*?)</code>", text, re.S):
            self.code.append(Fragment(
                self._line(text, match.start()),
                " ".join(html.unescape(match.group(1)).split())))
        return re.sub(r"<code>.*?</code>", self._hide, text, flags=re.S)

    @staticmethod
    def _hide(match):
        """Keeps the place, and forgets what stands there."""
        return re.sub(r"[^\n]", "x", match.group(0))

    def _take_backquotes(self, text):
        pattern = r"(?<!`)(`+)(?!`)((?:(?!\n[ \t]*\n).)+?)(?<!`)\1(?!`)"
        for match in re.finditer(pattern, text, re.S):
            self.code.append(Fragment(self._line(text, match.start()),
                                      " ".join(match.group(2).split())))
        self._spans = {match.start(): match.group(2)
                       for match in re.finditer(pattern, text, re.S)}
        self._unhidden = text
        text = re.sub(pattern, self._hide, text, flags=re.S)
        for match in re.finditer("`", text):
            self.problems.append(Fragment(
                self._line(text, match.start()),
                "a backquote without its partner"))
        return text

    def _read_headings(self, text):
        # Slugs need the words that have been hidden.
        original = self._unhidden
        for pattern in r"^#{1,6} +(.*?) *#* *$", r"<h\d[^>]*>(.*?)</h\d>":
            for match in re.finditer(pattern, original, re.M):
                self.headings.append(self._line(original, match.start()))
                self._add_slug(match.group(1))
        for match in re.finditer(r"\b(?:name|id)=\"([^\"]+)\"", text):
            self.anchors.add(match.group(1))

    def _add_slug(self, heading):
        slug = slug_of(heading)
        count = self._slugs.get(slug, 0)
        self._slugs[slug] = count + 1
        self.anchors.add(slug if count == 0 else f"{slug}-{count}")

    def _read_links(self, text):
        for match in re.finditer(r"(!?)\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+)\)",
                                 text):
            self._add_link(text, match.start(), match.group(2), match.group(1))
        # A picture within a link.
        for match in re.finditer(r"\[!\[[^\]]*\]\(([^()\s]+)\)", text):
            self._add_link(text, match.start(), match.group(1), "!")
        for match in re.finditer(r"<(a|img)\b[^>]*?\b(?:href|src)=\"([^\"]*)\"",
                                 text):
            self._add_link(text, match.start(), match.group(2),
                           "!" if match.group(1) == "img" else "")

    def _add_link(self, text, position, target, picture):
        fragment = Fragment(self._line(text, position), target)
        (self.pictures if picture else self.links).append(fragment)


def slug_of(heading):
    """The anchor that GitHub makes of a heading."""
    heading = re.sub(r"<[^>]*>", "", heading)
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    heading = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return heading.replace(" ", "-")
