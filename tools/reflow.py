#!/usr/bin/env python3
"""Wraps paragraphs and list items of Markdown that have a line over 130 letters. Code, tables, headings, comments and HTML stay.

    python3 tools/reflow.py docs/faq.md ...
"""

import re
import sys
from pathlib import Path

WIDEST = 130
ITEM = re.compile(r"^(\s*)([-*+]|\d+[.)])\s+")
OTHER = re.compile(r"^\s*(\||#|<|>|!\[|```|~~~|\[[^\]]+\]: )")
# What would begin a list, a heading or a table where a line begins with it.
BEGINS = re.compile(r"^([-*+>|#]|\d+[.)]|=+$|-+$)")


def wrapped(lines):
    """A paragraph or list item in lines that are narrow enough."""
    if all(len(line) <= WIDEST for line in lines):
        return lines
    item = ITEM.match(lines[0])
    indent = re.match(r"\s*", lines[0])[0]
    hanging = " " * len(item[0]) if item else indent
    words = " ".join([lines[0][len(item[0]) if item else len(indent) :], *(line.strip() for line in lines[1:])]).split()
    rows, head = [], item[0] if item else indent
    row = []
    for word in words:
        if row and len(head) + len(" ".join([*row, word])) > WIDEST:
            # No line begins with what would make a list of it.
            carried = [word]
            while BEGINS.match(carried[0]) and len(row) > 1:
                carried.insert(0, row.pop())
            rows.append(head + " ".join(row))
            head, row = hanging, carried
        else:
            row.append(word)
    return [*rows, head + " ".join(row)]


def reflow(text):
    """A page with its paragraphs wrapped."""
    out, block, code = [], [], False

    def close():
        if block:
            out.extend(wrapped(block))
            block.clear()

    for line in text.split("\n"):
        fence = line.lstrip().startswith(("```", "~~~"))
        # A line that ends in two blanks or a backslash is broken on purpose.
        if fence or code or not line.strip() or OTHER.match(line) or line.endswith(("  ", "\\")):
            close()
            out.append(line)
            code ^= fence
        else:
            if ITEM.match(line):
                close()
            block.append(line)
    close()
    return "\n".join(out)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        path = Path(name)
        old = path.read_text()
        new = reflow(old)
        assert old.split() == new.split(), name
        if new != old:
            path.write_text(new)
            print(name)
