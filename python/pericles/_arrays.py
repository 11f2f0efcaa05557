"""Conversion of arguments to arrays, with messages that show the shape given and the one needed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._errors import PericlesError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
else:
    from ._lazy import np


def as_vectors(given: Any, points: int, dimension: int, what: str = "the values") -> NDArray[np.float64]:
    """Return an array of shape (points, dimension); one vector stands for all points."""
    try:
        array = np.asarray(given, dtype=float)
    except (TypeError, ValueError) as error:
        raise PericlesError(f"{what} are not numbers: {error}") from None
    if array.ndim < 2 and dimension == 1 and array.shape in ((points,), ()):
        array = np.broadcast_to(array.reshape(-1, 1), (points, 1))
    elif array.shape == (dimension,):
        array = np.broadcast_to(array, (points, dimension))
    if array.shape != (points, dimension):
        raise PericlesError(
            f"{what} have shape {array.shape}; needed: ({points}, {dimension}), one row for each point, "
            f"or ({dimension},) for the same vector on all points"
        )
    return np.ascontiguousarray(array)


def finite(array: NDArray[np.float64], what: str) -> NDArray[np.float64]:
    """Reject NaN and infinity."""
    wrong = ~np.isfinite(array)
    if wrong.any():
        row = int(np.argwhere(wrong)[0][0])
        raise PericlesError(f"{what} have a value that is NaN or infinite, first for point {row}; all must be finite")
    return array


def as_numbers(given: Any, points: int | None, what: str) -> NDArray[np.uint32]:
    """Return point numbers from a mask or a list of numbers."""
    array = np.asarray(given)
    if array.dtype == bool:
        if points is not None and array.shape != (points,):
            raise PericlesError(f"the mask {what} has shape {array.shape}; needed: ({points},), one entry for each point")
        return np.flatnonzero(array).astype(np.uint32)
    if array.size == 0:
        return np.zeros(0, np.uint32)
    if array.ndim != 1 or array.dtype.kind not in "iu":
        raise PericlesError(f"{what} is neither a mask (bool) nor a list of point numbers (int)")
    if array.min() < 0 or (points is not None and array.max() >= points):
        most = "" if points is None else f" to {points - 1}"
        raise PericlesError(f"{what} has point {array.min() if array.min() < 0 else array.max()}; points are numbered from 0{most}")
    return array.astype(np.uint32)
