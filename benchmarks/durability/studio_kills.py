"""A studio killed while it is told of edits: every edit that it acknowledged is there.

    python -m benchmarks studio_kills [--kills 1000] [--seed 0]

A client splits, merges, moves, names, undoes and redoes without a pause, until the server is
killed at a random moment. The next one must show the table that was acknowledged last, or
that of the edit whose answer was on its way; the table on the disk must be the one shown;
nothing may be said of damage. Needs a system that can fork.
"""

from __future__ import annotations

import os
import random
import shutil
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter
from pathlib import Path
from signal import SIGKILL
from typing import Any

import httpx2 as httpx

import kineme
from _options import command_line, few
from kineme.datasets import bundled_recording
from kineme.studio.app import create_app  # noqa: F401 (loaded before the fork)
from kineme.studio.reading import ReadingOptions
from kineme.studio.server import serve
from kineme.studio.storage.listed import file_id

MOST_EDITS = few(12, 5)
"""Before a server is killed, in the midst of the next."""


def started(folder: Path) -> tuple[int, httpx.Client]:
    """A studio of a folder, as a process of its own, and who asks it."""
    said, saying = os.pipe()
    process = os.fork()
    if process == 0:
        try:
            serve(
                folder,
                None,
                options=ReadingOptions(),
                port=0,
                browser=False,
                announce=lambda address: (
                    os.close(saying) if os.write(saying, address.encode()) else None
                ),
            )
        except Exception:  # noqa: BLE001 (which would otherwise pass for a kill)
            traceback.print_exc()
        finally:
            os._exit(1)
    os.close(saying)
    address, token = os.read(said, 1000).decode().split("?token=")
    os.close(said)
    return process, httpx.Client(base_url=address, headers={"x-kineme-token": token}, timeout=60)


def random_edit(table: dict[str, Any], chance: random.Random) -> dict[str, Any]:
    """Some edit of a table as the studio sends it; some are refused."""
    rows = [row for row in table["segments"] if row["level"] == "activity"]
    row = chance.choice(rows)
    frame, activity = row["start_frame"], {"level": "activity"}
    return chance.choice(
        [
            {"kind": "split", **activity, "frame": chance.randrange(1, rows[-1]["stop_frame"])},
            {
                "kind": "move_border",
                **activity,
                "frame": frame,
                "to": frame + chance.randint(-9, 9),
            },
            {"kind": "name_segment", **activity, "frame": frame, "label": f"n{chance.random()}"},
            {
                "kind": "merge",
                **activity,
                "start_frame": frame,
                "stop_frame": row["stop_frame"] + 1,
            },
            {"kind": "undo"},
            {"kind": "redo"},
        ]
    )


def edit_until_killed(
    client: httpx.Client, place: str, message: dict[str, Any], chance: random.Random, process: int
) -> tuple[dict[str, Any], int]:
    """The last message that was acknowledged, and how many edits were."""
    acknowledged, most, took = 0, chance.randrange(MOST_EDITS), 0.05
    end: threading.Timer | None = None
    while True:
        if acknowledged == most and end is None:
            end = threading.Timer(chance.uniform(0.0, 2.0 * took), os.kill, (process, SIGKILL))
            end.start()
        edit = random_edit(message["segmentation"], chance)
        began = time.perf_counter()
        try:
            answer = client.post(
                f"{place}/edits", json={"revision": message["revision"], "edit": edit}
            )
        except httpx.TransportError:
            return message, acknowledged
        took = time.perf_counter() - began
        if answer.status_code == 200:
            message, acknowledged = {**message, **answer.json()}, acknowledged + 1


def wrong(shown: dict[str, Any], last: dict[str, Any], path: Path) -> list[str]:
    """What is not as it was acknowledged."""
    found = []
    lost = shown["revision"] not in (last["revision"], last["revision"] + 1)
    if lost or (
        shown["revision"] == last["revision"] and shown["segmentation"] != last["segmentation"]
    ):
        found.append("an acknowledged edit is lost")
    if shown["warnings"]:
        found.append(f"damage: {shown['warnings']}")
    rows = [row for row in shown["segmentation"]["segments"] if row["level"] == "activity"]
    starts = [row["start_frame"] for row in rows][1:]
    if path.exists() and kineme.read_segments(path).cuts().tolist() != starts:
        found.append("the table on the disk is another one")
    return found


def main() -> None:
    """Edit, kill, look, count; exit code 1 where something is lost."""
    parser = command_line(__doc__)
    parser.add_argument("--kills", type=int, default=few(1000, 3))
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    os.environ["KINEME_THREADS"] = "1"  # threads do not outlive a fork
    chance, found, edits = random.Random(options.seed), Counter[str](), 0
    with tempfile.TemporaryDirectory() as name:
        take = Path(shutil.copy(bundled_recording(), Path(name) / "take.bvh"))
        place = f"/api/recordings/{file_id(take)}"
        last: dict[str, Any] | None = None
        for kill in range(1, options.kills + 1):
            process, client = started(Path(name))
            with client:
                shown = client.get(place).json()
                if last is not None:
                    found.update(wrong(shown, last, take.with_name("take.segments.json")))
                last, acknowledged = edit_until_killed(client, place, shown, chance, process)
            edits += acknowledged
            _, status = os.waitpid(process, 0)
            if not os.WIFSIGNALED(status):
                sys.exit("the studio ended by itself: what it says is above")
            if kill % 50 == 0 or kill == options.kills:
                said = dict(found) or "nothing lost"
                print(f"{kill} kills, {edits} acknowledged edits: {said}", flush=True)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
