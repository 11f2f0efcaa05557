"""Exceptions and warnings."""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = [
    "DeckError",
    "OutputError",
    "PericlesError",
    "PericlesWarning",
    "Problem",
    "TooLargeError",
    "UnstableError",
]


class PericlesWarning(UserWarning):
    """A warning about a deck, a model or a run."""


class PericlesError(Exception):
    """An error of Pericles; the base of all others."""

    def __init__(self, message: str, **attributes: Any) -> None:
        super().__init__(message)
        for name, value in attributes.items():
            setattr(self, name, value)

    def __reduce__(self) -> Any:
        return (_rebuilt, (type(self), self.args, dict(self.__dict__)))


def _rebuilt(kind: type[PericlesError], args: tuple[Any, ...], attributes: dict[str, Any]) -> PericlesError:
    error = kind(*args)
    error.__dict__.update(attributes)
    return error


class Problem(NamedTuple):
    """A problem of a deck.

    Attributes
    ----------
    message : str
        What is wrong.
    help : str or None
        What is allowed.
    file : str or None
        The file, or ``"<dict>"`` for a deck made from a dict.
    line, column : int or None
        Location in the text, from 1.
    path : str or None
        The key with its tables, such as ``load.0.traction``.
    excerpt : str or None
        The text at the location.
    text : str
        All of it in one line.
    """

    message: str
    help: str | None = None
    file: str | None = None
    line: int | None = None
    column: int | None = None
    path: str | None = None
    excerpt: str | None = None
    text: str = ""


class DeckError(PericlesError, ValueError):
    """The deck or model is invalid.

    Attributes
    ----------
    problems : list of Problem
        All problems, in the order of the text.
    """

    problems: list[Problem]

    def __init__(self, message: str, problems: Any = ()) -> None:
        super().__init__(message)
        self.problems = []
        for problem in problems:
            self.problems.append(Problem(**problem) if isinstance(problem, dict) else problem)


class UnstableError(PericlesError, ArithmeticError):
    """The run became unstable or cannot continue.

    Attributes
    ----------
    step : int
        The step at which it was found.
    time : float
        Its time, s.
    cause, advice : str or None
        What happened, and what usually helps.
    point : int
        The point where it is strongest.
    place : tuple of float
        Its reference position, m.
    result : Result or None
        The results up to the error.
    """

    step: int | None = None
    time: float | None = None
    cause: str | None = None
    advice: str | None = None
    point: int | None = None
    place: tuple[float, float, float] | None = None
    result: Any = None


class TooLargeError(PericlesError, MemoryError):
    """The model or its results need more memory than is available.

    Attributes
    ----------
    needed, allowed : float or None
        Estimated and available memory, bytes.
    """

    needed: float | None = None
    allowed: float | None = None


class OutputError(PericlesError, OSError):
    """A file or folder cannot be read or written."""


# Messages name the classes as users write them.
for _class in (PericlesWarning, PericlesError, Problem, DeckError, UnstableError, TooLargeError, OutputError):
    _class.__module__ = "pericles"
