/** Hold a page's state as signals. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { getClusterColor, assignLabelColors } from "./colors";
import type { ByHand, Level, Recording, Segment, Segments } from "./messages";
import type { OpenRecording } from "./openRecording";
import {
  groupClusters,
  joinLabels,
  getLane,
  findNearestBorder,
  findSegmentAt,
  type Cluster,
} from "./segments";
import type { Span } from "./view";

/** A border being dragged to another frame. */
export interface Drag {
  lane: string;
  frame: number;
  to: number;
}

/** Identifies a segment by level and start frame. */
export interface Selection {
  level: Level;
  start_frame: number;
}

/** Another result, shown below the first. */
export interface OtherResult {
  name: string;
  segmentation: Segments;
  /** Whether to mark borders that only one of the two results has. */
  marked?: boolean;
}

export interface Bounds {
  start_s: number | null;
  stop_s: number | null;
}

export const UNBOUNDED: Bounds = { start_s: null, stop_s: null };

/** Available levels of detail, coarsest first, and the current one. */
export interface Levels {
  all: readonly number[];
  detail: number;
  choose: (detail: number) => void;
}

/** Time source that playback follows. */
export interface VideoTime {
  /** Return the time in the recording, seconds; null if the video has no picture for it. */
  getTime(): number | "waiting" | null;
}

export class State {
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
  readonly selection = signal<Selection | null>(null);
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

  readonly active: ReadonlySignal<OpenRecording | undefined> = computed(
    () => this.opened.value[this.current.value],
  );
  readonly recording: ReadonlySignal<Recording | undefined> = computed(
    () => this.active.value?.recording.value,
  );
  /** Open people of the active recording's file; empty if only one is open. */
  readonly people: ReadonlySignal<readonly OpenRecording[]> = computed(() => {
    const file = this.recording.value?.file;
    const same = this.opened.value.filter((each) => file && each.recording.value.file === file);
    return same.length > 1 ? same : [];
  });
  /** The active segment table; each edit replaces it. */
  readonly table: ReadonlySignal<Segments | undefined> = computed(
    () => this.recording.value?.segmentation,
  );
  readonly fps = computed(() => this.recording.value?.fps ?? 1);
  readonly duration = computed(() => (this.recording.value?.n_frames ?? 0) / this.fps.value);
  readonly range: ReadonlySignal<Span> = computed(
    () => this.zoom.value ?? { start_s: 0, stop_s: Math.max(this.duration.value, 1e-3) },
  );
  readonly frame = computed(() => this.getFrameAt(this.playhead.value));
  readonly activities = computed(() => this.getRows("activity"));
  readonly primitives = computed(() => this.getRows("primitive"));
  readonly labels = computed(() => joinLabels(this.activities.value, this.primitives.value));
  /** Colours of the labels of all shown results. */
  readonly labelColors = computed(() =>
    assignLabelColors([
      ...(this.table.value?.segments ?? []),
      ...this.others.value.flatMap(({ segmentation }) => segmentation.segments),
      ...this.people.value.flatMap(({ recording }) => recording.value.segmentation.segments),
    ]),
  );
  readonly clusters: ReadonlySignal<Cluster[]> = computed(() =>
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
  readonly selected: ReadonlySignal<Segment | undefined> = computed(() => {
    const at = this.selection.value;
    if (!at) return undefined;
    return this.getLane(at.level).find((segment) => segment.start_frame === at.start_frame);
  });

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

  private getRows(level: Level): Segment[] {
    const table = this.table.value;
    return table ? getLane(table, level) : [];
  }
}
