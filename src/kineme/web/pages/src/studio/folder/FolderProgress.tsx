/** How far the folder is: "312 of 1,396 checked, 40 left above half a doubt". */
import type { JSX } from "preact";
import type { Tally } from "./briefTables";

export function FolderProgress({ tally }: { tally: Tally }): JSX.Element | null {
  const { all, checked, doubtful } = tally;
  if (!all) return null;
  return (
    <p class="folder-progress">
      <progress max={all} value={checked} aria-label="Segments of the folder checked" />
      <span class="number" title="Left: not checked, and more probably wrong than right">
        {grouped(checked)} of {grouped(all)} checked, {grouped(doubtful)} left above half a doubt
      </span>
    </p>
  );
}

function grouped(n: number): string {
  return n.toLocaleString("en");
}
