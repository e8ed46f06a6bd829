"""How figures look and become SVG or a picture file: one style, one palette, the same bytes for the same content."""

import io
import re
import textwrap
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatterSciNotation

from blockshake.errors import InputError
from blockshake.files import replacing
from blockshake.pages.blocks import PAGE_WIDTH

# Okabe and Ito's palette with Tol's red in place of vermilion, distinguished by colour-blind readers
BLACK, ORANGE, BLUE, GREEN, RED = "#000000", "#e69f00", "#0072b2", "#009e73", "#cc3311"
SKY, PURPLE = "#56b4e9", "#cc79a7"
LIGHT_GREY, GREY, DARK_GREY = "#e2e2e2", "#b8b8b8", "#555555"
MEASURED = {"color": BLACK, "linestyle": (0, (4, 2)), "linewidth": 0.9}  # line of a measured curve
_INCH = 0.0254  # m
_LETTERS = 84  # of titles, over the columns of a figure
STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "axes.titlesize": 8.0,
    "axes.labelsize": 7.5,
    "axes.linewidth": 0.6,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#e4e4e4",
    "grid.linewidth": 0.4,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "lines.linewidth": 0.8,
    "path.simplify": True,
    "path.simplify_threshold": 0.1,  # of a point in print
    "svg.fonttype": "path",
    "svg.hashsalt": "blockshake",
    "text.parse_math": False,  # a dollar in a name is a dollar
}
_RAISED = str.maketrans(
    "-0123456789",
    "\N{SUPERSCRIPT MINUS}\N{SUPERSCRIPT ZERO}\N{SUPERSCRIPT ONE}\N{SUPERSCRIPT TWO}\N{SUPERSCRIPT THREE}"
    "\N{SUPERSCRIPT FOUR}\N{SUPERSCRIPT FIVE}\N{SUPERSCRIPT SIX}\N{SUPERSCRIPT SEVEN}\N{SUPERSCRIPT EIGHT}"
    "\N{SUPERSCRIPT NINE}",
)
# none of matplotlib's own remarks: no date, no links
_NO_METADATA = {"Date": None, "Creator": None, "Format": None, "Type": None}
# formats of picture files by suffix, with the same of theirs
_PICTURES = {".png": {}, ".pdf": {"CreationDate": None}, ".svg": _NO_METADATA}
_RESOLUTION = 200  # dots an inch, of a PNG


def column_title(words, columns):
    """Title of one of so many columns, in lines that fit its width."""
    lines = (textwrap.wrap(line, _LETTERS // columns, break_long_words=False) for line in words.split("\n"))
    return "\n".join("\n".join(line) for line in lines)


class _Picture(Figure):
    """A figure that a notebook shows, whether pyplot is at work there or not."""

    def _repr_png_(self):
        content = io.BytesIO()
        self.savefig(content, format="png")
        return content.getvalue()


def new_figure(height, width=PAGE_WIDTH):
    """Empty figure of this size [m] whose parts are laid out without overlap."""
    return _Picture(figsize=(width / _INCH, height / _INCH), layout="constrained")


def check_picture(path):
    """Refuse a path whose suffix is no format of pictures, with `InputError`."""
    if Path(path).suffix.lower() not in _PICTURES:
        raise InputError(path, "", f"expected a picture's suffix: {', '.join(_PICTURES)}")


def save_picture(path, plot, *arguments, **named):
    """Write the matplotlib figure that ``plot(...)`` returns as PNG, PDF or SVG, by the suffix, and return it."""
    check_picture(path)
    with matplotlib.rc_context(STYLE), replacing(path) as temporary:
        kind = Path(path).suffix.lower()
        figure = drawn(plot, *arguments, **named)
        figure.savefig(temporary, format=kind[1:], dpi=_RESOLUTION, metadata=_PICTURES[kind])
    return figure


def drawn(plot, *arguments, **named):
    """The matplotlib figure that ``plot(...)`` returns, in the report's style; powers in plain letters."""
    with matplotlib.rc_context(STYLE):
        figure = plot(*arguments, **named)
    for axis in (one for axes in figure.axes for one in (axes.xaxis, axes.yaxis)):
        if isinstance(axis.get_major_formatter(), LogFormatterSciNotation):
            axis.set_major_formatter(PowersOfTen())
        if isinstance(axis.get_minor_formatter(), LogFormatterSciNotation):
            axis.set_minor_formatter(PowersOfTen())
    return figure


def svg_of(plot, *arguments, **named):
    """SVG text, in the report's style, of the matplotlib figure that ``plot(...)`` returns."""
    with matplotlib.rc_context(STYLE):
        figure = drawn(plot, *arguments, **named)
        with io.StringIO() as text:
            figure.savefig(text, format="svg", metadata=_NO_METADATA)
            svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    return re.sub(r' d="([^"]*)"', lambda found: f' d="{_shorter(found[1])}"', svg)


class PowersOfTen(LogFormatterSciNotation):
    """Labels of a logarithmic axis in plain letters, such as 10 with a raised 3: formulas are not read."""

    def __call__(self, x, pos=None):
        """Label of a tick at ``x``, empty where it has none."""
        label = re.sub(r"\$|\\mathdefault", "", super().__call__(x, pos))
        label = label.replace(r"\times", "\N{MULTIPLICATION SIGN}")
        label = re.sub(r"\^\{(.*?)\}", lambda found: found[1].translate(_RAISED), label)
        return label.replace("{", "").replace("}", "")


def _shorter(path):
    """Path data to a hundredth of a point, which no printer shows, at a third of the bytes.

    A line's command stands once for all the points that follow, each distinguished from the one before.
    """
    rounded = re.sub(r"-?\d+\.\d{3,}", lambda found: f"{float(found[0]):.2f}", path)
    return re.sub(r"(M \S+ \S+) (L [-\d. L]+)", _one_line, " ".join(rounded.split()))


def _one_line(found):
    places = [round(100.0 * float(one)) for one in re.findall(r"-?[\d.]+", found[0])]
    steps = (after - before for before, after in zip(places, places[2:], strict=False))
    return f"{found[1]} l {' '.join(map(_hundredths, steps))} "


def _hundredths(steps):
    """Decimal number of hundredths without the zeros that it can do without: ``-.5`` for -50."""
    return re.sub(r"^(-?)0\.", r"\1.", f"{steps / 100.0:g}")
