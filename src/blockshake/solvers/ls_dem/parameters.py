"""Numerical parameters of LS-DEM."""

from typing import Annotated

from pydantic import Field

from blockshake.validation import Strict

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]


class LsDemParameters(Strict):
    """Numerical parameters of LS-DEM; each is set as ``ls_dem.NAME``."""

    normal_stiffness: Positive = Field(
        2.16e10,
        description="normal stiffness of an interface per area [N/m3]; default E/h of a 1.6 m block, "
        "Zhou et al. (2023), Eq. (7), at Table 2's means",
    )
    shear_stiffness: Positive = Field(
        9.0e9,
        description="shear stiffness of an interface per area [N/m3]; default G/h of a 1.6 m block, "
        "Zhou et al. (2023), Eq. (8), at Table 2's means",
    )
    node_spacing: Positive = Field(
        0.2, description="aimed distance of surface nodes [m]; Zhou et al. (2023), section LS-DEM"
    )
    perimeter_inset: Positive = Field(
        0.005, description="distance of the outermost nodes from the perimeter of a flat [m]; chosen"
    )
    skin: Positive = Field(
        0.01,
        description="distance within which nodes are kept ready for contact [m]; changes speed, never results",
    )
