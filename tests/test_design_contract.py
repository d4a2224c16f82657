"""Every registered design method, on every system it accepts: its certificate is the truth.

Adding a method to `flexbase.METHODS` puts it under these tests. The witnesses are assembled from Pinocchio's inertia
and Jacobian and the base's numbers: full state spaces, Cauchy's integral for residues, no reduced form.
"""

from __future__ import annotations

import dataclasses
import json
import warnings
from functools import cache
from itertools import product

import numpy as np
import pytest

import flexbase
from flexbase import FlexbaseWarning, Infeasible, InputError
from flexbase.model.loop import Gain
from systems.lagged import law
from systems.oracle import FullSystem
from systems.planar import PAPER_TIP, planar, sliding_pair
from systems.random_plants import random_pose

SYSTEMS = {
    "paper": lambda: flexbase.load("ueda2003").at_tip(PAPER_TIP),
    "paper, other pose": lambda: flexbase.load("ueda2003").at_tip([0.25, 0.3]),
    "sliding pair": lambda: sliding_pair(0.9).at([0.2]),
    "space n=2": lambda: random_pose(3, 1, 2, 2),
    "space n=3": lambda: random_pose(5, 1, 3, 3),
    "space n=3 undamped": lambda: random_pose(6, 1, 3, 3, damping="zero"),
    "two modes planar": lambda: planar([0.3, 0.25, 0.35, 0.3], m=2, damping=3.0).at([0.685, -1.151]),
    "two modes in space": lambda: random_pose(1, 2, 3, 2),
    "redundant": lambda: random_pose(4, 1, 3, 2),
}

SEVERAL, MISSED = "2 base joints, but this method shapes one", "the first mode misses its targets by"
REFUSED = dict.fromkeys(product(["exact", "recursive"], ["two modes planar", "two modes in space"]), SEVERAL)
REFUSED |= dict.fromkeys(product(["recursive", "task-priority"], ["sliding pair", "space n=2", "space n=3"]), MISSED)
UNCLAIMED = {("task-priority", "two modes planar"), ("task-priority", "two modes in space")}  # residuals above a tenth
CASES = [pair for pair in product(flexbase.METHODS, SYSTEMS) if pair not in REFUSED]

FREQUENCIES_FREE = {"convex", "bounded"}  # methods that aim at positive realness alone unless asked for more


@cache
def designed(method, system):
    """The pose, and the compensator with the warnings of its design; or None and the refusal."""
    pose = SYSTEMS[system]()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            return pose, flexbase.design(pose, method), tuple(str(w.message) for w in caught if is_ours(w))
        except (InputError, Infeasible) as refusal:
            return pose, None, (f"{type(refusal).__name__}: {refusal}",)


def is_ours(warning):
    assert issubclass(warning.category, FlexbaseWarning), warning
    return True


@pytest.fixture(params=CASES, ids=", ".join)
def case(request):
    pose, compensator, said = designed(*request.param)
    assert compensator is not None, said
    return pose, compensator, said


@pytest.fixture(params=[pair for pair in CASES if pair not in UNCLAIMED], ids=", ".join)
def claimed(request):
    return designed(*request.param)


def independent_modes(pose, E):
    """[w, omega] of each vibration mode, slowest first, from the full system."""
    system = FullSystem(pose, E)
    poles = system.vibrations()
    residues = [system.mode_residue(pole) for pole in poles]
    return np.array([np.linalg.eigvalsh(R + R.T)[0] for R in residues]), np.abs(poles), residues


def check_facts(pose, E, certificate):
    """All that a certificate claims about a gain; raises AssertionError where a claim is wrong."""
    system, m = FullSystem(pose, E), pose.arm.m
    assert certificate.min_eig_modified_inertia == pytest.approx(np.linalg.eigvalsh(system.M)[0], rel=1e-8)
    assert certificate.min_eig_modified_inertia > 0.0
    for gain, w, omega in (
        (np.zeros_like(E), certificate.robustness_before, certificate.frequency_before_rad_s),
        (E, certificate.robustness_after, certificate.frequency_after_rad_s),
    ):
        robustness, frequencies, residues = independent_modes(pose, gain)
        size = max(np.abs(R).max() for R in residues)
        assert w == pytest.approx(robustness, rel=0.0, abs=1e-8 * size)
        # an extreme gain leaves M - E ill-conditioned, and each witness loses as many digits
        assert omega == pytest.approx(frequencies, rel=1e-9 + 1e-16 * np.linalg.cond(pose.M - system.E * (gain is E)))
    squares, damping, form = law(pose, E)
    follow = form > 1e-8 * np.abs(E).max()  # what is rounding pumps nothing
    limits = damping[follow] / (squares * form)[follow]
    expected = limits.min(initial=np.inf)
    if certificate.lag_limit_s is None:
        assert expected > 1.0
    else:
        assert certificate.lag_limit_s == pytest.approx(expected, rel=1e-6)
    around = np.linalg.inv(system.inertia)[m:, m:] @ E
    rho = np.abs(np.linalg.eigvals(around)).max()
    assert certificate.algebraic_loop_radius == pytest.approx(rho, rel=1e-8)
    rng = np.random.default_rng(0)
    turned = around * np.exp(1j * rng.uniform(0.0, 2.0 * np.pi, (20000, len(E))))[:, None, :]
    mu = np.abs(np.linalg.eigvals(turned)).max()
    assert certificate.algebraic_loop_radius_per_joint >= max(mu, rho) - 1e-9
    assert certificate.algebraic_loop_radius_per_joint <= max(mu, rho) * (1.0 + 1e-2)  # random phases miss the top
    gains = pose.arm.gains
    loop = FullSystem(pose, E).close(gains.stiffness, gains.damping)
    poles = loop.poles()
    held = poles[np.argsort(np.abs(poles))[2 * (pose.arm.n - pose.arm.k) :]]  # not a redundant arm's free motions, at 0
    # relative to the fastest pole and the conditioning of M - E, as every eigenvalue of this loop is
    slack = (1e-9 + 1e-16 * np.linalg.cond(loop.M)) * np.abs(poles).max()
    assert certificate.closed_loop_abscissa == pytest.approx(held.real.max(), rel=0.0, abs=slack)


def check_targets(pose, E, compensator):
    """What the certificate promises beyond facts: the first mode aligned and at its target, as far as its residual."""
    _, frequency_before, residues_before = independent_modes(pose, np.zeros_like(E))
    w, frequencies, residues = independent_modes(pose, E)
    scale = np.linalg.norm(residues_before, axis=(1, 2))
    if compensator.method in FREQUENCIES_FREE:  # they may enlarge a residue that they cannot align
        scale = np.maximum(scale, np.linalg.norm(residues, axis=(1, 2)))
    slack = 1e-6 + compensator.certificate.target_residual
    assert np.all(w > -2.0 * slack * scale)
    if compensator.method not in FREQUENCIES_FREE:
        assert np.all(frequencies > 1.01 * frequency_before)  # by default all of them rise


def test_every_method_and_every_system_is_used():
    """No method refuses everything, and no system is refused by all."""
    assert {method for method, _ in CASES} == set(flexbase.METHODS)
    assert {system for _, system in CASES} == set(SYSTEMS)


@pytest.mark.parametrize("pair", REFUSED, ids=", ".join)
def test_what_does_not_apply_is_refused_with_its_reason(pair):
    _, compensator, said = designed(*pair)
    assert compensator is None
    assert REFUSED[pair] in said[0]


def test_certificate_is_the_truth(case):
    """M - E > 0, w and omega before and after, rho, mu and the rightmost pole, each by an independent computation.

    1e-9 for frequencies (eigenvalue conditioning is below 1e5 here), 1e-8 of the residues for w (Cauchy's integral).
    """
    pose, compensator, _ = case
    check_facts(pose, compensator.E, compensator.certificate)


def test_lag_margin_is_the_truth(case):
    """Stable just below the certified first-order lag, unstable just above, or unstable from the first lag on."""
    pose, compensator, _ = case
    margin, gains = compensator.certificate.lag_margin_s, pose.arm.gains
    free = 2 * (pose.arm.n - pose.arm.k)  # poles at 0 of a redundant arm, which no lag moves
    loop = FullSystem(pose, compensator.E).close(gains.stiffness, gains.damping)

    def rightmost(poles):
        return poles[np.argsort(np.abs(poles))[free:]].real.max()

    if margin is None:
        assert max(rightmost(loop.lagged_poles(lag)) for lag in np.geomspace(1e-5, 1.0, 40)) < 0.0
    elif margin == 0.0:
        assert max(rightmost(loop.poles()), rightmost(loop.lagged_poles(1e-6))) >= -1e-6
    else:
        lags = margin * np.concatenate([np.geomspace(1e-2, 0.9, 20), [1.0 - 1e-5]])
        assert max(rightmost(loop.lagged_poles(lag)) for lag in lags) < 0.0
        assert rightmost(loop.lagged_poles(margin * (1.0 + 1e-5))) > 0.0


def test_gain_is_symmetric_and_belongs_to_the_pose(case):
    """E = E^T to the bit, of the arm's size, with the pose, the robot and the method on its label."""
    pose, compensator, _ = case
    assert np.array_equal(compensator.E, compensator.E.T)
    assert compensator.E.shape == (pose.arm.n, pose.arm.n)
    assert np.array_equal(compensator.q, pose.q)
    assert compensator.robot == pose.plant.name
    assert compensator.method in flexbase.METHODS


def test_targets_hold(claimed):
    """Each w_i is 0 and each omega_i raised, up to the certified residual."""
    pose, compensator, _ = claimed
    assert compensator.certificate.target_residual <= 0.1
    check_targets(pose, compensator.E, compensator)


@pytest.mark.parametrize("pair", sorted(UNCLAIMED), ids=", ".join)
def test_a_large_residual_claims_nothing(pair):
    assert 0.1 < designed(*pair)[1].certificate.target_residual < 0.3


def test_the_empty_answer_fails_these_checks(case):
    """The control: E = 0 in place of the design contradicts both the certificate and the targets."""
    pose, compensator, _ = case
    zero = np.zeros_like(compensator.E)
    with pytest.raises(AssertionError):
        check_facts(pose, zero, compensator.certificate)
    with pytest.raises(AssertionError):
        check_targets(pose, zero, compensator)


def test_warnings_say_what_the_radii_say(case):
    """A warning exactly where rho or mu is 1 or more; the certificate carries what was warned."""
    _, compensator, said = case
    certificate = compensator.certificate
    assert said == certificate.warnings
    about_the_loop = [text for text in said if "algebraic-loop radius" in text]
    risky = max(certificate.algebraic_loop_radius, certificate.algebraic_loop_radius_per_joint) >= 1.0
    assert bool(about_the_loop) == risky


def test_a_design_survives_its_file(case, tmp_path):
    """save and load_compensator: E, pose, method and certificate come back to the bit."""
    _, compensator, _ = case
    path = tmp_path / "compensator.json"
    compensator.save(path)
    back = flexbase.load_compensator(path)
    assert np.array_equal(back.E, compensator.E)
    assert np.array_equal(back.q, compensator.q)
    assert (back.method, back.robot) == (compensator.method, compensator.robot)
    assert dataclasses.asdict(back.certificate) == dataclasses.asdict(compensator.certificate)


def test_dictionary_is_plain_json(case):
    """to_dict holds numbers, lists, strings and null: it survives JSON unchanged, without NaN."""
    _, compensator, _ = case
    plain = compensator.to_dict()
    assert json.loads(json.dumps(plain, allow_nan=False)) == plain


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("not json", "not valid JSON"),
        ("[]", "not a compensator"),
        ('{"format": "something else"}', "not a compensator"),
        ('{"format": "flexbase compensator 1"}', "missing or unknown"),
        (
            '{"format": "flexbase compensator 1", "method": "m", "robot": "r", "q": [0], '
            '"E": [[1, 2], [3, 4]], "certificate": {}}',
            "not symmetric",
        ),
        ('{"format": "flexbase compensator 1", "E": [[1, 2, 3]], "certificate": {}}', "square"),
        ('{"format": "flexbase compensator 1", "E": "x", "certificate": {}}', "not an array"),
        ('{"format": "flexbase compensator 1", "E": [[NaN]], "certificate": {}}', "not finite"),
        ('{"format": "flexbase compensator 1", "E": [[1]], "q": [1], "certificate": 3}', "missing or unknown"),
        ("\xff", "bad.json"),
    ],
)
def test_a_broken_compensator_file_is_refused(tmp_path, text, message):
    """Whatever is wrong with the file, one InputError that names it."""
    path = tmp_path / "bad.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError, match=message) as fault:
        flexbase.load_compensator(path)
    assert "bad.json" in str(fault.value)


def test_a_compensator_of_another_arm_is_refused():
    """E of a two-joint arm on a three-joint one: InputError with both sizes."""
    with pytest.raises(InputError, match=r"E has shape \(2, 2\).*3 arm joints"):
        flexbase.modes(random_pose(5, 1, 3, 3), Gain(np.zeros((2, 2))))
