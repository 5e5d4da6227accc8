"""What lies on disk: files that are either whole or absent, and arrays kept between runs.

Arrays that take seconds to compute and depend on few inputs are kept under a digest of all that determines them. Their
file carries a digest of key and content, and must hold the arrays asked for: a damaged or foreign one warns and is
replaced. Runs side by side don't disturb each other, since a file appears under its name only when complete. A folder
that can't be written costs the computing time of every run and nothing else.
"""

from __future__ import annotations

import hashlib
import io
import os
import pathlib
import tempfile
import warnings
import zipfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import numpy as np

CACHE_VARIABLE = "EXUDYN_EHD_CACHE"

Arrays = dict[str, np.ndarray]
Shapes = Mapping[str, tuple[int | str, ...]]


@contextmanager
def replacing(path: str | pathlib.Path, *, binary: bool = False) -> Iterator[Any]:
    """Open a temporary file next to ``path`` that takes its place when the block ends, and vanishes if the block fails.

    Parameters
    ----------
    path : path
        Its folder is made if needed.
    binary : bool
        Otherwise UTF-8 text without translation of line ends.
    """
    target = pathlib.Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    number, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    try:
        options: dict[str, Any] = {"mode": "wb"} if binary else {"mode": "w", "encoding": "utf-8", "newline": ""}
        with os.fdopen(number, **options) as file:
            yield file
        # mkstemp makes a file for its owner's eyes alone
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, target)
    except BaseException:
        pathlib.Path(name).unlink(missing_ok=True)
        raise


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
        Names and shapes of the arrays, all of finite floats; a letter for a
        length that the key doesn't tell, the same for the same length.
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
