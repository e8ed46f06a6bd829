"""The structure file (YAML): its keys, types and limits; whatever else is an error."""

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_serializer, model_validator

from blockshake.validation import Finite, Fraction, NotNegative, Positive, Strict, Whole

AXES = ("x", "y", "z")  # order of every vector
SIGNED_AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
QUATERNION = ("w", "x", "y", "z")  # order of every quaternion
Vector = tuple[Finite, Finite, Finite]
Quaternion = tuple[Finite, Finite, Finite, Finite]
# beyond anything that stands: where they end, arithmetic does too
Density = Annotated[Finite, Field(ge=1e-3, le=1e9)]
Modulus = Annotated[Finite, Field(ge=1.0, le=1e15)]
Velocities = tuple[*[Annotated[Finite, Field(ge=-1e4, le=1e4)]] * 3]
AngularVelocities = tuple[*[Annotated[Finite, Field(ge=-1e4, le=1e4)]] * 3]
Accelerations = tuple[*[Annotated[Finite, Field(ge=-1e4, le=1e4)]] * 3]
Copies = Annotated[Whole, Field(ge=1, le=1000)]
Name = Annotated[str, Field(min_length=1, pattern=r"^[^\s./]+$")]


def _three_or_six(elements):
    if len(elements) not in (3, 6):
        raise ValueError("expected three or six numbers")
    return elements


Inertia = Annotated[tuple[Finite, ...], AfterValidator(_three_or_six)]


class Material(Strict):
    """Bulk properties of a material."""

    density: Density = Field(description="mass density [kg/m3]")
    youngs_modulus: Modulus = Field(description="Young's modulus [Pa]")
    poisson_ratio: Finite = Field(gt=-1.0, lt=0.5, description="Poisson's ratio [1]")
    viscous_modulus: NotNegative = Field(
        0.0,
        description="viscous modulus of the bulk, its unit by assumption; rigid blocks do not use it [Pa s]",
    )


class Cylinder(Strict):
    """A cylinder about the body's z, as the upright prism of its volume on a regular polygon."""

    diameter: Positive = Field(description="of the cylinder [m]")
    height: Positive = Field(description="along body z [m]")
    sides: Annotated[Whole, Field(ge=8, le=64, multiple_of=4)] = Field(
        24, description="of the polygon, which shows a flat side to body x and y; `check` tells its errors"
    )


class Shape(Strict):
    """A box by its full edge lengths, chamfered or sharp, a cylinder, or a closed triangulated mesh."""

    box: tuple[Positive, Positive, Positive] | None = Field(
        None, description="edge lengths along body x, y, z [m]"
    )
    chamfer: NotNegative = Field(0.0, description="leg of the 45-degree chamfer of a box [m]")
    hollow: NotNegative = Field(
        0.0, description="depth of the middle of each face of a box below the face's perimeter [m]"
    )
    cylinder: Cylinder | None = Field(
        None,
        description="as a prism; none of a box or a mesh",
        exclude_if=lambda given: given is None,  # a structure without any keeps its digest
    )
    mesh: str | None = Field(None, description="file of a closed triangulated surface, coordinates in m")

    @model_validator(mode="after")
    def _one_kind(self):
        if sum(kind is not None for kind in (self.box, self.cylinder, self.mesh)) != 1:
            raise ValueError("expected either box (three edge lengths), cylinder or mesh (a file)")
        if self.box is None and self.chamfer:
            raise ValueError("expected a chamfer on a box only")
        if self.box is None and self.hollow:
            raise ValueError("expected hollow faces of a box only")
        if self.box is not None and 2.0 * self.chamfer >= min(self.box):
            raise ValueError("expected a chamfer below half the smallest edge length")
        if self.box is not None and self.hollow > 0.01 * min(self.box):
            raise ValueError("expected a hollow of at most a hundredth of the smallest edge length")
        return self


class Array(Strict):
    """Copies of a body in courses, each laid on the course below: a column, a row or a wall."""

    counts: tuple[Copies, Copies, Copies] = Field(description="of the copies along x, y and z")
    bond: Fraction = Field(
        0.0,
        description="shift along x of every second course, in widths of the body: 0.5 in a running bond [1]",
    )
    gap: NotNegative = Field(0.0, description="between neighbours of a course [m]")


class Body(Strict):
    """One rigid body: where it starts and how it moves then."""

    name: Name = Field(description="no dot, slash or space")
    shape: str = Field(description="one of `shapes`")
    material: str = Field(description="one of `materials`")
    position: Vector | None = Field(
        None, description="centroid of the shape, world frame [m]; none of a body that is laid `on` another"
    )
    on: str | None = Field(
        None,
        description="body on which this one is laid, its lowest point on the other's highest along z: it follows the "
        "sizes of both",
        exclude_if=lambda given: given is None,  # a structure without any keeps its digest
    )
    offset: Vector | None = Field(
        None,
        description="of a body laid `on` another: of its centroid from the other's along x and y, and gap along z [m]",
        exclude_if=lambda given: given is None,
    )
    steps: tuple[Finite, Finite] | None = Field(
        None,
        description="of a body laid `on` another: further offset along x and y, in widths of this body [1]",
        exclude_if=lambda given: given is None,
    )
    array: Array | None = Field(
        None,
        description="of a body laid `on` another: copies NAME-1, NAME-2 and so on, course by course from below",
        exclude_if=lambda given: given is None,
    )
    orientation: Quaternion = Field(
        (1.0, 0.0, 0.0, 0.0), description="unit quaternion w, x, y, z, body to world"
    )
    velocity: Velocities = Field((0.0, 0.0, 0.0), description="of the centroid, world frame [m/s]")
    angular_velocity: AngularVelocities = Field((0.0, 0.0, 0.0), description="world frame [rad/s]")
    driven: bool = Field(False, strict=True, description="the body follows the ground motion")
    density: Density | None = Field(None, description="of this body instead of its material's [kg/m3]")
    mass_offset: Vector = Field(
        (0.0, 0.0, 0.0), description="mass centre seen from the centroid of the shape, body frame [m]"
    )
    inertia: Inertia | None = Field(
        None,
        description="about the mass centre, body frame: elements xx, yy, zz of the tensor and, unless 0, xy, xz, yz; "
        "none: that of the shape at an even density [kg m2]",
        exclude_if=lambda given: given is None,  # a structure without any keeps its digest
    )

    @model_validator(mode="before")
    @classmethod
    def _needs_no_offset(cls, given):
        if isinstance(given, dict) and given.get("on") is not None:
            return {"offset": (0.0, 0.0, 0.0)} | given
        return given

    @model_validator(mode="after")
    def _has_one_place(self):
        if (self.position is None) == (self.on is None):
            raise ValueError("expected either position, or on with the name of a body below")
        for name in ("offset", "steps", "array"):
            if getattr(self, name) is not None and self.on is None:
                raise ValueError(f"expected no {name} of a body with a position")
        return self

    @model_serializer(mode="wrap")
    def _as_stated(self, serialize):
        """A place that follows from a body below is no part of the file."""
        stated = serialize(self)
        if self.on is not None:
            stated.pop("position", None)
        return stated


class Friction(Strict):
    """Coulomb's coefficient of a pair of materials; it may fall with slip rate and slip, and differ by direction."""

    pair: tuple[str, str] = Field(description="the two materials, in either order")
    coefficient: NotNegative = Field(description="at rest, before any slip [1]")
    rate_drop: Fraction = Field(0.0, description="share of the coefficient lost at high slip rate [1]")
    rate_scale: Positive = Field(0.01, description="slip rate at which 63 % of it is lost [m/s]")
    slip_drop: Fraction = Field(0.0, description="share of the coefficient lost after long slip [1]")
    slip_scale: Positive = Field(0.01, description="slip after which 63 % of it is lost [m]")
    asymmetry: Annotated[Finite, Field(gt=-1, lt=1)] = Field(
        0.0,
        description="share by which it is larger for slip of the joint's second body along its first's +x [1]",
    )


class Joint(Strict):
    """A joint that differs from others of its materials."""

    bodies: tuple[str, str] = Field(description="the two bodies, in either order")
    friction_factor: NotNegative = Field(1.0, description="on the coefficient of friction [1]")
    compliance: NotNegative = Field(0.0, description="of a soft layer along the normal, per area [m3/N]")


class Stopper(Strict):
    """A one-sided elastic stop fixed to the driven body."""

    body: str = Field(description="the body that is stopped")
    position: Vector = Field(description="point of the body, body frame, from the centroid [m]")
    axis: Literal[SIGNED_AXES] = Field(description="side on which the stop stands")
    gap: NotNegative = Field(description="clearance at the start [m]")
    stiffness: NotNegative = Field(
        description="force per closure beyond the gap, 0 for a stop that is not there [N/m]"
    )


EXTENSION = "extension."  # before the dotted name of a parameter of structures that state an extension
CREEP = 0.01  # m/s, below which a dry drag falls off


class ExternalForce(Strict):
    """A force from outside on a body, along a fixed axis; nothing of it acts on the driven body."""

    body: str = Field(description="the body that is pushed")
    position: Vector = Field(
        (0.0, 0.0, 0.0), description="point of the body, body frame, from the centroid [m]"
    )
    axis: Literal[AXES] = Field("x", description="of the world frame, along which the force acts")
    amplitude: Finite = Field(0.0, description="along the axis, from start until end [N]")
    start: NotNegative = Field(0.0, description="first instant of the amplitude [s]")
    end: Positive = Field(1e9, description="last instant of the amplitude [s]")
    stiffness: Finite = Field(
        0.0, description="force against the point's displacement relative to the driven body [N/m]"
    )
    damping: Finite = Field(0.0, description="force against the point's velocity relative to it [N s/m]")
    drag: NotNegative = Field(
        0.0, description="force against the direction of that velocity, F tanh(v / 0.01 m/s) [N]"
    )

    @model_validator(mode="after")
    def _ends(self):
        if self.end <= self.start:
            raise ValueError("expected `end` after `start`")
        return self


class Marker(Strict):
    """A point of a body whose displacement is measured."""

    name: Name = Field(description="of its readings")
    body: str = Field(description="the body that carries it")
    position: Vector = Field(description="body frame, from the centroid [m]")


class Accelerometer(Strict):
    """An accelerometer fixed to a body, one channel an axis."""

    name: Name = Field(description="a channel is named NAME-x and the like")
    body: str = Field(description="the body that carries it")
    position: Vector = Field(description="body frame, from the centroid [m]")
    axes: tuple[Literal[AXES], ...] = Field(min_length=1, description="of the body that it measures along")

    @model_validator(mode="after")
    def _each_axis_once(self):
        if len(set(self.axes)) < len(self.axes):
            raise ValueError("expected every axis once")
        return self


class DisplacementTransducer(Strict):
    """A wire between points of two bodies, or a rod that the reference carries and that bears on the body's face."""

    name: Name = Field(description="of its readings")
    body: str = Field(description="the body whose motion is read")
    position: Vector = Field(
        description="where the wire is hooked on, or a point of the face; body frame, from the centroid [m]"
    )
    reference: str = Field(description="the body that carries the transducer")
    reference_position: Vector = Field(
        description="where the wire leaves it, or a point of the rod; frame of the reference, from its centroid [m]"
    )
    axis: Literal[SIGNED_AXES] | None = Field(
        None, description="of the reference, along which the rod points to the face; none: a wire"
    )

    @property
    def anchor(self):
        """The end at the reference, as a point of it."""
        return Marker(name=self.name, body=self.reference, position=self.reference_position)


class StructureFile(Strict):
    """The whole file."""

    name: str = Field(description="of the structure, for reports")
    description: str = Field("", description="a sentence for reports")
    extension: str = Field(
        "",
        description="the cause that this structure has next to a nominal one, in words; a study's variables "
        "`extension.NAME`, NAME a parameter, are of such structures alone",
        exclude_if=lambda given: not given,  # a structure without any keeps its digest
    )
    gravity: Accelerations = Field((0.0, 0.0, -9.81), description="acceleration of a free body [m/s2]")
    materials: dict[Name, Material]
    shapes: dict[Name, Shape]
    bodies: tuple[Body, ...] = Field(min_length=1)
    friction: tuple[Friction, ...] = ()
    joints: tuple[Joint, ...] = ()
    restitution: Fraction = Field(0.5, description="C_res of Eq. (3), LS-DEM; 0 means critical damping [1]")
    nscd_restitution: Fraction = Field(0.0, description="Newton's restitution, NSCD [1]")
    stoppers: tuple[Stopper, ...] = ()
    external_forces: tuple[ExternalForce, ...] = ()
    markers: tuple[Marker, ...] = ()
    accelerometers: tuple[Accelerometer, ...] = ()
    displacement_transducers: tuple[DisplacementTransducer, ...] = Field(
        (),
        exclude_if=lambda given: not given,  # a structure without any keeps its digest
    )
