"""Numerical parameters of LS-DEM, and the contact stiffness of a structure about which nothing is said."""

from typing import Literal

from pydantic import Field

from blockshake.geometry.reference_block import reference_block
from blockshake.validation import NotNegative, Positive, Strict

LARGEST_INSET = 0.1  # of a flat's breadth
# the block that the defaults of LsDemParameters are for
_YOUNG, _POISSON, _HEIGHT = 3.45e10, 0.2, 1.6  # Pa, 1, m


class LsDemParameters(Strict):
    """Numerical parameters of LS-DEM; each is set as ``ls_dem.NAME``."""

    normal_stiffness: Positive = Field(
        2.16e10,
        description="normal stiffness of an interface per area, in proportion to E/h of the structure's blocks where "
        "nothing is said [N/m3]; E/h of a 1.6 m block, Zhou et al. (2023), Eq. (7), at Table 2's means",
    )
    shear_stiffness: Positive = Field(
        9.0e9,
        description="shear stiffness of an interface per area, in proportion to G/h of the structure's blocks where "
        "nothing is said [N/m3]; G/h of a 1.6 m block, Zhou et al. (2023), Eq. (8), at Table 2's means",
    )
    node_spacing: Positive = Field(
        0.2,
        description="aimed distance of surface nodes, of a shape broader than 1 m in proportion to its breadth [m]; "
        "Zhou et al. (2023), section LS-DEM",
    )
    perimeter_inset: Positive = Field(
        0.003,
        le=LARGEST_INSET,
        description="distance of the outermost nodes from the perimeter of a flat, over its narrower width [1]; chosen",
    )
    level_set: Literal["exact", "grid"] = Field(
        "exact",
        description="how the distance to a box or a convex mesh is found [exact or grid], by its formula or sampled; "
        "Zhou et al. (2023), Eq. (1), sample it",
    )
    grid_spacing: Positive = Field(
        0.02,
        description="spacing of the lattice of a sampled distance [m]; Zhou et al. (2023), section LS-DEM",
    )
    skin: Positive = Field(
        0.01,
        description="distance within which nodes are kept ready for contact [m]; changes speed, never results",
    )
    damping: Literal["interface", "node"] = Field(
        "interface",
        description="whose mass and stiffness Eq. (3) reads [interface or node]: the interface's, or literally each "
        "node's; Zhou et al. (2023), Eq. (3), docs/method.md",
    )
    pulling: bool = Field(
        False,
        description="whether the damped force of Eq. (2) may pull [true or false]; printed so, chosen: it does not",
    )
    shear_damping_ratio: NotNegative = Field(
        0.0, description="dashpot next to the shear spring, as a fraction of critical [1]; the paper has none"
    )


def own_stiffness(structure):
    """Normal and shear stiffness of a structure's interfaces, in proportion to E/h and G/h of its reference block.

    Parameters
    ----------
    structure : Structure

    Returns
    -------
    dict of str to float
        ``normal_stiffness`` and ``shear_stiffness`` [N/m3]: for a block of 1.6 m of Table 2's concrete the defaults of
        `LsDemParameters`, Zhou et al. (2023), Eqs. (7), (8).

    Raises
    ------
    InputError
        The structure has no free body.
    """
    usual, block = LsDemParameters(), reference_block(structure)
    material = structure.file.materials[structure.file.bodies[block.body].material]
    normal = (material.youngs_modulus / _YOUNG) * (_HEIGHT / float(block.size[2]))
    shear = normal * ((1.0 + _POISSON) / (1.0 + material.poisson_ratio))
    return {
        "normal_stiffness": usual.normal_stiffness * normal,
        "shear_stiffness": usual.shear_stiffness * shear,
    }
