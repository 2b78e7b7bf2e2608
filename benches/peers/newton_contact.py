"""Newton on Warp's CPU: its explicit solver against the table, vertex block descent with contacts between bodies. f32."""

import sys

import newton
import numpy as np
import warp as wp

from contact_cubes import GRAVITY, LAME, SHEAR, Case, measure

ITERATIONS = 20


class Body:
    explicit = False

    def __init__(self, case: Case, step):
        self.case, self.step = case, step
        builder = newton.ModelBuilder(up_axis=newton.Axis.Z, gravity=(0.0, 0.0, -GRAVITY))
        builder.add_ground_plane(cfg=newton.ModelBuilder.ShapeConfig(ke=1e2, kd=0.0, kf=0.0, mu=0.0))
        for rest in case.rest:
            builder.add_soft_mesh(
                pos=wp.vec3(0.0), rot=wp.quat_identity(), scale=1.0, vel=wp.vec3(0.0),
                vertices=[wp.vec3(*point) for point in rest], indices=case.tets.ravel().tolist(), density=1000.0,
                # moduli that are Hooke's at small strain: section 3.4 of Smith et al. 2018
                k_mu=4 / 3 * SHEAR, k_lambda=LAME + 5 / 6 * SHEAR, k_damp=0.0, particle_radius=5e-4,
            )
        builder.color()
        self.model = builder.finalize(device="cpu")
        self.model.soft_contact_ke, self.model.soft_contact_kd, self.model.soft_contact_mu = 1e2, 0.0, 0.0
        if self.explicit:
            self.model.particle_grid = None
            self.solver = newton.solvers.SolverSemiImplicit(self.model, enable_tri_contact=False)
        else:
            self.solver = newton.solvers.SolverVBD(
                self.model, iterations=ITERATIONS, particle_enable_self_contact=len(case.rest) > 1,
                particle_self_contact_radius=5e-4, particle_self_contact_margin=1e-3, particle_enable_tile_solve=False,
            )
        self.pipeline = newton.CollisionPipeline(self.model)
        self.contacts = self.pipeline.contacts()
        self.control = self.model.control()
        self.now, self.next = self.model.state(), self.model.state()

    def advance(self, steps):
        for _ in range(steps):
            self.now.clear_forces()
            self.pipeline.collide(self.now, self.contacts)
            self.solver.step(self.now, self.next, self.control, self.contacts, self.step)
            self.now, self.next = self.next, self.now

    def look(self):
        shape = self.case.rest.shape
        return tuple(a.numpy().astype(float).reshape(shape) for a in (self.now.particle_q, self.now.particle_qd))


class Explicit(Body):
    explicit = True


if __name__ == "__main__":
    wp.config.quiet = True
    wp.config.enable_backward = False
    explicit = "--explicit" in sys.argv
    if explicit:
        sys.argv.remove("--explicit")
    name, build, step = ("SolverSemiImplicit", Explicit, 1e-4) if explicit else (f"VBD, {ITERATIONS} iterations", Body, 1e-3)
    measure(f"Newton {name}", f"{newton.__version__} (Warp {wp.__version__})", build, step)
