"""A seeded run of the fuzzer; by hand it runs longer: see fuzz.py."""

from __future__ import annotations

import pytest

from files.fuzz import fuzz


@pytest.mark.slow
def test_hostile_files_end_in_a_robot_or_in_a_message():
    """No traceback, crash, hang or nonsense; and enough of both outcomes that the run means something."""
    counts, failures = fuzz(inputs=3000, workers=2, seed=7)
    assert failures == []
    assert sum(counts.values()) >= 3000
    assert counts["accepted"] > 100
    assert counts["refused"] > 1000
