"""Writes what ctest runs of one test program: each suite, as FOLDER/SUITE after its source's folder.

    python3 register_tests.py PROGRAM LIST.cmake plain|sanitized

Starting a program that links hundreds of libraries takes longer than most tests do, so that the tests of a suite share
a start. Long suites are cut in parts, FOLDER/SUITE:2 and so on, which run beside each other.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

MOST_TESTS = 12
# ctest starts the dearest first, so that no long one is left when the others are done: seconds of processor of those
# that take long, by suite (or part of it), else of their folder. Only their order matters.
COSTS = {"raytrace/Kinds/Leaks": 140, "app/Readme": 90, "app/Photometry/Tutorials": 20,
         "app/Studies/Tutorials": 15, "raytrace/Cases/Canted:2": 60, "raytrace/BeamTracer": 60,
         "sweep/CommandsByMpi": 50, "surface_models/HarveyShack": 40, "sweep/SweepByMpi": 38,
         "studies/DesignTexture": 33, "app/Inputs": 30,
         "raytrace/Cases/AgainstReference": 30, "studies/EngineChoice": 27, "calibration/Correction": 24,
         "turning/Turn": 24,
         "app/Commands/LongWork": 23, "raytrace/RoughFacets": 22, "studies/AdaptiveCurve": 22,
         "surface_models/Scatter": 20, "app/Front": 20, "raytrace/Kinds/RealArrays": 19,
         "surface_models/TextureModel": 19, "app/VerifyCommand": 18, "sweep/Cells": 18, "app/Inspect": 17,
         "image/Camera": 16, "sweep/SweepCommand": 16, "raytrace": 2, "app": 1}
# Seconds after which a suite hangs: sanitizers make them some ten times as long.
TIMEOUTS = {"plain": 1200, "sanitized": 12000}
# A fixed seed: property tests draw the same cases in every run. RC_PARAMS set by hand tries others.
PROPERTIES = 'ENVIRONMENT "RC_PARAMS=seed=1"'


def suites_of(program):
    """Folder and name of every suite, and the names of its tests."""
    with tempfile.TemporaryDirectory() as folder:
        listed = pathlib.Path(folder, "tests.json")
        subprocess.run([program, "--gtest_list_tests", f"--gtest_output=json:{listed}"], check=True, timeout=60,
                       stdout=subprocess.DEVNULL)
        suites = json.loads(listed.read_text())["testsuites"]
    return [(pathlib.Path(suite["testsuite"][0]["file"]).parent.name, suite["name"],
             [test["name"] for test in suite["testsuite"]]) for suite in suites]


def entries(program, timeout, folder, suite, tests):
    for part in range(0, len(tests), MOST_TESTS):
        name = f"{folder}/{suite}" + (f":{part // MOST_TESTS + 1}" if part else "")
        wanted = ":".join(f"{suite}.{test}" for test in tests[part:part + MOST_TESTS])
        cost = COSTS.get(name, COSTS.get(folder, 0))
        yield (f'add_test([==[{name}]==] [==[{program}]==] [==[--gtest_filter={wanted}]==])\n'
               f'set_tests_properties([==[{name}]==] PROPERTIES {PROPERTIES} TIMEOUT {timeout} COST {cost} '
               f'WORKING_DIRECTORY [==[{pathlib.Path.cwd()}]==])\n')


def main():
    program, out, build = sys.argv[1:]
    pathlib.Path(out).write_text("".join(text for suite in sorted(suites_of(program))
                                         for text in entries(program, TIMEOUTS[build], *suite)))


main()
