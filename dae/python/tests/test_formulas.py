"""Formulas from functions and from SymPy have the values that Python computes, and what has none is told."""

import math
import operator
import random
import re
import unittest

import momenta
import numpy as np

try:
    import sympy
    from sympy.physics.mechanics import dynamicsymbols
except ImportError:
    sympy = None


def value(formula, x, y):
    """A formula of x and y, computed by momenta: as potential of a system."""
    s = momenta.Scene().lagrangian(["x", "y"], kinetic="x.dot^2 + y.dot^2", potential=formula, position=[x, y])
    return s.load().energies(0, [x, y], [0, 0])[1]


def some_function(random, depth):
    """A function of (x, y) made at random, of operators and NumPy's functions."""
    if depth == 0:
        number = random.choice([-2, 3, 0.5, np.float64(-1.25), np.int64(2)])
        return random.choice([lambda x, y: x, lambda x, y: y, lambda x, y: number])
    f, g = some_function(random, depth - 1), some_function(random, depth - 1)
    one = random.choice([np.sin, np.cos, np.arctan, np.tanh, abs, operator.neg, np.square, np.floor, np.ceil])
    two = random.choice(
        [operator.add, operator.sub, operator.mul, np.add, np.multiply, np.subtract, np.hypot, np.minimum, np.maximum, np.arctan2]
    )
    safe = random.choice(
        [
            lambda a, b: a / (1 + abs(b)), lambda a, b: (1 + abs(a)) ** b, lambda a, b: abs(a) ** 2 - -b, lambda a, b: a - (b - a),
            lambda a, b: np.where(a < b, a, -b), lambda a, b: np.where((a > b) & np.logical_not(b >= 1) | (a == 0.25), a * b, b),
            lambda a, b: np.sqrt(a * a + 1) / (2 / (1 + b * b)), lambda a, b: -((a + b) ** 2), lambda a, b: np.exp(-a * a) * np.log(2 + b * b),
        ]
    )  # fmt: skip
    kind = random.randrange(3)
    if kind == 0:
        return lambda x, y: one(f(x, y))
    return (lambda x, y: two(f(x, y), g(x, y))) if kind == 1 else (lambda x, y: safe(f(x, y), g(x, y)))


class Traced(unittest.TestCase):
    def test_functions_have_the_values_that_python_computes(self):
        rng, judged = random.Random(28), 0
        for _ in range(400):
            f = some_function(rng, rng.randrange(1, 5))
            x, y = rng.uniform(-2, 2), rng.uniform(-2, 2)
            with np.errstate(all="ignore"):
                expected = float(f(np.float64(x), np.float64(y)))
            if not (math.isfinite(expected) and abs(expected) < 1e6):
                continue
            traced = f(momenta.Formula("x"), momenta.Formula("y"))
            if not isinstance(traced, momenta.Formula):
                continue  # a number
            with self.subTest(traced.text[:300]):
                found = value(traced, x, y)
                self.assertLess(abs(found - expected), 1e-9 * (1 + abs(expected)))
                judged += 1
        self.assertGreater(judged, 200)

    def test_a_pendulum_of_functions_is_the_typed_one(self):
        def scene(**keys):
            s = momenta.Scene(parameters={"m": 2, "g": 9.81, "l": 1})
            return s.lagrangian(["x", "y"], position=[0.8, -0.6], **keys)

        typed = scene(kinetic="m/2*(x.dot^2 + y.dot^2)", potential="m*g*y", force={"x": "-0.1*x.dot + sin(t)"})
        typed.constraint("rod", "hypot(x, y) - l")
        drag = 0.1
        traced = scene(
            kinetic=lambda m, x_dot, y_dot: m / 2 * (x_dot**2 + y_dot**2),
            potential=lambda m, g, y: m * g * y,
            force={"x": lambda x_dot, t: -drag * x_dot + np.sin(t)},
        ).constraint("rod", lambda x, y, l: np.hypot(x, y) - l)
        self.assertEqual(traced.to_dict()["lagrangian"]["kinetic"], "m/2*(x.dot^2+y.dot^2)")
        a, b = (s.load().accelerations(0.3, [0.8, -0.6], [0.6, 0.8]) for s in (typed, traced))
        np.testing.assert_allclose(a[0], b[0], rtol=1e-15)
        np.testing.assert_allclose(a[1], b[1], rtol=1e-15)

    def test_laws_and_equations_of_mechanisms_are_functions_too(self):
        def scene(law, length):
            s = momenta.Scene(gravity=[0, -9.81, 0]).body("rod", mass=1, shape={"kind": "rod", "length": length})
            return s.joint("O", "revolute", child="rod", axis="z").force("torque", joint="O", law=law)

        a = scene("-3*q^3 - 0.1*u", 2).load()
        b = scene(lambda q, u: -3 * q**3 - 0.1 * u, np.float64(2)).load()
        c = scene(-3 * momenta.Formula("O.q") ** 3 - 0.1 * momenta.Formula("O.u"), 2).load()
        for m in (b, c):
            np.testing.assert_allclose(m.accelerations(0, [0.4], [2])[0], a.accelerations(0, [0.4], [2])[0], rtol=1e-15)

    def test_arrays_of_formulas_are_computed_element_by_element(self):
        q = np.array([momenta.Formula("x"), momenta.Formula("y")])
        self.assertEqual((q @ q).text, "x*x+y*y")
        self.assertEqual(np.sin(q)[1].text, "sin(y)")
        self.assertEqual((np.float64(2) * q)[0].text, "2.0*x")

    def test_text_has_the_parentheses_it_needs(self):
        x, y = momenta.Formula("x"), momenta.Formula("y")
        for formula, text in [
            (x - (y - 1), "x-(y-1)"), (x / (y * 2), "x/(y*2)"), ((x**y) ** 2, "(x^y)^2"), (-(x**2), "-x^2"),
            ((-x) ** 2, "(-x)^2"), (x - -2, "x-(-2)"), (2 - x, "2-x"), (momenta.Formula("x + y") * 2, "(x + y)*2"),
            (~(x < y), "not (x < y)"), ((x < 1) & ((y < 1) | (x > 2)), "x < 1 and (y < 1 or x > 2)"),
            (x * (y / 2), "x*(y/2)"), (abs(x), "abs(x)"), (2**x, "2^x"),
        ]:  # fmt: skip
            self.assertEqual(formula.text, text)

    def test_what_has_no_value_is_told(self):
        x = momenta.Formula("x")

        def branches(x):
            return 1 if x > 0 else 2

        lagrangian = momenta.Scene().lagrangian
        for made, error, sentence in [
            (branches, TypeError, "has no value before a run, expected numpy.where"),
            (lambda x: math.sin(x), TypeError, "expected functions of NumPy in place of those of math"),
            (lambda *q: q[0], TypeError, r"takes \*q, expected arguments by name"),
            (lambda x: None, TypeError, "returns None, expected a formula of its arguments, or a number"),
            (lambda x: x * True, TypeError, "a formula holds True"),
            (lambda x: x * float("nan"), ValueError, "a formula holds nan, expected finite numbers"),
            (lambda x: x + "y", TypeError, "a formula holds 'y', expected numbers and formulas"),
            (lambda x: np.cbrt(x), TypeError, "numpy.cbrt is no function of formulas, expected one of: absolute, arccos"),
            (lambda x: np.interp(x, [0, 1], [0, 1]), TypeError, "numpy.interp does not take formulas"),
        ]:
            with self.subTest(sentence), self.assertRaisesRegex(error, sentence) as caught:
                lagrangian(["x"], kinetic="x.dot^2", potential=made)
            self.assertNotIn("\n", str(caught.exception))
        for _ in range(30):
            if len(x.text) > 400_000:
                break
            x = x + x
        with self.assertRaisesRegex(ValueError, "of more than 1000000 characters"):
            (x + x) * (x + x)
        with self.assertRaisesRegex(TypeError, "made of a text, found 3"):
            momenta.Formula(3)
        # Names that the scene does not have: the reader of scenes says so.
        with self.assertRaisesRegex(momenta.SceneError, "'z'"):
            momenta.Scene().lagrangian(["x"], kinetic=lambda x_dot, z: x_dot**2 + z).load()


@unittest.skipIf(sympy is None, "SymPy is not installed")
class FromSymPy(unittest.TestCase):
    def test_expressions_have_the_values_that_sympy_computes(self):
        x, y = sympy.symbols("x y", real=True)
        third = sympy.Rational(1, 3)
        for expression in [
            x - y, -x * y / 3, x / y / 2, (x + y) ** 2 / (x - 5), x**-2, 3 / (y * (x + 4)), sympy.sqrt(x + 3), 1 / sympy.sqrt(x + 3), third * x**2 - third,
            sympy.exp(x) * sympy.E, sympy.pi * x, sympy.GoldenRatio * y, sympy.Abs(x) ** 3, sympy.sign(y) * x, sympy.Max(x, y, 0.3),
            sympy.Min(x, -y, 2), sympy.atan2(y, x), sympy.asin(x / 9), sympy.log(y + 4), sympy.floor(3 * x), sympy.ceiling(3 * x),
            sympy.sec(x), sympy.cot(y), sympy.csc(x), sympy.coth(x), sympy.tanh(-x), x ** (y + 2), (-x) ** 2, 2**x, -(x**2),
            sympy.Piecewise((x, x < y), (y**2, (x > 0) & (y > 0)), (3, True)), sympy.Piecewise((1, sympy.Or(sympy.Not(x > y), y < 0)), (x, True)),
            sympy.Float("0.1", 30) * x, x - sympy.Rational(-7, 3) * y, -2 * (x - 3) / (3 * y), -x - y, -3 + x, sympy.Integer(4), x * y**-1 * 2 ** sympy.Rational(1, 2),
        ]:  # fmt: skip
            for a, b in [(0.7, -1.3), (1.4, 0.6), (0.2, 0.9)]:
                with self.subTest(str(expression)):
                    expected = complex(expression.subs({x: sympy.Float(a, 30), y: sympy.Float(b, 30)}).evalf(20))
                    if expected.imag == 0:
                        self.assertLess(abs(value(expression, a, b) - expected.real), 1e-13 * (1 + abs(expected)))

    def test_coordinates_are_functions_of_time(self):
        t, m, g = sympy.symbols("t m g")
        x, y = dynamicsymbols("x y")
        kinetic = m * (x.diff(t) ** 2 + y.diff(t) ** 2) / 2
        s = momenta.Scene(parameters={"m": 2, "g": 9.81})
        s.lagrangian(["x", "y"], lagrangian=kinetic - m * g * y, position=[0.6, 0.8])
        s.constraint("rod", sympy.sqrt(x**2 + y**2) - 1).lagrangian(["x", "y"], force={"x": -x.diff(t) * sympy.sin(t)})
        self.assertEqual(s.to_dict()["lagrangian"]["force"], {"x": "-x.dot*sin(t)"})
        typed = momenta.Scene()
        typed.lagrangian(["x", "y"], lagrangian="x.dot^2 + y.dot^2 - 19.62*y", position=[0.6, 0.8])
        typed.lagrangian(["x", "y"], force={"x": "-x.dot*sin(t)"}).constraint("rod", "hypot(x, y) - 1")
        a, b = (scene.load().accelerations(0.5, [0.6, 0.8], [0.8, -0.6]) for scene in (s, typed))
        np.testing.assert_allclose(a[0], b[0], rtol=1e-14)
        # A function may compute with SymPy.
        momenta.Scene().lagrangian(["x"], kinetic=lambda x_dot: x_dot**2, potential=lambda: sympy.Symbol("x") ** 2).load()

    def test_what_formulas_do_not_have_is_told(self):
        t, x = sympy.symbols("t x")
        f, q = sympy.Function("f"), sympy.Function("q")
        for expression, sentence in [
            (q(t).diff(t, 2), "is no first derivative of a coordinate by t"),
            (f(x), "is an unknown function, expected a function of t alone"),
            (sympy.Heaviside(x), "is Heaviside of SymPy, which formulas do not have"),
            (sympy.Integral(sympy.exp(x**2), x), "is Integral of SymPy"),
            (sympy.I * x, "is ImaginaryUnit of SymPy"),
            (sympy.oo, "Infinity of SymPy|holds inf"),
            (sympy.Piecewise((x, x > 0)), "has no value where no condition holds"),
            (sympy.Symbol(r"\theta"), "is no name in formulas"),
            (sympy.besselj(0, x), "is besselj of SymPy"),
            (sympy.Matrix([x, x]), r"a formula holds Matrix\(.*, expected numbers and formulas"),
        ]:
            with self.subTest(str(expression)), self.assertRaisesRegex((TypeError, ValueError), sentence) as caught:
                momenta.Scene().lagrangian(["x"], potential=expression)
            self.assertFalse(re.search("\n", str(caught.exception)))


if __name__ == "__main__":
    unittest.main()
