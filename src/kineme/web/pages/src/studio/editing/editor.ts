/**
 * Turn the user's commands into edits. They apply to the segment at the playhead on the edited
 * level, and to the border nearest to it; the timeline shows both. If the affected frame is not
 * visible, the first key press only scrolls to it. A key pressed while edits are being sent applies
 * to the playhead's position and the view at that time, in the table that these edits produce.
 */
import { batch, computed, signal } from "@preact/signals";
import type { ByHand, Edit, Level, MoveBorder, Recording, Segment, Segments } from "../../messages";
import type { Store } from "../../store";
import * as commands from "./edits";
import type { EditedRecording } from "./editedRecording";
import type { Session } from "../session";
import { findNearestBorder, findRow, findSegmentAt, getLane } from "../../segments";
import { formatCount } from "../../util";

/** Playhead position of queued keys; a key that moves a border updates it for later keys. */
interface PlayheadPosition {
  readonly level: Level;
  frame: number;
}

export class Editor {
  /** Which name field should get the focus. */
  readonly naming = signal<"segment" | "cluster" | null>(null);
  readonly segment = computed<Segment | undefined>(() => this.store.target.value);
  private readonly store: Store;
  /** The border that a pressed key moves, and by how many frames so far. */
  private heldBorder: { where: commands.EditContext; by: number; place: PlayheadPosition } | null =
    null;
  /** Playhead position at the last key. */
  private place: PlayheadPosition = { level: "primitive", frame: 0 };
  /** Recording of the running command. */
  private turnRecording: EditedRecording | undefined;
  /** The pressed key; it may be released before its command runs. */
  private pressedKey: { isDown: boolean } | null = null;

  constructor(private readonly session: Session) {
    this.store = session.store;
  }

  /** Send an edit that is independent of the playhead, based on `table`. */
  edit(edit: ByHand, table?: Segments): void {
    if (edit.kind === "move_border") this.moveBorder(edit);
    else if (edit.kind === "exclude") this.setExcluded(edit.frames, edit.excluded);
    else void this.send(edit, undefined, table);
  }

  /** Move a border and show it dragged until the table has it there. */
  private moveBorder(edit: MoveBorder): void {
    const drag = this.store.drag.peek();
    const end = (): void => {
      if (this.store.drag.peek() === drag) this.store.drag.value = null;
    };
    void this.send(edit, end).then(end);
  }

  split(): void {
    this.runCommand(
      commands.createSplit,
      ({ frame }) => frame,
      "There is a border at the playhead already: move the playhead first.",
    );
  }

  mergeWithNext(): void {
    this.runCommand(
      commands.createMerge,
      ({ lane, frame }) => findSegmentAt(lane, frame)?.stop_frame,
      "This is the last segment: choose one with a neighbour after it.",
    );
  }

  deleteBorder(): void {
    this.runCommand(
      commands.createDeletion,
      ({ lane, frame }) => findNearestBorder(lane, frame)?.start_frame,
      "There is no border to delete.",
    );
  }

  /** Move the current segment's start or stop to the playhead. */
  moveBorderHere(side: "start" | "stop"): void {
    this.runCommand(
      (where) => commands.createBorderMove(where, side),
      ({ frame }) => frame,
      "There is a border at the playhead already, or none on that side to bring here.",
    );
  }

  /** Move the nearest border and the playhead; a held key makes one edit when released. */
  nudge(frames: number): void {
    if (this.heldBorder) return this.extendNudge(frames);
    const pressed = (this.pressedKey ??= { isDown: true });
    this.runCommand(
      (where) => commands.createNudge(where, frames),
      ({ lane, frame }) => findNearestBorder(lane, frame)?.start_frame,
      "There is no border to move, or no room for it.",
      (_, where, place) => {
        this.heldBorder ??= { where, by: 0, place };
        this.extendNudge(frames);
        if (!pressed.isDown) this.release();
      },
    );
  }

  /** Send the edit of the moved border. */
  release(): void {
    if (this.pressedKey) this.pressedKey.isDown = false;
    this.pressedKey = null;
    if (!this.heldBorder) return;
    const edit = commands.createNudge(this.heldBorder.where, this.heldBorder.by);
    this.heldBorder = null;
    if (edit) this.moveBorder(edit);
    else this.store.drag.value = null;
  }

  /** Move the held border further, as far as possible. */
  private extendNudge(frames: number): void {
    const { where, by, place } = this.heldBorder!;
    const edit = commands.createNudge(where, by + frames);
    const frame = findNearestBorder(where.lane, where.frame)!.start_frame;
    const to = edit?.to ?? frame;
    const isThere = this.store.frame.peek() === place.frame; // the user may have moved it
    this.heldBorder = { where, by: to - frame, place };
    place.frame = to;
    batch(() => {
      this.store.drag.value = { lane: place.level, frame, to };
      if (isThere) this.store.seek(to / this.store.fps.value);
    });
  }

  /** Focus the name field of the segment or its cluster. */
  startNaming(target: "segment" | "cluster"): void {
    const segment = this.segment.value;
    if (segment && target === "cluster" && segment.cluster < 0)
      this.session.notifications.refuse(
        "This segment is in no cluster: there is no cluster to name.",
      );
    else if (segment) this.naming.value = target;
  }

  nameSegment(segment: Segment, label: string, table?: Segments): void {
    this.edit({ kind: "name_segment", ...commands.getTarget(segment), label }, table);
  }

  /** Name the segment at the playhead. */
  nameTarget(label: string): void {
    this.runAtPlayhead((segment) => this.nameSegment(segment, label));
  }

  /** Mark segments as checked or unchecked. */
  setChecked(segments: readonly Segment[], checked: boolean): void {
    const edits: ByHand[] = (["activity", "primitive"] as const).flatMap((level) => {
      const frames = segments
        .filter((each) => each.level === level)
        .map((each) => each.start_frame);
      return frames.length ? [{ kind: "check" as const, level, frames, checked }] : [];
    });
    this.sendTogether(edits, "");
  }

  /** Exclude the primitives at these frames from means, or include them again. */
  private setExcluded(frames: number[], excluded: boolean): void {
    const what = excluded ? "left out of means" : "in means again";
    void this.send({ kind: "exclude", frames, excluded }, () => {
      this.session.notifications.tell(`${formatCount(frames.length, "repetition")} ${what}.`);
    });
  }

  /** Exclude the selected repetition from means, or include it again. */
  toggleExcluded(): void {
    const row = this.store.selected.value;
    if (row?.kind === "primitive")
      this.runInTurn((_, { segmentation }) =>
        this.setExcluded([row.start_frame], !findRow(segmentation, row)?.excluded),
      );
    else this.session.notifications.refuse("Select the repetition to leave out of means first.");
  }

  /** Send several edits as one step and report how many segments changed. */
  sendTogether(edits: ByHand[], what: string): void {
    if (!edits.length) return;
    void this.send(edits.length === 1 ? edits[0]! : { kind: "together", edits }, () => {
      if (what) this.session.notifications.tell(`${formatCount(edits.length, "segment")} ${what}.`);
    });
  }

  undo(): void {
    if (this.canStep("can_undo")) this.session.edited.value?.undo();
    else this.session.notifications.refuse("There is nothing to undo.");
  }

  redo(): void {
    if (this.canStep("can_redo")) void this.send({ kind: "redo" });
    else this.session.notifications.refuse("There is nothing to redo.");
  }

  /** Run a function on the segment at the playhead once earlier edits are shown. */
  runAtPlayhead(act: (segment: Segment) => void): void {
    this.runInTurn(({ lane, frame }) => {
      const segment = findSegmentAt(lane, frame);
      if (segment) act(segment);
    });
  }

  /** Return whether undo or redo is possible; pending edits count as well. */
  private canStep(what: "can_undo" | "can_redo"): boolean {
    const edited = this.session.edited.value;
    return edited !== undefined && (edited.confirmed.value[what] || edited.hasPending());
  }

  /** Create an edit at the playhead and act on it if the affected frame is visible. */
  private runCommand(
    command: (where: commands.EditContext) => Edit | null,
    affects: (where: commands.EditContext) => number | undefined,
    otherwise: string,
    act: (edit: Edit, where: commands.EditContext, place: PlayheadPosition) => void = (edit) =>
      void this.send(edit),
  ): void {
    const { start_s, stop_s } = this.store.range.peek(); // visible when the key is pressed
    this.runInTurn((where, _, place) => {
      const edit = command(where);
      const frame = affects(where);
      const at_s = (frame ?? 0) / this.store.fps.value;
      const wasVisible = start_s <= at_s && at_s <= stop_s;
      if (!edit || frame === undefined) this.session.notifications.refuse(otherwise);
      else if (this.turnRecording !== this.session.edited.peek()) void this.send(edit);
      else if (!wasVisible && this.store.reveal(at_s))
        this.session.notifications.tell("This is where it would be: press once more to do it.");
      else act(edit, where, place);
    });
  }

  /** Run a function for the current playhead once earlier edits are shown. */
  private runInTurn(
    act: (where: commands.EditContext, recording: Recording, place: PlayheadPosition) => void,
  ): void {
    const edited = this.session.edited.peek();
    const [level, frame] = [this.store.workLevel.peek(), this.store.frame.peek()];
    if (this.place.level !== level || this.place.frame !== frame) this.place = { level, frame };
    const { place } = this;
    edited?.runWhenShown(() => {
      const { value: recording } = edited.confirmed;
      const lane = getLane(recording.segmentation, level);
      this.turnRecording = edited; // another recording may be active by now
      act({ lane, frame: place.frame }, recording, place);
      this.turnRecording = undefined;
    });
  }

  /** Send an edit; the selection follows a moved start. */
  private send(edit: Edit, made?: () => void, table?: Segments): Promise<void> {
    const edited = this.turnRecording ?? this.session.edited.peek();
    const show = (): void => {
      made?.();
      if (edited !== this.session.edited.peek()) return;
      const at = this.store.selection.peek();
      const start = at && commands.getMovedStart(edit, at.level, at.start_frame);
      if (at && start !== null) this.store.selection.value = { ...at, start_frame: start };
    };
    return edited?.edit(edit, show, table) ?? Promise.resolve();
  }
}
