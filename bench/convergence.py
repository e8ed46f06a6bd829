"""How LS-DEM's numerical parameters, varied one at a time, change two short runs of configuration 1.

The runs are the stack under one cycle of sine, and its lowest block alone, which rocks freely after a kick.
"""

from kicked_block import rocking_block
from motions import NUDGE
from shaken_stack import SHAKING, shaken_stack

from blockshake.geometry.structure import load_structure
from blockshake.pages.wording import MICRO, number
from blockshake.simulation.models import model_of
from blockshake.solvers.ls_dem.parameters import LsDemParameters, own_stiffness

_MODEL = "ls-dem"
_EXACT = 0.0  # spacing of the grid that stands for the exact distance
# settings [SI], the word and the printed unit of each parameter
PARAMETERS = {
    "time_step": ((1e-5, 2e-5, 5e-5, 1e-4), "time step", 1e6, f"{MICRO}s"),
    "node_spacing": ((0.05, 0.1, 0.2, 0.4), "node spacing", 1e3, "mm"),
    "perimeter_inset": ((0.0015, 0.003, 0.006, 0.012), "perimeter inset", 1.0, "of the width"),
    "grid_spacing": ((_EXACT, 0.005, 0.01, 0.02, 0.04), "grid spacing", 1e3, "mm"),
}
# observable: head of its column, factor from SI, format of its number
_COLUMNS = {
    "sink": (f"Sink [{MICRO}m]", 1e6, ".2f"),
    "swing_time": ("Swing time [ms]", 1e3, ".2f"),
    "impact_ratio": ("Impact ratio [1]", 1.0, ".4f"),
    "peak_drift": ("Peak drift [mm]", 1e3, ".2f"),
    "end_drift": ("End drift [mm]", 1e3, ".1f"),
    "energy_residual": ("Energy residual [1]", 1.0, ".1e"),
}
HEADER = ("Parameter", "Setting", *(head for head, _, _ in _COLUMNS.values()))


def convergence_rows(settings=None, shaking=SHAKING):
    """One row for each setting, the default marked by a star, and one of the floor.

    Parameters
    ----------
    settings : dict of str to tuple of float, optional
        Values of each numerical parameter [SI]; a spacing of the grid of 0 is the exact distance. By default those of
        `PARAMETERS`.
    shaking : dict
        ``acceleration`` [m/s2], ``frequency`` [Hz] and ``duration`` [s] of `shaken_stack`.

    Notes
    -----
    The floor is the difference that a ground acceleration and a kick larger by one part in a million make to the run
    with default parameters. Rocking is sensitive: a difference that is no larger states nothing of the parameter.
    """
    settings = settings or {name: values for name, (values, *_) in PARAMETERS.items()}
    structure, usual_step = load_structure("configuration-1"), model_of(_MODEL).time_step
    usual = LsDemParameters(**own_stiffness(structure))
    defaults = usual.model_dump() | {"time_step": usual_step, "grid_spacing": _EXACT}

    def observe(name="time_step", value=usual_step, strength=1.0):
        step = value if name == "time_step" else usual_step
        changes = {} if name == "time_step" or value == _EXACT else {name: value}
        if "grid_spacing" in changes:
            changes["level_set"] = "grid"
        numerical = LsDemParameters(**own_stiffness(structure), **changes)
        stronger = shaking | {"acceleration": strength * shaking["acceleration"]}
        return rocking_block(structure, _MODEL, numerical, step, strength) | shaken_stack(
            structure, numerical, step, **stronger
        )

    reference, nudged = observe(), observe(strength=1.0 + NUDGE)
    rows = []
    for name, values in settings.items():
        _, word, factor, unit = PARAMETERS[name]
        for value in values:
            shown = "exact" if name == "grid_spacing" and value == _EXACT else f"{factor * value:g} {unit}"
            star = value == defaults[name]
            read = reference if star else observe(name, value)
            rows.append((word, shown + " *" * star, *_cells(read)))
    floor = {name: abs(nudged[name] - reference[name]) for name in _COLUMNS}
    last = (number(factor * floor[name], 2) for name, (_, factor, _) in _COLUMNS.items())
    return [*rows, ("floor", "", *last)]


def _cells(read):
    return [f"{factor * read[name]:{form}}" for name, (_, factor, form) in _COLUMNS.items()]
