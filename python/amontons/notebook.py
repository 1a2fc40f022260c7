# SPDX-License-Identifier: GPL-2.0-or-later
"""How runs look in a notebook (Jupyter): pages of text and pictures, and progress while a run computes. Needs nothing but the
notebook itself."""
from __future__ import annotations

import base64
import html
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

_BAR = ('<div style="width:24em;max-width:100%;border:1px solid #888"><div style="width:{:.1f}%;height:0.6em;background:#0d4589">'
        "</div></div>")
_REFRESH = 0.5   # s, between two pictures of a run that computes


def _row(*cells: str) -> str:
    return "<tr>" + "".join(f'<td style="text-align:left">{html.escape(cell)}</td>' for cell in cells) + "</tr>"


def progress_html(step: Any) -> str:
    """A StepView as a bar and a line of numbers."""
    part = min(max(float(step.fraction), 0.0), 1.0) if step.fraction == step.fraction else 0.0
    return _BAR.format(100 * part) + f"<div>t = {step.t:.6g}, U = {step.U:.6g}, F_T/F_N = {step.mu:.4f}</div>"


def result_html(title: str, rows: Iterable[tuple[str, str]], warnings: Iterable[str], pictures: Iterable[Path]) -> str:
    """A table of numbers, warnings, and pictures, which come along in the page."""
    parts = [f"<b>{html.escape(title)}</b>", "<table>", *(_row(*row) for row in rows), "</table>"]
    parts += [f'<div style="color:#9c2a0e">Warning: {html.escape(text)}</div>' for text in warnings]
    for picture in pictures:
        data = base64.b64encode(picture.read_bytes()).decode()
        parts.append(f'<figure style="display:inline-block;margin:0.5em"><img style="width:26em" alt="{html.escape(picture.stem)}" '
                     f'src="data:image/png;base64,{data}"></figure>')
    return "\n".join(parts)


class NotebookProgress:
    """Shows a run's progress below the cell that computes it: `amontons.run(scene, progress=amontons.NotebookProgress())`."""

    def __init__(self) -> None:
        try:
            from IPython.display import HTML, display
        except ImportError:
            raise ImportError("progress in a notebook needs IPython, which a notebook has") from None
        self._html, self._next, self._last = HTML, 0.0, ""
        self._handle = display(HTML(""), display_id=True)

    def __call__(self, step: Any) -> None:
        now = time.monotonic()
        self._last = progress_html(step)
        if now >= self._next:
            self._handle.update(self._html(self._last))
            self._next = now + _REFRESH

    def finish(self) -> None:
        """Shows the last step; called by `run` at its end."""
        self._handle.update(self._html(self._last))
