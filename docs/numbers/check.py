#!/usr/bin/env python3
"""Compares the documents with what their commands print: tables, numbers in prose, printed lines.

    docs/numbers/check.py PROGRAM            says what differs; exit status 1 if anything does
    docs/numbers/check.py PROGRAM --write    puts the numbers of this machine in their place
    docs/numbers/check.py PROGRAM --write --times    processor times too: on a quiet machine

PROGRAM is momenta, for instance build/release/dae/momenta; names of documents after it choose among them.
With MOMENTA_ALL_DOCUMENTS=1 also what is marked `long`, minutes of it.

Marks are comments, which no reader of the rendered page sees. COMMAND is a command, {HEADER} in it the
cell of the row under HEADER, or `above`: the last command that stands indented above the mark.

    <!-- table: COMMAND -->       the table below: its columns are quantities of runs (quantities.py), its
                                  first columns tell which run of the command a row is
    <!-- printed: COMMAND -->     the indented lines, or rows, below are among what it prints, in this order
    <!-- NAME: COMMAND -->        a name for formulas of this page; NAME(a, b): {a} and {b} are arguments
    8.2e-5<!-- = FORMULA -->      the number before it
    <!-- holds: FORMULA -->       what the sentence before it says
    <!-- scene: FILE -->          FILE of the scratch folder holds the blocks of TOML above, put together
    <!-- timed: COMMAND -->       the table below has times, or what depends on them: not compared
    <!-- elsewhere: WHERE -->     the table below was measured by something else: not compared

A mark of a table may go on, one on a line: `HEADER = FORMULA` for a column that is no quantity, with
`row` for its cells by header; `within FACTOR` where a motion is sensitive, through singular poses say;
`long`. A FORMULA is Python on the page's names: bare("acceleration").position_drift,
gain(3).error / gain(0.3).error, check.json["mobility"]. Every table with measured numbers has a mark.
"""
import os
import re
import sys
from pathlib import Path
from statistics import median

sys.dont_write_bytecode = True  # the folder belongs to the reader

from commands import STUDIES, TOP, Commands, options_of, parse, verb_of
from printed import compare_lines
from quantities import BRANCH_LOST, COLUMNS, COUNTED, SENSITIVE_COUNT, agree, written
from reading import commands_run, links_lead_somewhere

DOCUMENTS = ["README.md", "CONTRIBUTING.md", "docs/**/*.md", "examples/*/README.md", "tests/benchmark/README.md"]
ALL = os.environ.get("MOMENTA_ALL_DOCUMENTS", "0") not in ("", "0")
MARK = re.compile(r"<!--\s*(.*?)\s*-->", re.S)
MEASURED = re.compile(r"-?(\d+\.\d+|\d+e-\d+)( m?s)?")
NUMBER = re.compile(r"(-?\d[\d ]*(?:\.\d+)?(?:e-?\d+|·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?)$")


def cells(line):
    """Of a row of a table, without the bars around it."""
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().strip("|"))]


class Page:
    """One document: its text, and what of it differs."""

    def __init__(self, file, commands, write, times):
        self.file, self.commands, self.write, self.times = file, commands, write, times
        self.text = file.read_text(encoding="utf-8")
        self.changes, self.complaints, self.names, self.marked = [], [], {}, set()

    # Places

    def line(self, at):
        return self.text.count("\n", 0, at) + 1

    def complain(self, at, sentence):
        self.complaints.append(f"{self.file.relative_to(TOP)}:{self.line(at)}: {sentence}")

    def differs(self, start, end, value, now=None):
        """What stands between start and end is not `value`: said, or put right."""
        if self.write:
            self.changes.append((start, end, now if now is not None else written(value, self.text[start:end])))
        else:
            self.complain(start, f"'{self.text[start:end]}' stands here, expected "
                                 f"{now if now is not None else written(value, self.text[start:end])}")

    # Commands and formulas

    def above(self, at):
        found = re.findall(r"(?m)^ {4,}(momenta (?:[^\n]*\\\n)*[^\n]*)", self.text[:at])
        if not found:
            raise LookupError("no command stands above")
        return re.sub(r"\\\n\s*", "", found[-1]).split(" # ")[0].strip()

    def command(self, text, at):
        """`above`, a command, or `above` with more options."""
        return re.sub(r"^above\b", lambda _: self.above(at), text.strip())

    def value(self, formula, **more):
        """(what a formula gives, the factor that two machines may differ by)."""
        self.commands.used.clear()
        known = dict(self.names, median=median, abs=abs, max=max, min=min, round=round, len=len, all=all, any=any, **more)
        value = eval(formula, {**known, "__builtins__": {}})  # pages of this repository, nobody else's
        return value, max(self.commands.used, default=1.0)

    def define(self, name, parameters, text, at):
        command = self.command(text, at)

        def with_values(*values):
            filled = command
            for parameter, value in zip(parameters, values):
                filled = filled.replace("{" + parameter + "}", str(value))
            return self.commands.answer(filled)

        class Once:  # a name without parameters stands for its answer
            def __call__(_, *label, **more):
                return with_values()(*label, **more)

            def __getattr__(_, quantity):
                return getattr(with_values(), quantity)

        self.names[name] = with_values if parameters else Once()

    # Marks

    def go_through(self):
        for mark in MARK.finditer(self.text):
            head, _, rest = mark[1].partition(":")
            name = re.fullmatch(r"([a-z]\w*)(?:\(([\w, ]*)\))?", head.strip())
            lines = [line.strip() for line in re.sub(r"\\\n\s*", " ", rest).splitlines()]
            try:
                if mark[1].startswith("="):
                    self.number(mark)
                elif head == "holds":
                    if not self.value(" ".join(lines))[0]:
                        self.complain(mark.start(), f"the sentence before does not hold: {' '.join(lines).strip()}")
                elif head == "scene":
                    blocks = re.findall(r"(?ms)^```toml\n(.*?)^```", self.text[:mark.start()])
                    (self.commands.folder / rest.strip()).write_text("\n".join(blocks), encoding="utf-8")
                elif head in ("table", "printed"):
                    self.below(mark, head, lines)
                elif head.startswith("elements of "):  # a test of core compares such a table
                    pass
                elif head in ("timed", "elsewhere"):
                    self.marked.add(self.block(mark.end())[0])
                elif name and "momenta" in rest or rest.strip().startswith("above"):
                    self.define(name[1], re.findall(r"\w+", name[2] or ""), lines[0] or lines[1], mark.start())
                else:
                    self.complain(mark.start(), f"'{head}' is no mark")
            except (LookupError, AttributeError, TypeError, ValueError, SyntaxError, NameError, ZeroDivisionError) as e:
                self.complain(mark.start(), f"{type(e).__name__}: {e}")
        for table in re.finditer(r"(?m)^\|.*\n\|[-| :]+\|\n(?:\|.*\n?)+", self.text):
            numbers = [cell for row in table[0].splitlines()[2:] for cell in cells(row) if MEASURED.fullmatch(cell)]
            if table.start() not in self.marked and len(numbers) > 2:
                self.complain(table.start(), "this table has measured numbers and no mark")
        for start, end, now in sorted(self.changes, reverse=True):
            self.text = self.text[:start] + now + self.text[end:]
        if self.changes:
            self.file.write_text(self.text, encoding="utf-8")

    def block(self, at):
        """(start, text) of the table or the indented lines after `at`."""
        below = re.compile(r"(?:[ \t]*\n)*((?:\|.*\n?)+|(?:(?: {4}.*|[ \t]*)\n)+)").match(self.text, at)
        if not below:
            raise LookupError("neither a table nor indented lines stand below this mark")
        return below.start(1), below[1]

    def number(self, mark):
        text = self.text[:mark.start()].split("\n")[-1]
        found = NUMBER.search(text.rstrip("`"))
        if not found:
            raise LookupError(f"no number stands before '{mark[0]}'")
        formula, _, within = mark[1][1:].partition(" within ")
        value, factor = self.value(formula)
        number = found[1].strip()
        start = mark.start() - len(text) + found.start(1) + found[1].index(number)
        if not agree(number, value, float(within or factor)):
            self.differs(start, start + len(number), value)

    def below(self, mark, head, lines):
        start, block = self.block(mark.end())
        self.marked.add(start)
        command = self.command(lines[0] or lines[1], mark.start())
        more = [line for line in lines[1:] if line and line != lines[0] and not command.endswith(line)]
        if "long" in more and not ALL:
            return
        within = next((float(line.split()[1]) for line in more if line.startswith("within ")), None)
        if head == "printed":
            said = self.commands.answer(command, self.times).text
            if said is None:  # a program of this repository that is not built
                return
            for at, old, now in compare_lines(block, said, within or 3.0):
                self.differs(start + at, start + at + len(old), None, now)
            return
        formulas = dict(re.split(r"\s+= ", line, maxsplit=1) for line in more if " = " in line)
        counts = re.search("|".join(COUNTED), block.splitlines()[0] + " ".join(formulas.values()))
        if counts and verb_of(command) in STUDIES and not self.times:
            command += " --timing once"
        self.table(start, block, command, formulas, within)

    def table(self, start, block, command, formulas, within):
        lines = block.splitlines(keepends=True)
        headers = cells(lines[0])
        at = start + len(lines[0]) + len(lines[1])
        for line in lines[2:]:
            row = dict(zip(headers, cells(line)))
            place = 1
            try:
                run, answer = self.run_of(row, command)
                for header in headers:
                    cell = row[header]
                    where = line.index(cell, place) if cell else place
                    self.cell(at + where, header, cell, row, run, answer, formulas, within)
                    place = line.index("|", where + len(cell)) + 1
            except LookupError as e:
                self.complain(at, str(e))
            at += len(line)

    def run_of(self, row, command):
        filled = re.sub(r"\{([^}]+)\}", lambda m: options_of(m[1], row[m[1]]), command)
        answer = self.commands.answer(filled, self.times)
        if "summary.json" not in os.listdir(answer.folder) if answer.folder.exists() else True:
            return None, answer
        chosen = {} if "{form}" in command else {"label": row.get("form", "")}
        if "{integrator}" not in command:
            chosen["integrator"] = row.get("integrator", "")
        if "tolerance" in row and "{tolerance}" not in command:
            chosen["rtol"] = parse(row["tolerance"])
        try:
            return answer(**chosen), answer
        except LookupError:
            if "form" in row or len(answer.runs) == 1:
                raise
            return None, answer

    def cell(self, at, header, cell, row, run, answer, formulas, within):
        name = re.sub(r"\s*\[[^]]*\]", "", header).replace("`", "")
        formula = formulas.get(name) or (f"run.{COLUMNS[name]}" if name in COLUMNS and run is not None else None)
        if name.startswith("CPU"):
            self.time(at, header, cell, run)
        if not formula:
            return
        value, factor = self.value(formula, run=run, answer=answer, row={
            key: parse(text) if parse(text) is not None else text.strip("`") for key, text in row.items()})
        if within:
            factor = max(factor, min(within, SENSITIVE_COUNT) if COLUMNS.get(name) in COUNTED else within)
        if cell == "–" and run is not None and (not run.done or run.accuracy == BRANCH_LOST):
            return  # a motion that is not that of the mechanism has no numbers to compare
        if not agree(cell, value, factor):
            self.differs(at, at + len(cell), value)
        elif self.write and cell not in ("–", "rounding") and written(value, cell) != cell:
            self.differs(at, at + len(cell), value)

    def time(self, at, header, cell, run):
        number = cell.split(" ")[0]
        if parse(number) is None and cell != "–":
            self.complain(at, f"'{cell}' stands under '{header}', expected a number")
        seconds = run.summary["time"]["cpu_s"] if run is not None else None
        if self.write and self.times and seconds:
            unit = 1000 if cell.endswith("ms") or "[ms]" in header else 1
            now = written(seconds * unit) + cell[len(number):]
            self.changes.append((at, at + len(cell), now))


def main():
    arguments = [word for word in sys.argv[1:] if not word.startswith("--")]
    options = {word for word in sys.argv[1:] if word.startswith("--")}
    if not arguments or options - {"--write", "--times"}:
        sys.exit(__doc__)
    chosen = [Path(name).resolve() for name in arguments[1:]]
    files = [file for pattern in DOCUMENTS for file in sorted(TOP.glob(pattern))]
    commands = Commands(arguments[0])
    complaints = []
    try:
        for file in chosen or files:
            page = Page(file, commands, "--write" in options, "--times" in options)
            page.go_through()
            complaints += page.complaints
            complaints += links_lead_somewhere(file) + commands_run(file, commands)
    finally:
        commands.close()
    print("\n".join(complaints) if complaints else f"{len(chosen or files)} documents show what {commands.count} "
          "commands print")
    sys.exit(1 if complaints else 0)


if __name__ == "__main__":
    main()
