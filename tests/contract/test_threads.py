"""Verbs in two threads at once: each result has its own cautions, and quiet in one thread is not quiet in another."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from types import SimpleNamespace

import numpy as np

import flexbase as fb
from flexbase.cautions import caution, collected

ROUNDS = 5


def test_each_run_has_its_own_cautions(paper: fb.Plant, paper_pose: fb.Pose) -> None:
    """Two compensators of two other robots, simulated at the same time."""
    together, start = Barrier(2), paper.at_tip([0.33, 0.25])
    move = fb.Move(switch=1e-3, end=2e-3, interval=1e-3)

    def runs(robot: str) -> list[fb.Run]:
        loop, found = SimpleNamespace(E=0.01 * np.eye(2), robot=robot), []
        for _ in range(ROUNDS):
            together.wait()
            with collected(quietly=True):
                found.append(fb.simulate(paper, start, paper_pose, loop, move=move))
        return found

    with ThreadPoolExecutor(2) as pool:
        for robot, found in zip("ab", pool.map(runs, "ab"), strict=True):
            said = f'compensator: designed for "{robot}", used on "ueda2003".'
            assert [run.cautions for run in found] == [(said,)] * ROUNDS


def test_designs_keep_their_own(paper: fb.Plant) -> None:
    """Certificates made side by side are those made one after the other."""
    poses = [paper.at_tip([0.33, -0.25]), paper.at_tip([0.5, 0.1])]

    def made(pose: fb.Pose) -> tuple[str, ...]:
        with collected(quietly=True) as said:
            warned = fb.design(pose, "exact").certificate.warnings
        assert tuple(said) == warned
        return warned

    one_by_one = [made(pose) for pose in poses]
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(made, poses)) == one_by_one


def test_quiet_in_one_thread_only() -> None:
    entered, said_there = Barrier(2), Barrier(2)

    def quiet() -> list[str]:
        with collected(quietly=True) as said:
            entered.wait()
            said_there.wait()
        return said

    def loud() -> list[str]:
        entered.wait()
        with collected(quietly=True) as said:
            caution("heard")
        said_there.wait()
        return said

    with ThreadPoolExecutor(2) as pool:
        there, here = pool.submit(quiet), pool.submit(loud)
        assert (there.result(), here.result()) == ([], ["heard"])
