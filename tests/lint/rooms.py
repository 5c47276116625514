#!/usr/bin/env python3
"""Holds the table of rooms in docs/architecture.md to the includes of the source, both ways.

The table goes from the bottom up: a room includes only rooms above it in the table, so there is no circle. Every room that
"may include" names is included by some file; every include is named there. Every folder with sources is a room, or is
inside of one that is not in lib/tandem.

usage: rooms.py ROOT
"""

import collections
import pathlib
import re
import sys

from lint import CPP, Report, files, search, without_comments

TOPS = ("lib/tandem", "cpu", "cuda", "apps", "tests")
SHORT = "lib/tandem/"  # is left out in "may include"
# Where the compiler looks for quoted includes, beside the folder of the file.
INCLUDE_PATHS = ("lib", "", "apps", "apps/bench", "tests")
ALL = "all above"
NONE = "none"


def read_table(page):
    """{room: set of the rooms that it may include, or ALL}, in the order of the rows."""
    section = page.partition("\n## Rooms\n")[2].partition("\n## ")[0]
    table = {}
    for room, allowed in re.findall(r"^\| `([\w/]+)` \|[^|\n]*\|([^|\n]*)\|$", section, re.M):
        names = [name.strip() for name in allowed.split(",")]
        table[room] = ALL if names == [ALL] else set() if names == [NONE] else set(names)
    return table


def room_of(folder, table):
    """The row of a folder, or None. In the library a folder is a room of its own."""
    if folder.startswith(SHORT):
        return folder if folder in table else None
    while folder and folder not in table:
        folder = folder.rpartition("/")[0]
    return folder or None


def find_included(root, path, name):
    """The path of an included file of ours, or None."""
    for place in (path.rpartition("/")[0], *INCLUDE_PATHS):
        found = root / place / name
        if found.is_file():
            resolved = found.resolve()
            return resolved.relative_to(root).as_posix() if resolved.is_relative_to(root) else None
    return None


def find_arrows(root, table, report):
    """{(room, included room): a place where}. Reports folders that are no rooms."""
    arrows, lost, rooms = {}, set(), set()
    for path, text in files(root, TOPS, CPP):
        room = room_of(path.rpartition("/")[0], table)
        rooms.add(room)
        if room is None:
            lost.add(path.rpartition("/")[0])
            continue
        for line, match in search(without_comments(text), r'(?m)^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]'):
            included = find_included(root, path, match.group(1))
            if included and included.startswith(tuple(top + "/" for top in TOPS)):
                other = room_of(included.rpartition("/")[0], table)
                if other is not None and other != room:
                    arrows.setdefault((room, other), f"{path}:{line}")
    for folder in sorted(lost):
        report.add(folder, "is no room: the table in docs/architecture.md has no row for it")
    for room in table:
        if room not in rooms:
            report.add("docs/architecture.md", f"the room {room} has no sources")
    return arrows


def check(root, report):
    """Adds what is wrong to the report; returns the number of rooms and of arrows."""
    table = read_table((root / "docs/architecture.md").read_text())
    if not table:
        report.add("docs/architecture.md", "has no table of rooms under '## Rooms'")
    arrows = find_arrows(root, table, report)
    order = list(table)
    allowed = collections.defaultdict(set)
    for room, names in table.items():
        for name in () if names == ALL else sorted(names):
            full = name if name in table else SHORT + name
            if full not in table:
                report.add("docs/architecture.md", f"{room} may include '{name}', which is no room")
            elif order.index(full) >= order.index(room):
                report.add("docs/architecture.md", f"{room} may include {name}, which is not above it in the table")
            elif (room, full) not in arrows:
                report.add("docs/architecture.md", f"{room} may include {name}, and no include does")
            allowed[room].add(full)
    for (room, other), where in sorted(arrows.items()):
        if table[room] != ALL and other not in allowed[room]:
            report.add(where, f"{room} includes {other}, which the table in docs/architecture.md does not allow")
        elif table[room] == ALL and order.index(other) >= order.index(room):
            report.add(where, f"{room} includes {other}, which is not above it in the table in docs/architecture.md")
    return len(table), len(arrows)


def main():
    report = Report()
    rooms, arrows = check(pathlib.Path(sys.argv[1]).resolve(), report)
    report.finish(f"{rooms} rooms, {arrows} arrows between them")


if __name__ == "__main__":
    main()
