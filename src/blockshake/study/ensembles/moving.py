"""Blocks of samples in space against the measured markers, moving in the page; the print has a still of them."""

import base64
import json

import numpy as np
from scipy.spatial.transform import Rotation

from blockshake.measurement.sensors.markers import marker_bodies
from blockshake.pages.drawing import RED, column_title, new_figure
from blockshake.pages.scene.bodies import body_colors, body_mesh
from blockshake.pages.scene.projection import VIEWS, Scene
from blockshake.pages.scene.structure_picture import draw_blocks
from blockshake.pages.wording import given, millimetres, model_label
from blockshake.study.ensembles.shown_samples import shown_markers

MAGNIFICATIONS = (1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
_LARGEST_SHARE = 0.1  # of the height of the highest mass centre over the lowest: displacement in the still
_FINEST = 1e-5  # m and rad, of the whole numbers of the positions
_MOST = 32767  # a whole number of two bytes
_NONE = -32768  # where no marker was read


def usual_magnification(case):
    """Magnification at which the median samples of a case are well seen: the largest that keeps them in the picture."""
    height = float(np.ptp(case.structure.position[:, 2]))
    peaks = [float(one.shown["peak"][0]) for one in case.responses.values() if one.shown.sizes["sample"]]
    room = [one for one in MAGNIFICATIONS if one * max(peaks, default=0.0) <= _LARGEST_SHARE * height]
    return max(room, default=1.0)


def moving_samples(case):
    """JSON of the bodies of a case, of the motion of its shown samples and of the measured markers.

    Lengths are in m and angles in rad; motions are whole numbers of two bytes, little endian, in base 64, times their
    ``unit``.
    """
    shown = {model: one.shown for model, one in case.responses.items()}
    times = next(iter(shown.values()))["time"].to_numpy()
    colors = body_colors(case.structure)
    bodies = []
    for body in range(len(colors)):
        mesh = body_mesh(case.structure, body)
        bodies.append({
            "place": _rounded(mesh.place), "arms": _rounded(mesh.arms), "faces": mesh.faces,
            "color": _rounded(colors[body]),
        })  # fmt: skip
    samples = [
        {
            "label": _label(model, one),
            "shift": _packed(one["shift"].transpose("time", "body", "axis").to_numpy()),
            "turn": _packed(one["turn"].transpose("time", "body", "axis").to_numpy()),
        }
        for model, of_model in shown.items()
        for one in (of_model.isel(sample=index) for index in range(of_model.sizes["sample"]))
    ]
    measured = None
    if case.test is not None:
        read = shown_markers(case.test, times)
        carriers, arms = _markers(case.structure, read["marker"].values)
        measured = {
            "label": case.curve_word, "bodies": carriers.tolist(), "arms": _rounded(arms),
            "shift": _packed(read.to_numpy()),
        }  # fmt: skip
    moving = {
        "step": float(times[1] - times[0]), "frames": len(times), "magnification": usual_magnification(case),
        "bodies": bodies, "samples": samples, "measured": measured,
    }  # fmt: skip
    return json.dumps(moving, separators=(",", ":"))


def plot_still(case):
    """Figure of the median sample by every model at its largest displacement along x, with the measured markers.

    Magnified as `usual_magnification` states; markers on faces that look away are left out.
    """
    magnification = usual_magnification(case)
    scene = Scene(case.structure, "3d")
    found = {model: one.shown for model, one in case.responses.items() if one.shown.sizes["sample"]}
    figure = new_figure(0.075)
    panels = figure.subplots(1, len(found), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (model, shown) in zip(panels, found.items(), strict=True):
        # the first shown is the median one
        one = shown.isel(sample=0).transpose("time", "body", "axis")
        frame = int(np.abs(one["shift"].sel(axis="x")).max("body").argmax("time"))
        draw_blocks(axes, scene, case.structure, *_moved(case.structure, one.isel(time=frame), magnification))
        if case.test is not None:
            _draw_markers(axes, scene, case, one["time"].to_numpy()[frame], magnification)
        words = f"{model_label(model)}\nsample {int(one['sample'])} at {float(one['time'][frame]):.2f} s"
        axes.set_title(column_title(words, len(found)))
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.set_axis_off()
    return figure


def _moved(structure, pose, magnification):
    """Places and orientations of the bodies at a magnified pose."""
    turn = Rotation.from_rotvec(magnification * pose["turn"].to_numpy())
    turned = turn * Rotation.from_quat(structure.orientation, scalar_first=True)
    return structure.position + magnification * pose["shift"].to_numpy(), turned.as_quat(scalar_first=True)


def _draw_markers(axes, scene, case, time, magnification):
    read = shown_markers(case.test, np.array([time]))
    carriers, arms = _markers(case.structure, read["marker"].values)
    moved = magnification * read.isel(time=0).to_numpy()
    seen = scene.seen(case.structure.position[carriers] + arms + moved)[arms @ VIEWS["3d"][2] > 0.0]
    axes.plot(seen[:, 0], seen[:, 1], "o", color=RED, markersize=1.6, markeredgewidth=0.0)


def _markers(structure, names):
    """Bodies that carry markers, by index, and the markers seen from their mass centres, world axes [m]."""
    listed = [marker.name for marker in structure.file.markers]
    rows = [listed.index(str(name)) for name in names]
    carriers = np.array([structure.body_names.index(body) for body in marker_bodies(structure, names)])
    turn = Rotation.from_quat(structure.orientation[carriers], scalar_first=True)
    return carriers, turn.apply(structure.arms(structure.file.markers)[rows])


def _label(model, one):
    words = f"{model_label(model)}, sample {int(one['sample'])}: {one['chosen'].item()}, {millimetres(one['peak'])} mm"
    ended = one["status"].item()
    return (
        words if ended == "completed" else f"{words}, {ended} at {given(round(float(one['end_time']), 2))} s"
    )


def _packed(values):
    """Values as whole numbers of two bytes and their unit, fine enough that nothing is seen of it."""
    finite = np.isfinite(values)
    unit = max(_FINEST, float(np.abs(values[finite]).max(initial=0.0)) / _MOST)
    whole = np.where(finite, np.round(np.where(finite, values, 0.0) / unit), _NONE)
    return {"unit": unit, "data": base64.b64encode(whole.astype("<i2").tobytes()).decode()}


def _rounded(values):
    return np.round(values, 4).tolist()
