"""How every kernel is compiled: kept on disk, without the interpreter's lock."""

from __future__ import annotations

from typing import Any

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
