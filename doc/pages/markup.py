"""Turns the prose of the repository, Markdown as GitHub shows it and the pages
of the steps in the style of deal.II, into what Doxygen understands.

What differs: formulas between dollar signs, anchors of headings, links to files,
which lead to pages here, and pictures. Names of classes of the library, of
steps and of files in the prose become links."""

import html
import re

import sites


class Names:
    """What becomes a link by its name alone. classes: of the library. steps and
    files: whether they do. dealii: whether deal.II has pages."""

    def __init__(self, classes, dealii, steps=True, files=True):
        self.classes = classes
        self.dealii = dealii
        self.steps = steps
        self.files = files


# Within the text of a link nothing is a link.
NO_NAMES = Names(frozenset(), dealii=False, steps=False, files=False)


# One alternative per kind of text; what matches none stays as it is.
INLINE = re.compile(r"""
    (?P<comment> <!--.*?--> )
  | (?P<code> `[^`]+` | <code>.*?</code> )
  | (?P<verbatim> @f\[.*?@f\] | @f\{.*?@f\} | @f\$.*?@f\$ )
  | (?P<display> \$\$(?P<display_text>.+?)\$\$ )
  | (?P<formula> \$(?P<formula_text>[^$]+?)\$ )
  | (?P<picture> !\[(?P<picture_text>[^\]]*)\]\((?P<picture_target>[^)\s]+)\)
               | <img\s[^>]*?> )
  | (?P<link> \[(?P<link_text>(?:[^\[\]`]|`[^`]*`)+)\]\((?P<link_target>[^)\s]+)\) )
  | (?P<bold> \*\*(?=\S)(?P<bold_text>.+?)(?<=\S)\*\*(?!\*) )
  | (?P<emphasis> (?<![\w*])\*(?=[^\s*])(?P<emphasis_text>[^*]*?[^\s*])\*(?![\w*]) )
  | (?P<step> (?<![\w/-])step-(?:\d+|friction-[23]d)(?![\w/-]|\.\w) )
""", re.VERBOSE | re.DOTALL)


def formula(text):
    return f"@f${' '.join(text.split())}@f$"


def picture(target, text, source):
    """A picture that is scaled to the width of the page, and can be looked at in
    its own size. What is written in raw HTML, Doxygen leaves alone."""
    where = html.escape(sites.site(sites.resolve(target, source)))
    return (f'@htmlonly<a class="picture" href="{where}"><img src="{where}" '
            f'alt="{html.escape(" ".join(text.split()))}"></a>@endhtmlonly')


def link_to_class(name, text=""):
    return f"<code>@ref {name} \"{text or name}\"</code>"


def code(text, source, names):
    """Code in the text: of a class or a file it is a link."""
    content = (text[6:-7] if text.startswith("<code>") else text[1:-1])
    content = html.unescape(" ".join(content.split()))
    name = content.partition("::")[0]
    if name in names.classes:
        return link_to_class(name, content)
    if names.files and re.fullmatch(r"[\w./-]+\.\w+|common", content):
        for path in (sites.resolve(content, source), content):
            if (sites.ROOT / path).exists() and not path.startswith(".."):
                return link(path, f"<code>{html.escape(content)}</code>", source)
    # Doxygen takes a quote after a single backtick for the end of a quotation.
    ticks = "``" if "'" in content else "`"
    return f"{ticks}{content}{ticks}"


def link(path, text, source, heading=""):
    if sites.is_library(path):
        plain = re.sub(r"<[^>]*>|`", "", text)
        return f'@ref {path} "{plain}"'
    return f'<a href="{html.escape(sites.site(path, heading))}">{text}</a>'


def step(name, names):
    if names.steps and name in sites.STEPS:
        return f'<a href="{sites.page_of_step(name)}.html">{name}</a>'
    if names.dealii:
        return f'@ref {name.replace("-", "_")} "{name}"'
    return name


def inline(text, source, names):
    """Text without headings and blocks of code."""

    def replace(match):
        kind = next(name for name in ("comment", "code", "verbatim", "display",
                                      "formula", "picture", "link", "bold", "emphasis",
                                      "step")
                    if match[name] is not None)
        if kind == "comment":
            return ""
        if kind == "code":
            return code(match[0], source, names)
        if kind == "display":
            return f"@f[{match['display_text']}@f]"
        if kind == "formula":
            return formula(match["formula_text"])
        if kind == "picture":
            if match["picture_target"] is not None:
                return picture(match["picture_target"], match["picture_text"],
                               source)
            attributes = dict(re.findall(r'(\w+)="([^"]*)"', match[0]))
            return picture(attributes["src"], attributes.get("alt", ""), source)
        if kind == "link":
            target, _, heading = match["link_target"].partition("#")
            content = inline(match["link_text"], source, NO_NAMES)
            if re.match(r"\w+:", match["link_target"]):
                return f'<a href="{match["link_target"]}">{content}</a>'
            path = sites.resolve(target, source) if target else source
            name = match["link_text"].strip("`")
            if sites.is_library(path) and name in names.classes:
                return link_to_class(name)
            return link(path, content, source, heading)
        if kind in ("bold", "emphasis"):
            tag = "b" if kind == "bold" else "em"
            content = inline(match[f"{kind}_text"], source, names)
            return f"<{tag}>{content}</{tag}>"
        if kind == "step":
            return step(match[0], names)
        return match[0]

    return INLINE.sub(replace, text)


def blocks(text, begin, end):
    """Pairs of (whether a block of code, its lines)."""
    lines, inside = [], False
    for line in text.split("\n"):
        stripped = line.strip()
        if not inside and stripped.startswith(begin):
            yield False, lines
            lines, inside = [line], True
        elif inside and stripped.startswith(end):
            yield True, lines + [line]
            lines, inside = [], False
        else:
            lines.append(line)
    if inside:
        raise ValueError("A block of code has no end.")
    yield False, lines


def fenced(lines):
    """A fenced block, as one of Doxygen's, which knows fewer languages."""
    language = {"cpp": "{.cpp}", "c++": "{.cpp}"}.get(
        lines[0].strip().strip("`"), "{.unparsed}")
    indent = lines[0][:len(lines[0]) - len(lines[0].lstrip())]
    return [f"{indent}@code{language}", *lines[1:-1], f"{indent}@endcode"]


def markdown(text, source, names):
    """A whole page in Markdown. Longer ones get a table of contents."""
    name = sites.page(source)
    result = []
    headings = 0

    def heading(match):
        nonlocal headings
        level, title = match[1], match[2].strip()
        title = inline(title, source, names)
        title = re.sub(r"</?(a|code)\b[^>]*>", "", title)
        if level == "#":
            label = "" if name == "index" else f" {{#{name}}}"
            return f"# {title}{label}\n\n@tableofcontents\n"
        headings += 1
        label = sites.anchor(name, sites.slug(match[2]))
        return f"{level} {title} {{#{label}}}"

    for is_code, lines in blocks(text, "```", "```"):
        if is_code:
            result += fenced(lines)
        else:
            chunk = inline_with_headings("\n".join(lines), source, names, heading)
            result.append(chunk)
    # A line that begins with a year and a dot is no item of a list.
    page = re.sub(r"^( *\d{3,})\. ", r"\1\\. ", "\n".join(result),
                  flags=re.MULTILINE)
    if headings < 4:
        page = page.replace("@tableofcontents\n", "", 1)
    return page


def inline_with_headings(text, source, names, heading):
    parts = re.split(r"^(#{1,4} .*)$", text, flags=re.MULTILINE)
    for i, part in enumerate(parts):
        if i % 2:
            parts[i] = re.sub(r"^(#{1,4}) (.*)$", heading, part)
        else:
            parts[i] = inline(part, source, names)
    return "".join(parts)


def documented(text, source, names):
    """Prose of a step, with blocks between @code and @endcode."""
    result = []
    for is_code, lines in blocks(text, "@code", "@endcode"):
        chunk = "\n".join(lines)
        if is_code:
            result.append(re.sub(r"^@code\{\.(txt|sh)\}", "@code{.unparsed}",
                                 chunk))
        else:
            result.append(inline(chunk, source, names))
    return "\n".join(result)


def library(text):
    """A file of the library. In its comments there are formulas between dollar
    signs. Its namespace is left out, so that Doxygen finds its classes in the
    programs that are using it, and so are deal.II's, and explicit instantiations,
    in which it would look for functions. No line is added or lost."""
    text = re.sub(r"\$([^$]+?)\$", r"@f$\1@f$", text)
    text = re.sub(r"^namespace Friction$\n^\{$", "\n", text, flags=re.MULTILINE)
    text = re.sub(r"^\} // namespace Friction$", "", text, flags=re.MULTILINE)
    text = re.sub(r"\b(?:dealii|Friction)::(?!\s)", "", text)
    return re.sub(r"^ *template (?!<)[^;]*;",
                  lambda match: "\n" * match[0].count("\n"), text,
                  flags=re.MULTILINE)
