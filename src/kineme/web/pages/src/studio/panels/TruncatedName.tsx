/** Show a name whose middle is shortened first, since recordings often differ at the end. */
import type { JSX } from "preact";

const TAIL = 12; // letters at the end that always stay visible

export function TruncatedName({ name }: { name: string }): JSX.Element {
  const cut = Math.max(name.length - TAIL, 0);
  return (
    <span class="name halves">
      <span>{name.slice(0, cut)}</span>
      <span>{name.slice(cut)}</span>
    </span>
  );
}
