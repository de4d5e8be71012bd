"""What each key does that the help lists, as seen from outside; each leaves all as it was."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from screen import Screen

Check = Callable[[Screen], None]


def state(screen: Screen, condition: str, *keys: str) -> None:
    """Press keys, and wait until a condition on the page's state holds."""
    for key in keys:
        screen.page.keyboard.press(key)
    screen.wait(condition)


def plays(screen: Screen) -> None:
    state(screen, "k.playing", "Space")
    state(screen, "!k.playing", "Space")


def steps(screen: Screen) -> None:
    state(screen, "k.frame === 0", "Home")
    state(screen, "k.frame === 2", "ArrowRight", "ArrowRight")
    state(screen, "k.frame === 1", "ArrowLeft")


def steps_over_segments(screen: Screen) -> None:
    first, second, third = screen.starts()[:3]
    state(screen, f"k.frame === {first}", "Home")
    state(screen, f"k.frame === {third}", "Shift+ArrowRight", "Shift+ArrowRight")
    state(screen, f"k.frame === {second}", "Shift+ArrowLeft")


def loops(screen: Screen) -> None:
    state(screen, "k.loop !== null", "l")
    state(screen, "k.loop === null", "l")


def marks(screen: Screen) -> None:
    state(screen, "k.frame === 0", "Home")
    state(screen, "k.frame === 1", "ArrowRight", "i")
    state(screen, "k.frame === 3", "ArrowRight", "ArrowRight", "o")
    state(screen, "k.loop && Math.abs(k.loop.start_s - 1 / 60) < 0.01", "l")
    state(screen, "k.loop === null", "l")
    state(screen, "k.frame === 1", "o", "ArrowLeft", "ArrowLeft", "i")
    state(screen, "k.loop && k.loop.stop_s - k.loop.start_s > 0.05", "l")
    state(screen, "k.loop === null", "l")


def zooms_to_the_segment(screen: Screen) -> None:
    state(screen, "k.range.stop_s - k.range.start_s < k.duration / 2", "z")
    shows_all(screen)


def fills_the_screen(screen: Screen) -> None:
    side = screen.page.locator(".place-side")
    screen.page.keyboard.press("f")
    side.wait_for(state="hidden")
    screen.page.keyboard.press("f")
    side.wait_for()


def zooms(screen: Screen) -> None:
    shows_all(screen)
    state(screen, "k.range.stop_s - k.range.start_s < 0.8 * k.duration", "+")
    state(screen, "k.range.stop_s - k.range.start_s > 0.9 * k.duration", "-")
    shows_all(screen)


def shows_all(screen: Screen) -> None:
    state(screen, "k.range.stop_s - k.range.start_s >= k.duration - 1e-6", "0")


def jumps(screen: Screen) -> None:
    state(screen, "k.playhead === k.duration", "End")
    state(screen, "k.playhead === 0", "Home")


def changes_detail(screen: Screen) -> None:
    state(screen, "k.other === 'Preview'", ",")
    screen.page.get_by_role("button", name="Discard").click()
    screen.wait("k.other === null")


def shows_curves(screen: Screen) -> None:
    place = screen.page.locator(".place-curves")
    shown = place.count()
    screen.page.keyboard.press("g")
    place.wait_for(state="detached" if shown else "attached")
    screen.page.keyboard.press("g")
    place.wait_for(state="attached" if shown else "detached")


def lays_a_ghost(screen: Screen) -> None:
    to_a_segment(screen)
    ghost = screen.page.get_by_text("ghost:")
    screen.page.keyboard.press("v")
    ghost.wait_for()
    screen.page.keyboard.press("v")
    ghost.wait_for(state="detached")


def names_by_number(screen: Screen) -> None:
    """With a label of the folder; here it has none, and the page says where to add one."""
    screen.page.keyboard.press("1")
    screen.page.get_by_text("No label is on the key 1 yet").wait_for()


def edits(*keys: str, more: int, again: bool = False) -> Check:
    """A key that changes the table, by so many rows; it is undone, and with ``again`` redone."""

    def check(screen: Screen) -> None:
        to_a_segment(screen)
        before = screen.state["segments"]
        state(screen, f"k.segments.length === {len(before) + more}", *keys)
        after = screen.state["segments"]
        steps = [("Control+z", before), ("Control+Shift+z", after), ("Control+z", before)]
        for key, rows in steps if again else steps[:1]:
            revision = screen.state["revision"]
            state(screen, f"k.revision > {revision}", key)
            assert screen.state["segments"] == rows, key

    return check


def moves_a_border(screen: Screen) -> None:
    to_a_segment(screen)
    start = screen.state["frame"]
    moved = f"k.segments.some((row) => row.start_frame === {start + 1})"
    state(screen, moved, "Alt+ArrowRight")
    state(screen, f"!({moved})", "Control+z")


def brings_a_border(screen: Screen) -> None:
    for key in "[]":
        to_a_segment(screen)
        start = screen.state["frame"]
        state(screen, f"k.frame === {start + 2}", "ArrowRight", "ArrowRight")
        here = f"k.segments.some((row) => row.start_frame === {start + 2})"
        state(screen, here, key)
        state(screen, f"!({here})", "Control+z")


def to_a_segment(screen: Screen) -> None:
    """To the fifth primitive, whichever level what came before has left."""
    state(screen, "k.frame === 0", "0", "Home")
    state(screen, "k.frame > 0 && k.selected !== null", "Shift+ArrowRight")
    if screen.state["selected"]["level"] == "activity":
        screen.page.keyboard.press("a")
    state(screen, "k.frame === 0", "Home")
    fifth = screen.starts()[4]
    state(screen, f"k.frame === {fifth}", *["Shift+ArrowRight"] * 4)


def changes_level(screen: Screen) -> None:
    to_a_segment(screen)
    n = len(screen.starts("activity"))
    keys = ["a", "ArrowRight", "ArrowRight", "s"]
    state(screen, f"k.segments.filter((row) => row.level === 'activity').length === {n + 1}", *keys)
    state(screen, f"k.segments.filter((row) => row.level === 'activity').length === {n}",
          "Control+z", "a")  # fmt: skip


def names(key: str) -> Check:
    def check(screen: Screen) -> None:
        to_a_segment(screen)
        revision = screen.state["revision"]
        screen.page.keyboard.press(key)
        focused = "document.activeElement.matches('.segment-panel input[type=text]')"
        state(screen, focused)
        state(screen, f"!{focused} && k.revision === {revision}", "x", "Escape")

    return check


def looks_at_the_next(screen: Screen) -> None:
    state(screen, "k.selected !== null", "j")
    first = screen.state["selected"]
    state(screen, f"k.selected.start_frame !== {first['start_frame']}", "j")


def checks(key: str) -> Check:
    def check(screen: Screen) -> None:
        to_a_segment(screen)
        revision = screen.state["revision"]
        state(screen, f"k.revision > {revision} && k.unsent.length === 0", key)
        state(screen, f"k.revision > {revision + 1} && k.unsent.length === 0", "Control+z")

    return check


def cancels(screen: Screen) -> None:
    for key in (",", "Escape"):
        screen.page.keyboard.press(key)
    screen.page.wait_for_timeout(800)
    assert screen.state["other"] is None  # the preview that was to come


def opens_the_next(screen: Screen) -> None:
    name = screen.state["name"]
    state(screen, f"k.name !== '{name}' && k.hasMotion", "PageDown")
    state(screen, f"k.name === '{name}' && k.hasMotion", "PageUp")


def shows_a_dialog(key: str) -> Check:
    def check(screen: Screen) -> None:
        dialog: Any = screen.page.locator("dialog[open]")
        screen.page.keyboard.press(key)
        dialog.wait_for()
        screen.page.keyboard.press("Escape")
        dialog.wait_for(state="detached")

    return check


# "Ctrl + Z" is pressed after each edit.
CHECKS: dict[str, Check] = {
    "Space": plays,
    "← →": steps,
    "Shift + ← →": steps_over_segments,
    "L": loops,
    "I, O": marks,
    "Z": zooms_to_the_segment,
    ", .": changes_detail,
    "V": lays_a_ghost,
    "G": shows_curves,
    "F": fills_the_screen,
    "+ −": zooms,
    "Home, End": jumps,
    "0": shows_all,
    "S": edits("ArrowRight", "ArrowRight", "s", more=1),
    "M": edits("m", more=-1),
    "Delete": edits("Delete", more=-1),
    "[, ]": brings_a_border,
    "Alt + ← →": moves_a_border,
    "A": changes_level,
    "N": names("n"),
    "Shift + N": names("Shift+N"),
    "1 … 9": names_by_number,
    "J": looks_at_the_next,
    "K": checks("k"),
    "Shift + K": checks("Shift+K"),
    "X": checks("x"),
    "Page Down, Page Up": opens_the_next,
    "Ctrl + Z": edits("m", more=-1),
    "Ctrl + Shift + Z": edits("m", more=-1, again=True),
    "H": shows_a_dialog("h"),
    "T": shows_a_dialog("t"),
    "C": shows_a_dialog("c"),
    "E": shows_a_dialog("e"),
    "Escape": cancels,
    "?": shows_a_dialog("?"),
}
