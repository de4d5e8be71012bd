/** Recordings on a page: their data, and how they come. */
import { signal, type Signal } from "@preact/signals";
import type { Recording } from "./messages";
import { unpackMotion, type Motion } from "./motion";
import type { RecordingData } from "./recordingData";

/** A recording on the page; the table inside `recording` changes with each edit. */
export interface OpenRecording {
  data: RecordingData;
  recording: Signal<Recording>;
  /** null without a skeleton, and until it has come. */
  motion: Signal<Motion | null>;
}

/** A recording from where its data are; the motion comes later, so that the lanes show at once. */
export async function openRecording(data: RecordingData): Promise<OpenRecording> {
  const recording = signal(await data.recording());
  return { data, recording, motion: signal<Motion | null>(null) };
}

/** Loads the motion of an opened recording. */
export async function loadMotion(opened: OpenRecording): Promise<void> {
  const { motion: head } = opened.recording.value;
  if (head) opened.motion.value = await unpackMotion(head, await opened.data.motion());
}
