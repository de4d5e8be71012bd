/** Create small segment tables and recordings for tests of the studio. */
import type { Level, Recording, Segment, Segments } from "../../src/messages";
import { createTable, recording as createRecording, segment } from "../recordings";

export const FPS = 10;

/** Create a row. */
export function row(level: Level, start: number, stop: number, cluster = 0, label = ""): Segment {
  return segment(start, stop, { level, cluster, label });
}

/** Create one activity of 100 frames and primitives of 30, 30 and 40. */
export function table(): Segments {
  return createTable([
    row("activity", 0, 100),
    row("primitive", 0, 30, 0),
    row("primitive", 30, 60, 1),
    row("primitive", 60, 100, 0),
  ]);
}

export function recording(segmentation = table()): Recording {
  return createRecording(segmentation);
}

/** Return the start frames of the primitives. */
export function starts(segmentation: Segments): number[] {
  return segmentation.segments
    .filter((segment) => segment.level === "primitive")
    .map((segment) => segment.start_frame);
}
