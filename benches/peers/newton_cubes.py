"""Newton's explicit solver (SolverSemiImplicit on Warp's CPU): stable neo-Hookean (Smith et al. 2018), no contacts, f32."""

import newton
import numpy as np
import warp as wp

from cubes import GRAVITY, LAME, SHEAR, Cube, measure


class Body:
    def __init__(self, cube: Cube, _threads):
        builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=(0.0, 0.0, GRAVITY))
        mass = cube.mass.copy()
        mass[cube.held] = 0  # Newton's way to hold a particle
        count = len(mass)
        builder.add_particles(cube.points.tolist(), [(0.0, 0.0, 0.0)] * count, mass.tolist(), [0.001] * count)
        # Their moduli that are Hooke's at small strain: section 3.4 of Smith et al.
        for tet in cube.tets.tolist():
            builder.add_tetrahedron(*tet, 4 / 3 * SHEAR, LAME + 5 / 6 * SHEAR, 0.0)
        self.model = builder.finalize(device="cpu")
        self.model.particle_grid = None  # no contacts between particles
        self.solver = newton.solvers.SolverSemiImplicit(self.model, enable_tri_contact=False)
        self.control = self.model.control()
        self.states = self.model.state(), self.model.state()
        self.rest = cube.points.astype(np.float32)

    def two_steps(self):
        one, other = self.states
        for state, following in ((one, other), (other, one)):
            state.clear_forces()
            self.solver.step(state, following, self.control, None, self.step)

    def reset(self, step):
        self.step = step
        self.two_steps()  # compiles before it is recorded
        with wp.ScopedCapture(device="cpu") as recorded:  # replayed without Python between the kernels
            self.two_steps()
        self.graph = recorded.graph
        for state in self.states:
            state.particle_q.assign(self.rest)
            state.particle_qd.zero_()

    def advance(self, steps):
        assert steps % 2 == 0, "two steps are recorded together: one state into the other and back"
        for _ in range(steps // 2):
            wp.capture_launch(self.graph)

    def positions(self):
        return self.states[0].particle_q.numpy()


if __name__ == "__main__":
    wp.config.quiet = True
    wp.config.enable_backward = False
    measure("Newton SolverSemiImplicit", f"{newton.__version__} (Warp {wp.__version__})", Body, "Warp runs on one CPU thread")
