"""Storage on disk: files that are either whole or absent, and arrays kept between runs.

Arrays that take seconds to compute and depend on few inputs are kept under a digest of all that determines them. A
damaged file, or that of other inputs, gives a warning and is replaced. Simultaneous runs don't disturb each other,
since a file appears under its name only when complete. If a folder can't be written, every run computes the arrays
again. When the folder is full, the file unused for longest is deleted. numba keeps compiled kernels in folders of its
own; where it finds none, the process gets one.
"""

from __future__ import annotations

import atexit
import dataclasses
import enum
import hashlib
import os
import pathlib
import shutil
import tempfile
import types
import uuid
import warnings
import zipfile
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import Any

import numba
import numpy as np

from exudyn_ehd.progress import announced
from exudyn_ehd.status import EHDError, InputError

CACHE_VARIABLE = "EXUDYN_EHD_CACHE"
# Version of all algorithms whose results are kept: raise it with every change of their results, so that older files are
# not used.
FORMAT = 7
# Bytes of all arrays kept.
LARGEST_CACHE = 3e8

Arrays = dict[str, np.ndarray]


def require_path(where: str, path: object, suffix: str = "") -> pathlib.Path:
    """Return ``path`` as a path, or raise `InputError` if it is none, is a folder, or does not end in ``suffix``."""
    if not isinstance(path, (str, os.PathLike)):
        raise InputError(f"{where}: path must be a str or a path, got {path!r}.")
    file = pathlib.Path(path)
    if file.is_dir() or any(parent.exists() and not parent.is_dir() for parent in file.parents):
        raise InputError(f"{where}: path must be that of a file in a folder, got '{path}'.")
    if suffix and file.suffix != suffix:
        raise InputError(f"{where}: path must end in {suffix}, got '{path}'.")
    return file


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
    temporary = target.with_name(f".{target.name}.{uuid.uuid4().hex}")
    options: dict[str, Any] = {"mode": "xb"} if binary else {"mode": "x", "encoding": "utf-8", "newline": ""}
    try:
        with open(temporary, **options) as file:
            yield file
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def fingerprint(value: object) -> str:
    """Digest of what describes something: options by their fields, arrays by content, functions by their code.

    It is the same in every process. Names and constants that a function refers to outside itself do not count.

    Parameters
    ----------
    value : object
        Numbers, texts, arrays, containers of them, functions, and objects with attributes.
    """
    digest = hashlib.sha256()
    for part in _parts(value, set()):
        digest.update(part)
    return digest.hexdigest()[:32]


def _parts(value: object, above: set[int]) -> Iterator[bytes]:
    """The bytes that tell a value from others of its kind or another; ``above`` holds what contains it."""
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, (bool, complex, str, bytes, enum.Enum)):
        yield f"<{value!r}>".encode()
        return
    if isinstance(value, (int, float)):
        yield f"<{value if abs(value) > 2**53 else float(value)!r}>".encode()
        return
    yield f"<{type(value).__qualname__}".encode()
    if id(value) not in above:
        if isinstance(value, np.ndarray) and value.dtype != object:
            yield repr((value.dtype.str, value.shape)).encode() + np.ascontiguousarray(value).tobytes()
        elif isinstance(value, (type, types.BuiltinFunctionType, types.ModuleType)):
            yield repr(value).encode()
        else:
            for item in _content(value):
                yield from _parts(item, above | {id(value)})
    yield b">"


def _content(value: Any) -> Iterable[object]:
    """Return the parts of an object that determine its digest."""
    if dataclasses.is_dataclass(value):
        return [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
    if isinstance(value, types.CodeType):
        return value.co_code, value.co_names, value.co_consts
    if isinstance(value, types.FunctionType):
        cells = [cell.cell_contents for cell in value.__closure__ or ()]
        return value.__code__, value.__defaults__, value.__kwdefaults__, cells
    if isinstance(value, Mapping):
        return value.items()
    if isinstance(value, (set, frozenset)):
        return sorted(value, key=repr)
    if isinstance(value, (tuple, list, np.ndarray)):
        return value
    # as pickle sees it: class, arguments, attributes
    return value.__reduce_ex__(2)


def cache_folder() -> pathlib.Path:
    """Return the folder of kept results: ``EXUDYN_EHD_CACHE``, else ``exudyn_ehd`` in the user's cache folder."""
    chosen = os.environ.get(CACHE_VARIABLE)
    if chosen:
        return pathlib.Path(chosen)
    # who has no home keeps nothing
    user = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return pathlib.Path(os.devnull if user.startswith("~") else user) / "exudyn_ehd"


def give_kernels_a_cache() -> None:
    """Give numba a folder for this process if it finds none for its cache; it refuses to compile without.

    Raises
    ------
    EHDError
        If there is no temporary folder either.
    """
    try:
        numba.njit(cache=True)(_probe)
        return
    except RuntimeError:
        remedy = "set NUMBA_CACHE_DIR to a folder that can be written."
    try:
        folder = tempfile.mkdtemp(prefix="exudyn_ehd_kernels_")
    except OSError:
        raise EHDError(
            f"exudyn_ehd: numba has no folder for its compiled kernels, and there is none for temporary files; {remedy}"
        ) from None
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    # processes that this one starts share it
    numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"] = folder
    warnings.warn(
        "exudyn_ehd: numba can write its cache neither next to the package nor in the user's cache folder; kernels are "
        f"compiled anew in every run (10 s). To keep them, {remedy}",
        stacklevel=2,
    )


def _probe() -> None:
    """A function for numba to look for a folder for."""


def cached_arrays(name: str, key: object, compute: Callable[[], Arrays]) -> Arrays:
    """Arrays from the disk, or computed and stored there.

    Parameters
    ----------
    name : str
        Start of the file's name, of the warning about a damaged file, and what long work says that it makes.
    key : object
        Everything that determines the arrays besides `FORMAT`, as for `fingerprint`.
    compute : function
        Makes the arrays.
    """
    path = cache_folder() / f"{name}_{fingerprint((FORMAT, key))}.bin"
    stored = None
    with suppress(OSError):
        stored = read_arrays(path, path.stem)
        if stored is None:
            warnings.warn(f"exudyn_ehd: the cache file {path.name} is damaged; it is built again.", stacklevel=3)
        # files that nobody reads go first, see _make_room
        os.utime(path)
    if stored is not None:
        return stored
    with announced(f"exudyn_ehd: computing {name.replace('_', ' ')}; later runs read them from the disk ..."):
        arrays = compute()
    with suppress(OSError):
        with replacing(path, binary=True) as file:
            # numpy's stub lets keywords be flags too
            np.savez(file, format=path.stem, **arrays)  # type: ignore[arg-type]
        _make_room(path)
    return arrays


def read_arrays(path: str | pathlib.Path, form: str) -> dict[str, np.ndarray] | None:
    """Arrays of a NumPy archive by name; None if it is damaged, or its "format" is another one."""
    with open(path, "rb") as file:
        try:
            with np.load(file, allow_pickle=False) as data:
                arrays = dict(data)
        # whatever numpy finds in bytes that are no archive of arrays
        except (
            ValueError,
            EOFError,
            TypeError,
            AttributeError,
            NotImplementedError,
            zipfile.BadZipFile,
            zlib.error,
        ):
            return None
    return arrays if str(arrays.pop("format", "")) == form else None


def _make_room(newest: pathlib.Path) -> None:
    """Remove the files that were not used for longest, until the others are within the limit; ``newest`` stays.

    Temporary files of writers that were killed are among them.
    """
    files, total = [], newest.stat().st_size
    for path in newest.parent.iterdir():
        # another process may remove what this one looks at
        with suppress(FileNotFoundError):
            if ".bin" in path.suffixes and path != newest:
                status = path.stat()
                files.append((status.st_mtime, status.st_size, path))
    for _, size, path in sorted(files, reverse=True):
        total += size
        if total > LARGEST_CACHE:
            path.unlink(missing_ok=True)


give_kernels_a_cache()
