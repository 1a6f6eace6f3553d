#!/usr/bin/env python3
"""Draws the graph of includes between the folders of core and dae, and compares it with docs/reference/rooms.md.

    tests/rooms.py [TOP]

The drawing's table has one row a room, a room below those it includes: so there is no circle. One line for each arrow
that the drawing does not have, has without cause, or has against its order, and exit status 1. Standard library alone.
With --table it prints the table's last column as the source has it.
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
    """Rooms in their order, and the arrows."""
    rooms, drawn = [], set()
    for line in text.split("\n"):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")] if line.startswith("| `") else []
        names = [re.findall(r"`([^`]+)`", cell) for cell in cells]
        if cells:
            rooms.append(names[0][0])
            drawn.update((names[0][0], name) for name in names[-1])
    return rooms, drawn


def main():
    asked = [a for a in sys.argv[1:] if not a.startswith("--")]
    top = Path(asked[0] if asked else Path(__file__).parents[1]).resolve()
    found = arrows(top)
    if "--table" in sys.argv:
        for room in sorted({a for pair in found for a in pair}):
            print(f"{room}: " + " ".join(f"`{b}`" for a, b in sorted(found) if a == room))
        return 0
    rooms, drawn = drawing((top / DRAWING).read_text(encoding="utf-8"))
    faults = []
    for (a, b), files in sorted(found.items()):
        example = f"{files[0][0]} includes {files[0][1]}"
        if (a, b) not in drawn:
            faults.append(f"'{a}' → '{b}': {example}; expected an arrow that {DRAWING} has")
        elif a in rooms and b in rooms and rooms.index(b) > rooms.index(a):
            faults.append(f"'{a}' → '{b}': {example}, against the order of {DRAWING}; expected '{b}' above '{a}'")
    faults += [f"'{a}' → '{b}' is in {DRAWING}; no file includes so" for a, b in sorted(drawn - set(found))]
    faults += [f"'{room}' has no row in {DRAWING}" for room in sorted({a for pair in found for a in pair} - set(rooms))]
    print("\n".join([*faults, f"{len(rooms)} rooms, {len(found)} arrows, {len(faults)} faults"]))
    return 1 if faults or not found else 0


if __name__ == "__main__":
    sys.exit(main())
