/** Edits as people make them: at the playhead and of the selected segment, with the selection following. */
import { computed, signal } from "@preact/signals";
import type { Edit, Kind, Level, Segment } from "../../messages";
import { segmentAt } from "../../segments";
import type { Store } from "../../store";
import * as commands from "./commands";
import type { Session } from "../session";

export class Editor {
  /** Asks for the field of a name to take the keyboard: of a segment or its cluster. */
  readonly naming = signal<"segment" | "cluster" | null>(null);
  /** The level one works in: that of the selection. */
  readonly level = computed<Level>(() => {
    const chosen = this.store.selection.value?.level;
    return chosen ?? (this.store.primitives.value.length ? "primitive" : "activity");
  });
  /** The selected segment, else the one under the playhead. */
  readonly segment = computed<Segment | undefined>(
    () => this.store.selected.value ?? segmentAt(this.lane(), this.store.frame.value),
  );
  private readonly store: Store;

  constructor(private readonly session: Session) {
    this.store = session.store;
  }

  moveBorder(level: Level, frame: number, to: number): void {
    if (frame !== to) this.make({ kind: "move_border", level, frame, to });
  }

  split(): void {
    this.make(
      commands.split(this.where()),
      "There is a border at the playhead already: move it first.",
    );
  }

  mergeWithNext(): void {
    const segment = this.segment.value;
    this.make(
      segment ? commands.mergeWithNext(this.where(), segment) : null,
      "This is the last segment: choose one with a neighbour after it.",
    );
  }

  deleteBorder(): void {
    this.make(commands.deleteBorder(this.where()), "There is no border to delete.");
  }

  /** Moves the border nearest to the playhead, which goes with it. */
  nudge(frames: number): void {
    const edit = commands.nudgeBorder(this.where(), frames);
    this.make(edit, "There is no border to move, or no room for it.");
    if (edit) this.store.seek(edit.to / this.store.fps.value);
  }

  name(segment: Segment, label: string): void {
    const { level, start_frame: frame } = segment;
    if (label !== segment.label) this.make({ kind: "name_segment", level, frame, label });
  }

  nameCluster(cluster: number, label: string): void {
    this.make({ kind: "name_cluster", cluster, label });
  }

  setCluster(segment: Segment, cluster: number): void {
    const { level, start_frame: frame } = segment;
    if (cluster !== segment.cluster) this.make({ kind: "set_cluster", level, frame, cluster });
  }

  setKind(segment: Segment, to: Kind): void {
    const { level, start_frame: frame } = segment;
    if (to !== segment.kind) this.make({ kind: "set_kind", level, frame, to });
  }

  undo(): void {
    if (this.isOpenTo("can_undo")) this.session.edited.value?.undo();
  }

  redo(): void {
    if (this.isOpenTo("can_redo")) this.make({ kind: "redo" });
  }

  /** Edits on their way may be what there is to undo or redo. */
  private isOpenTo(what: "can_undo" | "can_redo"): boolean {
    const edited = this.session.edited.value;
    return edited !== undefined && (edited.shown.value[what] || edited.unsent().length > 0);
  }

  private make(edit: Edit | null, otherwise = ""): void {
    const edited = this.session.edited.value;
    if (!edited) return;
    if (!edit) {
      this.session.bulletin.tell(otherwise);
      return;
    }
    const at = this.store.selection.value;
    edited.edit(edit);
    const start = at && commands.followed(edit, at.level, at.start_frame);
    if (at && start !== null) this.store.selection.value = { ...at, start_frame: start! };
  }

  private where(): commands.Where {
    return { lane: this.lane(), frame: this.store.frame.value };
  }

  private lane(): Segment[] {
    return this.level.value === "activity"
      ? this.store.activities.value
      : this.store.primitives.value;
  }
}
