"""Types of arguments and results, for type checkers: nothing of this exists when the package runs."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._deck import Deck

    Floats = NDArray[np.float64]
    #: A function of the time (s) and the positions of points (m), which returns an array or one vector.
    Function = Callable[[float, Floats], ArrayLike]
    #: A function of the positions of points (m).
    Field = Callable[[Floats], ArrayLike]
    #: A vector with one entry per axis as in decks: a number, a text with unit or an expression, or None for a free axis.
    Vector = Sequence[Union[float, str, None]]
    #: A set, a mask, or point numbers.
    Points = Union[str, ArrayLike]
    #: A deck, the tables of a deck, or the file of a deck.
    DeckLike = Union[Deck, Mapping[str, Any], str, os.PathLike[str]]
    #: Values of keys of a deck.
    Changes = Mapping[str, Any]
