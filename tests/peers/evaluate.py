"""evaluate.py: figures of the wheat points from spheres, by the rules that their source used.

Angle: radial bins of one diameter, the highest sphere top of each, a line through the bins between 20 and 80 % of the
highest top; then the line is fitted again to all sphere tops within 0.75 d of it (taken along z, between the same heights).
Bulk density: mass of the spheres cut by a slab from 2 d above the floor to 2 d below the highest top, over its volume.
Rate: slope of the mass that crossed between 20 and 80 % of all that crossed.
"""
import numpy as np


def pile_angle(x, y, z, r, d):
    """Degrees. Arrays in m, axis of the pile at x = y = 0, floor at z = 0."""
    radius, top = np.hypot(x, y), z + r
    peak = top.max()
    bins = (radius / d).astype(int)
    middles, heights = [], []
    for b in np.unique(bins):
        height = top[bins == b].max()
        if 0.2 * peak <= height <= 0.8 * peak:
            middles.append((b + 0.5) * d)
            heights.append(height)
    if len(middles) < 2:
        return float("nan")
    slope, level = np.polyfit(middles, heights, 1)
    near = (np.abs(top - (level + slope * radius)) <= 0.75 * d) & (top >= 0.2 * peak) & (top <= 0.8 * peak)
    slope, level = np.polyfit(radius[near], top[near], 1)
    return float(np.degrees(np.arctan(-slope)))


def slab_density(z, r, density, low, high, area):
    """kg/m3: volume of spheres between two heights, exact, times their density, over the slab."""
    def below(height):
        h = np.clip(height - (z - r), 0, 2 * r)
        return np.pi * h * h * (r - h / 3)
    return float(density * np.sum(below(high) - below(low)) / (area * (high - low)))


def column_density(z, r, density, d, area):
    return slab_density(z, r, density, 2 * d, (z + r).max() - 2 * d, area)


def rate(time, mass, low=0.2, high=0.8):
    """kg/s."""
    end = mass[-1]
    band = (mass >= low * end) & (mass <= high * end)
    return float(np.polyfit(time[band], mass[band], 1)[0])
