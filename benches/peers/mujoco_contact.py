"""MuJoCo's flex against a plane and each other: St. Venant-Kirchhoff tetrahedra, contacts as soft constraints. f64."""

import sys

import mujoco
import numpy as np

from contact_cubes import GRAVITY, POISSON, YOUNG, Case, measure

SCENE = """
<mujoco>
  <option integrator="{integrator}" gravity="0 0 -{gravity}" timestep="{step}" solver="CG" tolerance="1e-8" cone="elliptic">
    <flag eulerdamp="disable"/>
  </option>
  <size memory="2G"/>
  <worldbody>
    <geom type="plane" size="1 1 .01" condim="1" friction="0 0 0"/>
    {cubes}
  </worldbody>
</mujoco>
"""
CUBE = """
    <flexcomp name="cube{i}" type="direct" dim="3" mass="{mass}" radius="{radius}" point="{points}" element="{tets}">
      <elasticity young="{young}" poisson="{poisson}"/>
      <contact selfcollide="none" condim="1" friction="0 0 0" solref="{solref}" solimp="0.99 0.999 0.0001"/>
    </flexcomp>
"""
RADIUS = 1e-5  # m: flexes have a skin


def words(numbers):
    return " ".join(f"{number:.9g}" for number in np.ravel(numbers))


class Body:
    integrator = "Euler"

    def __init__(self, case: Case, step):
        self.case = case
        cube = lambda i: CUBE.format(
            i=i, mass=case.mass.sum(), radius=RADIUS, points=words(case.rest[i]), tets=words(case.tets),
            young=YOUNG, poisson=POISSON, solref=f"{max(2 * step, 1e-3)} 1",
        )
        cubes = "".join(cube(i) for i in range(len(case.rest)))
        text = SCENE.format(integrator=self.integrator, gravity=GRAVITY, step=step, cubes=cubes)
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        # it spreads the mass evenly over the nodes; lumped by volume, as everywhere else
        self.model.body_mass[self.model.flex_vertbodyid] = np.tile(case.mass, len(case.rest))
        mujoco.mj_setConst(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)

    def advance(self, steps):
        mujoco.mj_step(self.model, self.data, nstep=steps)

    def look(self):
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_flex(self.model, self.data)
        shape = self.case.rest.shape
        # three slides a node, in the order of the nodes
        return self.data.flexvert_xpos.reshape(shape).copy(), self.data.qvel.reshape(shape).copy()


class Discrete(Body):
    integrator = "discrete"


if __name__ == "__main__":
    discrete = "--discrete" in sys.argv
    if discrete:
        sys.argv.remove("--discrete")
    name, build, step = ("discrete", Discrete, 1e-3) if discrete else ("Euler", Body, 2e-4)
    measure(f"MuJoCo flex, {name}", mujoco.__version__, build, step)
