"""The command line of the program, and its commands as functions."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

from ._errors import DeckError, OutputError, PericlesError, TooLargeError, UnstableError

#: Exit statuses of the program as exceptions.
_CLASSES: dict[int, type[PericlesError]] = {3: DeckError, 4: UnstableError, 6: OutputError, 8: TooLargeError}

#: A comparison that failed is a result, not an error.
_COMPARED = 5


def main() -> int:
    """Run the program ``pericles`` with the arguments of this process."""
    from . import _pericles

    return int(_pericles.command_line(["pericles", *sys.argv[1:]]))


def call(*arguments: str | os.PathLike[str]) -> Any:
    """Run a command of the program in a process of its own and return its JSON results.

    A process of its own ends at Ctrl-C, needs no memory of this one, and has its own threads.
    """
    import tempfile

    with tempfile.TemporaryDirectory(prefix="pericles-") as folder:
        path = Path(folder) / "results.json"
        execute(*arguments, "--json", path)
        return json.loads(path.read_text(encoding="utf-8"))


def execute(*arguments: str | os.PathLike[str]) -> None:
    """Run a command of the program in a process of its own; a failure is an exception."""
    import subprocess

    command = [sys.executable, "-m", "pericles", *(os.fspath(argument) for argument in arguments)]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=_environment())
    if done.returncode not in (0, _COMPARED):
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        text = "\n".join(line.removeprefix("error: ") for line in lines if not line.startswith("warning:"))
        kind = _CLASSES.get(done.returncode, PericlesError)
        raise kind(text or f"the program ended with status {done.returncode}")


def _environment() -> dict[str, str]:
    """Return an environment in which the process finds this package."""
    root = str(Path(__file__).resolve().parent.parent)
    known = os.environ.get("PYTHONPATH")
    return {**os.environ, "PYTHONPATH": root if not known else root + os.pathsep + known}
