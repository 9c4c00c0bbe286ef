"""wheat_fill.py: where the wheat of the lift and of the orifice starts. The source of the points inserts its spheres at random
places; a bed that falls from a source's lattice of Calx settles 3 % looser, so the places are part of the comparison.
"""
import itertools

import numpy as np

COUNT = 4000
RADII = np.array([0.0017, 0.00185, 0.0020])  # m
MASS_SHARES = np.array([0.25, 0.50, 0.25])
REACH, LOWEST, HIGHEST = 0.0375, 0.003, 0.085  # m: spheres lie wholly inside of this cylinder
DENSITY = 1400  # kg/m3
SPEED = 0.3  # m/s, downwards


def radii(count=COUNT):
    """One radius per sphere, m: the numbers nearest to the shares of mass, largest first."""
    numbers = MASS_SHARES / RADII**3
    numbers = np.rint(count * numbers / numbers.sum()).astype(int)
    numbers[1] += count - numbers.sum()
    return np.repeat(RADII, numbers)[::-1]


def places(sizes, seed):
    """Centres without overlaps, m, one after the other at random; a place that is taken is drawn again."""
    random = np.random.default_rng(seed)
    cell = 2 * sizes.max()
    cells, out = {}, []
    for r in sizes:
        while True:
            x, y = random.uniform(r - REACH, REACH - r, 2)
            z = random.uniform(LOWEST + r, HIGHEST - r)
            if np.hypot(x, y) > REACH - r:
                continue
            at = tuple(int(v // cell) for v in (x, y, z))
            near = (s for step in itertools.product((-1, 0, 1), repeat=3)
                    for s in cells.get((at[0] + step[0], at[1] + step[1], at[2] + step[2]), ()))
            if all((x - s[0]) ** 2 + (y - s[1]) ** 2 + (z - s[2]) ** 2 >= (r + s[3]) ** 2 for s in near):
                break
        cells.setdefault(at, []).append((x, y, z, r))
        out.append((x, y, z))
    return np.array(out)


def write_liggghts(path, seed):
    """The same places as a data file of LIGGGHTS: number, type, diameter, density, place."""
    sizes = radii()
    with open(path, "w", encoding="ascii") as out:
        out.write(f"wheat, seed {seed}\n\n{COUNT} atoms\n1 atom types\n\n-0.05 0.05 xlo xhi\n-0.05 0.05 ylo yhi\n0 0.2 zlo zhi\n\n"
                  "Atoms\n\n")
        for k, ((x, y, z), r) in enumerate(zip(places(sizes, seed).tolist(), sizes.tolist())):
            out.write(f"{k + 1} 1 {2 * r!r} {DENSITY} {x!r} {y!r} {z!r}\n")


def write(path, seed):
    """A source's CSV."""
    sizes = radii()
    with open(path, "w", encoding="ascii") as out:
        out.write("x_m,y_m,z_m,vz_m_s,scale\n")
        for (x, y, z), r in zip(places(sizes, seed).tolist(), sizes.tolist()):
            out.write(f"{x!r},{y!r},{z!r},{-SPEED!r},{r / RADII[1]!r}\n")
