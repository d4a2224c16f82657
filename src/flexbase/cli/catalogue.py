"""The commands and what each is for, in the order in which the program lists them."""

from __future__ import annotations

COMMANDS = {
    "check": "Is the project sound? Show what it says.",
    "modes": "Vibration modes at a pose, and whether they are positive real.",
    "verdict": "The exact verdict: positive real, or where in frequency not.",
    "design": "A compensator: the change of control that makes a pose safe.",
    "hardware": "Controllers for the loop as it runs, side by side.",
    "hardware-map": "Verdicts on the loop as it runs, over the workspace or a path.",
    "simulate": "Move the tip, then settle it: does the loop come to rest?",
    "ellipsoid": "Dynamic manipulability, without and with a compensator.",
    "map": "Measures over the tip's plane, joints, samples or parameters.",
    "montecarlo": "How sure is a design when the plant is not known exactly?",
    "draw": "A picture or page of a map that was written earlier.",
    "posture": "The joints in which the arm stands best on a target.",
    "rac": "Robust arm configurations, as curves or points.",
    "layout": "Where to put the work, or the base.",
    "recommend": "Which controller to use as the loop really runs, and why.",
    "study": "Many poses: which controllers run, and do verdicts come true?",
    "reproduce": "The paper's figures and numbers, beside what it prints.",
    "robots": "The bundled robots.",
    "init": "Write a commented project file to start from.",
}
