"""Newton's vertex block descent on Warp's CPU: stable neo-Hookean tetrahedra, implicit Euler. f32."""

import newton
import numpy as np
import warp as wp

from lens import LAME, SHEAR, Lens, measure


class Body:
    def __init__(self, lens: Lens, step, scheme):
        self.lens, self.step = lens, step
        builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=(0.0, 0.0, 0.0))
        builder.add_soft_mesh(
            pos=wp.vec3(0.0), rot=wp.quat_identity(), scale=1.0, vel=wp.vec3(0.0),
            vertices=[wp.vec3(*point) for point in lens.points], indices=lens.tets.ravel().tolist(), density=1000.0,
            # moduli that are Hooke's at small strain: section 3.4 of Smith et al. 2018
            k_mu=4 / 3 * SHEAR, k_lambda=LAME + 5 / 6 * SHEAR, k_damp=0.0, particle_radius=1e-5,
        )
        for node in lens.held:
            builder.particle_mass[int(node)] = 0.0
            builder.particle_flags[int(node)] = builder.particle_flags[int(node)] & ~newton.ParticleFlags.ACTIVE
        builder.color()
        self.model = builder.finalize(device="cpu")
        self.solver = newton.solvers.SolverVBD(
            self.model, iterations=int(scheme), particle_enable_self_contact=False, particle_enable_tile_solve=False
        )
        self.control = self.model.control()
        self.now, self.next = self.model.state(), self.model.state()
        self.rest = self.now.particle_q.numpy().astype(float)
        # compiles its kernels before anything is timed
        self.advance(np.zeros_like(lens.points))
        self.now, self.next = self.model.state(), self.model.state()

    def advance(self, force):
        self.now.clear_forces()
        self.now.particle_f.assign(force.astype(np.float32))
        self.solver.step(self.now, self.next, self.control, None, self.step)
        self.now, self.next = self.next, self.now

    def displacements(self):
        return self.now.particle_q.numpy().astype(float) - self.rest


if __name__ == "__main__":
    wp.config.quiet = True
    wp.config.enable_backward = False
    measure("Newton VBD", f"{newton.__version__} (Warp {wp.__version__})", Body, ["20", "100", "500"])
