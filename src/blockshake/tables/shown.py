"""Results in one line in a terminal, and as a table in a notebook."""

from collections.abc import Iterable
from html import escape


class Shown:
    """Base of results, which say themselves in a few words, and in the rows of a table, its heads first."""

    def _words(self) -> str:
        raise NotImplementedError

    def _rows(self) -> Iterable[Iterable[object]]:
        raise NotImplementedError

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._words()}>"

    def _repr_html_(self) -> str:
        import pandas as pd  # takes long, and few are shown

        heads, *rows = self._rows()
        return f"<p>{escape(repr(self))}</p>{pd.DataFrame(rows, columns=heads).to_html(index=False, max_rows=40)}"
