"""Read the manifest of clips, and check it against its schema."""

from __future__ import annotations

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema

SCHEMA = json.loads(files("kineme.clips").joinpath("manifest.schema.json").read_text("utf-8"))


def read_manifest(folder: Path, name: str = "manifest.json") -> list[dict[str, Any]]:
    """Return the entries of all clips."""
    content = json.loads((folder / name).read_text(encoding="utf-8"))
    jsonschema.validate(content, SCHEMA)
    return content["clips"]
