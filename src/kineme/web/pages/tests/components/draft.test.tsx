import { fireEvent, render, waitFor } from "@testing-library/preact";
import { expect, test } from "vitest";
import { NameInput, NumberInput } from "../../src/layout/controls";
import { SegmentPanel } from "../../src/studio/panels/SegmentPanel";
import { row, table } from "../studio/tables";
import { show } from "./page";

test("a draft stays while the value changes, and goes to what it was begun for", () => {
  const named: string[] = [];
  const field = (segment: string, value: string) => (
    <NameInput
      aria-label="Name"
      value={value}
      onName={(name) => named.push(`${segment}: ${name}`)}
    />
  );
  const page = render(field("first", "walk"));
  const input = page.getByLabelText("Name") as HTMLInputElement;
  fireEvent.focus(input);
  fireEvent.input(input, { target: { value: "strol" } });
  page.rerender(field("second", "squat"));
  expect(page.getByLabelText("Name")).toBe(input);
  expect(input.value).toBe("strol");
  fireEvent.input(input, { target: { value: "stroll " } });
  fireEvent.blur(input);
  expect(named).toEqual(["first: stroll"]);
  expect(input.value).toBe("squat");
});

test("Escape leaves the name as it was", () => {
  const named: string[] = [];
  const page = render(
    <NameInput aria-label="Name" value="walk" onName={(name) => named.push(name)} />,
  );
  const input = page.getByLabelText("Name") as HTMLInputElement;
  fireEvent.focus(input);
  fireEvent.input(input, { target: { value: "hop" } });
  fireEvent.keyDown(input, { key: "Escape" });
  fireEvent.blur(input);
  expect(named).toEqual([]);
  expect(input.value).toBe("walk");
});

test("each step of a number is handed over at once, and once", () => {
  const given: number[] = [];
  const page = render(
    <NumberInput aria-label="Frame" value={7} onNumber={(number) => given.push(number)} />,
  );
  const input = page.getByLabelText("Frame") as HTMLInputElement;
  fireEvent.focus(input);
  for (const step of ["8", "9"]) {
    fireEvent.input(input, { target: { value: step } });
    fireEvent.change(input);
  }
  expect(given).toEqual([8, 9]);
  fireEvent.blur(input);
  expect(given).toEqual([8, 9]);
});

test("the panel keeps what is typed when the playhead reaches another segment", async () => {
  const rows = [
    row("activity", 0, 100, 0, ""),
    row("primitive", 0, 50, 0, "hop"),
    row("primitive", 50, 100, 1, "squat"),
  ];
  const page = await show(<SegmentPanel />, { ...table(), segments: rows });
  page.store.seek(0.1);
  const comment = await waitFor(() => page.getByPlaceholderText(/others should know/));
  fireEvent.focus(comment);
  fireEvent.input(comment, { target: { value: "slips" } });
  const before = page.getByText(/frames 0/);
  page.store.seek(page.store.duration.value * 0.9);
  await waitFor(() => expect(before.textContent).toContain("frames 50"));
  expect(page.getByPlaceholderText(/others should know/)).toBe(comment);
  expect((comment as HTMLTextAreaElement).value).toBe("slips");
});
