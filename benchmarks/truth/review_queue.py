"""Whether the studio's review queue leads to what is wrong: 20 recordings, by keys alone.

    python -m benchmarks review_queue [--share 0.2] [--mend] [--record]

The five trials of subject 86 and fifteen sequences of HDM05 exercises, of other seeds than those
that probabilities were learnt from, are opened one after the other in Chromium. ``J`` goes
through the first fifth of the queue. A wrong border counts as shown where a segment
that starts there is, a wrong count and a wrong cluster where their activity is. With ``--mend``
a border shown that is wrong is mended on the way: moved to the true one if that is near and
nobody has it, else deleted; the queue is then another. What is right is judged as in
confidence.py.
"""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import kineme
from _browser import FLAGS, chromium
from _figures import add_option, record
from _options import command_line
from _recordings import Case, hdm05, subject_86
from _sources import NEAR_S
from confidence import (
    Segments,
    Truth,
    in_seconds,
    right_borders,
    right_counts,
    right_cuts,
    right_links,
    truth_of,
)
from kineme.studio.storage.listed import file_id
from report_in_browser import SIZE, wait
from studio import start

PROMISED = 0.6  # of wrong borders and counts
UNSEEN = 60  # seeds that confidence.py learns from
NEAR = 1.5  # seconds to a true border that a wrong one is moved to
KINDS = ("border", "count", "cluster", "cut")


class Review:
    """A page whose recordings are looked through by keys."""

    def __init__(self, page: Any):
        self.page, self.pressed = page, 0

    def press(self, key: str) -> None:
        self.page.keyboard.press(key)
        self.pressed += 1

    @property
    def rows(self) -> list[dict[str, Any]]:
        rows: list[dict[str, Any]] = self.page.evaluate("window.kineme.segments")
        return rows

    def next(self) -> dict[str, Any]:
        """The next segment to look at."""
        self.press("j")
        row: dict[str, Any] = self.page.evaluate("window.kineme.selected")
        return row

    def mend(self, row: dict[str, Any], truth: Truth, fps: float) -> None:
        """Move the border that a segment starts at, or delete it."""
        own = [each["start_s"] for each in self.rows if each["level"] == row["level"]]
        at = row["start_s"]
        wanted = [
            (early + late) / 2
            for early, late in truth.borders
            if not any(early - NEAR_S <= t <= late + NEAR_S for t in own)
        ]
        to = min(wanted, key=lambda t: abs(t - at), default=np.inf)
        revision = self.page.evaluate("window.kineme.revision")
        if abs(to - at) > NEAR:
            self.press("Delete")
        else:
            far, near = divmod(abs(round((to - at) * fps)), 10)
            arrow = "ArrowRight" if to > at else "ArrowLeft"
            for key in [f"Alt+Shift+{arrow}"] * far + [f"Alt+{arrow}"] * near:
                self.press(key)
        wait(self.page, f"window.kineme.revision > {revision}")
        wait(self.page, "window.kineme.unsent.length === 0")


def cases() -> Iterator[Case]:
    """Subject 86, and sequences of HDM05 with three to six, and with two or three repetitions."""
    yield from subject_86()
    yield from hdm05(8, first=UNSEEN)
    yield from hdm05(7, first=UNSEEN, runs=10, repeats=(2, 3))


def segments_of(rows: list[dict[str, Any]], case: Case) -> Segments:
    """What a page shows, in seconds."""
    names = ("level", "kind", "start_frame", "stop_frame", "cluster")
    columns: Any = {name: np.array([row[name] for row in rows]) for name in names}
    columns["kind"][columns["kind"] == "primitive"] = "activity"  # as methods call them
    return in_seconds(columns, case.motion.fps)


def wrong(truth: Truth, found: Segments) -> dict[str, list[tuple[str, float]]]:
    """What is wrong, by kind: the level and start of the segment that it is looked for at."""
    middle = found.edges[:-1]
    return {
        "border": [
            ("", middle[g]) for g, right in right_borders(truth, found, NEAR_S) if not right
        ],
        "count": [("activity", middle[g]) for g, right in right_counts(truth, found) if not right],
        "cluster": [("activity", middle[g]) for g, right in right_links(truth, found) if not right],
        "cut": [("", found.cuts[p]) for p, right in right_cuts(truth, found) if not right],
    }


def is_shown(level: str, at: float, shown: list[tuple[str, float]]) -> bool:
    """Whether a segment was looked at that starts there; of any level where none is named."""
    return any(abs(at - start) < 1e-3 and level in ("", of) for of, start in shown)


def look_through(
    review: Review, case: Case, share: float, totals: Counter[str], *, mend: bool
) -> None:
    """The first part of the queue of the recording that is open, and what was wrong in it."""
    truth, rows = truth_of(case), review.rows
    faults = wrong(truth, segments_of(rows, case))
    bad = {round(at * case.motion.fps) for _, at in faults["border"]}
    shown: list[tuple[str, float]] = []
    for _ in range(round(share * len(rows))):
        row = review.next()
        shown.append((row["level"], row["start_s"]))
        if mend and row["level"] == "activity" and row["start_frame"] in bad:
            review.mend(row, truth, case.motion.fps)
    after = wrong(truth, segments_of(review.rows, case))
    totals["rows"] += len(rows)
    totals["looks"] += len(shown)
    for kind in KINDS:
        totals[kind] += len(faults[kind])
        totals[f"{kind} shown"] += sum(is_shown(*fault, shown) for fault in faults[kind])
        totals[f"{kind} after"] += len(after[kind])


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--share", type=float, default=0.2, help="of the queue")
    parser.add_argument("--mend", action="store_true", help="wrong borders, on the way")
    add_option(parser)
    options = parser.parse_args()
    totals: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as name, chromium(*FLAGS) as browser:
        paths, known = [], list(cases())
        for i, case in enumerate(known):
            paths.append(Path(name) / f"{i:02d}.bvh")
            kineme.write(case.motion, paths[-1])
        studio = start(Path(name))
        review = Review(browser.new_page(viewport=SIZE))
        review.page.goto(f"{studio.base}/?token={studio.token}&open={file_id(paths[0])}")
        for path, case in zip(paths, known, strict=True):
            wait(review.page, f"window.kineme?.name === '{path.name}'")
            wait(review.page, "window.kineme.hasMotion && !window.kineme.finding")
            look_through(review, case, options.share, totals, mend=options.mend)
            review.press("PageDown")
        studio.end()
    report(totals, review.pressed, options.share)


def report(totals: Counter[str], pressed: int, share: float) -> None:
    """What was shown of what was wrong, and what is left."""
    print(f"{totals['looks']} of {totals['rows']} segments looked at, {pressed} keys pressed")
    for kind in KINDS:
        shown, all_of_it = totals[f"{kind} shown"], totals[kind]
        print(f"  wrong {kind}s: {shown} of {all_of_it} shown, {totals[f'{kind} after']} left")
        record(f"review_queue.{kind}", f"{shown} of {all_of_it}")
    both = (totals["border shown"] + totals["count shown"]) / (totals["border"] + totals["count"])
    verdict = "kept" if both >= PROMISED else "NOT KEPT"
    print(f"of wrong borders and counts {both:.2f} in the first {share:.0%}; {PROMISED}: {verdict}")
    record("review_queue.share", round(both, 2))
    record("review_queue.keys", pressed)


if __name__ == "__main__":
    main()
