#!/usr/bin/env python3
"""Makes docs/reference/guarantees.md: what each file of tests guarantees, as its head says.

    tests/guarantees.py [TOP]            exit status 1 where the page is not this one, or a file has no head
    tests/guarantees.py --print [TOP]    prints the page

Tests stand in the rooms of what they test. Standard library alone.
"""
import re
import sys
from pathlib import Path

PAGE = "docs/reference/guarantees.md"
START = """# Guarantees: what the tests hold

Made of the heads of the files of tests by `tests/guarantees.py --print`. Each file stands in the room of what it tests ([rooms](rooms.md)); one name of a test is one guarantee (`momenta_core_tests --gtest_list_tests`). Slow twins and random mechanisms that many of them share are in `tests/equations`.
"""


def head(file):
    """The first paragraph of a file's head; empty: it has none."""
    words = []
    for line in file.read_text(encoding="utf-8").split("\n"):
        if not line.startswith("//") or not line.strip("/ "):
            break
        words.append(line.strip("/ "))
    return " ".join(words)


def page(top):
    """The page, and a sentence for each file without a head."""
    text, faults, room = [START], [], None
    for file in sorted(file for part in ("core", "dae") for file in (top / "tests" / part).rglob("*.cpp")):
        name = file.relative_to(top / "tests").as_posix()
        if (of := "/".join(name.split("/")[:2])) != room:
            room = of
            text.append(f"\n## {room}\n\n| file | guarantees |\n|---|---|\n")
        if not (what := head(file)):
            faults.append(f"tests/{name}: found no head; expected a comment of what the file guarantees")
        what = re.sub(r"([|<>])", r"\\\1", what)
        text.append(f"| [{file.stem}](../../tests/{name}) | {what} |\n")
    return "".join(text), faults


def main():
    asked = [a for a in sys.argv[1:] if not a.startswith("--")]
    top = Path(asked[0] if asked else Path(__file__).parents[1]).resolve()
    text, faults = page(top)
    if "--print" in sys.argv:
        print(text, end="")
        return 0
    file = top / PAGE
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        faults.append(f"{PAGE} is not made of the heads; expected what tests/guarantees.py --print prints")
    print("\n".join([*faults, f"{len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
