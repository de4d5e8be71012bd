import { fireEvent, waitFor, within } from "@testing-library/preact";
import { expect, test } from "vitest";
import { SegmentTable } from "../../src/studio/table/SegmentTable";
import { row, table } from "../studio/tables";
import { show, type Page } from "./page";

const rows = [
  row("activity", 0, 100, 0, "gymnastics"),
  row("primitive", 0, 30, 0, "hop"),
  row("primitive", 30, 60, 1, "squat"),
  row("primitive", 60, 100, 0, "arms"),
];

const open = (): Promise<Page> => show(<SegmentTable />, { ...table(), segments: rows });

function names(page: Page): string[] {
  const cells = page.getAllByRole("row").map((each) => within(each).getAllByRole("gridcell")[2]!);
  return cells.map((cell) => cell.textContent.trim());
}

test("segments are in the order that was asked for, and back", async () => {
  const page = await open();
  expect(names(page)).toEqual(["gymnastics", "hop", "squat", "arms"]);
  fireEvent.click(page.getByTitle("Order by name"));
  await waitFor(() => expect(names(page)).toEqual(["arms", "gymnastics", "hop", "squat"]));
  fireEvent.click(page.getByTitle("Order by name"));
  await waitFor(() => expect(names(page)).toEqual(["squat", "hop", "gymnastics", "arms"]));
});

test("a filter leaves what it is for", async () => {
  const page = await open();
  const level = page.getByLabelText("Level");
  fireEvent.change(level, { target: { value: "primitive" } });
  await waitFor(() => expect(names(page)).toEqual(["hop", "squat", "arms"]));
  fireEvent.input(page.getByPlaceholderText("Name or cluster"), { target: { value: "cluster 1" } });
  await waitFor(() => expect(names(page)).toEqual(["squat"]));
  expect(page.getByRole("status").textContent).toBe("1 segment");
});

test("a row that is clicked is chosen everywhere, and what is chosen elsewhere is chosen here", async () => {
  const page = await open();
  fireEvent.click(page.getAllByRole("row")[2]!);
  expect(page.store.selected.value?.label).toBe("squat");
  page.store.select(page.store.primitives.value[2]!);
  await waitFor(() => {
    const chosen = page.getAllByRole("row", { selected: true });
    expect(chosen.map((each) => each.textContent)).toEqual([expect.stringContaining("arms")]);
  });
});

test("all rows from one to another get a name, as one edit", async () => {
  const page = await open();
  const [, first, , last] = page.getAllByRole("row");
  fireEvent.click(first!);
  fireEvent.click(last!, { shiftKey: true });
  await page.findByText("Name 3");
  fireEvent.input(page.getByLabelText("Name for all chosen"), { target: { value: "lunge" } });
  fireEvent.submit(page.getByLabelText("Name for all chosen").closest("form")!);
  await waitFor(() => expect(names(page)).toEqual(["gymnastics", "lunge", "lunge", "lunge"]));
  expect(page.server.got).toMatchObject([{ kind: "together", edits: { length: 3 } }]);
});

test("of ten thousand segments those in sight are there", async () => {
  const many = Array.from({ length: 10_000 }, (_, i) => row("primitive", i, i + 1, 0, `no ${i}`));
  const page = await show(<SegmentTable />, { ...table(), n_frames: 10_000, segments: many });
  expect(page.getAllByRole("row").length).toBeLessThan(40);
  const grid = page.getByRole("grid");
  expect(grid.getAttribute("aria-rowcount")).toBe("10000");
  grid.scrollTop = 26 * 5000;
  fireEvent.scroll(grid);
  await waitFor(() => expect(names(page)).toContain("no 5000"));
});
