/** Open recordings and load their motion. */
import { signal, type ReadonlySignal, type Signal } from "@preact/signals";
import type { MotionHead, Recording } from "./messages";
import { unpackMotion, type Motion } from "./motion";
import type { RecordingData } from "./recordingData";

/** A recording on the page; edits replace the table inside `recording`. */
export interface OpenRecording {
  data: RecordingData;
  recording: ReadonlySignal<Recording>;
  /** null without a skeleton or while loading. */
  motion: Signal<Motion | null>;
  /** Keypoints in the video; null without them or while loading. */
  keypoints: Signal<Motion | null>;
}

/** Return a person's display name; numbers become "person 1". */
export function formatPerson(name: string): string {
  return /^\d+$/.test(name) ? `person ${name}` : name;
}

/** A recording that the page may change. */
export interface ShownRecording extends OpenRecording {
  recording: Signal<Recording>;
}

/** Open a recording without its motion, so that the lanes show at once. */
export async function openRecording(data: RecordingData): Promise<ShownRecording> {
  const recording = signal(await data.loadRecording());
  return { data, recording, motion: signal(null), keypoints: signal(null) };
}

/** Load a recording's motion, again until all poses of a large recording are there. */
export async function loadMotion(opened: OpenRecording): Promise<void> {
  const keypoints = loadKeypoints(opened);
  for (;;) {
    const { motion: head } = opened.recording.peek(); // it may have changed while loading
    if (!head || isComplete(head, opened.motion.peek())) return keypoints;
    opened.motion.value = await unpackMotion(head, await opened.data.loadMotion(head.n_samples));
  }
}

async function loadKeypoints(opened: OpenRecording): Promise<void> {
  const picture = opened.recording.peek().video?.picture;
  if (!picture || opened.keypoints.peek()) return;
  opened.keypoints.value = await unpackMotion(picture.keypoints, await opened.data.loadKeypoints());
}

function isComplete({ n_samples, step }: MotionHead, motion: Motion | null): boolean {
  return motion?.head.n_samples === n_samples && motion.head.step === step;
}
