"""The chosen cause on the tests to select by alone, at a stated level.

By these tests alone, the ratio B_k of the evidence of cause k at a place over no cause has the mean 1 where nothing
acts. The mean over all K causes and places exceeds 1 / a with the probability a at most (Markov's inequality; e-values,
Vovk and Wang 2021, Proposition 2.2). B / K of the chosen one is no larger than this mean: the test holds its level
although these tests had a part in the choice. That of a further cause holds given those before it, which were fitted
to these tests as well: its level is approximate.
"""

import numpy as np

from blockshake.diagnosis.answer.decision import HeldOut
from blockshake.diagnosis.evidence.slab_motion import explain_slab
from blockshake.effects.joint_compliance import EFFECT as JOINT_COMPLIANCE


def held_out_rows(evidence, group, select):
    """`HeldOut` of the first cause of a `Group` in the joints; None without rows in the tests to select by.

    Parameters
    ----------
    evidence : Evidence or None
        By which the cause was found. A soft joint shows in closed joints too, which these rows do not hold.
    group : Group
    select : sequence of str
        Names of the tests to select by.
    """
    key = group.rivals[0].cause, group.rivals[0].place
    tests = evidence.tests if evidence else []
    chosen = [number for number, test in enumerate(tests) if test.seen.name in select]
    if not chosen or key not in evidence.keys or key[0] == JOINT_COMPLIANCE.name:
        return None
    alone = evidence.of_tests(chosen, key[0])
    likelihood, rows = alone.most_probable(key).likelihood, evidence.best(key).rows
    whitened = likelihood.whiten([rows[number][:, None] for number in chosen])
    expected = 0.5 * float(likelihood.normal_equations(whitened)[1][0, 0])
    return _held_out([tests[n].seen.name for n in chosen], alone.gain(key), len(evidence.keys), expected)


def held_out_slab(slabs, group, explained, select, without=()):
    """`HeldOut` of the first cause of a `Group` of the slab.

    ``slabs`` are `SlabMotion` by test, and ``explained`` as of `explain_slab` of all of them ``without`` some effects.
    """
    cause, chosen = group.rivals[0].cause, [name for name in slabs if name in select]
    if not chosen:
        return None
    others = {*explained, *without} - {cause}
    alone = explain_slab([slabs[name] for name in chosen], others)[cause]
    return _held_out(chosen, alone.gain, len(explained))


def _held_out(tests, gain, tried, expected=None):
    p = float(np.exp(min(0.0, np.log(tried) - gain)))
    return HeldOut(tests=tuple(tests), gain=float(gain), tried=tried, p=p, expected=expected)
