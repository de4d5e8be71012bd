/** The server of the studio, as far as tests need one. */
import type { Edit, Edited, EditRequest, Recording } from "../../src/messages";
import { expected, storyOf } from "../../src/studio/editing/story";
import { Refused, Unreachable } from "../../src/studio/server/answers";
import { recording } from "./tables";

/** A server that edits one table, knows edits by name, can be switched off, or die once it saved. */
export class Server {
  up = true;
  /** What it cannot make, for reasons of its own. */
  refuses: (edit: Edit) => boolean = () => false;
  dieAfterSaving = false;
  /** Milliseconds until it answers. */
  latency = 0;
  readonly got: Edit[] = [];
  private readonly known = new Set<string>();
  private story;

  constructor(public now: Recording = recording()) {
    this.story = storyOf({ segmentation: now.segmentation, ids: now.ids! });
  }

  async recording(): Promise<Recording> {
    if (!this.up) throw new Unreachable();
    return this.now;
  }

  async edit(_id: string, { revision, edit, name = "" }: EditRequest): Promise<Edited> {
    if (this.latency) await new Promise((resolve) => setTimeout(resolve, this.latency));
    if (!this.up) throw new Unreachable();
    if (this.known.has(name)) return this.answer();
    if (revision !== this.now.revision) throw new Refused(409, "The table has changed.", {});
    const after = expected(this.story, edit, name || crypto.randomUUID());
    if (!after || after === this.story || this.refuses(edit))
      throw new Refused(400, "It cannot be made.", {});
    this.story = after;
    this.got.push(edit);
    if (name) this.known.add(name);
    const { segmentation, ids } = after.present;
    const saved = "take.segments.json";
    this.now = { ...this.now, segmentation, ids: [...ids], revision: revision + 1, saved };
    if (this.dieAfterSaving) {
      this.up = false;
      throw new Unreachable();
    }
    return this.answer();
  }

  private answer(): Edited {
    return { ...this.now, ids: this.now.ids!, notes: [] };
  }
}
