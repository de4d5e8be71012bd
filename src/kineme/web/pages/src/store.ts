/** The state of a page, and what may be done with it. */
import { batch } from "@preact/signals";
import type { Level, Segment } from "./messages";
import type { OpenRecording } from "./opened";
import { durationOf, indexAt } from "./segments";
import { State, UNBOUNDED } from "./state";
import { following, inside, panned, zoomed, type Span } from "./view";

const SMALL = 1 / 30; // of the time that is shown
const AROUND = 12; // times its own length

export class Store extends State {
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
    this.workOn(this.worked.value === "activity" ? "primitive" : "activity");
  }

  /** Works on a level from now on, where it has segments. */
  workOn(level: Level): void {
    if (!this.lane(level).length || level === this.worked.value) return;
    batch(() => {
      this.level.value = level;
      this.selection.value = null;
    });
  }

  /** Looks at the result coarser (-1) or finer (1). */
  stepDetail(by: 1 | -1): void {
    const levels = this.levels.value;
    const next = levels?.all[positionOf(levels.detail, levels.all) + by];
    if (next !== undefined) levels?.choose(next);
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
    const at = this.bounds.value[end] === here ? null : here;
    const bounds = { ...this.bounds.value, [end]: at };
    const { start_s, stop_s } = bounds;
    if (start_s !== null && stop_s !== null && stop_s <= start_s)
      bounds[end === "start_s" ? "stop_s" : "start_s"] = null;
    this.bounds.value = bounds;
    if (this.loop.value && before) this.loop.value = this.markedSpan();
  }

  /** What is between the marks; one alone reaches to the end or the start of the recording. */
  markedSpan(): Span | null {
    const { start_s, stop_s } = this.bounds.value;
    if (start_s === null && stop_s === null) return null;
    return { start_s: start_s ?? 0, stop_s: stop_s ?? this.duration.value };
  }

  /** Stops at a segment and selects it; one that would hardly be seen, or not whole, is zoomed to. */
  lookAt(segment: Segment): void {
    this.playing.value = false;
    this.select(segment);
    const { start_s, stop_s } = this.range.value;
    const share = (segment.stop_s - segment.start_s) / (stop_s - start_s);
    if (share < SMALL || segment.stop_s > stop_s) this.zoomTo(segment, AROUND);
  }

  /** Shows what is between the marks, else the segment at the playhead, with a little around it. */
  zoomToTarget(): void {
    const span = this.markedSpan() ?? this.target.value;
    if (span) this.zoomTo(span, 1.2);
  }

  /** Shows so many times the length of a span, which is in the middle. */
  private zoomTo(span: Span, times: number): void {
    const length = span.stop_s - span.start_s;
    const wide = Math.min(Math.max(times * length, 0.2), this.duration.value);
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

  /** Lays the repetition at the playhead over the others; once more takes it away. */
  toggleGhost(): void {
    const present = this.present.value ?? null;
    const same = this.ghost.value?.start_frame === present?.start_frame;
    this.ghost.value = this.ghost.value && same ? null : present;
  }

  /** One more recording; it becomes the current one. */
  add(opened: OpenRecording): void {
    this.opened.value = [...this.opened.value, opened];
    this.show(this.opened.value.length - 1);
  }

  /** Makes a recording of the page the current one; people of one file go on in the same time. */
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

/** Where a detail stands among those there are: at the finest that is no finer. */
export function positionOf(detail: number, all: readonly number[]): number {
  return Math.max(all.filter((each) => each <= detail * (1 + 1e-9)).length - 1, 0);
}

function contains(segment: Segment, frame: number): boolean {
  return segment.start_frame <= frame && frame < segment.stop_frame && durationOf(segment) > 0;
}
