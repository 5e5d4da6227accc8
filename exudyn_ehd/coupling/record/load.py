"""Histories back from their files."""

from __future__ import annotations

import math
import pathlib
import zipfile
from typing import Any

import numpy as np

from exudyn_ehd.coupling.record.history import DIMENSIONS, FORMAT, JointHistory
from exudyn_ehd.coupling.record.on_disk import open_rows, read_head, read_rows
from exudyn_ehd.coupling.record.record import history_of, history_on_disk
from exudyn_ehd.status import InputError
from exudyn_ehd.storage import require_path


def load_history(path: str | pathlib.Path, *, start: float = -math.inf, end: float = math.inf) -> JointHistory:
    """Read what `JointHistory.save` has written, or the `File` of a record, as far as it has come.

    Parameters
    ----------
    path : path
    start, end : float
        s: the steps with ``start <= time <= end``, as `JointHistory.between`. Of a `File` no others are read but a
        thousand before them, from which the errors of the steps are summed up. Without both the history of a `File`
        reads each of its arrays when it is asked for.

    Returns
    -------
    JointHistory

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    InputError
        If it holds something else, or the start lies after the end.

    Examples
    --------
    After the example of `JointHistory`:

    >>> again = ehd.load_history("main.npz")
    >>> bool((again.force == history.force).all())
    True
    """
    require_path("load_history", path)
    head = read_head(path)
    if head is not None and head["names"] == FORMAT:
        dimensions = {name: head[name] for name in DIMENSIONS}
        if start == -math.inf and end == math.inf:
            return history_on_disk(open_rows(path, head["width"]), dimensions, head["lags"])
        first, rows = read_rows(path, head["width"], start, end)
        return history_of(rows, dimensions, head["lags"], first).between(start, end)
    try:
        with open(path, "rb") as raw, np.load(raw, allow_pickle=False) as data:
            known = "format" in data.files and str(data["format"]) == FORMAT
            values = {name: data[name] for name in data.files if name != "format"} if known else {}
    except (zipfile.BadZipFile, ValueError, EOFError, TypeError, AttributeError):
        known = False
    if not known:
        raise InputError(
            f"load_history: '{path}' holds no history of this version; give a file written by joint.save(...)."
        )
    fields: dict[str, Any] = {name: value if value.ndim else float(value) for name, value in values.items()}
    # files of before records could be thinned have all steps
    fields.setdefault("step_count", np.arange(fields["time"].size))
    return JointHistory(**fields).between(start, end)
