"""Independent witnesses of a bundled project: what Pinocchio makes of the robot file and the text of the project.

Nothing of flexbase reads anything here: the TOML is read by tomllib, the URDF by Pinocchio itself.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin
import scipy.linalg

import flexbase
from files.engines import GRAVITY

LIBRARY = Path(flexbase.__file__).parent / "model" / "library"
ROWS = ("x", "y", "z", "rx", "ry", "rz")
Z = np.array([0.0, 0.0, 1.0])


def tables(name: str) -> dict[str, Any]:
    """The text of a bundled project as plain tables."""
    return tomllib.loads((LIBRARY / f"{name}.toml").read_text("utf-8"))


def diagonal(values: list[float]) -> np.ndarray:
    """Bundled bases are given by vectors."""
    return np.diag(np.array(values, dtype=float))


def placed(xyz: list[float], rpy: list[float]) -> pin.SE3:
    return pin.SE3(pin.rpy.rpyToMatrix(*rpy), np.array(xyz, dtype=float))


class Answer(NamedTuple):
    """M, the 6 x N Jacobian of the tool (x y z rx ry rz), h + g, and where the tool is."""

    M: np.ndarray
    J: np.ndarray
    bias: np.ndarray
    position: np.ndarray
    rotation: np.ndarray


class Witness:
    """The whole chain of a project as one Pinocchio model, composed from the files: base, mount, arm."""

    def __init__(self, name: str) -> None:
        self.project = tables(name)
        robot = self.project["robot"]
        self.model, self.tool = (self._planar if "links" in robot else self._mounted)(robot, self.project["base"])
        self.model.gravity = pin.Motion(np.concatenate([GRAVITY, np.zeros(3)]))
        self.data = self.model.createData()

    def _planar(self, robot: dict[str, Any], base: dict[str, Any]) -> tuple[pin.Model, int]:
        """Links along x that turn about z."""
        model, parent, length = pin.Model(), 0, 0.0
        for link in robot["links"]:
            parent = model.addJoint(parent, pin.JointModelRZ(), placed([length, 0, 0], [0, 0, 0]), link["joint"])
            body = pin.Inertia(link["mass"], np.array([link["com"], 0.0, 0.0]), np.diag(link["inertia"] * Z))
            model.appendBodyToJoint(parent, body, pin.SE3.Identity())
            length = link["length"]
        return model, self._frame(model, parent, placed([length, 0, 0], [0, 0, 0]))

    def _mounted(self, robot: dict[str, Any], base: dict[str, Any]) -> tuple[pin.Model, int]:
        """The added joints and their body; then the arm as Pinocchio reads it, its root link welded to the body."""
        model, parent = pin.Model(), 0
        kinds = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}
        for joint in base["joint"]:
            moving = kinds[joint["type"]](np.array(joint["axis"]) / np.linalg.norm(joint["axis"]))
            parent = model.addJoint(parent, moving, pin.SE3.Identity(), joint["name"])
        body = base["body"]
        inertia = pin.Inertia(body["mass"], np.array(body["com"], dtype=float), np.diag(body["inertia"]))
        model.appendBodyToJoint(parent, inertia, pin.SE3.Identity())
        mount = base["mount"]
        seat = self._frame(model, parent, placed(mount["xyz"], mount.get("rpy", [0, 0, 0])), "seat")
        arm = pin.buildModelFromUrdf(str(LIBRARY / robot["file"]))
        whole = pin.appendModel(model, arm, seat, pin.SE3.Identity())
        return whole, whole.getFrameId(robot["tool"])

    def _frame(self, model: pin.Model, parent: int, place: pin.SE3, name: str = "tool") -> int:
        return int(model.addFrame(pin.Frame(name, parent, 0, place, pin.FrameType.OP_FRAME)))

    def __call__(self, q: np.ndarray, rates: np.ndarray) -> Answer:
        """Everything in one state; continuous joints are cosine and sine to Pinocchio."""
        model, data = self.model, self.data
        full = np.concatenate(
            [[np.cos(x), np.sin(x)] if joint.nq == 2 else [x] for joint, x in zip(model.joints[1:], q, strict=True)]
        )
        upper = np.triu(pin.crba(model, data, full))
        J = pin.computeFrameJacobian(model, data, full, self.tool, pin.LOCAL_WORLD_ALIGNED).copy()
        bias = pin.nonLinearEffects(model, data, full, rates).copy()
        pin.framesForwardKinematics(model, data, full)
        at = data.oMf[self.tool]
        return Answer(upper + np.triu(upper, 1).T, J, bias, at.translation.copy(), at.rotation.copy())

    def state_space(self, q: np.ndarray) -> StateSpace:
        """The linear model about a rest without gravity, from Pinocchio's M and J and the project's numbers."""
        answer = self(q, np.zeros_like(q))
        base, rows = self.project["base"], [ROWS.index(row) for row in self.project["task"]["rows"]]
        N, m = len(q), len(base["stiffness"])
        K, D = np.zeros((N, N)), np.zeros((N, N))
        K[:m, :m], D[:m, :m] = diagonal(base["stiffness"]), diagonal(base["damping"])
        J = answer.J[rows]
        B = np.vstack([np.zeros((m, len(rows))), J[:, m:].T])
        return StateSpace(answer.M, D, K, B, J)


class StateSpace:
    """x' = A x + B f, y = C x with x = (q, q'): all 2N poles, and residues from left and right eigenvectors."""

    def __init__(self, M: np.ndarray, D: np.ndarray, K: np.ndarray, B: np.ndarray, C: np.ndarray) -> None:
        N = len(M)
        self.A = np.block([[np.zeros((N, N)), np.eye(N)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
        self.B = np.vstack([np.zeros_like(B), np.linalg.solve(M, B)])
        self.C = np.hstack([C, np.zeros_like(C)])
        values, left, right = scipy.linalg.eig(self.A, left=True, right=True)
        self.vibrations = []
        for i in np.argsort(np.abs(values)):  # rigid poles are double zeros, spread by rounding
            if values[i].imag > 0.0 and abs(values[i]) > 1e-4 * np.abs(values).max():
                dyad = np.outer(self.C @ right[:, i], left[:, i].conj() @ self.B) / (left[:, i].conj() @ right[:, i])
                self.vibrations.append((values[i], dyad))

    @property
    def rigid(self) -> np.ndarray:
        """R_0, the double pole at zero: the mean of s^2 P(s) over a circle inside the slowest vibration."""
        radius = 0.1 * abs(self.vibrations[0][0])
        points = radius * np.exp(2j * np.pi * (np.arange(32) + 0.5) / 32)
        eye = np.eye(len(self.A))
        return np.mean([s**2 * self.C @ np.linalg.solve(s * eye - self.A, self.B) for s in points], axis=0).real
