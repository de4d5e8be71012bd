"""Pick a row of a table of columns."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


def pick_row(table: Mapping[str, np.ndarray], **keys: str) -> dict[str, Any]:
    """Return the values of the only row that has these texts in these columns."""
    (row,) = np.flatnonzero(np.all([table[name] == text for name, text in keys.items()], axis=0))
    return {name: column[row] for name, column in table.items()}
