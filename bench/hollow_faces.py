"""Impact and sway of configuration 1 with hollow faces, by LS-DEM, with NSCD and Housner's edges."""

from kicked_block import housner_ratio, rocking_block
from shaken_stack import SHAKING, shaken_stack

from blockshake.geometry.structure import load_structure
from blockshake.simulation.models import MODELS

HOLLOWS = (0.0, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3)  # m
SPACINGS = (0.2, 0.1, 0.05)  # m
HEADER = (
    "hollow [mm]",
    *(f"impact ratio, nodes at {spacing:g} m" for spacing in SPACINGS),
    "sink [um]",
    "peak drift [mm]",
)


def hollow_rows():
    """One row for each depth, then one for NSCD and one for Housner's edges, which have no hollow."""
    lsdem, nscd = MODELS["ls-dem"], MODELS["nscd-rigid"]
    rows = []
    for hollow in HOLLOWS:
        structure = load_structure("configuration-1", {"shapes.block.hollow": hollow})
        ratios = [
            rocking_block(structure, "ls-dem", lsdem.schema(node_spacing=spacing), lsdem.time_step, 1.0)[
                "impact_ratio"
            ]
            for spacing in SPACINGS
        ]
        swayed = shaken_stack(structure, lsdem.schema(), lsdem.time_step, **SHAKING)
        rows.append(
            (
                f"{1e3 * hollow:g}",
                *(f"{ratio:.3f}" for ratio in ratios),
                f"{1e6 * swayed['sink']:.1f}",
                f"{1e3 * swayed['peak_drift']:.1f}",
            )
        )
    structure = load_structure("configuration-1")
    corners = rocking_block(structure, "nscd-rigid", nscd.schema(), 2e-4, 1.0)["impact_ratio"]
    rows.append(("NSCD, any", f"{corners:.3f}", "", "", "", ""))
    rows.append(("Housner's edges", f"{housner_ratio(structure):.3f}", "", "", "", ""))
    return rows
