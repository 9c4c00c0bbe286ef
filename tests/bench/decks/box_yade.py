"""box_yade.py: a bed in a box, timed, or bodies that collide (the gate), run by Yade. Environment: START (folder of a start),
STEPS, WARM_UP, ROLLING, and for the gate GATE=1, RESTITUTION, STEP, GRAVITY,
ON_WALL. Prints one JSON line.

Hertz-Mindlin with the dashpot of LIGGGHTS' hertz: betan = betas = sqrt(5/6) beta(e). Yade cuts the pulling part of the
dashpot off and takes the normal dashpot for shear, too; its rolling cap is eta times the mean radius."""
# Names come from Yade, which runs this file. pylint: disable=undefined-variable
import csv
import json
import math
import os
import time

env = os.environ
gate, restitution = env.get("GATE") == "1", float(env.get("RESTITUTION", "0.3"))
rolling, steps = float(env.get("ROLLING", "0")), int(env["STEPS"])
with open(env["START"] + "/case.json", encoding="ascii") as file:
    scene = json.load(file)
material = O.materials.append(FrictMat(young=1e7, poisson=0.25, density=2100, frictionAngle=math.atan(0.5)))
count = 0
with open(env["START"] + "/" + scene["sources"][0]["file"], encoding="ascii") as file:
    for row in csv.DictReader(file):
        x, v, w = ([float(row[f"{name}{axis}{unit}"]) for axis in "xyz"]
                   for name, unit in (("", "_m"), ("v", "_m_s"), ("w", "_rad_s")))
        sphere = utils.sphere(Vector3(*x), 1.25e-3 * float(row.get("scale", 1)), material=material)
        sphere.state.vel, sphere.state.angVel = Vector3(*v), Vector3(*w)
        O.bodies.append(sphere)
        count += 1
walls = [(2, 0.0, 1)]
if not gate:
    lx, ly = scene["parts"][0]["parameters"]["max"][:2]
    walls += [(0, 0.0, 1), (0, lx, -1), (1, 0.0, 1), (1, ly, -1)]
for axis, position, sense in walls:
    O.bodies.append(utils.wall(position, axis=axis, sense=sense, material=material))
damp = math.sqrt(5 / 6) * -math.log(restitution) / math.hypot(math.pi, math.log(restitution))
physics = Ip2_FrictMat_FrictMat_MindlinPhys(betan=damp, betas=damp)
if rolling > 0:
    # Cap and spring on the effective radius: half of the mean one between equal spheres, the radius itself at a wall. There
    # is one number for both: right for pairs, and in the gate, where a ball rolls on a wall, right for that.
    share = 1 if env.get("ON_WALL") == "1" else 0.5
    physics.eta, physics.krot = share * rolling, 500 * (share * 1.25e-3) ** 2
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [physics],
                             [Law2_ScGeom_MindlinPhys_Mindlin(includeMoment=rolling > 0)]),
             NewtonIntegrator(gravity=(0, 0, -float(env.get("GRAVITY", "9.81"))), damping=0.0)]
O.dt = float(env.get("STEP", scene["time"]["step"]))
if int(env.get("WARM_UP", "0")) > 0:
    O.run(int(env["WARM_UP"]), wait=True)
start = time.monotonic()
O.run(steps, wait=True)
wall = time.monotonic() - start
pairs = sum(1 for i in O.interactions if i.isReal and i.id1 < count and i.id2 < count and i.geom.penetrationDepth > 0)
found = {"yade": yade.config.version, "wall_s": wall, "coordination": 2 * pairs / count}
if gate:
    found["velocity_m_s"] = [list(O.bodies[k].state.vel) for k in range(count)]
    found["spin_rad_s"] = [list(O.bodies[k].state.angVel) for k in range(count)]
print(json.dumps(found), flush=True)
os._exit(0)  # pylint: disable=protected-access
