"""Do the tables stay as they were? Every preset over every recording at hand, kept and compared.

    python -m benchmarks unchanged --write before.json
    python -m benchmarks unchanged --against before.json

A rebuilding that is not meant to change results is held against the tables made
before it: all columns of all rows must be equal. Provenance is not compared.
Recordings that cannot be segmented count by their error. Takes some minutes on
two cores.
"""

from __future__ import annotations

import json
import os
import warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

from _options import DATA, command_line, few, skip

os.environ.setdefault("KINEME_THREADS", "1")  # before the workers start: two of them share cores

PRESETS = ("kineme", "voegele2014", "krueger2017")
FOLDERS = {
    "cmu86": "*.amc",
    "cmu_formats": "*.*",
    "hdm05": "**/*.amc",
    "formats": "*.*",
    "timeseries": "*.txt",
    "sets": "**/recordings/*.parquet",
}
RATES = {".txt": 100.0}  # of files that do not tell


def main() -> None:
    """Write the tables, or compare them."""
    parser = command_line(__doc__)
    parser.add_argument("--write", type=Path, help="file to keep the tables in")
    parser.add_argument("--against", type=Path, help="file that they were kept in")
    parser.add_argument("--only", default="", help="recordings whose path holds this")
    given = parser.parse_args()
    found: dict[str, Any] = {}
    paths = [path for path in recordings() if given.only in str(path)][:: few(1, 60)]
    if not paths:
        skip(f"no recordings in {DATA}: set KINEME_DATA to the folder that holds them")
    with ProcessPoolExecutor(2) as pool:
        for tables in pool.map(tables_of, paths):
            found |= tables
    if given.write:
        given.write.write_text(json.dumps(found), encoding="utf-8")
        print(f"{len(found)} tables of {len(paths)} recordings written")
    if given.against:
        before = json.loads(given.against.read_text(encoding="utf-8"))
        before = {name: table for name, table in before.items() if given.only in name}
        differing = [name for name in before if not same(before[name], found.get(name))]
        for name in differing:
            print(f"differs: {name}: {told(before[name])}, now {told(found.get(name))}")
        print(f"{len(before) - len(differing)} of {len(before)} tables are equal")
        raise SystemExit(bool(differing))


def recordings() -> list[Path]:
    """Every recording at hand."""
    found = [path for folder, glob in FOLDERS.items() for path in (DATA / folder).glob(glob)]
    return sorted(path for path in found if path.suffix not in (".asf", ".json"))


def tables_of(path: Path) -> dict[str, Any]:
    """The table of each preset, or why there is none, by recording and preset."""
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
                # As text, so that nan is nan and no digit is lost.
                found[f"{name}|{preset}"] = {c: values.tolist() for c, values in columns.items()}
            except kineme.KinemeError as error:
                found[f"{name}|{preset}"] = str(error)
    return found


def same(before: Any, now: Any) -> bool:
    """Whether two tables, or two errors, are one; nan is nan."""
    return json.dumps(before) == json.dumps(now)


def told(table: Any) -> str:
    """A table in a few words."""
    return f"{len(table['level'])} rows" if isinstance(table, dict) else f"{table!r:.80}"


if __name__ == "__main__":
    main()
