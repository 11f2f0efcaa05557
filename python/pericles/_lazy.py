"""NumPy, imported with the first array: ``import pericles`` stays fast."""

from __future__ import annotations

from typing import Any


class _Lazy:
    def __getattr__(self, name: str) -> Any:
        import numpy

        return getattr(numpy, name)


np: Any = _Lazy()
