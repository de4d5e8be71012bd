"""Working in the studio: curves, ghosts, many recordings, exports."""

from __future__ import annotations

from screen import PLACES, Screen, box_of, picture_of, until


def test_curves_lie_under_the_timeline_and_follow_its_zoom(page):
    page.keyboard.press("g")
    curves = page.locator(".channels canvas")
    whole = picture_of(curves)
    page.keyboard.press("z")
    until(page, lambda: curves.screenshot() != whole, "curves of the segment alone")
    edge = page.get_by_role("separator", name="Size of curves")
    tall = box_of(curves)["height"]
    edge.press("ArrowUp")
    until(page, lambda: box_of(curves)["height"] == tall + 16, "curves 16 pixels taller")


def test_a_label_of_the_folder_is_given_with_its_key_and_a_comment_stays(page, take):
    screen = Screen(page)
    field = page.get_by_label("A label for all recordings of the folder")
    field.fill("lunge")
    field.press("Enter")
    page.get_by_role("button", name="1 lunge").wait_for()
    field.press("Escape")
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("1")
    screen.wait("k.segments.some((each) => each.label === 'lunge')")
    comment = page.get_by_placeholder("what others should know of it")
    comment.fill("the left foot slips")
    comment.press("Control+Enter")
    table = take.with_suffix(".segments.json")
    screen.saved()
    until(page, lambda: "the left foot slips" in table.read_text(), "the comment is on the disk")
    screen.saved()
    page.reload()
    Screen(page).opened()
    page.keyboard.press("Shift+ArrowRight")
    screen.wait("k.selected")
    until(page, lambda: comment.input_value() == "the left foot slips", "the comment is shown")


def test_chosen_rows_become_a_cluster_or_clips(page):
    screen = Screen(page)
    page.get_by_role("tab", name="Table").click()
    rows = page.locator(".table-rows [role=row]:not(.activity)").filter(has_text="cluster 0")
    rows.nth(0).click()
    rows.nth(1).click(modifiers=["Control"])
    with page.expect_download() as clips:
        page.get_by_role("button", name="Loops…").click()
    assert clips.value.suggested_filename.endswith(".zip")
    clusters = {row["cluster"] for row in screen.lane("primitive")}
    page.get_by_role("button", name="New cluster").click()
    screen.saved()
    assert {row["cluster"] for row in screen.lane("primitive")} == clusters | {max(clusters) + 1}


def test_good_loops_come_first_and_are_saved(page):
    screen = Screen(page)
    page.get_by_role("tab", name="Table").click()
    page.get_by_role("button", name="Loops by quality…").click()
    window = page.get_by_role("dialog", name="Repetitions as loops")
    row = window.locator("tbody tr")
    row.first.wait_for()
    ranks = [int(each) for each in window.locator("tbody tr td:nth-child(2)").all_inner_texts()]
    bests = [index for index, rank in enumerate(ranks) if rank == 1]
    for start, stop in zip(bests, [*bests[1:], len(ranks)], strict=True):
        assert ranks[start:stop] == list(range(1, stop - start + 1))
    checked = window.get_by_role("checkbox", checked=True)
    until(page, lambda: checked.count() == len(bests), "the best are chosen")
    plays = window.get_by_role("button", name="Play cluster")
    plays.nth(1).click()
    plays.first.click()
    figure = window.get_by_role("img", name="round after round")
    figure.wait_for()
    pressed = window.get_by_role("button", name="Play cluster", pressed=True)
    until(page, lambda: pressed.count() == 1, "one plays")
    first = figure.screenshot()
    until(page, lambda: figure.screenshot() != first, "the loop plays")
    window.get_by_role("button", name="Pause").click()
    rest = picture_of(figure)
    until(page, lambda: figure.screenshot() == rest, "the loop rests")
    checked.first.uncheck()
    with page.expect_download() as loops:
        window.get_by_role("button", name=f"Save {len(bests) - 1} as loops").click()
    assert loops.value.suggested_filename.endswith(".zip")
    row.nth(1).get_by_role("button", name="Show").click()
    screen.wait("k.selected")
    window.wait_for(state="hidden")


def test_a_repetition_is_laid_over_another_one(page):
    screen = Screen(page)
    screen.click(screen.lane("primitive")[9])
    screen.wait("k.selected")
    page.keyboard.press("v")
    page.keyboard.press("Shift+ArrowRight")
    page.get_by_text("ghost:").wait_for()
    figure = page.locator(PLACES["figure"])
    laid = picture_of(figure)
    page.get_by_role("button", name="Ghost").click()
    page.get_by_role("button", name="Ghost").click()
    until(page, lambda: figure.screenshot() != laid, "another ghost")
