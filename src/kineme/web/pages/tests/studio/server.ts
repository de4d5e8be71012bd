/** Simulate the studio's server. */
import type { Edit, Edited, EditRequest, Level, Recording } from "../../src/messages";
import { Refused, Unreachable } from "../../src/studio/server/api";
import { recording, row } from "./tables";

type Table = Pick<Recording, "segmentation">;

/** A server that edits one table, recognises repeated edits, and can be offline or fail after saving. */
export class Server {
  up = true;
  /** Edits that it refuses. */
  refuses: (edit: Edit) => boolean = () => false;
  dieAfterSaving = false;
  /** Delay of answers, milliseconds. */
  latency = 0;
  readonly got: Edit[] = [];
  private readonly known = new Set<string>();
  private readonly past: Table[] = [];

  constructor(public now: Recording = recording()) {}

  async loadRecording(): Promise<Recording> {
    if (!this.up) throw new Unreachable();
    return this.now;
  }

  async sendEdit(_id: string, { revision, edit, name = "" }: EditRequest): Promise<Edited> {
    if (this.latency) await new Promise((resolve) => setTimeout(resolve, this.latency));
    if (!this.up) throw new Unreachable();
    if (this.known.has(name)) return this.answer();
    if (revision !== this.now.revision) throw new Refused(409, "The table has changed.", {});
    const after = edit.kind === "undo" ? this.past.pop() : applyEdit(this.now, edit);
    if (!after || this.refuses(edit)) throw new Refused(400, "It cannot be made.", {});
    if (edit.kind !== "undo") this.past.push(this.now);
    this.got.push(edit);
    if (name) this.known.add(name);
    const { segmentation } = after;
    const saved = "take.segments.json";
    this.now = { ...this.now, segmentation, revision: revision + 1, saved };
    if (this.dieAfterSaving) {
      this.up = false;
      throw new Unreachable();
    }
    return this.answer();
  }

  private answer(): Edited {
    return { ...this.now, change: null, notes: [] };
  }
}

/** Apply an edit of the kinds that the tests use. */
function applyEdit(table: Table, edit: Edit): Table | undefined {
  const { segmentation } = table;
  const rows = segmentation.segments.map((each) => ({ ...each }));
  const startingAt = (level: Level, frame: number): number =>
    rows.findIndex((each) => each.level === level && each.start_frame === frame);
  if (edit.kind === "together")
    return edit.edits.reduce<Table | undefined>((now, one) => now && applyEdit(now, one), table);
  if (edit.kind === "check") {
    for (const frame of edit.frames) rows[startingAt(edit.level, frame)]!.checked = edit.checked;
  } else if (edit.kind === "split") {
    const { level, frame } = edit;
    const at = rows.findIndex((each) => each.level === level && each.stop_frame > frame);
    rows.splice(at + 1, 0, row(level, frame, rows[at]!.stop_frame, rows[at]!.cluster));
    rows[at]!.stop_frame = frame;
  } else if ("frame" in edit) {
    const at = startingAt(edit.level, edit.frame);
    if (at < 0) return undefined;
    if (edit.kind === "name_segment") rows[at]!.label = edit.label;
    if (edit.kind === "move_border") rows[at]!.start_frame = rows[at - 1]!.stop_frame = edit.to;
    if (edit.kind === "delete_border") rows[at - 1]!.stop_frame = rows.splice(at, 1)[0]!.stop_frame;
  } else return undefined;
  return { segmentation: { ...segmentation, segments: rows } };
}
