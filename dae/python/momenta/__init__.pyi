# Types of the package momenta, for editors and type checkers; a test compares them with the package.

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, TypedDict

import numpy
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

__version__: str

_Array = NDArray[numpy.float64]
_Path = str | os.PathLike[str]
_State = Mapping[str, Any] | _Path | None
_Progress = bool | Callable[[float, str], object] | None
_Vector = Sequence[float] | _Array
_Direction = Literal["x", "-x", "y", "-y", "z", "-z"] | _Vector

class SceneError(ValueError): ...

class _Origin(TypedDict, total=False):
    parent: _Vector
    child: _Vector

class _Rotation(TypedDict, total=False):
    rpy: _Vector
    quaternion: Sequence[float]
    axis: _Direction
    angle: float

class _Shape(TypedDict, total=False):
    kind: Literal["rod", "box", "cylinder", "sphere", "point"]
    length: float
    radius: float
    size: _Vector
    axis: _Direction

class _SceneKeys(TypedDict, total=False):
    gravity: _Vector
    parameters: Mapping[str, float | str]
    require: Sequence[Mapping[str, str]]
    body: Sequence[Mapping[str, Any]]
    joint: Sequence[Mapping[str, Any]]
    loop: Sequence[Mapping[str, Any]]
    drive: Sequence[Mapping[str, Any]]
    force: Sequence[Mapping[str, Any]]
    function: Sequence[Mapping[str, Any]]
    marker: Sequence[Mapping[str, Any]]
    event: Sequence[Mapping[str, Any]]
    visual: Sequence[Mapping[str, Any]]
    assembly: Mapping[str, Any]
    run: Mapping[str, Any]
    lagrangian: Mapping[str, Any]

class _Bearing(TypedDict, total=False):
    static: float
    dynamic: float
    transition: float
    radius: float
    length: float

class _BodyKeys(TypedDict, total=False):
    mass: float
    shape: _Shape
    com: _Vector
    inertia: float | Sequence[float]
    any_inertia: bool

class _JointKeys(TypedDict, total=False):
    parent: str
    child: str
    origin: _Origin
    rotation: _Rotation
    axis: _Direction
    axis2: _Direction
    direction: _Direction
    pitch: float
    position: float | Sequence[float]
    velocity: float | Sequence[float]
    stiffness: float
    rest: float
    damping: float
    rotor_inertia: float | Sequence[float]
    friction: float
    friction_rate: float
    bearing: _Bearing
    limits: Sequence[float]
    stop_stiffness: float
    stop_damping: float
    stop_width: float
    restitution: float

class _LoopKeys(TypedDict, total=False):
    parent: str
    child: str
    origin: _Origin
    rotation: _Rotation
    axis: _Direction
    axis2: _Direction
    direction: _Direction
    length: float
    joints: Sequence[str]
    ratios: Sequence[float]
    powers: Sequence[int]
    coordinates: Sequence[int]
    offset: float
    curve: Literal["line", "circle", "spline"]
    radius: float
    crown_radius: float
    normal: _Direction
    points: Sequence[Sequence[float]]
    closed: bool
    profile: Mapping[str, Mapping[str, Any]]
    equation: str

class _DriveKeys(TypedDict, total=False):
    from_: float
    joint: str
    loop: str
    coordinate: int
    origin: Literal["x", "y", "z"]
    coefficients: Sequence[float]
    amplitude: float
    frequency: float
    offset: float
    phase: float
    to: float
    duration: float
    start: float
    times: Sequence[float]
    values: Sequence[float]
    law: str

class _SpringKeys(TypedDict, total=False):
    name: str
    parent: str
    child: str
    origin: _Origin
    stiffness: float
    damping: float
    rest: float
    dead_band: float
    limits: Sequence[float]
    stop_stiffness: float
    stop_damping: float
    stop_width: float
    law: str

class _ForceKeys(_SpringKeys, total=False):
    joint: str
    value: float
    V: str
    body: str
    point: _Vector
    force: Sequence[float | str]
    torque: Sequence[float | str]
    axes: Literal["ground", "body"]
    rotation: _Rotation
    rotational_stiffness: float
    rotational_damping: float
    joints: Sequence[str]
    coordinates: Sequence[int]
    ratios: Sequence[float]

class _MarkerKeys(TypedDict, total=False):
    point: _Vector

class _EventKeys(TypedDict, total=False):
    name: str
    direction: Literal["up", "down", "both"]
    stop: bool

class _VisualKeys(TypedDict, total=False):
    size: _Vector
    length: float
    radius: float
    file: str
    scale: _Vector
    position: _Vector
    rotation: _Rotation
    colour: _Vector

class _LagrangianKeys(TypedDict, total=False):
    units: Sequence[str]
    position: Sequence[float | str]
    velocity: Sequence[float | str]
    lagrangian: Any
    kinetic: Any
    potential: Any
    force: Mapping[str, Any]
    constraints: Sequence[Mapping[str, str]]

class _AssemblyKeys(TypedDict, total=False):
    hold: Sequence[str]

class _RunTableKeys(TypedDict, total=False):
    end: float
    step: float
    leak: float
    samples: int
    project: bool

class _RunKeys(TypedDict, total=False):
    form: str
    integrator: str
    gauge: str
    rtol: float
    atol: float | None
    step: float | None
    end: float | None
    samples: int | None
    spectral_radius: float
    project: bool | None
    baumgarte_alpha: float
    baumgarte_beta: float
    beta: float
    penalty: float
    cpu_limit: float

class Formula:
    def __init__(self, text: str) -> None: ...
    @property
    def text(self) -> str: ...
    def __neg__(self) -> Formula: ...
    def __pos__(self) -> Formula: ...
    def __abs__(self) -> Formula: ...
    def __add__(self, other: Any) -> Formula: ...
    def __radd__(self, other: Any) -> Formula: ...
    def __sub__(self, other: Any) -> Formula: ...
    def __rsub__(self, other: Any) -> Formula: ...
    def __mul__(self, other: Any) -> Formula: ...
    def __rmul__(self, other: Any) -> Formula: ...
    def __truediv__(self, other: Any) -> Formula: ...
    def __rtruediv__(self, other: Any) -> Formula: ...
    def __pow__(self, other: Any) -> Formula: ...
    def __rpow__(self, other: Any) -> Formula: ...
    def __lt__(self, other: Any) -> Formula: ...
    def __le__(self, other: Any) -> Formula: ...
    def __gt__(self, other: Any) -> Formula: ...
    def __ge__(self, other: Any) -> Formula: ...
    def __eq__(self, other: Any) -> Formula: ...  # type: ignore[override]
    def __ne__(self, other: Any) -> Formula: ...  # type: ignore[override]
    def __and__(self, other: Any) -> Formula: ...
    def __or__(self, other: Any) -> Formula: ...
    def __invert__(self) -> Formula: ...

class Scene:
    def __init__(self, name: str = "", **keys: Unpack[_SceneKeys]) -> None: ...
    def body(self, name: str, **keys: Unpack[_BodyKeys]) -> Scene: ...
    def joint(self, name: str, kind: str, **keys: Unpack[_JointKeys]) -> Scene: ...
    def loop(self, name: str, kind: str, **keys: Unpack[_LoopKeys]) -> Scene: ...
    def drive(self, kind: str, **keys: Unpack[_DriveKeys]) -> Scene: ...
    def force(self, kind: str, **keys: Unpack[_ForceKeys]) -> Scene: ...
    def spring(self, **keys: Unpack[_SpringKeys]) -> Scene: ...
    def marker(self, name: str, body: str, **keys: Unpack[_MarkerKeys]) -> Scene: ...
    def function(self, name: str, x: Sequence[float], y: Sequence[float]) -> Scene: ...
    def event(self, when: Any, **keys: Unpack[_EventKeys]) -> Scene: ...
    def visual(self, body: str, kind: str, **keys: Unpack[_VisualKeys]) -> Scene: ...
    def lagrangian(self, coordinates: Sequence[str], **keys: Unpack[_LagrangianKeys]) -> Scene: ...
    def constraint(self, name: str, equation: Any, unit: Literal["m", "rad"] | None = None) -> Scene: ...
    def assembly(self, **keys: Unpack[_AssemblyKeys]) -> Scene: ...
    def run(self, **keys: Unpack[_RunTableKeys]) -> Scene: ...
    @classmethod
    def from_dict(cls, keys: Mapping[str, Any]) -> Scene: ...
    def to_dict(self) -> dict[str, Any]: ...
    def to_toml(self) -> str: ...
    def save(self, file: _Path) -> None: ...
    def load(
        self,
        algebra: str = "auto",
        kkt: str = "auto",
        *,
        cut: str = "auto",
        at: _State = None,
        set: Mapping[str, float] | None = None,
        stops: float | Sequence[float] | None = None,
    ) -> Mechanism: ...
    def __eq__(self, other: object) -> bool: ...

class Start:
    @property
    def t(self) -> float: ...
    @property
    def q(self) -> _Array: ...
    @property
    def u(self) -> _Array: ...
    @property
    def udot(self) -> _Array: ...
    @property
    def lambda_(self) -> _Array: ...
    @property
    def residue(self) -> str: ...
    @property
    def rank(self) -> int: ...
    @property
    def mobility(self) -> int: ...
    @property
    def free_positions(self) -> int: ...
    @property
    def dependent_rows(self) -> list[int]: ...
    @property
    def moved(self) -> float: ...
    @property
    def branch(self) -> str: ...

class Mechanism:
    @property
    def name(self) -> str: ...
    @property
    def nq(self) -> int: ...
    @property
    def nv(self) -> int: ...
    @property
    def m(self) -> int: ...
    @property
    def coordinates(self) -> list[str]: ...
    @property
    def rates(self) -> list[str]: ...
    @property
    def equations(self) -> list[str]: ...
    @property
    def q0(self) -> _Array: ...
    @property
    def u0(self) -> _Array: ...
    @property
    def plan(self) -> dict[str, str]: ...
    @property
    def options(self) -> dict[str, str]: ...
    @property
    def remarks(self) -> list[str]: ...
    def to_toml(self) -> str: ...
    def assemble(self) -> Start: ...
    def momentum_rates(
        self,
        t: float,
        q: ArrayLike,
        p: ArrayLike,
        centre: ArrayLike | None = None,
        leak: float = 0.0,
        tau: ArrayLike | None = None,
    ) -> tuple[_Array, _Array, _Array]: ...
    def accelerations(
        self, t: float, q: ArrayLike, u: ArrayLike, tau: ArrayLike | None = None
    ) -> tuple[_Array, _Array]: ...
    def rates_of_states(
        self,
        t: float,
        q: ArrayLike,
        p: ArrayLike,
        tau: ArrayLike | None = None,
        leak: float = 0.0,
        threads: int = 1,
    ) -> tuple[_Array, _Array]: ...
    def accelerations_of_states(
        self, t: float, q: ArrayLike, u: ArrayLike, tau: ArrayLike | None = None, threads: int = 1
    ) -> tuple[_Array, _Array]: ...
    def momenta(self, t: float, q: ArrayLike, u: ArrayLike, sigma: ArrayLike | None = None) -> _Array: ...
    def constraints(self, t: float, q: ArrayLike, u: ArrayLike) -> tuple[_Array, _Array]: ...
    def kkt(self, t: float, q: ArrayLike) -> tuple[_Array, _Array]: ...
    def inverse_mass_times(self, t: float, q: ArrayLike, x: ArrayLike) -> _Array: ...
    def energies(self, t: float, q: ArrayLike, u: ArrayLike) -> tuple[float, float]: ...
    def evaluate(
        self, t: float = 0.0, q: ArrayLike | None = None, v: ArrayLike | None = None, p: ArrayLike | None = None
    ) -> dict[str, Any]: ...
    def move(self, sweep: str | dict[str, float], to: float | None = None, by: float = 0, hold: Sequence[str] = (), output: str = "") -> dict[str, Any]: ...
    def assemblies(self, hold: Sequence[str] = (), by: str = "search", starts: int = 1000, seed: int = 1, threads: int = 0) -> dict[str, Any]: ...
    def effort(
        self,
        *,
        motion: dict[str, ArrayLike] | None = None,
        actuate: Sequence[str] = (),
        weights: dict[str, float] = ...,
        hold: Sequence[str] = (),
        static: bool = False,
        end: float | None = None,
        samples: int | None = None,
        within: float = 1e-6,
    ) -> dict[str, Any]: ...
    def modes(self, equilibrium: str = "settle", drives: str = "held", count: int = 0) -> dict[str, Any]: ...
    def linearise(
        self,
        kind: str = "minimal",
        t: float = 0.0,
        q: ArrayLike | None = None,
        u: ArrayLike | None = None,
        equilibrium: str = "",
        inputs: Sequence[str] = (),
        outputs: Sequence[str] = (),
        independent: Sequence[str] = (),
    ) -> dict[str, Any]: ...
    def fit(
        self,
        vary: Sequence[str],
        *,
        sweep: str = "",
        to: str = "",
        least: str = "",
        keep: Sequence[str] = (),
        over: tuple[float, float] | None = None,
        poses: int = 73,
        rate: float = 1.0,
        starts: int = 1,
        seed: int = 1,
        iterations: int = 500,
        form: str = "momentum",
        integrator: str = "",
        gauge: str = "",
        rtol: float = 1e-8,
        atol: float | None = None,
        step: float | None = None,
        end: float | None = None,
        project: bool | None = None,
        baumgarte_alpha: float = 0.0,
        baumgarte_beta: float = 0.0,
        beta: float = 0.0,
        progress: _Progress = None,
    ) -> dict[str, Any]: ...
    def gradient(
        self,
        of: str,
        by: Sequence[str],
        *,
        integral: bool = False,
        form: str = "momentum",
        integrator: str = "",
        gauge: str = "",
        rtol: float = 1e-8,
        atol: float | None = None,
        step: float | None = None,
        end: float | None = None,
        samples: int | None = None,
        project: bool | None = None,
        baumgarte_alpha: float = 0.0,
        baumgarte_beta: float = 0.0,
        beta: float = 0.0,
        cpu_limit: float = 0.0,
        trajectory: bool = False,
        mode: Literal["automatic", "forward", "adjoint"] = "automatic",
        progress: _Progress = None,
    ) -> dict[str, Any]: ...
    def run(
        self,
        *,
        form: str = "momentum",
        integrator: str = "",
        gauge: str = "",
        rtol: float = 1e-8,
        atol: float | None = None,
        step: float | None = None,
        end: float | None = None,
        samples: int | None = None,
        spectral_radius: float = 0.8,
        project: bool | None = None,
        baumgarte_alpha: float = 0.0,
        baumgarte_beta: float = 0.0,
        beta: float = 0.0,
        penalty: float = 0.0,
        cpu_limit: float = 0.0,
        reference: str = "",
        reactions: bool = False,
        progress: _Progress = None,
    ) -> Run: ...
    def drift(
        self,
        *,
        forms: Sequence[str] = (),
        integrator: str = "",
        rtol: float = 1e-8,
        step: float | None = None,
        end: float | None = None,
        samples: int | None = None,
        reference: str = "",
        cpu_limit: float = 60.0,
        progress: _Progress = None,
    ) -> Study: ...
    def work(
        self,
        *,
        forms: Sequence[str] = (),
        integrators: Sequence[str] = (),
        tolerances: Sequence[float] = (1e-4, 1e-6, 1e-8, 1e-10),
        end: float | None = None,
        reference: str = "",
        cpu_limit: float = 10.0,
        progress: _Progress = None,
    ) -> Study: ...

class Run:
    @property
    def scene(self) -> str: ...
    @property
    def form(self) -> str: ...
    @property
    def integrator(self) -> str: ...
    @property
    def gauge(self) -> str: ...
    @property
    def rtol(self) -> float: ...
    @property
    def atol(self) -> float: ...
    @property
    def step(self) -> float: ...
    @property
    def end_time(self) -> float: ...
    @property
    def project(self) -> bool: ...
    @property
    def baumgarte_alpha(self) -> float: ...
    @property
    def baumgarte_beta(self) -> float: ...
    @property
    def beta(self) -> float: ...
    @property
    def penalty(self) -> float: ...
    @property
    def kkt(self) -> str: ...
    @property
    def jacobian(self) -> str: ...
    @property
    def linear_solver(self) -> str: ...
    @property
    def status(self) -> str: ...
    @property
    def stopped_at(self) -> float: ...
    @property
    def reason(self) -> str: ...
    @property
    def departure(self) -> str: ...
    @property
    def stiff_from(self) -> float: ...
    @property
    def changed_at(self) -> float: ...
    @property
    def position_drift_max(self) -> float: ...
    @property
    def velocity_drift_max(self) -> float: ...
    @property
    def between_steps_max(self) -> float: ...
    @property
    def angle_drift_max(self) -> float: ...
    @property
    def angle_rate_drift_max(self) -> float: ...
    @property
    def angle_between_steps_max(self) -> float: ...
    @property
    def position_exponent(self) -> float: ...
    @property
    def velocity_exponent(self) -> float: ...
    @property
    def angle_exponent(self) -> float: ...
    @property
    def angle_rate_exponent(self) -> float: ...
    @property
    def energy_error_max(self) -> float: ...
    @property
    def energy_turned_over(self) -> float: ...
    @property
    def position_error_max(self) -> float: ...
    @property
    def velocity_error_max(self) -> float: ...
    @property
    def force_error_max(self) -> float: ...
    @property
    def multiplier_error_max(self) -> float: ...
    @property
    def multiplier_difference_max(self) -> float: ...
    @property
    def momentum_error_max(self) -> float: ...
    @property
    def impulse_error_max(self) -> float: ...
    @property
    def effort_error_max(self) -> float: ...
    @property
    def reaction_error_max(self) -> float: ...
    @property
    def work_error_max(self) -> float: ...
    @property
    def partitions(self) -> int: ...
    @property
    def cpu_s(self) -> float: ...
    @property
    def wall_s(self) -> float: ...
    @property
    def repeats(self) -> int: ...
    @property
    def untimed(self) -> str: ...
    @property
    def integrated(self) -> str: ...
    @property
    def residue(self) -> str: ...
    @property
    def weak_evaluations(self) -> int: ...
    @property
    def least_pivot(self) -> float: ...
    @property
    def events(self) -> list[dict[str, Any]]: ...
    @property
    def event_remarks(self) -> list[str]: ...
    @property
    def stops(self) -> list[dict[str, Any]]: ...
    @property
    def counters(self) -> dict[str, int]: ...
    @property
    def drift_unit(self) -> str: ...
    @property
    def reaction_errors(self) -> list[dict[str, Any]]: ...
    @property
    def t(self) -> _Array: ...
    @property
    def position_drift(self) -> _Array: ...
    @property
    def angle_drift(self) -> _Array: ...
    @property
    def angle_rate_drift(self) -> _Array: ...
    @property
    def velocity_drift(self) -> _Array: ...
    @property
    def energy(self) -> _Array: ...
    @property
    def energy_error(self) -> _Array: ...
    @property
    def impulse(self) -> _Array: ...
    @property
    def position_error(self) -> _Array: ...
    @property
    def force_error(self) -> _Array: ...
    @property
    def multiplier_error(self) -> _Array: ...
    @property
    def multiplier_difference(self) -> _Array: ...
    @property
    def momentum_error(self) -> _Array: ...
    @property
    def impulse_error(self) -> _Array: ...
    @property
    def effort_error(self) -> _Array: ...
    @property
    def reaction_error(self) -> _Array: ...
    @property
    def work_error(self) -> _Array: ...
    @property
    def columns(self) -> list[str]: ...
    @property
    def trajectory(self) -> _Array: ...
    def __getitem__(self, name: str) -> _Array: ...
    def plot(self, *columns: str, ax: Any = None) -> Any: ...

_Loaded = Scene | Mechanism | Mapping[str, Any] | str | os.PathLike[str]

class Study(list[Run]):
    ladder: bool
    @property
    def table(self) -> str: ...
    def __init__(self, runs: Iterable[Run] = (), ladder: bool = False) -> None: ...
    def plot(self, what: str | None = None, *, ax: Any = None) -> Any: ...

class Sweep:
    csv: str
    json: dict[str, Any]
    table: str
    @property
    def columns(self) -> list[str]: ...
    def __getitem__(self, name: str) -> _Array | list[str]: ...
    def __len__(self) -> int: ...
    def plot(self, column: str = "position_drift_max", *, ax: Any = None) -> Any: ...
    def plot_along_time(self, column: str, *, ax: Any = None) -> Any: ...

class Page(str):
    def save(self, file: _Path) -> None: ...

def load(
    scene: Scene | Mapping[str, Any] | _Path,
    algebra: str = "auto",
    kkt: str = "auto",
    *,
    cut: str = "auto",
    loops: _Path = "",
    free_root: bool = False,
    key: str | int = "",
    at: _State = None,
    set: Mapping[str, float] | None = None,
    control: Mapping[str, float] | float | None = None,
    stops: float | Sequence[float] | None = None,
) -> Mechanism: ...
def parse(
    text: str, name: str = "scene", algebra: str = "auto", kkt: str = "auto", *, cut: str = "auto"
) -> Mechanism: ...
def evaluate(scene: _Loaded, at: _State = None) -> dict[str, Any]: ...
def index(
    scene: _Loaded, forms: Iterable[str] = (), at: _State = None, *, progress: _Progress = None
) -> dict[str, Any]: ...
def run(scene: _Loaded, **arguments: Any) -> Run: ...
def view(scene: _Loaded) -> Page: ...
def sweep(
    scene: _Loaded,
    vary: Mapping[str, str | ArrayLike] | Iterable[str],
    *,
    watch: str | Iterable[str] = (),
    sample: str = "",
    points: int | None = None,
    seed: int | None = None,
    indices: bool = False,
    threads: int = 0,
    progress: _Progress = None,
    **run: Unpack[_RunKeys],
) -> Sweep: ...
def forms() -> list[str]: ...
def integrators() -> list[str]: ...
