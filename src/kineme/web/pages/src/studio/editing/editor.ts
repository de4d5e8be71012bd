/**
 * Edits as people make them. There is one target: the segment at the playhead,
 * on the level one works in, and the border nearest to the playhead. The
 * timeline shows both. What an edit would reach outside of the view is brought
 * into the view first. A key that is pressed while edits are on their way is for
 * where the playhead was then, in the table that these edits leave.
 */
import { batch, computed, signal } from "@preact/signals";
import type { ByHand, Edit, Level, MoveBorder, Recording, Segment, Segments } from "../../messages";
import type { Store } from "../../store";
import * as commands from "./commands";
import type { EditedRecording } from "./editedRecording";
import type { Session } from "../session";
import { findRow, laneOf, nearestBorder, segmentAt } from "../../segments";
import { counted } from "../../counted";

/** Where the playhead is for some keys: those that move a border take it along for those after them. */
interface Place {
  readonly level: Level;
  frame: number;
}

export class Editor {
  /** Asks for the field of a name to take the keyboard: of a segment or its cluster. */
  readonly naming = signal<"segment" | "cluster" | null>(null);
  readonly segment = computed<Segment | undefined>(() => this.store.target.value);
  private readonly store: Store;
  /** The border that a key holds: from where, and how far it is by now. */
  private held: { where: commands.Where; by: number; place: Place } | null = null;
  /** Where the playhead was for the last key. */
  private place: Place = { level: "primitive", frame: 0 };
  /** The recording of the command whose turn it is. */
  private turnOf: EditedRecording | undefined;
  /** The key that moves a border, which may be released before its turn has come. */
  private pressed: { isDown: boolean } | null = null;

  constructor(private readonly session: Session) {
    this.store = session.store;
  }

  /** Makes an edit that needs no playhead, of segments of `table` where edits came since. */
  edit(edit: ByHand, table?: Segments): void {
    if (edit.kind === "move_border") this.moveBorder(edit);
    else if (edit.kind === "exclude") this.exclude(edit.frames, edit.excluded);
    else void this.send(edit, undefined, table);
  }

  /** The border stays where it was dragged to until the table shows it there. */
  private moveBorder(edit: MoveBorder): void {
    const drag = this.store.drag.peek();
    const end = (): void => {
      if (this.store.drag.peek() === drag) this.store.drag.value = null;
    };
    void this.send(edit, end).then(end);
  }

  split(): void {
    this.make(
      commands.split,
      ({ frame }) => frame,
      "There is a border at the playhead already: move the playhead first.",
    );
  }

  mergeWithNext(): void {
    this.make(
      commands.mergeWithNext,
      ({ lane, frame }) => segmentAt(lane, frame)?.stop_frame,
      "This is the last segment: choose one with a neighbour after it.",
    );
  }

  deleteBorder(): void {
    this.make(
      commands.deleteBorder,
      ({ lane, frame }) => nearestBorder(lane, frame)?.start_frame,
      "There is no border to delete.",
    );
  }

  /** The segment at the playhead starts, or stops, at the playhead. */
  borderHere(side: "start" | "stop"): void {
    this.make(
      (where) => commands.borderHere(where, side),
      ({ frame }) => frame,
      "There is a border at the playhead already, or none on that side to bring here.",
    );
  }

  /**
   * Moves the border nearest to the playhead, which goes with it. It is made when the key is
   * released: as long as it is held it is one edit.
   */
  nudge(frames: number): void {
    if (this.held) return this.carry(frames);
    const pressed = (this.pressed ??= { isDown: true });
    this.make(
      (where) => commands.nudgeBorder(where, frames),
      ({ lane, frame }) => nearestBorder(lane, frame)?.start_frame,
      "There is no border to move, or no room for it.",
      (_, where, place) => {
        this.held ??= { where, by: 0, place };
        this.carry(frames);
        if (!pressed.isDown) this.release();
      },
    );
  }

  /** Makes the border that a key holds. */
  release(): void {
    if (this.pressed) this.pressed.isDown = false;
    this.pressed = null;
    if (!this.held) return;
    const edit = commands.nudgeBorder(this.held.where, this.held.by);
    this.held = null;
    if (edit) this.moveBorder(edit);
    else this.store.drag.value = null;
  }

  /** Takes the border that a key holds on, as far as there is room. */
  private carry(frames: number): void {
    const { where, by, place } = this.held!;
    const edit = commands.nudgeBorder(where, by + frames);
    const frame = nearestBorder(where.lane, where.frame)!.start_frame;
    const to = edit?.to ?? frame;
    const isThere = this.store.frame.peek() === place.frame; // it may have been moved since
    this.held = { where, by: to - frame, place };
    place.frame = to;
    batch(() => {
      this.store.drag.value = { lane: place.level, frame, to };
      if (isThere) this.store.seek(to / this.store.fps.value);
    });
  }

  /** The field of a name takes the keyboard, where there is one. */
  startNaming(target: "segment" | "cluster"): void {
    const segment = this.segment.value;
    if (segment && target === "cluster" && segment.cluster < 0)
      this.session.bulletin.refuse("This segment is in no cluster: there is no cluster to name.");
    else if (segment) this.naming.value = target;
  }

  name(segment: Segment, label: string, table?: Segments): void {
    this.edit({ kind: "name_segment", ...commands.placeOf(segment), label }, table);
  }

  /** Gives the segment one works on a name of its own. */
  nameTarget(label: string): void {
    this.atPlayhead((segment) => this.name(segment, label));
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
  private exclude(frames: number[], excluded: boolean): void {
    const what = excluded ? "left out of means" : "in means again";
    void this.send({ kind: "exclude", frames, excluded }, () => {
      this.session.bulletin.tell(`${counted(frames.length, "repetition")} ${what}.`);
    });
  }

  /** Leaves the selected repetition out of means, or brings it back. */
  toggleExcluded(): void {
    const row = this.store.selected.value;
    if (row?.kind === "primitive")
      this.inTurn((_, { segmentation }) =>
        this.exclude([row.start_frame], !findRow(segmentation, row)?.excluded),
      );
    else this.session.bulletin.refuse("Select the repetition to leave out of means first.");
  }

  /** Several edits as one step, which says how many segments it reached. */
  together(edits: ByHand[], what: string): void {
    if (!edits.length) return;
    void this.send(edits.length === 1 ? edits[0]! : { kind: "together", edits }, () => {
      if (what) this.session.bulletin.tell(`${counted(edits.length, "segment")} ${what}.`);
    });
  }

  undo(): void {
    if (this.isOpenTo("can_undo")) this.session.edited.value?.undo();
    else this.session.bulletin.refuse("There is nothing to undo.");
  }

  redo(): void {
    if (this.isOpenTo("can_redo")) void this.send({ kind: "redo" });
    else this.session.bulletin.refuse("There is nothing to redo.");
  }

  /** Does something with the segment at the playhead, as it is once the edits before are shown. */
  atPlayhead(act: (segment: Segment) => void): void {
    this.inTurn(({ lane, frame }) => {
      const segment = segmentAt(lane, frame);
      if (segment) act(segment);
    });
  }

  /** Edits on their way may be what there is to undo or redo. */
  private isOpenTo(what: "can_undo" | "can_redo"): boolean {
    const edited = this.session.edited.value;
    return edited !== undefined && (edited.confirmed.value[what] || edited.isOwing());
  }

  /** An edit of what is at the playhead, if it can be seen. */
  private make(
    command: (where: commands.Where) => Edit | null,
    affects: (where: commands.Where) => number | undefined,
    otherwise: string,
    act: (edit: Edit, where: commands.Where, place: Place) => void = (edit) => void this.send(edit),
  ): void {
    this.inTurn((where, _, place) => {
      const edit = command(where);
      const frame = affects(where);
      if (!edit || frame === undefined) this.session.bulletin.refuse(otherwise);
      else if (this.turnOf !== this.session.edited.peek()) void this.send(edit);
      else if (this.store.reveal(frame / this.store.fps.value))
        this.session.bulletin.tell("This is where it would be: press once more to do it.");
      else act(edit, where, place);
    });
  }

  /** Does something at the playhead as it is now, once the edits before are shown. */
  private inTurn(act: (where: commands.Where, recording: Recording, place: Place) => void): void {
    const edited = this.session.edited.peek();
    const [level, frame] = [this.store.worked.peek(), this.store.frame.peek()];
    if (this.place.level !== level || this.place.frame !== frame) this.place = { level, frame };
    const { place } = this;
    edited?.whenShown(() => {
      const { value: recording } = edited.confirmed;
      const lane = laneOf(recording.segmentation, level);
      this.turnOf = edited; // another one may be in front by now
      act({ lane, frame: place.frame }, recording, place);
      this.turnOf = undefined;
    });
  }

  /** The selection follows the border that it starts at. */
  private send(edit: Edit, made?: () => void, table?: Segments): Promise<void> {
    const edited = this.turnOf ?? this.session.edited.peek();
    const show = (): void => {
      made?.();
      if (edited !== this.session.edited.peek()) return;
      const at = this.store.selection.peek();
      const start = at && commands.followed(edit, at.level, at.start_frame);
      if (at && start !== null) this.store.selection.value = { ...at, start_frame: start };
    };
    return edited?.edit(edit, show, table) ?? Promise.resolve();
  }
}
