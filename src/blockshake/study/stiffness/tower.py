"""The tower of a wave test: four of a structure's blocks on a plate, as configuration 2 of the paper is."""

from blockshake.geometry.reference_block import reference_block
from blockshake.geometry.structure import build_structure

_BLOCKS = 4
_PLATE_WIDTH = 1.25  # of the block's longest horizontal edge
_PLATE_HEIGHT = 0.125  # of the block's
_DECIMALS = 9  # of a place [m]: as in a file
_FRICTION = 10.0  # a step slips no joint, however light the blocks


def tower_of(structure):
    """Tower of four equal boxes of a structure's `reference_block`, of its material and restitution.

    Parameters
    ----------
    structure : Structure
        A shape that is no box the box around it is taken.

    Returns
    -------
    Structure
        The bodies ``slab``, driven, of the material of the structure's first driven body, or of the blocks' own
        without one, and ``block-1`` to ``block-4`` from the lowest up.

    Raises
    ------
    InputError
        The structure has no free body.
    """
    file, block = structure.file, reference_block(structure)
    reference = file.bodies[block.body]
    under = next((body.material for body in file.bodies if body.driven), reference.material)
    materials = list(dict.fromkeys([reference.material, under]))
    width, depth, height = (float(edge) for edge in block.size)
    plate = _PLATE_WIDTH * max(width, depth), _PLATE_HEIGHT * height
    bodies = [
        {
            "name": f"block-{number + 1}", "shape": "block",
            "material": reference.material, "density": reference.density,
            "position": [0.0, 0.0, round((number + 0.5) * height, _DECIMALS)],
        }
        for number in range(_BLOCKS)
    ]  # fmt: skip
    slab = {"name": "slab", "shape": "slab", "material": under, "driven": True}
    mapping = {
        "name": f"tower of {file.name}",
        "materials": {name: file.materials[name].model_dump() for name in materials},
        "shapes": {
            "slab": {"box": [plate[0], plate[0], plate[1]]},
            "block": {"box": [width, depth, height], "chamfer": file.shapes[reference.shape].chamfer},
        },
        "bodies": [{**slab, "position": [0.0, 0.0, -0.5 * plate[1]]}, *bodies],
        "friction": [{"pair": [reference.material, other], "coefficient": _FRICTION} for other in materials],
        "restitution": file.restitution,
    }
    return build_structure(mapping, structure.source, structure.folder)
