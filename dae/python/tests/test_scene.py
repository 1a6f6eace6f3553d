"""Scenes built in Python: the same as scene files, and checked by the reader of scene files alone."""

import ast
import os
import pathlib
import tempfile
import tomllib
import unittest

import momenta
import numpy as np

try:
    import sympy
except ImportError:
    sympy = None

EXAMPLES = pathlib.Path(os.environ["MOMENTA_EXAMPLES"])


def four_bar():
    s = momenta.Scene("four-bar", gravity=[0, -9.81, 0])
    for name, length in [("crank", 1), ("coupler", 2.0), ("rocker", np.float64(1.5))]:
        s.body(name, mass=1, shape={"kind": "rod", "length": length})
    s.joint("O", "revolute", child="crank", position=1.0)
    s.joint("A", "revolute", parent="crank", child="coupler", origin={"parent": [1, 0, 0]}, position=-0.5)
    s.joint("C", "revolute", child="rocker", origin={"parent": np.array([2.0, 0, 0])}, position=1.5)
    s.loop("B", "revolute", parent="coupler", child="rocker", origin={"parent": [2, 0, 0], "child": [1.5, 0, 0]})
    return s.marker("B", "rocker", point=[1.5, 0, 0]).run(end=2, samples=20)


class Built(unittest.TestCase):
    def test_every_example_comes_through_a_dict_and_back(self):
        files = sorted(EXAMPLES.glob("*/*.toml"))
        self.assertGreater(len(files), 10)
        for file in files:
            with self.subTest(file.name):
                keys = tomllib.loads(file.read_text())
                scene = momenta.Scene.from_dict(keys)
                self.assertEqual(scene.to_dict(), keys)
                self.assertEqual(tomllib.loads(scene.to_toml()), keys)
                self.assertEqual(scene.load().to_toml(), momenta.load(file).to_toml())

    def test_the_builder_says_what_the_file_says(self):
        text = """
            name = "pendulum"
            gravity = [0, 0, -9.81]
            assembly.hold = ["O"]
            run.end = 3
            [[body]]
            name = "bob"
            mass = 2
            com = [0, 0, -0.5]
            inertia = 0.1
            [[body]]
            name = "slide"
            mass = 1
            inertia = 1
            [[joint]]
            name = "O"
            kind = "revolute"
            child = "bob"
            axis = "y"
            damping = 0.1
            [[joint]]
            name = "S"
            kind = "prismatic"
            parent = "bob"
            child = "slide"
            [[force]]
            kind = "spring-damper"
            child = "bob"
            stiffness = 3
            origin = { parent = [1, 0, 0] }
            [[drive]]
            kind = "harmonic"
            joint = "S"
            amplitude = 1e-3
            frequency = 2
        """
        s = momenta.Scene("pendulum", gravity=[0, 0, -9.81])
        s.body("bob", mass=2, com=[0, 0, -0.5], inertia=0.1).body("slide", mass=1, inertia=1)
        s.joint("O", "revolute", child="bob", axis="y", damping=0.1)
        s.joint("S", "prismatic", parent="bob", child="slide")
        s.spring(child="bob", stiffness=3, origin={"parent": [1, 0, 0]})
        s.drive("harmonic", joint="S", amplitude=1e-3, frequency=2)
        s.run(end=3).assembly(hold=["O"])
        self.assertEqual(momenta.load(s).to_toml(), momenta.load(text).to_toml())
        self.assertEqual(s.load().run().t[-1], 3)

    def test_arrays_become_lists_and_what_is_none_is_left_out(self):
        s = momenta.Scene(gravity=np.array([0, -9.81, 0])).body("b", mass=np.int64(1), com=None)
        self.assertEqual(s.to_dict(), {"gravity": [0, -9.81, 0], "body": [{"name": "b", "mass": 1}]})
        s.body("c", mass=0.5, any_inertia=False).run(project=True)
        self.assertEqual(tomllib.loads(s.to_toml()), s.to_dict())
        s.to_dict()["body"][0]["mass"] = 2
        self.assertEqual(s.to_dict()["body"][0]["mass"], 1)

    def test_names_may_hold_anything_a_file_holds(self):
        name = 'é "quoted" \\ 5\N{DEGREE SIGN} \N{MUSICAL SYMBOL G CLEF}'
        s = momenta.Scene(name).body(name, mass=1, inertia=1).joint("J", "revolute", child=name)
        self.assertEqual(s.load().name, name)
        self.assertEqual(tomllib.loads(momenta.Scene("\x7f\t\n\x01").to_toml())["name"], "\x7f\t\n\x01")

    def test_it_is_loaded_from_anything(self):
        s = four_bar()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.toml"
            s.save(file)
            texts = [momenta.load(x).to_toml() for x in (s, s.to_dict(), s.to_toml(), file, str(file))]
        self.assertEqual(set(texts), {s.load().to_toml()})
        self.assertEqual(s.load().run().status, "done")

    def test_every_verb_takes_it(self):
        s = four_bar()
        run = momenta.run(s, form="projected", end=1)
        self.assertEqual((run.status, run.t[-1]), ("done", 1))
        np.testing.assert_array_equal(run["B.x"], s.load().run(form="projected", end=1)["B.x"])
        self.assertIn("q", momenta.evaluate(s))
        self.assertIn("<html", momenta.view(s))
        self.assertEqual(len(momenta.sweep(s, {"body.crank.mass": [1, 2]}, watch="B.x", end=0.1)["B.x last"]), 2)

    def test_a_key_that_is_a_word_of_python(self):
        s = momenta.Scene().drive("step", joint="O", from_=0.5, to=1, duration=1)
        self.assertEqual(s.to_dict()["drive"][0]["from"], 0.5)
        self.assertIn("\nfrom = 0.5\n", s.to_toml())

    def test_formulas_move_as_bodies_do(self):
        hinge = momenta.Scene("pendulum", gravity=[0, -9.81, 0])
        hinge.body("bob", mass=2, com=[1, 0, 0], inertia=0).joint("O", "revolute", child="bob", position=-0.5)
        typed = momenta.Scene("pendulum", parameters={"m": 2, "g": 9.81})
        typed.lagrangian(["x", "y"], position=["cos(0.5)", "-sin(0.5)"], kinetic="m/2*(x.dot^2 + y.dot^2)")
        typed.lagrangian(["x", "y"], potential="m*g*y").constraint("rod", "hypot(x, y) - 1")
        a = hinge.load().run(form="projected", rtol=1e-11, end=1)
        b = typed.load().run(form="projected", rtol=1e-11, end=1)
        self.assertAlmostEqual(np.cos(a["O.q"][-1]), b["x"][-1], 8)
        m = typed.load()
        self.assertEqual((m.nq, m.nv, m.m), (2, 2, 1))
        np.testing.assert_allclose(m.momenta(0, [1, 0], [3, 4]), [6, 8])

    @unittest.skipIf(sympy is None, "SymPy is not installed")
    def test_formulas_are_taken_from_sympy(self):
        x, rate, m = sympy.symbols("x x.dot m")
        typed = momenta.Scene(parameters={"m": 2})
        typed.lagrangian(["x"], lagrangian=m * rate**2 / 2 - sympy.Abs(x) ** 3 / 3, force={"x": -rate})
        self.assertEqual(typed.to_dict()["lagrangian"]["force"], {"x": "-x.dot"})
        self.assertNotIn("**", typed.to_toml())
        np.testing.assert_allclose(typed.load().accelerations(0, [-2], [1])[0], [(4 - 1) / 2])

    def test_it_starts_elsewhere(self):
        m = momenta.load(EXAMPLES / "four_bar" / "scene.toml", at={"v": {"O": np.float64(0.5)}})
        self.assertEqual(m.u0[0], 0.5)
        with self.assertRaisesRegex(momenta.SceneError, "joint 'X' is not in the scene"):
            four_bar().load(at={"q": {"X": 1}})

    def test_urdf_says_what_was_left_out(self):
        file = next((EXAMPLES / "models").glob("*/*.urdf"))
        self.assertIsInstance(momenta.load(file, free_root=True).remarks, list)
        with self.assertRaisesRegex(ValueError, "expected none with a scene given as text"):
            momenta.load(four_bar(), free_root=True)


class Loaded(unittest.TestCase):
    """What --set, --control and --stops do, from Python."""

    def test_numbers_are_set(self):
        file = EXAMPLES / "four_bar" / "scene.toml"
        text = file.read_text()
        for scene in (file, text, tomllib.loads(text)):
            m = momenta.load(scene, set={"body.crank.mass": 3.5, "gravity.1": -1})
            self.assertEqual(tomllib.loads(m.to_toml())["body"][0]["mass"], 3.5)
            self.assertNotEqual(m.to_toml(), momenta.load(scene).to_toml())
        text = "[parameters]\na = 2\n[[body]]\nname='b'\nmass='3*a'\ninertia=1\n[[joint]]\nname='j'\nkind='revolute'\nchild='b'\n"
        m = momenta.load(text, set={"a": 5})
        self.assertEqual(tomllib.loads(m.to_toml())["body"][0]["mass"], 15)
        with self.assertRaisesRegex(ValueError, "'b': the scene has no parameter of that name"):
            momenta.load(text, set={"b": 5})
        with self.assertRaisesRegex(ValueError, "expected a finite number"):
            momenta.load(text, set={"a": float("nan")})

    def test_actuators_act(self):
        file = EXAMPLES / "models" / "mujoco_small" / "humanoid.xml"
        free = momenta.load(file)

        def at(m):
            return np.asarray(m.accelerations(0, m.q0, m.u0)[0])

        all_at_one = momenta.load(file, control=0.2)
        one = momenta.load(file, control={"knee_right": 0.2})
        self.assertGreater(abs(at(all_at_one) - at(free)).max(), 1)
        self.assertGreater(abs(at(one) - at(free)).max(), 1)
        self.assertGreater(abs(at(one) - at(all_at_one)).max(), 1)
        self.assertEqual(abs(at(momenta.load(file, control={})) - at(momenta.load(file, control=0))).max(), 0)
        with self.assertRaisesRegex(momenta.SceneError, "actuator .knee. is not in the file"):
            momenta.load(file, control={"knee": 1})
        with self.assertRaisesRegex(ValueError, "control are of a robot's file"):
            momenta.load(four_bar().to_toml(), control=1)

    def test_limits_stop(self):
        file = EXAMPLES / "models" / "panda_urdf" / "panda.urdf"
        joint = tomllib.loads(momenta.load(file, stops=(1e4, 100)).to_toml())["joint"][1]
        self.assertEqual((joint["stop_stiffness"], joint["stop_damping"]), (1e4, 100))
        self.assertNotIn("stop_damping", tomllib.loads(momenta.load(file, stops=1e4).to_toml())["joint"][1])
        with self.assertRaisesRegex(momenta.SceneError, "stop_stiffness and stop_damping must be finite and >= 0"):
            momenta.load(file, stops=-1)
        with self.assertRaisesRegex(ValueError, "stops are a stiffness"):
            momenta.load(file, stops=(1, 2, 3))


class Mistakes(unittest.TestCase):
    def expect(self, words, make, kind=momenta.SceneError):
        with self.assertRaises(kind) as caught:
            make()
        self.assertIn(words, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_the_reader_names_owner_and_key(self):
        self.expect("body 'x': unknown key 'mas'; did you mean 'mass'?", momenta.Scene().body("x", mas=1).load)
        self.expect("joint 'J': axis is", four_bar().joint("J", "revolute", child="crank", axis=3).load)
        self.expect("four-bar:", four_bar().body("crank", mass=1, inertia=1).load)
        self.expect("unknown key 'bodi'; did you mean 'body'?", momenta.Scene(bodi=[{}]).load)
        self.expect("mass is nan", momenta.Scene().body("x", mass=float("nan")).load)
        self.expect("not representable in 64 bits", momenta.Scene().body("x", mass=10**30).load)

    def test_what_no_file_can_hold(self):
        self.expect("found (1+2j)", lambda: momenta.Scene().body("x", mass=1 + 2j), TypeError)
        self.expect("found int", lambda: momenta.load(3), TypeError)
        self.expect("found list", lambda: momenta.Scene.from_dict([]), TypeError)
        self.expect("surrogates", lambda: momenta.Scene("\ud800").load(), ValueError)


class Keys(unittest.TestCase):
    """The stub's keys are those that the reader knows: it lists them where it meets another."""

    tables = {  # of the stub: key of the scene, its kinds, what the builder's methods take by name
        "_BodyKeys": ("body", [None], {"name"}),
        "_JointKeys": ("joint", ["revolute"], {"name", "kind"}),
        "_LoopKeys": ("loop", ["distance", "coupler", "slot", "cam", "rack", "equation", "rolling"], {"name", "kind"}),
        "_DriveKeys": ("drive", ["polynomial", "harmonic", "step", "table", "formula"], {"kind"}),
        "_ForceKeys": (
            "force",
            ["spring-damper", "bushing", "coordinate-spring", "torque", "wrench", "potential"],
            {"kind"},
        ),
        "_SpringKeys": ("force", ["spring-damper"], {"kind"}),
        "_MarkerKeys": ("marker", [None], {"name", "body"}),
        "_EventKeys": ("event", [None], {"when"}),
        "_VisualKeys": ("visual", ["box", "capsule", "mesh"], {"body", "kind"}),
        "_LagrangianKeys": ("lagrangian", [None], {"coordinates"}),
        "_AssemblyKeys": ("assembly", [None], set()),
        "_RunTableKeys": ("run", [None], set()),
        "_SceneKeys": (None, [None], {"name"}),
    }

    def test_of_stubs(self):
        stub = ast.parse(pathlib.Path(momenta.__file__).with_suffix(".pyi").read_text())
        written = {c.name: c for c in stub.body if isinstance(c, ast.ClassDef)}

        def keys_of(name):
            own = {item.target.id.removesuffix("_") for item in written[name].body if isinstance(item, ast.AnnAssign)}
            return own.union(*(keys_of(b.id) for b in written[name].bases if b.id in written))

        for name, (key, kinds, others) in self.tables.items():
            with self.subTest(name):
                known = set().union(*(self.known(key, kind) for kind in kinds))
                self.assertEqual(keys_of(name) | others, known)

    def known(self, key, kind):
        table = {"kind": kind, "xyzzy": 1} if kind else {"xyzzy": 1}
        body, joint = {"name": "b", "mass": 1, "inertia": 1}, {"name": "J", "kind": "weld", "child": "b"}
        keys = {"body": [body], "joint": [joint]}
        keys |= {key: table if key in ("assembly", "run", "lagrangian") else [table]} if key else table
        with self.assertRaises(momenta.SceneError) as caught:
            momenta.load(keys)
        self.assertRegex(str(caught.exception), "unknown key '[a-z.]*xyzzy'")
        return set(str(caught.exception).partition("expected one of: ")[2].split(", "))


if __name__ == "__main__":
    unittest.main()
