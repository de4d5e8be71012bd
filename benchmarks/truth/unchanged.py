"""Check that results did not change: segment every recording with every preset and compare.

    python -m benchmarks unchanged --write before.json
    python -m benchmarks unchanged --against before.json

Use it around a change that should not alter results: all columns of all rows must be equal.
Provenance is not compared. For recordings that cannot be segmented, the errors are compared.
Takes some minutes on two cores.
"""

from __future__ import annotations

import json
import os
import warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from _options import DATA, choose_size, make_parser, skip

os.environ.setdefault("KINEME_THREADS", "1")  # set before the workers start, which share the cores

PRESETS = ("kineme", "voegele2014", "krueger2017")
FOLDERS = {
    "cmu86": "*.amc",
    "cmu_formats": "*.*",
    "hdm05": "**/*.amc",
    "formats": "*.*",
    "timeseries": "*.txt",
    "sets": "**/recordings/*.parquet",
}
RATES = {".txt": 100.0}  # of files without a frame rate


def main() -> None:
    """Write or compare tables."""
    parser = make_parser(__doc__)
    parser.add_argument("--write", type=Path, help="file to keep the tables in")
    parser.add_argument("--against", type=Path, help="file that they were kept in")
    parser.add_argument("--only", default="", help="recordings whose path holds this")
    given = parser.parse_args()
    found: dict[str, Any] = {}
    paths = [path for path in list_recordings() if given.only in str(path)][:: choose_size(1, 60)]
    if not paths:
        skip(f"no recordings in {DATA}: set KINEME_DATA to the folder that holds them")
    with ProcessPoolExecutor(2) as pool:
        for tables in pool.map(segment_recording, paths):
            found |= tables
    if given.write:
        given.write.write_text(json.dumps(found), encoding="utf-8")
        print(f"{len(found)} tables of {len(paths)} recordings written")
    if given.against:
        before = json.loads(given.against.read_text(encoding="utf-8"))
        before = {name: table for name, table in before.items() if given.only in name}
        differing = [name for name in before if not is_same(before[name], found.get(name))]
        for name in differing:
            old, new = describe_table(before[name]), describe_table(found.get(name))
            print(f"differs: {name}: {old}, now {new}")
        print(f"{len(before) - len(differing)} of {len(before)} tables are equal")
        raise SystemExit(bool(differing))


def list_recordings() -> list[Path]:
    """Return all recordings."""
    found = [path for folder, glob in FOLDERS.items() for path in (DATA / folder).glob(glob)]
    return sorted(path for path in found if path.suffix not in (".asf", ".json"))


def segment_recording(path: Path) -> dict[str, Any]:
    """Return the table or error of each preset, by recording and preset."""
    import kineme

    name = path.relative_to(DATA).as_posix()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found: dict[str, Any] = {}
        for preset in PRESETS:
            try:
                recording = kineme.read(path, fps=RATES.get(path.suffix))
                table = kineme.segment(recording, preset=preset).table
                columns = table.columns()
                # Lists are compared as JSON text, so that nan equals nan.
                found[f"{name}|{preset}"] = {c: values.tolist() for c, values in columns.items()}
            except kineme.KinemeError as error:
                found[f"{name}|{preset}"] = str(error)
    return found


def is_same(before: Any, now: Any) -> bool:
    """Return whether two tables or errors are equal; nan equals nan."""
    return json.dumps(before) == json.dumps(now)


def describe_table(table: Any) -> str:
    """Describe a table in a few words."""
    return f"{len(table['level'])} rows" if isinstance(table, dict) else f"{table!r:.80}"


if __name__ == "__main__":
    main()
