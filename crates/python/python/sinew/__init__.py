"""Soft tissue by nonlinear finite elements, on the CPU and the GPU.

>>> import sinew
>>> scene = sinew.Scene("scenes/cube_under_gravity.ron")
>>> simulation = sinew.Simulation(scene)
>>> simulation.advance_to(0.1)
>>> places = simulation.body("cube").positions()  # (n, 3), in m

A scene is a text file (`docs/scene.md` describes every word); all units are SI. `docs/python.md` tells of the rest:
inputs, grabbing, snapshots, errors, pictures, the viewer (:func:`sinew.view`), sweeps (:func:`sinew.sweep`), reinforcement learning (:mod:`sinew.gym`),
:mod:`sinew.usd` and :mod:`sinew.rerun`.
"""

from collections.abc import Mapping

from ._copies import per_copy
from ._errors import Bug, Error, GpuError, NotConverged, SceneError, SnapshotError, Unstable
from ._sinew import Body, Grab, Inputs, Pick, Picture, Scene, Simulation, Snapshot, __version__
from ._sweep import Row, grid, latin_hypercube, read_sweep, sweep
from ._view import view

Mapping.register(Inputs)

__all__ = [
    "Body",
    "Bug",
    "Error",
    "GpuError",
    "Grab",
    "Inputs",
    "NotConverged",
    "Pick",
    "Picture",
    "Row",
    "Scene",
    "SceneError",
    "Simulation",
    "Snapshot",
    "SnapshotError",
    "Unstable",
    "__version__",
    "grid",
    "latin_hypercube",
    "per_copy",
    "read_sweep",
    "sweep",
    "view",
]
