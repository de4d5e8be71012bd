import { act, fireEvent } from "@testing-library/preact";
import { afterEach, expect, test, vi } from "vitest";
import type { State } from "../../src/messages";
import { OpeningProgress } from "../../src/studio/folder/FolderPanel";
import { listing } from "../studio/briefs";
import { table } from "../studio/tables";
import { show } from "./page";

afterEach(() => void vi.useRealTimers());

test("a recording that takes long can be left while another one is shown", async () => {
  const page = await show(<OpeningProgress />, table());
  const { session } = page.services;
  vi.useFakeTimers();
  const long = { ...listing("long", null), bytes: 156_700_000 };
  await act(() => {
    session.state.value = { recordings: [long] } as unknown as State;
    session.opening.value = "long";
  });
  await act(() => void vi.advanceTimersByTime(3000));
  expect(page.container.textContent).toContain("Reading long.bvh, 156.7 MB: 3 s");
  await act(() => void fireEvent.click(page.getByText("Cancel")));
  expect(page.container.textContent).toBe("");
  expect(session.opening.value).toBeNull();
  expect(page.store.recording.value?.id).toBe("take");
});
