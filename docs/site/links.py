#!/usr/bin/env python3
"""Checks that every link within the project's Markdown files leads to a file and, where it names one, to a heading.

    docs/site/links.py [TOP]

Standard library alone. One line for each link that leads nowhere, and exit status 1. Headings have the anchors that
GitHub gives them; the site (make.py) gives the same.
"""
import os
import re
import sys
import unicodedata
from pathlib import Path
from urllib.parse import unquote

LINK = re.compile(r"""\]\(\s*<?([^)\s>]+)>?(?:\s+"[^"]*")?\s*\)""")
OUTSIDE = re.compile(r"[a-z][a-z0-9+.-]*:", re.IGNORECASE)
LEFT_OUT = ("build", "results", ".git")


def slug(heading, separator="-"):
    """The anchor of a heading: letters, marks, digits, _ and - in lower case, spaces as `separator`."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    text = re.sub(r"(?<!\w)([*_]{1,3})(\S.*?)\1(?!\w)", r"\2", text)
    kept = [c for c in text.strip().lower() if c in " -_" or unicodedata.category(c)[0] in "LM" or unicodedata.category(c) == "Nd"]
    return "".join(kept).replace(" ", separator)


def pages(top):
    """All Markdown files of the project, from its top."""
    found = []
    for folder, inner, files in os.walk(top):
        inner[:] = [name for name in inner if not name.startswith(LEFT_OUT)]
        found += [Path(folder) / name for name in files if name.endswith(".md")]
    return sorted(found)


def prose(text):
    """(number, line) of what is neither fenced nor indented code; code within a line is blanked."""
    fence, blank, in_list = None, True, False
    for number, line in enumerate(text.split("\n"), 1):
        mark = re.match(r"\s*(```+|~~~+)", line)
        if fence or mark:
            if fence and mark and mark[1].startswith(fence):
                fence = None
            elif not fence:
                fence = mark[1]
            continue
        indented = line.startswith("    ") and not in_list
        if indented and blank:
            continue
        blank = not line.strip() or indented
        if line.strip() and not line.startswith(" "):
            in_list = bool(re.match(r"([-*+]|\d+[.)])\s", line))
        yield number, re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", lambda m: "`" * len(m[0]), line), line


def anchors(page):
    """Anchors of all headings, and of <a id=…> or <a name=…>."""
    found, times = set(), {}
    for _, _, line in prose(page.read_text(encoding="utf-8")):
        heading = re.match(r" {0,3}#{1,6}\s+(.*?)\s*#*\s*$", line)
        if heading:
            name = slug(heading[1])
            again = times.get(name, 0)
            times[name] = again + 1
            found.add(f"{name}-{again}" if again else name)
        found.update(re.findall(r"""<a\s+(?:id|name)=["']([^"']+)["']""", line))
    return found


def links(page):
    """(line, target) of every link that does not leave the project."""
    for number, line, _ in prose(page.read_text(encoding="utf-8")):
        for target in LINK.findall(line):
            if not OUTSIDE.match(target):
                yield number, unquote(target)


def main():
    top = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    known, broken, checked = {}, 0, 0
    for page in pages(top):
        for number, target in links(page):
            checked += 1
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            name = file / "README.md" if file.is_dir() else file
            if not file.exists():
                fault = "no such file"
            elif top not in (file, *file.parents):
                fault = "outside the project"
            elif anchor and name.suffix == ".md" and name.exists():
                known.setdefault(name, anchors(name))
                fault = None if anchor in known[name] else f"no heading '{anchor}'; expected one of {', '.join(sorted(known[name]))}"
            else:
                fault = None
            if fault:
                broken += 1
                print(f"{page.relative_to(top)}:{number}: '{target}': {fault}")
    print(f"{checked} links within {len(pages(top))} Markdown files, {broken} lead nowhere")
    return 1 if broken or not checked else 0


if __name__ == "__main__":
    sys.exit(main())
