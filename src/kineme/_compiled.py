"""How every kernel is compiled: kept on disk, without the interpreter's lock.

Kernels copy, add and sort with loops: an array assigned to a slice, an array added to another
or `numpy.sort` in one of them makes the first run ever a second longer.
"""

from __future__ import annotations

from typing import Any

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
