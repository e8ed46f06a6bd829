"""Faults of the markers of one body, named one after the other by the residual that each leaves in the rigid fit."""

from typing import NamedTuple

import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial.transform import Rotation

from blockshake.measurement.motion.body_frame import outlying
from blockshake.parity.kinds import drift, gain, wrong_place
from blockshake.parity.kinds.kind import Column
from blockshake.parity.linear_faults import Equations, Unknowns, coloured_variance, name_faults

_FAULTLESS_MARKERS = 2  # of a body, that must be left without a fault, or nothing states which is at fault
_MOST_FAULTS = 8  # faults on one body
_LINEARISATIONS = 4
_BRACKET = 0.1  # m, by which a marker may stand off its body
_WEAK_LEVER = 0.1  # lever of the markers about an axis, over the largest: the turn about it is mostly noise
_TURNS = 2.0  # standard deviations: of less the turn about an axis is taken to be noise as well
_SMOOTHING = 101  # readings, half a second, over which such a turn is averaged
_SEGMENT = 40  # readings over which coloured noise averages out, 0.2 s at 200 Hz
# m, of the first reading's own error: as good as unknown, and no fault
_CONSTANT = Column(None, 3, 1e-2, lambda seen: np.eye(3)[None, None], by_test=True)


class MarkerCheck(NamedTuple):
    """Findings of one body; standard deviation of each marker's reading [m], after they are taken out and before."""

    findings: tuple
    noise: np.ndarray
    misfit: np.ndarray


class _Seen(NamedTuple):
    """Body in one test: what the signatures of faults are made of.

    ``scale`` (n_times,) runs from -1/2 to 1/2 over the record; ``back`` (n_times, 3, 3) turns into the body's frame;
    ``moved`` (n_times, n_markers, 3) are the markers' displacements in the body's frame [m]; ``turned`` (n_times, 3, 3)
    is the start's orientation, seen from the body.
    """

    scale: np.ndarray
    back: np.ndarray
    moved: np.ndarray
    turned: np.ndarray


def hypotheses(body):
    """Number of faults that are looked at: a gain and a place of every marker, and a drift in each test."""
    return len(body.markers) * (2 + len(body.tests))


def check_body(body, marker_noise, level):
    """`MarkerCheck`: name the faults of a body's markers, the clearest first, until the rest is within tolerances.

    Parameters
    ----------
    body : BodyMarkers
        Without outliers.
    marker_noise : float
        Stated standard deviation [m]: the drift over a record that is tolerated.
    level : Level

    Notes
    -----
    In the body's frame with rotation R(t) and start R0, what remains of a reading is P applied to the sum over the
    markers of ``c + R' s d + R' u g + (1 - R' R0) e`` with constant c, drift d over the record (s from -1/2 to 1/2),
    gain g of the displacement u and place e: a gain follows the displacement, a wrong place follows the rotation and is
    nothing before it. A place off the body is none. The equations are made anew about the faults that were named.
    """
    creep = drift.of_marker(marker_noise)
    columns = creep, gain.OF_MARKER, wrong_place.OF_MARKER
    unknowns = Unknowns((_CONSTANT, *columns), len(body.markers), len(body.tests))
    faults = {fault: (unknowns.of(fault), 1) for column in columns for fault in unknowns.faults(column)}
    sizes, made = np.zeros(len(unknowns.spread)), {}

    def equations_of(named, spread):
        equations, *made["noise"] = _linearised(body, unknowns, sizes, faults, marker_noise)
        for _ in range(_LINEARISATIONS if named else 0):
            numbers = np.concatenate([unknowns.of(fault) for fault in named])
            sizes[numbers] += equations.posterior(spread)[0][numbers]
            equations, *made["noise"] = _linearised(body, unknowns, sizes, faults, marker_noise)
        return equations

    def on_the_body(fault, estimate):
        place = body.points[fault.sensor] + estimate
        within = (body.box[0] - _BRACKET <= place) & (place <= body.box[1] + _BRACKET)
        return fault.column is not wrong_place.OF_MARKER or bool(within.all())

    named, equations, spread = name_faults(
        equations_of, unknowns, level, body.markers, _MOST_FAULTS, _FAULTLESS_MARKERS, on_the_body
    )
    covariance, findings = equations.posterior(spread)[1] if named else None, []
    for fault, p in named.items():
        numbers, by_test = unknowns.of(fault), fault.column is creep
        if not on_the_body(fault, sizes[numbers]):  # moved there by a fault that was named later
            continue
        tests = (body.tests[fault.test],) if by_test else body.tests
        length = np.ptp(body.readings[fault.test][0]) if by_test else 1.0
        square = covariance[np.ix_(numbers, numbers)] / length**2
        kind, where = fault.column.kind, (body.markers[fault.sensor],)
        findings.append(kind.finding(where, p, tests, sizes[numbers] / length, square))
    return MarkerCheck(tuple(findings), *made["noise"])


def _linearised(body, unknowns, sizes, faults, marker_noise):
    """`Equations` about faults of these sizes, and the noise and misfit of every marker [m]."""
    normal, right, kept = np.zeros((len(sizes), len(sizes))), np.zeros(len(sizes)), []
    for test in range(len(body.tests)):
        design, residual, projector = _one_test(body, unknowns, sizes, test, marker_noise)
        numbers, flat = unknowns.of_test(test), design.reshape(-1, design.shape[2])
        normal[np.ix_(numbers, numbers)] += flat.T @ flat
        right[numbers] += flat.T @ residual.ravel()
        kept.append((numbers, design, residual, projector))
    ridge = 1e-9 * np.diag(np.diagonal(normal)) + 1e-12 * np.eye(len(sizes))
    free = np.linalg.lstsq(normal + ridge, right, rcond=None)[0]
    rest = [residual - design @ free[numbers] for numbers, design, residual, _ in kept]
    before = [residual - residual.mean(axis=0) for _, _, residual, _ in kept if len(residual)]
    # a reading's own share of what the rigid fit leaves
    shares = sum(np.diagonal(projector, axis1=1, axis2=2).sum(axis=0) for *_, projector in kept)
    variance = coloured_variance(rest, shares.sum(), _SEGMENT)
    shares = np.maximum(shares.reshape(-1, 3).sum(axis=1), 1e-9)
    noise, misfit = (
        np.sqrt(
            sum((residual.reshape(-1, *body.points.shape) ** 2).sum(axis=(0, 2)) for residual in parts)
            / shares
        )
        if np.isfinite(variance)
        else np.full(len(shares), np.nan)
        for parts in (rest, before)
    )
    return Equations(normal, right, variance, faults), noise, misfit


def _one_test(body, unknowns, sizes, test, marker_noise):
    """Columns, residual and projector of one test, over the noise by axis, of the times at which the body stands."""
    body = body.in_test(test)
    ((time, displacement),) = body.readings
    scale = (time - time[0]) / (time[-1] - time[0]) - 0.5
    creep, gains, places = (sizes[numbers] for _, numbers in list(unknowns.numbers.items())[1:])
    displacement = (displacement - scale[:, None, None] * creep[test]) / (1.0 + gains[0])
    pose = body.frame(displacement, places[0])
    used = np.flatnonzero(
        pose.projector.any(axis=(1, 2))
        & ~outlying(pose.residual).any(axis=1)  # next to one that is a gap
        & body.upright(pose.rotation)
    )
    points = body.points + places[0]
    rotation = _steadied(points, pose.rotation[used], body.rotation, marker_noise)
    moved = pose.position[used, None] + np.einsum("tij,mj->tmi", rotation, points)
    moved = moved - (body.position + points @ body.rotation.T)
    back = rotation.transpose(0, 2, 1)
    seen = _Seen(scale[used], back, moved @ rotation, back @ body.rotation)
    same, signatures = np.eye(len(points)), []
    for column in unknowns.numbers:
        of_each = column.signature(seen)[:, :, :, None] * same[:, None, :, None]
        of_each = np.broadcast_to(of_each, (len(used), *of_each.shape[1:]))
        signatures.append(of_each.reshape(len(used), 3 * len(points), column.components * len(points)))
    projector, scale = pose.projector[used], np.tile(body.noise, len(points))
    residual = np.nan_to_num(pose.residual[used]).reshape(len(used), 3 * len(points)) / scale
    design = projector @ (np.concatenate(signatures, axis=-1) / scale[:, None])
    return design, np.einsum("tij,tj->ti", projector, residual), projector


def _steadied(points, rotation, start_rotation, marker_noise):
    """Rotations whose turn is averaged over time about an axis through nearly all markers, or about which none is seen.

    Its noise would enter the signatures and make every estimate that rests on it too small.
    """
    arms = points - points.mean(axis=0)
    lever, axes = np.linalg.eigh((arms**2).sum() * np.eye(3) - arms.T @ arms)
    if not len(rotation):
        return rotation
    vectors = Rotation.from_matrix(np.einsum("ji,tjk->tik", start_rotation, rotation)).as_rotvec()
    turns = ((vectors @ axes) ** 2).mean(axis=0) * lever > (_TURNS * marker_noise) ** 2
    weak = axes[:, ~turns | (lever < _WEAK_LEVER**2 * lever.max())]
    about = vectors @ weak
    steady = uniform_filter1d(about, _SMOOTHING, axis=0, mode="nearest")
    return start_rotation @ Rotation.from_rotvec(vectors + (steady - about) @ weak.T).as_matrix()
