"""The engine. Arrays are numpy's; units are SI; the order of nodes and elements is that of the scene's meshes (*the
author's order*) unless something else is said."""

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import NDArray

__version__: str

@final
class Scene:
    """A scene, read and checked: simulations are made of it, as many as are wanted. It can be pickled: of a scene from
    a file the path travels, of one from a text the text.

    `set` puts values in at places, as `--set` does: `{"bodies.cube.mesh.cells": (20, 20, 20)}`. Values are numbers,
    bools, None, tuples, lists and arrays of those, and texts, which are RON as they stand (`"Young(young: 5e3, poisson:
    0.45)"`). `allow_outside`: the scene may name files outside its folder.

    Raises SceneError with all mistakes at once.
    """

    def __new__(
        cls, path: str | os.PathLike[str], set: Mapping[str, Any] | None = None, *, allow_outside: bool = False
    ) -> Scene: ...
    @classmethod
    def from_text(
        cls,
        text: str,
        set: Mapping[str, Any] | None = None,
        *,
        name: str = "scene.ron",
        folder: str | os.PathLike[str] | None = None,
        files: Mapping[str, bytes | str] | None = None,
        allow_outside: bool = False,
    ) -> Scene:
        """A scene of a text. Meshes and laws that it names are in `folder`, or in memory: `files`, by the names that
        the scene gives them; then nothing is read from a disk. `name` stands in messages."""

    @classmethod
    def _made_of(
        cls,
        name: str | None,
        text: str | None,
        path: str | os.PathLike[str] | None,
        files: Mapping[str, bytes] | None,
        sets: Sequence[str],
        allow_outside: bool,
    ) -> Scene: ...
    def with_values(self, set: Mapping[str, Any]) -> Scene:
        """The same scene, read again with these values too."""

    @property
    def text(self) -> str:
        """The text with all values that were put in."""

    @property
    def title(self) -> str:
        """What the scene shows."""

    @property
    def duration(self) -> float:
        """Simulated time (s)."""

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies."""

    @property
    def probes(self) -> list[str]:
        """Names of the probes."""

    @property
    def tools(self) -> list[str]:
        """Names of the tools."""

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What is not wrong but should be known, as in `SceneError.diagnostics`."""

@final
class Inputs(Mapping[str, float]):
    """The inputs of a simulation: `simulation.inputs["grip"] = 0.3` sets what a `curve: Input(name: "grip")` goes to
    from the next step on; reading gives its present value."""

    def __len__(self) -> int: ...
    def __getitem__(self, name: str) -> float: ...
    def __setitem__(self, name: str, value: float) -> None: ...
    def __iter__(self) -> Any: ...
    def about(self, name: str) -> dict[str, Any]:
        """`value`, `target`, `rate` (1/s or None) and `uses`: where in the scene, what of it, its unit."""

@final
class Pick:
    """Where a ray meets a body: see Simulation.pick."""

    @property
    def body(self) -> str:
        """The body's name."""

    @property
    def element(self) -> int:
        """The author's number of the element behind the face."""

    @property
    def nodes(self) -> list[int]:
        """The three nodes of the triangle: rows of Body.positions()."""

    @property
    def weights(self) -> list[float]:
        """The point's weights of these nodes, which sum up to 1."""

    @property
    def point(self) -> NDArray[np.float64]:
        """The point (m), (3,)."""

    @property
    def normal(self) -> NDArray[np.float64]:
        """The triangle's outward normal, (3,)."""

    @property
    def distance(self) -> float:
        """From the ray's origin (m)."""

@final
class Grab:
    """What a hand holds, from Simulation.grab."""

    def move(self, target: Sequence[float] | NDArray[np.float64]) -> None:
        """Pulls the point to a place (m), from the next step on."""

    @property
    def force(self) -> NDArray[np.float64]:
        """The force with which it pulls (N), (3,)."""

    def release(self) -> None:
        """Lets go."""

@final
class Snapshot:
    """A state of a simulation. It can be pickled."""

    @property
    def time(self) -> float:
        """The time (s)."""

    @property
    def step_count(self) -> int:
        """Steps taken until then."""

    def to_bytes(self) -> bytes:
        """As a file has it."""

    @classmethod
    def from_bytes(cls, data: bytes) -> Snapshot:
        """Of a file's bytes. Raises SnapshotError."""

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes it; `sinew run --resume` takes it."""

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Snapshot:
        """Reads one. Raises SnapshotError."""

    def differences(self, other: Snapshot) -> list[str]:
        """The parts in which two differ by a bit or more; none where they are the same."""

@final
class Picture:
    """A picture: notebooks show it."""

    @property
    def png(self) -> bytes:
        """As a PNG file."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it."""

    def _repr_png_(self) -> bytes: ...

@final
class Body:
    """A body of a simulation, from Simulation.body. What it gives is of the simulation's present state."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def displacement(self) -> NDArray[np.float32] | NDArray[np.float64]:
        """Displacements (m) as they lie in memory, without a copy: (rows, 3), in the run's precision, read-only.

        `displacement[body.rows]` is in the author's order. The array lives as long as anybody holds it. Explicit steps
        on the CPU write into it. After going back, Simulation.change, implicit steps, static analyses and on a GPU it
        keeps the state it showed, and `generation` is another: ask again. While another thread steps it may show old
        and new numbers mixed.
        """

    @property
    def generation(self) -> int:
        """Another one whenever arrays from `displacement` may have been left behind."""

    @property
    def rows(self) -> NDArray[np.uint32]:
        """The row of `displacement` of each node in the author's order, (n,)."""

    def positions(self, out: NDArray[Any] | None = None) -> NDArray[np.float64]:
        """Where the nodes are (m), (n, 3), in the author's order. `out`: an array of that shape to write into, of any
        type that float64 can be cast to; it is handed back."""

    def displacements(self, out: NDArray[Any] | None = None) -> NDArray[np.float64]:
        """Displacements of the nodes (m), (n, 3), in the author's order; a copy. `out` as of positions."""

    @property
    def rest_positions(self) -> NDArray[np.float64]:
        """Where the nodes are at rest (m), (n, 3)."""

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Triangles of the surface, (m, 3): rows of positions(), counter-clockwise seen from outside. They change when
        elements are removed."""

    @property
    def node_numbers(self) -> NDArray[np.uint64]:
        """The author's numbers of the nodes, (n,)."""

    def fields(self) -> dict[str, NDArray[Any]]:
        """`displacement` (m) and `velocity` (m/s, in the middle of the last step) of nodes, (n, 3); of elements
        `volume_ratio` (e,), `stress` (Pa, Cauchy: xx, yy, zz, xy, yz, xz; (e, 6)) and `alive` (bool, (e,))."""

    def internal_forces(self) -> NDArray[np.float64]:
        """Internal forces on the nodes (N), (n, 3)."""

    def masses(self) -> NDArray[np.float64]:
        """Lumped masses of the nodes (kg), (n,); 0 where all elements are removed."""

    def contact(self) -> dict[str, Any]:
        """What it feels of other bodies and itself. Raises ValueError where it may touch none."""

    @property
    def copies(self) -> int:
        """How many copies of its mesh it is made of (`copies` in the scene)."""

    def by_copy(self, array: NDArray[Any]) -> NDArray[Any]:
        """An array of all nodes or elements, (n, ...), parted into those of each copy: (copies, n / copies, ...)."""

@final
class Simulation:
    """A simulation of a scene. The interpreter is released while the engine works; a simulation does one thing at a
    time, and who calls meanwhile waits. Several simulations run side by side in threads.

    `backend`: "auto" takes a hardware GPU if there is one, "cpu" or "gpu". `precision`: "f32", or "f64" on the CPU.
    `threads`: 0 is one a core. `grabs`: whether bodies can be grabbed. `resets`: whether the start is kept for reset().

    Raises SceneError, GpuError, and in all that steps or looks Unstable, NotConverged and GpuError.
    """

    def __new__(
        cls,
        scene: Scene,
        *,
        backend: Literal["auto", "cpu", "gpu"] = "auto",
        precision: Literal["f32", "f64"] = "f32",
        threads: int = 0,
        grabs: bool = False,
        resets: bool = True,
    ) -> Simulation: ...
    @property
    def scene(self) -> Scene:
        """What it was made of."""

    @property
    def time(self) -> float:
        """Simulated time (s)."""

    @property
    def time_step(self) -> float:
        """The present step (s)."""

    @property
    def step_count(self) -> int:
        """Steps taken."""

    @property
    def is_finished(self) -> bool:
        """Whether the scene's duration has passed, or equilibrium is reached."""

    @property
    def is_on_gpu(self) -> bool:
        """Whether steps are taken on a GPU."""

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """What is not wrong with the scene but should be known."""

    def step(self, count: int = 1) -> None:
        """Takes steps. Ctrl-C ends this and what follows between two steps; what was done stays."""

    def advance_to(self, time: float) -> None:
        """Takes steps until the time is reached (s). Ctrl-C as of step."""

    def advance_for(self, budget: float, until: float = ...) -> dict[str, Any]:
        """Takes as many steps as fit into a budget of time on the wall (s), one at least, until a simulated time (s).

        Gives `steps`, `simulated` (s), `took` (s), `real_time_factor`, simulated time over that on the wall (in a
        summary it is the other way round), and `why` it ended: "reached", "budget", "rest". It does not wait for
        `real_time: true` of a scene, as the other ways to step do.
        """

    def finish(self) -> None:
        """Takes all steps that are left, to the scene's end or to equilibrium. Ctrl-C as of step."""

    @property
    def inputs(self) -> Inputs:
        """The inputs that the scene has: a mapping from names to values, to be set."""

    def body(self, name: str) -> Body:
        """The body of a name."""

    @property
    def bodies(self) -> dict[str, Body]:
        """All bodies by name."""

    def probe(self, name: str) -> NDArray[np.float64]:
        """What a probe sees now, in the units of its table."""

    def probes(self) -> dict[str, NDArray[np.float64]]:
        """What all probes see now."""

    def energies(self) -> dict[str, Any]:
        """Energies of all bodies (J): kinetic, strain and so on; None for what is not counted."""

    def summary(self, ended: str = "unfinished") -> dict[str, Any]:
        """What the run amounted to so far, as `summary.json` has it; `ended` stands in it."""

    def tool(self, name: str) -> dict[str, Any]:
        """What a tool feels: `force` (N), `torque` (N m), `place` (m), `nodes`, `penetration` (m) and more; `work` and
        `loss` (J) are None in a static analysis, which counts none."""

    def attachment(self, name: str) -> dict[str, Any]:
        """What a suture, tie or glue bears."""

    def change(self, set: Mapping[str, Any]) -> None:
        """Changes parameters of materials and amplitudes of loads while it runs: places and values as of Scene. Raises
        SceneError; then nothing has changed."""

    def snapshot(self) -> Snapshot:
        """The present state."""

    def restore(self, snapshot: Snapshot) -> None:
        """Goes back, or on, to a state. What follows has the same bits as it had. Raises SnapshotError."""

    def reset(self) -> None:
        """Goes back to the start, with all inputs at their initial values and nothing held."""

    def keep_history(self, every: float, *, bytes: int = ...) -> None:
        """Keeps a state now and whenever so much simulated time has passed (s), as many as fit into so many bytes."""

    def forget_history(self) -> None:
        """Keeps no more states, and forgets those that were kept."""

    @property
    def history(self) -> list[float]:
        """The times of the kept states (s), the oldest first."""

    def rewind(self, time: float) -> float:
        """Goes back to the last kept state that is not later than a time (s), or to the start; its time."""

    def pick(
        self,
        origin: Sequence[float] | NDArray[np.float64],
        direction: Sequence[float] | NDArray[np.float64],
    ) -> Pick | None:
        """Where a ray first meets a body's surface as it is now; None where it meets none."""

    def grab(
        self,
        pick: Pick,
        *,
        stiffness: float | None = None,
        damping: float | None = None,
        most_force: float = ...,
    ) -> Grab:
        """Holds the picked point by a spring (N/m) and a damper (N s/m) of at most `most_force` (N). Left out, they are
        so soft that no step has to follow. Needs `grabs=True`."""

    def grab_nodes(
        self,
        body: str,
        nodes: Sequence[int] | NDArray[Any],
        weights: Sequence[float] | NDArray[np.float64] | None = None,
        *,
        stiffness: float | None = None,
        damping: float | None = None,
        most_force: float = ...,
    ) -> Grab:
        """Holds the weighted mean of nodes, which are rows of Body.positions()."""

    def picture(self, array: str | None = None, **words: Any) -> Picture:
        """A picture of the present state, by the software renderer, without tools; of bodies with a skin that is drawn.
        `words` are those of the scene's `picture` (`from_` for `from`): `picture(field="VonMises", from_=(1, -2, 0.6),
        size=(640, 480), ghost=True)`. `array` colours by another array or a component of one: `"displacement.z"`."""

    def _repr_png_(self) -> bytes: ...

class SweepResults:
    """What is done of a part of a sweep, in the files of a folder."""

    def __init__(
        self,
        scene: Scene,
        table: Sequence[Mapping[str, Any]],
        keep: str | list[str],
        at: list[float],
        part: tuple[int, int],
        folder: str,
        how: tuple[str, str, bool],
        /,
    ) -> None: ...
    def missing(self) -> list[int]: ...
    def lines(self) -> list[str]: ...
    def add(self, number: int, line: str, /) -> None: ...
    def write_table(self) -> None: ...

def check_kept(scene: Scene, names: list[str], at: list[float], /) -> None: ...
def probes_at(simulation: Simulation, names: list[str], times: list[float], /) -> list[list[list[float]]]: ...
def warnings_of(simulation: Simulation, /) -> list[str]: ...
def latin_hypercube_rows(ranges: list[tuple[str, tuple[float, float]]], count: int, seed: int, /) -> list[list[float]]: ...
def read_sweep_file(path: str, /) -> tuple[str, list[dict[str, Any]], list[str], list[float]]: ...
