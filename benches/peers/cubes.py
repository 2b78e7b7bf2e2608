"""The cubes all programs run, and how one of them is timed. Lengths in m, times in s, SI units throughout."""

import argparse
import json
import time

import numpy as np

EDGE = 0.1
YOUNG, POISSON, DENSITY = 3000.0, 0.45, 1000.0
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
GRAVITY = -2.0
WATCHED = 0.1  # the time at which the top's displacement is told
# Six tetrahedra of a cell along the diagonal from corner 0 to corner 7; corner = x + 2 y + 4 z. The same as the engine's Box.
KUHN = [[0, 1, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 1, 7, 5], [0, 2, 7, 3], [0, 4, 7, 6]]


class Cube:
    """points (n, 3), x fastest; tets (m, 4), of positive volume; mass (n), lumped; held and top, indices of nodes."""

    def __init__(self, cells):
        line = np.arange(cells + 1)
        z, y, x = (axis.ravel() for axis in np.meshgrid(line, line, line, indexing="ij"))
        self.cells = cells
        self.points = np.stack([x, y, z], 1) * (EDGE / cells)
        inner = (x < cells) & (y < cells) & (z < cells)
        row = cells + 1
        corners = np.array([i + row * (j + row * k) for k in (0, 1) for j in (0, 1) for i in (0, 1)])
        corner = np.flatnonzero(inner)[:, None] + corners
        self.tets = corner[:, KUHN].reshape(-1, 4).astype(np.int32)
        edges = self.points[self.tets[:, 1:]] - self.points[self.tets[:, :1]]
        volume = np.linalg.det(edges) / 6
        assert (volume > 0).all()
        self.mass = np.zeros(len(self.points))
        np.add.at(self.mass, self.tets.ravel(), np.repeat(volume * DENSITY / 4, 4))
        self.held = np.flatnonzero(z == 0)
        self.top = np.flatnonzero(z == cells)


def measure(program, version, build, note="", threads=(1,)):
    """Times one cube and prints a line of JSON.

    `build(cube, threads)` gives a body with `reset(step)`, `advance(steps)` (even) and `positions()`;
    `threads` are those it knows, None for any.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--cells", type=int, default=10)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=6.0, help="seconds of timed blocks")
    asked = parser.parse_args()
    if threads is not None and asked.threads not in threads:
        return
    cube = Cube(asked.cells)
    body = build(cube, asked.threads)
    steps = stable_steps(cube, body)
    body.reset(WATCHED / steps)
    body.advance(steps)
    watched = top(cube, body)
    best, median = best_block(body, asked.seconds)
    if not watched < 0 or not bounded(cube, body):
        raise SystemExit(f"{program}, {asked.cells} cells: diverged, the time counts for nothing")
    scale = 1e9 / len(cube.tets)
    print(
        json.dumps(
            {
                "program": program,
                "version": version,
                "threads": asked.threads,
                "cells": asked.cells,
                "ns": best * scale,
                "median": median * scale,
                "step": WATCHED / steps,
                "top": watched,
                "note": note,
            }
        ),
        flush=True,
    )


def stable_steps(cube, body):
    """An even number of steps until the watched time: a quarter more than the first of a row that keeps the cube bounded."""
    wave = np.sqrt((LAME + 2 * SHEAR) / DENSITY)
    step = EDGE / cube.cells / np.sqrt(2) / wave  # a wave through the lowest height of a tetrahedron
    for _ in range(12):
        steps = even(WATCHED / step)
        body.reset(WATCHED / steps)
        body.advance(steps)
        if bounded(cube, body) and top(cube, body) < 0:
            return even(1.25 * steps)
        step *= 0.8
    raise SystemExit("no stable step was found")


def even(number):
    """The next even number: some programs step from one state into another and back."""
    return 2 * int(np.ceil(number / 2))


def top(cube, body):
    """Mean displacement of the top, along z."""
    return float((body.positions() - cube.points)[cube.top, 2].mean())


def bounded(cube, body):
    """Whether all nodes are finite and less than a fifth of the edge away from where they were."""
    moved = np.abs(body.positions() - cube.points).max()
    return bool(np.isfinite(moved) and moved < EDGE / 5)


def best_block(body, seconds):
    """Best and median seconds a step, of blocks of some milliseconds, as `sinew bench` has them."""
    began = time.perf_counter()
    body.advance(10)
    body.positions()
    steps = even(10 * 0.005 / (time.perf_counter() - began))
    blocks = []
    until = time.perf_counter() + seconds
    while len(blocks) < 5 or time.perf_counter() < until:
        began = time.perf_counter()
        body.advance(steps)
        blocks.append((time.perf_counter() - began) / steps)
    return min(blocks), float(np.median(blocks))
