"""CITATION.cff is what reference managers read: it has the form they ask for, and says what is so.

The schema beside this file holds the fields of the format that we use: the format's own checker
(cffconvert) wants a jsonschema of years ago.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

import kineme

ROOT = Path(__file__).resolve().parents[1]
SCHEMA = json.loads((ROOT / "tests" / "citation.schema.json").read_text(encoding="utf-8"))


@pytest.fixture
def citation() -> dict[str, Any]:
    return yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))


def test_citation_is_valid(citation: dict[str, Any]) -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    jsonschema.validate(citation, SCHEMA)


def test_the_citation_names_the_version_of_the_package(citation: dict[str, Any]) -> None:
    assert citation["version"] == kineme.__version__
