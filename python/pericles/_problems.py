"""Problems of decks and warnings."""

from __future__ import annotations

import warnings

from . import _toml
from ._errors import DeckError, PericlesWarning, Problem


def warn(messages: list[str], depth: int = 3) -> None:
    """Issue warnings at the caller of the package."""
    for message in messages:
        warnings.warn(message, PericlesWarning, stacklevel=depth)


def located(error: DeckError, text: str, name: str) -> None:
    """Add its key to every problem, and to the message if nobody has seen the text, as for a dict."""
    problems = []
    for problem in error.problems:
        is_known = problem.path is not None
        path = problem.path or (_toml.path_at(text, problem.line) if problem.file == name else _of_override(problem))
        problem = problem._replace(path=path)
        if not is_known and name.startswith("<dict") and problem.file == name and path and not problem.message.startswith(path):
            place = f"{name}:{problem.line}:{problem.column}: "
            problem = problem._replace(text=problem.text.replace(place, f"{place}{path}: ", 1))
        problems.append(problem)
    message = str(error)
    for old, new in zip(error.problems, problems):
        message = message.replace(old.text, new.text, 1)
    error.args = (message,)
    error.problems = problems


def _of_override(problem: Problem) -> str | None:
    prefix = "--set "
    return problem.file[len(prefix) :] if problem.file and problem.file.startswith(prefix) else None
