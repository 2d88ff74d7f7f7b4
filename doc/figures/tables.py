"""What all tables have in common."""

import re
import sys


def show(value, text="{}"):
    return "-" if value is None else text.format(value)


def write(tables, output, document):
    """Each of the tables, which are functions without arguments by name, goes to
    a text file in the folder `output`, and to the place that is marked for it in
    `document`."""
    text = document.read_text()
    for name, make in tables.items():
        table = make()
        (output / f"{name}.txt").write_text(table + "\n")
        print(table + "\n")
        text, n = re.subn(
            rf"(<!-- {re.escape(name)}\.txt -->\n@code\{{\.txt\}}\n).*?(@endcode)",
            lambda match: match.group(1) + table + "\n" + match.group(2),
            text, flags=re.S)
        if n > 1:
            sys.exit(f"{document}: more than one place for {name}.txt")
    document.write_text(text)
