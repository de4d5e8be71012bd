/** The state of a page: what is open, where the playhead stands, what is selected, and what follows. */
import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { clusterColor, labelColors } from "./colors";
import type { ByHand, Level, Recording, Segment, Segments } from "./messages";
import type { OpenRecording } from "./opened";
import { clustersOf, labelSpans, laneOf, nearestBorder, segmentAt, type Cluster } from "./segments";
import type { Span } from "./view";

/** A border on its way to another frame. */
export interface Drag {
  lane: string;
  frame: number;
  to: number;
}

/** A segment is known by its level and first frame. */
export interface Selection {
  level: Level;
  start_frame: number;
}

/** Another result shown below the first. */
export interface OtherResult {
  name: string;
  segmentation: Segments;
  /** Whether borders are marked that one of the two has and the other has not. */
  marked?: boolean;
}

export interface Bounds {
  start_s: number | null;
  stop_s: number | null;
}

export const UNBOUNDED: Bounds = { start_s: null, stop_s: null };

/** The details a result can be looked at, coarsest first, and the one that is. */
export interface Levels {
  all: readonly number[];
  detail: number;
  choose: (detail: number) => void;
}

/** What the page follows while it plays. */
export interface Pace {
  /** Second of the recording where it is; null where it has no say, as after its end. */
  seconds(): number | "waits" | null;
}

export class State {
  /** The recordings shown side by side. */
  readonly opened = signal<OpenRecording[]>([]);
  /** Which of them the timeline, the matrix and the clusters belong to. */
  readonly current = signal(0);
  readonly playhead = signal(0);
  readonly playing = signal(false);
  readonly speed = signal(1);
  readonly loop = signal<Span | null>(null);
  /** Where what one is interested in starts and stops, seconds; null: not marked. */
  readonly bounds = signal<Bounds>(UNBOUNDED);
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
  /** A repetition laid over the one that plays, in step with it. */
  readonly ghost = signal<Segment | null>(null);
  readonly follow = signal(true);
  readonly trails = signal(true);
  /** The video that is seen; null without one. */
  readonly film = signal<Pace | null>(null);
  /** Whether the figure is large and the video small. */
  readonly figureFirst = signal(false);
  /** Whether the video is silent. */
  readonly muted = signal(false);
  /** The span of time that the timeline and the matrix show; null: all of it. */
  readonly zoom = signal<Span | null>(null);
  /** Other results of the recording, which lie below it. */
  readonly others = signal<readonly OtherResult[]>([]);
  /** Whether curves are shown under the timeline. */
  readonly curves = signal(false);
  /** null where there is one detail only. */
  readonly levels = signal<Levels | null>(null);
  /** Makes an edit of the table; null in a report, which is not edited. */
  readonly edit = signal<((edit: ByHand) => void) | null>(null);
  /** The border that a pointer or a key that is held moves. */
  readonly drag = signal<Drag | null>(null);

  readonly active: ReadonlySignal<OpenRecording | undefined> = computed(
    () => this.opened.value[this.current.value],
  );
  readonly recording: ReadonlySignal<Recording | undefined> = computed(
    () => this.active.value?.recording.value,
  );
  /** The people who are open of the same file, the one in front among them; none where it is one. */
  readonly people: ReadonlySignal<readonly OpenRecording[]> = computed(() => {
    const file = this.recording.value?.file;
    const same = this.opened.value.filter((each) => file && each.recording.value.file === file);
    return same.length > 1 ? same : [];
  });
  /** Its segment table, the same one until an edit makes another of it. */
  readonly table: ReadonlySignal<Segments | undefined> = computed(
    () => this.recording.value?.segmentation,
  );
  readonly fps = computed(() => this.recording.value?.fps ?? 1);
  readonly duration = computed(() => (this.recording.value?.n_frames ?? 0) / this.fps.value);
  readonly range: ReadonlySignal<Span> = computed(
    () => this.zoom.value ?? { start_s: 0, stop_s: Math.max(this.duration.value, 1e-3) },
  );
  readonly frame = computed(() => this.frameAt(this.playhead.value));
  readonly activities = computed(() => this.rows("activity"));
  readonly primitives = computed(() => this.rows("primitive"));
  /** What is called how, when. */
  readonly labels = computed(() => labelSpans(this.activities.value, this.primitives.value));
  /** The colour of each label of the result, and of those beside it. */
  readonly labelColors = computed(() =>
    labelColors([
      ...(this.table.value?.segments ?? []),
      ...this.others.value.flatMap(({ segmentation }) => segmentation.segments),
      ...this.people.value.flatMap(({ recording }) => recording.value.segmentation.segments),
    ]),
  );
  readonly clusters: ReadonlySignal<Cluster[]> = computed(() =>
    clustersOf(this.primitives.value, this.table.value?.cluster_names ?? {}),
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

  /** The segments of a level in time order. */
  lane(level: Level): Segment[] {
    return level === "activity" ? this.activities.value : this.primitives.value;
  }

  private rows(level: Level): Segment[] {
    const table = this.table.value;
    return table ? laneOf(table, level) : [];
  }
}
