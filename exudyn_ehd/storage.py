"""What takes seconds to compute and depends on few inputs is kept on disk: arrays under a digest of all that determines them.

A file carries a digest of its key and its content, and must hold the arrays asked for: a damaged or foreign one warns and is replaced. Files appear under their name only
when complete, so that runs side by side don't disturb each other. A folder that can't be written costs the computing time of every run
and nothing else.
"""

from __future__ import annotations

import hashlib
import io
import os
import pathlib
import warnings
import zipfile
from collections.abc import Callable, Mapping

import numpy as np

from exudyn_ehd.files import replacing

CACHE_VARIABLE = "EXUDYN_EHD_CACHE"

Arrays = dict[str, np.ndarray]
Shapes = Mapping[str, tuple[int | str, ...]]


def cache_folder() -> pathlib.Path:
    """Where results are kept: ``EXUDYN_EHD_CACHE``, else ``exudyn_ehd`` in the user's cache folder."""
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen:
        return pathlib.Path(chosen)
    return pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "exudyn_ehd"


def cached_arrays(name: str, key: bytes, shapes: Shapes, compute: Callable[[], Arrays]) -> Arrays:
    """Arrays from the disk, or computed and stored there.

    Parameters
    ----------
    name : str
        Start of the file's name, and of the warning about a damaged file.
    key : bytes
        Everything that determines the arrays, a number for the format and for the algorithm included.
    shapes : mapping
        Names and shapes of the arrays, all of finite floats; a letter for a length that the key doesn't tell, the same for the same length.
    compute : function
        Makes the arrays.
    """
    digest = hashlib.sha256(key).digest()
    path = cache_folder() / f"{name}_{digest.hex()[:24]}.bin"
    stored = _read(path, digest, shapes)
    if stored is not None:
        return stored
    arrays = compute()
    _write(path, digest, arrays)
    return arrays


def _read(path: pathlib.Path, digest: bytes, shapes: Shapes) -> Arrays | None:
    try:
        raw = path.read_bytes()
    except OSError:
        return None
    if hashlib.sha256(digest + raw[32:]).digest() != raw[:32]:
        _warn(path, "damaged")
        return None
    try:
        with np.load(io.BytesIO(raw[32:]), allow_pickle=False) as data:
            arrays = {name: data[name] for name in data.files}
    # whatever numpy finds in bytes that are no archive of arrays
    except (ValueError, OSError, EOFError, KeyError, AttributeError, TypeError, zipfile.BadZipFile):
        _warn(path, "no file of this package")
        return None
    if arrays.keys() != shapes.keys() or not _fit(arrays, shapes):
        _warn(path, "no file of this package's version")
        return None
    return arrays


def _fit(arrays: Arrays, shapes: Shapes) -> bool:
    lengths: dict[str, int] = {}
    for name, shape in shapes.items():
        array = arrays[name]
        if array.dtype != np.float64 or array.ndim != len(shape) or not np.all(np.isfinite(array)):
            return False
        for have, want in zip(array.shape, shape, strict=True):
            if have != (lengths.setdefault(want, have) if isinstance(want, str) else want):
                return False
    return True


def _warn(path: pathlib.Path, why: str) -> None:
    warnings.warn(f"exudyn_ehd: the cache file {path.name} is {why}; it is built again.", stacklevel=5)


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
