/** Hold a page's state as signals, and change it. */
import { batch, computed, signal, type ReadonlySignal } from "@preact/signals";
import type { Level, Segment, ByHand, Segments } from "./messages";
import type { OpenRecording } from "./recordingData";
import {
  getDuration,
  findIndexAt,
  groupClusters,
  joinLabels,
  getLane,
  findNearestBorder,
  findRow,
  findSegmentAt,
  type SegmentId,
} from "./segments";
import { revealTime, clampRange, panRange, zoomRange, type Span } from "./view";
import { getClusterColor, assignLabelColors } from "./colors";
import { createContext } from "preact";
import { useContext } from "preact/hooks";

const MIN_VISIBLE_SHARE = 1 / 30; // of the visible time
const ZOOM_CONTEXT = 12; // visible time, as a multiple of the segment's duration

/** A border being dragged to another frame. */
export interface Drag {
  lane: string;
  frame: number;
  to: number;
}

/** Another result, shown below the first. */
export interface OtherResult {
  name: string;
  segmentation: Segments;
  /** Whether to mark borders that only one of the two results has. */
  marked?: boolean;
}

interface Bounds {
  start_s: number | null;
  stop_s: number | null;
}

const UNBOUNDED: Bounds = { start_s: null, stop_s: null };

/** Available levels of detail, coarsest first, and the current one. */
interface Levels {
  all: readonly number[];
  detail: number;
  choose: (detail: number) => void;
}

/** Time source that playback follows. */
export interface VideoTime {
  /** Return the time in the recording, seconds; null if the video has no picture for it. */
  getTime(): number | "waiting" | null;
}

export class Store {
  /** Recordings shown side by side. */
  readonly opened = signal<OpenRecording[]>([]);
  /** Index of the active recording. */
  readonly current = signal(0);
  readonly playhead = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(1);
  readonly loop = signal<Span | null>(null);
  /** Marked start and stop, seconds; null if not set. */
  readonly bounds = signal<Bounds>(UNBOUNDED);
  /** The selected segment; moving the playhead out of it clears the selection. */
  readonly selection = signal<SegmentId | null>(null);
  /** The level that the user edits. */
  readonly level = signal<Level>("primitive");
  /** Number of the selected cluster. */
  readonly cluster = signal<number | null>(null);
  /** Number of the cluster under the pointer. */
  readonly hovered = signal<number | null>(null);
  /** Whether the viewer plays all members of `cluster` in step. */
  readonly inStep = signal(false);
  /** A repetition shown over the current one, in step with it. */
  readonly ghost = signal<Segment | null>(null);
  readonly follow = signal(true);
  readonly trails = signal(true);
  /** Time of the visible video; null without one. */
  readonly videoTime = signal<VideoTime | null>(null);
  readonly figureFirst = signal(false);
  readonly muted = signal(false);
  /** Visible time span of timeline and matrix; null for all. */
  readonly zoom = signal<Span | null>(null);
  /** Other results of the recording, shown below it. */
  readonly others = signal<readonly OtherResult[]>([]);
  /** Whether curves are shown below the timeline. */
  readonly curves = signal(false);
  /** null if there is only one level of detail. */
  readonly levels = signal<Levels | null>(null);
  /** Applies an edit; null in a report. */
  readonly edit = signal<((edit: ByHand) => void) | null>(null);
  /** The border that a pointer or a pressed key is moving. */
  readonly drag = signal<Drag | null>(null);

  readonly active = computed(() => this.opened.value[this.current.value]);
  readonly recording = computed(() => this.active.value?.recording.value);
  /** Open people of the active recording's file; empty if only one is open. */
  readonly people = computed(() => {
    const file = this.recording.value?.file;
    const same = this.opened.value.filter((each) => file && each.recording.value.file === file);
    return same.length > 1 ? same : [];
  });
  /** The active segment table; each edit replaces it. */
  readonly table = computed(() => this.recording.value?.segmentation);
  readonly fps = computed(() => this.recording.value?.fps ?? 1);
  readonly duration = computed(() => (this.recording.value?.n_frames ?? 0) / this.fps.value);
  readonly range: ReadonlySignal<Span> = computed(
    () => this.zoom.value ?? { start_s: 0, stop_s: Math.max(this.duration.value, 1e-3) },
  );
  readonly frame = computed(() => this.getFrameAt(this.playhead.value));
  readonly activities = computed(() => getLane(this.table.value, "activity"));
  readonly primitives = computed(() => getLane(this.table.value, "primitive"));
  readonly labels = computed(() => joinLabels(this.activities.value, this.primitives.value));
  /** Colours of the labels of all shown results. */
  readonly labelColors = computed(() =>
    assignLabelColors([
      ...(this.table.value?.segments ?? []),
      ...this.others.value.flatMap(({ segmentation }) => segmentation.segments),
      ...this.people.value.flatMap(({ recording }) => recording.value.segmentation.segments),
    ]),
  );
  readonly clusters = computed(() =>
    groupClusters(this.primitives.value, this.table.value?.cluster_names ?? {}),
  );
  readonly shownCluster = computed(() =>
    this.clusters.value.find((cluster) => cluster.id === this.cluster.value),
  );
  /** The primitive at the playhead. */
  readonly present = computed(() => findSegmentAt(this.primitives.value, this.frame.value));
  /** The edited level: activities if there are no primitives. */
  readonly workLevel: ReadonlySignal<Level> = computed(() =>
    this.primitives.value.length ? this.level.value : "activity",
  );
  /** Segment that edits apply to: the one at the playhead. */
  readonly target = computed(() =>
    findSegmentAt(this.getLane(this.workLevel.value), this.frame.value),
  );
  /** Segment after the border nearest to the playhead. */
  readonly border = computed(() =>
    findNearestBorder(this.getLane(this.workLevel.value), this.frame.value),
  );
  readonly selected = computed(() => {
    const at = this.selection.value;
    return at && this.table.value ? findRow(this.table.value, at) : undefined;
  });

  /** Return the index of the open recording with an id; -1 if none. */
  findIndex(id: string | undefined): number {
    return this.opened.value.findIndex((each) => each.recording.value.id === id);
  }

  /** Return a segment's colour: its cluster's, else its label's, else null. */
  getColor(segment: Segment): string | null {
    if (segment.cluster >= 0) return getClusterColor(segment.cluster);
    return this.labelColors.value.get(segment.label) ?? null;
  }

  /** Return the frame shown at a time (seconds), clipped to the recording. */
  getFrameAt(seconds: number): number {
    const last = Math.max((this.recording.value?.n_frames ?? 1) - 1, 0);
    return Math.min(Math.max(Math.floor(seconds * this.fps.value + 1e-6), 0), last);
  }

  /** Return the segments of a level in time order. */
  getLane(level: Level): Segment[] {
    return level === "activity" ? this.activities.value : this.primitives.value;
  }

  seek(seconds: number): void {
    const playhead = Math.min(Math.max(seconds, 0), this.duration.value);
    batch(() => {
      this.playhead.value = playhead;
      const chosen = this.selected.value;
      if (chosen && !containsFrame(chosen, this.frame.value)) this.selection.value = null;
      if (this.zoom.value)
        this.zoom.value = revealTime(this.zoom.value, playhead, this.duration.value);
    });
  }

  /** Show more (`factor` > 1) or less time, keeping the time `around` in place. */
  zoomBy(factor: number, around: number = this.playhead.value): void {
    const total = this.duration.value;
    if (total <= 0) return;
    const range = zoomRange(this.range.value, factor, around, total);
    this.zoom.value = range.stop_s - range.start_s >= total - 1e-9 ? null : range;
  }

  /** Move the visible span by seconds. */
  panBy(seconds: number): void {
    if (this.zoom.value) this.zoom.value = panRange(this.zoom.value, seconds, this.duration.value);
  }

  /** Scroll to a time; return whether that was necessary. */
  reveal(seconds: number): boolean {
    const { zoom } = this;
    if (!zoom.value || (zoom.value.start_s <= seconds && seconds <= zoom.value.stop_s))
      return false;
    zoom.value = revealTime(zoom.value, seconds, this.duration.value);
    return true;
  }

  /** Stop and move the playhead by some frames. */
  step(frames: number): void {
    this.playing.value = false;
    this.seek((this.frame.value + frames) / this.fps.value);
  }

  /** Select a segment and move playhead and loop to it. */
  select(segment: Segment, options: { seek?: boolean } = {}): void {
    batch(() => {
      this.level.value = segment.level;
      this.selection.value = { level: segment.level, start_frame: segment.start_frame };
      if (segment.cluster >= 0) this.cluster.value = segment.cluster;
      if (this.loop.value) this.loop.value = { start_s: segment.start_s, stop_s: segment.stop_s };
      if (options.seek ?? true) this.seek(segment.start_s);
    });
  }

  /** Select the next or previous segment. */
  stepSegment(by: 1 | -1): void {
    const lane = this.getLane(this.workLevel.value);
    const segment = lane[findIndexAt(lane, this.frame.value) + by];
    if (segment) this.select(segment);
  }

  /** Switch the edited level. */
  toggleLevel(): void {
    this.setLevel(this.workLevel.value === "activity" ? "primitive" : "activity");
  }

  /** Edit a level, if it has segments. */
  setLevel(level: Level): void {
    if (!this.getLane(level).length || level === this.workLevel.value) return;
    batch(() => {
      this.level.value = level;
      this.selection.value = null;
    });
  }

  /** Show the next coarser (-1) or finer (1) level of detail. */
  stepDetail(by: 1 | -1): void {
    const levels = this.levels.value;
    const next = levels?.all[findDetailIndex(levels.detail, levels.all) + by];
    if (next !== undefined) levels?.choose(next);
  }

  /** Select a cluster and go to its next member, else its first; stay if the playhead is in one. */
  selectCluster(id: number): void {
    const members = this.clusters.value.find((cluster) => cluster.id === id)?.members ?? [];
    const inside = members.find((segment) => containsFrame(segment, this.frame.value));
    const next = members.find((segment) => segment.start_frame >= this.frame.value);
    this.cluster.value = id;
    const target = inside ?? next ?? members[0];
    if (target) this.select(target);
  }

  /** Set a mark at the playhead, or remove it if it is there; update a loop over the marks. */
  toggleMark(end: "start_s" | "stop_s"): void {
    const before = this.getMarkedSpan();
    const here = this.playhead.value;
    const at = this.bounds.value[end] === here ? null : here;
    const bounds = { ...this.bounds.value, [end]: at };
    const { start_s, stop_s } = bounds;
    if (start_s !== null && stop_s !== null && stop_s <= start_s)
      bounds[end === "start_s" ? "stop_s" : "start_s"] = null;
    this.bounds.value = bounds;
    if (this.loop.value && before) this.loop.value = this.getMarkedSpan();
  }

  /** Return the span between the marks; a single mark extends to the recording's start or end. */
  getMarkedSpan(): Span | null {
    const { start_s, stop_s } = this.bounds.value;
    if (start_s === null && stop_s === null) return null;
    return { start_s: start_s ?? 0, stop_s: stop_s ?? this.duration.value };
  }

  /** Stop at a segment and select it; zoom if it is too short to see or not fully visible. */
  showSegment(segment: Segment): void {
    this.playing.value = false;
    this.select(segment);
    const { start_s, stop_s } = this.range.value;
    const share = (segment.stop_s - segment.start_s) / (stop_s - start_s);
    if (share < MIN_VISIBLE_SHARE || segment.stop_s > stop_s) this.zoomTo(segment, ZOOM_CONTEXT);
  }

  /** Zoom to the span between the marks, else to the segment at the playhead. */
  zoomToTarget(): void {
    const span = this.getMarkedSpan() ?? this.target.value;
    if (span) this.zoomTo(span, 1.2);
  }

  /** Zoom to a multiple of a span's duration, centred on the span. */
  private zoomTo(span: Span, times: number): void {
    const length = span.stop_s - span.start_s;
    const wide = Math.min(Math.max(times * length, 0.2), this.duration.value);
    const start = (span.start_s + span.stop_s - wide) / 2;
    const range = clampRange({ start_s: start, stop_s: start + wide }, this.duration.value);
    this.zoom.value = wide < this.duration.value ? range : null;
  }

  /** Loop the marked span, else the segment at the playhead; or stop looping. */
  toggleLoop(): void {
    const marked = this.getMarkedSpan();
    const segment = this.target.value;
    if (this.loop.value || marked || !segment) {
      this.loop.value = this.loop.value ? null : marked;
      return;
    }
    this.select(segment, { seek: !containsFrame(segment, this.frame.value) });
    this.loop.value = { start_s: segment.start_s, stop_s: segment.stop_s };
  }

  /** Show the current repetition as a ghost, or remove the ghost. */
  toggleGhost(): void {
    const present = this.present.value ?? null;
    const same = this.ghost.value?.start_frame === present?.start_frame;
    this.ghost.value = this.ghost.value && same ? null : present;
  }

  /** Add a recording and make it active. */
  add(opened: OpenRecording): void {
    this.opened.value = [...this.opened.value, opened];
    this.show(this.opened.value.length - 1);
  }

  /** Make a recording active; people of one file keep the current time. */
  show(index: number): void {
    const file = this.recording.value?.file;
    const sameTime = Boolean(file) && this.opened.value[index]?.recording.value.file === file;
    batch(() => {
      this.selection.value = null;
      this.cluster.value = null;
      this.others.value = [];
      this.inStep.value = false;
      this.ghost.value = null;
      this.current.value = index;
      if (sameTime) return;
      this.loop.value = null;
      this.zoom.value = null;
      this.bounds.value = UNBOUNDED;
      this.playing.value = false;
    });
    this.seek(this.playhead.value);
  }

  close(index: number): void {
    this.opened.value = this.opened.value.filter((_, i) => i !== index);
    const last = Math.max(this.opened.value.length - 1, 0);
    const before = this.current.value > index ? 1 : 0;
    this.show(Math.min(this.current.value - before, last));
  }
}

/** Return the index of the finest level that is not finer than `detail`. */
export function findDetailIndex(detail: number, all: readonly number[]): number {
  return Math.max(all.filter((each) => each <= detail * (1 + 1e-9)).length - 1, 0);
}

function containsFrame(segment: Segment, frame: number): boolean {
  return segment.start_frame <= frame && frame < segment.stop_frame && getDuration(segment) > 0;
}

const StoreContext = createContext<Store | null>(null);

/** Provide the store to all components of a page. */
export const StoreProvider = StoreContext.Provider;

export function useStore(): Store {
  const store = useContext(StoreContext);
  if (!store) throw new Error("A component stands outside of the StoreProvider.");
  return store;
}
