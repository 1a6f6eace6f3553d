"""A scene built in Python: tables of keys, as in docs/reference/scene.md, written as TOML.

The reader of scene files alone decides what the keys mean and which values they may have.
"""

import copy
import json
import os
import re

from . import _momenta
from .formulas import is_formula, text_of

# Keys of a scene whose value is a list of tables, and keys whose value is one table.
_LISTS = ("body", "joint", "loop", "drive", "force", "function", "marker", "event", "visual")
_TABLES = ("assembly", "run", "lagrangian")


class Scene:
    """A scene, built table by table; keywords are the keys of docs/reference/scene.md.

    s = momenta.Scene('pendulum', gravity=[0, -9.81, 0])
    s.body('rod', mass=1, shape={'kind': 'rod', 'length': 1})
    s.joint('O', 'revolute', child='rod', position=0.5)
    run = s.load().run(end=10)

    body, joint, loop, drive, force, spring, function, marker, event, visual, lagrangian, constraint, assembly and run
    return the scene, so that calls can be chained. Keys that are None are left out, and an underscore
    at the end of one, as in from_, which Python keeps for itself. load() reports mistakes: a SceneError, one sentence.
    """

    def __init__(self, name="", **keys):
        self._keys = {}
        self._put(self._keys, {"name": name or None, **keys})

    def body(self, name, **keys):
        """Adds a body: mass [kg], shape, com [m], inertia [kg m^2], any_inertia."""
        return self._add("body", name=name, **keys)

    def joint(self, name, kind, **keys):
        """Adds a joint of the tree: parent, child, origin [m], rotation, axis, position, velocity,
        stiffness, rest, damping, friction, friction_rate, bearing, limits, stop_stiffness,
        stop_damping, stop_width, restitution, rotor_inertia, pitch, axis2, direction."""
        return self._add("joint", name=name, kind=kind, **keys)

    def loop(self, name, kind, **keys):
        """Adds a joint that closes a loop, or a coupler: parent, child, origin [m], rotation, axis, axis2,
        direction; length [m] of a distance; joints, ratios, powers, coordinates, offset of a coupler;
        curve, radius [m], points [m], closed of a slot; profile of a cam; radius [m], offset of a rack;
        equation, a formula that is zero."""
        return self._add("loop", name=name, kind=kind, **keys)

    def drive(self, kind, **keys):
        """Adds a drive, which prescribes a motion of a joint or a loop. `kind` is its law: polynomial,
        harmonic, step, table or formula. Keys: joint or loop, coordinate, and the keys of the law (from_ of a
        step)."""
        return self._add("drive", kind=kind, **keys)

    def force(self, kind, **keys):
        """Adds a spring-damper; a bushing; a coordinate-spring: joints, ratios, coordinates, and what a
        spring has; a torque along a joint: joint, value; a wrench on a body: body, point [m],
        force [N], torque [N m], axes; or a potential: V. `law`, a formula as of `lagrangian`, stands in place of the
        numbers of all but bushings and wrenches; its own names are q and u, length and rate, or l and rate."""
        return self._add("force", kind=kind, **keys)

    def spring(self, **keys):
        """Adds a force of kind spring-damper: parent, child, origin [m], stiffness [N/m], damping
        [N s/m], rest, dead_band, limits [m], stop_stiffness, stop_damping, stop_width."""
        return self.force("spring-damper", **keys)

    def function(self, name, x, y):
        """Adds a function that formulas of forces call: the natural cubic spline through the points (x, y)."""
        return self._add("function", name=name, x=x, y=y)

    def marker(self, name, body, **keys):
        """Adds a point of a body whose motion is recorded: point [m], in body axes."""
        return self._add("marker", name=name, body=body, **keys)

    def event(self, when, **keys):
        """Adds an event, told where the formula `when` passes zero: name, direction ("up", "down" or "both"), stop
        (True: the run ends there). `when` is a formula as of `lagrangian`."""
        return self._add("event", when=_formula(when), **keys)

    def visual(self, body, kind, **keys):
        """Adds a solid that is drawn and has no effect on motion: position [m], rotation, colour; size,
        length, radius [m] by its kind; file and scale of a mesh."""
        return self._add("visual", body=body, kind=kind, **keys)

    def lagrangian(self, coordinates, **keys):
        """Makes the scene a system of formulas, without bodies: units, position, velocity, by coordinate;
        lagrangian, or kinetic and potential; force, a dict by coordinate; constraints, a list of dicts.

        A formula is a string, a number, a function of coordinates x, rates x_dot, t and parameters by these names, a
        Formula, or a SymPy expression in which x(t), or the symbol x, is a coordinate and x(t).diff(t), or the symbol
        'x.dot', its rate."""
        for key in ("lagrangian", "kinetic", "potential"):
            keys[key] = _formula(keys.get(key))
        if keys.get("force") is not None:
            keys["force"] = {name: _formula(x) for name, x in keys["force"].items()}
        return self._put(self._keys.setdefault("lagrangian", {}), {"coordinates": coordinates, **keys})

    def constraint(self, name, equation, unit=None):
        """Adds a holonomic constraint of the formulas, equation = 0, in m or, with unit='rad', in rad."""
        self._put(table := {}, {"name": name, "equation": _formula(equation), "unit": unit})
        self._keys.setdefault("lagrangian", {}).setdefault("constraints", []).append(table)
        return self

    def assembly(self, **keys):
        """Sets keys of [assembly]: hold, the joints, or coordinates of formulas, that assembly does not move."""
        return self._put(self._keys.setdefault("assembly", {}), keys)

    def run(self, **keys):
        """Sets keys of [run], the defaults of a run: end [s], step [s], samples, leak [1/s], project."""
        return self._put(self._keys.setdefault("run", {}), keys)

    @classmethod
    def from_dict(cls, keys):
        """A scene from a dict like the one that tomllib reads from a scene file."""
        if not isinstance(keys, dict):
            raise TypeError(f"a scene is made from a dict, found {type(keys).__name__}")
        return cls(**keys)

    def to_dict(self):
        """The scene as a dict of dicts, lists, strings and numbers."""
        return copy.deepcopy(self._keys)

    def to_toml(self):
        """The scene as the text of a scene file."""
        top = {key: x for key, x in self._keys.items() if not _is_table(key, x)}
        text = "".join(_line(key, x) for key, x in top.items())
        for key, tables in self._keys.items():
            if key not in top:
                head = f"[[{key}]]" if key in _LISTS else f"[{key}]"
                for table in tables if key in _LISTS else [tables]:
                    text += f"\n{head}\n" + "".join(_line(k, x) for k, x in table.items())
        return text

    def save(self, file):
        """Writes the scene file completely, or not at all."""
        _momenta.write(os.fspath(file), self.to_toml())

    def load(self, algebra="auto", kkt="auto", *, cut="auto", at=None, set=None, stops=None):
        """The Mechanism of this scene: momenta.load(scene, ...)."""
        from .verbs import load

        return load(self, algebra, kkt, cut=cut, at=at, set=set, stops=stops)

    def __eq__(self, other):
        return isinstance(other, Scene) and self._keys == other._keys

    def __repr__(self):
        counts = (f"{len(self._keys.get(key, []))} [[{key}]]" for key in ("body", "joint", "loop"))
        return f"<momenta.Scene {self._keys.get('name', '')!r}: {', '.join(counts)}>"

    def _add(self, key, **keys):
        self._put(table := {}, keys)
        self._keys.setdefault(key, []).append(table)
        return self

    def _put(self, table, keys):
        table.update({key.removesuffix("_"): _plain(x) for key, x in keys.items() if x is not None})
        return self


def _is_table(key, x):
    if key in _LISTS:
        return isinstance(x, list) and all(isinstance(table, dict) for table in x)
    return key in _TABLES and isinstance(x, dict)


def _formula(x):
    """A formula as scene files have it, of a string, a number, a Formula, a function or a SymPy expression."""
    return x if isinstance(x, (str, bool)) or x is None else text_of(x)


def _plain(x):
    """Converts arrays and numbers of NumPy to Python's types, formulas to their text; copies lists and dicts, so that
    no other object shares them."""
    if is_formula(x):
        return text_of(x)
    if hasattr(x, "tolist"):
        x = x.tolist()
    if isinstance(x, dict):
        return {key: _plain(value) for key, value in x.items() if value is not None}
    if isinstance(x, (list, tuple)):
        return [_plain(value) for value in x]
    if isinstance(x, str):
        x.encode()  # files are UTF-8: refuses half a character
    if isinstance(x, (bool, int, float, str)):
        return x
    raise TypeError(f"a scene holds numbers, strings, lists and dicts, found {x!r:.100}")


def _line(key, x):
    return f"{_name(key)} = {_value(x)}\n"


def _name(key):
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else _text(key)


def _text(x):
    return json.dumps(x, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(x):
    if isinstance(x, bool):
        return "true" if x else "false"
    if isinstance(x, str):
        return _text(x)
    if isinstance(x, list):
        return "[" + ", ".join(map(_value, x)) + "]"
    if isinstance(x, dict):
        return "{ " + ", ".join(f"{_name(key)} = {_value(value)}" for key, value in x.items()) + " }"
    return repr(x)  # inf and nan are TOML too: the reader refuses them by name
