/** The matrix, and below it, where there is room, what is at the playhead. */
import type { JSX } from "preact";
import { Present } from "../clusters/Present";
import { Matrix } from "./Matrix";

export function MatrixPlace(): JSX.Element {
  return (
    <div class="matrix-place">
      <div class="matrix-top">
        <Matrix />
      </div>
      <Present />
    </div>
  );
}
