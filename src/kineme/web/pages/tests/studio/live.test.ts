import { expect, test } from "vitest";
import type { LiveEvent, LiveUpdate } from "../../src/messages";
import {
  listPartsToDraw,
  describeStatus,
  computeTempo,
  applyUpdate,
  type Live,
} from "../../src/studio/live/live";

const HEAD = { channels: ["x"], sample_fps: 25, bones: [] };
const BLANK = { stop_s: 0, cluster: 0, label: "", number: 0, repetitions: 0, text: "" };

function event(kind: LiveEvent["event"], more: Partial<LiveEvent>): LiveEvent {
  return { ...BLANK, event: kind, at_s: 9, state: "provisional", start_s: 0, ...more };
}

function update(now_s: number, events: LiveEvent[], more: Partial<LiveUpdate> = {}): LiveUpdate {
  const rest = { head: null, silent_s: 0, has_ended: false, first_s: 0, samples: [], pose: [] };
  return { ...rest, now_s, events, ...more };
}

function repetition(number: number, state: LiveEvent["state"] = "provisional"): LiveEvent {
  return event("Repetition", { state, number, start_s: 2 * number - 2, stop_s: 2 * number });
}

const started = event("ActivityStarted", { label: "squat" });

function shown(...events: LiveEvent[]): Live {
  return applyUpdate(null, update(6, events, { head: HEAD }))!;
}

test("the count, its tempo, and what is sure of it", () => {
  const final = event("ActivityStarted", { state: "final", label: "squat" });
  const live = shown(
    started,
    ...[1, 2, 3].map((n) => repetition(n)),
    final,
    repetition(1, "final"),
  );
  expect(live.current).toMatchObject({ name: "squat", count: 3 });
  expect(computeTempo(live.current!.stops)).toBe(30);
  const drawn = listPartsToDraw(live, "repetitions");
  expect(drawn.map(({ start_s, isFinal }) => [start_s, isFinal])).toEqual([
    [0, true],
    [2, false],
    [4, false],
  ]);
  expect(listPartsToDraw(live, "activities").map(({ stop_s }) => stop_s)).toEqual([2, 6]);
});

test("an hour leaves no more than what is shown", () => {
  let live: Live | null = shown();
  for (let n = 1; n < 1800; n++) {
    const whole = event("ActivityEnded", { state: "final", start_s: 2 * n - 2, stop_s: 2 * n });
    const events = [started, repetition(n), repetition(n, "final"), whole];
    const samples = Array.from({ length: 50 }, () => [1]);
    live = applyUpdate(live, update(2 * n, events, { first_s: 2 * n - 2, samples }));
  }
  expect(live!.final.repetitions.length).toBeLessThan(70);
  expect(live!.provisional.repetitions.length).toBeLessThan(70);
  expect(live!.samples.length).toBeLessThanOrEqual(500);
  expect(live!.past.length).toBe(200);
});

test("what is wrong with the source is said", () => {
  expect(describeStatus(null, true)).toContain("Waiting");
  const gap = event("Gap", { start_s: 5 });
  expect(describeStatus(shown(gap), true)).toContain("Gap");
  expect(describeStatus(shown(gap, { ...gap, state: "final", stop_s: 6 }), true)).toBe(
    "Recording.",
  );
  expect(describeStatus(applyUpdate(shown(), update(6, [], { silent_s: 3 })), true)).toContain(
    "stopped",
  );
  expect(describeStatus(shown(), false)).toContain("does not answer");
  expect(describeStatus(applyUpdate(shown(), update(6, [], { has_ended: true })), false)).toContain(
    "ended",
  );
});
