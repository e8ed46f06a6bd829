"""A run as moving pictures: its blocks in elevation or in parallel projection, as GIF or MP4."""

import logging
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.animation import FFMpegWriter
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from PIL import Image
from scipy.spatial.transform import Rotation

from blockshake.errors import Argument, InputError
from blockshake.files import AnyPath, check_output, replacing
from blockshake.pages.drawing import DARK_GREY, STYLE
from blockshake.pages.scene.bodies import body_colors
from blockshake.pages.scene.projection import VIEWS, Scene
from blockshake.pages.wording import given
from blockshake.simulation.load_run import RunSource, load_run
from blockshake.solvers.pieces import Due
from blockshake.views.figure import run_title

FRAME_RATE = 20.0  # Hz; a GIF counts in hundredths of a second
_MOST_FRAMES = 100_000  # hours of drawing
_PIXELS = 100  # an inch
_LARGEST, _SMALLEST = 7.0, 3.6  # inches, of the drawing's sides
_LETTERS = 17.0  # of the title, an inch
_MARGIN = 0.04  # of the drawing, around the blocks
_NEWS_EVERY = 10.0  # s of wall time between lines of progress
_log = logging.getLogger(__name__)


def _check_suffix(path):
    """Refuse a path whose suffix is no format of moving pictures or cannot be written here, with `InputError`."""
    suffix = Path(path).suffix.lower()
    if suffix not in (".gif", ".mp4"):
        raise InputError(path, "", "expected a suffix of moving pictures: .gif or .mp4")
    if suffix == ".mp4" and not FFMpegWriter.isAvailable():
        wrong = "an MP4 needs the program ffmpeg, which is not installed; GIF needs nothing"
        raise InputError(path, "", wrong)


def animate(
    run: RunSource,
    output: AnyPath,
    view: str = "front",
    magnification: float = 1.0,
    speed: float = 1.0,
    meshes: AnyPath | None = None,
) -> Path:
    """Write a run as moving pictures, atomically; progress goes to the log.

    Parameters
    ----------
    run : str, path or xarray.Dataset
        A run file, or what `simulate` returns.
    output : str or path
        GIF, or MP4 where ffmpeg is installed, by the suffix.
    view : str
        One of `VIEWS`: ``front`` (x and z), ``side`` (y and z) or ``3d``.
    magnification : float
        Factor on the motion against the first driven body, displacement and rotation; the base's own motion is shown as
        it is.
    speed : float
        Seconds of the run in a second of the animation.
    meshes : str or path, optional
        Folder of the structure's meshes; by default that of the run file, or the current one.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        No run, a mesh that is not found, an unknown view or suffix, a number that is not positive, or more than
        `_MOST_FRAMES` frames.

    Examples
    --------
    >>> import blockshake
    >>> run = blockshake.simulate("my.yaml", "alkion", "nscd-rigid", duration=0.2)
    >>> blockshake.animate(run, "run.gif", magnification=10.0).name
    'run.gif'
    """
    _check_suffix(check_output(output))
    if view not in VIEWS:
        raise InputError(Argument("view"), view, f"expected {' or '.join(VIEWS)}")
    for name, value in (("magnification", magnification), ("speed", speed)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(Argument(name), "", f"expected a positive number, not {value}")
    loaded, structure = load_run(run, meshes)
    times = loaded["time"].to_numpy()
    frames = (times[-1] - times[0]) / speed * FRAME_RATE
    if frames > _MOST_FRAMES:
        raise InputError(Argument("speed"), "", f"expected at most {_MOST_FRAMES} frames, not {frames:.2g}")
    wanted = np.arange(times[0], times[-1] + 1e-9, speed / FRAME_RATE)
    rows = np.searchsorted(times, wanted - 0.5 * float(np.diff(times[:2]).sum()), side="left")
    position, orientation = magnified(loaded.isel(time=rows), structure, magnification)
    with matplotlib.rc_context(STYLE):
        film = _Film(loaded, structure, view, _words(magnification, speed), position, orientation)
        with replacing(output) as temporary:
            write = _write_gif if Path(output).suffix.lower() == ".gif" else _write_mp4
            write(temporary, film, times[rows])
    return Path(output)


def magnified(run, structure, magnification):
    """Poses with the motion against the base magnified.

    Positions (n_times, n_bodies, 3), inertial frame [m], and unit quaternions (n_times, n_bodies, 4), body to world.

    Notes
    -----
    A body's displacement against the base and its rotation vector against the base, both since the structure
    file's pose and in the base's frame, are multiplied. Magnified blocks overlap: the motion of a rigid body is no
    multiple of a smaller one.
    """
    position, orientation = run["position"].to_numpy(), run["orientation"].to_numpy()
    if magnification == 1.0:
        return position, orientation
    turn = Rotation.from_quat(orientation.reshape(-1, 4), scalar_first=True)
    bodies = np.arange(position.shape[1])
    base, origin, start_turn, start = _base(structure, position, orientation)
    back = _repeated(base.inv(), len(bodies))
    at_start = Rotation.from_quat(structure.orientation, scalar_first=True)
    rest = (start_turn.inv() * at_start).as_quat()
    rest = Rotation.from_quat(np.tile(rest, (len(position), 1)))
    at_rest = start_turn.inv().apply(structure.position - start)
    seen = back.apply((position - origin[:, None]).reshape(-1, 3)).reshape(position.shape)
    seen = at_rest + magnification * (seen - at_rest)
    turned = Rotation.from_rotvec(magnification * (back * turn * rest.inv()).as_rotvec()) * rest
    forth = _repeated(base, len(bodies))
    moved = forth.apply(seen.reshape(-1, 3)).reshape(position.shape) + origin[:, None]
    return moved, (forth * turned).as_quat(scalar_first=True).reshape(orientation.shape)


def _base(structure, position, orientation):
    """Rotations and places of the first driven body over time and at the start; the inertial frame where none is."""
    if not structure.driven.any():
        still = Rotation.identity(len(position))
        return still, np.zeros((len(position), 3)), Rotation.identity(), np.zeros(3)
    base = int(np.argmax(structure.driven))
    return (
        Rotation.from_quat(orientation[:, base], scalar_first=True),
        position[:, base],
        Rotation.from_quat(structure.orientation[base], scalar_first=True),
        structure.position[base],
    )


def _repeated(rotations, times):
    return Rotation.from_quat(np.repeat(rotations.as_quat(), times, axis=0))


def _words(magnification, speed):
    words = "" if magnification == 1.0 else f"motion against the base times {given(magnification)}; "
    return words + ("real time" if speed == 1.0 else f"{given(speed)} times real time")


class _Film:
    """A figure whose blocks are moved from frame to frame."""

    def __init__(self, run, structure, view, words, position, orientation):
        self._scene = Scene(structure, view)
        self._poses = position, orientation
        self._colors = body_colors(structure)
        low, high = self._scene.extent(position, orientation)
        middle, half = 0.5 * (low + high), (0.5 + _MARGIN) * (high - low)
        scale = min(_LARGEST / (2.0 * half.max()), 0.5 * _LARGEST / (2.0 * half.min()))
        width, height = np.maximum(2.0 * half * scale, _SMALLEST)
        title = f"{run_title(run, int(_LETTERS * width))}\n{words}"
        top = 0.15 + 0.15 * len(title.splitlines())
        # whole and even numbers of pixels, which films need
        size = np.ceil(np.array([width, height + top]) * _PIXELS / 2.0) * 2.0 / _PIXELS
        self.figure = Figure(figsize=size, dpi=_PIXELS)
        self.canvas = FigureCanvasAgg(self.figure)
        axes = self.figure.add_axes((0.0, 0.0, 1.0, height / (height + top)))
        reach = np.maximum(half, 0.5 * np.array([width, height]) / scale)
        (left, bottom), (right, top) = middle - reach, middle + reach
        axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
        axes.set_axis_off()
        self._blocks = axes.add_collection(PolyCollection([], linewidths=0.6, edgecolors=DARK_GREY))
        self.figure.text(0.5, 0.99, title, ha="center", va="top", fontsize=7.5)
        self._clock = axes.text(0.02, 0.99, "", transform=axes.transAxes, va="top", fontsize=8.0)

    def draw(self, frame, time):
        """Move the blocks and the clock."""
        outlines, bodies, light = self._scene.faces(*(poses[frame] for poses in self._poses))
        self._blocks.set_verts(outlines)
        self._blocks.set_facecolor(self._colors[bodies] * np.array(light)[:, None])
        self._clock.set_text(f"t = {time:.2f} s")

    def picture(self):
        """The frame as pixels."""
        self.canvas.draw()
        return Image.fromarray(np.asarray(self.canvas.buffer_rgba())).convert("RGB")


def _frames(film, times):
    """Draw one frame after the other and say how far it is."""
    news = Due(_NEWS_EVERY)
    for frame, time in enumerate(times):
        film.draw(frame, time)
        yield
        if news():
            _log.info("%d of %d frames", frame + 1, len(times))


def _write_gif(path, film, times):
    """One palette for all frames, made from the first; one frame in memory at a time."""

    def pictures():
        palette = None
        for _ in _frames(film, times):
            picture = film.picture()
            palette = palette or picture.quantize(128, dither=Image.Dither.NONE)
            yield picture.quantize(palette=palette, dither=Image.Dither.NONE)

    frames = pictures()
    duration = round(1000.0 / FRAME_RATE)
    next(frames).save(path, format="GIF", save_all=True, append_images=frames, duration=duration, loop=0)


def _write_mp4(path, film, times):
    writer = FFMpegWriter(fps=FRAME_RATE, metadata={"comment": "made by blockshake"})
    with writer.saving(film.figure, str(path), _PIXELS):
        for _ in _frames(film, times):
            writer.grab_frame()
