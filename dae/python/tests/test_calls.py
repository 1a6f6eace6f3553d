"""Any public call with any arguments: a result that is what it is said to be, or one exception with
one sentence. Each round is a process of its own, so that a crash of the interpreter is seen and told
with its calls. MOMENTA_CALLS=n makes n times as many calls."""

import faulthandler
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
import unittest

EXAMPLES = pathlib.Path(os.environ["MOMENTA_EXAMPLES"])
NAN, INF = float("nan"), float("inf")
NUMBERS = [0, -0.0, 1, -1, 1e-3, 0.1, 2.5, 1e-300, 5e-324, 1e16, 1e100, -1e155, 1e300, -1e308, NAN,
           INF, -INF, 7, 10**9, 2**31, 2**63, -(2**31), 10**400, True]
OTHERS = [None, "", "x", "momentum", "leak:nan", "leak:-1", "none", "dop853", "ida", b"\xff", [], [1],
          {}, (), object(), 3 + 4j, "\0", "ü" * 50, [[1.0], [2.0]], ["momentum"], ["momentum", "x"]]


def one_sentence(text):
    return len(text) > 5 and "\n" not in text.strip()


class Round:
    def __init__(self, seed):
        import momenta
        import numpy
        self.momenta, self.np, self.rng = momenta, numpy, random.Random(seed)
        self.example = EXAMPLES / self.rng.choice(["four_bar", "driven", "free_body", "chain", "bricard"])
        self.text = (self.example / "scene.toml").read_text()
        self.m = momenta.load(str(self.example / "scene.toml"))
        self.start = self.m.assemble()
        self.run = self.m.run(end=0.05, samples=3)
        self.results = 0

    def number(self):
        return self.rng.choice(NUMBERS) if self.rng.random() < 0.5 else self.rng.uniform(-2, 2)

    def array(self, size):
        r, np = self.rng, self.np
        how = r.random()
        if how < 0.1:
            return r.choice(OTHERS + NUMBERS)
        n = size if r.random() < 0.9 else r.randrange(2 * size + 3)
        x = [r.uniform(-1, 1) for _ in range(n)]
        for _ in range(r.choice([0, 0, 0, 1, n])):
            if n:
                x[r.randrange(n)] = r.choice([v for v in NUMBERS if abs(v) < 10**300 or v != v or abs(v) == INF])
        if how < 0.2:
            return x
        a = np.array(x, dtype=float)
        kind = r.randrange(12)
        with np.errstate(all="ignore"):
            return {0: lambda: a.astype(np.float32), 1: lambda: a.reshape(-1, 1), 2: lambda: a[::-1],
                    3: lambda: np.repeat(a, 2)[::2], 4: lambda: a.astype(complex),
                    5: lambda: np.array([str(v) for v in x], dtype=object),
                    6: lambda: a.reshape(1, -1)}.get(kind, lambda: a)()

    def state(self):
        m, s = self.m, self.start
        good = self.rng.random() < 0.5
        return (s.q if good else self.array(m.nq), s.u if good else self.array(m.nv))

    def some(self, choices):
        """Some of the named arguments, right or not."""
        r = self.rng
        return {k: (r.choice(v) if r.random() < 0.7 else r.choice(NUMBERS + OTHERS))
                for k, v in choices.items() if r.random() < 0.3}

    def calls(self):
        m, r, momenta = self.m, self.rng, self.momenta
        t = lambda: 0.0 if r.random() < 0.6 else self.number()
        q, u = self.state()
        p = self.array(m.nv)
        end = {"end": r.choice([0.01, 0.05])}
        common = {"rtol": [1e-6, 1e-3, 0, -1, NAN, 1e300, 1e-300], "end": [0.01, 0, -1, INF, 1e-300],
                  "samples": [1, 3, 0, -1, 2**31 - 1], "step": [1e-3, 0, -1, NAN, 1e300],
                  "reference": ["nowhere.csv", str(self.example), ""], "cpu_limit": [0.2, 1e-9, -1, NAN]}
        forms, methods = momenta.forms(), momenta.integrators()
        gains = {k: [0.0, 1.0, -1.0, NAN, INF, 1e300]
                 for k in ("baumgarte_alpha", "baumgarte_beta", "beta", "penalty")}
        limits = {"cpu_limit": 0.3}
        return [
            ("momentum_rates", lambda: m.momentum_rates(t(), q, p, **self.some(
                {"centre": [None, self.array(m.m)], "leak": [0.0, 3.0, NAN, INF, 1e300],
                 "tau": [None, self.array(m.nv)]}))),
            ("accelerations", lambda: m.accelerations(t(), q, u, **self.some({"tau": [None, self.array(m.nv)]}))),
            ("momenta", lambda: m.momenta(t(), q, u, **self.some({"sigma": [None, self.array(m.m)]}))),
            ("constraints", lambda: m.constraints(t(), q, u)),
            ("kkt", lambda: m.kkt(t(), q)),
            ("inverse_mass_times", lambda: m.inverse_mass_times(t(), q, p)),
            ("energies", lambda: m.energies(t(), q, u)),
            ("evaluate", lambda: m.evaluate(**self.some(
                {"t": [0.0, NAN, 1e300], "q": [q], "v": [u], "p": [p]}))),
            ("move", lambda: m.move(**self.some(
                {"sweep": ["A", "O", "", {"O": 1.0}, {"O": 0}, {}], "to": [None, 1.0, NAN, 1e300],
                 "by": [0.1, 0, -1, NAN, 1e300], "hold": [[], ["A"], ["x"]]}))),
            ("assemblies", lambda: m.assemblies(**{"starts": 5, **self.some(
                {"hold": [[], ["A"], ["O"], ["x"]], "by": ["search", "homotopy", ""], "starts": [1, 0, -1],
                 "seed": [1, 2**63], "threads": [0, 1, -1]})})),
            ("effort", lambda: m.effort(**self.some(
                {"motion": [None, {}, {"t": [0, 1, 2, 3], "O.q": [1, 1.1, 1.2, 1.3]}, {"t": [0.0], "O.q": [NAN]},
                            {"t": [1, 0], "O.q": [0, 1]}],
                 "actuate": [[], ["O"], ["O", "A"], ["x"]], "weights": [{}, {"O": 2.0}, {"O": NAN}, {"x": 1}],
                 "hold": [[], ["A"]], "static": [True, False], "end": [0.1, 0, NAN, 1e300],
                 "samples": [1, 3, 0, -1], "within": [1e-6, 0, NAN]}))),
            ("modes", lambda: m.modes(**self.some(
                {"equilibrium": ["settle", "nearest", "start", ""], "drives": ["held", "running", "x"],
                 "count": [0, 1, -1, 10**6]}))),
            ("linearise", lambda: m.linearise(**self.some(
                {"kind": ["minimal", "descriptor", ""], "t": [0.0, 0.1, NAN, 1e300], "q": [q], "u": [u],
                 "equilibrium": ["", "settle", "x"], "inputs": [[], ["efforts"], ["x"], ["O", "O"]],
                 "outputs": [[], ["rates"], ["x"]], "independent": [[], ["O"], ["A"], ["O", "A"], ["x"]]}))),
            ("gradient", lambda: m.gradient(**{"of": "O.q", "by": ["O.q"], "end": 0.02, **self.some(
                {"of": ["O.q", "energy", "O.q > 1", "x", "", "1/0"],
                 "by": [["O.q"], ["O.u"], ["gravity.1", "O.q"], [], ["x"], ["O.q", "O.q"]],
                 "integral": [True], "form": forms, "gauge": ["", "reset", "leak:nan"],
                 "step": [0.01, 0, NAN], "end": [0.02, 0, NAN], "rtol": [1e-6, NAN, 0],
                 "samples": [1, 0], "trajectory": [True]})})),
            ("fit", lambda: m.fit(**{"vary": ["a"], "sweep": "O", "least": "mean(C.q)", "iterations": 2, **self.some(
                {"vary": [["a"], ["a=0:1"], [], ["x"], ["a", "a"]], "sweep": ["O", "", "x"], "to": ["", "none.csv"],
                 "least": ["", "mean(O.q)", "max(x)", "1/0", "last(O.q)"], "keep": [[], ["a < 1"], ["O.q"]],
                 "over": [(0.0, 0.1), (NAN, 1.0)], "poses": [3, 0, -1], "rate": [1.0, NAN], "starts": [1, 2, 0],
                 "end": [0.02, 0, NAN]})})),
            ("assemble", lambda: m.assemble(*([self.number()] if r.random() < 0.3 else []))),
            ("run", lambda: m.run(**{**end, **limits, **self.some(
                {**common, **gains, "form": forms, "integrator": methods + [""], "project": [True, False],
                 "gauge": ["", "none", "reset", "flip", "leak", "leak:3", "leak:", "leak:nan", "leak:1e400",
                           "leak:-1"], "atol": [1e-6, 0, NAN]})})),
            ("drift", lambda: m.drift(**{**end, **limits, "forms": ["momentum"], "samples": 2, **self.some(
                {**common, "forms": [[r.choice(forms)], ["x"]], "integrator": methods})})),
            ("work", lambda: m.work(**{**end, **limits, "forms": ["momentum"], "tolerances": [1e-4], **self.some(
                {**{k: common[k] for k in ("end", "reference", "cpu_limit")},
                 "forms": [[r.choice(forms)], ["x"]], "integrators": [[r.choice(methods)], ["x"]],
                 "tolerances": [[1e-4], [0.0], [NAN], [1e300], [1e-4] * 3]})})),
            ("load", lambda: momenta.load(*([r.choice(OTHERS + ["nowhere.toml", str(self.example), "/dev/null"])]),
                                          **self.some({"algebra": ["auto", "planar", "spatial", "x"],
                                                       "kkt": ["auto", "sweeps", "sparse", "dense", "x"]}))),
            ("parse", lambda: momenta.parse(r.choice([self.text[:r.randrange(len(self.text))], self.text,
                                                      "\0", "[[body]]"] + OTHERS), **self.some(
                {"name": ["scene", ""], "algebra": ["spatial", "planar"], "kkt": ["dense", "sparse", ""]}))),
            ("evaluate()", lambda: momenta.evaluate(r.choice([m, m, self.text, self.scene()] + OTHERS),
                                                    **self.some({"at": self.states()}))),
            ("index", lambda: momenta.index(r.choice([m, m, self.scene()]), **self.some(
                {"forms": [["momentum"], "momentum", ["x"], [r.choice(forms)]], "at": self.states()}))),
            ("view", lambda: momenta.view(r.choice([m, self.text, self.scene()] + OTHERS))),
            ("sweep", lambda: momenta.sweep(self.text, r.choice([
                {"gravity.1": [-9.81, 1]}, {"gravity.1": "0:-9:2"}, ["gravity.1=1"], {"nowhere": [1]},
                {"gravity.1": []}, {"gravity.1": [NAN]}, {"gravity.9": [1]}, "gravity.1=0:1:0"] + OTHERS),
                **{"end": 0.01, "cpu_limit": 0.3, **self.some(
                    {"watch": ["energy", ["x"], []], "threads": [0, 1, -1], **gains, "form": forms,
                     "samples": [1, 0], "x": [1]})})),
            ("scene", lambda: self.scene().load()),
            ("to_toml", lambda: r.choice([m, self.scene()]).to_toml()),
            ("save", lambda: r.choice([self.scene(), momenta.view(m)]).save(r.choice(
                ["", "/dev/null/x", "/proc/x", str(self.example), "\0"] + OTHERS[-6:]))),
            ("run[...]", lambda: self.run[r.choice(self.run.columns + ["t", "x", ""] + OTHERS)]),
            ("attribute", lambda: getattr(r.choice([self.run, m, self.start]), r.choice(
                [n for n in dir(r.choice([self.run, m, self.start])) if not n.startswith("_")] or ["t"]))),
            ("set", lambda: setattr(r.choice([self.run, m, self.start]), "t", 3)),
        ]

    def states(self):
        """For `at`."""
        names = [n.split(".")[0] for n in self.m.coordinates]
        name = self.rng.choice(names + ["x"])
        return [{}, {"q": {name: self.number()}}, {"v": {name: self.number()}, "t": self.number()},
                {"p": {name: [1, 2]}}, {"q": 3}, {"x": {}}, "{", "{}", '{"q": {}}', "nowhere.json", "[]",
                {"q": {name: NAN}}, {"tau": {name: 1}}, {"q": {name: 1e300}}]

    def scene(self):
        """A scene built with some mistake, or none."""
        r = self.rng
        wild = lambda usual: usual if r.random() < 0.9 else r.choice(NUMBERS + OTHERS[:-6])
        try:
            s = self.momenta.Scene(wild("s"), gravity=wild([0, -9.81, 0]))
            s.body(wild("rod"), mass=wild(1), shape=wild({"kind": "rod", "length": 1}))
            s.joint(wild("O"), wild("revolute"), child=wild("rod"), position=wild(0.3), damping=wild(None))
            if r.random() < 0.5:
                s.loop("L", wild("point"), parent=wild("ground"), child="rod", origin=wild({"parent": [1, 0, 0]}))
            if r.random() < 0.3:
                s.drive(wild("polynomial"), joint=wild("O"), coefficients=wild([0.3, 1]))
            if r.random() < 0.3:
                s.spring(parent="ground", child=wild("rod"), stiffness=wild(3))
            return s
        except (TypeError, ValueError):
            return self.momenta.Scene("empty")

    def finite(self, x):
        """Nothing that is no number in a result of the equations."""
        np = self.np
        if isinstance(x, dict):
            return all(self.finite(v) for k, v in x.items())
        if isinstance(x, (tuple, list)):
            return all(self.finite(v) for v in x)
        if isinstance(x, (float, np.ndarray)) and not isinstance(x, str):
            return bool(np.isfinite(x).all())
        return True

    def judge(self, name, call):
        momenta = self.momenta
        try:
            result = call()
        except TypeError as e:  # a sentence, and the signatures
            assert one_sentence(str(e).split("\n")[0]), (name, str(e))
            return
        except AttributeError as e:
            assert name in ("attribute", "set") and one_sentence(str(e)), (name, str(e))
            return
        except (ValueError, KeyError, IndexError, RuntimeError, OverflowError) as e:
            assert one_sentence(str(e)), (name, str(e))
            return
        self.results += 1
        if name == "run":
            result = [result]
        if name in ("run", "drift", "work"):
            assert result, name
            for run in result:
                assert run.status in ("done", "failed", "time limit", "came apart"), run.status
                assert run.status == "done" or one_sentence(run.reason), (name, run.reason)
                if run.status == "done":
                    assert self.np.isfinite(run.t).all(), name
                    assert self.np.isfinite(run.position_drift).all(), name
        elif name in ("load", "parse", "scene"):
            assert result.nq >= 0
        elif name == "sweep":
            assert len(result) == len(result["status"]) > 0
            for status, reason in zip(result["status"], result["reason"]):
                assert status == "done" or one_sentence(reason), (status, reason)
        elif name in ("view", "to_toml"):
            assert isinstance(result, str) and result
        elif name == "save":
            pass
        elif name == "modes":  # damping ratios of modes at s = 0 are none
            assert all(self.finite(v) for k, v in result.items() if k != "damping_ratio")
        elif name not in ("run[...]", "attribute", "set", "assemble", "index"):
            assert self.finite(result), (name, result)

    def go(self, calls):
        for _ in range(calls):
            name, call = self.rng.choice(self.calls())
            self.judge(name, call)
        assert self.results > calls / 20, self.results


class Calls(unittest.TestCase):
    def test_every_outcome_is_documented(self):
        rounds = int(os.environ.get("MOMENTA_CALLS", "1")) * 4
        for seed in range(rounds):
            with self.subTest(seed=seed):
                done = subprocess.run([sys.executable, __file__, "round", str(seed)], capture_output=True,
                                      text=True, timeout=280)
                self.assertEqual(done.returncode, 0, done.stderr[-3000:])


if __name__ == "__main__":
    if sys.argv[1:2] == ["round"]:
        faulthandler.enable()
        resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)  # for what is saved under any name
            Round(int(sys.argv[2])).go(250)
    else:
        unittest.main()
