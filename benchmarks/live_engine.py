"""Measures the time in ms that the live page's engine takes for its requests. The bundle under Node.js is compared with
the native program. The difference is the cost of running the engine in a browser.

    python3 benchmarks/live_engine.py build/release/bin/retrace_live
"""

import json
import pathlib
import statistics
import subprocess
import sys
import time

SOURCE = pathlib.Path(__file__).resolve().parent.parent
DIRECTIONS = [(5.0 + 7.0 * k, 11.0 * k) for k in range(8)]


class Engine:
    def __init__(self, *command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def timed(self, **request):
        start = time.perf_counter()
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline())
        assert answer["ok"], answer
        return answer, 1000.0 * (time.perf_counter() - start)


def median_ms(engine, design, ask, **request):
    times = [engine.timed(ask=ask, design=design, incidence_deg=t, azimuth_deg=p, **request)[1] for t, p in DIRECTIONS]
    return f"{statistics.median(times):.1f} ({min(times):.1f} to {max(times):.1f})"


def main():
    engines = {"native": Engine(sys.argv[1]),
               "bundle": Engine("node", SOURCE / "tests/live/bundle.cjs", SOURCE / "data/live_page")}
    for kind in ("rtp", "hexagonal_icc", "triangular_icc"):
        for name, engine in engines.items():
            toml = engine.timed(ask="template", kind=kind, extent="infinite")[0]["toml"]
            design = engine.timed(ask="open", toml=toml, source="design.toml")[0]["design"]
            engine.timed(ask="part", design=design)
            times = [engine.timed(ask="set", design=design, changes={"body.thickness_mm": 1 + k / 100})[1] for k in range(20)]
            print(f"{kind} {name}: a change {statistics.median(times):.1f} ms; part {median_ms(engine, design, 'part')}; "
                  f"path {median_ms(engine, design, 'path', at_mm=[0.3, 0.2])}")
            for error in (1e-3, 1e-4, 1e-5, 1e-6):
                print(f"  direction to {error:g}: {median_ms(engine, design, 'direction', target_error=error)} ms")
            curve = [[t, 0.0] for t in range(-60, 61, 3)]
            for error in (1e-3, 1e-4):
                _, ms = engine.timed(ask="rre", design=design, directions=curve, target_error=error)
                print(f"  curve of {len(curve)} to {error:g}: {ms:.0f} ms")
    packed = (SOURCE / "data/live_page/engine.wasm.gz").stat().st_size
    print(f"engine.wasm.gz {packed} bytes, engine.js {(SOURCE / 'data/live_page/engine.js').stat().st_size}")


main()
