"""MuJoCo's deformable bodies (flex): St. Venant-Kirchhoff tetrahedra, a body of three slides a node, Euler. It has f64 only."""

import mujoco
import numpy as np

from cubes import DENSITY, EDGE, GRAVITY, POISSON, YOUNG, Cube, measure

SCENE = """
<mujoco>
  <option integrator="Euler" gravity="0 0 {gravity}">
    <flag contact="disable" constraint="disable" eulerdamp="disable" autoreset="disable" island="disable"/>
  </option>
  <worldbody>
    <flexcomp name="cube" type="direct" dim="3" mass="{mass}" radius="0.001" point="{points}" element="{tets}">
      <elasticity young="{young}" poisson="{poisson}"/>
      <contact selfcollide="none" contype="0" conaffinity="0"/>
      <pin id="{held}"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


def words(numbers):
    return " ".join(f"{number:.9g}" for number in np.ravel(numbers))


class Body:
    def __init__(self, cube: Cube, _threads):
        text = SCENE.format(
            gravity=GRAVITY,
            mass=DENSITY * EDGE**3,
            points=words(cube.points),
            tets=words(cube.tets),
            held=words(cube.held),
            young=YOUNG,
            poisson=POISSON,
        )
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        # It spreads the mass evenly over the nodes; lumped by volume, as everywhere else:
        body = self.model.flex_vertbodyid
        free = body > 0
        self.model.body_mass[body[free]] = cube.mass[free]
        mujoco.mj_setConst(self.model, self.data)

    def reset(self, step):
        self.model.opt.timestep = step
        mujoco.mj_resetData(self.model, self.data)

    def advance(self, steps):
        mujoco.mj_step(self.model, self.data, nstep=steps)

    def positions(self):
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)
        return self.data.flexvert_xpos.copy()


if __name__ == "__main__":
    # mju_threadpool makes no difference to these bodies: measured within the noise.
    measure("MuJoCo flex, Euler", mujoco.__version__, Body, "f64; its flex forces run on one thread")
