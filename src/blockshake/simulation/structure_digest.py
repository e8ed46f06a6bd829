"""The identity of a structure, by which finished runs of it are found again."""

from blockshake.files import content_digest


def structure_digest(structure):
    """Twelve hexadecimal digits of a structure's content, solids of meshes included."""
    solids = (solid.vertices.tobytes() for solid in structure.solids.values())
    return content_digest(structure.file.model_dump(mode="json"), *solids)
