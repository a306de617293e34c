"""Prints R_A in cd/(lx m2) for linear red, green and blue.

    python3 print_r_a.py material.json ALPHA GAMMA BETA OMEGA

material.json is a table that `retrace export DESIGN material.json` writes. The angles are in degrees: observation,
presentation, entrance and orientation angle. Without angles, they are read from the lines of standard input.
"""

import sys
from math import asin, atan2, cos, radians, sin

from read_material import r_a, read


def directions(alpha, gamma, beta, omega):  # unit vectors to the source and to the observer (CIE 54.2), from degrees
    alpha, gamma, beta, omega = map(radians, (alpha, gamma, beta, omega))
    beta1, beta2 = atan2(sin(beta) * cos(gamma), cos(beta)), asin(sin(beta) * sin(gamma))
    epsilon = omega - radians(90) + atan2(sin(beta1), cos(beta1) * sin(beta2))

    def in_part(v):  # multiplies by the transpose of R_x(-beta1) R_y(beta2) R_z(epsilon)
        x, y, z = v[0], v[1] * cos(beta1) - v[2] * sin(beta1), v[1] * sin(beta1) + v[2] * cos(beta1)
        x, z = x * cos(beta2) - z * sin(beta2), x * sin(beta2) + z * cos(beta2)
        return x * cos(epsilon) + y * sin(epsilon), -x * sin(epsilon) + y * cos(epsilon), z

    return in_part((0, 0, 1)), in_part((0, sin(alpha), cos(alpha)))


if __name__ == "__main__":
    table = read(sys.argv[1])
    for line in [" ".join(sys.argv[2:])] if len(sys.argv) > 2 else sys.stdin:
        print(*r_a(table, *directions(*map(float, line.split()))) or ("outside the table",))
