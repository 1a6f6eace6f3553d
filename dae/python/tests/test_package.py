"""The package as people meet it: help, stubs, pickles, plots, notebooks, the wheel."""

import ast
import contextlib
import copy
import importlib.util
import inspect
import io
import json
import os
import pathlib
import pickle
import re
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock
import zipfile

import momenta
import numpy as np

EXAMPLES = pathlib.Path(os.environ["MOMENTA_EXAMPLES"])
HERE = pathlib.Path(__file__).resolve().parents[1]


def load(name):
    return momenta.load(EXAMPLES / name / "scene.toml")


def public():
    """(name, object) of what the package offers, members of classes with them."""
    for name in momenta.__all__:
        thing = getattr(momenta, name)
        yield name, thing
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") or member == "__getitem__":
                    yield f"{name}.{member}", value


class Names(unittest.TestCase):
    def test_of_help_are_those_of_the_package(self):
        for name, thing in public():
            text = inspect.getdoc(thing) or ""
            for word in ("::", "_momenta", "std::", "Bench"):
                self.assertNotIn(word, text, name)
            if "." not in name and name != "__version__":
                self.assertEqual(thing.__module__, "momenta", name)
        self.assertIn("-> momenta.Run", momenta.Mechanism.run.__doc__)
        self.assertEqual(repr(momenta.Mechanism), "<class 'momenta.Mechanism'>")
        self.assertEqual(repr(momenta.SceneError), "<class 'momenta.SceneError'>")

    def test_everything_public_is_described(self):
        for name, thing in public():
            self.assertTrue(inspect.getdoc(thing), name)

    def test_version(self):
        project = (HERE.parents[1] / "CMakeLists.txt").read_text()
        version = re.search(r"project\(momenta VERSION ([\d.]+)", project).group(1)
        self.assertEqual(momenta.__version__, version)


def signature_of(thing):
    """[(name, whether by name alone)] of a function; the compiled ones say it in their first line."""
    if not isinstance(thing, (types.FunctionType, types.MethodType)):
        first = (thing.__doc__ or "").partition("\n")[0]
        inside = re.search(r"\((.*)\) -> ", first).group(1)
        while "[" in inside:
            inside = re.sub(r"\[[^\[\]]*\]", "()", inside)
        thing = eval("lambda " + re.sub(r": [\w.]+(\(\))?", "", inside) + ": 0", {}, {})
    kinds = {"KEYWORD_ONLY": "*", "VAR_KEYWORD": "**", "VAR_POSITIONAL": "..."}
    parameters = inspect.signature(thing).parameters.values()
    return [(p.name, kinds.get(p.kind.name, "")) for p in parameters]


def written_signature(node):
    a = node.args
    names = [(x.arg, "") for x in a.args] + ([(a.vararg.arg, "...")] if a.vararg else [])
    return names + [(x.arg, "*") for x in a.kwonlyargs] + ([(a.kwarg.arg, "**")] if a.kwarg else [])


class Stubs(unittest.TestCase):
    def setUp(self):
        stub = pathlib.Path(momenta.__file__).with_suffix(".pyi")
        self.nodes = ast.parse(stub.read_text()).body
        self.assertTrue((stub.parent / "py.typed").is_file())

    def test_names_and_arguments_are_those_of_the_package(self):
        written = {}
        for node in self.nodes:
            if isinstance(node, ast.FunctionDef):
                written[node.name] = node
            elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                written[node.name] = None
                for member in node.body:
                    if isinstance(member, ast.FunctionDef):
                        written[f"{node.name}.{member.name}"] = member
        there = dict(public())
        of_python = {"Scene.__init__", "Scene.__eq__", "Study.__init__", "Sweep.__len__"}
        of_python |= {name for name in written if name.startswith("Formula.__")}
        self.assertEqual(set(written) - of_python, set(there) - {"__version__"})
        for name, node in written.items():
            if node is None or name in of_python - {"Scene.__init__", "Study.__init__"}:
                continue
            owner = getattr(momenta, name.partition(".")[0])
            thing = there.get(name) or owner.__init__
            is_property = any(getattr(d, "id", "") == "property" for d in node.decorator_list)
            self.assertEqual(isinstance(thing, property), is_property, name)
            if not is_property:
                thing = getattr(thing, "__func__", thing)
                self.assertEqual(signature_of(thing), written_signature(node), name)


class Pickles(unittest.TestCase):
    def test_scene(self):
        scene = momenta.Scene("s", gravity=[0, 0, -9.81]).body("b", mass=1, inertia=1)
        self.assertEqual(pickle.loads(pickle.dumps(scene)), scene)
        self.assertNotEqual(copy.deepcopy(scene).body("c", mass=1), scene)

    def test_mechanism(self):
        for name in ("four_bar", "driven", "spatial_slider_crank"):
            m = load(name)
            again = pickle.loads(pickle.dumps(m))
            for what in ("name", "options", "equations"):
                self.assertEqual(getattr(again, what), getattr(m, what))
            self.assertEqual(again.to_toml(), m.to_toml())
            for a, b in zip(m.accelerations(0.0, m.q0, m.u0), again.accelerations(0.0, m.q0, m.u0)):
                np.testing.assert_array_equal(a, b)
        planar = momenta.load(EXAMPLES / "four_bar" / "scene.toml", algebra="spatial", kkt="dense")
        self.assertEqual(copy.deepcopy(planar).options, {"algebra": "spatial", "kkt": "dense", "cut": "auto"})

    def test_run(self):
        run = load("four_bar").run(end=1, samples=30)
        again = pickle.loads(pickle.dumps(run))
        for name, value in vars(momenta.Run).items():
            if isinstance(value, property):
                np.testing.assert_array_equal(getattr(again, name), getattr(run, name), name)
        np.testing.assert_array_equal(again["O.q"], run["O.q"])

    def test_failed_run_and_study(self):
        failed = load("four_bar").run(end=100, rtol=1e-12, samples=100000, cpu_limit=1e-9)
        again = pickle.loads(pickle.dumps(failed))
        self.assertEqual((again.status, again.reason), (failed.status, failed.reason))
        self.assertNotEqual(again.status, "done")
        study = load("four_bar").drift(forms=["momentum"], end=0.2, samples=5)
        again = pickle.loads(pickle.dumps(study))
        self.assertEqual((len(again), again.table), (len(study), study.table))
        self.assertRegex(repr(study), r"momentum +rk4 .* done ")
        self.assertIsInstance(again, momenta.Study)
        self.assertFalse(again.ladder)

    def test_what_is_no_pickle(self):
        for thing in (load("four_bar"), load("four_bar").run(end=0.1)):
            with self.assertRaisesRegex(ValueError, "this is no pickled"):
                type(thing).__new__(type(thing)).__setstate__(("x",))


class Axes:
    """Takes note of what is drawn on it."""

    def __init__(self):
        self.lines, self.labels = [], {}

    def _draw(self, x, y, *style, label=""):
        self.lines.append((label, np.array(x), np.array(y)))

    plot = semilogy = loglog = _draw

    def set_xlabel(self, text):
        self.labels["x"] = text

    def set_ylabel(self, text):
        self.labels["y"] = text

    def legend(self):
        pass

    def grid(self, *style, **more):
        pass


class Plots(unittest.TestCase):
    def test_of_a_run(self):
        run = load("four_bar").run(end=0.5, samples=10)
        ax = run.plot("O.q", "B.x", ax=Axes())
        self.assertEqual([label for label, _, _ in ax.lines], ["O.q", "B.x"])
        np.testing.assert_array_equal(ax.lines[1][1], run.t)
        np.testing.assert_array_equal(ax.lines[1][2], run["B.x"])
        self.assertEqual(len(run.plot(ax=Axes()).lines), 3)

    def test_of_studies(self):
        m = load("four_bar")
        study = m.drift(forms=["momentum", "acceleration"], end=0.5, samples=10)
        ax = study.plot("velocity_drift", ax=Axes())
        self.assertEqual((len(ax.lines), ax.labels["y"]), (len(study), "velocity drift [m/s]"))
        work = m.work(forms=["momentum", "acceleration"], tolerances=[1e-4, 1e-6, 1e-8], end=0.5)
        ax = work.plot(ax=Axes())
        self.assertEqual([len(x) for _, x, _ in ax.lines], [3, 3])
        self.assertTrue(work.ladder)

    def test_of_a_sweep(self):
        sweep = momenta.sweep(load("four_bar"), {"gravity.1": [-9, -5], "run.leak": [1, 2, 3]}, end=0.2)
        ax = sweep.plot("steps", ax=Axes())
        self.assertEqual([label for label, _, _ in ax.lines], [f"run.leak = {x}" for x in (1, 2, 3)])
        np.testing.assert_array_equal(ax.lines[0][1], [-9, -5])
        self.assertEqual(ax.labels, {"x": "gravity.1", "y": "steps"})

    def test_without_matplotlib_one_sentence(self):
        run = load("four_bar").run(end=0.1)
        with unittest.mock.patch.dict(sys.modules, {"matplotlib": None}):
            with self.assertRaisesRegex(ImportError, "there is no matplotlib: install python3-matplotlib"):
                run.plot()

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "no matplotlib")
    def test_by_matplotlib(self):
        import matplotlib

        matplotlib.use("Agg")
        m = load("four_bar")
        for ax in (m.run(end=0.1).plot(), m.drift(forms=["momentum"], end=0.1).plot()):
            ax.figure.savefig(io.BytesIO())


class Notebooks(unittest.TestCase):
    def test_they_run_and_hold_no_results(self):
        lessons = sorted((HERE.parents[1] / "docs" / "index-reduction" / "notebooks").glob("*.ipynb"))
        self.assertEqual([file.name[0] for file in lessons], list("12345678"))
        notebooks = sorted((HERE / "examples").glob("*.ipynb")) + lessons
        self.assertGreaterEqual(len(notebooks), 10)
        pyplot = types.ModuleType("matplotlib.pyplot")
        pyplot.subplots = lambda: (None, Axes())
        package = types.ModuleType("matplotlib")
        package.pyplot = pyplot
        drawn = {"matplotlib": package, "matplotlib.pyplot": pyplot}
        for file in notebooks:
            notebook = json.loads(file.read_text())
            self.assertEqual(notebook["nbformat"], 4)
            names = {}
            with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
                with unittest.mock.patch.dict(sys.modules, drawn), contextlib.redirect_stderr(io.StringIO()), \
                        contextlib.redirect_stdout(io.StringIO()):
                    for number, cell in enumerate(notebook["cells"]):
                        if cell["cell_type"] != "code":
                            continue
                        self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), file.name)
                        with self.subTest(file.name, cell=number):
                            exec(compile("".join(cell["source"]), f"{file.name}:{number}", "exec"), names)


class Wheel(unittest.TestCase):
    """Built from the compiled part that is there; building that is the build's own matter."""

    @unittest.skipUnless(importlib.util.find_spec("pip"), "no pip")
    def test_pip_installs_it_without_a_network(self):
        clean = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "MOMENTA_BUILD")}

        def call(*command):
            result = subprocess.run(command, env=clean, capture_output=True, text=True, cwd=folder)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            return result.stdout

        with tempfile.TemporaryDirectory() as folder:
            call(sys.executable, "-m", "venv", "--system-site-packages", "--without-pip", folder)
            python = str(pathlib.Path(folder) / "bin" / "python")
            pip = [python, "-m", "pip", "--disable-pip-version-check", "--no-cache-dir", "install"]
            given = ["--config-settings", f"build={os.environ['MOMENTA_BUILD']}"]
            for isolation in ([], ["--no-build-isolation"]):
                call(*pip, "--no-index", *isolation, *given, "--force-reinstall", "--no-deps", HERE)
                asked = "import momenta as m; print(m.__version__, m.__file__, len(m.forms()))"
                version, file, forms = call(python, "-c", asked).split()
                self.assertEqual((version, int(forms)), (momenta.__version__, len(momenta.forms())))
                self.assertTrue(os.path.samefile(pathlib.Path(file).parents[4], folder), file)
            call(*pip, "--no-index", *given, HERE)  # with what it needs, which is there

    def test_what_it_holds_and_what_it_says(self):
        spec = importlib.util.spec_from_file_location("backend", HERE / "backend.py")
        backend = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(backend)
        with tempfile.TemporaryDirectory() as folder:
            name = backend.build_wheel(folder, {"build": os.environ["MOMENTA_BUILD"]})
            with zipfile.ZipFile(pathlib.Path(folder) / name) as wheel:
                held = set(wheel.namelist())
                info = f"momenta-{momenta.__version__}.dist-info"
                recorded = wheel.read(f"{info}/RECORD").decode().splitlines()
            self.assertEqual({line.split(",")[0] for line in recorded}, held)
            installed = {p.name for p in pathlib.Path(momenta.__file__).parent.iterdir() if p.is_file()}
            self.assertEqual({x.partition("/")[2] for x in held if x.startswith("momenta/")}, installed)
            with self.assertRaisesRegex(SystemExit, "is not there; expected a build folder"):
                backend.build_wheel(folder, {"build": folder})
        with self.assertRaisesRegex(SystemExit, "expected `pip wheel ./dae/python`"):
            backend.build_sdist("")


if __name__ == "__main__":
    unittest.main()
