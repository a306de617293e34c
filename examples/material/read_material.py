"""Reads a table that `retrace export DESIGN material.json` writes (docs/theory/appearance.md). Requires no packages."""
import csv, json
from math import atan2, degrees, hypot
from pathlib import Path


def read(file):
    table = json.loads(Path(file).read_text())
    with open(Path(file).with_name(table["values"])) as lines:
        rows = [[float(band) for band in row[3:]] for row in list(csv.reader(lines))[1:]]
    grid = table["columns"] ** 2
    return table | {"r_a": [rows[k : k + grid] for k in range(0, len(rows), grid)]}


def cubic(x):  # weights of the values at 0, 1, 2 and 3 (Lagrange interpolation)
    return [(x - 1) * (x - 2) * (x - 3) / -6, x * (x - 2) * (x - 3) / 2, x * (x - 1) * (x - 3) / -2, x * (x - 1) * (x - 2) / 6]


def r_a(table, source, observer):  # source, observer: unit vectors in the part frame; returns None outside the table
    signs = [-1 if table["mirror_" + axis] and source[k] < 0 else 1 for k, axis in enumerate("xy")]
    x, y = (signs[k] * source[k] for k in (0, 1))
    n, half = table["columns"], table["half_width"]
    place = [(signs[k] * (observer[k] - table["back"][k] * source[k]) + half) * (n - 1) / (2 * half) for k in (0, 1)]
    first = [min(max(int(p) - 1, 0), n - 4) for p in place]
    entrance, azimuth = degrees(atan2(hypot(x, y), source[2])), degrees(atan2(y, x))
    for cell in table["cells"]:
        (e0, e1), (a0, a1) = cell["entrance_deg"], cell["azimuth_deg"]
        for turn in (azimuth, azimuth + 360):
            if e0 - 1e-6 <= entrance <= e1 + 1e-6 and a0 - 1e-6 <= turn <= a1 + 1e-6 and all(0 <= p <= n - 1 for p in place):
                along, around = cubic(3 * (entrance - e0) / (e1 - e0)), cubic(3 * (turn - a0) / (a1 - a0))
                right, up = (cubic(place[k] - first[k]) for k in (0, 1))
                return [sum(around[k // 4] * along[k % 4] * up[j] * right[i] * table["r_a"][light][(first[1] + j) * n + first[0] + i][band]
                            for k, light in enumerate(cell["directions"]) for j in range(4) for i in range(4)) for band in range(3)]
