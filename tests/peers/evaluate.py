"""evaluate.py: figures of the wheat points from spheres, by the rules that their source used (its calibration/measure.py at
95f50e60, which the points' description shortens).

Angle: grains that rest, about the axis of their mass; radial bins of one diameter, in each the highest top that three others
follow within 1.5 d; a line through the bins between 20 and 80 % of the highest, without those off by 2.5 sd; then three times
a line through all tops within 0.75 d of the line, between the same heights of the line. Piles lower than 4 d take the bins
between 20 and 80 % of the radius instead.
Bulk density: mass of the spheres whose centres lie from 2 d above the floor to 2 d below the height of the bed, which is the
99th percentile of the tops, over that volume. In a bed of 10 d it comes out 0.5 to 1 % above the mass that the planes cut.
Rate: slope of the mass that crossed between 20 and 80 % of all that crossed until the run ended.
"""
import numpy as np


def axis_of(x, y, r):
    weight = r**3 / np.sum(r**3)
    return np.sum(x * weight), np.sum(y * weight)


def surface(tops, d):
    """The highest top with three others, or all others of a small bin, within 1.5 d below it."""
    tops = np.sort(tops)[::-1]
    needed = min(3, len(tops) - 1)
    held = [top for k, top in enumerate(tops) if np.sum(tops[k + 1:] > top - 1.5 * d) >= needed]
    return held[0] if held else np.median(tops)


def pile_angle(x, y, z, r, d=None):
    """Degrees. Arrays in m, floor at z = 0; d: the median diameter unless it is given."""
    d = 2 * np.median(r) if d is None else d
    at = axis_of(x, y, r)
    radius, top = np.hypot(x - at[0], y - at[1]), z + r
    bins = (radius / d).astype(int)
    filled = [b for b in np.unique(bins) if np.sum(bins == b) >= 4]
    middles = (np.array(filled) + 0.5) * d
    heights = np.array([surface(top[bins == b], d) for b in filled])
    peak, reach = heights.max(), np.quantile(middles, 0.95)
    flat = peak < 4 * d
    low, high = (0.2 * reach, 0.8 * reach) if flat else (0.2 * peak, 0.8 * peak)
    along = middles if flat else heights
    used = (along >= low) & (along <= high)
    if used.sum() < 2:
        return float("nan")
    middles, heights = middles[used], heights[used]
    slope, level = np.polyfit(middles, heights, 1)
    off = np.abs(heights - level - slope * middles)
    kept = off <= 2.5 * np.std(heights - level - slope * middles)
    if 2 <= kept.sum() < len(kept):
        slope, level = np.polyfit(middles[kept], heights[kept], 1)
    low = low if flat else 0.2 * max(peak, level)
    for _ in range(3):
        line = level + slope * radius
        along = radius if flat else line
        near = (along >= low) & (along <= high) & (np.abs(top - line) <= 0.75 * d)
        if near.sum() < 10:
            break
        slope, level = np.polyfit(radius[near], top[near], 1)
    return float(np.degrees(np.arctan(-slope)))


def column_density(z, r, density, area):
    """kg/m3."""
    d, height = 2 * np.median(r), np.quantile(z + r, 0.99)
    low, high = 2 * d, height - 2 * d
    inside = (z >= low) & (z <= high)
    return float(density * np.sum(4 / 3 * np.pi * r[inside] ** 3) / (area * (high - low)))


def rate(time, mass, low=0.2, high=0.8):
    """kg/s."""
    end = mass[-1]
    band = (mass >= low * end) & (mass <= high * end)
    return float(np.polyfit(time[band], mass[band], 1)[0])
