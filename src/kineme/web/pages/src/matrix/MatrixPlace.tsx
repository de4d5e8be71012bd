/** The matrix, and below it, where there is room, what is at the playhead. */
import type { JSX } from "preact";
import { Present } from "../clusters/Present";
import type { Store } from "../store";
import { Matrix } from "./Matrix";

export function MatrixPlace({ store }: { store: Store }): JSX.Element {
  return (
    <div class="matrix-place">
      <div class="matrix-top">
        <Matrix store={store} />
      </div>
      <Present store={store} />
    </div>
  );
}
