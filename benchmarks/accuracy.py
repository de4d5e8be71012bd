"""The published methods on the benchmark, beside the accuracies that are promised.

    python benchmarks/accuracy.py [FOLDER OF RECORDINGS]

Strict and tolerant accuracy as their authors coded them, on every trial at
hand; the promise is for the mean of trials 1, 9, 10, 11 and 14. A uniform cut
every half second stands beside, because it passes both under this protocol.
Exits with 1 if a promise is not kept.
"""

from __future__ import annotations

import sys
import warnings
from pathlib import Path

from _options import DATA, command_line, few, is_quick, needed
from agreement import CONFIGURATIONS
from kineme.reproduction.benchmark import METHODS, mean_scores, preset_method, run
from kineme.reproduction.trials import find_folder, load_trials

TRIALS = ("86_01", "86_09", "86_10", "86_11", "86_14")
PROMISED = {
    "voegele2014": (0.91, 0.98),
    "krueger2017": (0.91, 0.975),
    "2017_plain": (0.91, 0.975),  # without bundling
}


def main() -> int:
    parser = command_line(__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=DATA, help="of the recordings")
    folder = parser.parse_args().folder
    needed("cmu86", folder)
    plain = {"2017_plain": preset_method(CONFIGURATIONS["2017_plain"][1])}
    methods = {name: (plain | METHODS)[name] for name in (*PROMISED, "uniform")}
    results = run(load_trials(find_folder(folder), few(TRIALS, TRIALS[:1])), methods)
    print(f"{'trial':8} {'method':12} {'strict':>7} {'tolerant':>9}")
    for result in results:
        scores = result.scores
        print(
            f"{result.trial.name:8} {result.method:12} {scores['strict']:7.4f} "
            f"{scores['tolerant']:9.4f}"
        )
    kept = True
    for name, scores in mean_scores(results).items():
        line = f"{'mean':8} {name:12} {scores['strict']:7.4f} {scores['tolerant']:9.4f}"
        if name in PROMISED:
            strict, tolerant = PROMISED[name]
            good = scores["strict"] >= strict and scores["tolerant"] >= tolerant
            kept &= good
            line += f"   promised {strict:.3f} {tolerant:.3f}   {'kept' if good else 'NOT KEPT'}"
        print(line)
    return 0 if kept or is_quick() else 1


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
