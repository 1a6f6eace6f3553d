"""Formulas of Python: functions traced by overloaded operators, and SymPy expressions, as the text that scene
files have (docs/reference/scene.md, parameters).

A function is called once, with a Formula for each of its arguments, by name: x is the coordinate or parameter x,
x_dot the rate x.dot. What its operators and NumPy's functions are applied to is written down, not computed.
"""

import functools
import inspect
import math
import numbers
import re

# How strongly an operation binds; operands that bind less stand in parentheses.
_OR, _AND, _NOT, _COMPARISON, _SUM, _PRODUCT, _POWER, _ATOM = range(8)
_LONGEST = 1_000_000  # characters of a formula

_COMPARISONS = {
    "less": "<", "less_equal": "<=", "greater": ">", "greater_equal": ">=", "equal": "==", "not_equal": "!=",
}  # fmt: skip
# Functions of formulas, by their names in NumPy.
_FUNCTIONS = {name: name for name in "sin cos tan sinh cosh tanh exp log sqrt sign floor hypot".split()} | {
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "absolute": "abs", "fabs": "abs",
    "minimum": "min", "maximum": "max", "fmin": "min", "fmax": "max",
}  # fmt: skip


class Formula:
    """A formula of a scene, written down as it is computed.

    x = momenta.Formula("x")
    -0.5 * np.sin(x) ** 2          # Formula('-0.5*sin(x)^2')

    +, -, *, /, **, abs, comparisons, & | ~ of these, and NumPy's sin, cos, tan, arcsin, arccos, arctan, arctan2,
    sinh, cosh, tanh, exp, log, sqrt, hypot, sign, floor, minimum, maximum and where. TypeError for what needs its
    value: if, and, or, not, math.sin, float.
    """

    __slots__ = ("_binds", "_text")
    __hash__ = None  # == is written down

    def __init__(self, text):
        """The formula of a text, such as a name: 'x', 'x.dot', 'O.q'."""
        if not isinstance(text, str):
            raise TypeError(f"a formula is made of a text, found {_shown(text)}")
        self._text = text
        self._binds = _ATOM if re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.]*", text) else _OR

    @property
    def text(self):
        """The text, as in a scene file."""
        return self._text

    def __repr__(self):
        return f"Formula({self._text!r})"

    def __neg__(self):
        return _made("-" + _operand(self, _PRODUCT), _SUM)

    def __pos__(self):
        return self

    def __abs__(self):
        return _call("abs", self)

    def __add__(self, other):
        return _joined(self, "+", other, _SUM)

    def __radd__(self, other):
        return _joined(other, "+", self, _SUM)

    def __sub__(self, other):
        return _joined(self, "-", other, _SUM)

    def __rsub__(self, other):
        return _joined(other, "-", self, _SUM)

    def __mul__(self, other):
        return _joined(self, "*", other, _PRODUCT)

    def __rmul__(self, other):
        return _joined(other, "*", self, _PRODUCT)

    def __truediv__(self, other):
        return _joined(self, "/", other, _PRODUCT)

    def __rtruediv__(self, other):
        return _joined(other, "/", self, _PRODUCT)

    def __pow__(self, other):
        return _power(self, other)

    def __rpow__(self, other):
        return _power(other, self)

    def __lt__(self, other):
        return _compared(self, "<", other)

    def __le__(self, other):
        return _compared(self, "<=", other)

    def __gt__(self, other):
        return _compared(self, ">", other)

    def __ge__(self, other):
        return _compared(self, ">=", other)

    def __eq__(self, other):
        return _compared(self, "==", other)

    def __ne__(self, other):
        return _compared(self, "!=", other)

    def __and__(self, other):
        return _logical(self, "and", other, _AND)

    def __or__(self, other):
        return _logical(self, "or", other, _OR)

    def __invert__(self):
        return _made("not " + _operand(self, _ATOM), _NOT)

    def __bool__(self):
        raise TypeError(
            f"{_shown(self)} has no value before a run, expected numpy.where(c, x, y) in place of if, and &, |, ~ in "
            "place of and, or, not"
        )

    def __float__(self):
        raise TypeError(
            f"{_shown(self)} has no value before a run, expected functions of NumPy in place of those of math"
        )

    __int__ = __index__ = __complex__ = __float__

    def __getattr__(self, name):
        # NumPy calls methods of the elements of arrays of objects.
        if name in _FUNCTIONS:
            return lambda *others: _call(_FUNCTIONS[name], self, *others)
        raise AttributeError(f"a formula has no attribute {name!r}")

    def __array_ufunc__(self, function, method, *inputs, **options):
        name = function.__name__
        if method != "__call__" or options or any(getattr(x, "ndim", 0) for x in inputs):
            return NotImplemented
        operators = {
            "add": lambda x, y: _joined(x, "+", y, _SUM), "subtract": lambda x, y: _joined(x, "-", y, _SUM),
            "multiply": lambda x, y: _joined(x, "*", y, _PRODUCT), "divide": lambda x, y: _joined(x, "/", y, _PRODUCT),
            "true_divide": lambda x, y: _joined(x, "/", y, _PRODUCT), "power": _power, "float_power": _power,
            "negative": lambda x: -x, "positive": lambda x: x, "square": lambda x: x**2, "reciprocal": lambda x: 1 / x,
            "ceil": lambda x: -_call("floor", -x), "logical_and": lambda x, y: _logical(x, "and", y, _AND),
            "logical_or": lambda x, y: _logical(x, "or", y, _OR), "logical_not": lambda x: ~x,
        }  # fmt: skip
        if name in operators:
            return operators[name](*inputs)
        if name in _COMPARISONS:
            return _compared(inputs[0], _COMPARISONS[name], inputs[1])
        if name in _FUNCTIONS:
            return _call(_FUNCTIONS[name], *inputs)
        raise TypeError(f"numpy.{name} is no function of formulas, expected one of: {', '.join(sorted(_FUNCTIONS))}")

    def __array_function__(self, function, types, arguments, options):
        if function.__name__ == "where" and len(arguments) == 3 and not options:
            return _call("if", _truth(arguments[0]), *arguments[1:])
        raise TypeError(f"numpy.{function.__name__} does not take formulas, expected numpy.where or a ufunc of NumPy")


def is_formula(x):
    """Whether x is a Formula, a function, or a SymPy expression."""
    return isinstance(x, Formula) or _is_sympy(x) or inspect.isfunction(x) or inspect.ismethod(x)


def text_of(x):
    """The text of a Formula, a function, a SymPy expression or a number.

    TypeError, one sentence, for what formulas do not have.
    """
    if inspect.isfunction(x) or inspect.ismethod(x):
        x = _traced(x)
    elif _is_sympy(x):
        x = _of_sympy(x)
    return _operand(x, _OR)


def _traced(function):
    title = getattr(function, "__name__", "function")
    arguments = []
    for name, parameter in inspect.signature(function).parameters.items():
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            raise TypeError(
                f"{title} takes *{name}, expected arguments by name: coordinates x, rates x_dot, t, parameters"
            )
        if parameter.default is parameter.empty:
            arguments.append(name)
    rates = (name.removesuffix("_dot") + ".dot" if name.endswith("_dot") else name for name in arguments)
    result = function(**dict(zip(arguments, map(Formula, rates))))
    if _is_sympy(result):
        result = _of_sympy(result)
    if not isinstance(result, (Formula, numbers.Real)) or isinstance(result, bool):
        raise TypeError(f"{title} returns {_shown(result)}, expected a formula of its arguments, or a number")
    return result


def _made(text, binds):
    if len(text) > _LONGEST:
        raise ValueError(f"a formula of more than {_LONGEST} characters, expected a shorter one: {text:.60}…")
    made = Formula.__new__(Formula)
    made._text, made._binds = text, binds
    return made


def _operand(x, least):
    """The text of x, in parentheses where it binds less."""
    if isinstance(x, Formula):
        return x._text if x._binds >= least else f"({x._text})"
    if _is_sympy(x):
        return _operand(_of_sympy(x), least)
    if _is_truth(x):
        raise TypeError(f"a formula holds {x!r}, expected a number or a comparison of formulas")
    if isinstance(x, numbers.Integral):
        text = str(int(x))
    elif isinstance(x, numbers.Real):
        if not math.isfinite(x):
            raise ValueError(f"a formula holds {float(x)!r}, expected finite numbers")
        text = repr(float(x))
    elif getattr(x, "ndim", None) == 0:
        return _operand(x.item(), least)
    else:
        raise TypeError(f"a formula holds {_shown(x)}, expected numbers and formulas")
    return f"({text})" if text.startswith("-") and least > _SUM else text


def _joined(x, operator, y, binds):
    """x operator y, from left to right: of y equal binding needs parentheses."""
    return _made(_operand(x, binds) + operator + _operand(y, binds + 1), binds)


def _power(x, y):
    return _made(_operand(x, _ATOM) + "^" + _operand(y, _ATOM), _POWER)


def _compared(x, operator, y):
    return _made(f"{_operand(x, _SUM)} {operator} {_operand(y, _SUM)}", _COMPARISON)


def _logical(x, operator, y, binds):
    return _made(f"{_operand(_truth(x), binds)} {operator} {_operand(_truth(y), binds + 1)}", binds)


def _truth(x):
    """True and False of Python and NumPy as comparisons."""
    return _made("0 < 1" if x else "1 < 0", _COMPARISON) if _is_truth(x) else x


def _is_truth(x):
    return isinstance(x, bool) or type(x).__name__ in ("bool_", "BooleanTrue", "BooleanFalse")


def _shown(x):
    """x on one line, for sentences."""
    return " ".join(repr(x).split())[:100]


def _call(name, *arguments):
    return _made(f"{name}({', '.join(_operand(x, _OR) for x in arguments)})", _ATOM)


def _is_sympy(x):
    return hasattr(x, "free_symbols") and hasattr(x, "func") and hasattr(x, "args")


def _of_sympy(x):
    """A SymPy expression as a formula. x(t) is the coordinate x, its derivative by t the rate x.dot, as is the symbol
    'x.dot'."""
    kind = type(x).__name__
    if getattr(x, "is_Symbol", False):
        return _named(x.name)
    if getattr(x, "is_Integer", False):
        return int(x)
    if getattr(x, "is_Rational", False):
        return _joined(int(x.p), "/", int(x.q), _PRODUCT)
    if getattr(x, "is_Float", False):
        return float(x)
    if kind == "Pi":
        return _made("pi", _ATOM)
    if getattr(x, "is_NumberSymbol", False):
        return _call("exp", 1) if kind == "Exp1" else float(x)
    if x.func.__class__.__name__ == "UndefinedFunction":
        if len(x.args) == 1 and x.args[0].is_Symbol and x.args[0].name == "t":
            return _named(x.func.__name__)
        raise TypeError(f"{_shown(x)} is an unknown function, expected a function of t alone: a coordinate")
    if kind == "Derivative":
        coordinate, *by = x.args
        if len(by) == 1 and str(by[0][0]) == "t" and by[0][1] == 1 and str(coordinate.args) in ("(t,)",):
            return _made(_of_sympy(coordinate)._text + ".dot", _ATOM)
        raise TypeError(f"{_shown(x)} is no first derivative of a coordinate by t, expected rates such as x(t).diff(t)")
    if kind == "Piecewise":
        *pieces, (last, always) = x.args
        if always != True:  # noqa: E712  SymPy's true
            raise TypeError(f"{_shown(x)} has no value where no condition holds, expected a last piece (…, True)")
        result = _of_sympy(last)
        for value, condition in reversed(pieces):
            result = _call("if", _of_sympy(condition), _of_sympy(value), result)
        return result
    if kind == "Add":
        return _sum(x.args)
    if kind == "Mul":
        return _product(x.args)
    if kind not in _SYMPY and kind.lower() not in _FUNCTIONS.values():
        raise TypeError(f"{_shown(x)} is {kind} of SymPy, which formulas do not have")
    arguments = [x_ if _is_truth(x_) else _of_sympy(x_) for x_ in x.args]
    if kind == "Pow":
        return _sympy_power(x, *arguments)
    if kind in _RELATIONS:
        return _compared(arguments[0], _RELATIONS[kind], arguments[1])
    if kind == "Not":
        return _made("not " + _operand(_truth(arguments[0]), _ATOM), _NOT)
    if kind in _FOLDED:
        return functools.reduce(_FOLDED[kind], arguments)
    if kind in _INVERSE:
        return _joined(1, "/", _call(_INVERSE[kind], *arguments), _PRODUCT)
    if kind == "ceiling":
        return -_call("floor", _joined(0, "-", arguments[0], _SUM))
    return _call(kind.lower(), *arguments)


# Classes of SymPy beside those that are functions of formulas by the same name.
_RELATIONS = {
    "StrictLessThan": "<", "LessThan": "<=", "StrictGreaterThan": ">", "GreaterThan": ">=", "Equality": "==",
    "Unequality": "!=",
}  # fmt: skip
_FOLDED = {
    "And": lambda a, b: _logical(a, "and", b, _AND), "Or": lambda a, b: _logical(a, "or", b, _OR),
    "Max": lambda a, b: _call("max", a, b), "Min": lambda a, b: _call("min", a, b),
}  # fmt: skip
_INVERSE = {"sec": "cos", "csc": "sin", "cot": "tan", "sech": "cosh", "csch": "sinh", "coth": "tanh"}
_SYMPY = {"Pow", "Not", "ceiling", *_RELATIONS, *_FOLDED, *_INVERSE}


def _named(name):
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*(\.[A-Za-z][A-Za-z0-9_]*)*", name):
        raise TypeError(f"the symbol {name!r} is no name in formulas, expected letters, digits and _, a letter first")
    return _made(name, _ATOM)


def _negated(x):
    """-x and true where x is a product with a negative number, else x and false."""
    number, rest = x.as_coeff_Mul()
    return (-number * rest, True) if number.is_negative else (x, False)


def _sum(terms):
    result = None
    for term in terms:
        term, minus = _negated(term)
        term = _of_sympy(term)
        if result is None:
            result = -term if minus else term
        else:
            result = _joined(result, "-" if minus else "+", term, _SUM)
    return result


def _product(factors):
    """Factors with negative powers are divided by."""
    above, below, minus = None, None, False
    for factor in factors:
        if factor == -1:
            minus = not minus
            continue
        base, exponent = factor.as_base_exp()
        if exponent.is_number and exponent.is_negative and not factor.is_number:
            part = _of_sympy(base**-exponent)
            below = part if below is None else _joined(below, "*", part, _PRODUCT)
        else:
            part = _of_sympy(factor)
            above = part if above is None else _joined(above, "*", part, _PRODUCT)
    result = 1 if above is None else above
    if below is not None:
        result = _joined(result, "/", below, _PRODUCT)
    return _made("-" + _operand(result, _PRODUCT), _SUM) if minus else result


def _sympy_power(x, base, exponent):
    number = x.args[1]
    if number == 0.5 or str(number) == "1/2":
        return _call("sqrt", base)
    if number.is_number and number.is_negative:
        return _joined(1, "/", _of_sympy(x.args[0] ** -number), _PRODUCT)
    return _power(base, exponent)
