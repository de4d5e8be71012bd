/** Show the matrix and, if there is space, the current segment. */
import type { JSX } from "preact";
import { CurrentSegment } from "../clusters/CurrentSegment";
import { Matrix } from "./Matrix";

export function MatrixPanel(): JSX.Element {
  return (
    <div class="matrix-place">
      <div class="matrix-top">
        <Matrix />
      </div>
      <CurrentSegment />
    </div>
  );
}
