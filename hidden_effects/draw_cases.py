"""Draw a list of cases: every effect at two sizes and every form from outside in every laboratory, clean cases, pairs.

``python hidden_effects/draw_cases.py --seed 1759261812 --output hidden_effects/seeds.yaml`` writes the sealed list. The
number is that of the commit in which the laboratories joined, 68dc3474: nobody chose it by an answer. Another number
gives another list of the same make-up. A case's name states nothing of what is hidden in it.
"""

import argparse
import sys
from itertools import product
from pathlib import Path

import numpy as np
from case_plan import STRENGTHS
from case_truth import SIZES
from make_case import LABORATORIES
from outside_forces import OUTSIDE

from blockshake.effects.registry import EFFECTS
from blockshake.files import write_text

CLEAN = {"home": 32, "mujoco": 46, "unusual": 36}
PAIRS = {"home": 10, "mujoco": 16, "unusual": 14}
# how often each form from outside is in each laboratory, on which structures how often
FORMS = {"home": 1, "mujoco": 2, "unusual": 2}
STRUCTURES = {
    "single-block": 1, "two-blocks": 3, "three-blocks": 4, "four-blocks": 3, "bridged-walls": 2, "trilithon": 2,
    "six-block-wall": 2, "configuration-1": 2, "configuration-2": 2, "configuration-3": 1, "configuration-4": 1,
}  # fmt: skip
SLIDING = "sliding-blocks"
# on structures that nothing else slides on, half of the time
_FRICTION = ("weak-joint", "rate-weakening-friction", "slip-weakening-friction", "friction-asymmetry")
# what needs a second block; and what a wall with steel beams has in too many places to be placed
_NOT_ON = {
    "single-block": {"eccentricity", "block-mass", "outside-weight", "outside-dry-drag"},
    "configuration-4": set(EFFECTS) | set(OUTSIDE),
}
_GAINED = {"two-blocks", "three-blocks", "four-blocks", "configuration-1", "trilithon", SLIDING}
_FAULTS = {name for name, effect in EFFECTS.items() if effect.acts == "observation"}
HEAD = """\
# Drawn by hidden_effects/draw_cases.py --seed {seed}. Every effect of the registry at two sizes and every form from
# outside in every laboratory, pairs of causes, and clean cases. A case's name says nothing of what is hidden in it;
# what is drawn follows from its seed alone.{sealed}
"""
SEALED = """
#
# The sealed cases of the track record, fixed before any was diagnosed: nobody looks into one, or at one's verdict, to
# improve the diagnosis."""


def draw_cases(seed):
    """Cases of a list as mappings, in an order that states nothing.

    Parameters
    ----------
    seed : int
    """
    generator = np.random.default_rng(seed)
    wanted = [
        (laboratory, causes, size)
        for laboratory in LABORATORIES
        for causes, size in _hidden(laboratory, generator)
    ]
    order = generator.permutation(len(wanted))
    seeds = generator.choice(10**6, len(wanted), replace=False)
    strengths, cases = list(STRENGTHS), []
    for number, (index, own) in enumerate(zip(order, seeds, strict=True), start=1):
        laboratory, causes, size = wanted[index]
        structure = _structure(causes, generator)
        case = {
            "name": f"hidden-{number:03d}", "seed": int(own), "laboratory": laboratory, "structure": structure,
            "strength": strengths[generator.integers(len(strengths))],
        }  # fmt: skip
        case |= {"causes": list(causes)} if causes else {}
        case |= {"size": size} if size else {}
        gained = structure in _GAINED and causes and not set(causes) & _FAULTS
        case |= {"gain": "responses"} if gained else {}
        cases.append(case)
    return cases


def _hidden(laboratory, generator):
    """Causes and size of every case of a laboratory."""
    yield from [((), None)] * CLEAN[laboratory]
    yield from (((name,), size) for name, size in product(EFFECTS, SIZES))
    yield from [((name,), None) for name in OUTSIDE] * FORMS[laboratory]
    names = [*EFFECTS, *OUTSIDE]
    for _ in range(PAIRS[laboratory]):
        first = generator.choice(list(EFFECTS))
        other = generator.choice([name for name in names if name != first])
        yield (str(first), str(other)), "large"


def _structure(causes, generator):
    """A structure on which these causes can act."""
    if set(causes) & set(_FRICTION) and generator.random() < 0.5:
        return SLIDING
    able = {name: often for name, often in STRUCTURES.items() if not _NOT_ON.get(name, set()) & set(causes)}
    often = np.array(list(able.values()), dtype=float)
    return str(generator.choice(list(able), p=often / often.sum()))


def as_text(cases, seed, sealed):
    """A list of cases as the text of its file."""
    lines = []
    for case in cases:
        words = (
            f"{key}: [{', '.join(one)}]" if key == "causes" else f"{key}: {one}" for key, one in case.items()
        )
        lines.append(f"  - {{{', '.join(words)}}}\n")
    return HEAD.format(seed=seed, sealed=SEALED if sealed else "") + "cases:\n" + "".join(lines)


def main(arguments):
    """Write a list, as the command line states."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument("--output", type=Path, required=True)
    asked = parser.parse_args(arguments)
    sealed = asked.output.resolve() == Path(__file__).with_name("seeds.yaml").resolve()
    cases = draw_cases(asked.seed)
    write_text(asked.output, as_text(cases, asked.seed, sealed))
    sys.stdout.write(f"{len(cases)} cases in {asked.output}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
