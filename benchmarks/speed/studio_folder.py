"""What a morning's work on a folder takes in the studio: keys, clicks, names, seconds.

    python -m benchmarks studio_folder [--record]

In Chromium, which draws with the processor, as a person does it. Twenty recordings
have ten borders between them that are wrong, by up to twelve frames, and have a low confidence:
they are found and moved to where they were with keys alone, and checked. A library of twenty
recordings, five of which somebody has corrected, gets names for all of its clusters, two of
them split so that there are eight, and one action brings them into the corrected ones. Three
people's labels of twenty recordings are compared, which gives kappas. Last a folder of 500
recordings with 100 segments each is shown and gone through.
What is counted is compared with what is on the disk then.
"""

from __future__ import annotations

import os
import tempfile
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

import kineme
from _browser import FLAGS, chromium
from _figures import add_option, record
from _measure import verdict
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.library import Library, build
from kineme.segments.editing import check
from kineme.segments.editing.annotating import marked
from report_in_browser import SIZE, wait
from studio import start

TWENTY, WRONG, FIVE, EIGHT = few((20, 10, 5, 8), (4, 3, 2, 4))
MANY, ROWS, STEPS = few((500, 100, 20), (10, 20, 4))
MOST_KEYS, MOST_ACTIONS, MOST_PAGE_S, MOST_STEP_S = 60, 4, 1.0, 0.2
PEOPLE = {"anna": 0, "ben": 4, "cleo": 40}  # frames by which their borders lie later
LENGTH, WIDTH, FURTHEST = 1200, 100, 12  # frames: of a recording, of a segment, of a mistake
PLACE = "window.kineme.name + JSON.stringify(window.kineme.selected)"


def main() -> None:
    parser = command_line(__doc__)
    add_option(parser)
    parser.parse_args()
    print(f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}")
    with tempfile.TemporaryDirectory() as name, chromium(*FLAGS) as browser:
        tab = browser.new_page(viewport=SIZE)
        for work in (mended, named, compared, shown):
            place = Path(name) / work.__name__
            place.mkdir()
            work(tab, place)


def mended(tab: Any, folder: Path) -> None:
    """The ten worst borders of twenty recordings, each at its place again, and checked."""
    random = np.random.default_rng(3)
    wrong = {}
    edges = np.arange(0, LENGTH + 1, WIDTH)
    for i, path in enumerate(recordings(folder, TWENTY)):
        starts, sure = edges.copy(), np.full(len(edges) - 1, 0.95)
        if i < WRONG:
            at = int(random.integers(2, len(edges) - 2))
            by = int(random.integers(3, FURTHEST + 1)) * int(random.choice([-1, 1]))
            starts[at] += by
            sure[at] = 0.05 + 0.02 * i
            wrong[path] = (int(edges[at]), int(starts[at]))
        write_table(path, starts, sure)
    studio = start(folder)
    tab.goto(f"{studio.base}/?token={studio.token}")
    wait(tab, "document.querySelectorAll('.folder-row .gradient').length > 0")
    keys = Keys(tab)
    keys.press("j")
    for path, (right, found) in wrong.items():
        wait(tab, f"window.kineme.name === '{path.name}' && window.kineme.selected !== null")
        tens, ones = nearest(right - found)
        for count, key in ((tens, "Alt+Shift+Arrow"), (ones, "Alt+Arrow")):
            for _ in range(abs(count)):
                keys.press(key + ("Right" if count > 0 else "Left"))
        keys.press("k")
        saved(tab)
    wait(tab, f"document.querySelector('.queue-bar').innerText.includes('{WRONG} of ')")
    for path, (right, _) in wrong.items():
        table = kineme.read_segments(path.with_suffix(".segments.json"))
        if right not in table.activities.start_frame or len(marked(table, "checked")) != 1:
            raise SystemExit(f"{path.name}: the border is not where it was, or not checked")
    studio.end()
    said = verdict(keys.pressed, MOST_KEYS)
    print(
        f"the {WRONG} worst borders of {TWENTY} recordings: {keys.pressed} keys, 0 clicks; {said}"
    )
    record("studio_folder.borders.keys", keys.pressed)


def named(tab: Any, folder: Path) -> None:
    """Eight names and one action for twenty recordings."""
    (folder / "takes").mkdir()
    paths = recordings(folder / "takes", TWENTY)
    build(folder / "takes", folder / "library")
    library = Library(folder / "library")
    while len(library.clusters()) < EIGHT:
        wide = max(library.clusters(), key=lambda each: each.recordings)
        words = library.table("words").to_pylist()
        of = sorted({word["recording"] for word in words if word["cluster"] == wide.cluster})
        library.split(wide.cluster, of[: len(of) // 2])
        library = Library(folder / "library")
    names = {each.cluster: f"movement {each.cluster}" for each in library.clusters()}
    for path in paths[:FIVE]:  # as found by themselves, and corrected
        table = kineme.segment(kineme.read(path))
        kineme.write_segments(
            check(table, "activity", [0], checked=True), path.with_suffix(".segments.json")
        )
    studio = start(folder / "library")
    tab.goto(f"{studio.base}/?token={studio.token}")
    wait(tab, f"document.querySelectorAll('.card').length === {len(names)}")
    for cluster, name in names.items():
        tab.get_by_label(f"Name of cluster {cluster}", exact=True).focus()
        tab.keyboard.type(name)
        tab.keyboard.press("Enter")
    wait(tab, "[...document.querySelectorAll('.card input')].every((field) => field.value)")
    tab.wait_for_timeout(1000)
    begun = perf_counter()
    tab.get_by_role("button", name="Numbers and names to").press("Enter")
    wait(tab, "document.body.innerText.includes('Other numbers or names in')")
    took = perf_counter() - begun
    told = Library(folder / "library").table("segments").to_pylist()
    for path in paths[:FIVE]:
        table = kineme.read_segments(path.with_suffix(".segments.json"))
        of_library = [row["label"] for row in told if row["recording"] == path.name]
        if table.table.label.tolist() != of_library or len(marked(table, "checked")) != 1:
            raise SystemExit(f"{path.name}: has not the names of the library, or lost its mark")
    studio.end()
    print(f"{len(names)} clusters named in {TWENTY} recordings: {len(names)} names, 1 action")
    print(f"  {took:.2f} s for the {FIVE} that were corrected")
    record("studio_folder.names", len(names))
    record("studio_folder.names.tables", round(took, 2), unit="s")


def compared(tab: Any, folder: Path) -> None:
    """Three people's labels of twenty recordings, and how far they agree."""
    edges = np.arange(0, LENGTH + 1, WIDTH)
    for path in recordings(folder, TWENTY):
        write_table(path, edges, np.full(len(edges) - 1, 0.9))
        for who, later in PEOPLE.items():
            (folder / who).mkdir(exist_ok=True)
            starts = np.append(0, edges[1:] + later)
            rows = "".join(
                f"{start},{min(stop, LENGTH)},movement {i % 3}\n"
                for i, (start, stop) in enumerate(pairwise(starts))
            )
            table = folder / who / f"{path.stem}.csv"
            table.write_text(f"start_frame,stop_frame,label\n{rows}")
    studio = start(folder)
    tab.goto(f"{studio.base}/?token={studio.token}")
    wait(tab, "document.querySelectorAll('.folder-row .gradient').length > 0")
    actions = (
        tab.get_by_role("button", name="Open session").first,
        tab.get_by_role("button", name="Compare…").first,
        tab.get_by_role("button", name=f"Compare {len(PEOPLE)} people"),
    )
    begun = perf_counter()
    for action in actions:
        action.click()
    wait(tab, f"window.kineme.others.length === {len(PEOPLE)}")
    took = perf_counter() - begun
    rows = tab.locator(".scores tbody tr").all_inner_texts()
    kappas = [float(row.split("\t")[1]) for row in rows]
    if len(kappas) != len(PEOPLE) + 1 or not kappas[0] > max(kappas[1:]) > 0:
        raise SystemExit(f"the agreement of these people is another: {rows}")
    studio.end()
    said = verdict(len(actions), MOST_ACTIONS)
    print(
        f"{len(PEOPLE)} people compared over {TWENTY} recordings: {len(actions)} clicks, ", end=""
    )
    print(f"{took:.1f} s; {said}")
    record("studio_folder.people.clicks", len(actions))


def shown(tab: Any, folder: Path) -> None:
    """The page of a large folder, and steps through it."""
    random = np.random.default_rng(1)
    edges = np.linspace(0, LENGTH, ROWS + 1).astype(int)
    for path in recordings(folder, MANY):
        write_table(path, edges, random.uniform(0.3, 1, ROWS))
    studio = start(folder)
    for when in ("first", "again"):
        begun = perf_counter()
        tab.goto(f"{studio.base}/?token={studio.token}")
        wait(tab, "document.querySelectorAll('.folder-row .gradient').length > 0")
        took = perf_counter() - begun
        print(f"{MANY} recordings of {ROWS} segments, {when}: {took:.2f} s", end="; ")
        print(verdict(took, MOST_PAGE_S))
        record(f"studio_folder.page.{when}", round(took, 2), unit="s")
    times = [step(tab, key) for key in ("j", *"jk" * (STEPS // 2))][1:]
    median, slow = np.median(times), np.percentile(times, 95)
    print(f"{STEPS} steps of the review: median {median:.2f} s, 95 % within {slow:.2f} s; ", end="")
    print(verdict(float(median), MOST_STEP_S))
    record("studio_folder.step", round(float(median), 2), unit="s")
    record("studio_folder.step.slow", round(float(slow), 2), unit="s")
    studio.end()


def step(tab: Any, key: str) -> float:
    """Seconds from a key to another place, which is shown; a person looks at it then."""
    before = tab.evaluate(PLACE)
    begun = perf_counter()
    tab.keyboard.press(key)
    wait(tab, f"{PLACE} !== {before!r} && window.kineme.selected !== null")
    took = perf_counter() - begun
    tab.wait_for_timeout(1000)
    return took


class Keys:
    """A keyboard that counts."""

    def __init__(self, tab: Any):
        self._tab, self.pressed = tab, 0

    def press(self, key: str) -> None:
        self._tab.keyboard.press(key)
        self.pressed += 1


def saved(tab: Any) -> None:
    wait(tab, "window.kineme.unsent.length === 0")


def nearest(frames: int) -> tuple[int, int]:
    """Tens and ones that make so many frames with the fewest keys."""
    tens = round(frames / 10)
    return tens, frames - 10 * tens


def recordings(folder: Path, n: int) -> list[Path]:
    """So many pieces of the bundled recording."""
    head, motion = bundled_recording().read_text().split("MOTION\n")
    _, frame_time, *frames = motion.strip().split("\n")
    paths = [folder / f"session_{i // 20:02d}_take_{i:03d}.bvh" for i in range(n)]
    for i, path in enumerate(paths):
        first = i * (len(frames) - LENGTH) // n
        kept = frames[first : first + LENGTH]
        path.write_text("\n".join([head + "MOTION", f"Frames: {LENGTH}", frame_time, *kept, ""]))
    return paths


def write_table(path: Path, edges: Any, confidences: Any) -> None:
    """A table of activities that start so surely."""
    n = len(edges) - 1
    columns = {
        "level": ["activity"] * n,
        "kind": ["activity"] * n,
        "start_frame": edges[:-1],
        "stop_frame": edges[1:],
        "cluster": np.arange(n) % 8,
        "border_confidence": confidences,
    }
    table = kineme.Segmentation.from_columns(columns, n_frames=LENGTH, fps=60.0)
    kineme.write_segments(table, path.with_suffix(".segments.json"))


if __name__ == "__main__":
    main()
