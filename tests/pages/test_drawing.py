import re

import numpy as np
import pytest
from PIL import Image

from blockshake.errors import InputError
from blockshake.pages.drawing import column_title, new_figure, save_picture, svg_of


def plot(end):
    figure = new_figure(0.0508, 0.0762)
    figure.subplots().plot([0.0, end], [0.0, 1.0])
    return figure


@pytest.mark.parametrize(("suffix", "begins"), [(".png", b"\x89PNG"), (".svg", b"<?xml"), (".PDF", b"%PDF")])
def test_a_picture_has_the_format_of_its_suffix_and_the_same_bytes(tmp_path, suffix, begins):
    for name in ("a", "b"):
        save_picture(tmp_path / f"{name}{suffix}", plot, 2.0)
    content = (tmp_path / f"a{suffix}").read_bytes()
    assert content.startswith(begins)
    assert content == (tmp_path / f"b{suffix}").read_bytes()


def test_a_png_has_its_size_in_print_and_is_not_empty(tmp_path):
    save_picture(tmp_path / "a.png", plot, 2.0)
    with Image.open(tmp_path / "a.png") as picture:
        assert picture.size == (600, 400)  # 3 by 2 inches, 200 dots an inch
        assert np.asarray(picture.convert("L")).std() > 10.0


def test_a_suffix_that_is_no_picture_is_refused(tmp_path):
    with pytest.raises(InputError, match=r"expected a picture's suffix: \.png, \.pdf, \.svg"):
        save_picture(tmp_path / "a.jpg", plot, 2.0)
    assert list(tmp_path.iterdir()) == []


def test_points_of_a_curve_are_where_matplotlib_puts_them(tmp_path):
    """Each is distinguished from the one before, to a hundredth of a point; errors do not add up along the curve."""

    def curve():
        figure = new_figure(0.05)
        figure.subplots().plot(np.sin(0.3 * np.arange(400.0)), gid="curve")
        return figure

    save_picture(tmp_path / "exact.svg", curve)
    exact = np.array(_curve((tmp_path / "exact.svg").read_text()).replace("L", "").split()[1:], dtype=float)
    command, x, y, line, *steps = _curve(svg_of(curve)).split()
    assert (command, line) == ("M", "l")
    told = np.cumsum(np.array([x, y, *steps], dtype=float).reshape(-1, 2), axis=0)
    np.testing.assert_allclose(told, exact.reshape(-1, 2), atol=0.0051)
    assert len(" ".join(steps)) < 0.5 * len((tmp_path / "exact.svg").read_text())


def _curve(svg):
    """Path data of the curve."""
    return re.search(r'id="curve">\s*<path d="([^"]*)"', svg)[1]


@pytest.mark.parametrize(
    ("scale", "limits", "wanted"),
    [
        ("log", (1e-3, 1e2), {"10⁻³", "10⁰", "10²"}),
        ("symlog", (-100.0, 100.0), {"-10²", "0", "10²"}),
        ("log", (2.0, 7.0), {"2\N{MULTIPLICATION SIGN}10⁰", "6\N{MULTIPLICATION SIGN}10⁰"}),
    ],
)
def test_powers_of_ten_are_plain_letters(tmp_path, scale, limits, wanted):
    """Formulas are not read, so that the labels of a logarithmic axis must not be any."""
    drawn = new_figure(0.06)

    def plot():
        axes = drawn.subplots()
        axes.set(xscale=scale, xlim=limits)
        return drawn

    save_picture(tmp_path / "powers.png", plot)
    (axes,) = drawn.axes
    labels = {
        label.get_text().replace(" ", "") for label in axes.get_xticklabels(which="both") if label.get_text()
    }
    assert wanted <= labels, labels
    assert not [label for label in labels if set(label) & set("${}\\^")]


def test_titles_of_many_columns_break_and_those_of_few_stay():
    words = "NSCD viscoelastic\n10 of 10 samples"
    assert column_title(words, 4) == words
    assert column_title("NSCD rigid in whole steps\n10 of 10 samples", 9) == (
        "NSCD\nrigid in\nwhole\nsteps\n10 of 10\nsamples"
    )
