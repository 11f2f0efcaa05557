"""Simulations."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
import time as clock
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from . import _pericles
from ._errors import PericlesError, UnstableError
from ._result import Result

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from ._model import Model

Snapshot = _pericles.Snapshot

#: A function of a snapshot, which may return :data:`STOP`.
Callback = Callable[[Snapshot], object]


class _Stop:
    """What a callback returns to stop the run."""

    def __repr__(self) -> str:
        return "pericles.STOP"

    def __reduce__(self) -> str:
        return "STOP"


STOP = _Stop()


def schedule(every: int | None, time: float | None, count: int | None) -> tuple[str, float] | None:
    """Return the one schedule that is given."""
    given = [(kind, value) for kind, value in (("steps", every), ("time", time), ("count", count)) if value is not None]
    if len(given) > 1:
        raise PericlesError("give one of steps (every), time and count")
    return given[0] if given else None


class Simulation:
    """A run of a model, made by :meth:`Model.simulation`.

    A run releases the interpreter's lock. Ctrl-C stops it between two steps; :meth:`run` then goes on.
    """

    def __init__(self, core: _pericles.Simulation, model: Model) -> None:
        self._core = core
        self._model = model

    def every(
        self, *, steps: int | None = None, time: float | None = None, count: int | None = None
    ) -> Callable[[Callback], Callback]:
        """Call a function during the run; use as a decorator.

        The function receives a snapshot with ``step``, ``time``, ``energies``, ``broken_bonds`` and ``field(name)``, which
        copies a field. Returning :data:`STOP` stops the run.

        Parameters
        ----------
        steps, time, count : int or float
            One of: every given number of steps, each given time (s), or the given number of times. The first and the last
            state are included.
        """
        found = schedule(steps, time, count)
        if found is None:
            raise PericlesError("give one of steps, time and count")

        def register(function: Callback) -> Callback:
            self._core.observe(found[0], float(found[1]), function, STOP)
            return function

        return register

    def run(self, *, progress: bool = False) -> Simulation:
        """Run to the end, or until a callback returns :data:`STOP`.

        Parameters
        ----------
        progress : bool
            Show a progress bar (package tqdm), or a line per second.
        """
        self._advance(None, progress)
        return self

    def step(self, count: int = 1) -> Simulation:
        """Run a number of steps."""
        self._advance(self._core.step + count, False)
        return self

    def _advance(self, until: int | None, progress: bool) -> None:
        with _progress(self._core) if progress else contextlib.nullcontext():
            try:
                self._core.run(until)
            except UnstableError as error:
                error.result = self.result()
                raise

    def stop(self) -> None:
        """Stop the run of another thread after its current step."""
        self._core.stop()

    @property
    def steps_done(self) -> int:
        """Number of completed steps, also during a run."""
        return self._core.step

    @property
    def time(self) -> float:
        """Time reached, s; also during a run."""
        return self._core.time

    @property
    def steps(self) -> int:
        """Number of steps of the whole run."""
        return self._core.steps

    @property
    def dt(self) -> float:
        """Time step, s."""
        return self._core.dt

    @property
    def warnings(self) -> list[str]:
        """Warnings about the model with its conditions."""
        return self._core.warnings

    @property
    def energies(self) -> dict[str, float]:
        """The energy balance of the current state, J."""
        return self._core.energies

    @property
    def broken_bonds(self) -> int:
        """Number of broken bonds, each counted once."""
        return self._core.broken_bonds

    @property
    def stop_reason(self) -> str | None:
        """What stopped the run before its last step: a stop condition of the deck, a callback, or :meth:`stop`."""
        return self._core.stop_reason

    def field(self, name: str) -> NDArray[np.float64]:
        """Return a copy of a field of the current state: shape (n, components), or (n,) for scalars."""
        return self._core.field(name)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the state to a file. It holds no functions: :meth:`load` needs the same model."""
        self._core.save(path)

    def load(self, path: str | os.PathLike[str]) -> None:
        """Read the state that :meth:`save`, or a run of the same model, wrote; the run continues bitwise identically."""
        self._core.load(path)

    def result(self) -> Result:
        """Return the results so far."""
        if self._core.folder is not None:
            return Result.open(self._core.folder)
        return Result.of_simulation(self._core, self._model)

    def close(self) -> None:
        """Release memory and the lock of the output folder; results stay."""
        self._core.close()

    def __enter__(self) -> Simulation:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<pericles.Simulation: step {self._core.step} of {self._core.steps}, t = {self._core.time:.4g} s>"


@contextlib.contextmanager
def _progress(core: _pericles.Simulation) -> Iterator[None]:
    """Show progress from another thread, fed by the step number alone."""
    done = threading.Event()
    first = core.step
    try:
        from tqdm.auto import tqdm
    except ImportError:
        tqdm = None

    def bar() -> None:
        with tqdm(total=core.steps, initial=first, unit="step", leave=True) as shown:
            last = first
            while not done.wait(0.1):
                now = core.step
                shown.update(now - last)
                last = now
            shown.update(core.step - last)

    def lines() -> None:
        began = clock.monotonic()
        while not done.wait(1.0):
            seconds = clock.monotonic() - began
            print(f"step {core.step} of {core.steps}, t = {core.time:.4g} s, {seconds:.0f} s", file=sys.stderr)

    thread = threading.Thread(target=bar if tqdm else lines, daemon=True)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()
