/** Create small recordings for tests. */
import { signal } from "@preact/signals";
import {
  bareSegment,
  type MotionHead,
  type Recording,
  type Segment,
  type Segments,
} from "../src/messages";
import type { Motion } from "../src/motion";
import type { RecordingData } from "../src/recordingData";
import { Store } from "../src/store";

export function segment(start: number, stop: number, more: Partial<Segment> = {}): Segment {
  const level = more.level ?? "primitive";
  return {
    ...bareSegment,
    level,
    kind: level,
    start_frame: start,
    stop_frame: stop,
    start_s: start / 10,
    stop_s: stop / 10,
    cluster: 0,
    ...more,
  };
}

/** Create a table of segments. */
export function createTable(segments: Segment[], more: Partial<Segments> = {}): Segments {
  const n_frames = Math.max(...segments.map((each) => each.stop_frame), 0);
  const bare = { schema: "", fps: 10, provenance: {}, timings: {}, cluster_names: {} };
  return { ...bare, n_frames, segments, ...more };
}

/** Create a recording of 100 frames with a table. */
export function recording(segmentation: Segments, more: Partial<Recording> = {}): Recording {
  return {
    id: "take",
    name: "take.bvh",
    n_frames: 100,
    fps: 10,
    motion: null,
    matrix: { fps: 10, tile: 256, sizes: [100] },
    segmentation,
    levels: [],
    video: null,
    read_options: {},
    revision: 0,
    can_undo: false,
    can_redo: false,
    saved: "",
    warnings: [],
    ...more,
  };
}

/** Create a store with an open recording. */
export function openStore(shown: Recording): Store {
  const store = new Store();
  store.add({
    data: {} as RecordingData,
    recording: signal(shown),
    motion: signal(null),
    keypoints: signal(null),
  });
  return store;
}

export function head(n_samples: number, more: Partial<MotionHead> = {}): MotionHead {
  return {
    n_samples,
    sample_fps: 10,
    joints: ["hips", "hand"],
    parents: [-1, 0],
    bones: [[0, 1]],
    origin: [0, 0, 0],
    step: 0.001,
    heading: null,
    effectors: {},
    ...more,
  };
}

/** Create a motion whose joints are at positions that `at` returns, in millimetres. */
export function motion(
  n_samples: number,
  at: (sample: number, joint: number) => [number, number, number],
  more: Partial<MotionHead> = {},
): Motion {
  const steps = new Int16Array(n_samples * 6);
  for (let sample = 0; sample < n_samples; sample++)
    for (const joint of [0, 1]) steps.set(at(sample, joint), 6 * sample + 3 * joint);
  return { head: head(n_samples, more), steps };
}
