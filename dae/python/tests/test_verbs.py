"""evaluate, index, sweep and view give what the program writes."""

import csv
import json
import os
import pathlib
import re
import subprocess
import tempfile
import threading
import unittest

import momenta
import numpy as np

EXAMPLES = pathlib.Path(os.environ["MOMENTA_EXAMPLES"])
FOUR_BAR = EXAMPLES / "four_bar" / "scene.toml"


def program(*arguments):
    command = [os.environ["MOMENTA_PROGRAM"], *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


class AsTheProgram(unittest.TestCase):
    def test_evaluate(self):
        state = {"t": 0.5, "q": {"O": 0.3}, "p": {"A": [0.2]}, "tau": {"O": 0.5}}
        for file, at in [(FOUR_BAR, None), (FOUR_BAR, state), (EXAMPLES / "driven" / "scene.toml", None)]:
            with self.subTest(file=file.parent.name, at=at):
                wanted = json.loads(program("evaluate", file, *(["--at", json.dumps(at)] if at else [])))
                self.assertEqual(momenta.evaluate(file, at), wanted)
                self.assertEqual(momenta.evaluate(momenta.load(file), json.dumps(at) if at else None), wanted)
        values = momenta.evaluate(FOUR_BAR, {"q": {"O": np.float64(0.3), "A": np.array([0.1])}})
        self.assertEqual((values["q"]["O"], values["q"]["A"]), ([0.3], [0.1]))

    def test_index(self):
        wanted = json.loads(program("index", FOUR_BAR, "--json", "--forms", "momentum,acceleration-index3"))
        self.assertEqual(momenta.index(FOUR_BAR, ["momentum", "acceleration-index3"]), wanted)

    def test_sweep(self):
        options = {"end": 1, "rtol": 1e-9, "form": "acceleration"}
        vary = {"body.crank.mass": [0.5, 2], "gravity.1": "-9.81:0:3"}
        with tempfile.TemporaryDirectory() as out:
            places = ["--vary", "body.crank.mass=0.5,2", "--vary", "gravity.1=-9.81:0:3"]
            asked = [x for name, value in options.items() for x in (f"--{name}", value)]
            program("sweep", FOUR_BAR, *places, *asked, "--watch", "B.y", "--out", out, "--quiet")
            table, summary = ((pathlib.Path(out) / f"sweep.{x}").read_text() for x in ("csv", "json"))
        made = momenta.sweep(FOUR_BAR, vary, watch="B.y", **options)
        self.assertEqual(made.csv, table)
        summary = json.loads(summary)
        for key in made.json.keys() - {"cpu_s"}:
            self.assertEqual(made.json[key], summary[key], key)
        self.assertEqual(len(made), 6)
        np.testing.assert_array_equal(made["body.crank.mass"], [0.5] * 3 + [2] * 3)
        self.assertEqual(made["status"], ["done"] * 6)
        rows = list(csv.DictReader(table.splitlines()))
        np.testing.assert_array_equal(made["B.y last"], [float(row["B.y last"]) for row in rows])
        np.testing.assert_array_equal(made["position_drift_max"], made["position_drift_max [m]"])
        again = momenta.sweep(momenta.load(FOUR_BAR), ["body.crank.mass=0.5,2"], threads=1, **options)
        np.testing.assert_array_equal(again["steps"], made["steps"][::3])

    def test_sample(self):
        with tempfile.TemporaryDirectory() as out:
            asked = ["--vary", "body.crank.mass=normal:1:0.1", "--vary", "body.rocker.mass=1:2", "--end", 0.2]
            asked += ["--samples", 4, "--sample", "sobol", "--points", 8, "--seed", 5, "--indices", "--watch", "B.y"]
            program("sweep", FOUR_BAR, *asked, "--out", out, "--quiet")
            table, summary = ((pathlib.Path(out) / f"sweep.{x}").read_text() for x in ("csv", "json"))
        vary = {"body.crank.mass": "normal:1:0.1", "body.rocker.mass": "1:2"}
        made = momenta.sweep(
            FOUR_BAR, vary, watch="B.y", sample="sobol", points=8, seed=5, indices=True, end=0.2, samples=4
        )
        self.assertEqual(made.csv, table)
        summary = json.loads(summary)
        for key in made.json.keys() - {"cpu_s"}:
            self.assertEqual(made.json[key], summary[key], key)
        self.assertEqual(len(made), 8 * 4)
        b = made["B.y last"].reshape(8, 4)[:, :2]
        self.assertAlmostEqual(made.json["statistics"]["B.y last"]["mean"], b.mean(), 14)
        self.assertAlmostEqual(made.json["statistics"]["B.y last"]["deviation"], b.std(ddof=1), 14)
        q = np.quantile(b, 0.95)
        self.assertAlmostEqual(made.json["statistics"]["B.y last"]["q95"], q, 14)
        self.assertAlmostEqual(made.json["along_time"]["B.y"]["q95"][-1], q, 14)
        for wrong, sentence in (
            ({"points": 3}, "points asked for without a sample"),
            ({"sample": "halton"}, "sample 'halton' is not known"),
            ({"sample": "latin", "points": 0}, "a sample of 0 points"),
        ):
            with self.assertRaisesRegex(ValueError, sentence):
                momenta.sweep(FOUR_BAR, vary, **wrong)

    def test_view(self):
        def study(page):
            island = re.search(r'<script type="application/json" id="study">(.*?)</script>', page, re.DOTALL)
            data = json.loads(island.group(1))
            for of_the_call in ("command", "scene_hash"):
                del data[of_the_call]
            del data["environment"]["date"]
            return page.replace(island.group(1), ""), data

        page = momenta.view(FOUR_BAR)
        self.assertEqual(study(page), study(program("view", FOUR_BAR)))
        self.assertIn("<iframe", page._repr_html_())
        with tempfile.TemporaryDirectory() as folder:
            page.save(pathlib.Path(folder) / "page.html")
            self.assertEqual((pathlib.Path(folder) / "page.html").read_text(), page)

    def test_sentences(self):
        def told(*arguments):
            command = [os.environ["MOMENTA_PROGRAM"], *map(str, arguments)]
            result = subprocess.run(command, capture_output=True, text=True)
            return result.stderr.strip().removeprefix("momenta: ")

        file, X, O = FOUR_BAR, {"q": {"X": 1}}, {"q": {"O": 1}}
        rates = {"v": {"O": [1, 2]}}
        cases = [
            (lambda: momenta.evaluate(file, X), "evaluate", file, "--at", json.dumps(X)),
            (lambda: momenta.evaluate(file, "no.json"), "evaluate", file, "--at", "no.json"),
            (lambda: momenta.index(file, ["momentm"]), "index", file, "--forms", "momentm"),
            (lambda: momenta.index(file, at=O), "index", file, "--at", json.dumps(O)),
            (lambda: momenta.sweep(file, ["gravity"]), "sweep", file, "--vary", "gravity"),
            (lambda: momenta.sweep(file, {"a.b": 1}), "sweep", file, "--vary", "a.b=1.0"),
            (lambda: momenta.view("nowhere.toml"), "view", "nowhere.toml"),
            (lambda: momenta.load(file, at=rates), "view", file, "--at", json.dumps(rates)),
        ]
        for call, *arguments in cases:
            with self.subTest(arguments[0], at=arguments[2:]):
                with self.assertRaises(ValueError) as caught:
                    call()
                self.assertEqual(str(caught.exception), told(*arguments))

    def test_what_is_wrong_with_every_case_is_said_once(self):
        with self.assertRaisesRegex(ValueError, "rtol is -1.0, expected a positive tolerance"):
            momenta.sweep(FOUR_BAR, {"gravity.1": [1, 2]}, rtol=-1)
        with self.assertRaisesRegex(TypeError, "tolerance: sweep takes the arguments of Mechanism.run"):
            momenta.sweep(FOUR_BAR, {"gravity.1": [1, 2]}, tolerance=1)
        with self.assertRaisesRegex(ValueError, "threads is -1, expected 0 or more"):
            momenta.sweep(FOUR_BAR, {"gravity.1": [1, 2]}, threads=-1)


class Progress(unittest.TestCase):
    def calls(self):
        m = momenta.load(FOUR_BAR)
        return [
            lambda progress: m.run(end=1, progress=progress),
            lambda progress: m.drift(forms=["momentum", "acceleration"], end=1, progress=progress),
            lambda progress: m.work(forms=["momentum"], tolerances=[1e-4, 1e-6], end=0.5, progress=progress),
            lambda progress: momenta.index(m, ["momentum", "acceleration"], progress=progress),
            lambda progress: momenta.sweep(m, {"gravity.1": [1, 2, 3]}, end=0.5, progress=progress),
        ]

    def test_it_rises_to_one(self):
        for call in self.calls():
            told = []
            call(lambda fraction, text: told.append((fraction, text)))
            fractions = [fraction for fraction, _ in told]
            self.assertEqual(fractions, sorted(fractions))
            self.assertEqual(fractions[-1], 1)
            self.assertEqual(fractions.count(1), 1)
            self.assertLess(len(told), 110)
            self.assertTrue(all(isinstance(text, str) and text for _, text in told))

    def test_what_it_raises_stops_the_call(self):
        def stop(fraction, text):
            raise KeyError("enough")

        for call in self.calls():
            with self.assertRaisesRegex(KeyError, "enough"):
                call(stop)

    def test_what_is_no_function(self):
        for call in self.calls():
            with self.assertRaisesRegex(TypeError, "progress is 3, expected True, a function of"):
                call(3)


class Threads(unittest.TestCase):
    def test_a_sweep_stops_where_progress_does(self):
        before = threading.active_count()

        def stop(fraction, text):
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            momenta.sweep(FOUR_BAR, {"gravity.1": "1:2:200"}, threads=2, progress=stop)
        self.assertEqual(threading.active_count(), before)


if __name__ == "__main__":
    unittest.main()
