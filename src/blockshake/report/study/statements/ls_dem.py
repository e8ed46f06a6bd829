"""Statements on LS-DEM: its equations, its discretisation and its steps."""

import numpy as np

from blockshake.report.document.wording import MISSING, given, model_label, number
from blockshake.report.study.statements.statement import judged, missing, setting, unjudged
from blockshake.solvers.ls_dem.contact.contact_law import Law, kept_stretch, normal_force, trial_stretch
from blockshake.solvers.ls_dem.interfaces import damping_ratio
from blockshake.study.ensembles.outcomes import numerical_figure

_STIFFNESS, _FRICTION = 2.0e6, 0.75  # N/m and 1, of the node at which the equations are evaluated
_DEPTH, _CLOSING = 1e-3, 0.05  # m, m/s
_SAME = 1e-9  # relative difference of two values that are one and the same


def level_set(content):
    """Eq. (1), sampled on a lattice."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    kind, spacing = (setting(content, "ls-dem", f"ls_dem.{name}") for name in ("level_set", "grid_spacing"))
    if kind == "exact":
        return judged(False, "The distance to a box is taken by its formula, which has no lattice.")
    return judged(spacing == 0.02, f"The lattice of the distance has a spacing of {given(spacing)} m.")


def node_spacing(content):
    """Surface nodes."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    spacing = setting(content, "ls-dem", "ls_dem.node_spacing")
    return judged(spacing == 0.2, f"The aimed spacing of the nodes is {given(spacing)} m.")


def normal_law(content):
    """Eq. (2), which pulls where the dashpot outweighs the spring."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    pulling = setting(content, "ls-dem", "ls_dem.pulling")
    restitution = next(iter(content.cases.values())).structure.file.restitution
    ratio = damping_ratio(restitution)
    spring, least = _STIFFNESS * _DEPTH, -np.inf if pulling else 0.0
    dashpot = 1.5 * spring / _CLOSING
    shares = [
        _plain(normal_force)(-_DEPTH, 1.0, closing, _STIFFNESS, dashpot, least) / (spring - dashpot * closing)
        + 0.0
        for closing in (-_CLOSING, _CLOSING)
    ]
    words = (
        f"The force of a node is {number(shares[0])} times that of the equation where the dashpot presses, and "
        f"{number(shares[1])} times where it outweighs the spring and would pull."
    )
    if not pulling and ratio < 1.0:
        words += (
            f" A flat impact at C_res {given(restitution)} rebounds at {number(rebound_without_pull(ratio))} "
            "of its velocity where nothing pulls."
        )
    return judged(all(abs(share - 1.0) < _SAME for share in shares), words)


def rebound_without_pull(ratio):
    """Rebound over impact velocity of a mass on a spring and a dashpot that do not pull [1].

    ``ratio``: fraction of critical damping, below 1. Schwager and Poeschel (2007), Granular Matter 9, 465: the contact
    ends where the force, not the depth, is zero again.
    """
    frequency = np.sqrt(1.0 - ratio**2)
    phase = np.arctan2(2.0 * ratio * frequency, frequency**2 - ratio**2)
    return float(np.exp(-ratio / frequency * (np.pi - phase)))


def damping(content):
    """Eq. (3), for each node or interface: never with the mass of one block alone."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    of = setting(content, "ls-dem", "ls_dem.damping")
    restitution = sorted({case.structure.file.restitution for case in content.cases.values()})
    ratios = ", ".join(f"{number(damping_ratio(one))} for C_res {given(one)}" for one in restitution)
    return judged(
        False,
        f"The dashpot is that of each {of}, with the reduced mass of the two bodies, half of it on each side; its "
        f"ratio to critical is {ratios}.",
    )


def shear_law(content):
    """Eqs. (4) and (5)."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    normal = _STIFFNESS * _DEPTH
    law = Law(_STIFFNESS, _STIFFNESS, 0.0, _FRICTION, 0.0, 0.0, 0.0, 0.0, 0.0)
    shares = []
    for moved in (0.5 * _DEPTH, 2.0 * _DEPTH):
        # a step along x and toward the other body, whose normal is z: the stretch takes up the tangential part alone
        stretch, *rest = _plain(trial_stretch)(0.0, 0.0, 0.0, moved, 0.0, -_DEPTH, 0.0, 0.0, 1.0)
        kept, _ = _plain(kept_stretch)(stretch, *rest[:2], normal, _STIFFNESS, law)
        shares.append(kept * _STIFFNESS * stretch / min(_FRICTION * normal, _STIFFNESS * moved))
    ratio = setting(content, "ls-dem", "ls_dem.shear_damping_ratio")
    words = (
        f"The force of a shear spring is {number(shares[0])} times that of the equations below Coulomb's limit and "
        f"{number(shares[1])} times beyond it; the ratio of a dashpot beside the spring is {given(ratio)}."
    )
    return judged(all(abs(one - 1.0) < _SAME for one in shares) and ratio == 0.0, words)


def stable_step(content):
    """Eq. (6) and the explicit scheme with a step that is stable."""
    if absent := missing(content, "ls-dem"):
        return unjudged(absent)
    samples = [case.responses["ls-dem"].samples for case in content.cases.values()]
    step = content.study["models"]["ls-dem"]["time_step"]
    limit = min(numerical_figure(one, "numerics_stable_time_step", np.min) for one in samples)
    residual = max(numerical_figure(one, "energy_residual", np.max) for one in samples)
    if not np.isfinite(limit):
        return unjudged("The runs of this study do not say which step is stable.")
    return judged(
        step <= limit,
        f"The step is {given(step)} s, and the smallest limit of stability among the samples, with the joints of "
        f"the start, is {number(limit)} s. "
        f"The energy audit, in which forces and moments work, misses {number(residual)} of the energy in play at most.",
    )


def time_step(content, model, printed):
    """Step of a model."""
    if absent := missing(content, model):
        return unjudged(absent)
    alike = [name for name in content.study["models"] if name.split("-")[0] == model.split("-")[0]]
    steps = {content.study["models"][name]["time_step"] for name in alike}
    residuals = [
        numerical_figure(case.responses[model].samples, "energy_residual", np.max)
        for case in content.cases.values()
    ]
    known = [one for one in residuals if np.isfinite(one)]
    missed = number(max(known)) if known else MISSING
    parts = setting(content, model, "nscd.impact_parts") if model == "nscd-rigid" else 1
    split = f", {given(parts)} times shorter where bodies meet" if parts > 1 else ""
    return judged(
        all(abs(one / printed - 1.0) < _SAME for one in steps) and parts == 1,
        f"The step is {' and '.join(map(given, sorted(steps)))} s{split}; the energy "
        f"residual of {model_label(model)} is {missed} at most.",
    )


def _plain(function):
    """The Python function of a kernel."""
    return getattr(function, "py_func", function)
