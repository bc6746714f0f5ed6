"""Prepares a public header for Doxygen: filter.py HEADER prints the header.

The first comment of the header becomes the text of the header's page. In comments the characters <, >, \\ and % are
written such that Doxygen takes them as they stand.
SPDX-License-Identifier: MIT
"""
import re
import sys


def plain(text: str) -> str:
    """The text of a comment, in which pieces in backquotes stay as they are."""
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"[<>\\]", r"\\\g<0>", part).replace("%", "%%")
                   for part in parts)


with open(sys.argv[1], encoding="utf-8") as file:
    lines = file.read().split("\n")
head = next(at for at, line in enumerate(lines) if not line.startswith("//"))
for at, line in enumerate(lines):
    if at < head:
        text = "" if "SPDX" in line else plain(line[2:])
        lines[at] = ("/// @file\n///" if at == 0 else "///") + text
    else:
        found = re.match(r"(.*?///<?)(.*)$", line)
        if found:
            lines[at] = found.group(1) + plain(found.group(2))
print("\n".join(lines), end="")
