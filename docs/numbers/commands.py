"""Commands of the documents, run as a reader runs them, each once, in a scratch folder that is gone afterwards.

In the folder `examples` and `docs` are those of the repository and `momenta` is found by name.
"""
import csv
import json
import math
import os
import re
import shlex
import subprocess
import tempfile
from pathlib import Path

from quantities import Run, parse

TOP = Path(__file__).resolve().parents[2]
STUDIES = ("run", "drift", "work")
LIMIT = 300  # processor time of a run [s]: none is near it, and a document is no place for one that never ends


def verb_of(command):
    words = command.split()
    return words[1] if len(words) > 1 and words[0] == "momenta" else ""


def without(command, *options):
    """The command without these options and their values."""
    return re.sub(r" --(" + "|".join(options) + r")\b( (?!--)('[^']*'|[^ ]+))?", "", command)


class Answer:
    """What a command said and wrote."""

    def __init__(self, text, folder, used, timed):
        self.text, self.folder, self._used, self._timed = text, folder, used, timed

    @property
    def summaries(self):
        with open(self.folder / "summary.json", encoding="utf-8") as file:
            found = json.load(file)
        return found if isinstance(found, list) else [found]

    @property
    def runs(self):
        half_ranges = {}
        study = self.folder / "study.csv"
        if study.exists():
            with open(study, encoding="utf-8") as file:
                half_ranges = dict(enumerate(
                    [float(row[f"{what}_exponent_half_range"] or 0) for what in ("position", "velocity")]
                    for row in csv.DictReader(file)))
        return [Run(run, half_ranges.get(i, (0, 0)), self._used, lambda i=i: self._timed().summaries[i])
                for i, run in enumerate(self.summaries)]

    @property
    def json(self):
        return json.loads(self.text[self.text.index("{"):])

    def __call__(self, label="", integrator="", rtol=None):
        """The one run that a row's label means."""
        fits = [run for run in self.runs if means(label, run.summary)
                and (not integrator or same_integrator(integrator, run.summary))
                and (rtol is None or abs(run.summary["rtol"] / rtol - 1) < 1e-6)]
        if len(fits) != 1:
            wanted = ", ".join(str(part) for part in (label, integrator, rtol) if part)
            raise LookupError(f"'{wanted}' means {len(fits)} runs of the command, expected one")
        return fits[0]

    def __getattr__(self, quantity):
        """Of a command with one run: that run's."""
        return getattr(self(), quantity)

    def at_error(self, label, error, quantity):
        """A count for a given error, on a straight line through the logarithms of the two rungs around it."""
        rungs = [run for run in self.runs if means(label, run.summary) and run.done and run.error]
        rungs.sort(key=lambda run: -run.summary["rtol"])
        for loose, tight in zip(rungs, rungs[1:]):
            if loose.error >= error >= tight.error:
                part = math.log(loose.error / error) / math.log(loose.error / tight.error)
                return getattr(loose, quantity) * (getattr(tight, quantity) / getattr(loose, quantity)) ** part
        return None


class Commands:
    """Runs each distinct command once. `used` has the runs that formulas looked at since it was emptied."""

    def __init__(self, program):
        self.used, self.count, self._answers = [], 0, {}
        self._scratch = tempfile.TemporaryDirectory(prefix="momenta_documents_")
        self.folder = Path(self._scratch.name)
        for name in ("examples", "docs"):
            (self.folder / name).symlink_to(TOP / name)
        (self.folder / "bin").mkdir()
        program = Path(program).resolve()
        for built in (program, *(program.parents[1] / "tests" / "benchmark").glob("momenta_*")):
            (self.folder / "bin" / built.name).symlink_to(built)

    def close(self):
        self._scratch.cleanup()

    def shell(self, line):
        """(exit status, standard output and error) of a line typed in the scratch folder."""
        environment = dict(os.environ, PATH=f"{self.folder / 'bin'}:{os.environ['PATH']}")
        done = subprocess.run(["/bin/sh", "-c", line], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout.decode("utf-8", "replace")

    def answer(self, command, timed=False):
        """Of a command as it stands in a document; results go to a folder of its own, times are not taken."""
        command = " ".join(without(command, "out", "figures", "quiet").split())
        if command not in self._answers:
            self.count += 1
            folder = self.folder / f"answer{self.count}"
            line = command
            if verb_of(command) in STUDIES:
                line += f" --out {folder}" + ("" if timed or "--timing" in command else " --timing none")
                line += "" if "--cpu-limit" in command else f" --cpu-limit {LIMIT}"
            status, text = self.shell(line)
            rows = [row for row in text.splitlines() if not row.startswith("momenta: wrote")]
            text = None if status == 127 else "\n".join(rows)  # 127: no such program
            if verb_of(command) in STUDIES and not (folder / "summary.json").exists():
                raise LookupError(f"`{command}` gave no results: {(text or '').strip()[-300:]}")
            counted = command if "--timing" in command else command + " --timing once"
            self._answers[command] = Answer(text, folder, self.used, lambda: self.answer(counted))
        return self._answers[command]


# A row's label: `momentum`, leak 3/s, projected

def read_label(label):
    """{form, gauge, project} as far as a label tells them; without a form the whole label is left out."""
    form = re.search(r"`([a-z0-9-]+)`", label)
    parts = [part.strip() for part in label.replace("`", "").split(",")]
    told = {"form": form[1] if form else parts[0]}
    for part in parts[1:]:
        leak = re.fullmatch(r"leak(?: ([\d.]+)/s)?", part)
        if leak:
            told["gauge"] = f"leak:{leak[1]}" if leak[1] else "leak"
        elif part in ("reset", "flip"):
            told["gauge"] = part
        elif part == "no gauge":
            told["gauge"] = "none"
        elif part in ("projected", "corrected"):
            told["project"] = True
        else:
            raise LookupError(f"'{part}' in '{label}' is neither a gauge nor 'projected'")
    return told


def same_gauge(told, found):
    if told.startswith("leak:") and found.startswith("leak:"):
        rate = parse(told[5:])
        return abs(float(found[5:]) / rate - 1) < 0.05
    return told == found or (told == "leak" and found.startswith("leak"))


def same_integrator(cell, summary):
    return cell.replace("`", "").split(",")[0].strip().lower() == summary["integrator"]


def means(label, summary):
    if not label.strip():
        return True
    told = read_label(label)
    if told["form"] != summary["form"] or ("gauge" in told and not same_gauge(told["gauge"], summary["gauge"])):
        return False
    return told.get("project", False) == summary["project"]


def options_of(header, cell):
    """What a cell of a row puts in place of {header} in a command."""
    cell = cell.strip().replace("`", "")
    if header == "form":
        told = read_label(cell)
        return (f"--form {told['form']}" + (f" --gauge {told['gauge']}" if "gauge" in told else "")
                + (" --project" if told.get("project") else " --no-project"))
    if header == "integrator":
        method, _, rest = cell.partition(",")
        step = re.fullmatch(r"\s*h = ([\d.]+) ms", rest)
        more = f" --step {float(step[1]) / 1000:g}" if step else f" --rtol {rest.strip()}" if rest else ""
        return f"--integrator {method.strip()}{more}"
    value = parse(cell)
    return f"{value:g}" if value is not None else shlex.quote(cell)
