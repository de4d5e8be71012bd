/** What the page foresees, or makes of an answer, is what the package makes (make_edits.py). */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, it } from "vitest";
import type { Annotation, Edit, Segment, Segments, TableChange } from "../../src/messages";
import { changedBy } from "../../src/studio/editing/changes";
import { foreseen } from "../../src/studio/editing/foreseen/foreseen";
import {
  idsAfter,
  madeOn,
  readdressed,
  type IdentifiedTable,
} from "../../src/studio/editing/identities";

type Said = Pick<Segments, "cluster_names" | "checked" | "by_hand" | "comments"> & {
  rows: unknown[][];
  ids: string[];
};
/** Rows have the columns that others follow from. */
interface Edits {
  columns: string[];
  chains: Chain[];
}
interface Chain {
  start: Said & Pick<Segments, "annotation">;
  steps: Step[];
}
interface Step {
  edit: Edit;
  name: string;
  after: (Said & Pick<Annotation, "excluded">) | null;
  /** What an answer tells of it and of its undoing; null where that is the whole table. */
  changes: (TableChange | null)[];
}

const FPS = 30;
const { columns, chains } = JSON.parse(
  readFileSync(join(import.meta.dirname, "edits.json"), "utf-8"),
) as Edits;

/** What a step ends in; what people said of rows comes with what the page makes of it. */
function afterOf(
  { excluded, ...after }: NonNullable<Step["after"]>,
  made: Segments,
): IdentifiedTable {
  return knownOf({ ...after, annotation: { ...made.annotation, excluded } });
}

function knownOf({ rows, ids, ...rest }: Chain["start"]): IdentifiedTable {
  const told = rows.map(
    (row) => Object.fromEntries(row.map((cell, i) => [columns[i]!, cell])) as unknown as Segment,
  );
  const actions = told.filter((row) => row.level === "activity").map((row) => row.cluster);
  const segments = told.map((row) => ({
    ...row,
    start_s: row.start_frame / FPS,
    stop_s: row.stop_frame / FPS,
    action: actions[row.activity]!,
  }));
  const n_frames = segments.at(-1)!.stop_frame;
  const table = { schema: "", n_frames, fps: FPS, provenance: {}, timings: {}, ...rest, segments };
  return { segmentation: table, ids };
}

it.each(chains.map((chain, i) => [i, chain] as const))(
  "chain %i of edits is foreseen",
  (_, { start, steps }) => {
    let before = knownOf(start);
    for (const { edit, name, after } of steps) {
      const now = foreseen(before.segmentation, edit)!;
      if (!after) {
        expect(now, JSON.stringify(edit)).toBe(before.segmentation);
        continue;
      }
      const known = { segmentation: now, ids: idsAfter(before, now, name) };
      expect(known, JSON.stringify(edit)).toEqual(afterOf(after, now));
      before = known;
    }
  },
);

it.each(chains.map((chain, i) => [i, chain] as const))(
  "the tables of chain %i are made of what answers tell",
  (_, { start, steps }) => {
    let before = knownOf(start);
    for (const { edit, after, changes } of steps) {
      if (!after) continue;
      const [change, undoing] = changes;
      const now = afterOf(after, foreseen(before.segmentation, edit)!);
      if (change) expect(changedBy(change, before), JSON.stringify(edit)).toEqual(now);
      if (undoing) expect(changedBy(undoing, now), JSON.stringify(edit)).toEqual(before);
      before = now;
    }
  },
);

it("an edit is one of the same segments, wherever its frames have gone", () => {
  for (const { start, steps } of chains) {
    let before = knownOf(start);
    for (const { edit, name, after } of steps) {
      if (!after) continue;
      const on = madeOn(edit, before);
      expect(readdressed(edit, on, before), JSON.stringify(edit)).toEqual(edit);
      expect(on, JSON.stringify(edit)).not.toContain(null);
      const segmentation = foreseen(before.segmentation, edit)!;
      before = { segmentation, ids: idsAfter(before, segmentation, name) };
    }
  }
});
