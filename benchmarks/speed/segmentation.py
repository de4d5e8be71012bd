"""Measure how long segmenting 86_10 takes, relative to a matrix product.

    python -m benchmarks segmentation [--runs 21] [--record]

The reference is the float32 product X Y' of the features with a copy of themselves, as a naive
self-similarity matrix needs it. For X X' numpy computes only one half. All times are medians of
runs in turn, after one that is not counted. The authors' program ran under GNU Octave on two cores
of another machine.
"""

from __future__ import annotations

import json
import math
import warnings
from collections import defaultdict
from statistics import median

import numpy as np

import kineme
from _figures import add_option, record
from _measure import judge, time_in_turn
from _options import DATA, choose_size, find_data, make_parser
from kineme.methods.base import Preset
from kineme.methods.prepare import compute_motion_features
from kineme.methods.presets import DEFAULT, PRESETS, PUBLISHED
from kineme.methods.region_growing.preset import KRUEGER2017

PLAIN = KRUEGER2017.replace(bundling=None, radius=0.302 * math.sqrt(5))
MEASURED = {DEFAULT: PRESETS[DEFAULT], **PUBLISHED, "krueger2017, not bundled": PLAIN}
REFERENCES = {
    "voegele2014": "2014_paper",
    "krueger2017": "2017_bundled",
    "krueger2017, not bundled": "2017_plain",
}


def main() -> None:
    parser = make_parser(__doc__)
    parser.add_argument("--runs", type=int, default=choose_size(21, 1))
    add_option(parser)
    runs = parser.parse_args().runs
    motion = kineme.read(find_data("cmu86/86_10.amc"))
    stages: dict[str, dict[str, list[float]]] = {name: defaultdict(list) for name in MEASURED}
    works = {}
    for name, preset in MEASURED.items():
        features = compute_motion_features(motion, preset).astype(np.float32)
        copy = features.copy()

        def whole(name: str = name, preset: Preset = preset) -> None:
            for stage, seconds in kineme.segment(motion, preset=preset).timings.items():
                stages[name][stage].append(seconds)

        works[name] = whole
        works[f"{name} X Y'"] = lambda x=features, y=copy: x @ y.T
        works[f"{name} X X'"] = lambda x=features: x @ x.T
    seconds = time_in_turn(works, runs=runs)
    for name in MEASURED:
        took, product, half = (seconds[f"{name}{what}"] for what in ("", " X Y'", " X X'"))
        print(f"{name}: {1000 * took:.1f} ms")
        key = f"segmentation.{name.replace(', ', '_').replace(' ', '_')}"
        record(f"{key}.milliseconds", round(1000 * took, 1), unit="ms")
        record(f"{key}.products", f"{took / product:.0f}", unit="times")
        record(f"{key}.product", f"{1000 * product:.1f}", unit="ms")
        for stage, times in stages[name].items():
            record(f"{key}.{stage}", round(1000 * median(times), 1), unit="ms")
        parts = (f"{stage} {1000 * median(times):.1f}" for stage, times in stages[name].items())
        print("  of which " + ", ".join(parts))
        print(f"  X Y' {1000 * product:.1f} ms: {took / product:.1f} times", end="")
        print(f"; X X' {1000 * half:.1f} ms: {took / half:.1f} times")
        if name in REFERENCES:
            print(f"  seconds: {judge(took, 0.1)}; times X Y': {judge(took / product, 8)}")
            path = DATA / "cmu86" / "reference" / f"{REFERENCES[name]}_86_10.json"
            octave = sum(json.loads(path.read_text())["seconds_in_octave"].values())
            record(f"{key}.octave", round(octave, 1), unit="s")
            print(f"  the authors' program in Octave: {octave:.1f} s, {octave / took:.0f} times")
    ratio = seconds["kineme"] / seconds["voegele2014"]
    print(f"kineme: {ratio:.2f} times voegele2014; {judge(ratio, 2)}")


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    main()
