"""Results in one line in a terminal, and as a small table in a notebook."""

from collections.abc import Sequence
from html import escape

_MOST_ROWS = 40


class Shown:
    """Base of results, which say themselves in a few words, and in the rows of a table, its heads first."""

    def _words(self) -> str:
        raise NotImplementedError

    def _rows(self) -> Sequence[Sequence[object]]:
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._words()}>"

    def _repr_html_(self) -> str:
        """Table for a notebook; more rows than 40 are left out, and the last row says so."""
        heads, *rows = self._rows()
        left = len(rows) - _MOST_ROWS
        rows = rows[:_MOST_ROWS] + ([[f"and {left} more"]] if left > 0 else [])
        lines = ["".join(f"<td>{escape(str(cell))}</td>" for cell in row) for row in rows]
        lines.insert(0, "".join(f"<th>{escape(str(head))}</th>" for head in heads))
        table = "".join(f"<tr>{line}</tr>" for line in lines)
        return f"<p>{escape(repr(self))}</p><table>{table}</table>"
