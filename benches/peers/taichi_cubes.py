"""Explicit neo-Hookean tetrahedra in Taichi on the CPU, f32: our own program in their framework, the usual way it is written there.

Forces element by element with atomic sums onto the nodes, then symplectic Euler node by node. The law has no power and no
logarithm, so that it costs less than the engine's: P = mu (F - cof F / J) + lambda (J - 1) cof F.
"""

import numpy as np
import taichi as ti

from cubes import GRAVITY, LAME, SHEAR, Cube, measure


@ti.data_oriented
class Body:
    def __init__(self, cube: Cube, threads):
        ti.init(arch=ti.cpu, cpu_max_num_threads=threads, default_fp=ti.f32, fast_math=True, offline_cache=False, log_level=ti.ERROR)
        nodes, tets = len(cube.points), len(cube.tets)
        self.rest = cube.points.astype(np.float32)
        edges = np.swapaxes(cube.points[cube.tets[:, 1:]] - cube.points[cube.tets[:, :1]], 1, 2)
        self.x, self.v, self.f = (ti.Vector.field(3, ti.f32, nodes) for _ in range(3))
        self.inverse_mass = ti.field(ti.f32, nodes)  # 0 where held
        self.tets = ti.Vector.field(4, ti.i32, tets)
        self.inverse = ti.Matrix.field(3, 3, ti.f32, tets)
        self.volume = ti.field(ti.f32, tets)
        inverse_mass = 1 / cube.mass
        inverse_mass[cube.held] = 0
        self.inverse_mass.from_numpy(inverse_mass.astype(np.float32))
        self.tets.from_numpy(cube.tets)
        self.inverse.from_numpy(np.linalg.inv(edges).astype(np.float32))
        self.volume.from_numpy((np.linalg.det(edges) / 6).astype(np.float32))

    @ti.kernel
    def one_step(self, step: ti.f32):
        for e in self.tets:
            tet = self.tets[e]
            a = self.x[tet[0]]
            edges = ti.Matrix.cols([self.x[tet[1]] - a, self.x[tet[2]] - a, self.x[tet[3]] - a])
            inverse = self.inverse[e]
            f = edges @ inverse
            c0, c1, c2 = f[:, 0], f[:, 1], f[:, 2]
            cofactor = ti.Matrix.cols([c1.cross(c2), c2.cross(c0), c0.cross(c1)])
            j = c0.dot(cofactor[:, 0])
            stress = SHEAR * f + (LAME * (j - 1) - SHEAR / j) * cofactor
            force = -self.volume[e] * stress @ inverse.transpose()
            self.f[tet[1]] += force[:, 0]
            self.f[tet[2]] += force[:, 1]
            self.f[tet[3]] += force[:, 2]
            self.f[tet[0]] -= force[:, 0] + force[:, 1] + force[:, 2]
        for n in self.x:
            if self.inverse_mass[n] > 0:
                self.v[n] += step * (self.f[n] * self.inverse_mass[n] + ti.Vector([0.0, 0.0, GRAVITY]))
                self.x[n] += step * self.v[n]
            self.f[n] = ti.Vector([0.0, 0.0, 0.0])

    def reset(self, step):
        self.step = step
        self.x.from_numpy(self.rest)
        self.v.fill(0)
        self.f.fill(0)

    def advance(self, steps):
        for _ in range(steps):
            self.one_step(self.step)
        ti.sync()

    def positions(self):
        return self.x.to_numpy()


if __name__ == "__main__":
    measure("Taichi, our program", ".".join(map(str, ti.__version__)), Body, threads=None)
