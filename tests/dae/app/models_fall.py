#!/usr/bin/env python3
"""Prints two tables of every model of a folder: what it is, and ten seconds of it in four forms.

    MOMENTA_MODELS=FOLDER tests/dae/app/models_fall.py build/dev/dae/momenta [options]

A model is a file that a `reference.json` beside it names, as dae/app/models.cpp reads them. With
`--tests build/dev/tests/momenta_dae_tests` the first table has the deviations from those values that
dae/app/models.cpp finds: of M, the bias, the accelerations of the tree and with loops closed. With
`--no-times` no column has what another machine would not print again. Without MOMENTA_MODELS nothing is done. Exit status 1 where a run ends without a number and without a sentence.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

RATE = 0.5  # of every hinge and slide, one way and the other by turns, before loops are closed
FORMS = ("momentum", "projected", "stabilised-index2", "momentum-index2")


def models_below(folder):
    """Each with the rates it starts with, by joint."""
    for values in sorted(pathlib.Path(folder).glob("*/reference.json")):
        models = json.loads(values.read_text())["models"]
        for name in sorted(models):
            moving = [j["name"] for j in models[name]["joints"] if j.get("name") and j["type"] in ("hinge", "slide")]
            yield values.parent / name, {joint: RATE * (-1) ** i for i, joint in enumerate(moving)}


def deviations(tests):
    """By "folder/model": cells of M, bias, accelerations of the tree, and with loops closed."""
    found = {}
    printed = subprocess.run([tests, "--gtest_filter=*Models*"], capture_output=True, text=True).stdout
    for model, *cells in re.findall(r"^\| (\S+) \| \d+ \| (\S+) \| (\S+) \| (\S+) \|$", printed, re.M):
        found[model] = [*cells, ""]
    for model, closed in re.findall(r"^\| (\S+) \| loops .* \| (\S+) \|$", printed, re.M):
        found.setdefault(model, ["", "", "", ""])[3] = closed
    return found


def size_of(program, model):
    """What `momenta check` says, or the sentence it stops with."""
    checked = subprocess.run([program, "check", str(model), "--json", "--quiet"], capture_output=True, text=True)
    return (json.loads(checked.stdout), "") if checked.returncode == 0 else ({}, checked.stderr.strip())


def reading_time(program, model):
    """The shortest of three times to read it and write it as TOML, with the program's start [s]."""
    times = []
    for _ in range(3):
        start = time.monotonic()
        subprocess.run([program, "convert", str(model), "-"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        times.append(time.monotonic() - start)
    return min(times)


def page_size(program, model):
    """Of the page of `momenta view` [kB]."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "view", str(model), "--out", folder, "--quiet"], capture_output=True)
        pages = list(pathlib.Path(folder).glob("**/*.html"))
        return sum(page.stat().st_size for page in pages) / 1000


def fall(program, model, rates, form, seconds, cpu_limit):
    """(summary, the sentence where the run stops)."""
    command = [program, "run", str(model), "--form", form, "--end", seconds, "--cpu-limit", cpu_limit]
    command += ["--at", json.dumps({"v": rates})]
    done = subprocess.run([*command, "--timing", "none", "--quiet", "--json"], capture_output=True, text=True)
    try:
        summary = json.loads(done.stdout)
    except json.JSONDecodeError:
        return None, done.stderr.strip()
    return summary, summary["reason"] if summary["status"] != "done" else ""


def number(value):
    return "" if value is None else "0" if value == 0 else f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e")


def print_sizes(program, models, tests, times):
    found = deviations(tests) if tests else {}
    print("| model | rates | loop rows, rank | M | bias | accelerations of the tree | with loops closed "
          f"| {'read [s] | ' if times else ''}page [kB] |")
    print("|---|---|---|---|---|---|---|---|" + "---|" * times)
    for model, _ in models:
        name = f"{model.parent.name}/{model.name}"
        size, sentence = size_of(program, model)
        if sentence:
            print(f"| `{name}` | {sentence} | | | | | | |" + " |" * times, flush=True)
            continue
        rows = f"{size['loop_equations']}, {size['rank']}" if size["loop_equations"] else ""
        cells = found.get(name, [""] * 4)
        last = f"{reading_time(program, model):.2f} | " if times else ""
        last += f"{page_size(program, model):.0f}"
        print(f"| `{name}` | {size['rates']} | {rows} | {' | '.join(cells)} | {last} |", flush=True)


def print_falls(program, models, seconds, cpu_limit, times):
    """The number of runs without a number and without a sentence."""
    silent = 0
    print(f"| model | form | drift | energy error [J] | steps | {'CPU [s] | ' if times else ''}stopped |")
    print("|---|---|---|---|---|---|" + "---|" * times)
    for model, rates in models:
        for i, form in enumerate(FORMS):
            start = os.times()
            summary, sentence = fall(program, model, rates, form, seconds, cpu_limit)
            end = os.times()
            silent += summary is None and not sentence
            cells = [""] * (3 + times)
            if summary:
                spent = end.children_user + end.children_system - start.children_user - start.children_system
                drift, energy = summary["drift"]["position_max"], summary["energy"]["error_max"]
                cells = [number(drift), number(energy), str(summary["counters"]["steps"])]
                cells += [f"{spent:.1f}"] if times else []
            name = f"`{model.parent.name}/{model.name}`" if i == 0 else ""
            print(f"| {name} | `{form}` | {' | '.join(cells)} | {sentence} |", flush=True)
    return silent


def main():
    folder = os.environ.get("MOMENTA_MODELS")
    if not folder:
        return 0
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", help="momenta")
    parser.add_argument("--tests", help="momenta_dae_tests")
    parser.add_argument("--end", default="10", help="seconds of motion; 0: the first table alone")
    parser.add_argument("--cpu-limit", default="60", help="seconds of processor time of a run")
    parser.add_argument("--no-times", action="store_true", help="without times of reading and of runs")
    o = parser.parse_args()
    models = list(models_below(folder))
    print_sizes(o.program, models, o.tests, not o.no_times)
    if float(o.end) == 0:
        return 0
    print()
    return 1 if print_falls(o.program, models, o.end, o.cpu_limit, not o.no_times) else 0


if __name__ == "__main__":
    sys.exit(main())
