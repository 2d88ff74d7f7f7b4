#!/usr/bin/env python3
"""Takes from the tag file of deal.II's documentation what our pages link to:

    dealii_tag.py TAG OUTPUT

These are its classes, the functions of its namespaces, and its steps; not the
files, modules, members and specialisations, which are most of it, which Doxygen
would need a minute to read, and some of which it does not understand. TAG may be
compressed by gzip."""

import gzip
import sys
import xml.etree.ElementTree as ElementTree


def wanted(compound, namespaces):
    kind = compound.get("kind")
    name = compound.findtext("name")
    if kind == "page":
        return name.startswith("step_")
    # Of a class within a class Doxygen would think that the latter is a namespace.
    scope = name.rpartition("::")[0]
    return (kind in ("class", "struct", "namespace") and "<" not in name and
            (scope == "" or scope in namespaces))


def has_functions(namespace):
    """Others have functions with names that programs give to variables."""
    return namespace.endswith("Tools") or namespace.startswith("Utilities")


def main():
    tag, output = sys.argv[1:]
    with (gzip.open if tag.endswith(".gz") else open)(tag, "rb") as file:
        root = ElementTree.parse(file).getroot()
    namespaces = {compound.findtext("name") for compound in root
                  if compound.get("kind") == "namespace"}
    for compound in list(root):
        if not wanted(compound, namespaces):
            root.remove(compound)
            continue
        known = set()
        for child in list(compound):
            if child.tag == "member":
                name = child.findtext("name")
                keep = (compound.get("kind") == "namespace" and
                        has_functions(compound.findtext("name")) and
                        child.get("kind") == "function" and name not in known)
                known.add(name)
                if not keep:
                    compound.remove(child)
            elif child.tag not in ("name", "filename", "title", "templarg",
                                   "base"):
                compound.remove(child)
    ElementTree.ElementTree(root).write(output, encoding="UTF-8",
                                        xml_declaration=True)


if __name__ == "__main__":
    main()
