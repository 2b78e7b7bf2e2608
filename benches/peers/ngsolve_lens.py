"""NGSolve: the same neo-Hookean law by its energy, implicit Euler, Newton's iterations with a sparse Cholesky factor
each. f64, masses consistent."""

import ngsolve as ngs
import numpy as np
from netgen.meshing import Element2D, Element3D, FaceDescriptor, Mesh, MeshPoint, Pnt

from lens import BULK, DENSITY, SHEAR, Lens, measure

TOLERANCE = 1e-3  # of the work of the first residual's step


def volume_mesh(lens):
    """All of its surface is boundary 1; held nodes are told by a mask."""
    mesh = Mesh(dim=3)
    points = [mesh.Add(MeshPoint(Pnt(*point))) for point in lens.points]
    mesh.Add(FaceDescriptor(bc=1, domin=1, domout=0))
    faces = lens.tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, 1), axis=0, return_index=True, return_counts=True)
    for face in faces[first[count == 1]]:
        mesh.Add(Element2D(1, [points[node] for node in face]))
    for tet in lens.tets:
        mesh.Add(Element3D(1, [points[node] for node in tet]))
    return ngs.Mesh(mesh)


class Body:
    def __init__(self, lens: Lens, step, scheme):
        self.step = step
        mesh = volume_mesh(lens)
        space = ngs.VectorH1(mesh, order=1)
        u = space.TrialFunction()
        gradient = ngs.Id(3) + ngs.Grad(u)
        j = ngs.Det(gradient)
        stretch = ngs.Trace(gradient.trans * gradient)
        energy = SHEAR / 2 * (j ** (-2 / 3) * stretch - 3) + BULK / 2 * (j - 1) ** 2
        self.u, self.before, self.velocity = (ngs.GridFunction(space) for _ in range(3))
        inertia = DENSITY / (2 * step**2) * ngs.InnerProduct(u - self.before, u - self.before)
        inertia -= DENSITY / step * ngs.InnerProduct(self.velocity, u)
        self.form = ngs.BilinearForm(space, symmetric=True)
        self.form += ngs.Variation((energy + inertia).Compile() * ngs.dx)
        free = ngs.BitArray(space.ndof)
        free.Set()
        count = len(lens.points)
        # components one after the other, vertices in the order of the points
        self.places = lambda component: slice(component * count, (component + 1) * count)
        assert space.ndof == 3 * count
        for node in lens.held:
            for component in range(3):
                free.Clear(component * count + int(node))
        self.free = free
        self.loads, self.residual, self.way = (self.u.vec.CreateVector() for _ in range(3))

    def advance(self, force):
        u = self.u.vec
        self.before.vec.data = u
        for component in range(3):
            self.loads.FV().NumPy()[self.places(component)] = force[:, component]
        first = None
        for _ in range(20):
            self.form.Apply(u, self.residual)
            self.residual.data -= self.loads
            self.form.AssembleLinearization(u)
            self.way.data = self.form.mat.Inverse(self.free, inverse="sparsecholesky") * self.residual
            work = abs(ngs.InnerProduct(self.way, self.residual))
            u.data -= self.way
            first = work if first is None else first
            if work <= TOLERANCE**2 * first:
                break
        self.velocity.vec.data = 1 / self.step * (u - self.before.vec)

    def displacements(self):
        return np.stack([self.u.vec.FV().NumPy()[self.places(component)] for component in range(3)], 1)


if __name__ == "__main__":
    with ngs.TaskManager():
        measure("NGSolve", ngs.__version__, Body, ["implicit Euler, Newton"])
