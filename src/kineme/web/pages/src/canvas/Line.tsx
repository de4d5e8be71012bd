/** A line of the playhead across its box, moved without drawing anything anew. */
import type { JSX } from "preact";

interface Props {
  /** From 0 at the start of the box to 1 at its end; outside of that it is not shown. */
  share: number;
  /** Whether it lies, and moves down. */
  lying?: boolean;
  /** Whether it has a handle at its top. */
  handle?: boolean;
}

export function Line({ share, lying = false, handle = false }: Props): JSX.Element | null {
  if (!(share >= 0 && share <= 1)) return null;
  const move = lying ? `translateY(${100 * share}cqh)` : `translateX(${100 * share}cqw)`;
  const kind = `${lying ? "lying" : "standing"}${handle ? " handle" : ""}`;
  return <div class={`line ${kind}`} style={{ transform: move }} />;
}
