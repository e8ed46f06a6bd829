"""Section on the causes of the differences between samples: figures and words."""

import numpy as np

from blockshake.pages.blocks import Figure, Heading, Items, Section, Text
from blockshake.pages.drawing import svg_of
from blockshake.pages.words import Words
from blockshake.study.sensitivity.figure import SHOWN, is_shown, plot_sensitivity
from blockshake.study.sensitivity.findings import (
    differs,
    markers_by_height,
    motion_sentences,
    sentence,
    shared_words,
)

_CAUSES = Words(__name__)


def sensitivities(content):
    """Influence of each random variable on the thickness of the envelopes, by case and level."""
    first, stripes = tuple(motion_sentences(content)), content.stripes
    blocks = [*([Items(first)] if first else []), Text(_CAUSES.method()), Items(_shared(stripes))]
    for stripe in stripes:
        blocks += _of_stripe(stripe)
    return Section("Causes of the thickness of the envelopes", "sensitivity", tuple(blocks))


def _shared(stripes):
    """Variables that share their indices, and samples that did not complete, in a sentence for results alike."""
    by_words, few = {}, []
    for stripe in stripes:
        for model, one in stripe.responses.items():
            history, peak = (int(one.sensitivity["used"].sel(quantity=name)) for name in ("history", "peak"))
            if np.isfinite(one.sensitivity["spread"]).any():
                row = stripe.name, model, one.samples.sizes["sample"], history, peak
                by_words.setdefault(shared_words(one.sensitivity), []).append(row)
            else:
                few.append((stripe.name, model, history))
    sentences = [_CAUSES.shared(words, runs) for words, runs in by_words.items()]
    return (*sentences, *([_CAUSES.few(few)] if few else []))


def _of_stripe(stripe):
    """Sentences and figures of what explains the differences, and one sentence on models by which nothing does."""
    noise, bodies = stripe.case.marker_noise, markers_by_height(stripe.case)
    top, found, quiet, nothing = list(bodies)[-1], {}, [], []
    for model, one in stripe.responses.items():
        spread = one.sensitivity["spread"].sel(marker=bodies[top])
        if any(is_shown(one.sensitivity, bodies.values(), measure, noise) for measure in SHOWN):
            found[model] = one.sensitivity
        elif differs(one.sensitivity, noise):
            nothing.append((model, top, float(spread.max())))
        elif np.isfinite(spread).any():
            quiet.append(model)
    sentences = [
        _CAUSES.known_ones(model, sentence(result, top, bodies[top])) for model, result in found.items()
    ]
    sentences += _CAUSES.items("unexplained", quiet, nothing, noise)
    if not sentences:
        return []
    drawn = [
        Figure(
            _CAUSES.figure(stripe.name, label.removesuffix(" [1]")),
            svg_of(plot_sensitivity, found, bodies, noise, measure),
        )
        for measure, (_, label, *_) in SHOWN.items()
        if any(is_shown(one, bodies.values(), measure, noise) for one in found.values())
    ]
    return [Heading(stripe.name, f"sensitivity-{stripe.key}"), Items(tuple(sentences)), *drawn]
