#!/usr/bin/env python3
"""Makes the site: the project's Markdown files as plain HTML by Debian's mkdocs, to be read from a folder, offline.

    docs/site/make.py FOLDER [API]

FOLDER gets `pages`, what mkdocs reads, and `html`, the site; html/index.html is its front. Navigation follows the order of
docs/README.md. API is the folder of the API reference (docs/api), which becomes html/api. Files that pages link to are
in the site too, folders without a README as lists of their files. Exit status 1 when a link within the site leads
nowhere, 77 where mkdocs is not installed.
"""
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

sys.path.append(str(Path(__file__).parent))
from links import OUTSIDE, links, pages  # noqa: E402

TOP = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent


def title_of(page):
    heading = re.search(r"^# (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return heading[1].replace("`", "") if heading else page.stem


def stage_page(page, staging):
    """Copies a page of HTML with the files that it is made of; its links to Markdown lead to what becomes of it."""
    text = page.read_text(encoding="utf-8")
    copy = staging / page.relative_to(TOP)
    copy.parent.mkdir(parents=True, exist_ok=True)
    copy.write_text(re.sub(r'(href="(?!\w+:)[^"]+)\.md"', r'\1.html"', text), encoding="utf-8")
    for target in re.findall(r'(?:src|href)="([^"#:]+)"', text):
        file = (page.parent / target).resolve()
        if file.suffix in (".js", ".css"):
            copy = staging / file.relative_to(TOP)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)


def staged(staging):
    """Copies the pages and what they link to, in place; links to folders become links to their pages."""
    folders = set()
    for page in pages(TOP):
        text = page.read_text(encoding="utf-8")
        for _, target in links(page):
            path, _, _ = target.partition("#")
            file = (page.parent / path).resolve()
            if not path or not file.exists():
                continue
            if file.is_dir():
                folders.add(file)
                text = text.replace(f"]({target})", f"]({target.rstrip('/')}/README.md)")
            elif file.suffix == ".html":
                stage_page(file, staging)
            elif file.suffix != ".md":
                copy = staging / file.relative_to(TOP)
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, copy)
        copy = staging / page.relative_to(TOP)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text, encoding="utf-8")
    for folder in folders:
        listing = staging / folder.relative_to(TOP) / "README.md"
        if listing.exists():
            continue
        lines = [f"# {folder.relative_to(TOP)}", ""]
        for file in sorted(folder.iterdir()):
            copy = listing.parent / file.name
            if file.is_file() and file.suffix != ".md":
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(file, copy)
            if file.is_file():
                lines.append(f"- [{title_of(file) if file.suffix == '.md' else file.name}]({file.name})")
            elif (copy / "README.md").exists():
                lines.append(f"- [{title_of(copy / 'README.md')}]({file.name}/README.md)")
        listing.parent.mkdir(parents=True, exist_ok=True)
        listing.write_text("\n".join([*lines, ""]), encoding="utf-8")


def navigation(staging):
    """The parts of docs/README.md in its order, the examples, and what stands at the top."""
    nav = [{"momenta": "README.md"}]
    for line in (staging / "docs/README.md").read_text(encoding="utf-8").split("\n"):
        part = re.fullmatch(r"\*\*(.+)\*\*", line)
        entry = re.match(r"- \[([^\]]+)\]\(([^)#]+)\)", line)
        if part:
            nav.append({part[1]: []})
        elif entry:
            file = (staging / "docs" / entry[2]).resolve().relative_to(staging.resolve())
            next(iter(nav[-1].values())).append({entry[1]: str(file)})
            if file.name == "README.md":  # a course: its lessons follow
                lessons = sorted(p for p in (staging / file).parent.glob("*.md") if p.name != "README.md")
                next(iter(nav[-1].values())).extend({title_of(p): str(p.relative_to(staging))} for p in lessons)
    nav.append({"Examples": [{title_of(p): str(p.relative_to(staging))} for p in sorted(staging.glob("examples/*/README.md"))]})
    nav.append({"Project": [{"Contributing": "CONTRIBUTING.md"}, {"Changelog": "CHANGELOG.md"}]})
    return nav


class Page(html.parser.HTMLParser):
    """What a page links to, and what it can be linked at."""

    def __init__(self, file):
        super().__init__()
        self.targets, self.anchors = [], set()
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.targets.append(value)
            if name in ("id", "name") and value:
                self.anchors.add(value)


def dead_links(site):
    """(page, target) of links within the site that lead nowhere; the API reference's own are Doxygen's affair."""
    read = {}
    for file in sorted(site.rglob("*.html")):
        if file.is_relative_to(site / "api") or file.name == "404.html":
            continue
        for target in Page(file).targets:
            parts = urlsplit(target)
            if OUTSIDE.match(target) or target.startswith("//"):
                continue
            aim = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            if aim.is_dir():
                aim /= "index.html"
            anchor = unquote(parts.fragment)
            if aim.is_file() and anchor and aim.suffix == ".html":
                read.setdefault(aim, Page(aim).anchors)
                if anchor in read[aim]:
                    continue
            elif aim.is_file():
                continue
            yield file.relative_to(site), target


def main():
    mkdocs = shutil.which("mkdocs")
    if not mkdocs:
        print("mkdocs is not installed: no site is made")
        return 77
    folder = Path(sys.argv[1]).resolve()
    staging, site = folder / "pages", folder / "html"
    for old in (staging, site):
        shutil.rmtree(old, ignore_errors=True)
    staging.mkdir(parents=True)
    staged(staging)
    config = folder / "mkdocs.yml"
    config.write_text("\n".join([
        "site_name: momenta", "site_url: ''", f"docs_dir: {json.dumps(str(staging))}", f"site_dir: {json.dumps(str(site))}",
        "use_directory_urls: false", f"theme: {{name: null, custom_dir: {json.dumps(str(HERE / 'theme'))}}}", "plugins: []",
        f"extra: {{api: {json.dumps(len(sys.argv) > 2)}}}", "markdown_extensions:",
        "  - sane_lists", "  - toc:", "      slugify: !!python/name:links.slug",
        f"nav: {json.dumps(navigation(staging), ensure_ascii=False)}", ""]), encoding="utf-8")
    # mkdocs looks for `links` beside this file.
    done = subprocess.run([mkdocs, "build", "--quiet", "--config-file", config], check=False,
                          env={**os.environ, "PYTHONPATH": str(HERE), "LC_ALL": "C.UTF-8"})
    if done.returncode:
        return 1
    if len(sys.argv) > 2:
        shutil.copytree(sys.argv[2], site / "api", dirs_exist_ok=True)
    dead = list(dead_links(site))
    for page, target in dead:
        print(f"{page}: '{target}' leads nowhere")
    print(f"{site / 'index.html'}: {sum(1 for _ in site.rglob('*.html'))} pages, {len(dead)} links lead nowhere")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
