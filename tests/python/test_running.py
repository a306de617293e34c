"""Tests of progress, Ctrl-C, threads, processes, memory and run times."""

import concurrent.futures
import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import program
import retrace as rt
from retrace import _core

PRISM = program.example("rtp_single_0p45mm.toml")
HONEYCOMB = program.example("honeycomb_infinite.toml")
LONG = {"engine": "montecarlo", "samples": 2**34}


def traced(design, seed=1):
    return program.same(
        rt.rre(design, incidence_deg=[0, 20], engine="montecarlo", samples=2048, seed=seed).json
    )


def python(code, *arguments):
    return subprocess.run(
        [sys.executable, "-c", code, *arguments], capture_output=True, text=True, timeout=120
    )


def resident_mib():
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


class Progress(unittest.TestCase):
    def test_callback(self):
        told = []
        rt.rre(
            HONEYCOMB,
            incidence_deg=range(-40, 41, 4),
            engine="montecarlo",
            samples=2**16,
            progress=told.append,
        )
        self.assertEqual(told, sorted(told))
        self.assertEqual(told[-1], 1)
        self.assertTrue(all(0 <= share <= 1 for share in told))

    def test_what_a_callback_raises_ends_the_work(self):
        def stop(share):
            raise LookupError("enough")

        begin = time.monotonic()
        with self.assertRaises(LookupError) as raised:
            rt.rre(HONEYCOMB, **LONG, progress=stop)
        self.assertEqual(raised.exception.args, ("enough",))
        self.assertLess(time.monotonic() - begin, 2)

    def test_bar(self):
        keywords = "engine='montecarlo', samples=2**20, progress=True"
        code = f"import retrace as rt; rt.rre({HONEYCOMB!r}, {keywords})"
        ended = python(code)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        without_tqdm = python(
            "import sys; sys.modules['tqdm'] = sys.modules['tqdm.auto'] = None; " + code
        )
        self.assertEqual((without_tqdm.returncode, without_tqdm.stderr), (0, ""))


class Interrupt(unittest.TestCase):
    def test_ctrl_c_ends_it_within_a_second(self):
        code = (
            "import retrace as rt, sys, time\n"
            "print('begun', flush=True)\n"
            "try: rt.rre(sys.argv[1], engine='montecarlo', samples=2**34)\n"
            "except KeyboardInterrupt: print('interrupted', time.monotonic())\n"
            "print(rt.rre(sys.argv[1], engine='montecarlo', samples=64).rre.size)\n"
        )
        child = subprocess.Popen(
            [sys.executable, "-c", code, HONEYCOMB], stdout=subprocess.PIPE, text=True
        )
        self.addCleanup(child.stdout.close)
        self.assertEqual(child.stdout.readline(), "begun\n")
        time.sleep(1)
        child.send_signal(signal.SIGINT)
        sent = time.monotonic()
        word, when = child.stdout.readline().split()
        self.assertEqual(word, "interrupted")
        self.assertLess(float(when) - sent, 1)
        self.assertEqual(child.stdout.readline(), "1\n")  # the next call works
        self.assertEqual(child.wait(timeout=10), 0)


class Threads(unittest.TestCase):
    def test_two_at_once_give_what_one_after_the_other_gives(self):
        expected = [traced(PRISM, 1), traced(HONEYCOMB, 2)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for _ in range(5):
                found = list(pool.map(traced, (PRISM, HONEYCOMB), (1, 2)))
                self.assertEqual(found, expected)

    def test_number_of_threads_changes_nothing(self):
        one, three = (
            rt.rre(HONEYCOMB, engine="montecarlo", samples=4096, threads=n) for n in (1, 3)
        )
        self.assertEqual(program.same(one.json), program.same(three.json))

    def test_others_run_meanwhile(self):
        turns = 0
        computing = threading.Thread(
            target=rt.rre, args=(HONEYCOMB,), kwargs={"engine": "montecarlo", "samples": 2**22}
        )
        computing.start()
        while computing.is_alive():
            turns += 1
            time.sleep(0.001)
        computing.join()
        self.assertGreater(turns, 20)


class Processes(unittest.TestCase):
    def test_spawn_and_forkserver(self):
        designs = [rt.Design.load(PRISM), rt.Design.load(PRISM, {"element.base_mm": 0.6})]
        expected = [traced(design) for design in designs]
        for method in ("spawn", "forkserver"):
            with self.subTest(method=method):
                with multiprocessing.get_context(method).Pool(2) as pool:
                    self.assertEqual(pool.map(traced, designs), expected)

    def test_fork_before_works(self):
        code = (
            "import multiprocessing, retrace as rt, sys\n"
            "def rre(file): return rt.rre(file).rre.tolist()\n"
            "with multiprocessing.get_context('fork').Pool(2) as pool:\n"
            "    print(pool.map(rre, [sys.argv[1]] * 2))\n"
        )
        ended = python(code, PRISM)
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(ended.stdout.strip(), str([rt.rre(PRISM).rre.tolist()] * 2))

    def test_work_after_a_fork_is_refused(self):
        """A forked process refuses work, because it lacks the threads of its parent."""
        rt.rre(PRISM)
        with multiprocessing.get_context("fork").Pool(1) as pool:
            with self.assertRaises(rt.Error) as refused:
                pool.apply_async(traced, (PRISM,)).get(timeout=60)
        self.assertIs(type(refused.exception), rt.Error)


class Costs(unittest.TestCase):
    def test_designs_in_a_loop_leak_nothing(self):
        def loop(count):
            for k in range(count):
                design = rt.Design.load(PRISM, {"element.base_mm": 0.4 + 0.001 * k})
                rt.rre(design, incidence_deg=[0, 10])
                rt.mesh(design)
            gc.collect()

        loop(200)
        before = resident_mib()
        loop(200)
        grown = resident_mib() - before
        print(f"200 designs: {grown:+.2f} MiB")
        self.assertLess(grown, 4)

    def test_a_call_costs_little_beside_the_librarys(self):
        """Compares the time of a call, including its arrays, with the time of the library. Minima of
        many calls are used, because other processes delay some calls. The limit is a ratio, because
        machines differ. The library takes half a millisecond for one direction of a prism."""
        design = rt.Design.load(PRISM)
        request = _core.RreRequest()
        of_python, of_library = [], []
        for _ in range(300):
            begin = time.perf_counter()
            rt.rre(design).rre.sum()
            of_python.append(time.perf_counter() - begin)
            of_library.append(_core.seconds_of_rre([design._core], request))
        more = min(of_python) - min(of_library)
        print(f"a call of rre: {1e3 * min(of_library):.2f} ms, by Python {1e3 * more:.2f} ms more")
        self.assertLess(more, 4 * min(of_library))

    def test_import(self):
        """Compares the processor time of the import with that of numpy, because machines differ."""
        code = (
            "import sys, time\n"
            "begin = time.process_time()\n"
            "import numpy\n"
            "middle = time.process_time()\n"
            "import retrace\n"
            "print(middle - begin, time.process_time() - middle)\n"
            "asked_for = ('matplotlib', 'pandas', 'xarray', 'scipy', 'tqdm', 'trimesh')\n"
            "print([name for name in asked_for if name in sys.modules])\n"
        )
        python(code)
        times = []
        for _ in range(5):
            ended = python(code)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            lines = ended.stdout.split("\n")
            times.append([float(word) for word in lines[0].split()])
            self.assertEqual(lines[1], "[]")
        of_numpy, own = map(min, zip(*times))
        print(f"import: {1e3 * (of_numpy + own):.0f} ms, of which numpy {1e3 * of_numpy:.0f} ms")
        self.assertLess(own, 2 * of_numpy)


if __name__ == "__main__":
    unittest.main()
