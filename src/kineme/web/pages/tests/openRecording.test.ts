import { signal } from "@preact/signals";
import { deflateSync } from "node:zlib";
import { expect, test } from "vitest";
import type { Recording } from "../src/messages";
import type { Motion } from "../src/motion";
import { loadMotion, type OpenRecording, type RecordingData } from "../src/recordingData";
import { head } from "./recordings";

test("all poses follow the few that a large recording shows first, also where they overtake", async () => {
  const recording = signal({ motion: head(2) } as Recording);
  const asked: number[] = [];
  const data = {
    loadMotion(n_samples: number) {
      asked.push(n_samples);
      recording.value = { motion: head(5) } as Recording; // it has been read meanwhile
      return Promise.resolve(new Uint8Array(deflateSync(new Uint8Array(12 * n_samples))).buffer);
    },
  } as unknown as RecordingData;
  const opened: OpenRecording = {
    data,
    recording,
    motion: signal<Motion | null>(null),
    keypoints: signal(null),
  };
  await loadMotion(opened);
  expect(asked).toEqual([2, 5]);
  expect(opened.motion.value?.head.n_samples).toBe(5);
  await loadMotion(opened);
  expect(asked).toEqual([2, 5]);
});
