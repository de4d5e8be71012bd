"""ACA and HACA against the original program's recorded runs: accuracy, objective, time.

    python -m benchmarks aca_haca [TRIAL ...]

Accuracy is the authors' own (blocks, truth cut at the mean marks). Seconds are
processor time on one thread, so that other work on the machine does not count;
the recorded ones are wall time under GNU Octave (searches in compiled C++) on
two shared cores of another machine, so a ratio is an order of magnitude.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

import kineme
from _options import DATA, command_line, few, needed
from kineme.evaluation import Labelling
from kineme.evaluation.annotations import read_trials
from kineme.features.rotations import joint_quaternions, log_maps
from kineme.methods import PRESETS
from kineme_reproduction.baselines import aca, haca
from kineme_reproduction.baselines.constants import AcaConstants, HacaConstants
from kineme_reproduction.baselines.reduction import block_starts, frame_kernel
from kineme_reproduction.benchmark import aca_accuracy

FOLDER = DATA / "cmu86"
TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
SEEDS = (1, 2, 3, 4, 5)
STAGES = ("reduce", "kernel", "aca_ini", "aca", "haca_ini", "haca")


def presets(reference: dict[str, Any]) -> tuple[AcaConstants, HacaConstants]:
    """ACA and HACA with the parameters of a recorded run."""
    one, two = reference["parameters"]["aca"], reference["parameters"]["haca"]
    shared = {"n_classes": int(one["k"]), "centres": int(one["kF"])}
    return (
        PRESETS["aca"].replace(shortest=int(one["nMi"]), longest=int(one["nMa"]), **shared),
        PRESETS["haca"].replace(
            fine_lengths=(int(two[0]["nMi"]), int(two[0]["nMa"])),
            coarse_lengths=(int(two[1]["nMi"]), int(two[1]["nMa"])),
            **shared,
        ),
    )


def stage_seconds(
    features: np.ndarray, one: AcaConstants, two: HacaConstants, seed: int
) -> dict[str, float]:
    """Processor seconds of the stages that the recorded runs tell apart."""
    random, seconds = np.random.RandomState(seed), {}

    def timed(stage: str, work: Callable[[], Any]) -> Any:
        began = time.process_time()
        result = work()
        seconds[stage] = time.process_time() - began
        return result

    def first(classes: int, lengths: tuple[int, int], starts: int) -> list[aca.State]:
        return list(aca.initial_states(kernel, classes, lengths, starts, one, random))

    classes, fine_classes, fine_lengths = one.required_classes(), two.fine_classes, two.fine_lengths
    blocks = timed("reduce", lambda: block_starts(features, one, random))
    kernel = timed("kernel", lambda: frame_kernel(features[blocks], one.nearest_share))
    weights = np.ones(len(blocks))
    states = timed("aca_ini", lambda: first(classes, (one.shortest, one.longest), 1))
    timed("aca", lambda: aca.improve(kernel, weights, states[0], classes, one.longest, one))
    states = timed("haca_ini", lambda: first(fine_classes, fine_lengths, two.fine_starts))

    def both_levels() -> None:
        for state in states:
            fine = aca.improve(kernel, weights, state, fine_classes, fine_lengths[1], two)
            haca.second_level(kernel, weights, fine, classes, two, random)

    timed("haca", both_levels)
    return seconds


def compare(trial: str) -> None:
    reference = json.loads((FOLDER / "reference" / f"aca_haca_{trial}.json").read_text())
    truth = read_trials(FOLDER / "annotations.json", fps=120.0)[trial]
    features = log_maps(joint_quaternions(kineme.read(FOLDER / f"{trial}.amc")))
    known = presets(reference)
    for preset in known:
        method = preset.name
        ours = []
        for seed in SEEDS:
            blocks = block_starts(features, preset, np.random.RandomState(seed))
            segments = preset.replace(seed=seed).segments(features)
            labelling = Labelling.from_cuts(
                segments.cuts, segments.clusters.tolist(), frames=segments.n_frames, fps=120.0
            )
            ours.append((aca_accuracy(truth, labelling, blocks=blocks), segments.objective))
        theirs = [(r[method]["accuracy"], r[method]["objective"]) for r in reference["runs"]]
        for who, rows in (("ours", ours), ("original", theirs)):
            accuracy, objective = zip(*rows, strict=True)
            print(
                f"{trial} {method:4} {who:8} mean {np.mean(accuracy):.4f} "
                f"each {' '.join(f'{a:.4f}' for a in accuracy)} "
                f"objectives {' '.join(f'{o:.2f}' for o in objective)}"
            )
    seconds = [stage_seconds(features, *known, seed) for seed in SEEDS]
    recorded = [run["seconds_in_octave"] for run in reference["runs"]]
    totals = np.zeros(2)
    for stage in STAGES:
        pair = np.array([np.mean([s[stage] for s in runs]) for runs in (seconds, recorded)])
        totals += pair
        print(
            f"{trial} {stage:8} {pair[0]:7.3f} s, original {pair[1]:6.2f} s: "
            f"{pair[1] / pair[0]:5.1f} times"
        )
    print(
        f"{trial} all      {totals[0]:7.3f} s, original {totals[1]:6.2f} s: "
        f"{totals[1] / totals[0]:5.1f} times"
    )


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("trials", nargs="*", default=few(TRIALS, TRIALS[:1]))
    needed("cmu86")
    with threadpool_limits(1):
        for name in parser.parse_args().trials:
            compare(name)


if __name__ == "__main__":
    main()
