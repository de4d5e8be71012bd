"""Published accuracies on CMU subject 86, trial by trial, each with its source.

They are facts to compare with, shipped as ``published.json`` beside this
file. How they were computed is told in `kineme.evaluation.paper`, as far
as it is known: ACA's and HACA's do not follow from their published cuts.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any


@cache
def published() -> dict[str, Any]:
    """Tables by name, each ``{method: {trial: value}}``; ``sources`` says where each is from.

    ``accuracy_strict``, ``accuracy_tolerant``, ``rerun_accuracy`` and
    ``rerun_accuracy_certain`` are per trial; ``means`` and
    ``cluster_variance_means`` are as printed.
    """
    text = files(__package__).joinpath("published.json").read_text(encoding="utf-8")
    tables: dict[str, Any] = json.loads(text)
    return tables
