"""Parts of a report, however it is printed: text, tables, figures and listings in sections."""

from dataclasses import dataclass, field, replace

PAGE_WIDTH = 0.17  # m, of the text on A4


@dataclass(frozen=True)
class Text:
    """A paragraph; ``strong`` sets it off."""

    text: str
    strong: bool = False
    kind: str = field(default="text", init=False)


@dataclass(frozen=True)
class Items:
    """A list of short statements."""

    items: tuple
    kind: str = field(default="items", init=False)


@dataclass(frozen=True)
class Heading:
    """Title of a part of a section; ``key`` is its anchor."""

    text: str
    key: str
    kind: str = field(default="heading", init=False)


@dataclass(frozen=True)
class Table:
    """Rows of text under a header.

    ``align`` has one letter a column, l or r; ``number`` counts the tables of the document. ``widths``, of columns that
    hold sentences, are shares of the width in print; such a table may run over pages.
    """

    caption: str
    header: tuple
    rows: tuple
    align: str
    widths: tuple = ()
    number: int = 0
    kind: str = field(default="table", init=False)


@dataclass(frozen=True)
class Drawing:
    """SVG text, ``width`` [m] in print."""

    svg: str
    width: float


@dataclass(frozen=True)
class Figure:
    """A drawing as SVG text, ``width`` [m] in print; ``number`` counts the figures of the document.

    ``moving``: JSON of blocks that move, which stand for the drawing on a screen; empty where the drawing stands.
    ``left``: `Drawing` to its left, or above it on a narrow screen.
    """

    caption: str
    svg: str
    width: float = PAGE_WIDTH
    moving: str = ""
    left: Drawing | None = None
    number: int = 0
    kind: str = field(default="figure", init=False)


@dataclass(frozen=True)
class Listing:
    """Text to be shown letter by letter, such as a file."""

    title: str
    text: str
    kind: str = field(default="listing", init=False)


@dataclass(frozen=True)
class Box:
    """A sentence in a frame on the first page of a report, and two or three numbers under it.

    ``facts`` has for each number its label, the number with its unit, and a note.
    """

    sentence: str
    facts: tuple
    kind: str = field(default="box", init=False)


@dataclass(frozen=True)
class Section:
    """Title, anchor and blocks."""

    title: str
    key: str
    blocks: tuple


@dataclass(frozen=True)
class Document:
    """The whole report; ``details`` are pairs of a label and words for its head."""

    title: str
    subtitle: str
    sections: tuple
    details: tuple = ()


def numbered(document):
    """The document with its figures and its tables counted from 1 in the order of reading."""
    counts = {"figure": 0, "table": 0}
    sections = []
    for section in document.sections:
        blocks = []
        for block in section.blocks:
            if block.kind in counts:
                counts[block.kind] += 1
                block = replace(block, number=counts[block.kind])
            blocks.append(block)
        sections.append(replace(section, blocks=tuple(blocks)))
    return replace(document, sections=tuple(sections))
