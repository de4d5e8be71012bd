/** Draw the playhead as a line across its container; moving it redraws no canvas. */
import type { JSX } from "preact";

interface Props {
  /** Position from 0 (start of the container) to 1 (end); hidden outside this range. */
  share: number;
  /** Whether the line is horizontal and moves down. */
  horizontal?: boolean;
  handle?: boolean;
}

export function PlayheadLine({
  share,
  horizontal = false,
  handle = false,
}: Props): JSX.Element | null {
  if (!(share >= 0 && share <= 1)) return null;
  const move = horizontal ? `translateY(${100 * share}cqh)` : `translateX(${100 * share}cqw)`;
  const kind = `${horizontal ? "horizontal" : "vertical"}${handle ? " handle" : ""}`;
  return <div class={`line ${kind}`} style={{ transform: move }} />;
}
