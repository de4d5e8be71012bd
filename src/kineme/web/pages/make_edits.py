"""What each edit makes of some tables, for the pages to compare what they foresee with.

    python src/kineme/web/pages/make_edits.py

writes ``tests/studio/edits.json``: tables, and after each of a chain of random edits the rows,
who they are, what people said of them, and what an answer tells of the edit. The pages show an
edit before the server has answered (``src/studio/editing/foreseen``), and make the table of its
answer (``changes.ts``); their tests hold them to this file, and a test of the package holds the
file to the package.
"""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

from kineme._files import atomic_write
from kineme.errors import ParameterError
from kineme.segments.segmentation import Segmentation
from kineme.segments.table import COLUMNS, Level, kind_of
from kineme.studio.edits import edited
from kineme.studio.storage.identities import Identities
from kineme.web.encoding import from_json, to_json
from kineme.web.page_data import segments_message
from kineme.web.requests import EditRequest
from kineme.web.table_changes import table_change

TARGET = Path(__file__).parent / "tests" / "studio" / "edits.json"
CHAINS, LENGTH = 6, 24
TOLD = [name for name, known in COLUMNS.items() if not known.derived or name == "activity"]
"""Columns of the rows; the others follow from them."""
N_FRAMES = 120
Chance = random.Random


def chains() -> list[dict[str, Any]]:
    """Of each chain the table it starts with, and its edits with what came of each.

    Returns
    -------
    list of dict
        ``after`` is null where an edit cannot be made; ``changes`` are what an answer tells of it,
        and of its undoing.
    """
    return [_chain(random.Random(seed), seed) for seed in range(CHAINS)]  # noqa: S311


def edits_json() -> str:
    """The file: the columns of its rows, and a line for each edit."""
    dense = json.JSONEncoder(ensure_ascii=False, separators=(",", ":"))
    lines = ",\n".join(map(dense.encode, chains()))
    text = f'{{"columns":{dense.encode(TOLD)},"chains":[\n{lines}\n]}}\n'
    return text.replace('{"edit":{"kind"', '\n{"edit":{"kind"')


def _chain(chance: Chance, seed: int) -> dict[str, Any]:
    table, ids = _table(chance, primitives=seed < CHAINS - 1), Identities()
    start, steps = _told(table, ids), []
    for number in range(LENGTH):
        said, name = _edit(chance, table), f"{seed}-{number} and more"
        sent = json.dumps({"revision": 0, "edit": said}).encode()
        edit = from_json(sent, EditRequest).edit
        after: dict[str, Any] | None = None
        changes: list[Any] = []
        try:
            made = edited(table, edit, None, None, None).table  # type: ignore[arg-type]
            before, (table, ids) = (table, ids), (made, ids.after(table, made, name))
            after = _told(table, ids)
            after["excluded"] = after.pop("annotation")["excluded"]
            changes = [_change(before, (table, ids)), _change((table, ids), before)]
        except ParameterError:
            pass
        steps.append({"edit": said, "name": name, "after": after, "changes": changes})
    return {"start": start, "steps": steps}


def _change(before: tuple[Segmentation, Identities], now: tuple[Segmentation, Identities]) -> Any:
    """What a page is told of a table in place of all of it."""
    ids = before[1].of(before[0]), now[1].of(now[0])
    return json.loads(to_json(table_change(before[0], now[0], ids, revision=0)))


def _told(table: Segmentation, ids: Identities) -> dict[str, Any]:
    """What a page is told of a table, as far as edits change it; rows without names of columns."""
    message = json.loads(to_json(segments_message(table)))
    rows = [[row[name] for name in TOLD] for row in message["segments"]]
    names = ("cluster_names", "checked", "by_hand", "comments", "annotation")
    return {"rows": rows, "ids": ids.of(table), **{name: message[name] for name in names}}


def _table(chance: Chance, *, primitives: bool) -> Segmentation:
    """Activities, a transition among them, and primitives that mostly are what these are."""
    borders = [0, 30, 45, 80, N_FRAMES]
    clusters = [0, -1, 1, 0]
    rows: list[tuple[Level, int, int, int]] = [
        ("activity", *span, cluster)
        for span, cluster in zip(pairwise(borders), clusters, strict=True)
    ]
    for _, start, stop, cluster in [*rows] if primitives else []:
        inner = sorted(chance.sample(range(start + 1, stop), 2)) if cluster >= 0 else []
        cuts = [start, *inner, stop]
        for span in pairwise(cuts):
            rows.append(("primitive", *span, chance.choice([cluster, cluster, 2])))
            rows[-1] = rows[-1] if cluster >= 0 else ("primitive", *span, -1)
    columns: dict[str, list[Any]] = {
        "level": [row[0] for row in rows],
        "start_frame": [row[1] for row in rows],
        "stop_frame": [row[2] for row in rows],
        "cluster": [row[3] for row in rows],
        "kind": [kind_of(row[0], transition=row[3] < 0) for row in rows],
        "label": ["walk" if row[3] == 0 else chance.choice(["", "", "own"]) for row in rows],
        "confidence": [round(chance.random(), 2) for _ in rows],
        "border_confidence": [round(chance.random(), 2) for _ in rows],
    }
    return Segmentation.from_columns(columns, n_frames=N_FRAMES, fps=30.0)


def _edit(chance: Chance, table: Segmentation) -> dict[str, Any]:
    """An edit of a table, as a page sends it; not all can be made."""
    kind, make = chance.choice([*_ONE.items(), *2 * [*_OFTEN.items()]])
    return {"kind": kind, **make(chance, table)}


def _level(chance: Chance, table: Segmentation) -> str:
    return chance.choice([row.level for row in table])


def _of_one(chance: Chance, table: Segmentation, **rest: Any) -> dict[str, Any]:
    """Something done to a segment, or to the border it starts at."""
    row = chance.choice(list(table))
    return {"level": row.level, "frame": row.start_frame, **rest}


def _move(chance: Chance, table: Segmentation) -> dict[str, Any]:
    where = _of_one(chance, table)
    far = chance.choice([-1, 1, -10, 10, -25, 25])
    return {**where, "to": where["frame"] + far}


def _split(chance: Chance, table: Segmentation) -> dict[str, Any]:
    return {"level": _level(chance, table), "frame": chance.randrange(N_FRAMES)}


def _merge(chance: Chance, table: Segmentation) -> dict[str, Any]:
    rows = list(table.level(_level(chance, table)))  # type: ignore[arg-type]
    first = chance.randrange(len(rows))
    last = min(first + chance.choice([1, 1, 2]), len(rows) - 1)
    frames = {"start_frame": rows[first].start_frame, "stop_frame": rows[last].stop_frame}
    return {"level": rows[0].level, **frames}


def _cluster(chance: Chance, table: Segmentation, more: int = 0) -> int:
    return chance.randrange(max(int(table.table.cluster.max()) + 1 + more, 1))


def _members(chance: Chance, table: Segmentation) -> dict[str, Any]:
    cluster = _cluster(chance, table)
    rows = table.primitives if len(table.primitives) else table.activities
    starts = [row.start_frame for row in rows if row.cluster == cluster]
    return {"cluster": cluster, "frames": chance.sample(starts, len(starts) // 2)}


def _order(chance: Chance, table: Segmentation) -> dict[str, Any]:
    there = sorted(set(table.table.cluster.tolist()) - {-1})
    return {"order": chance.sample(there, len(there))}


def _checked(chance: Chance, table: Segmentation) -> dict[str, Any]:
    rows = list(table.level(_level(chance, table)))  # type: ignore[arg-type]
    frames = [row.start_frame for row in chance.sample(rows, min(2, len(rows)))]
    return {"level": rows[0].level, "frames": frames, "checked": chance.random() < 0.7}


def _excluded(chance: Chance, table: Segmentation) -> dict[str, Any]:
    rows = list(table.primitives) or list(table)  # of which none can be left out
    frames = [row.start_frame for row in chance.sample(rows, min(2, len(rows)))]
    return {"frames": frames, "excluded": chance.random() < 0.7}


def _name(chance: Chance) -> str:
    return chance.choice(["", "hop", "squat", "über"])


def _together(chance: Chance, table: Segmentation) -> dict[str, Any]:
    rows = chance.sample(list(table), 2)
    name = _name(chance)
    named = [{"level": row.level, "frame": row.start_frame, "label": name} for row in rows]
    return {"edits": [{"kind": "name_segment", **each} for each in named]}


Make = Callable[[Chance, Segmentation], dict[str, Any]]
_OFTEN: dict[str, Make] = {"move_border": _move, "split": _split}
_ONE: dict[str, Make] = {
    "move_border": _move,
    "merge": _merge,
    "delete_border": _of_one,
    "name_segment": lambda chance, table: _of_one(chance, table, label=_name(chance)),
    "name_cluster": lambda chance, table: {
        "cluster": _cluster(chance, table), "label": _name(chance)},
    "set_cluster": lambda chance, table: _of_one(
        chance, table, cluster=_cluster(chance, table, 2) - 1),
    "set_kind": lambda chance, table: _of_one(
        chance, table, to=chance.choice(["activity", "primitive", "transition"])),
    "merge_clusters": lambda chance, table: {
        "cluster": _cluster(chance, table), "into": _cluster(chance, table)},
    "split_cluster": _members,
    "order_clusters": _order,
    "comment": lambda chance, table: _of_one(chance, table, text=chance.choice(["", "why?"])),
    "check": _checked,
    "exclude": _excluded,
    "together": _together,
}  # fmt: skip


if __name__ == "__main__":
    with atomic_write(TARGET) as draft:
        draft.write_text(edits_json(), encoding="utf-8")
