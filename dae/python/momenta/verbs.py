"""Reading of scenes, and the verbs evaluate, index, run and view of the program."""

import html
import json
import os

from . import _momenta
from .scene import Scene


def load(
    scene,
    algebra="auto",
    kkt="auto",
    *,
    cut="auto",
    loops="",
    free_root=False,
    key="",
    at=None,
    set=None,
    control=None,
    stops=None,
):
    """A Mechanism from a scene file (TOML, URDF, MJCF or SDF), TOML text, a Scene or a dict of its keys.

    A string with a line break is text, any other string is a path. `algebra`: auto, planar or spatial;
    `kkt`: auto, sweeps, sparse or dense; `cut`: joints that runs cut, auto for the least work or scene;
    `loops`: a file with the loops of a URDF; `free_root`: whether
    the root link of a URDF floats; `key`: the <key> of an MJCF to start at, by name or number; `at`: start values instead of the scene's, {'q': {joint: ...},
    'v': {...}}; `set`: numbers of a TOML scene in place of its own, {'body.crank.mass': 2}, or of its
    parameters, {'a': 0.6}; `control`: actuators of an MJCF act, at {name: value} and the others at the
    key's control or 0, or all of them at one number; `stops`: limits of joints push back, with a
    stiffness [N m/rad or N/m], or (stiffness, damping [N m s/rad or N s/m]). Raises SceneError: one
    sentence with file, line and what is wrong; ValueError for a place that the scene does not have.
    """
    at = _state(at)
    numbers = [(str(place), float(value)) for place, value in dict(set or {}).items()]
    text, name = _text_of(scene)
    more = _controls(control), _stops(stops), numbers, at, algebra, kkt, cut
    if text is None:
        return _momenta.read(name, os.fspath(loops), free_root, str(key), *more)
    if loops or free_root or key != "" or control is not None:
        raise ValueError(
            "loops, free_root, key and control are of a robot's file; expected none with a scene given as text"
        )
    return _momenta.parse(text, name, *more[1:])


def parse(text, name="scene", algebra="auto", kkt="auto", *, cut="auto"):
    """A Mechanism from TOML text; messages name the text by `name`."""
    return _momenta.parse(text, name, None, [], "", algebra, kkt, cut)


def run(scene, **arguments):
    """A Run of one form, as the verb `run` makes it: Mechanism.run of what load() makes of the scene.

    `scene`: a Mechanism, or what load() takes. `arguments`: those of Mechanism.run.
    """
    return _ready(scene).run(**arguments)


def evaluate(scene, at=None):
    """All values at one state, as the verb `evaluate` writes them; keys: docs/reference/evaluate.md.

    `scene`: a Mechanism, or what load() takes. `at`: {'t': 0, 'q': {joint: ...}, 'v' or 'p': {...},
    'tau': {...}}, a JSON file or its text; values left out are those of the start of the scene.
    """
    return json.loads(_momenta.evaluate(_ready(scene), _state(at) or "{}"))


def index(scene, forms=(), at=None, *, progress=None):
    """The differentiation index of each form, found numerically, and its hidden constraints, as the verb
    `index` writes them.

    `forms`: names of forms, empty: all; `at`: a consistent state, as for evaluate(), by default the
    start.
    """
    return json.loads(_momenta.index(_ready(scene), list(forms), _state(at), progress))


def view(scene):
    """A Page of the assembled mechanism, to be turned and zoomed, as the verb `view` writes it."""
    name = "" if isinstance(scene, _momenta.Mechanism) else _text_of(scene)[1]
    return Page(_momenta.page(_ready(scene), name))


class Page(str):
    """An HTML page without external files. A notebook shows it; save() writes it."""

    def save(self, file):
        """Writes the page completely, or not at all."""
        _momenta.write(os.fspath(file), str(self))

    def _repr_html_(self):
        style = "width: 100%; height: 640px; border: 0"
        return f'<iframe srcdoc="{html.escape(self)}" style="{style}"></iframe>'

    def __repr__(self):
        return f"<momenta.Page of {len(self)} characters>"


def _ready(scene):
    return scene if isinstance(scene, _momenta.Mechanism) else load(scene)


def _text_of(scene):
    """(TOML text, its name in messages); for a file (None, its path)."""
    if isinstance(scene, dict):
        scene = Scene.from_dict(scene)
    if isinstance(scene, Scene):
        return scene.to_toml(), scene.to_dict().get("name", "scene")
    if isinstance(scene, str) and "\n" in scene:
        return scene, "scene"
    if isinstance(scene, (str, os.PathLike)):
        return None, os.fspath(scene)
    found = type(scene).__name__
    raise TypeError(f"a scene is a path, TOML text, a Scene or a dict, found {found}")


def _controls(control):
    """The texts of --control."""
    if control is None:
        return []
    if isinstance(control, dict):
        return [f"{name}={float(value)!r}" for name, value in control.items()] or ["0"]
    return [repr(float(control))]


def _stops(stops):
    """(stiffness, damping), or None."""
    if stops is None:
        return None
    pair = tuple(stops) if hasattr(stops, "__len__") else (stops, 0)
    if len(pair) != 2:
        raise ValueError(f"stops are a stiffness, or (stiffness, damping), found {stops!r:.100}")
    return [float(x) for x in pair]


def _numbers(x):
    if hasattr(x, "tolist"):
        return x.tolist()
    raise TypeError(f"a state holds numbers and lists of them, found {x!r:.100}")


def _state(at):
    """A state in the form that the reader of states takes: text, or the path of a file."""
    if at is None:
        return ""
    if isinstance(at, dict):
        return json.dumps(at, default=_numbers)
    return os.fspath(at)
