"""The words of a project file: tables, keys, types and bounds. Editors get them as a JSON schema."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema

from flexbase.model.sensing import FASTEST, MOST_DELAY, MOST_EVERY, Sensing

LARGEST = 1e12  # of any number of a project, in SI units


def _numbers_or_rows(value: Any) -> Any:
    """Accept a list of numbers or a list of rows of numbers, and say plainly what else was found."""
    if not isinstance(value, list):
        raise ValueError(f"{shown(value)} is not a list of numbers")
    for entry in value:
        for number in entry if isinstance(entry, list) else [entry]:
            if isinstance(number, bool) or not isinstance(number, int | float):
                raise ValueError(f"{shown(number)} is not a number")
            if number != number or number in (float("inf"), float("-inf")):
                raise ValueError(f"{number} is not finite")
            if abs(number) > LARGEST:
                raise ValueError(f"{shown(number)} is beyond {LARGEST:g}")
    lengths = {len(entry) if isinstance(entry, list) else None for entry in value}
    if len(lengths) > 1:
        raise ValueError("its rows differ in length")
    return value


def shown(value: Any) -> str:
    """A value as TOML writes it, cut to a line."""
    if isinstance(value, bool):
        return f"{str(value).lower()} (a boolean)"
    if isinstance(value, str):
        return f'"{value[:60]}" (a string)'
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return f"{str(value)[:60]} (a list)"
    if isinstance(value, int) and abs(value) > LARGEST:
        return "a huge number"
    return str(value)[:60]


_NUMBERS = {"type": "array", "items": {"type": "number"}}
Numbers = Annotated[list[Any], BeforeValidator(_numbers_or_rows), WithJsonSchema(_NUMBERS)]
NumbersOrRows = Annotated[
    list[Any],
    BeforeValidator(_numbers_or_rows),
    WithJsonSchema({"anyOf": [_NUMBERS, {"type": "array", "items": _NUMBERS}]}),
]


class Table(BaseModel):
    """A TOML table: unknown keys are refused, nothing is converted, numbers are finite."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False, frozen=True)


class LinkTable(Table):
    """One planar link. Its x axis points along it; revolute joints turn about z, prismatic ones slide along `axis`."""

    joint: str = Field(min_length=1, description="name of the joint that moves this link")
    length: float = Field(ge=0, le=LARGEST, description="from this joint to the next, or to the tool [m]")
    mass: float = Field(gt=0, le=LARGEST, description="[kg]")
    com: float = Field(
        ge=-LARGEST, le=LARGEST, description="centre of mass, distance from the joint along the link [m]"
    )
    inertia: float = Field(ge=0, le=LARGEST, description="about the centre of mass [kg m^2]")
    type: Literal["revolute", "prismatic"] = Field("revolute", description="kind of joint")
    axis: Numbers = Field([1.0, 0.0], description="prismatic joints: direction in the previous link's x-y plane")


class PayloadTable(Table):
    """A body held at the tool, in the tool frame."""

    mass: float = Field(gt=0, le=LARGEST, description="[kg]")
    com: Numbers = Field([0.0, 0.0, 0.0], description="centre of mass from the tool [m], 3 numbers")
    inertia: Numbers = Field(
        [0.0, 0.0, 0.0], description="about its centre of mass [kg m^2]: xx yy zz, or xx yy zz xy xz yz"
    )


class RobotTable(Table):
    """The chain, base joints first: planar links written here, or a robot file."""

    links: list[LinkTable] | None = Field(None, min_length=1, description="planar links, base first")
    file: str | None = Field(None, min_length=1, description="URDF or MJCF beside this file or below")
    tool: str | None = Field(None, min_length=1, description="frame of the file whose motion is the task")
    payload: PayloadTable | None = None
    friction: Numbers | None = Field(None, description="viscous, one for each arm joint [N m s/rad or N s/m]")
    file_friction: bool = Field(False, description="take viscous joint friction from the robot file")
    rotor_inertia: Numbers | None = Field(None, description="reflected, one for each arm joint [kg m^2 or kg]")


class JointTable(Table):
    """A passive joint that the robot file does not have."""

    name: str = Field(min_length=1)
    type: Literal["revolute", "prismatic"] = Field(description="kind of joint")
    axis: Numbers = Field(description="direction, 3 numbers, in the frame that the joints before it have moved")


class BodyTable(Table):
    """The body that the added base joints carry, in the frame of the last one."""

    mass: float = Field(gt=0, le=LARGEST, description="[kg]")
    com: Numbers = Field([0.0, 0.0, 0.0], description="centre of mass [m], 3 numbers")
    inertia: Numbers = Field(description="about its centre of mass [kg m^2]: xx yy zz, or xx yy zz xy xz yz")


class MountTable(Table):
    """Where the arm's root sits on that body."""

    xyz: Numbers = Field([0.0, 0.0, 0.0], description="[m]")
    rpy: Numbers = Field([0.0, 0.0, 0.0], description="turns about the fixed x, then y, then z axis [rad]")


class BaseTable(Table):
    """The passive joints: the first ones of the chain, or joints added below it."""

    joints: list[str] = Field([], description="names of the passive joints of the robot, in chain order")
    joint: list[JointTable] = Field([], max_length=6, description="joints added before the robot's own")
    body: BodyTable | None = None
    mount: MountTable | None = None
    stiffness: NumbersOrRows | None = Field(None, description="one a joint, or a symmetric positive definite matrix")
    damping: NumbersOrRows | None = Field(None, description="one a joint, or a positive semidefinite matrix")
    frequency: Numbers | None = Field(None, description="instead of stiffness: of each joint alone, arm locked [rad/s]")
    damping_ratio: Numbers | None = Field(None, description="instead of damping: of each joint alone, arm locked")
    reference: Numbers | None = Field(None, description="arm joints at which the frequencies hold; zero if left out")
    equilibrium: Numbers | None = Field(None, description="where the springs rest [m or rad]; zero if left out")


class TaskTable(Table):
    """What is controlled."""

    rows: list[Literal["x", "y", "z", "rx", "ry", "rz"]] = Field(min_length=1, description="world axes, in task order")
    branch: Literal["+", "-", "+++", "++-", "+-+", "+--", "-++", "-+-", "--+", "---"] = Field(
        "+", description="default elbow: + is 0 < elbow angle < pi; of six joints also shoulder, elbow, wrist"
    )


class ControlTable(Table):
    """Default task gains: f = -(stiffness y + damping y')."""

    stiffness: NumbersOrRows = Field(description="one for each task row [N/m or N m/rad], or a matrix")
    damping: NumbersOrRows = Field(description="one for each task row [N s/m or N m s/rad], or a matrix")


class SensingTable(Table):
    """How the loop really runs: clock, delays, sensors and limits of the sampled controller."""

    rate: float = Field(Sensing.rate, gt=0, le=FASTEST, description="of controller, encoders and torque commands [Hz]")
    task_every: int | None = Field(
        None, ge=1, le=MOST_EVERY, description="the task sensor delivers once in so many samples; 1 if left out"
    )
    task_rate: float | None = Field(None, gt=0, le=FASTEST, description="instead of task_every [Hz]; it divides rate")
    compute_delay: int = Field(1, ge=0, le=MOST_DELAY, description="samples from a measurement to its torque")
    task_delay: int = Field(1, ge=0, le=MOST_DELAY, description="samples by which the task sensor is late, beside that")
    encoder_counts: float | None = Field(
        None, gt=0, le=LARGEST, description="a turn, or a metre of a sliding joint; not quantised if left out"
    )
    acceleration: Literal["accelerometer", "encoders", "kalman"] = Field(
        "accelerometer", description="of the arm joints: measured, differenced and filtered, or estimated"
    )
    accelerometer_lag: float = Field(Sensing.accelerometer_lag, ge=0, le=1e6, description="first-order lag [s]")
    acceleration_filter: float = Field(
        Sensing.acceleration_filter, gt=0, le=FASTEST, description="corner of the encoders' or the Kalman filter [Hz]"
    )
    acceleration_noise: float = Field(0.0, ge=0, le=1e6, description="standard deviation [rad/s^2 or m/s^2]")
    task_noise: float = Field(0.0, ge=0, le=1e6, description="standard deviation [m or rad]")
    torque_limit: Numbers | None = Field(None, description="one for each arm joint [N m or N]; none if left out")
    torque_slew: Numbers | None = Field(None, description="one for each arm joint [N m/s or N/s]; none if left out")


class ProjectFile(Table):
    """A flexbase project: an arm on a compliant base, its task and its default gains. SI units."""

    schema_version: int = Field(1, ge=1, le=1, description="version of this file format")
    name: str = Field(min_length=1, description="how results name this machine")
    gravity: Numbers = Field([0.0, 0.0, 0.0], description="free-fall acceleration in world axes [m/s^2]")
    robot: RobotTable
    base: BaseTable | None = Field(None, description="left out: a rigid base")
    task: TaskTable
    control: ControlTable | None = None
    sensing: SensingTable | None = Field(None, description="left out: verdicts on hardware assume 1 kHz")
