import numpy as np
import pytest
from PIL import Image

from blockshake.errors import InputError
from blockshake.report.document.drawing import new_figure, save_picture


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
