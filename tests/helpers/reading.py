"""Read content as a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import kineme


def read(folder: Path, name: str, content: str | bytes | list | dict, **options: object) -> Any:
    """Write text, bytes or JSON to a file of this name, and read it as a recording."""
    if isinstance(content, list | dict):
        content = json.dumps(content)
    (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    return kineme.read(folder / name, **options)
