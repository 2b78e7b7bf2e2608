"""MuJoCo's flex: St. Venant-Kirchhoff tetrahedra, a body of three slides a node. It has f64 only."""

import mujoco

from lens import POISSON, YOUNG, Lens, measure
from mujoco_cubes import words

SCENE = """
<mujoco>
  <option integrator="{integrator}" gravity="0 0 0" timestep="{step}">
    <flag contact="disable" constraint="disable" eulerdamp="disable" autoreset="disable" island="disable"/>
  </option>
  <size memory="1G"/>
  <worldbody>
    <flexcomp name="lens" type="direct" dim="3" mass="{mass}" radius="1e-5" point="{points}" element="{tets}">
      <elasticity young="{young}" poisson="{poisson}"/>
      <contact selfcollide="none" contype="0" conaffinity="0"/>
      <pin id="{held}"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


class Body:
    def __init__(self, lens: Lens, step, scheme):
        self.lens = lens
        text = SCENE.format(
            integrator=scheme, step=step, mass=lens.mass.sum(), points=words(lens.points), tets=words(lens.tets),
            young=YOUNG, poisson=POISSON, held=words(lens.held),
        )
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        body = self.model.flex_vertbodyid
        self.free = body > 0
        # it spreads the mass evenly over the nodes; lumped by volume, as everywhere else
        self.model.body_mass[body[self.free]] = lens.mass[self.free]
        mujoco.mj_setConst(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)

    def advance(self, force):
        # three slides a free node, in the order of the nodes
        self.data.qfrc_applied[:] = force[self.free].ravel()
        mujoco.mj_step(self.model, self.data)

    def displacements(self):
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)
        return self.data.flexvert_xpos - self.lens.points


if __name__ == "__main__":
    measure("MuJoCo flex", mujoco.__version__, Body, ["discrete"])
