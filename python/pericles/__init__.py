"""Peridynamics from Python.

Decks are dicts or files, points and conditions are arrays or functions, results are arrays.

>>> import pericles as pc
>>> deck = pc.Deck.from_dict({
...     "body": {"shape": "bar", "length": "1 m", "spacing": "1 cm"},
...     "material": {"density": 7850, "youngs_modulus": "210 GPa", "horizon_ratio": 3},
...     "initial": [{"velocity": {"expression": "cos(pi*x)"}}],
...     "time": {"end": "0.2 ms"},
... })
>>> simulation = deck.build().simulation()
>>> result = simulation.run().result()
>>> result.field("displacement").shape
(100, 1)
>>> bool(abs(result.audit.balance) < 1e-9 * result.audit.initial_energy)
True
"""

from __future__ import annotations

import os as _os

from . import _pericles
from ._check import Check, Report
from ._deck import Deck
from ._errors import (
    DeckError,
    OutputError,
    PericlesError,
    PericlesWarning,
    Problem,
    TooLargeError,
    UnstableError,
)
from ._fit import Fit, FittedValue, fit
from ._functions import (
    Difference,
    Dispersion,
    Modes,
    Reproduction,
    check,
    diff,
    dispersion,
    geodesics,
    mesh,
    modes,
    reproduce,
    run,
)
from ._functions import open_ as open
from ._model import Model
from ._pericles import __version__
from ._result import Audit, Info, Progress, Record, Result, Table, View
from ._simulation import STOP, Simulation, Snapshot
from ._sweep import Sweep, SweepPoint, sweep

__all__ = [
    "STOP",
    "Audit",
    "Check",
    "Deck",
    "DeckError",
    "Difference",
    "Dispersion",
    "Fit",
    "FittedValue",
    "Info",
    "Model",
    "Modes",
    "OutputError",
    "PericlesError",
    "PericlesWarning",
    "Problem",
    "Progress",
    "Record",
    "Report",
    "Reproduction",
    "Result",
    "Simulation",
    "Snapshot",
    "Sweep",
    "SweepPoint",
    "Table",
    "TooLargeError",
    "UnstableError",
    "View",
    "__version__",
    "check",
    "diff",
    "dispersion",
    "fit",
    "geodesics",
    "mesh",
    "modes",
    "open",
    "reproduce",
    "run",
    "set_threads",
    "sweep",
]


def set_threads(count: int) -> None:
    """Set the number of threads; call it before the first computation. Results do not depend on it."""
    _pericles.set_threads(count)


if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_pericles.after_fork)
