"""The contact stiffness of a structure about which nothing is said."""

from blockshake.geometry.reference_block import reference_block
from blockshake.solvers.ls_dem.parameters import LsDemParameters

# the block that the defaults of LsDemParameters are for
_YOUNG, _POISSON, _HEIGHT = 3.45e10, 0.2, 1.6  # Pa, 1, m


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
