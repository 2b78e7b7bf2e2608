"""Implicit statics with quadratic hexahedra: FElupe's elements and laws, a Newton loop, and extrapolation.

None of it is shared with sinew: 27-node hexahedra with 27 points, either of displacements alone or with pressure and
dilatation linear in each cell ("mixed": Q2/P1, stable and without locking), an exact tangent, a direct solver.
"""

import json
import os
import time
from pathlib import Path

import felupe as fem
import numpy as np
from felupe.element import Element
from pypardiso import spsolve

np.seterr(invalid="ignore")  # inverted elements on the way make NaN, which shortens the step
REFERENCES = Path(__file__).parents[2] / "docs" / "accuracy" / "references.json"


def moduli(young, poisson):
    """Shear and bulk modulus (Pa) of small strains."""
    return young / (2 * (1 + poisson)), young / (3 * (1 - 2 * poisson))


def bulk_of(shear, poisson):
    """Bulk modulus (Pa) from the shear modulus (Pa) and Poisson's ratio."""
    return 2 * shear * (1 + poisson) / (3 * (1 - 2 * poisson))


def graded(s, low=1.0, high=1.0):
    """Numbers of 0 to 1, drawn towards an end whose power is above 1 (cells there shrink like s^(power - 1))."""
    if low > 1 and high > 1:
        return s**low / (s**low + (1 - s) ** high)
    return s**low if low > 1 else 1 - (1 - s) ** high


def quadratic(points, unit):
    """Corner points with the middles of edges, faces and cells: of 27-node hexahedra."""
    return fem.mesh.convert(
        points, unit.cells, unit.cell_type, order=2, calc_points=True, calc_midfaces=True, calc_midvolumes=True
    )


class Linear(Element):
    """1, r, s, t in each cell: no nodes, no continuity."""

    def __init__(self):
        self.shape, self.points = (4,), np.zeros((4, 3))

    def function(self, rst):
        return np.array([1, *rst])

    def gradient(self, rst):
        return np.vstack([np.zeros(3), np.eye(3)])


class Body:
    """A block of 27-node hexahedra: `place` puts the corners of `cells` of the unit cube where they belong.

    `law` is a material of FElupe; `mixed` adds pressure and dilatation.
    """

    def __init__(self, cells, place, law, mixed=True):
        unit = fem.Cube(n=tuple(n + 1 for n in cells))
        points, connectivity, kind = quadratic(place(unit.points), unit)
        # where the nodes are in the unit cube: to carry a solution over from another mesh
        self.unit, self.cells = quadratic(unit.points, unit)[0], np.array(cells)
        self.mesh = fem.Mesh(points, connectivity, kind)
        self.region = fem.RegionTriQuadraticHexahedron(self.mesh)
        if mixed:
            own = np.arange(4 * len(connectivity)).reshape(-1, 4)
            linear = fem.Region(
                fem.Mesh(np.zeros((own.size, 3)), own, "linear"), Linear(), self.region.quadrature, grad=False
            )
            pressure, dilatation = fem.Field(linear, dim=1), fem.Field(linear, dim=1)
            dilatation.values[::4] = 1
            self.field = fem.FieldContainer([fem.Field(self.region, dim=3), pressure, dilatation])
            self.middles = self.unit[connectivity[:, :8]].mean(axis=1)
        else:
            self.field = fem.FieldContainer([fem.Field(self.region, dim=3)])
        self.solid = fem.SolidBody(umat=law, field=self.field)
        self.size = int(sum(self.field.fieldsizes))
        self.prescribed = {}
        self.force = np.zeros(self.size)
        self.share, self.started, self.rest = 0.0, False, self._state()

    def start_from(self, other):
        """Takes over another body's solution, interpolated by its own shape functions in the unit cube."""
        self.displacement[:] = other.interpolated(self.unit)
        for mine, theirs in zip(self.field[1:], other.field[1:]):
            cell, t = other.locate(self.middles)
            table = np.zeros((*other.cells, 4))
            table[tuple(other.locate(other.middles)[0].T)] = theirs.values.reshape(-1, 4)
            row = table[tuple(cell.T)]
            mine.values[::4, 0] = row[:, 0] + (row[:, 1:] * (2 * t - 1)).sum(axis=1)
            mine.values.reshape(-1, 4)[:, 1:] = row[:, 1:] * other.cells / self.cells
        self.started = True
        return self

    def locate(self, unit):
        """The cell of points of the unit cube, and where in it they are (0 to 1)."""
        cell = np.minimum((unit * self.cells).astype(int), self.cells - 1)
        return cell, unit * self.cells - cell

    def interpolated(self, unit):
        """Displacements (m) at points of the unit cube, by the shape functions."""
        cell, t = self.locate(unit)
        shape = [(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)]
        table = np.zeros((*(2 * self.cells + 1), 3))
        table[tuple(np.rint(self.unit * 2 * self.cells).astype(int).T)] = self.displacement
        weights = (shape[i][:, 0] * shape[j][:, 1] * shape[k][:, 2] for i, j, k in np.ndindex(3, 3, 3))
        corners = (table[tuple((2 * cell + list(ijk)).T)] for ijk in np.ndindex(3, 3, 3))
        return sum(weight[:, None] * corner for weight, corner in zip(weights, corners))

    def at(self, point):
        """Displacement (m) of a point at rest in a block whose cells are boxes."""
        unit = []
        for axis in range(3):
            lines = np.unique(np.round(self.mesh.points[:, axis], 12))[::2]
            unit.append(np.interp(point[axis], lines, np.linspace(0, 1, len(lines))))
        return self.interpolated(np.array([unit]))[0]

    @property
    def displacement(self):
        """Displacements of the nodes (m), a row each."""
        return self.field[0].values

    def nodes(self, **where):
        """Nodes whose coordinate is as given: nodes(x=0)."""
        scale = np.ptp(self.mesh.points, axis=0).max()
        keep = np.ones(len(self.mesh.points), bool)
        for axis, at in where.items():
            keep &= abs(self.mesh.points[:, "xyz".index(axis)] - at) < 1e-7 * scale
        return np.flatnonzero(keep)

    def hold(self, nodes, axes="xyz", to=0.0):
        """Prescribes displacements (m): `to` is a number, one a node, or a function of the load share."""
        for k, axis in enumerate(axes):
            for row, node in enumerate(nodes):
                self.prescribed[3 * int(node) + "xyz".index(axis)] = (to, row, k)

    def body_force(self, density_times_acceleration):
        """Adds a force per volume (N/m³)."""
        load = fem.SolidBodyForce(self.field, values=density_times_acceleration)
        self.force += load.assemble.vector().toarray().ravel()

    def traction(self, nodes, traction):
        """Adds a dead load (Pa) on the faces whose nodes are all given."""
        mask = np.zeros(len(self.mesh.points), bool)
        mask[nodes] = True
        region = fem.RegionTriQuadraticHexahedronBoundary(self.mesh, mask=mask)
        field = fem.FieldContainer([fem.Field(region, dim=3)])
        values = np.asarray(traction, float).reshape(3, 1, 1) * np.ones((3, *region.dV.shape))
        load = fem.IntegralForm([values], v=field, dV=region.dV, grad_v=[False]).assemble().toarray().ravel()
        self.force[: len(load)] += load

    def internal(self):
        return self.solid.assemble.vector(self.field).toarray().ravel()

    def energy(self, shear, bulk):
        """Strain energy (J) of the neo-Hookean law, the volumetric part by the dilatation where that is a field."""
        kinematics = self.field.extract()
        gradient, volume = kinematics[0], np.linalg.det(kinematics[0].transpose(2, 3, 0, 1))
        isochoric = shear / 2 * (volume ** (-2 / 3) * (gradient**2).sum(axis=(0, 1)) - 3)
        dilatation = kinematics[2][0] if len(kinematics) > 2 else volume
        return float(((isochoric + bulk / 2 * (dilatation - 1) ** 2) * self.region.dV).sum())

    def reaction(self, nodes):
        """The force (N) that holds nodes."""
        rest = (self.internal() - self.share * self.force)[: 3 * len(self.mesh.points)].reshape(-1, 3)
        return rest[nodes].sum(axis=0)

    def solve(self, shares=(1,), tolerance=1e-9, most=25):
        """Follows the load over `shares` (of 0 to 1) by Newton's method; halves a step that does not converge.

        After `start_from` the load is there at once, and what it lacks to be in balance is taken away instead.
        """
        fixed = np.array(sorted(self.prescribed), int)
        free = np.setdiff1d(np.arange(self.size), fixed)
        queue = [1] if self.started else list(shares)
        if self.started:
            self.displacement.ravel()[fixed] = [self._target(dof, 1) for dof in fixed]
        self.lacking = self.internal() - self.force if self.started else None
        states = [(self.share, self._state())]
        while queue:
            share = queue[0]
            if len(states) > 1:
                # predicted by going on as before
                (s0, old), (s1, new) = states[-2:]
                self._set(new + (new - old) * (share - s1) / (s1 - s0))
            step = np.zeros(self.size)
            step[fixed] = [self._target(dof, 1 if self.started else share) - self.displacement.ravel()[dof] for dof in fixed]
            # on the way the states need not be exact
            if self._newton(share, step, fixed, free, tolerance if share == 1 else 1e-4, most):
                self.share = share
                queue.pop(0)
                states.append((share, self._state()))
            else:
                self._set(states[-1][1])
                if self.started and share - self.share < 0.1:
                    # the coarse solution is no help here: from rest, then
                    self.started, self.share = False, 0.0
                    self._set(self.rest)
                    return self.solve(shares, tolerance, most)
                if share - self.share < 1e-4:
                    raise RuntimeError(f"no equilibrium beyond {self.share} of the load")
                queue.insert(0, 0.5 * (self.share + share))
        return self

    def _state(self):
        return np.concatenate([f.values.ravel() for f in self.field])

    def _set(self, state):
        offset = 0
        for f in self.field:
            f.values[:] = state[offset : offset + f.values.size].reshape(f.values.shape)
            offset += f.values.size

    def _target(self, dof, share):
        to, row, k = self.prescribed[dof]
        to = to(share) if callable(to) else np.asarray(to) * share
        return float(to if np.ndim(to) == 0 else to[row, k] if np.ndim(to) == 2 else to[k])

    def _newton(self, share, step, fixed, free, tolerance, most):
        load = self.force + (1 - share) * self.lacking if self.started else share * self.force
        for turn in range(most):
            stiffness = self.solid.assemble.matrix(self.field).tocsr()
            residual = load - self.internal()
            right = (residual - stiffness @ step)[free]
            # with pressures the matrix is indefinite: only the unsymmetric factorisation pivots well enough
            step[free] = spsolve(stiffness[free][:, free].tocsr(), right)
            start = self._state()
            for shorter in range(5):
                # a step that turns elements inside out is too long
                self._set(start + 0.5**shorter * step)
                inner = self.internal()
                if np.isfinite(inner).all():
                    break
            step = np.zeros(self.size)
            scale = np.linalg.norm(inner[fixed]) + np.linalg.norm(load)
            norm = np.linalg.norm((load - inner)[free]) / scale
            if "TELL" in os.environ:
                print(f"    load {share:.4f}, turn {turn}: residual {norm:.1e}", flush=True)
            if not np.isfinite(norm) or turn > 5 and norm > 0.5:
                return False
            if norm < tolerance:
                return True
        return False


def neo_hookean(shear, bulk, mixed=True):
    """Ψ = μ/2 (J^(-2/3) tr C - 3) + κ/2 (J - 1)²: sinew's `neo_hookean`."""
    if mixed:
        return fem.NearlyIncompressible(fem.NeoHooke(mu=shear), bulk=bulk)
    return fem.NeoHooke(mu=shear, bulk=bulk)


def extrapolate(sizes, values):
    """The limit of three values on ever finer meshes (cell sizes relative), its uncertainty and the observed order.

    Fits value = limit + c·sizeᵖ through the three. The uncertainty is the whole of what the limit differs from the
    finest value: cautious, for orders fall where stresses have no bound. Without a clear order the finest value counts,
    and the spread of the three is its uncertainty.
    """
    (h0, h1, h2), (v0, v1, v2) = sizes, [float(v) for v in values]
    slope = lambda p: (v0 - v1) * (h1**p - h2**p) - (v1 - v2) * (h0**p - h1**p)
    low, high = 0.3, 8.0
    if (v0 - v1) * (v1 - v2) <= 0 or slope(low) * slope(high) > 0:
        return v2, max(abs(v2 - v1), abs(v1 - v0)), None
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(low) * slope(middle) > 0 else (low, middle)
    limit = v2 + (v2 - v1) * h2**low / (h1**low - h2**low)
    return limit, abs(limit - v2), low


def study(problem, levels, run, units, how):
    """Runs `run(level, coarser body or None)` on each level, prints, extrapolates the last three and records.

    `run` returns the solved body and its quantities of interest (a dict).
    """
    rows, body = [], None
    for level in levels:
        start = time.time()
        body, row = run(level, body)
        rows.append({name: float(value) for name, value in row.items()})
        shown = "  ".join(f"{name} {value:.9g}" for name, value in rows[-1].items())
        print(f"{problem} {level}: {shown}  ({time.time() - start:.0f} s)", flush=True)
    for name in rows[0] if len(rows) > 2 else []:
        limit, doubt, order = extrapolate([1 / level for level in levels[-3:]], [row[name] for row in rows[-3:]])
        told = f"order {order:.2f}" if order else "no clear order: the finest mesh"
        print(f"  {name}: {limit:.9g} ± {doubt:.2g} {units[name]} ({told})", flush=True)
        meshes = {str(level): row[name] for level, row in zip(levels, rows)}
        made = f"FElupe {fem.__version__}, 27-node hexahedra with linear pressure: {how}, extrapolated"
        record(problem, name, limit, doubt, units[name], made, {"cells": meshes, "observed_order": order})


def record(problem, quantity, value, uncertainty, unit, how, more=None):
    """Puts a reference value into docs/accuracy/references.json; checks by other codes stay."""
    REFERENCES.parent.mkdir(parents=True, exist_ok=True)
    table = json.loads(REFERENCES.read_text()) if REFERENCES.exists() else {}
    entry = table.setdefault(problem, {}).setdefault(quantity, {})
    entry.update({"value": value, "uncertainty": uncertainty, "unit": unit, "how": how, **(more or {})})
    write(table)


def record_check(problem, quantity, code, level, value):
    """Puts what another code finds on a mesh beside the reference value."""
    table = json.loads(REFERENCES.read_text())
    table[problem][quantity].setdefault("checks", {}).setdefault(code, {})[str(level)] = value
    write(table)


def write(table):
    REFERENCES.write_text(json.dumps(table, indent=2, sort_keys=True, ensure_ascii=False) + "\n")
