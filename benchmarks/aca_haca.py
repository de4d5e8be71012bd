"""ACA and HACA against the original program's recorded runs: accuracy, objective, time.

    python benchmarks/aca_haca.py [TRIAL ...]

Accuracy is the authors' own (blocks, truth cut at the mean marks). Seconds are
processor time on one thread, so that other work on the machine does not count;
the recorded ones are wall time under GNU Octave (searches in compiled C++) on
two shared cores of another machine, so a ratio is an order of magnitude.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

import kineme
from kineme.evaluation import Labelling
from kineme.features.rotations import joint_quaternions, log_maps
from kineme.methods.baselines import aca, haca
from kineme.methods.baselines.reduction import block_starts, frame_kernel
from kineme.methods.baselines.segments import Segments
from kineme.reproduction import read_trials
from kineme.reproduction.aca_protocol import aca_accuracy

ROOT = Path(__file__).resolve().parents[1]
DATA = Path(os.environ.get("KINEME_DATA", ROOT.parent / "shared" / "data")) / "cmu86"
TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
SEEDS = (1, 2, 3, 4, 5)
STAGES = ("reduce", "kernel", "aca_ini", "aca", "haca_ini", "haca")


def values(reference: dict[str, Any]) -> dict[str, Any]:
    """The parameters of a recorded run, under the names of this package."""
    one, two = reference["parameters"]["aca"], reference["parameters"]["haca"]
    return {
        "classes": int(one["k"]),
        "centres": int(one["kF"]),
        "lengths": (int(one["nMi"]), int(one["nMa"])),
        "fine": (int(two[0]["nMi"]), int(two[0]["nMa"])),
        "coarse": (int(two[1]["nMi"]), int(two[1]["nMa"])),
    }


def stage_seconds(features: np.ndarray, v: dict[str, Any], seed: int) -> dict[str, float]:
    """Processor seconds of the stages that the recorded runs tell apart."""
    random, seconds = np.random.RandomState(seed), {}

    def timed(stage: str, work: Callable[[], Any]) -> Any:
        began = time.process_time()
        result = work()
        seconds[stage] = time.process_time() - began
        return result

    def first(classes: int, lengths: tuple[int, int], starts: int) -> list[aca.State]:
        return list(aca.initial_states(kernel, classes, *lengths, starts, random))

    blocks = timed("reduce", lambda: block_starts(features, centres=v["centres"], random=random))
    kernel = timed("kernel", lambda: frame_kernel(features[blocks]))
    weights = np.ones(len(blocks))
    states = timed("aca_ini", lambda: first(v["classes"], v["lengths"], 1))
    longest = v["lengths"][1]
    timed("aca", lambda: aca.improve(kernel, weights, states[0], v["classes"], longest))
    states = timed("haca_ini", lambda: first(haca.FINE_CLASSES, v["fine"], haca.FINE_STARTS))

    def both_levels() -> None:
        for state in states:
            fine = aca.improve(kernel, weights, state, haca.FINE_CLASSES, v["fine"][1])
            haca.second_level(kernel, weights, fine, v["classes"], v["coarse"], random)

    timed("haca", both_levels)
    return seconds


def found(features: np.ndarray, v: dict[str, Any], seed: int) -> dict[str, Segments]:
    shared = {"n_classes": v["classes"], "centres": v["centres"], "seed": seed}
    shortest, longest = v["lengths"]
    return {
        "aca": aca.aca(features, shortest=shortest, longest=longest, **shared),
        "haca": haca.haca(features, fine_lengths=v["fine"], coarse_lengths=v["coarse"], **shared),
    }


def compare(trial: str) -> None:
    reference = json.loads((DATA / "reference" / f"aca_haca_{trial}.json").read_text())
    truth = read_trials(DATA / "annotations.json", fps=120.0)[trial]
    features = log_maps(joint_quaternions(kineme.read(DATA / f"{trial}.amc")))
    v = values(reference)
    results = [found(features, v, seed) for seed in SEEDS]
    for method in ("aca", "haca"):
        ours = []
        for seed, result in zip(SEEDS, results, strict=True):
            random = np.random.RandomState(seed)
            blocks = block_starts(features, centres=v["centres"], random=random)
            segments = result[method]
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
    seconds = [stage_seconds(features, v, seed) for seed in SEEDS]
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


if __name__ == "__main__":
    with threadpool_limits(1):
        for name in sys.argv[1:] or TRIALS:
            compare(name)
