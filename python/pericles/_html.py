"""Tables for notebooks."""

from __future__ import annotations

import html
from collections.abc import Mapping
from typing import Any


def table_html(title: str, facts: Mapping[str, Any]) -> str:
    """Return facts as a table, with warnings in colour."""
    rows = []
    for key, value in facts.items():
        if value is None or isinstance(value, (list, dict)):
            continue
        shown = f"{value:.6g}" if isinstance(value, float) else str(value)
        rows.append(f"<tr><td>{html.escape(key.replace('_', ' '))}</td><td>{html.escape(shown)}</td></tr>")
    warnings = "".join(
        f'<p style="color:#b36b00">warning: {html.escape(text)}</p>' for text in facts.get("warnings") or []
    )
    return f"<b>{html.escape(title)}</b><table>{''.join(rows)}</table>{warnings}"
