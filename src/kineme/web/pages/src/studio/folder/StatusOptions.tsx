/** What a list of recordings can be narrowed to. */
import type { JSX } from "preact";

const STATUSES = ["new", "corrected", "labelled", "checked"] as const;

export function StatusOptions(): JSX.Element {
  return (
    <>
      <option value="">all</option>
      {STATUSES.map((status) => (
        <option key={status} value={status}>
          {status}
        </option>
      ))}
    </>
  );
}
