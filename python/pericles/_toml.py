"""Decks as TOML text."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from ._errors import PericlesError

_PLAIN = re.compile(r"[A-Za-z0-9_-]+\Z")


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise PericlesError(f"the key {key!r} of a deck is not a text")
    return key if _PLAIN.match(key) else _text(key)


def _text(text: str) -> str:
    out = []
    for character in text:
        if character in '"\\':
            out.append("\\" + character)
        elif ord(character) < 0x20 or ord(character) == 0x7F:
            out.append(f"\\u{ord(character):04x}")
        else:
            out.append(character)
    return '"' + "".join(out) + '"'


def text(value: Any, key: str) -> str:
    """Return the value of a key as in an override, ``key=value``."""
    value = plain(value, key)
    return value if isinstance(value, str) else _value(value)


def plain(value: Any, path: str = "") -> Any:
    """Return a deck value without NumPy types."""
    if isinstance(value, (str, bool)) or value is None:
        return value
    # Subclasses, such as `numpy.float64`, have a form of their own as text.
    if isinstance(value, (int, float)):
        return int(value) if isinstance(value, int) else float(value)
    if isinstance(value, Mapping):
        return {key: plain(inner, f"{path}.{key}".strip(".")) for key, inner in value.items()}
    if hasattr(value, "item") and getattr(value, "ndim", None) == 0:
        return value.item()
    if hasattr(value, "tolist"):
        size = getattr(value, "size", 0)
        if size > 1000:
            raise PericlesError(
                f"{path} is an array with {size} values; a deck has no arrays for points: give them to `build`, "
                "`set_initial`, `load` or `prescribe`"
            )
        return value.tolist()
    if callable(value):
        raise PericlesError(f"{path} is a function; give functions to `set_initial`, `load` or `prescribe` of the model")
    if isinstance(value, Sequence):
        return [plain(inner, f"{path}.{k}") for k, inner in enumerate(value)]
    if hasattr(value, "__fspath__"):
        return str(value)
    raise PericlesError(f"{path} is a {type(value).__name__}; a deck has texts, numbers, booleans, lists and dicts")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        if value != value:
            return "nan"
        if value in (float("inf"), float("-inf")):
            return "inf" if value > 0 else "-inf"
        return repr(float(value))
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        inner = (f"{_key(key)} = {_value(entry)}" for key, entry in value.items() if entry is not None)
        return "{ " + ", ".join(inner) + " }"
    return "[" + ", ".join(_value(entry) for entry in value) + "]"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(entry, Mapping) for entry in value)


def _table(table: Mapping[str, Any], path: list[str], lines: list[str]) -> None:
    later: list[tuple[str, Any]] = []
    for key, value in table.items():
        if value is None:
            continue
        if _is_tables(value) or (isinstance(value, Mapping) and value and len(path) < 2):
            later.append((key, value))
        else:
            lines.append(f"{_key(key)} = {_value(value)}")
    for key, value in later:
        inner = [*path, _key(key)]
        name = ".".join(inner)
        for entry in value if isinstance(value, list) else [value]:
            header = f"[[{name}]]" if isinstance(value, list) else f"[{name}]"
            if lines:
                lines.append("")
            lines.append(header)
            _table(entry, inner, lines)


def dumps(deck: Mapping[str, Any]) -> str:
    """Return the TOML text of a deck."""
    lines: list[str] = []
    _table(plain(deck), [], lines)
    return "\n".join(lines) + "\n"


def loads(text: str) -> dict[str, Any]:
    """Return the tables of a TOML text."""
    try:
        import tomllib
    except ImportError:  # Python 3.10
        try:
            import tomli as tomllib  # type: ignore[no-redef]
        except ImportError:
            raise PericlesError("reading a deck into a dict needs Python 3.11 or the package tomli: pip install tomli") from None
    return tomllib.loads(text)


_HEADER = re.compile(r"\s*(\[\[?)\s*([^\]]+?)\s*\]\]?\s*(#.*)?\Z")
_ENTRY = re.compile(r'\s*((?:"(?:[^"\\]|\\.)*"|[A-Za-z0-9_.-]+|\s*\.\s*)+?)\s*=')


def _numbered(name: str, counts: dict[str, int]) -> str:
    """Return a path with the numbers of the last entries of its lists."""
    parts = name.split(".")
    out: list[str] = []
    for end, part in enumerate(parts, 1):
        out.append(part)
        found = counts.get(".".join(parts[:end]))
        if found is not None:
            out.append(str(found))
    return ".".join(out)


def path_at(text: str, line: int | None) -> str | None:
    """Return the dotted path of the key in a line of a deck, such as ``load.0.traction``."""
    if line is None:
        return None
    lines = text.splitlines()
    if not 0 < line <= len(lines):
        return None
    counts: dict[str, int] = {}
    table = ""
    for at, content in enumerate(lines[:line], 1):
        header = _HEADER.match(content)
        if header:
            name = header.group(2).replace('"', "").replace(" ", "")
            if header.group(1) == "[[":
                counts[name] = counts.get(name, -1) + 1
            table = _numbered(name, counts)
            if at == line:
                return table
    # A value may go on over several lines.
    for at in range(line, 0, -1):
        if _HEADER.match(lines[at - 1]):
            break
        entry = _ENTRY.match(lines[at - 1])
        if entry:
            key = entry.group(1).strip().replace('"', "")
            return f"{table}.{key}".strip(".")
    return table or None
