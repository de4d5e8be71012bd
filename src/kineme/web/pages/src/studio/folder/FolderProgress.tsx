/** Show progress such as "312 of 1,396 checked; 40 of the others below 50 %". */
import type { JSX } from "preact";
import type { Tally } from "./briefTables";

export function FolderProgress({ tally }: { tally: Tally }): JSX.Element | null {
  const { all, checked, doubtful } = tally;
  if (!all) return null;
  return (
    <p class="folder-progress">
      <progress max={all} value={checked} aria-label="Segments of the folder checked" />
      <span
        class="number"
        title="Segments that nobody checked and that are more probably wrong than right"
      >
        {formatInteger(checked)} of {formatInteger(all)} checked; {formatInteger(doubtful)} of the
        others below 50 %
      </span>
    </p>
  );
}

function formatInteger(n: number): string {
  return n.toLocaleString("en");
}
