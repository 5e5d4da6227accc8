"""Files that are either whole or absent."""

from __future__ import annotations

import os
import pathlib
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def replacing(path: str | pathlib.Path, *, binary: bool = False) -> Iterator[Any]:
    """Open a temporary file beside ``path`` that takes its place when the block ends, and vanishes if the block fails.

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
