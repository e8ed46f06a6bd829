"""The box on the first page of a report."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Box:
    """A sentence in a frame, and three numbers under it.

    ``facts`` has for each number its label, the number with its unit, and a note.
    """

    sentence: str
    facts: tuple
    kind: str = field(default="box", init=False)
