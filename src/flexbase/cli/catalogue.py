"""The commands and what each is for, in the order in which the program lists them.

A command has the name of its function in `flexbase`, with hyphens: `hardware-map` is `fb.hardware_map`.
"""

from __future__ import annotations

COMMANDS = {
    "check": "Is the project sound? Show what it says.",
    "modes": "Vibration modes at a pose: are they positive real?",
    "verdict": "Positive real, exactly, or where in frequency not.",
    "manipulability": "Dynamic manipulability, without and with a compensator.",
    "design": "A compensator: the change that makes a pose safe.",
    "simulate": "Move the tip, then settle it: does the loop come to rest?",
    "recommend": "Which controller to use as the loop really runs, and why.",
    "compare": "Controllers for the loop as it runs, side by side.",
    "safe-gain": "How stiff the task-space loop may be as it runs.",
    "region": "Where one controller stays valid around its pose.",
    "simulate-sampled": "The move by a controller as hardware would run it.",
    "sweep": "Measures over tips, joints, samples or parameters.",
    "hardware-map": "Verdicts on the loop as it runs, over the workspace.",
    "hardware-path": "Verdicts on the loop as it runs, along a path.",
    "draw": "A picture or page of a map that was written earlier.",
    "montecarlo": "How sure is a design when the plant is not known exactly?",
    "postures": "The joints in which the arm stands best on a target.",
    "robust-curves": "Robust arm configurations over two joints, as curves.",
    "robust-points": "Robust arm configurations of any arm, as points.",
    "layout": "Where to put the work, or the base.",
    "hardware-study": "Many poses: which controllers run?",
    "agreement": "Many poses: do linear verdicts come true in MuJoCo?",
    "reproduce": "The paper's figures and numbers, beside what it prints.",
    "robots": "The bundled robots.",
    "init": "Write a commented project file to start from.",
}
RENAMED = {
    "ellipsoid": "manipulability",
    "hardware": "compare, with safe-gain and region as commands of their own",
    "map": "sweep",
    "posture": "postures",
    "rac": "robust-curves or robust-points",
    "study": "hardware-study or agreement",
}
