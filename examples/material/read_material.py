"""Reads a table that `retrace export DESIGN material.json` writes, with nothing but Python's own modules.

    python3 read_material.py material.json ALPHA GAMMA BETA OMEGA

prints R_A in cd/(lx m2) of linear red, green and blue for an observation, presentation, entrance and orientation angle
in degrees (docs/theory/appearance.md); without angles it reads them from lines of standard input.
"""

import csv, json, sys
from math import asin, atan2, cos, degrees, hypot, radians, sin, tan
from pathlib import Path


def read(file):
    table = json.loads(Path(file).read_text())
    with open(Path(file).with_name(table["values"])) as lines:
        rows = [[float(band) for band in row[3:]] for row in list(csv.reader(lines))[1:]]
    grid = table["columns"] ** 2
    return table | {"r_a": [rows[k : k + grid] for k in range(0, len(rows), grid)]}


def cubic(x):  # weights of the values at 0, 1, 2 and 3
    return [(x - 1) * (x - 2) * (x - 3) / -6, x * (x - 2) * (x - 3) / 2, x * (x - 1) * (x - 3) / -2, x * (x - 1) * (x - 2) / 6]


def r_a(table, source, observer):  # unit vectors of the part frame; None outside the table
    signs = [-1 if table["mirror_" + axis] and source[k] < 0 else 1 for k, axis in enumerate("xy")]
    x, y = (signs[k] * source[k] for k in (0, 1))
    n, half = table["columns"], table["half_width"]
    place = [(signs[k] * (observer[k] - source[k]) + half) * (n - 1) / (2 * half) for k in (0, 1)]
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


def directions(alpha, gamma, beta, omega):  # of CIE 54.2, in degrees: to the source and to the observer
    alpha, gamma, beta, omega = map(radians, (alpha, gamma, beta, omega))
    beta1, beta2 = atan2(sin(beta) * cos(gamma), cos(beta)), asin(sin(beta) * sin(gamma))
    epsilon = omega - radians(90) + atan2(sin(beta1), cos(beta1) * sin(beta2))

    def in_part(v):  # by the transpose of R_x(-beta1) R_y(beta2) R_z(epsilon)
        x, y, z = v[0], v[1] * cos(beta1) - v[2] * sin(beta1), v[1] * sin(beta1) + v[2] * cos(beta1)
        x, z = x * cos(beta2) - z * sin(beta2), x * sin(beta2) + z * cos(beta2)
        return x * cos(epsilon) + y * sin(epsilon), -x * sin(epsilon) + y * cos(epsilon), z

    return in_part((0, 0, 1)), in_part((0, sin(alpha), cos(alpha)))


if __name__ == "__main__":
    table = read(sys.argv[1])
    for line in [" ".join(sys.argv[2:])] if len(sys.argv) > 2 else sys.stdin:
        print(*r_a(table, *directions(*map(float, line.split()))) or ("outside the table",))
