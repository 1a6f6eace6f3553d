#!/usr/bin/env python3
"""Draws the graph of includes between the rooms of core and dae, their folders, and compares it with
docs/reference/rooms.md; looks for circles between the folders of a room, for files outside rooms, and for two types of one
name in headers, that linkers would take for one.

    tests/rooms.py [TOP]

The drawing's table has one row a room, a room below those it includes: so there is no circle. One line for each arrow
that the drawing does not have, has without cause, or has against its order, and exit status 1. Standard library alone.
With --table it prints the table's last column as the source has it, with --svg the picture, docs/figures/rooms.svg:
rooms in layers, each below those it includes, without arrows that follow from others.
"""
import re
import sys
from pathlib import Path

DRAWING = "docs/reference/rooms.md"
PICTURE = "docs/figures/rooms.svg"
TYPE = re.compile(r"^(?:namespace ([\w:]+) \{|(?:struct|class|enum|enum class) (\w+)(?: final)?(?: : .*)? *\{)", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s+[<"]([^">]+)[">]', re.MULTILINE)


def room_of(folder):
    """The room of a folder: what stands directly in core or dae."""
    return "/".join(folder.split("/")[:2])


def arrows(top, place=room_of):
    """{(room, room): [(file, file), …]} of all includes that cross from one room to another, or one folder."""
    found = {}
    for part in ("core", "dae"):
        for file in sorted((top / part).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            for name in INCLUDE.findall(file.read_text(encoding="utf-8")):
                aim = top / name.removeprefix("momenta/") if name.startswith("momenta/") else file.parent / name
                if not aim.is_file():
                    continue  # a library's
                a, b = (place(p.parent.relative_to(top).as_posix()) for p in (file, aim.resolve()))
                if a != b:
                    found.setdefault((a, b), []).append((file.relative_to(top), aim.resolve().relative_to(top)))
    return found


def circles(top):
    """Folders that need themselves by way of others."""
    found = arrows(top, lambda folder: folder)
    below = {a: {d for c, d in found if c == a} for pair in found for a in pair}
    return sorted(folder for folder in below if folder in reached(folder, below))


def loose(top):
    """Sources outside rooms."""
    return [f"{part}/{file.name}" for part in ("core", "dae") for file in sorted((top / part).glob("*"))
            if file.suffix in (".h", ".cpp")]


def namesakes(top):
    """[(type, [header, …])] of types that more than one header defines in one namespace."""
    found = {}
    for part in ("core", "dae"):
        for file in sorted((top / part).rglob("*.h")):
            space = ""
            for opened, name in TYPE.findall(file.read_text(encoding="utf-8")):
                if opened:
                    space = opened
                else:
                    found.setdefault(f"{space}::{name}", []).append(file.relative_to(top).as_posix())
    return [(name, files) for name, files in sorted(found.items()) if len(files) > 1]


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


def reached(room, below):
    """All rooms that one needs, itself left out."""
    seen, left = set(), list(below[room])
    while left:
        if (b := left.pop()) not in seen:
            seen.add(b)
            left += below[b]
    return seen


def depths(rooms, below):
    """The layer of each room, from 0. @pre no circle, rooms in their order"""
    depth = {}
    for room in rooms:  # what it includes stands before it
        depth[room] = 1 + max((depth[b] for b in below[room]), default=-1)
    return depth


def picture(rooms, drawn):
    """The layers as SVG. @pre as of depths"""
    below = {room: {b for a, b in drawn if a == room} for room in rooms}
    depth = depths(rooms, below)
    high, gap, letter, step = 26, 18, 7.4, 62
    layers = [[r for r in rooms if depth[r] == k] for k in range(max(depth.values()) + 1)]
    wide = {room: letter * len(room) + 18 for room in rooms}
    across = max(sum(wide[r] + gap for r in layer) for layer in layers) + gap
    place = {}
    for k, layer in enumerate(layers):
        x = (across - sum(wide[r] + gap for r in layer) + gap) / 2
        for room in layer:
            place[room] = (x, 14 + k * step)
            x += wide[room] + gap
    lines = []
    for a in rooms:
        for b in sorted(below[a], key=rooms.index):
            if any(b in reached(c, below) for c in below[a] - {b}):
                continue
            (xa, ya), (xb, yb) = place[a], place[b]
            xa, xb, yb = xa + wide[a] / 2, xb + wide[b] / 2, yb + high
            bend = (ya - yb) / 2
            lines.append(f'<path d="M{xa:.0f} {ya:.0f}C{xa:.0f} {ya - bend:.0f} {xb:.0f} {yb + bend:.0f} {xb:.0f} {yb + 5:.0f}"'
                         ' marker-end="url(#tip)"/>')
    boxes = [f'<rect x="{x:.0f}" y="{y:.0f}" width="{wide[r]:.0f}" height="{high}" rx="4" class="{r[:4].strip("/")}"/>'
             f'<text x="{x + wide[r] / 2:.0f}" y="{y + 17:.0f}">{r}</text>' for r, (x, y) in place.items()]
    size = f"{across:.0f} {28 + (len(layers) - 1) * step + high}"
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" role="img"'
        ' aria-label="Rooms of core and dae: an arrow leads from a room to one that it includes">',
        "<style>text{font:12px ui-monospace,monospace;text-anchor:middle;fill:#1b1f24}path{fill:none;stroke:#8a94a0}"
        "rect{stroke:#8a94a0}.core{fill:#e3eefb}.dae{fill:#fdf0dc}</style>",
        f'<rect width="100%" height="100%" style="fill:#fff;stroke:none"/>',
        '<marker id="tip" viewBox="0 0 8 8" refX="4" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
        '<path d="M0 0L8 4L0 8z" style="fill:#8a94a0;stroke:none"/></marker>', *lines, *boxes, "</svg>", ""])


def main():
    asked = [a for a in sys.argv[1:] if not a.startswith("--")]
    top = Path(asked[0] if asked else Path(__file__).parents[1]).resolve()
    found = arrows(top)
    if "--table" in sys.argv:
        for room in sorted({a for pair in found for a in pair}):
            print(f"{room}: " + " ".join(f"`{b}`" for a, b in sorted(found) if a == room))
        return 0
    rooms, drawn = drawing((top / DRAWING).read_text(encoding="utf-8"))
    if "--svg" in sys.argv:
        print(picture(rooms, drawn), end="")
        return 0
    faults = []
    for (a, b), files in sorted(found.items()):
        example = f"{files[0][0]} includes {files[0][1]}"
        if (a, b) not in drawn:
            faults.append(f"'{a}' → '{b}': {example}; expected an arrow that {DRAWING} has")
        elif a in rooms and b in rooms and rooms.index(b) > rooms.index(a):
            faults.append(f"'{a}' → '{b}': {example}, against the order of {DRAWING}; expected '{b}' above '{a}'")
    faults += [f"'{a}' → '{b}' is in {DRAWING}; no file includes so" for a, b in sorted(drawn - set(found))]
    faults += [f"'{room}' has no row in {DRAWING}" for room in sorted({a for pair in found for a in pair} - set(rooms))]
    faults += [f"folder '{folder}' needs itself by way of others; expected no circle" for folder in circles(top)]
    faults += [f"{name} is in no room; expected a folder" for name in loose(top)]
    faults += [f"{name} is defined in {' and in '.join(files)}" for name, files in namesakes(top)]
    file = top / PICTURE
    if not faults and (not file.is_file() or file.read_text(encoding="utf-8") != picture(rooms, drawn)):
        faults.append(f"{PICTURE} is not the picture of {DRAWING}; expected that of tests/rooms.py --svg")
    layers = "" if faults else f" in {1 + max(depths(rooms, {r: {b for a, b in drawn if a == r} for r in rooms}).values())} layers"
    print("\n".join([*faults, f"{len(rooms)} rooms{layers}, {len(found)} arrows, {len(faults)} faults"]))
    return 1 if faults or not found else 0


if __name__ == "__main__":
    sys.exit(main())
