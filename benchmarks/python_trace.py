"""Measures the processor time of a million rays through a part on one thread. `retrace.trace`, with arrays as input and
output, is compared with `retrace rays`. The latter uses an emitter of the same light and writes the rays that leave to
a TM-25 file. Each repetition runs both, and the result is the median ratio of their times.

    PYTHONPATH=build/release/python python3 benchmarks/python_trace.py build/release/bin/retrace
"""

import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
import retrace as rt

SIDE_MM = 10.0
RAYS = 1_000_000
PAIRS = 5
DESIGN = f"""
[element]
kind = "rtp"
base_mm = 0.5
width_mm = 0.5
[array]
arrangement = "offset"
x_length_mm = {SIDE_MM}
y_length_mm = {SIDE_MM}
[body]
thickness_mm = 0.5
refractive_index = 1.4917
"""


def program_s(program, folder):
    def used():
        children = resource.getrusage(resource.RUSAGE_CHILDREN)
        return children.ru_utime + children.ru_stime

    design = folder / "bricks.toml"
    design.write_text(DESIGN)
    before = used()
    subprocess.run(
        [program, "rays", design, "--emitter", "collimated", "--rays", str(RAYS), "--disc-mm", "9", "-o",
         folder / "out.tm25ray", "--threads", "1", "--quiet"], check=True, stdout=subprocess.DEVNULL)
    return used() - before


def python_s(design):
    generator = np.random.default_rng(1)
    radius = 4.5 * np.sqrt(generator.random(RAYS))
    angle = 2.0 * np.pi * generator.random(RAYS)
    origins = np.column_stack([0.5 * SIDE_MM + radius * np.cos(angle), 0.5 * SIDE_MM + radius * np.sin(angle),
                               np.full(RAYS, 3.0)])
    directions = np.tile([0.0, 0.0, -1.0], (RAYS, 1))
    before = time.process_time()
    found = rt.trace(design, origins, directions, threads=1)
    seconds = time.process_time() - before
    return seconds, len(found)


def main():
    design = rt.Design.parse(DESIGN)
    with tempfile.TemporaryDirectory() as folder:
        pairs = []
        for _ in range(PAIRS):
            program = program_s(sys.argv[1], pathlib.Path(folder))
            python, rays = python_s(design)
            pairs.append((python, program))
            print(f"Python {python:.2f} s, program {program:.2f} s, {rays} rays leave")
    print(f"Python over program: {statistics.median(a / b for a, b in pairs):.2f}")


if __name__ == "__main__":
    main()
