"""blockshake: how stacks of heavy blocks behave in an earthquake, and how sure we are.

The same as the command line, as functions. They are loaded when first asked for, so that a rule that only draws a
figure compiles no solver.
"""

import importlib

from blockshake.caches import set_cache_home

__version__ = "0.9.0"

# `__init__.pyi` names the same for editors and type checkers
_HOMES = {
    "load_structure": "blockshake.geometry.structure",
    "load_motion": "blockshake.dynamics.load_motion",
    "check": "blockshake.own_files.check",
    "simulate": "blockshake.simulation.simulate",
    "plot": "blockshake.views.figure",
    "animate": "blockshake.views.animation",
    "export": "blockshake.views.export",
    "draw_samples": "blockshake.study.sampling.latin_hypercube",
    "calibrate_stiffness": "blockshake.study.stiffness.wave_speed",
    "load_campaign": "blockshake.measurement.campaigns.campaign",
    "diagnose": "blockshake.run_diagnosis",
    "InputError": "blockshake.errors",
}
__all__ = list(_HOMES)
set_cache_home()


def __getattr__(name):
    if name not in _HOMES:
        raise AttributeError(f"module 'blockshake' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__():
    return sorted([*globals(), *_HOMES])
