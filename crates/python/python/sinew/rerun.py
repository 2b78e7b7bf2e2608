"""Runs in the Rerun viewer: `pip install rerun-sdk`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._sinew import Simulation


def log(simulation: Simulation, entity: str = "sinew", *, timeline: str = "time", recording: Any = None) -> None:
    """Logs the present state at the simulated time: the surface of each body's mesh (not its skin) at `ENTITY/BODY`,
    coloured by how far nodes have moved, and what probes see at `ENTITY/probes/NAME`.

    Goes to the recording of `rerun.init`, or to the one given. Statistics that Rerun sends are its own:
    `rerun analytics disable` turns them off.
    """
    import rerun

    rerun.set_time(timeline, duration=simulation.time, recording=recording)
    for name, body in simulation.bodies.items():
        moved = np.linalg.norm(body.displacements(), axis=1)
        share = moved / max(float(moved.max(initial=0.0)), 1e-300)
        colours = np.stack([255 * share, 90 + 60 * share, 255 * (1 - share)], axis=1).astype(np.uint8)
        mesh = rerun.Mesh3D(
            vertex_positions=body.positions(), triangle_indices=body.triangles, vertex_colors=colours
        )
        rerun.log(f"{entity}/{name}", mesh, recording=recording)
    for name, seen in simulation.probes().items():
        rerun.log(f"{entity}/probes/{name}", rerun.Scalars(seen), recording=recording)
