/** The state of a page: what is open, where the playhead stands, what is selected. */
import { batch, computed, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import type { Level, Recording, Segment, Segments } from "./messages";
import { unpackMotion, type Motion } from "./motion";
import { clustersOf, durationOf, indexAt, laneOf, segmentAt, type Cluster } from "./segments";
import type { RecordingData } from "./recordingData";
import { following, panned, zoomed, type Span } from "./view";

/** A recording on the page; the table inside `recording` changes with each edit. */
export interface OpenRecording {
  data: RecordingData;
  recording: Signal<Recording>;
  /** null without a skeleton, and until it has come. */
  motion: Signal<Motion | null>;
}

/** A segment is known by its level and first frame. */
export interface Selection {
  level: Level;
  start_frame: number;
}

/** What the page asks for when the user drags a border or names a cluster. The report has none. */
export interface EditHooks {
  moveBorder(level: Level, frame: number, to: number): void;
  nameCluster(cluster: number, label: string): void;
}

/** Another result shown below the first. */
export interface OtherResult {
  name: string;
  segmentation: Segments;
}

export class Store {
  /** The recordings shown side by side. */
  readonly opened = signal<OpenRecording[]>([]);
  /** Which of them the timeline, the matrix and the clusters belong to. */
  readonly current = signal(0);
  readonly playhead = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(1);
  readonly loop = signal<Span | null>(null);
  readonly selection = signal<Selection | null>(null);
  /** The number of the cluster that is looked at. */
  readonly cluster = signal<number | null>(null);
  /** The cluster under the pointer. */
  readonly hovered = signal<number | null>(null);
  /** Whether the viewer shows all members of `cluster` in step. */
  readonly inStep = signal(false);
  readonly follow = signal(true);
  readonly trails = signal(true);
  /** The span of time that the timeline and the matrix show; null: all of it. */
  readonly zoom = signal<Span | null>(null);
  readonly other = signal<OtherResult | null>(null);
  readonly edits = signal<EditHooks | null>(null);

  readonly active: ReadonlySignal<OpenRecording | undefined> = computed(
    () => this.opened.value[this.current.value],
  );
  readonly recording: ReadonlySignal<Recording | undefined> = computed(
    () => this.active.value?.recording.value,
  );
  readonly fps = computed(() => this.recording.value?.fps ?? 1);
  readonly duration = computed(() => (this.recording.value?.n_frames ?? 0) / this.fps.value);
  readonly range: ReadonlySignal<Span> = computed(
    () => this.zoom.value ?? { start_s: 0, stop_s: Math.max(this.duration.value, 1e-3) },
  );
  readonly frame = computed(() => this.frameAt(this.playhead.value));
  readonly activities = computed(() => this.lane("activity"));
  readonly primitives = computed(() => this.lane("primitive"));
  readonly clusters: ReadonlySignal<Cluster[]> = computed(() => clustersOf(this.primitives.value));
  /** The cluster whose members and curves are shown. */
  readonly shownCluster = computed(() =>
    this.clusters.value.find((cluster) => cluster.id === this.cluster.value),
  );
  /** The primitive under the playhead. */
  readonly present = computed(() => segmentAt(this.primitives.value, this.frame.value));
  readonly selected: ReadonlySignal<Segment | undefined> = computed(() => {
    const at = this.selection.value;
    if (!at) return undefined;
    const lane = at.level === "activity" ? this.activities.value : this.primitives.value;
    return lane.find((segment) => segment.start_frame === at.start_frame);
  });

  /** The frame on the screen at a time; the last one at the end of the recording. */
  frameAt(seconds: number): number {
    const last = Math.max((this.recording.value?.n_frames ?? 1) - 1, 0);
    return Math.min(Math.max(Math.floor(seconds * this.fps.value + 1e-6), 0), last);
  }

  seek(seconds: number): void {
    const playhead = Math.min(Math.max(seconds, 0), this.duration.value);
    batch(() => {
      this.playhead.value = playhead;
      if (this.zoom.value)
        this.zoom.value = following(this.zoom.value, playhead, this.duration.value);
    });
  }

  /** Shows more (`factor` > 1) or less time, around a time that stays where it is. */
  zoomBy(factor: number, around: number = this.playhead.value): void {
    const total = this.duration.value;
    if (total <= 0) return;
    const range = zoomed(this.range.value, factor, around, total);
    this.zoom.value = range.stop_s - range.start_s >= total - 1e-9 ? null : range;
  }

  /** Shows earlier or later times. */
  panBy(seconds: number): void {
    if (this.zoom.value) this.zoom.value = panned(this.zoom.value, seconds, this.duration.value);
  }

  /** Stops and goes some frames on, or back. */
  step(frames: number): void {
    this.playing.value = false;
    this.seek((this.frame.value + frames) / this.fps.value);
  }

  /** Selects a segment and brings everything there; a loop follows. */
  select(segment: Segment, options: { seek?: boolean } = {}): void {
    batch(() => {
      this.selection.value = { level: segment.level, start_frame: segment.start_frame };
      if (segment.cluster >= 0) this.cluster.value = segment.cluster;
      if (this.loop.value) this.loop.value = { start_s: segment.start_s, stop_s: segment.stop_s };
      if (options.seek ?? true) this.seek(segment.start_s);
    });
  }

  /** Selects the next primitive or the one before. */
  stepSegment(by: 1 | -1): void {
    const level = this.selection.value?.level ?? "primitive";
    const lane = level === "activity" ? this.activities.value : this.primitives.value;
    const segment = lane[indexAt(lane, this.frame.value) + by];
    if (segment) this.select(segment);
  }

  /** Shows a cluster and goes to its next member, else its first; stays put inside a member. */
  selectCluster(id: number): void {
    const members = this.clusters.value.find((cluster) => cluster.id === id)?.members ?? [];
    const inside = members.find((segment) => contains(segment, this.frame.value));
    const next = members.find((segment) => segment.start_frame >= this.frame.value);
    this.cluster.value = id;
    const target = inside ?? next ?? members[0];
    if (target) this.select(target);
  }

  /** Loops the selected segment, else the one under the playhead; or stops looping. */
  toggleLoop(): void {
    const segment = this.selected.value ?? this.present.value;
    if (this.loop.value || !segment) {
      this.loop.value = null;
      return;
    }
    this.select(segment, { seek: !contains(segment, this.frame.value) });
    this.loop.value = { start_s: segment.start_s, stop_s: segment.stop_s };
  }

  /** One more recording; it becomes the current one. */
  add(opened: OpenRecording): void {
    this.opened.value = [...this.opened.value, opened];
    this.show(this.opened.value.length - 1);
  }

  /** Makes a recording of the page the current one. */
  show(index: number): void {
    batch(() => {
      this.selection.value = null;
      this.loop.value = null;
      this.cluster.value = null;
      this.other.value = null;
      this.inStep.value = false;
      this.zoom.value = null;
      this.current.value = index;
    });
    this.seek(this.playhead.value);
  }

  close(index: number): void {
    this.opened.value = this.opened.value.filter((_, i) => i !== index);
    const last = Math.max(this.opened.value.length - 1, 0);
    const before = this.current.value > index ? 1 : 0;
    this.show(Math.min(this.current.value - before, last));
  }

  private lane(level: Level): Segment[] {
    const recording = this.recording.value;
    return recording ? laneOf(recording.segmentation, level) : [];
  }
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

function contains(segment: Segment, frame: number): boolean {
  return segment.start_frame <= frame && frame < segment.stop_frame && durationOf(segment) > 0;
}
