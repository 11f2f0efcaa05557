"""Signals, threads and processes."""

import multiprocessing
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from conftest import PLATE, changed

import pericles as pc

# Long enough that no run ends within the half second before it is interrupted.
LONG = changed(PLATE, time={"end": "40 ms"}, initial=[{"set": "left", "velocity": [-1, 0]}])


TIMERS = []


@pytest.fixture(autouse=True)
def _no_late_signal():
    """A test that failed before its signal must not interrupt the following ones."""
    # Programs that a shell starts in the background ignore SIGINT, and Python then installs no handler.
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    while TIMERS:
        TIMERS.pop().cancel()
    signal.signal(signal.SIGINT, handler)


def interrupt_after(seconds):
    """Send SIGINT to this process and return when it was sent."""
    sent = []

    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, send)
    timer.start()
    TIMERS.append(timer)
    return sent


@pytest.mark.parametrize("out", [None, "a"])
def test_an_interrupted_run_goes_on(out):
    simulation = pc.Deck.from_dict(LONG).build().simulation(out=out)
    sent = interrupt_after(0.5)
    with pytest.raises(KeyboardInterrupt):
        simulation.run()
    late = time.monotonic() - sent[0]
    print(f"P3 interrupt: {1e3 * late:.0f} ms")
    assert late < 0.2
    step = simulation.steps_done
    assert 0 < step < simulation.steps
    simulation.step(10)
    assert simulation.steps_done == step + 10
    plain = pc.Deck.from_dict(LONG).build().simulation()
    plain.step(step + 10)
    assert np.array_equal(plain.field("velocity"), simulation.field("velocity"))


def test_an_interrupted_sweep_goes_on():
    # About a hundred thousand steps for each run.
    sweep = pc.sweep(changed(LONG, time={"end": "4 s"}), {"material.density": [2440, 2500]}, jobs=1, out="s")
    sent = interrupt_after(1.0)
    with pytest.raises(KeyboardInterrupt):
        sweep.run()
    # A run that is stopped writes a checkpoint.
    assert time.monotonic() - sent[0] < 2.0
    state = pc.Sweep.open("s")[0].result
    assert state.info.status == "stopped" and 0 < state.info.progress["last_step"]


def test_an_interrupted_fit_stops():
    deck = changed(LONG, time={"end": "4 s"}, probe=[{"name": "tip", "at": ["20 mm", "5 mm"]}])
    sent = interrupt_after(1.0)
    with pytest.raises(KeyboardInterrupt):
        pc.fit(deck, ([0.0, 1.0], [0.0, 1e-3]), x="time", y="tip_u_x", keys=["material.density"], out="f")
    assert time.monotonic() - sent[0] < 2.0


def test_an_interrupted_callback():
    simulation = pc.Deck.from_dict(LONG).build().simulation()

    @simulation.every(steps=1)
    def slow(s):
        time.sleep(0.01)

    sent = interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt):
        simulation.run()
    assert time.monotonic() - sent[0] < 0.2


def test_an_interrupted_build():
    deck = changed(PLATE, body={"size": ["60 mm", "60 mm"], "spacing": "0.15 mm"}, material={"bonds": "list", "horizon_ratio": 6})
    sent = interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt):
        while True:
            pc.Deck.from_dict(deck).build()
    assert time.monotonic() - sent[0] < 0.2


def test_two_threads_on_one_simulation():
    simulation = pc.Deck.from_dict(LONG).build().simulation()
    simulation.every(steps=1)(lambda s: None)
    errors = []
    thread = threading.Thread(target=simulation.run)
    thread.start()
    deadline = time.monotonic() + 20
    while simulation.steps_done < 5 and time.monotonic() < deadline:
        time.sleep(0.001)
    # Reading needs no lock; everything else is rejected at once.
    assert simulation.time > 0
    for busy in (lambda: simulation.step(1), lambda: simulation.field("damage"), lambda: simulation.energies, lambda: simulation.save("c")):
        began = time.monotonic()
        with pytest.raises(pc.PericlesError, match="running"):
            busy()
        errors.append(time.monotonic() - began)
    simulation.stop()
    thread.join(20)
    assert not thread.is_alive() and max(errors) < 1
    assert simulation.field("damage").shape == (200,)


def test_runs_in_a_pool_of_threads(bar):
    def one(number):
        bar_ = changed(bar, material={"density": 7850 + number})
        return pc.Deck.from_dict(bar_).build().simulation().run().field("displacement")

    alone = [one(number) for number in range(4)]
    with ThreadPoolExecutor(2) as pool:
        together = list(pool.map(one, range(4)))
    for a, b in zip(alone, together):
        assert np.array_equal(a, b)


def _child(deck, queue):
    queue.put(float(pc.Deck.from_dict(deck).build().simulation().run().energies["kinetic_energy"]))


def test_spawned_processes_run(bar):
    own = pc.Deck.from_dict(bar).build().simulation().run().energies["kinetic_energy"]
    context = multiprocessing.get_context("spawn")
    queue = context.Queue()
    process = context.Process(target=_child, args=(bar, queue))
    process.start()
    assert queue.get(timeout=60) == own
    process.join(20)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_forked_processes_are_rejected_and_do_not_hang(tmp_path):
    script = tmp_path / "fork.py"
    script.write_text(
        textwrap.dedent(
            """
            import os, sys, warnings
            warnings.simplefilter("ignore")
            import pericles as pc
            deck = {"body": {"shape": "bar", "length": 1, "spacing": 0.01},
                    "material": {"density": 1, "youngs_modulus": 1, "horizon_ratio": 3}, "time": {"end": 1}}
            pc.Deck.from_dict(deck).build().simulation().run()
            child = os.fork()
            if child == 0:
                try:
                    pc.Deck.from_dict(deck).build()
                except pc.PericlesError as error:
                    os._exit(7 if "forked" in str(error) else 8)
                os._exit(9)
            sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
            """
        )
    )
    assert subprocess.run([sys.executable, str(script)], timeout=60).returncode == 7


def test_results_do_not_depend_on_the_number_of_threads(tmp_path):
    script = tmp_path / "threads.py"
    script.write_text(
        textwrap.dedent(
            f"""
            import hashlib, sys
            import pericles as pc
            pc.set_threads(int(sys.argv[1]))
            deck = {LONG!r}
            deck["time"]["end"] = "4 us"
            print(hashlib.sha256(pc.Deck.from_dict(deck).build().simulation().run().field("velocity").tobytes()).hexdigest())
            """
        )
    )
    found = {subprocess.check_output([sys.executable, str(script), count], text=True) for count in ("1", "2", "3")}
    assert len(found) == 1
