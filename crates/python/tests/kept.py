"""What sweeps keep, importable where processes do the work."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

import sinew


def shape(simulation: sinew.Simulation) -> dict[str, Any]:
    """All places, and their mean."""
    places = simulation.body("block").positions()
    return {"places": places, "mean": places.mean(axis=0), "count": len(places)}


def shape_of_a_mortal(simulation: sinew.Simulation) -> dict[str, Any]:
    """The same; whoever is asked first, ends without a word."""
    mark = Path(os.environ["SINEW_TEST_MARK"])
    time.sleep(0.02)
    try:
        mark.open("x").close()
    except FileExistsError:
        return shape(simulation)
    os._exit(1)


def wrong(simulation: sinew.Simulation) -> dict[str, Any]:
    """A mistake of the user's own."""
    raise ZeroDivisionError(f"at {simulation.time}")
