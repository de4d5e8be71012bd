/** Recordings on a page: their data, and how they come. */
import { signal, type ReadonlySignal, type Signal } from "@preact/signals";
import type { MotionHead, Recording } from "./messages";
import { unpackMotion, type Motion } from "./motion";
import type { RecordingData } from "./recordingData";

/** A recording on the page; the table inside `recording` changes with each edit. */
export interface OpenRecording {
  data: RecordingData;
  recording: ReadonlySignal<Recording>;
  /** null without a skeleton, and until it has come. */
  motion: Signal<Motion | null>;
  /** Keypoints in the picture of the video; null without them, and until they have come. */
  keypoints: Signal<Motion | null>;
}

/** What people call the person of a recording, of several in its file; some have only numbers. */
export function personCalled(name: string): string {
  return /^\d+$/.test(name) ? `person ${name}` : name;
}

/** A recording that the page itself may show otherwise. */
export interface ShownRecording extends OpenRecording {
  recording: Signal<Recording>;
}

/** A recording from where its data are; the motion comes later, so that the lanes show at once. */
export async function openRecording(data: RecordingData): Promise<ShownRecording> {
  const recording = signal(await data.recording());
  return { data, recording, motion: signal(null), keypoints: signal(null) };
}

/**
 * Loads the motion of an opened recording, unless it has come: a large one shows few poses of
 * itself until all of it is read.
 */
export async function loadMotion(opened: OpenRecording): Promise<void> {
  const keypoints = loadKeypoints(opened);
  for (;;) {
    const { motion: head } = opened.recording.peek(); // which may be another one meanwhile
    if (!head || isOf(head, opened.motion.peek())) return keypoints;
    opened.motion.value = await unpackMotion(head, await opened.data.motion(head.n_samples));
  }
}

async function loadKeypoints(opened: OpenRecording): Promise<void> {
  const picture = opened.recording.peek().video?.picture;
  if (!picture || opened.keypoints.peek()) return;
  opened.keypoints.value = await unpackMotion(picture.keypoints, await opened.data.keypoints());
}

function isOf({ n_samples, step }: MotionHead, motion: Motion | null): boolean {
  return motion?.head.n_samples === n_samples && motion.head.step === step;
}
