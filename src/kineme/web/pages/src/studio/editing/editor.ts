/**
 * Edits as people make them. There is one target: the segment at the playhead,
 * on the level one works in, and the border nearest to the playhead. The
 * timeline shows both. What an edit would reach outside of the view is brought
 * into the view first.
 */
import { batch, computed, signal } from "@preact/signals";
import type { ByHand, Edit, Kind, Level, Segment } from "../../messages";
import type { Store } from "../../store";
import * as commands from "./commands";
import type { Session } from "../session";
import { isExcluded, nearestBorder } from "../../segments";
import { counted } from "../../counted";

export class Editor {
  /** Asks for the field of a name to take the keyboard: of a segment or its cluster. */
  readonly naming = signal<"segment" | "cluster" | null>(null);
  readonly segment = computed<Segment | undefined>(() => this.store.target.value);
  private readonly store: Store;
  /** The border that a key holds: from where, and how far it is by now. */
  private held: { where: commands.Where; by: number } | null = null;

  constructor(private readonly session: Session) {
    this.store = session.store;
  }

  moveBorder(level: Level, frame: number, to: number): void {
    if (frame !== to) this.send({ kind: "move_border", level, frame, to });
  }

  split(): void {
    this.make(
      () => commands.split(this.where()),
      () => this.store.frame.value,
      "There is a border at the playhead already: move the playhead first.",
    );
  }

  mergeWithNext(): void {
    this.make(
      () => (this.segment.value ? commands.mergeWithNext(this.where(), this.segment.value) : null),
      () => this.segment.value?.stop_frame,
      "This is the last segment: choose one with a neighbour after it.",
    );
  }

  deleteBorder(): void {
    this.make(
      () => commands.deleteBorder(this.where()),
      () => this.store.border.value?.start_frame,
      "There is no border to delete.",
    );
  }

  /** The segment at the playhead starts, or stops, at the playhead. */
  borderHere(side: "start" | "stop"): void {
    this.make(
      () => commands.borderHere(this.where(), side),
      () => this.store.frame.value,
      "There is a border at the playhead already, or none on that side to bring here.",
    );
  }

  /**
   * Moves the border nearest to the playhead, which goes with it. It is made when the key is
   * released: as long as it is held it is one edit.
   */
  nudge(frames: number): void {
    if (this.held) this.carry(frames);
    else
      this.make(
        () => commands.nudgeBorder(this.where(), frames),
        () => this.store.border.value?.start_frame,
        "There is no border to move, or no room for it.",
        () => {
          this.held = { where: this.where(), by: 0 };
          this.carry(frames);
        },
      );
  }

  /** Makes the border that a key holds. */
  release(): void {
    const edit = this.held && commands.nudgeBorder(this.held.where, this.held.by);
    this.held = null;
    batch(() => {
      if (edit) this.send(edit);
      this.store.drag.value = null;
    });
  }

  /** Takes the border that a key holds on, as far as there is room. */
  private carry(frames: number): void {
    const { where, by } = this.held!;
    const edit = commands.nudgeBorder(where, by + frames);
    const frame = nearestBorder(where.lane, where.frame)!.start_frame;
    const to = edit?.to ?? frame;
    this.held = { where, by: to - frame };
    batch(() => {
      this.store.drag.value = { lane: this.store.worked.value, frame, to };
      this.store.seek(to / this.store.fps.value);
    });
  }

  /** The field of a name takes the keyboard, where there is one. */
  startNaming(target: "segment" | "cluster"): void {
    const segment = this.segment.value;
    if (segment && target === "cluster" && segment.cluster < 0)
      this.session.bulletin.tell("This segment is in no cluster: there is no cluster to name.");
    else if (segment) this.naming.value = target;
  }

  name(segment: Segment, label: string): void {
    const { level, start_frame: frame } = segment;
    this.send({ kind: "name_segment", level, frame, label });
  }

  /** Gives the segment one works on a name of its own. */
  nameTarget(label: string): void {
    this.session.edited.value?.whenShown(() => {
      const segment = this.segment.value;
      if (segment) this.name(segment, label);
    });
  }

  comment({ level, start_frame: frame }: Segment, text: string): void {
    this.send({ kind: "comment", level, frame, text });
  }

  splitCluster(cluster: number, frames: number[]): void {
    this.send({ kind: "split_cluster", cluster, frames });
  }

  orderClusters(order: number[]): void {
    this.send({ kind: "order_clusters", order });
  }

  nameCluster(cluster: number, label: string): void {
    this.send({ kind: "name_cluster", cluster, label });
  }

  mergeClusters(cluster: number, into: number): void {
    this.send({ kind: "merge_clusters", cluster, into });
  }

  setCluster(segment: Segment, cluster: number): void {
    const { level, start_frame: frame } = segment;
    if (cluster !== segment.cluster) this.send({ kind: "set_cluster", level, frame, cluster });
  }

  setKind(segment: Segment, to: Kind): void {
    const { level, start_frame: frame } = segment;
    if (to !== segment.kind) this.send({ kind: "set_kind", level, frame, to });
  }

  /** Marks segments as checked, or takes the mark away. */
  check(segments: readonly Segment[], checked: boolean): void {
    const edits: ByHand[] = (["activity", "primitive"] as const).flatMap((level) => {
      const frames = segments
        .filter((each) => each.level === level)
        .map((each) => each.start_frame);
      return frames.length ? [{ kind: "check" as const, level, frames, checked }] : [];
    });
    this.together(edits, "");
  }

  /** The primitives that start at these frames count in no mean, or do so again. */
  exclude(frames: number[], excluded: boolean): void {
    const what = excluded ? "left out of means" : "in means again";
    this.send({ kind: "exclude", frames, excluded }, () => {
      this.session.bulletin.tell(`${counted(frames.length, "repetition")} ${what}.`);
    });
  }

  /** Leaves the selected repetition out of means, or brings it back. */
  toggleExcluded(): void {
    const row = this.store.selected.value;
    const table = this.store.recording.value?.segmentation;
    if (row?.kind === "primitive" && table)
      this.exclude([row.start_frame], !isExcluded(table.annotation, row));
    else this.session.bulletin.tell("Select the repetition to leave out of means first.");
  }

  /** Several edits as one step, which says how many segments it reached. */
  together(edits: ByHand[], what: string): void {
    if (!edits.length) return;
    this.send(edits.length === 1 ? edits[0]! : { kind: "together", edits }, () => {
      if (what) this.session.bulletin.tell(`${counted(edits.length, "segment")} ${what}.`);
    });
  }

  undo(): void {
    if (this.isOpenTo("can_undo")) this.session.edited.value?.undo();
    else this.session.bulletin.tell("There is nothing to undo.");
  }

  redo(): void {
    if (this.isOpenTo("can_redo")) this.send({ kind: "redo" });
    else this.session.bulletin.tell("There is nothing to redo.");
  }

  /** Edits on their way may be what there is to undo or redo. */
  private isOpenTo(what: "can_undo" | "can_redo"): boolean {
    const edited = this.session.edited.value;
    return edited !== undefined && (edited.confirmed.value[what] || edited.unsent().length > 0);
  }

  /** An edit of what is at the playhead once the edits before it are shown, if it can be seen. */
  private make(
    command: () => Edit | null,
    place: () => number | undefined,
    otherwise: string,
    act: (edit: Edit) => void = (edit) => this.send(edit),
  ): void {
    this.session.edited.value?.whenShown(() => {
      const edit = command();
      const frame = place();
      if (!edit || frame === undefined) this.session.bulletin.tell(otherwise);
      else if (this.store.reveal(frame / this.store.fps.value))
        this.session.bulletin.tell("This is where it would be: press once more to do it.");
      else act(edit);
    });
  }

  /** The selection follows the border that it starts at. */
  private send(edit: Edit, made?: () => void): void {
    const at = this.store.selection.peek();
    const start = at && commands.followed(edit, at.level, at.start_frame);
    batch(() => {
      void this.session.edited.value?.edit(edit, made);
      if (at && start !== null) this.store.selection.value = { ...at, start_frame: start };
    });
  }

  private where(): commands.Where {
    return { lane: this.store.lane(this.store.worked.value), frame: this.store.frame.value };
  }
}
