"""Numerical parameters of nonsmooth contact dynamics with deformable blocks."""

from typing import Annotated

from pydantic import Field

from blockshake.solvers.nscd.parameters import StepParameters
from blockshake.validation import Positive


class DeformableParameters(StepParameters):
    """Numerical parameters of both deformable models; each is set as ``nscd_deformable.NAME``."""

    mesh_size: Positive = Field(0.2, description="edge of the hexahedra, about [m]; Zhou et al. (2023)")
    contact_spacing: Positive = Field(
        0.6,
        description="largest distance of contact points in a joint, and of the shapes that carry them [m], 10 gives "
        "the four corners; chosen, docs/theory/nscd-deformable.md",
    )
    modes: Annotated[int, Field(ge=0)] = Field(
        40,
        description="free modes of each shape besides the static ones [1], as many as the mesh has or more give the "
        "full mesh; chosen, docs/theory/nscd-deformable.md",
    )
    elastic_theta: Annotated[float, Field(ge=0.5, le=1.0)] = Field(
        0.6,
        description="weight of the end of a step in the deformation [1]; chosen, docs/theory/nscd-deformable.md",
    )
