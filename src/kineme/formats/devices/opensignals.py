"""Read OpenSignals (BITalino, biosignalsplux): a JSON header between lines of ``#``, then rows.

The header states the rate, the names of the columns, and which of them are sensors.
"""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import compress

from kineme.formats.delimited import DelimitedText
from kineme.formats.devices import Layout, begins_with
from kineme.formats.dialects import Dialect


def lay_out(text: DelimitedText) -> DelimitedText:
    """Return the table with columns named by label and sensor: ``A1 EMG``."""
    try:
        devices = [*json.loads(text.lines[1].lstrip("# ")).values()]
        rate = float(devices[0]["sampling rate"])
        names, is_channel = [], []
        for device in devices:  # Labels are unique within a device only.
            sensors = {
                label: label if sensor in ("RAW", "") else f"{label} {sensor}"
                for label, sensor in zip(device["label"], device["sensor"], strict=True)
            }
            columns = list(map(str, device["column"]))
            names += [sensors.get(column, column) for column in columns]
            is_channel += [column in sensors for column in columns]
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise text.content.error(f"its header cannot be read: {error}", 2) from None
    table = Layout(head=r"(?!#)", names=names)(text)
    return replace(
        table, rate=rate, hidden=frozenset(table.names) - {*compress(table.names, is_channel)}
    )


DIALECT = Dialect("OpenSignals", begins_with("# OpenSignals Text File Format"), layout=lay_out)
