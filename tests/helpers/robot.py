"""A robot that edits at random, and checks after each step that what was confirmed is there.

Where the line is slow it edits without waiting for answers, and sometimes the server dies
meanwhile: as many edits must be made then as undo takes back.
"""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import httpx2 as httpx

import kineme
from kineme.studio.storage.sidecars import make_file_id
from screen import Screen
from studio_server import StudioServer

Rows = list[dict[str, Any]]
EDITS = ("split", "delete", "merge", "nudge", "name", "cluster name", "check", "kind", "segment")
BY_KEY = ("nudge", "nudge", "nudge", "split", "delete", "merge", "name", "check", "kind")
OTHERS = ("undo", "undo", "redo", "reload", "kill", "outage", "other tab", "next")
STEPS = (*EDITS, *EDITS, *3 * ("burst",), *OTHERS)
UNDO = 100
"""Steps that undo goes back."""


class Robot:
    """Two tabs of a studio, and what its tables must be.

    Parameters
    ----------
    context : playwright BrowserContext
    server : StudioServer
        Which may be killed.
    takes : list of Path
        Recordings of its folder.
    seed : int
    latency : float
        Milliseconds that answers take at most; how long, changes with every step.
    """

    def __init__(
        self,
        context: Any,
        server: StudioServer,
        takes: list[Path],
        seed: int,
        *,
        latency: float = 0.0,
    ):
        self.chance, self.latency = random.Random(seed), latency
        self.server, self.takes, self.take = server, takes, takes[0]
        self.tabs = [Screen(context.new_page()) for _ in range(2)]
        self.screen = self.tabs[0]
        self.past: dict[Path, list[Rows]] = {take: [] for take in takes}
        self.future: dict[Path, list[Rows]] = {take: [] for take in takes}
        self.left: dict[Path, list[Rows]] = {take: [] for take in takes}
        self.last: dict[Path, int] = {}
        self.client = httpx.Client(timeout=300)  # one: to make it takes longer than a step
        self.edits = 0
        self.steps: list[str] = []
        self.open()

    def open(self) -> None:
        """Both tabs show the present recording."""
        for tab in self.tabs:
            tab.page.goto(self.server.address_of(self.take))
        for tab in self.tabs:
            tab.opened()
        self.screen.wait("k.unsent.length === 0")

    def step(self, what: str = "") -> str:
        """Do something, at random unless told what; what it was."""
        what = what or self.chance.choice(STEPS)
        self.steps.append(what)
        if self.latency:
            self.screen.slow_down(self.chance.choice([0.0, self.chance.uniform(0, self.latency)]))
        before, revision = self.rows(), self.revision()
        self.nothing_late(revision)
        if what in EDITS:
            self.edit(what)
            self.changed(before, what, revision)
        elif what == "undo":
            self.screen.page.keyboard.press("Control+z")
            self.settled(revision + bool(self.past[self.take]))
            if self.past[self.take]:
                self.future[self.take].append(before)
                self.must_be(self.past[self.take].pop(), what)
        elif what == "redo":
            self.screen.page.keyboard.press("Control+Shift+z")
            self.settled(revision + bool(self.future[self.take]))
            if self.future[self.take]:
                self.past[self.take].append(before)
                self.must_be(self.future[self.take].pop(), what)
        elif what == "reload":
            self.screen.page.reload()
            self.screen.opened()
            self.must_be(before, what)
        elif what == "kill":
            self.kill(before, revision)
        elif what in ("burst", "outage"):
            self.hasty(before, revision, outage=what == "outage")
        elif what == "other tab":
            self.screen = self.tabs[1 - self.tabs.index(self.screen)]
            self.screen.wait(f"k.revision === {self.revision()}")
            self.must_be(before, what)
        else:
            self.take = self.chance.choice(self.takes)
            self.open()
        self.on_the_disk(what)
        self.last[self.take] = self.revision()
        return what

    def edit(self, what: str) -> None:
        """One edit, by keys or in the panels, until it is made or refused."""
        self.begin(what)
        self.settled()

    def begin(self, what: str) -> None:
        """One edit, by keys or in the panels."""
        page, keys = self.screen.page, self.screen.page.keyboard
        frames = int(self.screen.state["duration"] * 60)
        page.get_by_label("Frame", exact=True).fill(str(self.chance.randrange(frames)))
        keys.press("Enter")
        if what == "name":
            keys.press("n")
            self.type_name(f"n{self.chance.randrange(10**6)}")
        elif what == "cluster name":
            keys.press("Shift+N")
            self.type_name(f"c{self.chance.randrange(10**6)}")
        elif what == "kind":
            choice = page.locator(".segment-panel select").first
            choice.select_option(index=self.chance.randrange(2))
        elif what == "segment":
            self.segment()
        else:
            way = self.chance.choice(["ArrowLeft", "ArrowRight"])
            nudge = f"Alt+Shift+{way}"
            known = {"split": "s", "delete": "Delete", "merge": "m", "check": "Shift+K"}
            keys.press(known.get(what, nudge))

    def type_name(self, name: str) -> None:
        """A name into the field that waits for it; a segment may be in no cluster to be named."""
        if self.screen.page.evaluate("document.activeElement.type === 'text'"):
            self.screen.page.keyboard.type(name)
            self.screen.page.keyboard.press("Enter")

    def segment(self) -> None:
        """Look at another segmentation, and apply or discard it."""
        page = self.screen.page
        choice = page.get_by_label("Preset", exact=True)
        names = ["kineme", "voegele2014", "krueger2017"]
        names.remove(choice.input_value())
        before = self.rows()
        choice.select_option(self.chance.choice(names))
        self.screen.wait("k.other === 'Preview'")
        self.must_be(before, "preview")
        button = self.chance.choice(["Apply", "Apply", "Discard"])
        page.get_by_role("button", name=button).click()
        self.screen.wait("k.other === null")

    def hasty(self, before: Rows, revision: int, *, outage: bool) -> None:
        """Some edits one after the other, none of which waits for an answer to the one before."""
        count = self.chance.randrange(2, 7)
        dies = self.chance.randrange(1, count) if outage else count
        for number in range(count):
            if number == dies:
                self.server.kill()  # the edits on their way are kept, those that follow not taken
            self.begin(self.chance.choice(BY_KEY))
            self.screen.page.wait_for_timeout(30)
        if outage:
            self.server.start()
            other = self.tabs[1 - self.tabs.index(self.screen)]
            other.page.goto(self.server.address_of(self.take))  # it tells the new token
            other.opened()
            notice = self.screen.page.locator("[data-notice=trouble]")
            notice.wait_for(state="detached")  # until then nothing can be edited
        self.settled()
        made = self.revision() - revision
        if not 0 <= made <= count:
            raise RuntimeError(f"of {count} edits {made} were made")
        tables = [self.rows()]
        for number in range(made):
            self.screen.page.keyboard.press("Control+z")
            self.settled(revision + made + number + 1)
            tables.insert(0, self.rows())
        self.must_be(before, f"undo of {self.steps[-1]}")
        for number in range(made):
            self.screen.page.keyboard.press("Control+Shift+z")
            self.settled(revision + 2 * made + number + 1)
        self.must_be(tables[-1], f"redo of {self.steps[-1]}")
        for rows in tables[:-1]:
            self.counted(rows)

    def kill(self, before: Rows, revision: int) -> None:
        """End the server without warning, sometimes with an edit on its way."""
        page = self.screen.page
        hasty = self.chance.random() < 0.5
        if hasty:
            page.keyboard.press("n")
            self.type_name(f"k{self.chance.randrange(10**6)}")
        self.server.kill()
        self.server.start()
        page.goto(self.server.address_of(self.take))
        self.screen.opened()
        self.screen.wait("k.unsent.length === 0")
        if hasty:
            if (now := self.revision()) != revision + 1:
                raise RuntimeError(f"an edit sent before a kill was made {now - revision} times")
            self.changed(before, "kill", revision)
        else:
            self.must_be(before, "kill")
        other = self.tabs[1 - self.tabs.index(self.screen)]
        other.page.goto(self.server.address_of(self.take))
        other.opened()

    def rows(self) -> Rows:
        """What the page shows."""
        rows: Rows = self.screen.state["segments"]
        return rows

    def revision(self) -> int:
        """Of the table, as the server says."""
        revision: int = self.ask("")["revision"]
        return revision

    def ask(self, address: str) -> Any:
        """What the server answers of the present recording."""
        asked = f"{self.server.root}api/recordings/{make_file_id(self.take)}{address}"
        headers = {"x-kineme-token": self.server.token, "connection": "close"}  # it is killed here
        return self.client.get(asked, headers=headers).json()

    def settled(self, revision: int = 0) -> None:
        """Until the server has confirmed or refused everything, and has that revision or more."""
        self.screen.page.wait_for_timeout(30)
        self.screen.wait(f"k.unsent.length === 0 && k.revision >= {revision}")
        self.screen.wait(f"k.revision === {self.revision()}")

    def nothing_late(self, revision: int) -> None:
        """RuntimeError where something was made after it had counted as refused."""
        if revision != self.last.get(self.take, revision):
            raise RuntimeError(f"{self.steps[-2]} was made after it had counted as refused")

    def changed(self, before: Rows, what: str, revision: int) -> None:
        """Count what an edit of that revision did; nothing, where it was refused."""
        if (now := self.revision()) == revision:
            self.must_be(before, f"refused {what}")
            return
        if now != revision + 1:
            raise RuntimeError(f"{what} was made {now - revision} times")
        if what == "segment":
            self.left[self.take].append(before)
        self.counted(before)

    def counted(self, before: Rows) -> None:
        """Count an edit of a table; what had been undone cannot be redone any more."""
        self.edits += 1
        if self.future[self.take]:
            self.left[self.take].append(self.future[self.take][0])
        self.future[self.take].clear()
        self.past[self.take] = [*self.past[self.take], before][-UNDO:]

    def must_be(self, rows: Rows, what: str) -> None:
        """RuntimeError where the page shows another table."""
        shown = self.rows()
        if shown != rows:
            differ = [row for row in shown if row not in rows][:3]
            last = ", ".join(self.steps[-8:])
            said = f"after {self.edits} edits ({last}), {what}: another table is shown"
            wanted = [row for row in rows if row not in shown][:3]
            raise RuntimeError(f"{said}: {differ} of {len(shown)}, not {wanted} of {len(rows)}")

    def on_the_disk(self, what: str) -> None:
        """RuntimeError where the saved table is not the one that the page shows."""
        path = self.take.with_suffix(".segments.json")
        if not path.exists():
            return
        saved = kineme.read_segments(path).table
        shown = self.rows()
        for name in ("level", "kind", "start_frame", "stop_frame", "cluster", "label"):
            if getattr(saved, name).tolist() != [row[name] for row in shown]:
                raise RuntimeError(f"after {self.edits} edits, {what}: {name} on the disk differs")

    def finish(self) -> None:
        """Everything that was replaced is a version; undo and redo give the same tables."""
        for tab in self.tabs:
            tab.page.close() if tab is not self.screen else tab.slow_down(0)
        self.tabs = [self.screen]
        for take in self.takes:
            self.take = take
            self.open()
            versions = self.ask("/versions")["versions"]
            kept = [
                self.ask(f"/versions/{v['number']}")["segmentation"]["segments"] for v in versions
            ]
            for rows in self.left[take][-50:]:
                if rows not in kept:
                    raise RuntimeError(f"a table of {take.name} that was replaced is gone")
            last, keys, revision = self.rows(), self.screen.page.keyboard, self.revision()
            for i, rows in enumerate(reversed(self.past[take])):
                keys.press("Control+z")
                self.settled(revision + i + 1)
                self.must_be(rows, "undo")
            for i in range(len(self.past[take])):
                keys.press("Control+Shift+z")
                self.settled(revision + len(self.past[take]) + i + 1)
            self.must_be(last, "redo")
            self.future[take].clear()
