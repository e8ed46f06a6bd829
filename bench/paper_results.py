"""Judges of what Zhou et al. (2023) say of their results, envelopes and joints that move: of `the_paper`."""

from itertools import combinations

import numpy as np

from blockshake.geometry.structure import load_structure
from blockshake.pages.rows import face_markers
from blockshake.pages.wording import (
    given,
    millimetres,
    model_label,
    number,
    parameter_label,
    percent,
    share_words,
)  # fmt: skip
from blockshake.statistics.intervals import SURE_FROM, quantile_interval, sample_quantiles
from blockshake.study.analyses import OF_THE_PAPER
from blockshake.study.ensembles.envelope import counted_samples
from blockshake.study.sensitivity.findings import influences, is_known, markers_by_height

FIRST, SECOND, THIRD, FOURTH = OF_THE_PAPER
STACKS_AND_WALLS = [(stack, walls) for stack in (FIRST, SECOND) for walls in (THIRD, FOURTH)]
_MATTER = {"friction": "friction", "density": "density", "youngs_modulus": "stiffness"}
_SOFT, _RIGID, _ELASTIC, _VISCOELASTIC = "ls-dem", "nscd-rigid", "nscd-elastic", "nscd-viscoelastic"


def upward(content):
    """Thickness of LS-DEM's envelopes from block to block."""
    spreads = {}
    for name, case in content.cases.items():
        chosen = {"quantity": "history", "marker": list(markers_by_height(case).values())}
        spread = case.responses[_SOFT].sensitivity["spread"].sel(chosen).to_numpy()
        if np.isfinite(spread).all():
            spreads[name] = spread
    grows = sum((np.diff(spread) > 0.0).all() for spread in spreads.values())
    shown = "; ".join(f"{name} {', '.join(map(millimetres, spread))} mm" for name, spread in spreads.items())
    return grows == len(spreads), (
        f"Standard deviation from the lowest block up{_at_scale(content)}: {shown}. It grows from each block to the "
        f"next in {share_words(grows, len(spreads))} cases. There are no limits: "
        "the blocks of a structure move together in each sample."
    )


def thicker(model, pairs):
    """Judge of the thickness of a model's envelopes at the top: of each pair the second case has the larger one."""

    def judge(content):
        tops = {}
        for case in content.cases.values():
            at = case.differences.sel(model=model, marker=list(markers_by_height(case).values())[-1])
            limits = at["width_interval"].transpose("bound").to_numpy()
            if int(at["counted"]) >= SURE_FROM and np.isfinite(limits).all():
                tops[case.name] = (float(at["width"]), *limits)
        return _ordered(content, tops, pairs, "Mean difference of two samples at the top in mm", millimetres)

    return judge


def with_structure(content):
    """Thickness of the envelopes at the top with the number of blocks, by every kind of block."""
    blocks = {name: int((~load_structure(name).driven).sum()) for name in OF_THE_PAPER}
    pairs = [pair for pair in combinations(OF_THE_PAPER, 2) if blocks[pair[0]] < blocks[pair[1]]]
    return _worst({model: thicker(model, pairs)(content) for model in (_RIGID, _ELASTIC, _VISCOELASTIC)})


def parameters_matter(content):
    """Friction, density and stiffness behind the envelopes of LS-DEM."""
    shown, levels = {}, []
    for case in content.cases.values():
        result = case.responses[_SOFT].sensitivity.sel(marker=list(markers_by_height(case).values())[-1])
        for quantity, measure in (("history", "first_order"), ("peak", "rank_correlation")):
            at = result.sel(quantity=quantity)
            if is_known(at, measure):
                levels.append(float(at[f"{measure}_chance"]))
                known = influences(at, measure)
                found = [one.parameter for one in known if one.beyond_chance and not one.control]
                shown.setdefault(case.name, {}).update(dict.fromkeys(found))
    if not levels:
        return None, "The samples are too few for a sensitivity."
    told = [f"{name}: {', '.join(map(parameter_label, names))}" for name, names in shown.items() if names]
    lacking = [
        words
        for key, words in _MATTER.items()
        if not any(key in one for names in shown.values() for one in names)
    ]
    words = f"Beyond chance at the top{_at_scale(content)}: {'; '.join(told) or 'no variable'}."
    if not lacking:
        return True, words
    return None, (
        f"{words} Not so: {', '.join(lacking)}. Chance alone makes a share or a correlation of {min(levels):.2f} to "
        f"{max(levels):.2f}; no evidence of a smaller influence is no evidence against it."
    )


def occurrences(content):
    """Share of the joints that open by LS-DEM, smallest in configuration 1."""
    pairs = [(FIRST, other) for other in (SECOND, THIRD, FOURTH)]
    return _joints_move(content, _SOFT, ["joint_uplift"], pairs, "whose middle opens")


def complicated(content):
    """Share of the joints that open or slip, larger in configurations 3 and 4, model by model."""
    moves, words = ["joint_uplift", "joint_slip"], "at whose middle the faces part or slip"
    models = content.study["models"]
    return _worst({one: _joints_move(content, one, moves, STACKS_AND_WALLS, words) for one in models})


def alike(content):
    """LS-DEM with rigid and viscoelastic blocks in contact dynamics."""
    words, few, apart, beyond = [], [], 0, 0
    for case in content.cases.values():
        for other in (model for model in (_RIGID, _VISCOELASTIC) if model in content.study["models"]):
            both = [_SOFT, other]
            if int(case.differences["counted"].sel(model=both).min()) < SURE_FROM:
                few.append(f"{case.name}, {model_label(other)}")
                continue
            pair = case.differences.sel(model=_SOFT, other=other)
            distance, width = float(pair["distance"]), case.differences["width"].sel(model=both)
            widest = float(width.mean("marker").max())
            apart, beyond = apart + (distance > widest), beyond + (distance > float(pair["distance_chance"]))
            at = {
                "frame": "slab",
                "marker": next(iter(face_markers(case.structure).values())),
                "quantile": 0.5,
            }
            peaks = [number(1e3 * float(case.responses[model].envelope["peak"].sel(at))) for model in both]
            words.append(
                f"{case.name}, {model_label(other)} {number(1e3 * distance)} mm with {number(1e3 * widest)} mm, "
                f"median peaks at the top {' and '.join(peaks)} mm"
            )
    if not words:
        return None, "The samples are too few to hold the models against each other."
    fewer = f" Of fewer than {SURE_FROM} samples, and not judged: {'; '.join(few)}." if few else ""
    return not apart, (
        "Energy distance of an ensemble of NSCD from that of LS-DEM, next to the mean difference of two samples of "
        f"the wider of both, means over times and the markers of all blocks: {'; '.join(words)}. Alike counts where "
        "the distance is the smaller one: two equal normal distributions may be about two standard deviations apart. "
        f"It is the larger one in {share_words(apart, len(words))} comparisons, and beyond that of samples "
        f"exchanged at random in {share_words(beyond, len(words))}.{fewer}"
    )


def _joints_move(content, model, names, pairs, words):
    """Share of the joints that move beyond the markers' noise: of each pair of cases the second has the larger one.

    A larger structure has more joints, so that their number would follow from the structure alone. A block that rocks
    moves the middle of its joint along the face too, so that slip alone would count it.
    """
    shares, joints = {}, []
    for name, case in content.cases.items():
        samples = counted_samples(case.responses[model].samples)
        joints.append(f"{samples.sizes['joint']} of {name}")
        if samples.sizes["sample"] >= SURE_FROM:
            moved = (samples[names].to_dataarray().max("variable") > case.marker_noise).mean("joint").values
            shares[name] = (sample_quantiles(moved, [0.5])[0], *quantile_interval(moved, [0.5])[:, 0])
    words = f"Share of the joints ({', '.join(joints)}) {words} by more than a marker's noise in %, median over the"
    return _ordered(content, shares, pairs, f"{words} samples", percent, ceiling=1.0)


def _ordered(content, found, pairs, words, written, ceiling=np.inf):
    """Whether of each pair of cases the second has the larger quantity: met beyond the limits in all, not met against
    them in one.

    ``found`` has value and limits of 95 % by case, without those of too few samples. A first case whose quantity is at
    the ceiling has no larger one: its pairs say nothing.
    """
    lacking = sorted({name for pair in pairs for name in pair} - set(found))
    pairs = [pair for pair in pairs if not set(pair) & set(lacking)]
    names = sorted({name for pair in pairs for name in pair})
    absent = f" Not in this study, or of too few samples: {', '.join(lacking)}." if lacking else ""
    if not pairs:
        return None, f"This study lacks the cases to compare.{absent}"
    if (
        len(
            {
                (content.cases[one].motion, *map(content.cases[one].settings.get, ("scale", "duration")))
                for one in names
            }
        )
        > 1
    ):
        return None, "The cases are shaken differently, which the structures cannot be distinguished from."
    full = sorted({less for less, _ in pairs if found[less][0] >= ceiling})
    pairs = [pair for pair in pairs if pair[0] not in full]
    larger = sum(found[more][1] > found[less][2] for less, more in pairs)
    smaller = sum(found[more][2] < found[less][1] for less, more in pairs)
    told = ", ".join("{} {} [{}, {}]".format(name, *map(written, found[name])) for name in names)
    words = f"{words} at scale {given(content.cases[names[0]].settings['scale'])}, with 95 % limits: {told}. "
    if full:
        words += f"Nothing can be larger than that of {', '.join(full)}. "
    words += (
        f"Pairs of structures in the stated order beyond the limits, all of which met asks for: {larger} of "
        f"{len(pairs)}; in the opposite one, of which one is enough for not met: {smaller}.{absent}"
        if pairs
        else f"No pair of structures is left.{absent}"
    )
    if smaller:
        return False, words
    return (larger == len(pairs) and not (lacking or full)) or None, words


def _worst(findings):
    """Finding of several models: the worst verdict is that of all."""
    verdicts = [verdict for verdict, _ in findings.values()]
    words = [f"{model_label(model)}: {words}" for model, (_, words) in findings.items()]
    worst = next(one for one in (False, None, True) if one in verdicts)
    return worst, " ".join([*words, "The worst of the models counts."])


def _at_scale(content):
    scales = sorted({case.settings["scale"] for case in content.cases.values()})
    return f" at scale {' and '.join(map(given, scales))}"
