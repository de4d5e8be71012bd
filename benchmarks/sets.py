"""Recordings of other laboratories, labelled by people, as ``kineme evaluate FOLDER`` scores them.

    python benchmarks/sets.py [SET ...] [--mapping folder] [--methods kineme uniform] [--record]

Channels of muscles are left out. ``--mapping recording`` (the default) lets clusters stand for
classes of their recording, ``folder`` for the same class in all. ``docs/sensors.md`` quotes what
``--record`` keeps.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from _figures import add_option, record
from kineme.evaluation.folder import evaluate_folder
from kineme.evaluation.recordings import Reading, recordings_below
from kineme.evaluation.tables import markdown
from kineme.labels.collections import labels_of

SETS = ("hugadb", "hapt", "ipolgait", "utkinect")
SHARES = ("mof", "edit", "f1@10", "f1@25", "f1@50")
OTHERS = ("border_f1", "cut_ratio", "seconds_per_hour")
READING = Reading(without=("emg*", "time*"))


def main() -> None:
    parser = argparse.ArgumentParser(description="Scores on sets of labelled recordings.")
    parser.add_argument("sets", nargs="*", default=SETS, help=", ".join(SETS))
    parser.add_argument(
        "--data", type=Path, default=os.environ.get("KINEME_DATA", "../shared/data")
    )
    parser.add_argument("--mapping", choices=("recording", "folder"), default="recording")
    parser.add_argument("--methods", nargs="+", default=["kineme"])
    parser.add_argument("--processes", type=int, default=2)
    add_option(parser)
    options = parser.parse_args()
    rows = []
    for name in options.sets:
        folder = options.data / "sets" / name
        labels = labels_of(recordings_below(folder / "recordings"), folder / "labels.csv")
        scored = evaluate_folder(
            labels,
            options.methods,
            mapping=options.mapping,
            reading=READING,
            processes=options.processes,
        )
        for method in options.methods:
            found = scored.over_all(method)
            shares = {key: 100 * found[key] for key in SHARES}
            for key, value in {**shares, **{key: found[key] for key in OTHERS}}.items():
                record(f"sets.{name}.{options.mapping}.{method}.{key}", round(value, 3))
            failed = sum(bool(one.error) for one in scored.methods[method])
            cells = [f"{value:.1f}" for value in shares.values()]
            cells += [f"{found['border_f1']:.3f}", f"{found['cut_ratio']:.2f}"]
            rows.append([name, method, str(len(labels) - failed), *cells])
    print(markdown(["set", "method", "recordings", *SHARES, *OTHERS[:2]], rows))


if __name__ == "__main__":
    main()
