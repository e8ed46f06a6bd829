"""Measured laws held against those of nominal draws, test by test and over all tests."""

import numpy as np
from scipy.stats import t as student

from blockshake.diagnosis.laws.findings import LawFinding, LawFindings
from blockshake.diagnosis.laws.law_table import kind_of, law_of
from blockshake.diagnosis.laws.null_laws import null_laws, tamed, tamed_error
from blockshake.diagnosis.laws.signatures import ECCENTRIC, OF_A_STOP, OF_ANY, OUTSIDE, SIGNATURES, STOP

_BROKEN_ONCE = 7.0  # standard deviations, in one test
_BROKEN = 5.0  # of the sum over all tests, in its standard deviation
_ODD = 4.0  # of a law in a test whose readings ask for a force from outside
_HOLDS = 3.0
_LEANS = 3.0  # of the sum over all tests, towards an effect
_LEAST_GAP = 2e-3  # m, of a stop
_FREEDOM = 10  # of the tail, for null distributions of some ten to twenty draws
_ALIKE = 4.0  # standard deviations that sizes of one cause may differ by from test to test
FORM = 0.15  # share of a size by which tests may differ in what a law's form leaves out


def judge_laws(measured, draws, outside):
    """Laws of a campaign.

    Parameters
    ----------
    measured : dict of str to xarray.Dataset
        By open test: from `read_laws`.
    draws : dict of str to float64 array, shape (n_draws, n_laws)
        By open test: laws of nominal draws by all solvers, in the order of the measured ones.
    outside : OutsideForce or None
        From `outside_force`, of these tests.

    Returns
    -------
    LawFindings
    """
    departures, places = {}, {}
    for test, own in measured.items():
        names = [str(name) for name in own["law"].values]
        nulls = null_laws(names, draws[test])
        for place, name in enumerate(names):
            value, error = float(own["law_value"][place]), float(own["law_error"][place])
            if name in nulls and np.isfinite(value):
                departures.setdefault(name, {})[test] = (value, error, nulls[name])
                joint, beneath = (own[key].values[place].item() for key in ("law_joint", "law_beneath"))
                places[name] = {"joint": joint, "beneath": beneath}
    laws = sorted(
        (_law(name, by_test, **places[name]) for name, by_test in departures.items()),
        key=lambda one: -_largest(one),
    )
    outside = outside if outside and _needed(outside, laws) else None
    isolated = tuple(effect for effect in SIGNATURES if _isolates(effect, laws))
    if outside and outside.law != "steady":
        isolated = tuple(effect for effect in isolated if effect != ECCENTRIC)
    if not isolated and outside and _is_stop(outside, laws):
        isolated = (STOP,)
    return LawFindings(
        laws=tuple(laws),
        isolated=isolated,
        outside=None if isolated else outside,
        outside_of_stop=outside if isolated == (STOP,) else None,
        p=_chance(laws),
    )


def accounts_for(effect, findings):
    """Whether the laws that are broken are among those that an effect may break.

    Parameters
    ----------
    effect : str
    findings : LawFindings

    Returns
    -------
    bool
        A contact with a stop accounts for a force from outside that comes and goes, and for no other. No effect
        accounts for a law of its own that is broken unlike in the tests.
    """
    if effect == STOP:
        kinds, forces = OF_A_STOP, ("spring", "pulse")
    elif effect in SIGNATURES:
        kinds, forces = (SIGNATURES[effect].own, *SIGNATURES[effect].others), ("steady",)
    else:
        kinds, forces = OF_ANY, ()
    if findings.outside and findings.outside.law not in forces:
        return False
    if effect in SIGNATURES and not all(_alike(one) for one in own_laws(effect, findings.laws) if one.broken):
        return False
    return all(kind_of(one.name) in kinds for one in findings.broken)


def law_that_holds(effect, place, findings):
    """Name of an effect's own law that was told at a place and holds, so that the effect is not there; else empty.

    Parameters
    ----------
    effect : str
    place : dict
        In the structure, with a ``joint``, a ``body`` or neither.
    findings : LawFindings

    Returns
    -------
    str
        Of a body the joint beneath all bodies tells, as that joint carries it.
    """
    if effect not in SIGNATURES or not SIGNATURES[effect].excludes:
        return ""
    told = [one for one in own_laws(effect, findings.laws) if _at(place, one)]
    if not told or any(_largest(one) > _HOLDS for one in told):
        return ""
    return told[0].name


def leans_to(effect, place, findings):
    """Whether an effect's own law departs its way at a place, if only a little.

    Parameters
    ----------
    effect : str
    place : dict
        As in `law_that_holds`.
    findings : LawFindings

    Returns
    -------
    bool
        True for an effect that has no law of its own, and where no joint's law is told, as under a block that bridges
        two walls. A stop has the force that it exerts.
    """
    if effect == STOP:
        return (findings.outside or findings.outside_of_stop) is not None
    if effect not in SIGNATURES or not any(one.joint for one in findings.laws):
        return True
    sign = SIGNATURES[effect].sign
    sums = [_sum(list(one.departures.values())) for one in own_laws(effect, findings.laws) if _at(place, one)]
    return any((sign * one if sign else abs(one)) > _LEANS for one in sums)


def _at(place, law):
    """Whether a law tells of a place; of one that is nowhere in particular every law does."""
    if "joint" in place:
        return law.joint in ("-".join(place["joint"]), "-".join(reversed(place["joint"])))
    return law.beneath or "body" not in place


def _law(name, by_test, joint, beneath):
    """One law over the tests."""
    rows = {}
    for test, (value, error, null) in by_test.items():
        own = tamed_error(name, value, error) if np.isfinite(error) else 0.0
        rows[test] = (tamed(name, value) - null.mean, float(np.hypot(null.spread, own)))
    away, spread = np.array(list(rows.values())).T
    weight = spread**-2
    return LawFinding(
        name=name,
        unit=law_of(name).unit,
        joint=joint,
        beneath=beneath,
        value=float(weight @ away / weight.sum()),
        error=float(weight.sum() ** -0.5),
        measured={test: value for test, (value, _, _) in by_test.items()},
        expected={test: null.mean for test, (_, _, null) in by_test.items()},
        departures={test: float(one / sigma) for test, (one, sigma) in rows.items()},
        broken=_is_broken(name, away / spread),
    )


def _is_broken(name, departures):
    """Whether departures from a law are too large, in one test or over all."""
    if law_of(name).least:
        departures = np.maximum(departures, 0.0)
    return bool(np.abs(departures).max() > _BROKEN_ONCE or abs(_sum(departures)) > _BROKEN)


def _sum(departures):
    departures = np.asarray(departures)
    return float(departures.sum() / np.sqrt(len(departures)))


def _largest(law):
    own = np.array(list(law.departures.values()))
    own = np.maximum(own, 0.0) if law_of(law.name).least else own
    return max(np.abs(own).max(), abs(_sum(own)))


def _needed(outside, laws):
    """Whether some test that shows the force departs from the nominal model in a law that such a force moves."""
    return any(
        abs(one.departures.get(test, 0.0)) > _ODD
        for one in laws
        if kind_of(one.name) in OUTSIDE
        for test in outside.tests
    )


def _is_stop(outside, laws):
    """Whether a force is that of a stop: a spring beyond a gap, on the same side in all tests."""
    if outside.law != "spring" or any(test["gap"] < _LEAST_GAP for test in outside.tests.values()):
        return False
    if len({test["side"] for test in outside.tests.values()}) > 1:
        return False
    return all(kind_of(one.name) in OF_A_STOP for one in laws if one.broken)


def own_laws(effect, laws):
    """Laws of an effect's own kind."""
    return [one for one in laws if kind_of(one.name) == SIGNATURES[effect].own]


def _isolates(effect, laws):
    """Whether an effect's own law is broken its way, alike in all tests, and all broken laws are among its others."""
    signature = SIGNATURES[effect]
    own = [one for one in own_laws(effect, laws) if one.broken]
    if not own or any(signature.sign * one.value < 0.0 for one in own):
        return False
    if not all(_alike(one) for one in own):
        return False
    return all(kind_of(one.name) in (signature.own, *signature.others) for one in laws if one.broken)


def _alike(law):
    """Whether the tests agree on the size of a departure: each with the mean of the others."""
    own = np.array([tamed(law.name, value) for value in law.measured.values()])
    own = own - np.array(list(law.expected.values()))
    sigma = np.abs(own) / np.maximum(np.abs(list(law.departures.values())), 1e-9)
    sigma = np.hypot(sigma, FORM * np.abs(own))
    for test in range(len(own)):
        others = np.arange(len(own)) != test
        if not others.any():
            continue
        weight = sigma[others] ** -2
        apart = own[test] - weight @ own[others] / weight.sum()
        if abs(apart) > _ALIKE * np.hypot(sigma[test], weight.sum() ** -0.5):
            return False
    return True


def _chance(laws):
    """Chance of the largest departure over all laws and tests, at most."""
    largest = max((_largest(one) for one in laws), default=0.0)
    return float(min(1.0, 2.0 * student.sf(largest, _FREEDOM) * max(len(laws), 1)))
