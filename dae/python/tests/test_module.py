"""The Python module: laws of the equations, views without copies, sentences for what is wrong."""

import gc
import os
import pathlib
import pickle
import runpy
import signal
import threading
import time
import unittest

import momenta
import numpy as np

EXAMPLES = pathlib.Path(os.environ["MOMENTA_EXAMPLES"])


def load(name):
    return momenta.load(str(EXAMPLES / name / "scene.toml"))


class Equations(unittest.TestCase):
    def setUp(self):
        self.m = load("andrews")
        self.start = self.m.assemble()
        self.rng = np.random.default_rng(1)

    def test_kkt_solution_solves_the_kkt_system(self):
        m, q = self.m, self.start.q
        p = self.rng.normal(size=m.nv) * 1e-5
        u, sigma, pdot = m.momentum_rates(0.0, q, p)
        M, J = m.kkt(0.0, q)
        self.assertEqual((M.shape, J.shape), ((m.nv, m.nv), (m.m, m.nv)))
        scale = np.abs(p).max()
        np.testing.assert_allclose(M @ u + J.T @ sigma, p, atol=1e-12 * scale)
        np.testing.assert_allclose(J @ u, 0, atol=1e-12 * np.abs(J).max() * np.abs(u).max())
        np.testing.assert_allclose(m.momenta(0.0, q, u, sigma), p, atol=1e-12 * scale)
        udot, lam = m.accelerations(0.0, q, np.zeros(m.nv))
        np.testing.assert_allclose(J @ udot, 0, atol=1e-9 * np.abs(udot).max())
        np.testing.assert_allclose(udot, self.start.udot, rtol=1e-8, atol=1e-8)

    def test_joint_forces_in_both_forms_and_of_many_states(self):
        chain = momenta.load(str(EXAMPLES / "chain" / "scene.toml"))
        for m, q0 in (self.m, self.start.q), (chain, chain.q0):
            tau = self.rng.normal(size=m.nv) * 1e-3
            u = np.asarray(m.u0) + 0.1
            M, J = m.kkt(0.0, q0)
            p = m.momenta(0.0, q0, u)
            free, pushed = m.momentum_rates(0.0, q0, p), m.momentum_rates(0.0, q0, p, tau=tau)
            np.testing.assert_allclose(pushed[2] - free[2], tau, atol=1e-12 * np.abs(free[2]).max() + 1e-15)
            np.testing.assert_array_equal(pushed[0], free[0])
            still, moved = m.accelerations(0.0, q0, u), m.accelerations(0.0, q0, u, tau=tau)
            change, load = moved[0] - still[0], moved[1] - still[1]
            size = np.abs(M).max() * np.abs(moved[0]).max()
            np.testing.assert_allclose(M @ change + J.T @ load, tau, atol=1e-9 * size)
            self.assertGreater(np.abs(change).max(), 0)

            turns = np.linspace(0, 1e-3, 11)  # more than a register holds, and no multiple of it
            q = np.ascontiguousarray(q0[:, None] + turns)
            ps, us = np.repeat(p[:, None], 11, 1), np.repeat(u[:, None], 11, 1)
            taus = tau[:, None] * (1 + turns)
            for leak, threads in (0.0, 1), (3.0, 2):
                qdot, pdot = m.rates_of_states(0.0, q, ps, tau=taus, leak=leak, threads=threads)
                udot, lam = m.accelerations_of_states(0.0, q, us, tau=taus, threads=threads)
                self.assertEqual((qdot.shape, pdot.shape, udot.shape, lam.shape),
                                 ((m.nq, 11), (m.nv, 11), (m.nv, 11), (m.m, 11)))
                for i in range(11):
                    one = m.momentum_rates(0.0, q[:, i], p, leak=leak, tau=taus[:, i])
                    np.testing.assert_allclose(qdot[:, i], one[0], atol=1e-10 * np.abs(one[0]).max())
                    np.testing.assert_allclose(pdot[:, i], one[2], atol=1e-10 * np.abs(one[2]).max())
                    one = m.accelerations(0.0, q[:, i], u, tau=taus[:, i])
                    np.testing.assert_allclose(udot[:, i], one[0], atol=1e-9 * np.abs(one[0]).max())
            plain = m.rates_of_states(0.0, q, ps)
            np.testing.assert_allclose(m.rates_of_states(0.0, q, ps, tau=taus)[1] - plain[1], taus,
                                       atol=1e-12 * np.abs(plain[1]).max() + 1e-15)
            with self.assertRaisesRegex(ValueError, "a column of p has 1 number, expected"):
                m.rates_of_states(0.0, q, ps[:1])
            with self.assertRaisesRegex(ValueError, "tau has 1 number"):
                m.accelerations(0.0, q0, u, tau=tau[:1])
            ps[0, 4] = np.nan
            with self.assertRaisesRegex(momenta.SceneError, "state 4: p\\[0\\] is not a number"):
                m.rates_of_states(0.0, q, ps)

    def test_inverse_mass(self):
        M, _ = self.m.kkt(0.0, self.start.q)
        x = self.rng.normal(size=self.m.nv)
        np.testing.assert_allclose(M @ self.m.inverse_mass_times(0.0, self.start.q, x), x, atol=1e-10)

    def test_lagrangians_with_and_without_constraints(self):
        for name in "double_pendulum", "car_axis":
            m = momenta.load(str(EXAMPLES / "lagrangian" / f"{name}.toml"))
            q = m.assemble().q
            u, x, tau = self.rng.normal(size=(3, m.nv))
            M, J = m.kkt(0.0, q)
            size = np.abs(M).max()
            np.testing.assert_allclose(M @ m.inverse_mass_times(0.0, q, x), x, atol=1e-12)
            udot, lam = m.accelerations(0.0, q, u, tau=tau)
            still = m.accelerations(0.0, q, u)
            np.testing.assert_allclose(M @ (udot - still[0]) + J.T @ (lam - still[1]), tau,
                                       atol=1e-9 * (1 + size * np.abs(udot).max()))
            all_udot, _ = m.accelerations_of_states(0.0, q[:, None], u[:, None], tau=tau[:, None])
            np.testing.assert_allclose(all_udot[:, 0], udot, rtol=1e-12)
            p = m.momenta(0.0, q, u)
            qdot, pdot = m.rates_of_states(0.0, q[:, None], p[:, None])
            one = m.momentum_rates(0.0, q, p)
            np.testing.assert_allclose(qdot[:, 0], one[0], rtol=1e-12)
            np.testing.assert_allclose(pdot[:, 0], one[2], rtol=1e-12)

    def test_constraints_hold_and_energy_is_that_of_the_mass_matrix(self):
        m, s = self.m, self.start
        phi, rate = m.constraints(0.0, s.q, s.u)
        self.assertLess(np.abs(phi).max(), 1e-12)
        self.assertLess(np.abs(rate).max(), 1e-12)
        u = self.rng.normal(size=m.nv)
        kinetic, _ = m.energies(0.0, s.q, u)
        M, _ = m.kkt(0.0, s.q)
        self.assertAlmostEqual(kinetic, u @ M @ u / 2, delta=1e-12 * kinetic)

    def test_evaluate_agrees(self):
        values = self.m.evaluate(q=self.start.q, p=np.zeros(self.m.nv))
        u, sigma, pdot = self.m.momentum_rates(0.0, self.start.q, np.zeros(self.m.nv))
        np.testing.assert_allclose(values["pdot"], pdot, atol=1e-12)
        self.assertIn("O", values["reactions"])
        self.assertEqual(values["rank"], self.m.m)

    def test_names(self):
        m = self.m
        self.assertEqual([len(m.coordinates), len(m.rates), len(m.equations)], [m.nq, m.nv, m.m])
        self.assertEqual(m.coordinates[0], "O.q [rad]")
        self.assertIn("loops", m.plan)
        self.assertIn("6 loop equations", repr(m))

    def test_open_chain(self):
        m = load("chain")
        self.assertEqual(m.m, 0)
        q = self.rng.normal(size=m.nq) if m.nq == m.nv else m.assemble().q
        u = self.rng.normal(size=m.nv)
        p = m.momenta(0.0, q, u)
        back, sigma, _ = m.momentum_rates(0.0, q, p)
        np.testing.assert_allclose(back, u, atol=1e-9)
        self.assertEqual(sigma.size, 0)


class Poses(unittest.TestCase):
    def test_a_crank_goes_round_and_its_rocker_swings(self):
        m = load("four_bar")
        found = m.move("O")
        self.assertEqual((found["end"], found["dead_points"]), ("closed", []))
        self.assertEqual(found["q"].shape, (361, m.nq))
        u, s = found["ratios"], found["displacement"]
        np.testing.assert_allclose(u[:, 0], 1)
        np.testing.assert_allclose(np.gradient(found["q"][:, 2], s)[1:-1], u[1:-1, 2], atol=2e-4)
        np.testing.assert_allclose(np.gradient(u[:, 2], s)[1:-1], found["ratio_rates"][1:-1, 2], atol=2e-3)
        by_rocker = m.move({"C": 1.0})
        self.assertEqual(len(by_rocker["dead_points"]), 2)
        np.testing.assert_allclose(by_rocker["reach"]["C.q"], found["reach"]["C.q"], atol=1e-9)
        with self.assertRaisesRegex(momenta.SceneError, "coordinate 'x' is not known"):
            m.move("x")

    def test_force_to_an_output_goes_by_the_transmission_angle(self):
        m = load("four_bar")
        found = m.move("O", by=0.2, output="C")
        # One force goes through all pins: its moment about C, the rocker's length 1.5, is 1.
        np.testing.assert_allclose(1.5 * found["joint_force"] * np.sin(found["transmission_angle"]), 1)
        self.assertNotIn("joint_force", m.move("O", by=0.5))


class Assemblies(unittest.TestCase):
    def test_of_a_four_bar_are_two_by_search_and_by_homotopy(self):
        m = load("four_bar")
        found = m.assemblies(["O"], starts=50)
        every = m.assemblies(["O"], by="homotopy")
        self.assertEqual((found["starts"], found["q"].shape), (50, (2, m.nq)))
        np.testing.assert_allclose(every["q"], found["q"], atol=1e-9)
        self.assertEqual(
            every["paths"],
            {"followed": 2, "finite": 2, "infinite": 0, "singular": 0, "lost": 0, "real": 2, "complete": True},
        )
        for q in every["q"]:
            np.testing.assert_allclose(m.constraints(0, q, np.zeros(m.nv))[0], 0, atol=1e-12)
        with self.assertRaisesRegex(momenta.SceneError, "leaves 1 degree of freedom"):
            m.assemblies()
        with self.assertRaisesRegex(ValueError, "expected 'search' or 'homotopy'"):
            m.assemblies(["O"], by="x")

    def test_of_a_platform_and_of_an_arm_in_space_are_counted(self):
        legs = [f"L{i}" for i in range(1, 7)]
        for name, hold, paths, finite, real in [("platform", legs, 128, 40, 8), ("arm", [], 32, 16, 16)]:
            m = momenta.load(str(EXAMPLES / "assemblies" / f"{name}.toml"))
            found = m.assemblies(hold, by="homotopy", threads=2)
            counts = found["paths"]
            self.assertEqual(
                (counts["followed"], counts["finite"], counts["real"], counts["complete"]), (paths, finite, real, True)
            )
            self.assertEqual(found["q"].shape, (real, m.nq))
            np.testing.assert_allclose(found["q"][0], m.assemble().q, atol=1e-12)
            for q in found["q"]:
                np.testing.assert_allclose(m.constraints(0, q, np.zeros(m.nv))[0], 0, atol=1e-11)
        with self.assertRaisesRegex(momenta.SceneError, "leaves 6 degrees of freedom"):
            momenta.load(str(EXAMPLES / "assemblies" / "platform.toml")).assemblies(by="homotopy")


class Efforts(unittest.TestCase):
    def test_of_a_motion_of_the_mechanism_itself_are_zero(self):
        m = load("four_bar")
        run = m.run(integrator="dop853", rtol=1e-11, atol=1e-11, end=1, samples=20)
        q, u = (np.column_stack([run[f"{joint}.{letter}"] for joint in "OAC"]) for letter in "qu")
        udot = [m.accelerations(*state)[0][0] for state in zip(run.t, q, u)]
        motion = {"t": run.t, "O.q": q[:, 0], "O.u": u[:, 0], "O.udot [rad/s^2]": udot}
        found = m.effort(motion=motion, actuate=["O"])
        self.assertEqual(found["actuators"], ["O"])
        self.assertEqual(found["effort"].shape, (21, 1))
        np.testing.assert_allclose(found["effort"], 0, atol=1e-8)
        shared = m.effort(motion=motion, actuate=["O", "C"], weights={"C": 2.0})
        self.assertEqual(shared["redundant"], 1)
        np.testing.assert_allclose(shared["effort"], 0, atol=1e-8)

    def test_hold_a_pose(self):
        m = load("four_bar")
        held = m.effort(actuate=["O"], static=True)
        self.assertEqual((held["u"].any(), held["t"].size), (False, 1))
        with self.assertRaisesRegex(momenta.SceneError, "no coordinate is actuated"):
            m.effort(static=True)
        with self.assertRaisesRegex(ValueError, "no drives"):
            m.effort(actuate=["O"])
        with self.assertRaisesRegex(ValueError, "is not known"):
            m.effort(actuate=["O"], motion={"t": [0, 1, 2], "x": [0, 0, 0]})


class Gradients(unittest.TestCase):
    def test_of_an_oscillator_is_that_of_the_formula(self):
        m = momenta.load("""
            [parameters]
            k = 40
            [[body]]
            name = "cart"
            mass = 1.6
            shape = { kind = "point" }
            [[joint]]
            name = "S"
            kind = "prismatic"
            child = "cart"
            axis = "x"
            position = 0.3
            stiffness = "k"
            """)
        found = m.gradient("S.q", ["k", "S.q", "S.u"], integrator="dop853", rtol=1e-12, end=1.1, samples=11,
                           trajectory=True)
        t = found["t"]
        self.assertEqual(found["tangents"].shape, (12, 2, 3))
        self.assertEqual(found["columns"], ["S.q", "S.u"])
        expected = np.stack([-0.3 * t * np.sin(5 * t) * 5 / 80, np.cos(5 * t), np.sin(5 * t) / 5], axis=1)
        np.testing.assert_allclose(found["tangents"][:, 0, :], expected, atol=1e-8)
        np.testing.assert_allclose(found["gradient"], expected[-1], atol=1e-10)
        with self.assertRaisesRegex(ValueError, "no parameter of the scene and no start value"):
            m.gradient("S.q", ["x"])

    def test_fit_finds_what_the_program_finds(self):
        folder = os.path.join(os.environ["MOMENTA_EXAMPLES"], "straight_line")
        m = momenta.load(os.path.join(folder, "scene.toml"))
        found = m.fit(["coupler", "rocker", "reach"], sweep="O", to=os.path.join(folder, "wanted.csv"))
        self.assertTrue(found["converged"])
        self.assertAlmostEqual(found["parameters"]["coupler"]["after"], 2.50770797, 7)
        again = momenta.load(found["scene_text"])
        least = again.fit(["reach=3:7"], sweep="O", over=(2.0, 4.0), least="max(P.y) - min(P.y)",
                          keep=["reach <= 2*coupler - 0.1"])
        self.assertTrue(least["converged"])
        self.assertLessEqual(least["parameters"]["reach"]["after"], 2 * 2.50770797 - 0.1 + 1e-7)
        with self.assertRaisesRegex(ValueError, "expected one comparison"):
            m.fit(["reach"], sweep="O", least="reach", keep=["reach"])

    def test_fit_finds_parameters_of_a_measured_motion(self):
        folder = os.path.join(os.environ["MOMENTA_EXAMPLES"], "identification")
        m = momenta.load(os.path.join(folder, "scene.toml"))
        found = m.fit(["stiffness", "damping", "centre"], to=os.path.join(folder, "measured.csv"))
        self.assertTrue(found["converged"])
        for name, truth in {"stiffness": 6.2, "damping": 0.23, "centre": 0.46}.items():
            parameter = found["parameters"][name]
            self.assertLess(abs(parameter["after"] - truth), 2 * parameter["deviation"])
        with self.assertRaisesRegex(ValueError, "does not go with a measured motion"):
            m.fit(["centre"], to=os.path.join(folder, "measured.csv"), keep=["centre < 1"])


class SmallMotions(unittest.TestCase):
    def test_shapes_solve_the_linearised_equations_of_unit_mass(self):
        m = load("four_bar")
        found = m.modes()
        self.assertEqual((found["nature"], found["degrees_of_freedom"]), ("stable", 1))
        M, J = m.kkt(0.0, found["q"])
        phi = found["shapes"]
        self.assertEqual(phi.shape, (m.nv, 1))
        np.testing.assert_allclose(phi.conj().T @ M @ phi, 1, atol=1e-12)
        np.testing.assert_allclose(J @ phi, 0, atol=1e-12)
        # Let go a little beside it, it accelerates by s^2 times the way.
        step = 1e-6 * phi[:, 0].real
        udot, _ = m.accelerations(0.0, found["q"] + step, np.zeros(m.nv))
        s = found["s"][0]
        np.testing.assert_allclose(udot, (s * s).real * step, rtol=1e-4)
        np.testing.assert_allclose(found["frequency"], s.imag / (2 * np.pi))
        np.testing.assert_array_equal(found["damping_ratio"], 0)

    def test_drives_are_held_or_running(self):
        text = """
            gravity = [0, 0, -9.81]
            [[body]]
            name = "shaft"
            mass = 1
            inertia = [1, 1, 1]
            [[body]]
            name = "bob"
            mass = 2
            com = [0, 0, -0.5]
            inertia = [0, 0, 0]
            [[joint]]
            name = "S"
            kind = "revolute"
            child = "shaft"
            axis = "z"
            [[joint]]
            name = "O"
            kind = "revolute"
            parent = "shaft"
            child = "bob"
            axis = "y"
            position = 0.1
            [[drive]]
            joint = "S"
            kind = "polynomial"
            coefficients = [0, 3]
        """
        m = momenta.parse(text)
        np.testing.assert_allclose(m.modes()["s"].imag ** 2, 9.81 / 0.5)
        np.testing.assert_allclose(m.modes(drives="running")["s"].imag ** 2, 9.81 / 0.5 - 9)

    def test_what_is_wrong_is_said(self):
        with self.assertRaisesRegex(momenta.SceneError, "no equilibrium: joint"):
            load("four_bar").modes(equilibrium="start")
        with self.assertRaisesRegex(ValueError, "expected settle, nearest, start or steady"):
            load("four_bar").modes(equilibrium="up")


class Runs(unittest.TestCase):
    def test_arrays_are_views_that_outlive_the_name(self):
        run = load("four_bar").run(end=1.0, samples=50)
        self.assertEqual(run.status, "done", run.reason)
        self.assertEqual(run.trajectory.shape, (51, len(run.columns)))
        for x in (run.t, run.trajectory, run["O.q"], run.energy_error):
            self.assertFalse(x.flags.owndata)
        self.assertTrue(np.shares_memory(run["O.q"], run.trajectory))
        self.assertTrue(np.shares_memory(run.t, run.t))
        np.testing.assert_array_equal(run["t"], run.t)
        q = run["O.q"]
        copy = q.copy()
        del run
        gc.collect()
        np.testing.assert_array_equal(q, copy)

    def test_states_go_in_without_copies_of_their_kind(self):
        m = load("four_bar")
        q = m.assemble().q
        wide = np.zeros((m.nq, 2))
        wide[:, 0] = q  # a column with a stride, and whole numbers, are taken too
        a = m.constraints(0.0, wide[:, 0], np.zeros(m.nv, dtype=int))
        b = m.constraints(0.0, q, np.zeros(m.nv))
        np.testing.assert_array_equal(a[0], b[0])

    def test_same_as_ever(self):
        m = load("four_bar")
        a, b = (m.run(form="momentum", integrator="dop853", rtol=1e-9, end=2.0) for _ in range(2))
        np.testing.assert_array_equal(a.trajectory, b.trajectory)
        self.assertGreater(a.counters["steps"], 5)

    def test_drift_and_work(self):
        m = load("four_bar")
        runs = m.drift(forms=["momentum", "acceleration"], end=2.0, samples=20)
        self.assertEqual({r.form for r in runs}, {"momentum", "acceleration"})
        ladder = m.work(forms=["momentum"], integrators=["dop853"], tolerances=[1e-5, 1e-8], end=1.0)
        self.assertEqual([r.rtol for r in ladder], [1e-5, 1e-8])
        self.assertLess(ladder[1].position_error_max, ladder[0].position_error_max)

    def test_events_and_stops(self):
        s = momenta.Scene("thrown", gravity=[0, 0, -10])
        s.body("a", mass=2, shape={"kind": "sphere", "radius": 0.1})
        s.joint("A", "prismatic", child="a", velocity=3, limits=[-1, 0.4], restitution=0.5)
        s.event("A.q - 0.3", name="height").event("A.q + 0.5", direction="down", stop=True)
        run = s.load().run(rtol=1e-12, end=2)
        # 3 t - 5 t^2 = 0.3; at 0.4, after 0.2 s, the rate 1 is turned into -0.5
        self.assertEqual(run.status, "event")
        self.assertEqual([e["direction"] for e in run.events], ["up", "down", "down"])
        self.assertAlmostEqual(run.events[0]["t"], (3 - np.sqrt(3)) / 10, places=10)
        self.assertAlmostEqual(run.events[0]["A.u"], np.sqrt(3), places=9)
        self.assertEqual(run.events[2]["name"], "event 2")
        self.assertAlmostEqual(run["A.q"][-1], -0.5, places=9)
        self.assertEqual([s["what"] for s in run.stops], ["impact"])
        self.assertAlmostEqual(run.stops[0]["after"], -0.5, places=9)
        self.assertEqual(pickle.loads(pickle.dumps(run)).events, run.events)

    def test_other_threads_go_on_during_a_run(self):
        counted, stop = [0], threading.Event()

        def count():
            while not stop.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = counted[0]
        load("four_bar").run(end=200.0, samples=10, rtol=1e-12)
        during = counted[0] - before
        stop.set()
        thread.join()
        self.assertGreater(during, 3)

    def test_ctrl_c_stops_a_run(self):
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            load("four_bar").run(end=1e6, samples=10_000_000, rtol=1e-12)
        timer.join()


class Mistakes(unittest.TestCase):
    def expect(self, words, call, *arguments, **named):
        with self.assertRaises(ValueError) as caught:
            call(*arguments, **named)
        self.assertIn(words, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_sentences(self):
        m = load("four_bar")
        self.expect("nowhere.toml", momenta.load, "nowhere.toml")
        self.expect("no body", momenta.parse, "name = 'nothing'")
        self.expect("q has 2 numbers, expected 3 (nq)", m.constraints, 0.0, np.zeros(2), np.zeros(3))
        self.expect("p has 4 numbers", m.momentum_rates, 0.0, np.zeros(3), np.zeros(4))
        self.expect("'momentm'", m.run, form="momentm")
        self.expect("expected auto, planar or spatial", momenta.load,
                    str(EXAMPLES / "four_bar" / "scene.toml"), algebra="flat")
        self.assertTrue(issubclass(momenta.SceneError, ValueError))
        with self.assertRaises(KeyError):
            m.run(end=0.1)["speed"]


class ExampleScripts(unittest.TestCase):
    def test_they_run(self):
        for script in sorted((pathlib.Path(__file__).parents[1] / "examples").glob("*.py")):
            with self.subTest(script.name):
                runpy.run_path(str(script), run_name="tested")


class Arguments(unittest.TestCase):
    """One sentence each, by name, before anything runs."""

    def setUp(self):
        self.m = load("four_bar")

    def refused(self, sentence, call, *args, **named):
        with self.assertRaises(ValueError) as caught:
            call(*args, **named)
        self.assertEqual(str(caught.exception), sentence)

    def test_numbers_of_a_run(self):
        m = self.m
        self.refused("end is -5.0, expected a positive number of seconds", m.run, end=-5)
        self.refused("end is 0.0, expected a positive number of seconds", m.drift, end=0)
        self.refused("step is nan, expected a positive number of seconds", m.run, step=float("nan"))
        self.refused("rtol is -1.0, expected a positive tolerance", m.run, rtol=-1)
        self.refused("atol is inf, expected a positive tolerance", m.run, atol=float("inf"))
        self.refused("samples is 0, expected at least 1", m.run, samples=0)
        self.refused("cpu_limit is -1.0, expected seconds, not negative; 0: none", m.run, cpu_limit=-1)
        self.refused("a tolerance is 0.0, expected a positive tolerance", m.work, tolerances=[0.0])

    def test_numbers_of_a_state(self):
        m = self.m
        q, bad = m.assemble().q, np.zeros(m.nv)
        bad[1] = np.nan
        sentence = "u[1] is not a number, expected a finite number"
        self.refused(sentence, m.accelerations, 0.0, q, bad)
        self.refused(sentence, m.energies, 0.0, q, bad)
        self.refused("t is inf, expected a time in seconds", m.constraints, float("inf"), q, bad)
        self.refused("momentum_rates: leak is -1, expected a rate in 1/s, not negative",
                     m.momentum_rates, 0.0, q, np.zeros(m.nv), leak=-1.0)
        self.refused("v[1] is not a number, expected a finite number", m.evaluate, v=bad)

    def test_evaluate_takes_the_assembled_start(self):
        m = self.m
        start = m.assemble()
        values = m.evaluate()
        self.assertLess(np.abs(values["phi"]).max(), 1e-12)
        np.testing.assert_array_equal(values["udot"], m.evaluate(q=start.q, v=start.u)["udot"])

    def test_signatures_show_public_names(self):
        for name in ("run", "drift", "work", "assemble", "evaluate", "modes"):
            self.assertNotIn("::", getattr(momenta.Mechanism, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
