#!/usr/bin/env python3
"""Draws the graph of includes between the folders of core and dae, and compares it with docs/reference/rooms.md.

    tests/rooms.py [TOP]

The drawing's first table has one row a room, a room below those it includes; its second table has the arrows that go the
other way, and so close circles. One line for each arrow that the drawing does not have, or has without cause, and exit
status 1. Standard library alone. With --table it prints the first table's last column as the source has it.
"""
import re
import sys
from pathlib import Path

DRAWING = "docs/reference/rooms.md"
INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^">]+)[">]', re.MULTILINE)


def arrows(top):
    """{(room, room): [(file, file), …]} of all includes that cross from one folder to another."""
    found = {}
    for part in ("core", "dae"):
        for file in sorted((top / part).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
                aim = top / name.removeprefix("momenta/") if name.startswith("momenta/") else file.parent / name
                if not aim.is_file():
                    continue  # a library's
                a, b = (p.parent.relative_to(top).as_posix() for p in (file, aim.resolve()))
                if a != b:
                    found.setdefault((a, b), []).append((file.relative_to(top), aim.resolve().relative_to(top)))
    return found


def drawing(text):
    """Rooms in their order, the arrows of the first table, and those of the second."""
    rooms, drawn, back = [], set(), set()
    for line in text.split("\n"):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("| `") else []
        names = [re.findall(r"`([^`]+)`", cell) for cell in cells]
        if cells and "→" in cells[0]:
            back.add(tuple(names[0]))
        elif cells:
            rooms.append(names[0][0])
            drawn.update((names[0][0], name) for name in names[-1])
    return rooms, drawn, back


def main():
    asked = [a for a in sys.argv[1:] if not a.startswith("--")]
    top = Path(asked[0] if asked else Path(__file__).parents[1]).resolve()
    found = arrows(top)
    if "--table" in sys.argv:
        for room in sorted({a for pair in found for a in pair}):
            print(f"{room}: " + " ".join(f"`{b}`" for a, b in sorted(found) if a == room))
        return 0
    rooms, drawn, back = drawing((top / DRAWING).read_text(encoding="utf-8"))
    faults = []
    for (a, b), files in sorted(found.items()):
        example = f"{files[0][0]} includes {files[0][1]}"
        if (a, b) not in drawn | back:
            faults.append(f"'{a}' → '{b}': {example}; expected an arrow that {DRAWING} has")
        elif (a, b) in drawn and b in rooms and rooms.index(b) > rooms.index(a):
            faults.append(f"'{a}' → '{b}': {example}, against the order of {DRAWING}; expected it below '{b}', or no circle")
    faults += [f"'{a}' → '{b}' is in {DRAWING}; no file includes so" for a, b in sorted((drawn | back) - set(found))]
    faults += [f"'{room}' has no row in {DRAWING}" for room in sorted({a for pair in found for a in pair} - set(rooms))]
    print("\n".join([*faults, f"{len(rooms)} rooms, {len(found)} arrows, {len(back)} of them in known circles, {len(faults)} faults"]))
    return 1 if faults or not found else 0


if __name__ == "__main__":
    sys.exit(main())
