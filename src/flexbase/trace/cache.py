"""Compiled programs on disk, so that the second start does not trace or compile."""

from __future__ import annotations

import hashlib
import os
import sys
import tempfile
from contextlib import suppress
from functools import cache
from pathlib import Path

FOLDER = "FLEXBASE_CACHE"  # environment variable: another folder, or "off"


def folder() -> Path | None:
    """Where compiled programs are kept, or None where the user wants none."""
    wanted = os.environ.get(FOLDER, "")
    if wanted.lower() == "off":
        return None
    if wanted:
        return Path(wanted)
    home = os.environ.get("XDG_CACHE_HOME") or (os.environ.get("LOCALAPPDATA") if sys.platform == "win32" else None)
    with suppress(RuntimeError):  # no home at all
        return (Path(home) if home else Path.home() / ".cache") / "flexbase" / "kernels"
    return None


@cache
def source_digest() -> str:
    """A fingerprint of all of flexbase's own code: a cached program of another version is never used."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256(sys.version.encode())
    for path in sorted(package.rglob("*.py")):
        digest.update(path.relative_to(package).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def read(key: str) -> bytes | None:
    """What was kept under a key, or None; a damaged file counts as none."""
    place = folder()
    if place is None:
        return None
    try:
        content = (place / _file(key)).read_bytes()
    except OSError:
        return None
    check, kept = content[:32], content[32:]
    return kept if hashlib.sha256(key.encode() + kept).digest() == check else None


def write(key: str, content: bytes) -> None:
    """Keep content under a key, whole or not at all. A folder that cannot be written is no fault: nothing is kept."""
    place = folder()
    if place is None:
        return
    with suppress(OSError):
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=place)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(hashlib.sha256(key.encode() + content).digest() + content)
            os.replace(name, place / _file(key))
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise


def _file(key: str) -> str:
    return hashlib.sha256(key.encode()).hexdigest()[:40] + ".o"
