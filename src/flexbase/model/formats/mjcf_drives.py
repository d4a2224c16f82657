"""Actuators, plugins and the medium of an MJCF: none of them acts on the plant, and none is passed over in silence."""

from __future__ import annotations

from flexbase.model.formats.fields import name_of, vector
from flexbase.model.formats.guard import Element
from flexbase.model.formats.notes import Notes

SERVOS = {"position", "velocity", "intvelocity", "damper", "general", "plugin", "dcmotor"}  # they act by themselves
ENDS = ("joint", "jointinparent", "tendon", "site", "cranksite", "body")
SERVO = "servo gains (kp, kv, gainprm, biasprm) not used: the joints feel flexbase's control law alone"
DRIVE = "gear and limits not used: the control law sets joint torques"
ARMATURE = "armature of the actuator ignored: give it as [robot] rotor_inertia"
MEDIUM = ("density", "viscosity", "wind")


def drive_notes(root: Element) -> list[str]:
    """A line for each kind of thing that MuJoCo would let act on the robot. Raises InputError."""
    notes = Notes()
    for actuator in _each(root, "actuator"):
        notes.add("actuator", _named(actuator), SERVO if actuator.tag in SERVOS else DRIVE)
        if "armature" in actuator.attributes:
            notes.add("actuator", _named(actuator), ARMATURE)
    for extension in _each(root, "extension"):
        named = name_of(extension, "plugin") if "plugin" in extension.attributes else f"<{extension.tag}>"
        notes.add("plugin", named, "of an extension, ignored: what it does to the robot is left out")
    for option in root.all("option"):
        for key in MEDIUM:
            if any(vector(option, key, (0.0, 0.0, 0.0) if key == "wind" else (0.0,))):
                notes.add("option", key, "ignored, because no fluid acts on the arm")
    return notes.lines()


def _named(actuator: Element) -> str:
    """Its name, or what it is and what it moves."""
    if "name" in actuator.attributes:
        return name_of(actuator)
    ends = [name_of(actuator, key) for key in ENDS if key in actuator.attributes]
    return f"<{actuator.tag}>" + "".join(f" of {end}" for end in ends[:1])


def _each(root: Element, section: str) -> list[Element]:
    return [child for found in root.all(section) for child in found.children]
