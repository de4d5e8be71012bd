import { fireEvent, waitFor } from "@testing-library/preact";
import { expect, test } from "vitest";
import { Notices } from "../../src/studio/Studio";
import { ReviewPanel } from "../../src/studio/review/ReviewPanel";
import { row, table } from "../studio/tables";
import { show, type Page } from "./page";

const rows = [
  row("primitive", 0, 30, 0, "hop"),
  { ...row("primitive", 30, 60, 1, "squat"), confidence: 0.4 },
  { ...row("primitive", 60, 100, 0, "arms"), confidence: 0.9 },
];

const open = (component = <ReviewPanel />): Promise<Page> =>
  show(component, { ...table(), segments: rows });

const listItems = (page: Page): string[] =>
  page.queryAllByRole("listitem").map((each) => each.textContent);

test("what has the lowest confidence is the first to be looked at", async () => {
  const page = await open();
  expect(listItems(page)).toEqual([
    expect.stringContaining("squat"),
    expect.stringContaining("arms"),
    expect.stringContaining("hop"),
  ]);
  fireEvent.click(page.getByText("Next"));
  expect(page.store.selected.value?.label).toBe("squat");
  await waitFor(() => expect(page.getByRole("status").textContent).toContain("40 %"));
});

test("what was checked leaves the queue, and the next one comes", async () => {
  const page = await open();
  fireEvent.click(page.getByText("Next"));
  fireEvent.click(page.getByText("Checked, next"));
  await waitFor(() => expect(listItems(page)).toHaveLength(2));
  await waitFor(() => expect(page.store.selected.value?.label).toBe("arms"));
  expect(page.getByText("1 of 3")).toBeTruthy();
  expect(page.server.got).toMatchObject([{ kind: "check", frames: [30], checked: true }]);
});

test("once all is checked it says so", async () => {
  const page = await open();
  for (let left = 3; left > 0; left--) {
    await waitFor(() => expect(listItems(page)).toHaveLength(left));
    fireEvent.click(page.getByText("Next"));
    fireEvent.click(page.getByText("Checked, next"));
  }
  await page.findByText("Every segment of this recording is checked.");
});

test("edits that nobody answers are named until they are sent", async () => {
  const page = await open(<Notices />);
  page.server.up = false;
  page.services.session.handleLostConnection = () =>
    void (page.services.session.trouble.value = "Nobody answers.");
  page.services.editor.nameSegment(page.store.primitives.value[0]!, "jump");
  const notice = await page.findByRole("alert");
  await waitFor(() => expect(notice.textContent).toMatch(/Nobody answers.*Not saved yet:.*jump/));
  page.server.up = true;
  page.services.session.trouble.value = null;
  await page.services.session.edited.value!.resume();
  await waitFor(() => expect(notice.textContent).toBe(""));
  expect(page.server.got).toHaveLength(1);
});

test("an edit that is refused is named until that was read", async () => {
  const page = await open(<Notices />);
  page.server.refuses = () => true;
  page.services.editor.nameSegment(page.store.primitives.value[0]!, "jump");
  await waitFor(() => expect(page.getByRole("alert").textContent).toMatch(/Not made: .*jump/));
  fireEvent.click(page.getByLabelText("Dismiss"));
  await waitFor(() => expect(page.getByRole("alert").textContent).toBe(""));
});
