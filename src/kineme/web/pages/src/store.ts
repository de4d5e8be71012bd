/** The state of a page: what is open, where the playhead stands, what is selected. */
import { batch, computed, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import { clusterColor, labelColors } from "./colors";
import type { Level, Recording, Segment, Segments } from "./messages";
import { unpackMotion, type Motion } from "./motion";
import {
  clustersOf,
  durationOf,
  indexAt,
  laneOf,
  nearestBorder,
  segmentAt,
  type Cluster,
} from "./segments";
import type { RecordingData } from "./recordingData";
import { following, inside, panned, zoomed, type Span } from "./view";

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
  moveBorder(level: Level, frame: number, to: number): Promise<void>;
  nameCluster(cluster: number, label: string): void;
  mergeClusters(cluster: number, into: number): void;
}

/** Another result shown below the first. */
export interface OtherResult {
  name: string;
  segmentation: Segments;
  /** Whether borders are marked that one of the two has and the other has not. */
  marked?: boolean;
}

interface Marks {
  start_s: number | null;
  stop_s: number | null;
}

const UNMARKED: Marks = { start_s: null, stop_s: null };

export class Store {
  /** The recordings shown side by side. */
  readonly opened = signal<OpenRecording[]>([]);
  /** Which of them the timeline, the matrix and the clusters belong to. */
  readonly current = signal(0);
  readonly playhead = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(1);
  readonly loop = signal<Span | null>(null);
  /** Where what one is interested in starts and stops, seconds; null: not marked. */
  readonly marks = signal<Marks>(UNMARKED);
  /** A segment that was chosen; it is left where the playhead leaves it. */
  readonly selection = signal<Selection | null>(null);
  /** The level one works in. */
  readonly level = signal<Level>("primitive");
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
  readonly activities = computed(() => this.rows("activity"));
  readonly primitives = computed(() => this.rows("primitive"));
  /** The colour of each label of the result, and of the one beside it. */
  readonly labelColors = computed(() =>
    labelColors([
      ...(this.recording.value?.segmentation.segments ?? []),
      ...(this.other.value?.segmentation.segments ?? []),
    ]),
  );
  readonly clusters: ReadonlySignal<Cluster[]> = computed(() =>
    clustersOf(this.primitives.value, this.recording.value?.segmentation.cluster_names ?? {}),
  );
  /** The cluster whose members and curves are shown. */
  readonly shownCluster = computed(() =>
    this.clusters.value.find((cluster) => cluster.id === this.cluster.value),
  );
  /** The primitive under the playhead. */
  readonly present = computed(() => segmentAt(this.primitives.value, this.frame.value));
  /** The level one works in: activities where there is no other. */
  readonly worked: ReadonlySignal<Level> = computed(() =>
    this.primitives.value.length ? this.level.value : "activity",
  );
  /** What edits are for: the segment of that level at the playhead. */
  readonly target = computed(() => segmentAt(this.lane(this.worked.value), this.frame.value));
  /** The segment after the border nearest to the playhead. */
  readonly border = computed(() => nearestBorder(this.lane(this.worked.value), this.frame.value));
  readonly selected: ReadonlySignal<Segment | undefined> = computed(() => {
    const at = this.selection.value;
    if (!at) return undefined;
    return this.lane(at.level).find((segment) => segment.start_frame === at.start_frame);
  });

  /** The colour of a segment: of its cluster, else of its label; null for what is neither. */
  colorOf(segment: Segment): string | null {
    if (segment.cluster >= 0) return clusterColor(segment.cluster);
    return this.labelColors.value.get(segment.label) ?? null;
  }

  /** The frame on the screen at a time; the last one at the end of the recording. */
  frameAt(seconds: number): number {
    const last = Math.max((this.recording.value?.n_frames ?? 1) - 1, 0);
    return Math.min(Math.max(Math.floor(seconds * this.fps.value + 1e-6), 0), last);
  }

  seek(seconds: number): void {
    const playhead = Math.min(Math.max(seconds, 0), this.duration.value);
    batch(() => {
      this.playhead.value = playhead;
      const chosen = this.selected.value;
      if (chosen && !contains(chosen, this.frame.value)) this.selection.value = null;
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

  /** Brings a time into the view; whether it was not there before. */
  reveal(seconds: number): boolean {
    const { zoom } = this;
    if (!zoom.value || (zoom.value.start_s <= seconds && seconds <= zoom.value.stop_s))
      return false;
    zoom.value = following(zoom.value, seconds, this.duration.value);
    return true;
  }

  /** Stops and goes some frames on, or back. */
  step(frames: number): void {
    this.playing.value = false;
    this.seek((this.frame.value + frames) / this.fps.value);
  }

  /** Selects a segment and brings everything there; a loop follows. */
  select(segment: Segment, options: { seek?: boolean } = {}): void {
    batch(() => {
      this.level.value = segment.level;
      this.selection.value = { level: segment.level, start_frame: segment.start_frame };
      if (segment.cluster >= 0) this.cluster.value = segment.cluster;
      if (this.loop.value) this.loop.value = { start_s: segment.start_s, stop_s: segment.stop_s };
      if (options.seek ?? true) this.seek(segment.start_s);
    });
  }

  /** Selects the next primitive or the one before. */
  stepSegment(by: 1 | -1): void {
    const lane = this.lane(this.worked.value);
    const segment = lane[indexAt(lane, this.frame.value) + by];
    if (segment) this.select(segment);
  }

  /** Works on the other level from now on. */
  changeLevel(): void {
    const level = this.worked.value === "activity" ? "primitive" : "activity";
    if (!this.lane(level).length) return;
    batch(() => {
      this.level.value = level;
      this.selection.value = null;
    });
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

  /** Sets a mark at the playhead, or takes it away if it is there; a loop of the marks follows. */
  mark(end: "start_s" | "stop_s"): void {
    const before = this.markedSpan();
    const here = this.playhead.value;
    const at = this.marks.value[end] === here ? null : here;
    const marks = { ...this.marks.value, [end]: at };
    const { start_s, stop_s } = marks;
    if (start_s !== null && stop_s !== null && stop_s <= start_s)
      marks[end === "start_s" ? "stop_s" : "start_s"] = null;
    this.marks.value = marks;
    if (this.loop.value && before) this.loop.value = this.markedSpan();
  }

  /** What is between the marks; one alone reaches to the end or the start of the recording. */
  markedSpan(): Span | null {
    const { start_s, stop_s } = this.marks.value;
    if (start_s === null && stop_s === null) return null;
    return { start_s: start_s ?? 0, stop_s: stop_s ?? this.duration.value };
  }

  /** Shows what is between the marks, else the segment at the playhead, with a little around it. */
  zoomToTarget(): void {
    const span = this.markedSpan() ?? this.target.value;
    if (!span) return;
    const length = span.stop_s - span.start_s;
    const wide = Math.min(Math.max(1.2 * length, 0.2), this.duration.value);
    const start = (span.start_s + span.stop_s - wide) / 2;
    const range = inside({ start_s: start, stop_s: start + wide }, this.duration.value);
    this.zoom.value = wide < this.duration.value ? range : null;
  }

  /** Loops what is marked, else the segment at the playhead; or stops looping. */
  toggleLoop(): void {
    const marked = this.markedSpan();
    const segment = this.target.value;
    if (this.loop.value || (!segment && !marked)) {
      this.loop.value = null;
      return;
    }
    if (marked) {
      this.loop.value = marked;
      return;
    }
    if (!segment) return;
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
      this.marks.value = UNMARKED;
      this.playing.value = false;
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

  /** The segments of a level in time order. */
  lane(level: Level): Segment[] {
    return level === "activity" ? this.activities.value : this.primitives.value;
  }

  private rows(level: Level): Segment[] {
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
