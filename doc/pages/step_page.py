"""Makes of a step program a page like those of deal.II's tutorial: introduction,
commented program, results, and the program without its comments."""

import re

import markup
import sites


def read(path):
    return (sites.ROOT / path).read_text()


def headings(text, page):
    """Headings in HTML and those of the programs, @sect3{...} and @sect4{...},
    get anchors, and so become part of the table of contents."""
    commands = {"1": "section", "3": "subsection", "4": "subsubsection"}

    def command(match):
        title = re.sub(r"</?(code|a)\b[^>]*>", "", match[2]).strip()
        label = re.sub(r"\W+", "_", title).strip("_")
        return f"@{commands[match[1]]} {page}_{label} {title}"

    text = re.sub(r'<a name="[^"]*"></a>\n?', "", text)
    text = re.sub(r"<h([13])>(.*?)</h\1>", command, text, flags=re.DOTALL)
    return re.sub(r"@sect([34])\{(.*)\}", command, text)


def without_margin(lines):
    """A piece of the program, without blank lines around it and moved to the
    left, where it is easier to read on small screens."""
    while lines and not lines[0].strip():
        lines = lines[1:]
    while lines and not lines[-1].strip():
        lines = lines[:-1]
    margin = min((len(line) - len(line.lstrip()) for line in lines
                  if line.strip()), default=0)
    return [line[margin:] for line in lines]


def is_comment(line):
    return line.lstrip().startswith("//")


def pieces(program):
    """Pairs of (whether a comment, its lines), in turn."""
    result = []
    for line in program.split("\n"):
        kind = is_comment(line)
        if not line.strip() and result:
            kind = False
        if not result or result[-1][0] != kind:
            result.append((kind, []))
        result[-1][1].append(line)
    return result


def commented(program, source, page, names):
    """Comments as prose and code as code. Comments at the end of a line stay
    where they are, as part of the code."""
    result = []
    for comment, lines in pieces(program):
        if comment:
            text = "\n".join(re.sub(r"^\s*// ?", "", line) for line in lines)
            text = headings(text, page)
            result.append(markup.documented(text, source, names) + "\n")
        else:
            lines = without_margin(lines)
            if lines:
                result += ["@code{.cpp}", *lines, "@endcode", ""]
    return "\n".join(result)


def plain(program):
    lines = [line for line in program.split("\n") if not is_comment(line)]
    text = "\n".join(lines)
    return re.sub(r"\n{3,}", "\n\n", text).strip("\n")


def page(source, names):
    """The page of the program `source`, as one comment for Doxygen."""
    step = source.split("/")[0]
    name = sites.page_of_step(step)
    program = read(source)
    if "*/" in program:
        raise ValueError(f"{source}: comments of a step program begin with //.")
    intro, results = f"{step}/doc/intro.dox", f"{step}/doc/results.dox"
    builds_on = ", ".join(markup.step(other, names) for other in
                          read(f"{step}/doc/builds-on").split())
    tooltip = read(f"{step}/doc/tooltip").strip()

    def part(path, anchor):
        text = headings(read(path), name)
        # The name of the part itself is known to links, whatever its title.
        text = re.sub(r"@section \S+", f"@section {name}_{anchor}", text, count=1)
        return markup.documented(text, path, names)

    text = "\n".join([
        f"@page {name} {step}",
        "@tableofcontents{HTML:3}",
        "",
        f"{tooltip}", "", f"It builds on {builds_on}.",
        "",
        part(intro, "intro"),
        "",
        f"@section {name}_program The commented program",
        "",
        commented(program, source, name, names),
        part(results, "results"),
        "",
        f"@section {name}_plain The plain program",
        "",
        "@code{.cpp}",
        plain(program),
        "@endcode",
    ])
    if "*/" in text:
        raise ValueError(f"{step}: '*/' in its prose would end the page.")
    return f"/**\n{text}\n*/\n"
