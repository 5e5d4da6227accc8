"""What takes seconds to compute and depends on few inputs is kept on disk: arrays under a digest of all that determines them.

A file carries a digest of its key and its content: a damaged or foreign one warns and is replaced. Files appear under their name only
when complete, so that runs side by side don't disturb each other. A folder that can't be written costs the computing time of every run
and nothing else.
"""

from __future__ import annotations

import hashlib
import io
import os
import pathlib
import warnings
from collections.abc import Callable

import numpy as np

from exudyn_ehd.files import replacing

CACHE_VARIABLE = "EXUDYN_EHD_CACHE"

Arrays = dict[str, np.ndarray]


def cache_folder() -> pathlib.Path:
    """Where results are kept: ``EXUDYN_EHD_CACHE``, else ``exudyn_ehd`` in the user's cache folder."""
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen:
        return pathlib.Path(chosen)
    return pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "exudyn_ehd"


def cached_arrays(name: str, key: bytes, compute: Callable[[], Arrays]) -> Arrays:
    """Arrays from the disk, or computed and stored there.

    Parameters
    ----------
    name : str
        Start of the file's name, and of the warning about a damaged file.
    key : bytes
        Everything that determines the arrays, a number for the format and for the algorithm included.
    compute : function
        Makes the arrays.
    """
    digest = hashlib.sha256(key).digest()
    path = cache_folder() / f"{name}_{digest.hex()[:24]}.bin"
    stored = _read(path, digest)
    if stored is not None:
        return stored
    arrays = compute()
    _write(path, digest, arrays)
    return arrays


def _read(path: pathlib.Path, digest: bytes) -> Arrays | None:
    try:
        raw = path.read_bytes()
    except OSError:
        return None
    if hashlib.sha256(digest + raw[32:]).digest() != raw[:32]:
        warnings.warn(f"exudyn_ehd: the cache file {path.name} is damaged; it is built again.", stacklevel=4)
        return None
    with np.load(io.BytesIO(raw[32:]), allow_pickle=False) as data:
        return {name: data[name] for name in data.files}


def _write(path: pathlib.Path, digest: bytes, arrays: Arrays) -> None:
    buffer = io.BytesIO()
    # numpy's stub lets keywords be flags too
    np.savez(buffer, **arrays)  # type: ignore[arg-type]
    payload = buffer.getvalue()
    try:
        with replacing(path, binary=True) as file:
            file.write(hashlib.sha256(digest + payload).digest() + payload)
    except OSError:
        return
