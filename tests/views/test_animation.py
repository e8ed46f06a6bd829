import json

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image

from blockshake.errors import InputError
from blockshake.simulation.run_histories import run_histories
from blockshake.views.animation import animate, magnified


@pytest.fixture(scope="module")
def gif(leaning_run, tmp_path_factory):
    path = tmp_path_factory.mktemp("gif") / "run.gif"
    animate(leaning_run[0], path, view="3d", magnification=3.0)
    return path


def test_a_gif_runs_in_real_time(gif):
    with Image.open(gif) as film:
        assert film.n_frames == 21  # 1 s at 20 Hz, both ends
        assert film.info["duration"] == 50
        assert film.info["loop"] == 0
        first = np.asarray(film.convert("RGB"))
        film.seek(20)
        last = np.asarray(film.convert("RGB"))
    assert first.std() > 10.0
    assert (first != last).any(axis=2).mean() > 0.01


def test_a_slower_one_has_more_frames_and_the_same_bytes_again(leaning_run, tmp_path):
    for name in ("a.gif", "b.gif"):
        animate(leaning_run[0], tmp_path / name, speed=2.0)
    with Image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 11
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()


def test_magnification_is_of_the_motion_against_the_base(leaning_run):
    run, structure = leaning_run
    position, orientation = magnified(run, structure, 4.0)
    larger = run.assign(
        position=(run["position"].dims, position), orientation=(run["orientation"].dims, orientation)
    )
    once, four = (run_histories(one, structure)["drift"] for one in (run, larger))
    np.testing.assert_allclose(four, 4.0 * once, atol=1e-12)
    np.testing.assert_allclose(position[:, 0], run["position"].sel(body="slab"), atol=1e-12)
    angle = 2.0 * np.arccos(np.clip(np.abs(orientation[:, 2, 0]), 0.0, 1.0))
    np.testing.assert_allclose(angle, 4.0 * 0.05 * run["time"], atol=1e-7)


@pytest.mark.parametrize(
    ("path", "keys", "words"),
    [
        ("x.avi", {}, "expected a suffix of moving pictures"),
        ("x.gif", {"view": "top"}, "view: top: expected front or side or far side or 3d"),
        ("x.gif", {"speed": 0.0}, "speed: expected a positive number"),
        ("x.gif", {"magnification": float("nan")}, "magnification: expected a positive number"),
    ],
)
def test_wishes_that_cannot_be_met_are_refused(leaning_run, tmp_path, path, keys, words):
    with pytest.raises(InputError, match=words):
        animate(leaning_run[0], tmp_path / path, **keys)
    assert list(tmp_path.iterdir()) == []


def test_an_mp4_without_ffmpeg_is_refused_in_one_line(leaning_run, tmp_path, monkeypatch):
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda cls: False))
    with pytest.raises(InputError, match="needs the program ffmpeg, which is not installed"):
        animate(leaning_run[0], tmp_path / "x.mp4")


@pytest.mark.skipif(not FFMpegWriter.isAvailable(), reason="ffmpeg is not installed")
def test_an_mp4_is_written_where_there_is_ffmpeg(leaning_run, tmp_path):
    animate(leaning_run[0], tmp_path / "x.mp4")
    assert (tmp_path / "x.mp4").read_bytes()[4:8] == b"ftyp"


@pytest.mark.parametrize("view", ["front", "side", "3d"])
def test_a_run_in_national_coordinates_looks_as_at_the_origin(view, leaning_run, tmp_path):
    run, structure = leaning_run
    origin = np.array([500_000.0, 4_000_000.0, 1000.0])
    mapping = structure.file.model_dump(mode="json")
    for body in mapping["bodies"]:
        body["position"] = (origin + body["position"]).tolist()
    moved = run.assign(position=run["position"] + origin)
    moved.attrs["structure_file"] = json.dumps(mapping)
    animate(run, tmp_path / "near.gif", view, 3.0, 5.0)
    animate(moved, tmp_path / "far.gif", view, 3.0, 5.0)
    with Image.open(tmp_path / "near.gif") as near, Image.open(tmp_path / "far.gif") as far:
        assert near.n_frames == far.n_frames > 1
        for frame in range(near.n_frames):
            near.seek(frame)
            far.seek(frame)
            a, b = (np.asarray(film.convert("RGB")).astype(int) for film in (near, far))
            # a line that falls between two pixels falls on either
            assert (np.abs(a - b).max(axis=2) > 60).mean() < 0.01
