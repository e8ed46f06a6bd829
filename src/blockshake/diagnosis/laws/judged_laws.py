"""Measured laws held against those of nominal draws, test by test and over all tests."""

import numpy as np
from scipy.stats import t as student

from blockshake.diagnosis.laws.findings import LawFinding, LawFindings
from blockshake.diagnosis.laws.law_table import kind_of, law_of
from blockshake.diagnosis.laws.mean_of_tests import FORM
from blockshake.diagnosis.laws.null_laws import (
    covariance,
    null_laws,
    tamed,
    tamed_error,
    untamed,
    untamed_error,
)
from blockshake.diagnosis.laws.signatures import ECCENTRIC, OF_A_STOP, OF_ANY, SIGNATURES, STOP

BROKEN_ONCE = 7.0  # standard deviations, in one test
BROKEN = 5.0  # of the sum over all tests, in its standard deviation
_HOLDS = 3.0
_LEANS = 3.0  # of the sum over all tests, towards an effect
_LEAST_GAP = 2e-3  # m, of a stop
_FREEDOM = 10  # of the tail, for null distributions of some ten to twenty draws
_ALIKE = 4.0  # standard deviations that sizes of one cause may differ by from test to test
_SURE = 5.0  # standard deviations: an effect of the visible size stays within `_HOLDS` in 2 % of the tests


def judge_laws(measured, draws, outside, shares):
    """Laws of a campaign.

    Parameters
    ----------
    measured : dict of str to xarray.Dataset
        By open test: from `read_laws`.
    draws : dict of str to float64 array, shape (n_draws, n_laws)
        By open test: laws of nominal draws by all solvers, in the order of the measured ones.
    outside : OutsideForce or None
        From `outside_force`, of these tests.
    shares : dict of str to float
        By free body: its share of the weight of all of them [1].

    Returns
    -------
    LawFindings
    """
    departures, places, readable = {}, {}, set()
    for test, own in measured.items():
        names = [str(name) for name in own["law"].values]
        nulls = null_laws(names, draws[test])
        readable |= set(nulls)
        for place, name in enumerate(names):
            value, error = float(own["law_value"][place]), float(own["law_error"][place])
            if name in nulls and np.isfinite(value):
                departures.setdefault(name, {})[test] = (value, error, nulls[name])
                joint, beneath = (own[key].values[place].item() for key in ("law_joint", "law_beneath"))
                places[name] = {"joint": joint, "beneath": beneath}
    told = [_law(name, by_test, **places[name]) for name, by_test in departures.items()]
    laws = sorted((one for one in told if law_of(one.name).judged), key=lambda one: -_largest(one))
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
        readable=tuple(sorted(readable)),
        shown=tuple(one for one in told if not law_of(one.name).judged),
        shares=shares,
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
        kinds, forces = OF_A_STOP, ("spring",)
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
    """Name of an effect's own law that is told at a place and holds, so that the effect is not there; else empty.

    Parameters
    ----------
    effect : str
    place : dict
        In the structure, with a ``joint``, a ``body`` or neither.
    findings : LawFindings

    Returns
    -------
    str
        Of a body the joint beneath all bodies tells, as that joint carries it. A law that is told too roughly to show
        the effect at its visible size excludes nothing.
    """
    if effect not in SIGNATURES or not SIGNATURES[effect].excludes:
        return ""
    told = [one for one in own_laws(effect, findings.laws) if _at(place, one)]
    if not told or any(_largest(one) > _HOLDS for one in told):
        return ""
    return next((one.name for one in told if _shows(one, SIGNATURES[effect].excludes)), "")


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
        True for an effect that has no law of its own, or none that nominal tests of the structure tell, and where no
        joint's law is told, as under a block that bridges two walls. A stop has the force that it exerts.
    """
    if effect == STOP:
        return (findings.outside or findings.outside_of_stop) is not None
    if effect not in SIGNATURES or not any(one.joint for one in findings.laws):
        return True
    own, sign = SIGNATURES[effect].own, SIGNATURES[effect].sign
    if not any(kind_of(name) == own for name in findings.readable):
        return True
    sums = [one.together for one in own_laws(effect, findings.laws) if _at(place, one)]
    return any((sign * one if sign else abs(one)) > _LEANS for one in sums)


def is_told(effect, place, findings):
    """Whether a measured test tells an effect's own law at a place; arguments as in `law_that_holds`."""
    return any(_at(place, one) for one in own_laws(effect, findings.laws))


def _shows(law, visible):
    """Whether some test tells a law so well that a departure by ``visible``, in the law's unit, would be seen."""
    for test, expected in law.expected.items():
        nominal = untamed(law.name, expected)
        shifted = tamed(law.name, nominal + visible)
        error = np.hypot(tamed_error(law.name, nominal + visible, law.errors[test]), law.spreads[test])
        if abs(shifted - expected) > _SURE * error:
            return True
    return False


def _at(place, law):
    """Whether a law tells of a place; of one that is nowhere in particular every law does."""
    if "joint" in place:
        return law.joint in ("-".join(place["joint"]), "-".join(reversed(place["joint"])))
    return law.beneath or "body" not in place


def _law(name, by_test, joint, beneath):
    """One law over the tests."""
    nulls = [null for _, _, null in by_test.values()]
    errors = {test: error if np.isfinite(error) else 0.0 for test, (_, error, _) in by_test.items()}
    own = np.array([tamed_error(name, value, errors[test]) for test, (value, _, _) in by_test.items()])
    away = np.array([tamed(name, value) - null.mean for value, _, null in by_test.values()])
    shared = covariance(nulls) + np.diag(own**2)
    spread = np.sqrt(np.diag(shared))
    departures = _counted(name, away / spread)
    together = float(departures.sum() / np.sqrt((shared / np.outer(spread, spread)).sum()))
    weight = spread**-2 / (spread**-2).sum()
    return LawFinding(
        name=name,
        unit=law_of(name).unit,
        joint=joint,
        beneath=beneath,
        value=float(weight @ away),
        error=float(np.sqrt(weight @ shared @ weight)),
        measured={test: value for test, (value, _, _) in by_test.items()},
        errors=errors,
        expected=dict(zip(by_test, (null.mean for null in nulls), strict=True)),
        spreads=dict(zip(by_test, (null.spread for null in nulls), strict=True)),
        departures=dict(zip(by_test, (away / spread).tolist(), strict=True)),
        together=together,
        broken=bool(np.abs(departures).max() > BROKEN_ONCE or abs(together) > BROKEN),
    )


def _counted(name, departures):
    """Departures that count: of a distance, which nothing makes too small, those upwards."""
    return np.maximum(departures, 0.0) if law_of(name).least else np.asarray(departures)


def _largest(law):
    return max(np.abs(_counted(law.name, list(law.departures.values()))).max(), abs(law.together))


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
    """Whether the tests agree on the size of a departure, in the law's unit: each with the mean of the others."""
    tests = list(law.measured)
    nominal = np.array([untamed(law.name, law.expected[test]) for test in tests])
    own = np.array([law.measured[test] for test in tests]) - nominal
    spread = [untamed_error(law.name, *one) for one in zip(nominal, law.spreads.values(), strict=True)]
    sigma = np.hypot([law.errors[test] for test in tests], spread)
    for test in range(len(own) if len(own) > 1 else 0):
        others = np.arange(len(own)) != test
        weight = sigma[others] ** -2
        mean = weight @ own[others] / weight.sum()
        if abs(own[test] - mean) > _ALIKE * np.hypot(
            np.hypot(sigma[test], weight.sum() ** -0.5), FORM * mean
        ):
            return False
    return True


def _chance(laws):
    """Chance of the largest departure over all laws, their tests and the sums of these, at most."""
    largest = max((_largest(one) for one in laws), default=0.0)
    count = sum(len(one.departures) + 1 for one in laws)
    return float(min(1.0, 2.0 * student.sf(largest, _FREEDOM) * max(count, 1)))
