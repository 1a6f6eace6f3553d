#!/usr/bin/env python3
"""Moves every model of a folder for ten seconds in four forms and prints a table.

    MOMENTA_MODELS=FOLDER tests/golden/models_fall.py build/dev/momenta [SECONDS [CPU_LIMIT]]

A model is a file that a `reference.json` beside it names, as dae_models.cpp reads them. Without
MOMENTA_MODELS nothing is done. Exit status 1 where a run ends without a number and without a sentence.
"""

import json
import os
import pathlib
import subprocess
import sys

RATE = 0.5  # of every hinge and slide, one way and the other by turns, before loops are closed
FORMS = ("momentum", "projected", "stabilised-index2", "momentum-index2")


def models_below(folder):
    """Each with the rates it starts with, by joint."""
    for values in sorted(pathlib.Path(folder).glob("*/reference.json")):
        models = json.loads(values.read_text())["models"]
        for name in sorted(models):
            moving = [j["name"] for j in models[name]["joints"] if j.get("name") and j["type"] in ("hinge", "slide")]
            yield values.parent / name, {joint: RATE * (-1) ** i for i, joint in enumerate(moving)}


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
    return "" if value is None else f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e")


def main():
    folder = os.environ.get("MOMENTA_MODELS")
    if not folder:
        return 0
    program, *more = sys.argv[1:]
    seconds, cpu_limit = (more + ["10", "60"][len(more):])[:2]
    silent = 0
    print("| model | rates | loop rows, rank | form | drift | energy error [J] | steps | stopped |")
    print("|---|---|---|---|---|---|---|---|")
    for model, rates in models_below(folder):
        checked = subprocess.run([program, "check", str(model), "--json", "--quiet"], capture_output=True, text=True)
        size = json.loads(checked.stdout) if checked.returncode == 0 else {}
        for i, form in enumerate(FORMS):
            summary, sentence = fall(program, model, rates, form, seconds, cpu_limit)
            silent += summary is None and not sentence
            name = f"`{model.parent.name}/{model.name}`" if i == 0 else ""
            count = size.get("rates", "") if i == 0 else ""
            rows = f"{size['loop_equations']}, {size['rank']}" if i == 0 and size.get("loop_equations") else ""
            cells = ["", "", ""]
            if summary:
                drift, energy = summary["drift"]["position_max"], summary["energy"]["error_max"]
                cells = [number(drift), number(energy), str(summary["counters"]["steps"])]
            print(f"| {name} | {count} | {rows} | `{form}` | {' | '.join(cells)} | {sentence} |", flush=True)
    return 1 if silent else 0


if __name__ == "__main__":
    sys.exit(main())
