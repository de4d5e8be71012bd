/** List where results differ; a click goes there. */
import type { JSX } from "preact";
import { useStore } from "../../context";
import { Button, TableHead } from "../../layout/controls";
import { formatTime } from "../../view";

interface Props {
  caption: string;
  /** Names of the compared results. */
  names: readonly string[];
  differences: readonly { start_s: number; stop_s: number; labels: readonly string[] }[];
}

export function DifferenceTable({ caption, names, differences }: Props): JSX.Element {
  const store = useStore();
  return (
    <table class="differences number">
      <caption>{caption}</caption>
      <TableHead columns={["From", "Seconds", ...names]} />
      <tbody>
        {differences.map(({ start_s, stop_s, labels }) => (
          <tr key={start_s}>
            <td>
              <Button class="link" onClick={() => store.seek(start_s)}>
                {formatTime(start_s, 2)}
              </Button>
            </td>
            <td>{(stop_s - start_s).toFixed(2)}</td>
            {labels.map((label, i) => (
              <td key={names[i]}>{label || "–"}</td>
            ))}
          </tr>
        ))}
        {differences.length === 0 && (
          <tr>
            <td colSpan={2 + names.length}>Nowhere for more than 0.25 s.</td>
          </tr>
        )}
      </tbody>
    </table>
  );
}
