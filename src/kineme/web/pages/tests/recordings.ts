/** Create small recordings for tests. */
import { bareSegment, type MotionHead, type Segment, type Segments } from "../src/messages";
import type { Motion } from "../src/motion";

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
