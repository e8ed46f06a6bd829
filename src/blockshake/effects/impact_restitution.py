"""Impacts lose less than the model has them lose."""

from blockshake.effects.effect import Effect, EffectParameter
from blockshake.effects.places import nowhere


def _act(experiment, values, place):
    file = experiment.structure.file
    return experiment.with_parameters(
        restitution=file.restitution + values["increase"],
        nscd_restitution=file.nscd_restitution + values["increase"],
    )


EFFECT = Effect(
    name="impact-restitution",
    title="restitution of impacts",
    acts="contact",
    equation="C_res + e in LS-DEM's dashpots, Newton's restitution e in NSCD, where it is 0 otherwise",
    source="Zhou et al. (2023), Eq. (3); Newton's law of impact",
    parameters=(EffectParameter("increase", "1", "of the restitution", 0.0, 0.0, 0.45, 0.3),),
    confused_with=("reduced-bearing", "vertical-motion"),
    distinguished_by="free rocking after a snap release: decay of successive peaks",
    places=nowhere,
    act=_act,
)
