"""Speed of the border. Limits are design goals; a debug build of the extension is not measured.

Where one thread works, its processor time is measured, which other processes change least.
"""

import os
import statistics
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest
from conftest import BAR, PLATE, changed, program

import pericles as pc

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.environ.get("PERICLES_GOALS") != "1", reason="measures time: set PERICLES_GOALS=1 on a quiet machine"),
]


def grid(points, **tables):
    """Return a plate with about so many points."""
    side = int(points**0.5)
    return changed(PLATE, body={"size": [side * 1e-3, side * 1e-3], "spacing": 1e-3}, **tables)


def test_p1_callbacks():
    deck = changed(BAR, body={"spacing": "0.25 m"}, material={"horizon_ratio": 1.5}, time={"end": "1 s", "dt": "10 us"})
    seconds = []
    for called in (False, True, False, True):
        simulation = pc.Deck.from_dict(deck).build().simulation(keep=[])
        if called:
            simulation.every(steps=1)(lambda s: None)
        began = time.process_time()
        simulation.run()
        seconds.append(time.process_time() - began)
    each = (min(seconds[1::2]) - min(seconds[::2])) / simulation.steps
    print(f"P1 callback: {1e6 * each:.2f} us")
    assert each < 1e-6


def test_p1_field_of_a_callback():
    simulation = pc.Deck.from_dict(grid(1e5)).build().simulation(keep=[])
    times = []

    @simulation.every(steps=1)
    def look(s):
        began = time.thread_time()
        s.field("displacement")
        times.append(time.thread_time() - began)

    simulation.step(20)
    print(f"P1 field of 1e5 points: {1e3 * statistics.median(times):.2f} ms")
    assert statistics.median(times) < 1e-3


def test_p2_a_run_takes_the_time_of_the_program(tmp_path):
    """The seconds of the time loop according to run.json. Runs alternate, and the shortest count."""
    deck = grid(2e4, time={"end": "40 us"}, initial=[{"set": "left", "velocity": [-1, 0]}])
    path = tmp_path / "plate.toml"
    pc.Deck.from_dict(deck).write(path)
    own, others = [], []
    for number in range(7):
        own.append(pc.run(path, out=f"a{number}").info.progress.wall_seconds)
        subprocess.run([*program(), "run", str(path), "--out", f"b{number}", "--quiet"], check=True)
        others.append(pc.open(f"b{number}").info.progress.wall_seconds)
    print(f"P2 run: {min(own):.3f} s, program: {min(others):.3f} s, {100 * (min(own) / min(others) - 1):+.1f} %")
    assert min(own) < 1.01 * min(others)


def test_a_function_costs_little_of_a_run():
    """A run with functions copies its state before every step, so that it can undo the step."""
    plain, loaded = (pc.Deck.from_dict(grid(2e4)).build() for _ in range(2))
    loaded.load([0], body_force=lambda t, x: [0, 0])
    seconds = {}
    for _ in range(3):
        for name, model in (("plain", plain), ("loaded", loaded)):
            simulation = model.simulation(keep=[])
            simulation.step(5)
            began = time.perf_counter()
            simulation.step(40)
            seconds[name] = min(seconds.get(name, 1e9), (time.perf_counter() - began) / 40)
    print(f"copies for undoing steps: {100 * (seconds['loaded'] / seconds['plain'] - 1):+.0f} % of a step of {1e3 * seconds['plain']:.2f} ms")
    assert seconds["loaded"] < 1.5 * seconds["plain"]


def test_p4_other_threads_keep_their_speed(tmp_path):
    """One core is left to the other thread: what it loses then is lost to the interpreter's lock."""
    script = tmp_path / "threads.py"
    script.write_text(
        textwrap.dedent(
            f"""
            import os, threading, time
            import pericles as pc
            pc.set_threads(max(1, (os.cpu_count() or 2) - 1))

            def count(stop):
                number = 0
                while not stop.is_set():
                    for _ in range(1000):
                        number += 1
                return number

            def counted(seconds):
                stop, found = threading.Event(), []
                thread = threading.Thread(target=lambda: found.append(count(stop)))
                thread.start()
                time.sleep(seconds)
                stop.set()
                thread.join()
                return found[0]

            simulation = pc.Deck.from_dict({grid(1e4, time={"end": "1 s"})!r}).build().simulation(keep=[])
            alone = counted(1.0)
            runner = threading.Thread(target=simulation.run)
            runner.start()
            together = counted(1.0)
            simulation.stop()
            runner.join()
            print(together / alone)
            """
        )
    )
    shares = [float(subprocess.check_output([sys.executable, str(script)])) for _ in range(3)]
    print(f"P4 other thread: {100 * max(shares):.0f} %")
    assert max(shares) > 0.9


def test_p5_result_field():
    deck = grid(1e6, material={"horizon_ratio": 1.5}, time={"end": "10 us", "dt": "10 us", "allow_unstable": True})
    result = pc.Deck.from_dict(deck).build().simulation(keep=["displacement"], count=1).run().result()
    result.field("displacement")
    times = []
    recording, output = result._recording, len(result.times) - 1
    for _ in range(1000):
        began = time.perf_counter()
        recording.field("displacement", output)
        times.append(time.perf_counter() - began)
    print(f"P5 field of 1e6 points: {1e6 * statistics.median(times):.1f} us")
    assert statistics.median(times) < 1e-5


def test_p6_callable_load():
    n = 500
    deck = changed(BAR, body={"spacing": f"{1 / n!r} m"}, time={"end": "10 ms"})
    plain, loaded = (pc.Deck.from_dict(deck).build() for _ in range(2))
    loaded.load("all", body_force=lambda t, x: np.sin(1e4 * t) * x)
    seconds = []
    for model in (plain, loaded, plain, loaded):
        simulation = model.simulation(keep=[])
        simulation.step(20)
        began = time.process_time()
        simulation.step(1000)
        seconds.append((time.process_time() - began) / 1000)
    each = min(seconds[1::2]) - min(seconds[::2])
    print(f"P6 callable load of {n} points: {1e6 * each:.0f} us")
    assert each < 6e-5


def test_p7_import():
    def seconds(code):
        """Processor time of a new interpreter."""
        times = []
        for _ in range(7):
            child = os.posix_spawn(sys.executable, [sys.executable, "-c", code], os.environ)
            used = os.wait4(child, 0)[2]
            times.append(used.ru_utime + used.ru_stime)
        return min(times)

    each = seconds("import pericles") - seconds("pass")
    loaded = subprocess.check_output([sys.executable, "-c", "import pericles, sys; print('numpy' in sys.modules)"], text=True)
    print(f"P7 import: {1e3 * each:.0f} ms")
    assert loaded.strip() == "False"
    assert each < 0.05
